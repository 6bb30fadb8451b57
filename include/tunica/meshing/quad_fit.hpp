// SPDX-License-Identifier: MIT
// Levels a sheet of quadrilaterals with the surface that it stands for: both ways, on the average, and within
// a tolerance of each other. Minimises sum (e r^2 + max(0, |r| - tau)^2) over distances r by moves of the
// nodes along their normals: convex once linearised, so Gauss-Seidel sweeps cannot diverge.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/quad_fans.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

struct QuadFitOptions {
  double tolerance;           // tau, distances beyond it count in full [length]
  double level = 0.02;        // e, weight of all distances
  int rounds = 2;             // of measuring distances
  double least_corner = 0.4;  // sine of a corner below which no move may make it worse
};

namespace detail {

template <FootSurface S>
class QuadFitter {
 public:
  QuadFitter(WallQuads& wall, const S& surface, const std::vector<Vec3>& targets,
             const QuadFitOptions& options)
      : wall_(wall),
        surface_(surface),
        targets_(targets),
        options_(options),
        around_(mesh::cells_of_nodes(wall.cells, count())),
        fixed_(at(count()), 0),
        normal_(at(count()), Vec3::Zero()),
        step_(at(count()), 0) {
    for (const auto& loop : wall.loops)
      for (const Index n : loop) fixed_[at(n)] = 1;
    for (Index q = 0; q < static_cast<Index>(wall.cells.cols()); ++q) {
      add(q, {0.25, 0.25, 0.25, 0.25});
      for (int k = 0; k < 4; ++k) {
        const Index a = node(q, k), b = node(q, k + 1);
        Weights w{};
        w[at(k)] = 1;
        if (fixed_[at(a)] == 0 && around_[a][0] == q) add(q, w);
        w[at(k)] = w[at((k + 1) % 4)] = 0.5;
        if (a < b && !(fixed_[at(a)] != 0 && fixed_[at(b)] != 0)) add(q, w);
      }
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
      samples_.push_back({-1, {}, 0, {}});
      samples_.back().target = static_cast<Index>(i);
    }
  }

  /// Measures what is not surely near, moves the nodes; the largest distance that was found.
  double round() {
    const double worst = measure();
    collect();
    std::fill(step_.begin(), step_.end(), 0.0);
    constexpr int sweeps = 8;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (Index n = 0; n < count(); ++n)
        if (fixed_[at(n)] == 0) relax(n);
    move();
    return worst;
  }

 private:
  using Weights = std::array<double, 4>;
  struct Sample {
    Index quad;
    Weights weights;    // of its corners
    double distance;    // signed, along the direction
    Weights gain;       // how much a step of a corner along its normal takes off the distance
    Index target = -1;  // number of the target, -1: a place of the sheet
    bool known = false;
  };

  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index count() const { return static_cast<Index>(wall_.nodes.cols()); }
  [[nodiscard]] Index node(Index q, int k) const { return wall_.cells(k % 4, q); }
  [[nodiscard]] Vec3 corner(Index q, int k) const { return vec::column(wall_.nodes, node(q, k)); }
  [[nodiscard]] Vec3 normal(Index q) const {
    return vec::unit(
        vec::cross(vec::minus(corner(q, 2), corner(q, 0)), vec::minus(corner(q, 3), corner(q, 1))));
  }
  void add(Index q, const Weights& w) { samples_.push_back({q, w, 0, {}}); }

  double measure() {
    for (Index n = 0; n < count(); ++n) {
      Vec3 sum = Vec3::Zero();
      for (const Index q : around_[n])
        sum += vec::cross(vec::minus(corner(q, 2), corner(q, 0)), vec::minus(corner(q, 3), corner(q, 1)));
      normal_[at(n)] = vec::unit(sum);
    }
    const mesh::Surface fans = fans_of_quads(wall_.nodes, wall_.cells);
    const TriangleFinder sheet(fans);
    double worst = 0;
    for (Sample& s : samples_) {
      if (s.known && std::abs(s.distance) < 0.5 * options_.tolerance) continue;
      Vec3 way, normal_there;
      if (s.target < 0) {
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < 4; ++k) x = vec::along(x, s.weights[at(k)], corner(s.quad, k));
        const Foot foot = surface_.nearest_facing(x, normal(s.quad));
        way = vec::minus(foot.point, x), normal_there = foot.normal;
      } else {
        const Vec3& x = targets_[at(s.target)];
        const QuadFoot foot = quad_foot(sheet, x);
        s.quad = foot.quad, s.weights = foot.weights;
        way = vec::minus(x, foot.point), normal_there = normal(s.quad);
      }
      const double far = vec::length(way);
      worst = std::max(worst, far);
      const double sign = vec::dot(way, normal_there) < 0 ? -1 : 1;
      const Vec3 direction = far > 1e-3 * options_.tolerance ? vec::scaled(sign / far, way) : normal_there;
      s.distance = sign * far, s.known = true;
      for (int k = 0; k < 4; ++k)
        s.gain[at(k)] = s.weights[at(k)] * vec::dot(normal_[at(node(s.quad, k))], direction);
    }
    return worst;
  }

