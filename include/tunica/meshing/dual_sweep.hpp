// SPDX-License-Identifier: MIT
// Dual contouring of an image in one sweep over its slices: each crossing is found once, gives a
// quadrilateral and is added to the errors of the four vertices around it. [JU02]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/dual_topology.hpp"
#include "tunica/meshing/grid_crossing.hpp"
#include "tunica/meshing/least_error.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/vertex_placer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// The sweep over the grid with its layer of outside nodes. Crossings: cross<axis>(node, first_inside) of an
/// edge within the image. Each thread fills a slab of slices; crossings between two slabs are found twice.
template <class Crossings>
class DualSweep {
 public:
  DualSweep(const std::array<std::vector<double>, 3>& axes, const PaddedBits& bits,
            const Crossings& crossings, std::vector<HermiteRegion> regions, double hold,
            const LeastErrorOptions& options)
      : axes_{padded(axes[0]), padded(axes[1]), padded(axes[2])},
        bits_(bits),
        crossings_(crossings),
        regions_(std::move(regions)),
        cuts_(regions_.size()),
        topology_(bits),
        hold_(hold),
        options_(options),
        nx_(bits.size(0)),
        ny_(bits.size(1)),
        nz_(bits.size(2)) {
    add_borders();
  }

  [[nodiscard]] const DualTopology& topology() const { return topology_; }

