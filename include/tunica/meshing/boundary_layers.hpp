// SPDX-License-Identifier: MIT
// layered_tetrahedra(surface): layers of flat tetrahedra that grow from the wall inward, the rest filled.
// Offset along most normal directions, heights that give way where there is no room. [PIRZADEH94]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/layer_assembly.hpp"
#include "tunica/meshing/layer_caps.hpp"
#include "tunica/meshing/layer_check.hpp"
#include "tunica/meshing/layer_directions.hpp"
#include "tunica/meshing/layer_heights.hpp"
#include "tunica/meshing/layer_options.hpp"
#include "tunica/meshing/layer_report.hpp"
#include "tunica/meshing/layer_sheet.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

/// The surface between layers and core: each node at the end of its column. Heights give way until all prisms
/// are good, no flat end folds and nothing crosses.
class LayerOffset {
 public:
  LayerOffset(const LayerSheet& sheet, LayerHeights& heights, const std::vector<LayerRim>& rims, int layers)
      : sheet_(sheet), heights_(heights), rims_(rims), layers_(layers), caps_(sheet), inner_(sheet.surface) {
    move_.assign(static_cast<std::size_t>(sheet.surface.node_count()), Vec3(0, 0, 0));
    find_edges();
  }

  /// The number of rounds that it took.
  int settle() {
    constexpr double gentle = 0.85, hard = 0.7;
    constexpr int patience = 300;  // rounds after which what is still in the way vanishes
    int round = 0;
    for (;; ++round) {
      const double soft = round < patience ? gentle : 0, steep = round < patience ? hard : 0;
      if (const auto poor = heights_.poor(); !poor.empty()) {
        give_way(poor, soft);
        continue;
      }
      follow();
      if (const auto folded = folds(); !folded.empty()) {
        give_way(folded, soft);
        continue;
      }
      if (const auto crossing = crossings(); !crossing.empty()) {
        give_way(crossing, steep);
        continue;
      }
      return round;
    }
  }

  void give_way_everywhere(double factor) {
    std::vector<Index> all;
    for (Index n = 0; n < sheet_.surface.node_count(); ++n) all.push_back(n);
    heights_.lower(all, factor);
  }

  [[nodiscard]] const mesh::Surface& inner() const { return inner_; }

 private:
  struct Edge {
    Index one, other, across;  // its triangles; the node of the second that the first has not
    double least;              // [rad]
  };

  /// Where none of the nodes has a height left the cause is farther away.
  void give_way(const std::vector<Index>& nodes, double factor) {
    if (!heights_.lower(nodes, factor)) give_way_everywhere(0.5);
  }

  void follow() {
    for (Index n = 0; n < sheet_.surface.node_count(); ++n) {
      if (sheet_.foot[static_cast<std::size_t>(n)] == ColumnFoot::none) continue;
      move_[static_cast<std::size_t>(n)] = vec::minus(heights_.place(n, layers_), sheet_.node(n));
    }
    caps_.follow(move_);
    for (Index n = 0; n < sheet_.surface.node_count(); ++n) {
      const bool column = sheet_.foot[static_cast<std::size_t>(n)] != ColumnFoot::none;
      vec::set_column(inner_.nodes, n,
                      column ? heights_.place(n, layers_)
                             : vec::plus(sheet_.node(n), move_[static_cast<std::size_t>(n)]));
    }
  }

  /// Nodes at which a flat end, a side of the layers on it or the inner surface would fold.
  [[nodiscard]] std::vector<Index> folds() const {
    std::vector<Index> list = caps_.folded(move_);
    for (const LayerRim& r : rims_) {
      const Vec3 a = sheet_.node(r.a), b = sheet_.node(r.b);
      const Vec3 c = vec::column(inner_.nodes, r.a), d = vec::column(inner_.nodes, r.b);
      const double length = vec::distance(a, b);
      const Vec3 up = caps_.normal(r.region);
      const auto flat = [&](const mesh::Triangle& t, double height) {
        constexpr double least = 0.1;  // of the area of a rectangle's half
        return height > 0 && !(vec::dot(t.area_vector(), up) > 0.5 * least * length * height);
      };
      const double left = vec::distance(a, c), right = vec::distance(b, d);
      if (flat({a, b, d}, right) || flat({a, d, c}, left) || flat({a, b, c}, left) || flat({b, d, c}, right))
        list.insert(list.end(), {r.a, r.b});
    }
    for (const Edge& e : edges_)
      if (!(angle(inner_, e.one, e.other, e.across) > 0.99 * e.least))
        for (const Index t : {e.one, e.other})
          for (const Index n : sheet_.corners(t)) add_columns(n, list);
    unify(list);
    return list;
  }

