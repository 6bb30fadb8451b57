// SPDX-License-Identifier: MIT
// Grows a sheet of quadrilaterals into what it misses of a surface: blind branches thinner than its edges.
// The quadrilateral below such a branch is inset and drawn out along it, ring by ring, as a square tube.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/quad_fans.hpp"
#include "tunica/meshing/quad_inset.hpp"
#include "tunica/meshing/quad_settle.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct QuadGrowOptions {
  double edge;       // mean edge of the sheet [length]
  double tolerance;  // distance that is aimed at [length]
  int rings = 12;    // at most, for the sake of time
  int failures = 3;  // places to give up before all others are: each costs the trial of some twenty sheets
};

namespace detail {

/// The target farthest from the sheet, and the quadrilateral nearest to it.
struct MissedPlace {
  Vec3 place = Vec3::Zero();
  Index quad = -1;
  double distance = 0;
};
/// The places given up, and all within `apart` of them, do not count.
[[nodiscard]] inline MissedPlace most_missed(const WallQuads& wall, const std::vector<Vec3>& targets,
                                             const std::vector<Vec3>& given_up, double apart) {
  const mesh::Surface fans = fans_of_quads(wall.nodes, wall.cells);
  const TriangleFinder sheet(fans);
  MissedPlace worst;
  for (const Vec3& x : targets) {
    const QuadFoot foot = quad_foot(sheet, x);
    const double distance = vec::distance(foot.point, x);
    const bool open = std::none_of(given_up.begin(), given_up.end(),
                                   [&](const Vec3& y) { return vec::distance(x, y) < apart; });
    if (open && distance > worst.distance) worst = {x, foot.quad, distance};
  }
  return worst;
}

/// A quadrilateral, then those that share a corner with it.
[[nodiscard]] inline std::vector<Index> quads_beside(const WallQuads& wall, Index quad) {
  std::vector<Index> list{quad};
  const mesh::Rows around = mesh::cells_of_nodes(wall.cells, static_cast<Index>(wall.nodes.cols()));
  for (int k = 0; k < 4; ++k)
    for (const Index q : around[wall.cells(k, quad)])
      if (std::find(list.begin(), list.end(), q) == list.end()) list.push_back(q);
  return list;
}

/// Draws an inset out along the way from the middle of its border to a place: by that length, its corners to
/// a share of their distance from the axis, then onto the surface if it is near there.
template <FootSurface S>
void draw_out(WallQuads& wall, const QuadInset& inset, const S& surface, const Vec3& place, double length,
              double near) {
  constexpr double narrow = 0.3;  // of an edge aside: inside of branches that the grid missed
  Vec3 middle = Vec3::Zero();
  const double share = 1 / static_cast<double>(inset.border.size());
  for (const Index n : inset.border) middle = vec::along(middle, share, vec::column(wall.nodes, n));
  const Vec3 axis = vec::unit(vec::minus(place, middle));
  for (std::size_t i = 0; i < inset.inner.size(); ++i) {
    const Vec3 out = vec::minus(vec::column(wall.nodes, inset.border[i]), middle),
               aside = vec::along(out, -vec::dot(out, axis), axis);
    Vec3 x = vec::along(vec::along(middle, length, axis), narrow, aside);
    const Foot foot = surface.nearest_facing(x, vec::unit(aside));
    if (foot.distance < near) x = foot.point;
    vec::set_column(wall.nodes, inset.inner[i], x);
  }
}

struct GrownQuads {
  WallQuads wall;
  double amiss;
};

}  // namespace detail

/// targets: points of the surface that the sheet must come near to; judge(wall): how bad a sheet is, 0 when
/// it needs no more. Keeps each ring that makes it better, settled; where none does the place is given up.
/// Gives the number of rings.
template <FootSurface S, class Judge>
int grow_quads(WallQuads& wall, const S& surface, const Rims& rims, const std::vector<Vec3>& targets,
               const QuadGrowOptions& options, Judge&& judge) {
  // Few rounds tell which places of a ring are worth many.
  constexpr int first_rounds = 4, all_rounds = 40;
  constexpr std::size_t finalists = 3;
  constexpr double reach = 2;   // around the branch, nodes move [edge]: the foot and a ring
  constexpr double onto = 0.5;  // nodes of a new ring as near to the surface are laid on it [edge]
  constexpr std::array<double, 2> parts{0.9, 0.6};  // of the way to the tip: a last ring, or one of two
  double value = judge(wall);
  std::vector<Vec3> given_up;
  int rings = 0;
  while (rings < options.rings && static_cast<int>(given_up.size()) < options.failures) {
    const auto missed = detail::most_missed(wall, targets, given_up, options.edge);
    if (!(value > 0) || !(missed.distance > options.tolerance)) break;
    QuadSettleOptions settle{.tolerance = settle_aim * options.tolerance,
                             .shortest = short_side * options.edge,
                             .rounds = first_rounds,
                             .centre = missed.place,
                             .radius = reach * options.edge + missed.distance};
    std::vector<detail::GrownQuads> tries;
    for (const Index q : detail::quads_beside(wall, missed.quad))
      for (const double part : parts) {
        detail::GrownQuads grown{wall, 0};
        const QuadInset inset = inset_quads(grown.wall, {q});
        const Vec3 x = vec::column(wall.nodes, inset.border[0]), y = vec::column(wall.nodes, inset.border[2]);
        const double way = vec::distance(missed.place, vec::between(x, y, 0.5));
        detail::draw_out(grown.wall, inset, surface, missed.place, std::min(part * way, options.edge),
                         onto * options.edge);
        grown.amiss = settle_quads(grown.wall, surface, rims, targets, settle);
        tries.push_back(std::move(grown));
      }
    std::stable_sort(
        tries.begin(), tries.end(),
        [](const detail::GrownQuads& a, const detail::GrownQuads& b) { return a.amiss < b.amiss; });
    tries.resize(std::min(tries.size(), finalists));
    settle.rounds = all_rounds;
    bool better = false;
    for (detail::GrownQuads& t : tries) {
      (void)settle_quads(t.wall, surface, rims, targets, settle);
      const double now = judge(t.wall);
      if (!(now < value)) continue;
      value = now, wall = std::move(t.wall), better = true;
    }
    if (better)
      ++rings;
    else
      given_up.push_back(missed.place);
  }
  return rings;
}

}  // namespace tunica::meshing
