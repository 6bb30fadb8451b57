// SPDX-License-Identifier: MIT
// Hexahedra made better by moving their nodes: means of the neighbours, then steps that raise the scaled
// Jacobians [KNUPP00] of the corners that fall short of a target.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/hex_guide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct HexImproveOptions {
  int sweeps = 10;      // of averaging
  int depth = 4;        // cells from the border in which nodes move
  double target = 0.6;  // scaled Jacobian of a corner below which its nodes are moved
  int passes = 12;      // over the corners below the target
};

struct [[nodiscard]] HexImproveReport {
  std::size_t moves = 0, visits = 0;
};

namespace detail {

/// det(u, v, w) / (|u| |v| |w|) and its derivatives by the three edges.
struct CornerShape {
  double s = -1;
  std::array<Vec3, 3> by;
};

[[nodiscard]] inline double corner_jacobian(const Vec3& u, const Vec3& v, const Vec3& w) {
  const double l = std::sqrt(vec::squared(u) * vec::squared(v) * vec::squared(w));
  return l > 0 ? vec::dot(vec::cross(u, v), w) / l : -1.0;
}

[[nodiscard]] inline CornerShape corner_shape(const Vec3& u, const Vec3& v, const Vec3& w) {
  CornerShape c;
  const double lu = vec::length(u), lv = vec::length(v), lw = vec::length(w);
  c.by.fill(Vec3(0, 0, 0));
  if (!(lu > 0 && lv > 0 && lw > 0)) return c;
  const Vec3 a = vec::scaled(1 / lu, u), b = vec::scaled(1 / lv, v), d = vec::scaled(1 / lw, w);
  const Vec3 bd = vec::cross(b, d), da = vec::cross(d, a), ab = vec::cross(a, b);
  c.s = vec::dot(ab, d);
  c.by[0] = vec::scaled(1 / lu, vec::along(bd, -c.s, a));
  c.by[1] = vec::scaled(1 / lv, vec::along(da, -c.s, b));
  c.by[2] = vec::scaled(1 / lw, vec::along(ab, -c.s, d));
  return c;
}

template <HexGuide Guide>
class HexImprover {
 public:
  HexImprover(HexComplex& hexes, Guide& guide, const HexImproveOptions& options)
      : x_(hexes.nodes),
        cells_(hexes.cells),
        border_(hexes.border),
        sites_(hexes.sites),
        guide_(guide),
        options_(options) {
    around();
    find_depth();
    neighbours();
  }

  HexImproveReport run() {
    for (Index n = 0; n < count(); ++n)
      if (!sites_[at(n)].inside()) x_[at(n)] = guide_.placed(n, x_[at(n)]);
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) average();
    for (int pass = 0; pass < options_.passes; ++pass)
      if (raise() == 0) break;
    return report_;
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index count() const { return static_cast<Index>(x_.size()); }

  void around() {
    rows_.offset.assign(x_.size() + 1, 0);
    for (const auto& c : cells_)
      for (const Index n : c) ++rows_.offset[at(n) + 1];
    for (std::size_t n = 1; n < rows_.offset.size(); ++n) rows_.offset[n] += rows_.offset[n - 1];
    rows_.item.resize(8 * cells_.size());
    std::vector<Index> next(rows_.offset.begin(), rows_.offset.end() - 1);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (const Index n : cells_[c]) rows_.item[at(next[at(n)]++)] = static_cast<Index>(c);
  }

  /// Nodes within some cells of the border, in ascending order.
  void find_depth() {
    std::vector<int> depth(x_.size(), -1);
    std::vector<Index> front;
    for (Index n = 0; n < count(); ++n)
      if (!sites_[at(n)].inside()) depth[at(n)] = 0, front.push_back(n);
    for (int d = 1; d <= options_.depth; ++d) {
      std::vector<Index> next;
      for (const Index n : front)
        for (const Index c : rows_[n])
          for (const Index m : cells_[at(c)])
            if (depth[at(m)] < 0) depth[at(m)] = d, next.push_back(m);
      front = std::move(next);
    }
    for (Index n = 0; n < count(); ++n)
      if (depth[at(n)] >= 0) moving_.push_back(n);
  }