  /// Edges that columns move, with the inner angle below which the surface counts as folded there.
  void find_edges() {
    constexpr double sharp = 15 * std::numbers::pi / 180, part = 0.7;  // [rad]; of the angle on the wall
    const mesh::Surface& s = sheet_.surface;
    const auto twin = mesh::twins(s.cells, s.node_count());
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index g = twin[static_cast<std::size_t>(h)];
      if (g < h) continue;
      const auto e = mesh::half_edge(s.cells, h);
      const Index across = s.cells(mesh::previous_in_triangle(g) % 3, g / 3),
                  before = s.cells(mesh::previous_in_triangle(h) % 3, h / 3);
      if (!sheet_.grows(e.from) && !sheet_.grows(e.to) && !sheet_.grows(across) && !sheet_.grows(before))
        continue;
      edges_.push_back({h / 3, g / 3, across, std::min(sharp, part * angle(s, h / 3, g / 3, across))});
    }
  }

  /// Angle inside of the surface between two triangles, pi and more where it is not convex; `across` is the
  /// node of the second that the first has not.
  [[nodiscard]] static double angle(const mesh::Surface& s, Index t, Index u, Index across) {
    const mesh::Triangle a = mesh::triangle(s, t), b = mesh::triangle(s, u);
    const Vec3 m = a.area_vector(), n = b.area_vector();
    if (!(vec::dot(m, vec::minus(vec::column(s.nodes, across), a.a)) < 0)) return std::numbers::pi;
    return std::numbers::pi - std::atan2(vec::length(vec::cross(m, n)), vec::dot(m, n));
  }

  [[nodiscard]] std::vector<Index> crossings() const {
    std::vector<Index> list;
    for (const auto& [t, u] : self_intersections(inner_))
      for (int k = 0; k < 3; ++k)
        for (const Index n : {inner_.cells(k, t), inner_.cells(k, u)}) add_columns(n, list);
    unify(list);
    return list;
  }
  static void unify(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  void add_columns(Index n, std::vector<Index>& list) const {
    if (sheet_.foot[static_cast<std::size_t>(n)] != ColumnFoot::none)
      list.push_back(n);
    else
      caps_.columns_near({n, n, n}, list);
  }

  const LayerSheet& sheet_;
  LayerHeights& heights_;
  const std::vector<LayerRim>& rims_;
  int layers_;
  LayerCaps caps_;
  mesh::Surface inner_;
  std::vector<Vec3> move_;
  std::vector<Edge> edges_;
};

inline void tell_heights(const LayerSheet& sheet, const LayerHeights& heights, LayeredFill& result) {
  LayerReport& r = result.report;
  double full = 0;
  for (Index n = 0; n < sheet.surface.node_count(); ++n) {
    const ColumnFoot foot = sheet.foot[static_cast<std::size_t>(n)];
    double share = 1;
    if (foot != ColumnFoot::none) {
      share = heights.wanted(n) > 0 ? heights.height(n) / heights.wanted(n) : 0;
      if (share > 0)
        ++r.columns;
      else
        ++r.vanished;
      if (share < r.least_share) r.least_share = share, r.thinnest = sheet.node(n);
      r.mean_share += share;
      full += share >= 0.99 ? 1 : 0;
    }
    result.share.push_back(share);
  }
  const double nodes = std::max(1, r.columns + r.vanished);
  r.mean_share /= nodes, r.full_share = full / nodes;
}

