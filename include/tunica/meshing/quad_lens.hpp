// SPDX-License-Identifier: MIT
// Lenses that magnify space around a few places: a uniform grid over the magnified surface is, seen from the
// surface itself, finer there and fades to the spacing asked for.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"

#include <vector>

namespace tunica::meshing {

/// One lens: x -> c + (x - c) (1 + a / (1 + |x - c|^2 / r^2)). Lengths grow (1 + a) times at the centre, the
/// push fades as r^2 / |x - c|; across the rays nothing shrinks, along them nothing shrinks below 1 - a/8 (at
/// |x - c| = sqrt(3) r), so that the map has an inverse for 0 <= a < 8.
struct Lens {
  Vec3 centre;
  double radius;     // r [length]
  double power = 1;  // a [-]

  [[nodiscard]] double stretch(double square) const { return 1 + power / (1 + square / (radius * radius)); }

  [[nodiscard]] Vec3 magnified(const Vec3& x) const {
    const Vec3 way = vec::minus(x, centre);
    return vec::along(centre, stretch(vec::dot(way, way)), way);
  }

  /// Newton's iteration for the distance s from the centre with s stretch(s^2) = t, between t / (1 + a) and
  /// t.
  [[nodiscard]] Vec3 restored(const Vec3& y) const {
    const Vec3 way = vec::minus(y, centre);
    const double t = vec::length(way);
    if (!(t > 0)) return y;
    double lo = t / (1 + power), hi = t, s = hi;
    for (int i = 0; i < 60 && hi - lo > 1e-15 * t; ++i) {
      const double u = s * s / (radius * radius), value = s * (1 + power / (1 + u)) - t;
      (value > 0 ? hi : lo) = s;
      const double slope = 1 + power * (1 - u) / ((1 + u) * (1 + u));
      const double next = s - value / slope;
      if (next == s) break;
      s = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    return vec::along(centre, s / t, way);
  }
};

/// Lenses one behind the other; without any it changes nothing.
class Lenses {
 public:
  /// Adds one; centre and radius as they are on the surface itself.
  void add(const Lens& lens) {
    TUNICA_EXPECT(lens.radius > 0 && lens.power >= 0 && lens.power < 8, "a lens keeps the order of space");
    list_.push_back({magnified(lens.centre), lens.radius * magnification(lens.centre), lens.power});
  }

  [[nodiscard]] bool empty() const { return list_.empty(); }
  [[nodiscard]] std::size_t count() const { return list_.size(); }

  [[nodiscard]] Vec3 magnified(Vec3 x) const {
    for (const Lens& lens : list_) x = lens.magnified(x);
    return x;
  }
  [[nodiscard]] Vec3 restored(Vec3 y) const {
    for (std::size_t i = list_.size(); i-- > 0;) y = list_[i].restored(y);
    return y;
  }

  /// How many times lengths across the rays grow at x.
  [[nodiscard]] double magnification(Vec3 x) const {
    double m = 1;
    for (const Lens& lens : list_) {
      const Vec3 way = vec::minus(x, lens.centre);
      m *= lens.stretch(vec::dot(way, way));
      x = lens.magnified(x);
    }
    return m;
  }

 private:
  std::vector<Lens> list_;  // each in the space that those before it have magnified
};

}  // namespace tunica::meshing
