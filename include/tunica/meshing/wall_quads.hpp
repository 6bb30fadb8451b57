// SPDX-License-Identifier: MIT
// The quadrilaterals of the wall, cut out of a closed contour: one sheet whose rims are simple loops,
// each with a layer of quadrilaterals of its own, so that no cell has two sides on a rim.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/quad_adjacency.hpp"
#include "tunica/meshing/rim_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A sheet of quadrilaterals with one loop of nodes for each rim, run with the sheet on its left.
struct WallQuads {
  Points<3> nodes;
  Connectivity<4> cells;
  std::vector<std::vector<Index>> loops;   // in the order of the rims
  std::vector<std::vector<double>> along;  // where the nodes of the loops are on their rims [length]
  Index dropped = 0;  // quadrilaterals of the wall left out because they hung by a corner
};

namespace detail {

/// Which quadrilaterals of region 0 make one sheet without corners that touch.
class WallSelection {
 public:
  WallSelection(const mesh::QuadSurface& contour, std::vector<Index> twin)
      : cells_(contour.cells),
        around_(mesh::cells_of_nodes(contour.cells, contour.node_count())),
        twin_(std::move(twin)) {
    for (Index q = 0; q < contour.cell_count(); ++q) kept_.push_back(contour.region_of(q) == 0);
    const auto before = std::count(kept_.begin(), kept_.end(), true);
    while (drop_small_parts() || drop_fans() || drop_slivers()) {
    }
    dropped_ = static_cast<Index>(before - std::count(kept_.begin(), kept_.end(), true));
  }

  [[nodiscard]] bool kept(Index q) const { return kept_[static_cast<std::size_t>(q)]; }
  [[nodiscard]] Index dropped() const { return dropped_; }
  [[nodiscard]] bool on_rim(Index half_edge) const {
    return kept(half_edge / 4) && !kept(twin_[static_cast<std::size_t>(half_edge)] / 4);
  }

 private:
  /// The sets of the listed quadrilaterals that edges join; only edges at `node` if it is not -1.
  [[nodiscard]] std::vector<std::vector<Index>> parts(const std::vector<Index>& list, Index node) const {
    std::vector<char> open(kept_.size(), 0);
    for (const Index q : list) open[static_cast<std::size_t>(q)] = 1;
    std::vector<std::vector<Index>> all;
    for (const Index seed : list) {
      if (open[static_cast<std::size_t>(seed)] == 0) continue;
      std::vector<Index> part{seed};
      open[static_cast<std::size_t>(seed)] = 0;
      for (std::size_t i = 0; i < part.size(); ++i)
        for (int k = 0; k < 4; ++k) {
          const Index q = part[i];
          if (node >= 0 && cells_(k, q) != node && cells_((k + 1) % 4, q) != node) continue;
          const Index other = twin_[static_cast<std::size_t>(4 * q + k)] / 4;
          if (open[static_cast<std::size_t>(other)] == 0) continue;
          open[static_cast<std::size_t>(other)] = 0;
          part.push_back(other);
        }
      all.push_back(std::move(part));
    }
    return all;
  }

  bool drop_all_but_largest(const std::vector<std::vector<Index>>& parts) {
    if (parts.size() < 2) return false;
    std::size_t largest = 0;
    for (std::size_t p = 1; p < parts.size(); ++p)
      if (parts[p].size() > parts[largest].size()) largest = p;
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (p != largest)
        for (const Index q : parts[p]) kept_[static_cast<std::size_t>(q)] = false;
    return true;
  }

  bool drop_small_parts() {
    std::vector<Index> list;
    for (Index q = 0; q < static_cast<Index>(kept_.size()); ++q)
      if (kept(q)) list.push_back(q);
    return drop_all_but_largest(parts(list, -1));
  }

  bool drop_fans() {
    bool changed = false;
    for (Index n = 0; n < around_.size(); ++n) {
      std::vector<Index> list;
      bool inside = true;
      for (const Index q : around_[n]) {
        if (kept(q))
          list.push_back(q);
        else
          inside = false;
      }
      if (!inside && list.size() > 1) changed = drop_all_but_largest(parts(list, n)) || changed;
    }
    return changed;
  }

  /// Three sides on the rim: its fourth side becomes the rim.
  bool drop_slivers() {
    bool changed = false;
    for (Index q = 0; q < static_cast<Index>(kept_.size()); ++q) {
      if (!kept(q)) continue;
      int sides = 0;
      for (int k = 0; k < 4; ++k) sides += on_rim(4 * q + k) ? 1 : 0;
      if (sides < 3) continue;
      kept_[static_cast<std::size_t>(q)] = false;
      changed = true;
    }
    return changed;
  }

