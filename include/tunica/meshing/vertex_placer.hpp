// SPDX-License-Identifier: MIT
// Places the vertices of dual contouring in the cells of an image's grid: where their errors are least, in
// the planes of flat parts, and apart from each other.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/flat_vertex.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/least_error.hpp"
#include "tunica/meshing/part_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tunica::meshing::detail {

/// Regions are kept as bits of a word, six of them are borders.
inline constexpr std::size_t most_cuts = 57;

/// The crossings of the vertices of a cell, which come one after the other: those with the wall, and the
/// others; flat is null where no region is flat.
struct CellCrossings {
  std::size_t count;
  const PlaneSums* walls;
  const FlatCrossings* flat;
};

/// Cells are numbered in the grid with a layer of outside nodes around it, axes are those of that grid. Cells
/// of the layer are as thin as the border of the image.
class VertexPlacer {
 public:
  using Cell = std::array<std::size_t, 3>;

  /// regions: the wall, flat ones up to `cuts`, then the borders.
  VertexPlacer(const std::array<std::vector<double>, 3>& axes, const std::vector<HermiteRegion>& regions,
               std::size_t cuts, double hold, const LeastErrorOptions& options)
      : axes_(axes), regions_(regions), cuts_(cuts), hold_(hold), options_(options) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& x : axes)
      for (std::size_t i = 1; i + 2 < x.size(); ++i) least = std::min(least, x[i + 1] - x[i]);
    nearest_ = on_plane * least;
  }

  void place(const Cell& at, const CellCrossings& crossings, double* nodes) const {
    const double x = axes_[0][at[0]], y = axes_[1][at[1]], z = axes_[2][at[2]];
    const double dx = axes_[0][at[0] + 1] - x, dy = axes_[1][at[1] + 1] - y, dz = axes_[2][at[2] + 1] - z;
    const double mx = hold_ * dx, my = hold_ * dy, mz = hold_ * dz;
    const Box box{Vec3(mx, my, mz), Vec3(dx - mx, dy - my, dz - mz)};
    double* to = nodes;
    for (std::size_t v = 0; v < crossings.count; ++v) {
      const bool flat = crossings.flat && (crossings.flat[v].regions != 0 || on_border(at));
      const Vec3 best = flat ? flat_place(at, crossings.walls[v], crossings.flat[v])
                             : least_error(crossings.walls[v], box, options_);
      to[0] = x + best[0], to[1] = y + best[1], to[2] = z + best[2];
      to += 3;
    }
    if (crossings.count > 1) part_all(at, crossings, nodes);
  }

 private:
  [[nodiscard]] bool on_border(const Cell& at) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (at[a] == 0 || at[a] + 2 == axes_[a].size()) return true;
    return false;
  }

  [[nodiscard]] FlatCell flat_cell(const Cell& at) const {
    FlatCell cell;
    cell.nearest = nearest_;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<int>(a);
      const double size = axes_[a][at[a] + 1] - axes_[a][at[a]];
      cell.corner[e] = axes_[a][at[a]];
      cell.box.lo[e] = at[a] == 0 ? size : 0;
      cell.box.hi[e] = at[a] + 2 == axes_[a].size() ? 0 : size;
    }
    return cell;
  }

  [[nodiscard]] bool in_cut(const FlatCrossings& flat) const {
    return (flat.regions & ((std::uint64_t{1} << cuts_) - 1)) != 0;
  }

  [[nodiscard]] Vec3 flat_place(const Cell& at, const PlaneSums& walls, const FlatCrossings& flat) const {
    std::array<const HermiteRegion*, most_cuts> planes{};
    std::size_t count = 0;
    for (std::size_t r = 1; r < cuts_; ++r)
      if ((flat.regions >> r & 1U) != 0) planes[count++] = &regions_[r];
    return flat_vertex(walls, flat, {planes.data(), count}, flat_cell(at), hold_, options_);
  }

  /// Those in cuts stay.
  void part_all(const Cell& at, const CellCrossings& crossings, double* nodes) const {
    const FlatCell cell = flat_cell(at);
    const Box box = held(cell.box, std::max(hold_, 0.0));
    Sheets sheets{.count = crossings.count, .place = {}, .mean = {}};
    for (std::size_t v = 0; v < crossings.count; ++v) {
      sheets.place[v] = sheets.mean[v] = Vec3(nodes[3 * v], nodes[3 * v + 1], nodes[3 * v + 2]);
      if (crossings.flat && in_cut(crossings.flat[v])) continue;
      const PlaneSums& walls = crossings.walls[v];
      Vec3 sum(walls.px, walls.py, walls.pz);
      int count = walls.count();
      if (crossings.flat) sum = vec::plus(sum, crossings.flat[v].sum), count += crossings.flat[v].count;
      sheets.mean[v] = vec::plus(cell.corner, held_in(box, vec::divided(sum, count)));
    }
    part(sheets, cell.box.diagonal());
    for (std::size_t v = 0; v < crossings.count; ++v)
      for (std::size_t a = 0; a < 3; ++a) nodes[3 * v + a] = sheets.place[v][static_cast<int>(a)];
  }

  const std::array<std::vector<double>, 3>& axes_;
  const std::vector<HermiteRegion>& regions_;
  std::size_t cuts_;  // beyond the last cut in regions_
  double hold_;
  LeastErrorOptions options_;
  double nearest_;  // less is no distance from a plane
};

}  // namespace tunica::meshing::detail