  [[nodiscard]] mesh::QuadSurface run() const {
    mesh::QuadSurface s;
    s.nodes.resize(3, topology_.vertex_count());
    s.cells.resize(4, topology_.quad_count());
    s.region.assign(static_cast<std::size_t>(topology_.quad_count()), 0);
    for (const auto& r : regions_) s.region_names.push_back(r.name);
    const std::ptrdiff_t slab = static_cast<std::ptrdiff_t>(nz_ - 2) / thread_count() + 1;  // slices of cells
    parallel_chunks(static_cast<std::ptrdiff_t>(nz_ - 1), slab,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      fill(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), s);
                    });
    return s;
  }

 private:
  /// The cells between two slices of nodes: what stands for each, and the errors of their vertices.
  struct Layer {
    std::unique_ptr<Index[]> map;
    std::vector<PlaneSums> walls;
    std::vector<FlatCrossings> flat;  // empty where no region is flat
    Index first = 0;                  // vertex
  };

  [[nodiscard]] static std::vector<double> padded(const std::vector<double>& x) {
    std::vector<double> p{2 * x[0] - x[1]};
    p.insert(p.end(), x.begin(), x.end());
    p.push_back(2 * x.back() - x[x.size() - 2]);
    return p;
  }

  void add_borders() {
    std::array<bool, 6> touched{};
    for (std::size_t k = 1; k + 1 < nz_; ++k)
      for (std::size_t j = 1; j + 1 < ny_; ++j) {
        if (!bits_.any(j, k)) continue;
        touched[0] |= bits_.inside(1, j, k), touched[1] |= bits_.inside(nx_ - 2, j, k);
        if (j == 1 || j + 2 == ny_ || k == 1 || k + 2 == nz_) {
          bool some = false;
          for (std::size_t w = 0; w < bits_.words(); ++w) some |= bits_.row(j, k)[w] != 0;
          touched[2] |= some && j == 1, touched[3] |= some && j + 2 == ny_;
          touched[4] |= some && k == 1, touched[5] |= some && k + 2 == nz_;
        }
      }
    for (std::size_t side = 0; side < 6; ++side) {
      if (!touched[side]) continue;
      const std::size_t a = side / 2;
      HermiteRegion border{border_names[side], true, {0, 0, 0}, Crossings::along(a, side % 2 == 1)};
      border.point[static_cast<int>(a)] = side % 2 == 0 ? axes_[a][1] : axes_[a][axes_[a].size() - 2];
      border_[side] = static_cast<Index>(regions_.size());
      regions_.push_back(border);
    }
  }

  void prepare(Layer& layer, std::size_t k) const {
    const auto [first, end] = topology_.cells(k);
    topology_.number(k, layer.map.get());
    layer.first = topology_.first_vertex(first);
    const auto vertices = static_cast<std::size_t>(topology_.first_vertex(end) - layer.first);
    layer.walls.assign(vertices, {});
    if (regions_.size() > 1) layer.flat.assign(vertices, {});
  }

  /// The vertices of the cells above the slices begin .. end - 1 and the quadrilaterals of edges from there.
  void fill(std::size_t begin, std::size_t end, mesh::QuadSurface& s) const {
    Layer lower, upper;
    lower.map = std::make_unique_for_overwrite<Index[]>(nx_ * ny_);
    upper.map = std::make_unique_for_overwrite<Index[]>(nx_ * ny_);
    if (begin > 0) prepare(lower, begin - 1);
    for (std::size_t k = begin; k <= end; ++k) {
      if (k + 1 < nz_) prepare(upper, k);
      cross_slice(k, lower, upper, k < end ? &s : nullptr);
      if (k > begin) place(k - 1, lower, s);
      std::swap(lower, upper);
    }
  }

  /// Crosses all edges from slice k upward and within it; quadrilaterals go to s unless that is null.
  void cross_slice(std::size_t k, Layer& lower, Layer& upper, mesh::QuadSurface* s) const {
    for (std::size_t j = 0; j + 1 < ny_; ++j) {
      if (!topology_.any_quad(j, k)) continue;
      Index quad = topology_.first_quad(j, k);
      for (std::size_t w = 0; w < bits_.words(); ++w) {
        const auto crossed = topology_.crossed(w, j, k);
        const std::uint64_t row = bits_.row(j, k)[w];
        for (std::uint64_t some = crossed[0] | crossed[1] | crossed[2]; some != 0; some &= some - 1) {
          const auto n = static_cast<unsigned>(std::countr_zero(some));
          const GridNode node{word_bits * w + n, j, k};
          const bool inside = (row >> n & 1U) != 0;
          if ((crossed[0] >> n & 1U) != 0) cross<0>(node, inside, lower, upper, quad++, s);
          if ((crossed[1] >> n & 1U) != 0) cross<1>(node, inside, lower, upper, quad++, s);
          if ((crossed[2] >> n & 1U) != 0 && s) cross<2>(node, inside, lower, upper, quad++, s);
        }
      }
    }
  }

  /// One crossing: the cells around its edge, counter-clockwise seen against the axis, have the edge as their
  /// number 3, 2, 0 and 1 along it.
  template <std::size_t A>
  void cross(const GridNode& node, bool inside, Layer& lower, Layer& upper, Index quad,
             mesh::QuadSurface* s) const {
    constexpr std::size_t B = (A + 1) % 3, C = (A + 2) % 3;
    static constexpr std::array<std::size_t, 4> edge{3, 2, 0, 1};
    const GridCrossing x = crossing<A>(node, inside);
    const auto at = [&](std::size_t back_b, std::size_t back_c) {
      GridNode cell = node;
      cell[B] -= back_b, cell[C] -= back_c;
      Layer& layer = cell[2] < node[2] ? lower : upper;
      return std::pair<Layer&, Index>(layer, layer.map[cell[0] + nx_ * cell[1]]);
    };
    const std::array<std::pair<Layer&, Index>, 4> around{at(1, 1), at(0, 1), at(0, 0), at(1, 0)};
    const double along = x.at * (axes_[A][node[A] + 1] - axes_[A][node[A]]);
    const double wide_b = axes_[B][node[B]] - axes_[B][node[B] - 1],
                 wide_c = axes_[C][node[C]] - axes_[C][node[C] - 1];
    std::array<Index, 4> vertex;
    for (std::size_t n = 0; n < 4; ++n) {
      vertex[n] = topology_.vertex(around[n].second, 4 * A + edge[n]);
      Layer& layer = around[n].first;
      const auto v = static_cast<std::size_t>(vertex[n] - layer.first);
      Vec3 p;
      p[A] = along, p[B] = (edge[n] & 1U) != 0 ? wide_b : 0, p[C] = (edge[n] & 2U) != 0 ? wide_c : 0;
      if (x.region == 0) {
        layer.walls[v].add(p, x.normal);
      } else {
        FlatCrossings& flat = layer.flat[v];
        flat.regions |= std::uint64_t{1} << static_cast<unsigned>(x.region);
        flat.sum = vec::plus(flat.sum, p), ++flat.count;
      }
    }
    if (!s) return;
    Index* q = s->cells.data() + 4 * std::ptrdiff_t{quad};
    for (std::size_t n = 0; n < 4; ++n) q[n] = vertex[inside ? n : 3 - n];
    if (x.region != 0) s->region[static_cast<std::size_t>(quad)] = x.region;
  }

  /// Edges into the layer of outside nodes are crossed in the border of the image.
  template <std::size_t A>
  [[nodiscard]] GridCrossing crossing(const GridNode& node, bool inside) const {
    if (node[A] == 0) return {1, Crossings::along(A, false), border_[2 * A]};
    if (node[A] + 2 == bits_.size(A)) return {0, Crossings::along(A, true), border_[2 * A + 1]};
    return crossings_.template cross<A>({node[0] - 1, node[1] - 1, node[2] - 1}, inside);
  }

  void place(std::size_t k, const Layer& layer, mesh::QuadSurface& s) const {
    const VertexPlacer placer(axes_, regions_, cuts_, hold_, options_);
    for (std::size_t j = 0; j + 1 < ny_; ++j) {
      const auto [first, end] = topology_.cells(j, k);
      for (std::size_t c = first; c < end; ++c) {
        const Index from = topology_.first_vertex(c), beyond = topology_.first_vertex(c + 1);
        const std::ptrdiff_t v = from - layer.first;
        placer.place({topology_.i(c), j, k},
                     {static_cast<std::size_t>(beyond - from), layer.walls.data() + v,
                      layer.flat.empty() ? nullptr : layer.flat.data() + v},
                     s.nodes.data() + 3 * std::ptrdiff_t{from});
      }
    }
  }

  const std::array<std::vector<double>, 3> axes_;
  const PaddedBits& bits_;
  const Crossings& crossings_;
  std::vector<HermiteRegion> regions_;  // the wall, the cuts, the borders
  std::size_t cuts_;                    // beyond the last cut in regions_
  DualTopology topology_;
  double hold_;
  LeastErrorOptions options_;
  std::size_t nx_, ny_, nz_;
  std::array<Index, 6> border_{};  // regions
};

}  // namespace tunica::meshing::detail