  const Connectivity<4>& cells_;
  mesh::Rows around_;
  std::vector<Index> twin_;
  std::vector<bool> kept_;
  Index dropped_ = 0;
};

/// Spreads the nodes of a loop evenly over its curve, turned to fit where they are.
[[nodiscard]] inline std::vector<double> spread_over(const RimCurve& curve, const Points<3>& nodes,
                                                     const std::vector<Index>& loop) {
  const double step = curve.length() / static_cast<double>(loop.size()),
               turn = 2 * std::numbers::pi / curve.length();
  double c = 0, s = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double shift = turn * (curve.nearest(vec::column(nodes, loop[i])) - step * static_cast<double>(i));
    c += std::cos(shift), s += std::sin(shift);
  }
  std::vector<double> along;
  for (std::size_t i = 0; i < loop.size(); ++i)
    along.push_back(std::atan2(s, c) / turn + step * static_cast<double>(i));
  return along;
}

}  // namespace detail

/// Cuts the wall out of a closed contour and gives each rim its layer. MeshError where the rim of a cap
/// is not one loop of the sheet: the spacing is too coarse there.
[[nodiscard]] inline WallQuads wall_quads(const mesh::QuadSurface& contour, const Rims& rims) {
  const auto twin = quad_twins(contour.cells, contour.node_count());
  const detail::WallSelection selection(contour, twin);
  WallQuads wall;
  wall.dropped = selection.dropped();

  std::vector<Index> number(static_cast<std::size_t>(contour.node_count()), -1);
  std::vector<Index> cells;
  Index count = 0;
  for (Index q = 0; q < contour.cell_count(); ++q)
    if (selection.kept(q))
      for (int k = 0; k < 4; ++k) {
        Index& n = number[static_cast<std::size_t>(contour.cells(k, q))];
        if (n < 0) n = count++;
        cells.push_back(n);
      }
  if (cells.empty()) throw MeshError("the contour has no quadrilateral of the wall");
  std::vector<Vec3> points(static_cast<std::size_t>(count));
  for (Index n = 0; n < contour.node_count(); ++n)
    if (number[static_cast<std::size_t>(n)] >= 0)
      points[static_cast<std::size_t>(number[static_cast<std::size_t>(n)])] = vec::column(contour.nodes, n);

  std::vector<Index> next(static_cast<std::size_t>(count), -1), cap(static_cast<std::size_t>(count), 0);
  for (Index h = 0; h < 4 * contour.cell_count(); ++h) {
    if (!selection.on_rim(h)) continue;
    const auto from = static_cast<std::size_t>(number[static_cast<std::size_t>(contour.cells(h % 4, h / 4))]);
    next[from] = number[static_cast<std::size_t>(contour.cells((h + 1) % 4, h / 4))];
    cap[from] = contour.region_of(twin[static_cast<std::size_t>(h)] / 4);
  }
  wall.loops.resize(rims.curves.size());
  for (Index first = 0; first < count; ++first) {
    if (next[static_cast<std::size_t>(first)] < 0) continue;
    std::vector<Index> loop;
    Index region = 0;
    for (Index n = first; next[static_cast<std::size_t>(n)] >= 0;) {
      loop.push_back(n);
      region = std::max(region, cap[static_cast<std::size_t>(n)]);
      n = std::exchange(next[static_cast<std::size_t>(n)], -1);
    }
    const auto rim = static_cast<std::size_t>(std::find(rims.regions.begin(), rims.regions.end(), region) -
                                              rims.regions.begin());
    if (rim == rims.regions.size() || !wall.loops[rim].empty()) {
      const Vec3& x = points[static_cast<std::size_t>(loop.front())];
      throw MeshError("the contour of the wall is torn at " + place(x) +
                      ": the edge length asked for is too coarse there");
    }
    wall.loops[rim] = std::move(loop);
  }
  for (std::size_t r = 0; r < rims.curves.size(); ++r)
    if (wall.loops[r].empty())
      throw MeshError("the contour of the wall does not reach \"" + rims.curves[r].name() +
                      "\": the edge length asked for is too coarse there");

  // The layer: each edge of a loop gets a quadrilateral, whose far side is on the rim.
  for (std::size_t r = 0; r < rims.curves.size(); ++r) {
    const std::vector<Index> old = wall.loops[r];
    const auto m = static_cast<Index>(old.size());
    for (Index i = 0; i < m; ++i) {
      const Index j = (i + 1) % m, a = old[static_cast<std::size_t>(i)], b = old[static_cast<std::size_t>(j)];
      cells.insert(cells.end(), {b, a, count + i, count + j});
      wall.loops[r][static_cast<std::size_t>(i)] = count + i;
      points.push_back(points[static_cast<std::size_t>(a)]);
    }
    count += m;
  }
  wall.nodes = vec::columns(points);
  wall.cells = vec::quads(cells);
  for (std::size_t r = 0; r < rims.curves.size(); ++r) {
    wall.along.push_back(detail::spread_over(rims.curves[r], wall.nodes, wall.loops[r]));
    for (std::size_t i = 0; i < wall.loops[r].size(); ++i)
      vec::set_column(wall.nodes, wall.loops[r][i], rims.curves[r].at(wall.along[r][i]));
  }
  return wall;
}

}  // namespace tunica::meshing