/// fill_core(inner) fills what is inside of the layers.
template <class FillCore>
[[nodiscard]] LayeredFill layered(const mesh::Surface& surface, const LayerOptions& options,
                                  FillCore&& fill_core) {
  TUNICA_EXPECT(options.layers > 0, "boundary layers are at least one");
  TUNICA_EXPECT(options.growth > 0 && options.last > 0 && options.first >= 0,
                "layers have a positive height");
  [[maybe_unused]] const FrontSurface closed(surface.nodes, surface.cells);  // or else refused
  require_no_crossing(surface);
  LayeredFill result;
  LayerSheet sheet = layer_sheet(surface, options.regions);
  const LayerDirections directions = layer_directions(sheet, options.smoothing);
  LayerHeights heights(sheet, directions, options);
  const auto rims = layer_rims(sheet);
  detail::LayerOffset offset(sheet, heights, rims, options.layers);
  result.report.layers = options.layers, result.report.blind = directions.blind;

  FillResult core;
  constexpr int tries = 4;  // a core that cannot be filled gets more room
  for (int i = 1;; ++i) {
    result.report.rounds += offset.settle();
    try {
      core = fill_core(offset.inner());
      break;
    } catch (const MeshError&) {
      if (i == tries) throw;
      offset.give_way_everywhere(i + 1 == tries ? 0 : 0.5);
    }
  }
  detail::tell_heights(sheet, heights, result);

  const LayerNumbers number(sheet, heights, options.layers);
  const Index given = surface.node_count(), added = core.mesh.node_count() - given;
  mesh::TetMesh& m = result.mesh;
  m.nodes.resize(3, number.count() + added);
  result.inner = offset.inner();
  for (Index n = 0; n < given; ++n) {
    const bool column = sheet.foot[static_cast<std::size_t>(n)] != ColumnFoot::none;
    vec::set_column(m.nodes, n, column ? sheet.node(n) : vec::column(result.inner.nodes, n));
    if (number.has_column(n))
      for (int level = 1; level <= options.layers; ++level)
        vec::set_column(m.nodes, number(n, level), heights.place(n, level));
    result.end.push_back(number.end(n));
  }
  for (Index n = 0; n < added; ++n)
    vec::set_column(m.nodes, number.count() + n, vec::column(core.mesh.nodes, given + n));

  std::vector<Index> cells;
  detail::each_prism(sheet, number, options.layers,
                     [&](const Prism& prism, const std::array<Index, 3>& rank) {
                       split_prism(prism, rank, [&](const std::array<Index, 4>& tet) {
                         cells.insert(cells.end(), tet.begin(), tet.end());
                       });
                     });
  const auto in_layers = static_cast<Index>(cells.size() / 4);
  m.cells.resize(4, in_layers + core.mesh.cell_count());
  std::copy(cells.begin(), cells.end(), m.cells.data());
  for (Index t = 0; t < core.mesh.cell_count(); ++t)
    for (int k = 0; k < 4; ++k) {
      const Index n = core.mesh.cells(k, t);
      m.cells(k, in_layers + t) =
          n < given ? result.end[static_cast<std::size_t>(n)] : n - given + number.count();
    }
  result.outer = detail::layer_border(sheet, rims, number, m.nodes, options.layers);
  detail::add_patches(m, result.outer);
  result.report.fill = core.report;
  detail::check_layers(result, in_layers, result.report);
  return result;
}

}  // namespace detail

/// Layers on the wall of a closed, oriented surface, the core filled by tetrahedra(). Flat ends stay in their
/// planes: the columns at their rims run within them, and their triangles shrink to make room. MeshError,
/// with a place, for surfaces that tetrahedra() refuses, and where no region can carry layers.
[[nodiscard]] inline LayeredFill layered_tetrahedra(const mesh::Surface& surface,
                                                    const LayerOptions& options = {},
                                                    const FillOptions& core = {}) {
  return detail::layered(surface, options,
                         [&](const mesh::Surface& inner) { return tetrahedra(inner, core); });
}

/// As above, with a size field for the core.
template <SizeField Size>
[[nodiscard]] LayeredFill layered_tetrahedra(const mesh::Surface& surface, const Size& size,
                                             const LayerOptions& options, const FillOptions& core = {}) {
  return detail::layered(surface, options,
                         [&](const mesh::Surface& inner) { return tetrahedra(inner, core, size); });
}

}  // namespace tunica::meshing