  /// The samples that each node has a hand in.
  void collect() {
    first_.assign(at(count()) + 1, 0);
    for (const Sample& s : samples_)
      for (int k = 0; k < 4; ++k)
        if (s.gain[at(k)] != 0) ++first_[at(node(s.quad, k)) + 1];
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    touched_.resize(first_.back());
    auto next = first_;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        if (samples_[i].gain[k] != 0)
          touched_[next[at(node(samples_[i].quad, static_cast<int>(k)))]++] = {i, k};
  }

  /// One Newton step for the node's own offset.
  void relax(Index n) {
    double slope = 0, bend = 0;
    for (std::size_t t = first_[at(n)]; t < first_[at(n) + 1]; ++t) {
      const Sample& s = samples_[touched_[t].sample];
      const double g = s.gain[touched_[t].corner], r = s.distance;
      const double excess = std::max(0.0, std::abs(r) - options_.tolerance);
      slope += g * (options_.level * r + std::copysign(excess, r));
      bend += g * g * (options_.level + (excess > 0 ? 1 : 0));
    }
    if (!(bend > 0)) return;
    shift(n, slope / bend);
  }

  void shift(Index n, double step) {
    step_[at(n)] += step;
    for (std::size_t t = first_[at(n)]; t < first_[at(n) + 1]; ++t)
      samples_[touched_[t].sample].distance -= samples_[touched_[t].sample].gain[touched_[t].corner] * step;
  }

  /// Carries the steps out, save those that would spoil a corner.
  void move() {
    for (Index n = 0; n < count(); ++n) {
      if (step_[at(n)] == 0) continue;
      const Vec3 before = vec::column(wall_.nodes, n);
      const double corner_before = worst_corner(n);
      vec::set_column(wall_.nodes, n, vec::along(before, step_[at(n)], normal_[at(n)]));
      if (worst_corner(n) >= std::min(options_.least_corner, corner_before)) continue;
      vec::set_column(wall_.nodes, n, before);
      shift(n, -step_[at(n)]);
    }
  }

  /// Least sine of the corners of the faces around a node, about the faces' normals.
  [[nodiscard]] double worst_corner(Index n) const {
    double worst = 1;
    for (const Index q : around_[n]) {
      const Vec3 m = normal(q);
      for (int k = 0; k < 4; ++k) {
        const Vec3 u = vec::minus(corner(q, k + 1), corner(q, k)),
                   v = vec::minus(corner(q, k + 3), corner(q, k));
        const double size = vec::length(u) * vec::length(v);
        worst = std::min(worst, size > 0 ? vec::dot(vec::cross(u, v), m) / size : 0);
      }
    }
    return worst;
  }

  struct Touch {
    std::size_t sample, corner;
  };
  WallQuads& wall_;
  const S& surface_;
  const std::vector<Vec3>& targets_;
  const QuadFitOptions options_;
  mesh::Rows around_;
  std::vector<char> fixed_;
  std::vector<Vec3> normal_;
  std::vector<double> step_;
  std::vector<Sample> samples_;
  std::vector<std::size_t> first_;
  std::vector<Touch> touched_;
};

}  // namespace detail

/// targets: points of the surface that the sheet must come near to. Nodes on the rims stay.
template <FootSurface S>
void fit_quads(WallQuads& wall, const S& surface, const std::vector<Vec3>& targets,
               const QuadFitOptions& options) {
  detail::QuadFitter<S> fitter(wall, surface, targets, options);
  for (int round = 0; round < options.rounds; ++round) fitter.round();
}

}  // namespace tunica::meshing
