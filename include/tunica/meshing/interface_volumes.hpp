// SPDX-License-Identifier: MIT
// The volumes of several regions at once: nodes move along the gradients of the volumes by multipliers, one a
// region, that solve a symmetric system (Newton's method: G M^-1 G' lambda = dV).
#pragma once

#include "tunica/meshing/interfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class InterfaceVolumes {
 public:
  /// target[r]: the volume of region r, negative: whatever is left.
  InterfaceVolumes(const Interfaces& s, std::vector<double> target)
      : target_(std::move(target)), offset_(s.nodes.size() + 1, 0) {
    // the regions of each node
    std::vector<std::vector<Index>> of(s.nodes.size());
    for (std::size_t t = 0; t < s.faces.size(); ++t)
      for (const Index n : s.faces[t])
        for (const Index r : s.sides[t])
          if (auto& list = of[static_cast<std::size_t>(n)];
              r >= 0 && target_[static_cast<std::size_t>(r)] >= 0 &&
              std::find(list.begin(), list.end(), r) == list.end())
            list.push_back(r);
    for (std::size_t n = 0; n < of.size(); ++n) {
      region_.insert(region_.end(), of[n].begin(), of[n].end());
      offset_[n + 1] = region_.size();
    }
  }

  /// Largest deviation from a target, relative to it.
  [[nodiscard]] double deviation(const Interfaces& s) const {
    const auto volume = volumes_of(s, target_.size());
    double worst = 0;
    for (std::size_t r = 0; r < target_.size(); ++r)
      if (target_[r] > 0) worst = std::max(worst, std::abs(volume[r] - target_[r]) / target_[r]);
    return worst;
  }

  /// The moves, one a node, that bring the volumes to their targets to first order; none longer than `most`,
  /// none along a frozen coordinate, none of a node with share 0.
  [[nodiscard]] std::vector<Vec3> moves(const Interfaces& s, const std::vector<double>& share, double most) {
    gradients(s, share);
    const auto volume = volumes_of(s, target_.size());
    const std::size_t n = target_.size();
    std::vector<double> lambda(n, 0), r(n, 0), z(n), p(n, 0), q(n), diagonal(n, 0);
    for (std::size_t i = 0; i < n; ++i)
      if (target_[i] >= 0) r[i] = target_[i] - volume[i];
    for (std::size_t node = 0; node < s.nodes.size(); ++node)
      for (std::size_t k = offset_[node]; k < offset_[node + 1]; ++k)
        diagonal[static_cast<std::size_t>(region_[k])] += weight_[node] * vec::squared(gradient_[k]);
    const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
      return sum;
    };
    const auto scaled = [&] {
      for (std::size_t i = 0; i < n; ++i) z[i] = diagonal[i] > 0 ? r[i] / diagonal[i] : 0;
    };
    // Conjugate gradients, preconditioned by the diagonal. The matrix is semi-definite: regions within nodes
    // that all stay have a fixed sum. A small part of the diagonal keeps their multipliers finite.
    constexpr int most_iterations = 500;
    constexpr double regular = 1e-8;
    constexpr double tolerance = 1e-24;  // of the squared residual
    scaled();
    p = z;
    double rho = dot(r, z);
    const double start = rho;
    for (int i = 0; i < most_iterations && rho > tolerance * start; ++i) {
      apply(s, p, q);
      for (std::size_t k = 0; k < n; ++k) q[k] += regular * diagonal[k] * p[k];
      const double curvature = dot(p, q);
      if (!(curvature > 0)) break;
      const double alpha = rho / curvature;
      for (std::size_t k = 0; k < n; ++k) lambda[k] += alpha * p[k], r[k] -= alpha * q[k];
      scaled();
      const double next = dot(r, z), beta = next / rho;
      rho = next;
      for (std::size_t k = 0; k < n; ++k) p[k] = z[k] + beta * p[k];
    }
    std::vector<Vec3> move(s.nodes.size());
    for (std::size_t node = 0; node < move.size(); ++node) {
      const Vec3 d = vec::scaled(weight_[node], combined(node, lambda));
      const double l = vec::length(d);
      move[node] = l > most ? vec::scaled(most / l, d) : d;
    }
    return move;
  }

 private:
  /// dV_r / dx_n = sum of the area vectors of r's triangles at n over 3, outward of r.
  void gradients(const Interfaces& s, const std::vector<double>& share) {
    gradient_.assign(region_.size(), Vec3(0, 0, 0));
    weight_.assign(s.nodes.size(), 0);
    for (std::size_t t = 0; t < s.faces.size(); ++t) {
      const Vec3 a = vec::divided(s.triangle(t).area_vector(), 3);
      const double area = vec::length(a);
      for (const Index node : s.faces[t]) {
        const auto m = static_cast<std::size_t>(node);
        weight_[m] += area;
        for (std::size_t k = offset_[m]; k < offset_[m + 1]; ++k)
          for (std::size_t side = 0; side < 2; ++side)
            if (region_[k] == s.sides[t][side])
              gradient_[k] = vec::along(gradient_[k], side == 0 ? 1 : -1, a);
      }
    }
    for (std::size_t m = 0; m < s.nodes.size(); ++m) {
      weight_[m] = weight_[m] > 0 ? share[m] / weight_[m] : 0;
      for (std::size_t k = offset_[m]; k < offset_[m + 1]; ++k)
        for (int a = 0; a < 3; ++a)
          if ((s.frozen[m] >> a & 1) != 0) gradient_[k][a] = 0;
    }
  }
  [[nodiscard]] Vec3 combined(std::size_t node, const std::vector<double>& x) const {
    Vec3 sum(0, 0, 0);
    for (std::size_t k = offset_[node]; k < offset_[node + 1]; ++k)
      sum = vec::along(sum, x[static_cast<std::size_t>(region_[k])], gradient_[k]);
    return sum;
  }
  void apply(const Interfaces& s, const std::vector<double>& x, std::vector<double>& y) const {
    std::fill(y.begin(), y.end(), 0);
    for (std::size_t node = 0; node < s.nodes.size(); ++node) {
      const Vec3 d = vec::scaled(weight_[node], combined(node, x));
      for (std::size_t k = offset_[node]; k < offset_[node + 1]; ++k)
        y[static_cast<std::size_t>(region_[k])] += vec::dot(gradient_[k], d);
    }
  }

  std::vector<double> target_;
  std::vector<std::size_t> offset_;
  std::vector<Index> region_;   // of each node, offset_[n] .. offset_[n + 1] - 1
  std::vector<Vec3> gradient_;  // beside it
  std::vector<double> weight_;  // of each node: share over a third of the area around it
};

}  // namespace tunica::meshing
