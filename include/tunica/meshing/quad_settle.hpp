// SPDX-License-Identifier: MIT
// Settles the nodes of a sheet of quadrilaterals where it lies farther from a surface than a tolerance, or
// the surface from it: each node there tries steps to all sides and keeps the best, for the distances around
// it and for the cells that an extrusion will raise on it. Nothing moves where nothing is amiss.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/quad_adjacency.hpp"
#include "tunica/meshing/quad_columns.hpp"
#include "tunica/meshing/quad_face.hpp"
#include "tunica/meshing/quad_misfit.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::meshing {

/// Of the mean edge: below 0.15 the corners of the cells turn over when the wall bends; a side just as long
/// as this costs nothing, so that some end a little below it.
inline constexpr double short_side = 0.16;

/// Of a tolerance: what settling aims at, so that what it just misses is still within.
inline constexpr double settle_aim = 0.9;

struct QuadSettleOptions {
  double tolerance;  // distance from which on places count [length]
  // Quality of a column, a scaled Jacobian; the cells extruded on it lose up to a third, and 0.3 is good.
  double sound = 0.45;                                      // from which on it does not count
  double hold = 0.35;                                       // below which no move may make it worse
  double shortest = 0;                                      // side from which on it does not count [length]
  int finer = 1;                                            // see QuadMisfit
  int rounds = 40;                                          // over the nodes, at most
  Vec3 centre = Vec3::Zero();                               // only nodes this near to it move, and only
  double radius = std::numeric_limits<double>::infinity();  // what is as near is looked at [length]
};

namespace detail {

template <FootSurface S>
class QuadSettler {
 public:
  QuadSettler(WallQuads& wall, const S& surface, const Rims& rims, const std::vector<Vec3>& targets,
              const QuadSettleOptions& options)
      : wall_(wall),
        options_(options),
        reach_(in_reach()),
        columns_(wall, rims),
        misfit_(wall, surface, near(targets), options.tolerance, reach_, options.finer),
        neighbours_(quad_neighbours(wall.cells, count())),
        rim_(at(count()), nullptr),
        along_(at(count()), nullptr),
        step_(at(count()), first_step) {
    for (std::size_t r = 0; r < wall.loops.size(); ++r)
      for (std::size_t i = 0; i < wall.loops[r].size(); ++i)
        rim_[at(wall.loops[r][i])] = &rims.curves[r], along_[at(wall.loops[r][i])] = &wall.along[r][i];
  }

  /// One pass over the nodes around which distances are amiss; whether it can go on.
  bool round() {
    std::vector<char> amiss(at(count()), 0);
    misfit_.mark(amiss);
    bool any = false;
    for (Index n = 0; n < count(); ++n)
      if ((amiss[at(n)] != 0 || sides(n, node(n)) > 0) && reach_[at(n)] != 0 && step_[at(n)] >= last_step)
        any = settle(n) || any;
    return any;
  }

