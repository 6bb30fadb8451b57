// SPDX-License-Identifier: MIT
// A point enters where the tetrahedra are nearly flat: the cavity around it grows until the point
// sees every face of its border well, and never over a part of the surface.
#pragma once

#include "tunica/meshing/front_surface.hpp"
#include "tunica/meshing/tet_complex.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace tunica::meshing {

/// The tetrahedron that contains x, by a walk from t; -1 when it does not end (it may turn in circles
/// where the tetrahedra are not Delaunay).
[[nodiscard]] inline Index containing(const TetComplex& c, const Vec3& x, Index t) {
  for (Index step = 0; step < c.size(); ++step) {
    int f = 0;
    for (int k = 0; k < 4; ++k, ++f) {
      const int g = (k + step) % 4;  // another first face each time breaks circles
      const Triple n = c.face(t, g);
      if (orient3d(c.point(n[0]), c.point(n[1]), c.point(n[2]), x) <= 0) continue;
      if (c.across(t, g) < 0) return -1;
      t = c.across(t, g) / 4;
      break;
    }
    if (f == 4) return t;
  }
  return -1;
}

class CavityInsert {
 public:
  CavityInsert(TetComplex& complex, const FrontSurface& surface) : c_(complex), s_(surface) {}

  /// Puts a node at x, which the seed contains; the new tetrahedra have a sine_quality above the
  /// floor. Returns its number, -1 if marked faces or locked edges stand in the way.
  Index insert(const Vec3& x, std::span<const Index> seed, double floor) {
    cavity_.assign(seed.begin(), seed.end());
    c_.clear_visited();
    for (const Index t : cavity_) c_.visit(t);
    for (std::size_t i = 0; i < cavity_.size(); ++i) {
      if (cavity_.size() > most_tets) return -1;
      for (int f = 0; f < 4; ++f) {
        const Side s = c_.across(cavity_[i], f);
        if (s >= 0 && c_.visited(s / 4)) {
          if (c_.mark(cavity_[i], f) >= 0) return -1;
          continue;
        }
        if (seen(c_.face(cavity_[i], f), x) > floor) continue;
        if (s < 0 || c_.mark(cavity_[i], f) >= 0) return -1;
        c_.visit(s / 4);
        cavity_.push_back(s / 4);
      }
    }
    border_.clear();
    for (const Index t : cavity_)
      for (int f = 0; f < 4; ++f)
        if (const Side s = c_.across(t, f); s < 0 || !c_.visited(s / 4)) border_.push_back(c_.face(t, f));
    if (swallows()) return -1;
    const Index p = c_.add_point(x);
    fresh_.clear();
    for (const Triple& n : border_) fresh_.push_back({n[0], n[2], n[1], p});
    c_.replace(cavity_, fresh_, open_);
    return p;
  }

 private:
  static constexpr std::size_t most_tets = 200;

  [[nodiscard]] double seen(const Triple& n, const Vec3& x) const {
    return sine_quality(c_.point(n[0]), c_.point(n[2]), c_.point(n[1]), x);
  }

  /// Would a node or a locked edge vanish with the cavity?
  [[nodiscard]] bool swallows() const {
    const auto on_border = [&](Index a, Index b) {
      return std::any_of(border_.begin(), border_.end(), [&](const Triple& n) {
        const auto has = [&](Index v) { return n[0] == v || n[1] == v || n[2] == v; };
        return has(a) && has(b);
      });
    };
    for (const Index t : cavity_) {
      const Quad& n = c_.nodes(t);
      for (const Index v : n)
        if (!on_border(v, v)) return true;
      for (const auto& [i, j] : mesh::Tet4::edges) {
        const Index a = n[static_cast<std::size_t>(i)], b = n[static_cast<std::size_t>(j)];
        if (s_.locked(a, b) && !on_border(a, b)) return true;
      }
    }
    return false;
  }

  TetComplex& c_;
  const FrontSurface& s_;
  std::vector<Index> cavity_;
  std::vector<Triple> border_;
  std::vector<Quad> fresh_;
  std::vector<Side> open_;
};

}  // namespace tunica::meshing
