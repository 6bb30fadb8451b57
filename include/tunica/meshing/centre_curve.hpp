// SPDX-License-Identifier: MIT
// A curve that is drawn to the middle of a vessel: each point goes where, in the plane square to the curve,
// the wall is farthest away.
#pragma once

#include "tunica/meshing/section.hpp"
#include "tunica/meshing/vessel_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace tunica::meshing::detail {

[[nodiscard]] inline double curve_length(const std::vector<Vec3>& x) {
  double l = 0;
  for (std::size_t i = 1; i < x.size(); ++i) l += vec::distance(x[i - 1], x[i]);
  return l;
}

/// The same polyline by points at even distances of about `step`; its ends stay.
[[nodiscard]] inline std::vector<Vec3> resampled(const std::vector<Vec3>& x, double step) {
  const double all = curve_length(x);
  const auto n = static_cast<std::size_t>(std::max(2.0, std::round(all / step)));
  std::vector<Vec3> y{x.front()};
  double passed = 0;
  for (std::size_t i = 1, k = 1; k < n; ++k) {
    const double wanted = all * static_cast<double>(k) / static_cast<double>(n);
    double l = vec::distance(x[i - 1], x[i]);
    while (i + 1 < x.size() && passed + l < wanted) passed += l, ++i, l = vec::distance(x[i - 1], x[i]);
    y.push_back(l > 0 ? vec::between(x[i - 1], x[i], std::min(1.0, (wanted - passed) / l)) : x[i]);
  }
  y.push_back(x.back());
  return y;
}

/// Each inner point goes half-way to the mean of its neighbours, again and again.
inline void smooth_curve(std::vector<Vec3>& x, int sweeps) {
  for (int s = 0; s < sweeps; ++s) {
    Vec3 last = x.front();
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      const Vec3 mean = vec::between(last, x[i + 1], 0.5);
      last = x[i];
      x[i] = vec::between(x[i], mean, 0.5);
    }
  }
}

/// Unit tangents, from the points on both sides.
[[nodiscard]] inline std::vector<Vec3> tangents(const std::vector<Vec3>& x) {
  std::vector<Vec3> t;
  for (std::size_t i = 0; i < x.size(); ++i)
    t.push_back(vec::unit(vec::minus(x[std::min(i + 1, x.size() - 1)], x[i == 0 ? 0 : i - 1])));
  return t;
}

/// The point of the plane through x, square to the tangent, next to x, that is farthest from the wall: the
/// centre of an inscribed ball. It is sought in directions that turn by the golden angle, so that it also
/// climbs along ridges, and no farther than the wall is; `accuracy` is a share of the radius.
[[nodiscard]] inline Vec3 most_inner(const Vec3& start, const Vec3& tangent, const WallDistance& wall,
                                     double accuracy) {
  const PlaneFrame frame(start, tangent);
  const double radius = wall(start);
  constexpr double golden = 2.399963229728653;  // [rad]
  constexpr int most_failures = 12;             // in a row: then the step is halved
  // triangles that stood in the way lately: most steps end at one of them
  std::array<Index, 12> blockers{};
  std::size_t blocked = 0;
  const auto reaches = [&](const Vec3& x, double least, double most) {
    for (std::size_t i = 0; i < std::min(blocked, blockers.size()); ++i)
      if (wall.squared_to(blockers[i], x) <= least * least) return 0.0;
    const auto touch = wall.nearest(x, most);
    if (touch.triangle >= 0 && touch.distance <= least)
      blockers[blocked++ % blockers.size()] = touch.triangle;
    return touch.distance;
  };
  double best = radius, u = 0, v = 0, angle = 0;
  for (double step = 0.25 * radius; step > accuracy * radius; step *= 0.5)
    for (int failures = 0; failures < most_failures; angle += golden) {
      const double p = u + step * std::cos(angle), q = v + step * std::sin(angle);
      const double d = std::hypot(p, q) < radius ? reaches(frame.place({p, q}), best, best + 2 * step) : 0;
      if (d > best) {
        best = d, u = p, v = q, failures = 0;
      } else {
        ++failures;
      }
    }
  return frame.place({u, v});
}

}  // namespace tunica::meshing::detail