  /// Of a node inside: all that an edge joins to it; of one on the surface those on the surface.
  void neighbours() {
    std::vector<std::vector<Index>> of(x_.size());
    const auto join = [&](Index a, Index b) {
      auto& list = of[at(a)];
      if (std::find(list.begin(), list.end(), b) == list.end()) list.push_back(b);
    };
    for (const auto& q : border_)
      for (std::size_t k = 0; k < 4; ++k) join(q[k], q[(k + 1) % 4]), join(q[(k + 1) % 4], q[k]);
    for (const Index n : moving_) {
      if (!sites_[at(n)].inside()) continue;
      for (const Index c : rows_[n]) {
        const auto& cell = cells_[at(c)];
        const auto k = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), n) - cell.begin());
        for (const int m : mesh::hex_corner_axes[k]) join(n, cell[static_cast<std::size_t>(m)]);
      }
    }
    near_.offset.assign(1, 0);
    for (const auto& list : of) {
      near_.item.insert(near_.item.end(), list.begin(), list.end());
      near_.offset.push_back(static_cast<Index>(near_.item.size()));
    }
  }

  void average() {
    for (const Index n : moving_) {
      const auto near = near_[n];
      if (near.empty()) continue;
      Vec3 sum(0, 0, 0);
      for (const Index m : near) sum = vec::plus(sum, x_[at(m)]);
      x_[at(n)] = guide_.placed(n, vec::divided(sum, static_cast<double>(near.size())));
    }
  }

  /// Visits the edges (u, v, w) of the corners that a node is part of, and which of them end in it (-1: all
  /// begin there).
  template <class Visit>
  void corners(Index n, Visit&& visit) const {
    for (const Index c : rows_[n]) {
      const auto& cell = cells_[at(c)];
      const auto k = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), n) - cell.begin());
      const auto edges = [&](std::size_t corner, int which) {
        const Vec3& o = x_[at(cell[corner])];
        const auto& ax = mesh::hex_corner_axes[corner];
        visit(vec::minus(x_[at(cell[static_cast<std::size_t>(ax[0])])], o),
              vec::minus(x_[at(cell[static_cast<std::size_t>(ax[1])])], o),
              vec::minus(x_[at(cell[static_cast<std::size_t>(ax[2])])], o), which);
      };
      edges(k, -1);
      for (const int m : mesh::hex_corner_axes[k]) {
        const auto& ax = mesh::hex_corner_axes[static_cast<std::size_t>(m)];
        edges(static_cast<std::size_t>(m),
              static_cast<int>(std::find(ax.begin(), ax.end(), static_cast<int>(k)) - ax.begin()));
      }
    }
  }

  /// Sum of the squares by which corners fall short of the target.
  [[nodiscard]] double shortfall(Index n) const {
    double sum = 0;
    corners(n, [&](const Vec3& u, const Vec3& v, const Vec3& w, int) {
      const double r = options_.target - corner_jacobian(u, v, w);
      if (r > 0) sum += r * r;
    });
    return sum;
  }

  /// One Gauss-Newton step on the shortfall, shortened until it falls.
  bool improve(Index n) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();  // sum g g^T, symmetric positive semidefinite
    Vec3 b(0, 0, 0);
    double before = 0, size = 0;
    int sides = 0;
    corners(n, [&](const Vec3& u, const Vec3& v, const Vec3& w, int which) {
      const CornerShape c = corner_shape(u, v, w);
      if (which < 0) size += vec::length(u) + vec::length(v) + vec::length(w), sides += 3;
      const double r = options_.target - c.s;
      if (!(r > 0)) return;
      before += r * r;
      const Vec3 g = which < 0 ? vec::scaled(-1, vec::plus(vec::plus(c.by[0], c.by[1]), c.by[2]))
                               : c.by[static_cast<std::size_t>(which)];
      const Vec3 d = guide_.way(n, g);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A(i, j) += d[i] * d[j];
      b = vec::along(b, r, d);
    });
    if (!(before > 0) || sides == 0) return false;
    size /= sides;
    ++report_.visits;
    const double damping = 1e-2 * (A(0, 0) + A(1, 1) + A(2, 2)) + 1e-12 / (size * size);
    for (int i = 0; i < 3; ++i) A(i, i) += damping;
    Vec3 step = solve(A, b);
    const double length = vec::length(step), most = 0.3 * size;
    if (!(length > 1e-6 * size)) return false;
    if (length > most) step = vec::scaled(most / length, step);
    const Vec3 old = x_[at(n)];
    for (int half = 0; half < 4; ++half) {
      x_[at(n)] = guide_.placed(n, vec::plus(old, step));
      if (shortfall(n) < before * (1 - 1e-4)) {
        ++report_.moves;
        return true;
      }
      step = vec::scaled(0.4, step);
    }
    x_[at(n)] = guide_.placed(n, old);
    return false;
  }

  /// Cramer's rule on a symmetric positive definite matrix.
  [[nodiscard]] static Vec3 solve(const Eigen::Matrix3d& A, const Vec3& b) {
    const Vec3 p(A(0, 0), A(0, 1), A(0, 2)), q(A(1, 0), A(1, 1), A(1, 2)), r(A(2, 0), A(2, 1), A(2, 2));
    const Vec3 qr = vec::cross(q, r), rp = vec::cross(r, p), pq = vec::cross(p, q);
    const double det = vec::dot(p, qr);
    if (!(std::abs(det) > 0)) return {0, 0, 0};
    return vec::divided(
        vec::plus(vec::plus(vec::scaled(b[0], qr), vec::scaled(b[1], rp)), vec::scaled(b[2], pq)), det);
  }

  std::size_t raise() {
    std::vector<char> wanted(x_.size(), 0);
    std::size_t low = 0;
    for (const auto& cell : cells_) {
      bool bad = false;
      for (std::size_t k = 0; k < 8 && !bad; ++k) {
        const auto& ax = mesh::hex_corner_axes[k];
        const Vec3& o = x_[at(cell[k])];
        bad = corner_jacobian(vec::minus(x_[at(cell[static_cast<std::size_t>(ax[0])])], o),
                              vec::minus(x_[at(cell[static_cast<std::size_t>(ax[1])])], o),
                              vec::minus(x_[at(cell[static_cast<std::size_t>(ax[2])])], o)) < options_.target;
      }
      if (!bad) continue;
      ++low;
      for (const Index n : cell) wanted[at(n)] = 1;
    }
    std::size_t moved = 0;
    for (Index n = 0; n < count(); ++n)
      if (wanted[at(n)] != 0 && improve(n)) ++moved;
    return moved;
  }

  std::vector<Vec3>& x_;
  const std::vector<std::array<Index, 8>>& cells_;
  const std::vector<std::array<Index, 4>>& border_;
  const std::vector<HexSite>& sites_;
  Guide& guide_;
  const HexImproveOptions options_;
  mesh::Rows rows_, near_;
  std::vector<Index> moving_;
  HexImproveReport report_;
};

}  // namespace detail

/// Moves the nodes of a complex. Those of the surface stay on it.
template <HexGuide Guide>
HexImproveReport improve_hexahedra(HexComplex& hexes, Guide& guide, const HexImproveOptions& options = {}) {
  return detail::HexImprover<Guide>(hexes, guide, options).run();
}

}  // namespace tunica::meshing