  /// What is amiss: distances, columns that are not sound, and short sides.
  [[nodiscard]] double amiss() const {
    double sum = misfit_.sum();
    for (Index n = 0; n < count(); ++n)
      if (reach_[at(n)] != 0) sum += shape(column(n)) + sides(n, node(n));
    return sum;
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index count() const { return static_cast<Index>(wall_.nodes.cols()); }
  [[nodiscard]] Vec3 node(Index n) const { return vec::column(wall_.nodes, n); }
  [[nodiscard]] bool near(const Vec3& x) const { return vec::distance(x, options_.centre) < options_.radius; }
  [[nodiscard]] std::vector<Vec3> near(const std::vector<Vec3>& all) const {
    std::vector<Vec3> list;
    for (const Vec3& x : all)
      if (near(x)) list.push_back(x);
    return list;
  }
  [[nodiscard]] std::vector<char> in_reach() const {
    std::vector<char> reach;
    for (Index n = 0; n < count(); ++n) reach.push_back(near(node(n)) ? 1 : 0);
    return reach;
  }

  [[nodiscard]] double column(Index n) const { return columns_.quality(n, options_.sound); }
  [[nodiscard]] double shape(double column) const {
    const double lack = 1 - column / options_.sound;
    return lack > 0 ? shape_weight * lack * lack : 0;
  }

  /// The corners of a node's faces, and the quality below which their columns must not fall.
  struct Feet {
    std::vector<Index> nodes;
    std::vector<double> held;
  };
  [[nodiscard]] Feet feet(const std::vector<Index>& faces) const {
    Feet feet;
    for (const Index q : faces)
      for (int k = 0; k < 4; ++k) {
        const Index m = wall_.cells(k, q);
        if (std::find(feet.nodes.begin(), feet.nodes.end(), m) == feet.nodes.end()) feet.nodes.push_back(m);
      }
    for (const Index m : feet.nodes) feet.held.push_back(std::min(options_.hold, column(m)));
    return feet;
  }
  /// Infinite where a column is spoilt.
  [[nodiscard]] double shape(const Feet& feet) const {
    double sum = 0;
    for (std::size_t i = 0; i < feet.nodes.size(); ++i) {
      const double quality = column(feet.nodes[i]);
      if (quality < feet.held[i]) return std::numeric_limits<double>::infinity();
      sum += shape(quality);
    }
    return sum;
  }

  /// Of the sides from a place for node n to its neighbours that are too short.
  [[nodiscard]] double sides(Index n, const Vec3& x) const {
    double sum = 0;
    for (const Index m : neighbours_[n]) {
      const double lack = options_.shortest - vec::distance(x, node(m));
      if (lack > 0) sum += shape_weight * lack * lack / (options_.shortest * options_.shortest);
    }
    return sum;
  }

  /// Sum of the area vectors of the faces, normalised.
  [[nodiscard]] Vec3 normal(const std::vector<Index>& faces) const {
    Vec3 sum = Vec3::Zero();
    for (const Index q : faces) {
      const QuadFace f = quad_face(wall_.nodes, wall_.cells, q);
      sum = vec::plus(sum, vec::cross(vec::minus(f.x[2], f.x[0]), vec::minus(f.x[3], f.x[1])));
    }
    return vec::unit(sum);
  }

  /// Moves a node to the best of a few places around it; whether it moved or may yet with shorter steps.
  bool settle(Index n) {
    constexpr double gain = 1e-3;  // least, of what is amiss: smaller ones would go on for ever
    const auto around = misfit_.around(n);
    const Feet below = feet(around.faces);
    const double unbounded = std::numeric_limits<double>::infinity(),
                 before = shape(below) + sides(n, node(n)) + misfit_.sum(around, 0, unbounded);
    if (!(before > 0)) return false;
    const Vec3 start = node(n);
    Vec3 best_x = start, mean = Vec3::Zero();
    double best = before * (1 - gain), h = unbounded;
    bool moved = false;
    const auto attempt = [&](const Vec3& x) {
      vec::set_column(wall_.nodes, n, x);
      double e = shape(below) + sides(n, x);
      if (e < best) e += misfit_.sum(around, vec::distance(x, start), best - e);
      if (!(e < best)) return false;
      best = e, best_x = x;
      return moved = true;
    };
    const double share = 1 / static_cast<double>(neighbours_[n].size());
    for (const Index m : neighbours_[n]) {
      mean = vec::along(mean, share, node(m));
      h = std::min(h, step_[at(n)] * std::max(vec::distance(start, node(m)), options_.shortest));
    }
    if (rim_[at(n)] != nullptr) {
      const double from = *along_[at(n)];
      for (const double s : {h, -h})
        if (attempt(rim_[at(n)]->at(from + s))) *along_[at(n)] = from + s;
    } else if (const Vec3 up = normal(around.faces); vec::length(up) > 0) {
      const Vec3 u = vec::orthogonal(up), v = vec::cross(up, u), a = vec::unit(vec::plus(u, v)),
                 b = vec::unit(vec::minus(u, v));
      for (const Vec3& way : {up, u, v, a, b})
        for (const double s : {h, -h}) attempt(vec::along(start, s, way));
      attempt(vec::between(start, mean, step_[at(n)]));
    }
    vec::set_column(wall_.nodes, n, best_x);
    if (!moved) {
      step_[at(n)] *= shorter;
      return step_[at(n)] >= last_step;
    }
    misfit_.update(around);
    for (const Index m : below.nodes) step_[at(m)] = std::max(step_[at(m)], awake);
    return true;
  }

  // Steps [shortest edge at the node]: from a quarter, which turns no face over, down to where it is settled;
  // a node beside one that moved gets one more try.
  static constexpr double first_step = 0.25, last_step = 0.01, shorter = 0.5, awake = 2 * last_step;
  // A column without any height, or a side without length, weighs as much as 20 places at twice the
  // tolerance: about those of a face.
  static constexpr double shape_weight = 20;

  WallQuads& wall_;
  const QuadSettleOptions options_;
  const std::vector<char> reach_;
  QuadColumns columns_;
  QuadMisfit<S> misfit_;
  mesh::Rows neighbours_;
  std::vector<const RimCurve*> rim_;  // of a node, or none
  std::vector<double*> along_;        // where the node is on it
  std::vector<double> step_;
};

}  // namespace detail

/// targets: points of the surface that the sheet must come near to. Nodes on rims slide on them. Gives what
/// is still amiss: 0 where sheet and targets are within the tolerance and all columns sound.
template <FootSurface S>
double settle_quads(WallQuads& wall, const S& surface, const Rims& rims, const std::vector<Vec3>& targets,
                    const QuadSettleOptions& options) {
  detail::QuadSettler<S> settler(wall, surface, rims, targets, options);
  for (int round = 0; round < options.rounds && settler.round(); ++round) {
  }
  return settler.amiss();
}

}  // namespace tunica::meshing
