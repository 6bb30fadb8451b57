// SPDX-License-Identifier: MIT
// Where planes meet a cell of a grid: a polygon in which a vertex can be held, or a piece of a line.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/least_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace tunica::meshing::detail {

/// Nodes nearer to a plane than this share of the grid's least spacing lie on it, for rounding not to tell.
inline constexpr double on_plane = 1e-9;

/// n . (x - point), 0 on the plane; nearest: less counts as that [length].
[[nodiscard]] inline double plane_distance(const HermiteRegion& plane, const Vec3& x, double nearest) {
  const double d = vec::dot(plane.normal, vec::minus(x, plane.point));
  return std::abs(d) <= nearest ? 0 : d;
}

/// A cell from its low corner: its sides; a cell of the layer around the grid is as thin as the border.
struct FlatCell {
  Vec3 corner;     // in the image
  Box box;         // relative to it
  double nearest;  // less is no distance from a plane

  [[nodiscard]] bool thin(int axis) const { return !(box.lo[axis] < box.hi[axis]); }
};

/// A box without the share `hold` of it at either side.
[[nodiscard]] inline Box held(Box box, double hold) {
  for (int a = 0; a < 3; ++a) {
    const double margin = hold * (box.hi[a] - box.lo[a]);
    box.lo[a] += margin, box.hi[a] -= margin;
  }
  return box;
}

/// Two directions that span a plane, or one that spans a line, of length 1; else 0.
struct FlatSpan {
  Vec3 u{0, 0, 0}, w{0, 0, 0};

  explicit FlatSpan(std::span<const Vec3> normals) {
    constexpr double parallel = 1e-6;
    if (normals.size() > 2) return;
    if (normals.size() == 2) {
      const Vec3 along = vec::cross(normals[0], normals[1]);
      if (vec::length(along) > parallel) u = vec::unit(along);
      return;
    }
    u = vec::orthogonal(normals[0]), w = vec::cross(normals[0], u);
  }
  [[nodiscard]] Vec3 part(const Vec3& x) const {
    return vec::along(vec::scaled(vec::dot(u, x), u), vec::dot(w, x), w);
  }
};

/// The part of a cell in one plane (a cut, or the border that the cell is as thin as), or in the line of a
/// cut and a border or of two borders. Its middle lies in the cell and not on its sides, unless the plane
/// only touches the cell there: middles of neighbouring cells are apart.
class FlatSection {
 public:
  FlatSection(const FlatCell& cell, std::span<const HermiteRegion* const> cuts, const FlatSpan& span)
      : span_(span) {
    const auto corner = [&](int c) {
      return Vec3((c & 1) != 0 ? cell.box.hi[0] : cell.box.lo[0],
                  (c & 2) != 0 ? cell.box.hi[1] : cell.box.lo[1],
                  (c & 4) != 0 ? cell.box.hi[2] : cell.box.lo[2]);
    };
    int thin = 0;
    for (int a = 0; a < 3; ++a) thin |= cell.thin(a) ? 1 << a : 0;
    if (cuts.size() > 1 || (cuts.size() == 1 && (thin & (thin - 1)) != 0)) return;
    for (int c = 0; c < 8; ++c) {
      if ((c & thin) != 0) continue;
      const Vec3 p = corner(c);
      if (cuts.empty()) points_[count_++] = p;
      for (int a = 0; a < 3 && !cuts.empty(); ++a) {
        if (((thin | c) >> a & 1) != 0) continue;
        const Vec3 q = corner(c | 1 << a);
        const double d = plane_distance(*cuts[0], vec::plus(cell.corner, p), cell.nearest),
                     e = plane_distance(*cuts[0], vec::plus(cell.corner, q), cell.nearest);
        if ((d < 0) != (e < 0)) points_[count_++] = vec::between(p, q, d / (d - e));
      }
    }
    for (std::size_t n = 0; n < count_; ++n)
      middle_ = vec::along(middle_, 1.0 / static_cast<double>(count_), points_[n]);
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] const Vec3& middle() const { return middle_; }

  /// x itself where it lies in the section less the share `hold` of the way to the middle; else the point of
  /// its edges where the error is least, or nearest to x where that says nothing.
  [[nodiscard]] Vec3 held(const Vec3& x, const PlaneSums& sums, double hold) const {
    std::array<Flat, 12> p;
    for (std::size_t n = 0; n < count_; ++n) p[n] = flat(points_[n], 1 - hold);
    std::sort(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(count_), [](const Flat& a, const Flat& b) {
      const double s = std::atan2(a.w, a.u), t = std::atan2(b.w, b.u);
      return s != t ? s < t : a.u * a.u + a.w * a.w < b.u * b.u + b.w * b.w;
    });
    const Flat to = flat(x, 1);
    bool inside = true;
    double area = 0;  // twice that; the plane may only touch the cell
    for (std::size_t n = 0; n < count_; ++n) {
      const Flat &a = p[n], &b = p[(n + 1) % count_];
      area += a.u * b.w - a.w * b.u;
      inside &= (b.u - a.u) * (to.w - a.w) - (b.w - a.w) * (to.u - a.u) >= 0;
    }
    if (inside && area > 0) return x;
    // E = y M y - 2 g y about the middle, and little of the distance from x
    const Vec3 g = sums.descent(middle_), mu = sums.applied(span_.u), mw = sums.applied(span_.w);
    const double little = 1e-4 * std::max(sums.trace(), 1.0);
    const double uu = vec::dot(span_.u, mu) + little, uw = vec::dot(span_.u, mw),
                 ww = vec::dot(span_.w, mw) + little;
    const double gu = vec::dot(span_.u, g) + little * to.u, gw = vec::dot(span_.w, g) + little * to.w;
    Flat best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < count_; ++n) {
      const Flat &a = p[n], &b = p[(n + 1) % count_];
      const double du = b.u - a.u, dw = b.w - a.w;
      const double bend = du * (uu * du + uw * dw) + dw * (uw * du + ww * dw);
      const double slope = du * (gu - uu * a.u - uw * a.w) + dw * (gw - uw * a.u - ww * a.w);
      const double t = bend > 0 ? std::min(std::max(slope / bend, 0.0), 1.0) : 0;
      const Flat y{a.u + t * du, a.w + t * dw};
      const double error = y.u * (uu * y.u + 2 * uw * y.w - 2 * gu) + y.w * (ww * y.w - 2 * gw);
      if (error < least) least = error, best = y;
    }
    return vec::along(vec::along(middle_, best.u, span_.u), best.w, span_.w);
  }

 private:
  struct Flat {
    double u = 0, w = 0;
  };
  [[nodiscard]] Flat flat(const Vec3& x, double share) const {
    const Vec3 d = vec::minus(x, middle_);
    return {share * vec::dot(span_.u, d), share * vec::dot(span_.w, d)};
  }

  const FlatSpan& span_;
  std::array<Vec3, 12> points_;
  std::size_t count_ = 0;
  Vec3 middle_{0, 0, 0};
};

}  // namespace tunica::meshing::detail
