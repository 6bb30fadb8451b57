// SPDX-License-Identifier: MIT
// By how much the cells around a node fall short of a scaled Jacobian, and the step of the node that
// mends most of it.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/hex_graph.hpp"
#include "tunica/meshing/hex_guide.hpp"
#include "tunica/meshing/hex_jacobian.hpp"
#include "tunica/meshing/hex_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// Where scaled Jacobians are looked at: at the corners, at the centre too, or at all of hex_points.
enum class HexPlaces { corners, centre, all };

/// What counts as short.
struct HexGoal {
  double jacobian = 0;  // of a corner
  double side = 0;      // below which an edge is short [length]
  HexPlaces places = HexPlaces::corners;
  bool worst = false;  // fourth powers are summed instead of squares
};

/// E = sum (goal - s)^2 over the corners with s below the goal, + sum (1 - l / side)^2 over short edges.
template <HexGuide Guide>
class HexShortfall {
 public:
  HexShortfall(std::vector<Vec3>& x, const std::vector<HexNodes>& cells, const HexGraph& graph, Guide& guide)
      : x_(x), cells_(cells), graph_(graph), guide_(guide) {}

  HexGoal goal;

  [[nodiscard]] bool falls_short(Index c) const {
    const auto& cell = cells_[at(c)];
    for (std::size_t k = 0; k < 8; ++k) {
      const auto e = corner_edges(x_, cell, k);
      if (!(corner_jacobian(e[0], e[1], e[2]) >= goal.jacobian)) return true;
    }
    for (std::size_t p = 0; p < 27; ++p) {
      if (!looked_at(p)) continue;
      const auto e = point_edges(x_, cell, p);
      if (!(corner_jacobian(e[0], e[1], e[2]) >= goal.jacobian)) return true;
    }
    return false;
  }

  /// One Gauss-Newton step of the node, no longer than `most`, shortened until E falls while the node stays
  /// within `reach` of `start`. Whether it moved.
  bool step(Index n, double most, const Vec3& start, double reach) {
    const System s = system(n);
    if (!(s.sum > 0)) return false;
    Vec3 way = s.solution();
    most = std::min(most, largest_step * s.size);
    const double length = vec::length(way);
    if (!(length > 1e-6 * s.size)) return false;
    if (length > most) way = vec::scaled(most / length, way);
    const Vec3 old = x_[at(n)];
    for (int trial = 0; trial < trials; ++trial) {
      x_[at(n)] = guide_.placed(n, vec::plus(old, way));
      if (vec::distance(x_[at(n)], start) < reach && sum(n) < s.sum * (1 - least_gain)) return true;
      way = vec::scaled(shortening, way);
    }
    x_[at(n)] = guide_.placed(n, old);
    return false;
  }

 private:
  static constexpr double largest_step = 0.3;  // of the mean edge at the node
  static constexpr int trials = 4;
  static constexpr double shortening = 0.4, least_gain = 1e-4, damping = 1e-2;
  using Weights = std::array<double, 3>;

  /// The normal equations A d = b of the shortfalls r_i with gradients g_i: A = sum w g g^T, symmetric
  /// positive semidefinite, b = sum w r g.
  struct System {
    std::array<Vec3, 3> A{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
    Vec3 b{0, 0, 0};
    double sum = 0, size = 0;  // E, and the mean length of the edges at the node

    void add(double r, double weight, const Vec3& g) {
      sum += weight * r * r;
      for (std::size_t i = 0; i < 3; ++i)
        A[i] = vec::along(A[i], weight * g[static_cast<Eigen::Index>(i)], g);
      b = vec::along(b, weight * r, g);
    }

    /// Damped, by Cramer's rule.
    [[nodiscard]] Vec3 solution() const {
      const double more = damping * (A[0][0] + A[1][1] + A[2][2]) + 1e-12 / (size * size);
      const Vec3 p(A[0][0] + more, A[0][1], A[0][2]), q(A[1][0], A[1][1] + more, A[1][2]),
          r(A[2][0], A[2][1], A[2][2] + more);
      const Vec3 qr = vec::cross(q, r), rp = vec::cross(r, p), pq = vec::cross(p, q);
      const double det = vec::dot(p, qr);
      if (!(std::abs(det) > 0)) return {0, 0, 0};
      return vec::divided(
          vec::plus(vec::plus(vec::scaled(b[0], qr), vec::scaled(b[1], rp)), vec::scaled(b[2], pq)), det);
    }
  };

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] bool looked_at(std::size_t p) const {
    return goal.places == HexPlaces::all ? !is_hex_corner(p)
                                         : goal.places == HexPlaces::centre && p == hex_centre;
  }

  /// Visits the derivatives of the map at the places that the node is part of; by: how they change with the
  /// node; own: it is the corner where they are taken.
  template <class Visit>
  void places(Index n, Visit&& visit) const {
    for (const Index c : graph_.cells(n)) {
      const auto& cell = cells_[at(c)];
      const auto k = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), n) - cell.begin());
      visit(corner_edges(x_, cell, k), Weights{-1, -1, -1}, true);
      for (const int m : mesh::hex_corner_axes[k]) {
        const auto corner = static_cast<std::size_t>(m);
        const auto& ax = mesh::hex_corner_axes[corner];
        Weights by{};
        for (std::size_t a = 0; a < 3; ++a) by[a] = ax[a] == static_cast<int>(k) ? 1 : 0;
        visit(corner_edges(x_, cell, corner), by, false);
      }
      if (goal.places == HexPlaces::corners) continue;
      for (std::size_t p = 0; p < 27; ++p)
        if (looked_at(p))
          visit(point_edges(x_, cell, p),
                Weights{hex_points.by[p][0][k], hex_points.by[p][1][k], hex_points.by[p][2][k]}, false);
    }
  }

  [[nodiscard]] double sum(Index n) const {
    double sum = 0;
    places(n, [&](const std::array<Vec3, 3>& e, const Weights&, bool own) {
      const double r = goal.jacobian - corner_jacobian(e[0], e[1], e[2]);
      if (r > 0) sum += goal.worst ? r * r * r * r : r * r;
      if (!own) return;
      for (const Vec3& side : e) {
        const double square = vec::squared(side);
        if (square >= goal.side * goal.side) continue;
        const double q = 1 - std::sqrt(square) / goal.side;
        sum += q * q;
      }
    });
    return sum;
  }

  [[nodiscard]] System system(Index n) {
    System s;
    int sides = 0;
    places(n, [&](const std::array<Vec3, 3>& e, const Weights& by, bool own) {
      if (own) {
        sides += 3;
        for (const Vec3& side : e) {
          const double l = vec::length(side);
          s.size += l;
          if (l < goal.side && l > 0)
            s.add(1 - l / goal.side, 1, guide_.way(n, vec::scaled(-1 / (l * goal.side), side)));
        }
      }
      const CornerShape c = corner_shape(e[0], e[1], e[2]);
      const double r = goal.jacobian - c.s;
      if (!(r > 0)) return;
      Vec3 g(0, 0, 0);
      for (std::size_t a = 0; a < 3; ++a)
        if (by[a] != 0) g = vec::along(g, by[a], c.by[a]);
      s.add(r, goal.worst ? r * r : 1, guide_.way(n, g));
    });
    s.size /= std::max(sides, 1);
    return s;
  }

  std::vector<Vec3>& x_;
  const std::vector<HexNodes>& cells_;
  const HexGraph& graph_;
  Guide& guide_;
};

}  // namespace tunica::meshing::detail
