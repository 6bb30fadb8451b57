// SPDX-License-Identifier: MIT
// Hermite data of a scalar field, or of the kept voxels of an image, closed at the grid's border by
// flat regions "border x0" ... [JU02, 2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/image/image.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/scalar_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Nodes that cover the box with that spacing [length], level with its centre.
[[nodiscard]] inline std::array<std::vector<double>, 3> uniform_axes(const Box& box, double spacing) {
  TUNICA_EXPECT(spacing > 0, "a grid has a positive spacing");
  std::array<std::vector<double>, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    const auto cells = std::max(1.0, std::ceil((box.hi[e] - box.lo[e]) / spacing - 1e-9));
    const double start = box.centre()[e] - 0.5 * cells * spacing;
    for (int i = 0; i <= static_cast<int>(cells); ++i) axes[a].push_back(start + i * spacing);
  }
  return axes;
}

namespace detail {

/// The grid with a layer of outside nodes around it; inside(i, j, k) of the nodes as given.
template <class Inside>
[[nodiscard]] HermiteGrid padded_grid(const std::array<std::vector<double>, 3>& axes, Inside&& inside) {
  HermiteGrid grid;
  for (std::size_t a = 0; a < 3; ++a) {
    TUNICA_EXPECT(axes[a].size() >= 2, "a grid needs two nodes along each axis");
    const auto& x = axes[a];
    grid.axes[a].push_back(2 * x[0] - x[1]);
    grid.axes[a].insert(grid.axes[a].end(), x.begin(), x.end());
    grid.axes[a].push_back(2 * x.back() - x[x.size() - 2]);
  }
  grid.inside.assign(grid.size(0) * grid.size(1) * grid.size(2), 0);
  for (std::size_t k = 0; k < axes[2].size(); ++k)
    for (std::size_t j = 0; j < axes[1].size(); ++j) {
      const std::size_t row = 1 + grid.size(0) * (j + 1 + grid.size(1) * (k + 1));
      for (std::size_t i = 0; i < axes[0].size(); ++i) grid.inside[row + i] = inside(i, j, k) ? 1 : 0;
    }
  return grid;
}

/// Fills in the crossings: those with a node of the padding lie in the border, with its normal; the
/// others come from cross(inside node, outside node), nodes in the numbering of the padded grid.
template <class Cross>
void add_crossings(HermiteGrid& grid, Cross&& cross) {
  grid.regions = {{}};
  std::array<Index, 6> border{};  // region of side 2a + s, 0: none yet
  for_crossed_edges(grid, [&](std::size_t, std::size_t node, std::size_t other, std::size_t a) {
    if (grid.position(node)[a] == 0) border[2 * a] = 1;
    if (grid.position(other)[a] + 1 == grid.size(a)) border[2 * a + 1] = 1;
  });
  for (std::size_t side = 0; side < 6; ++side) {
    if (border[side] == 0) continue;
    const std::size_t a = side / 2;
    const auto e = static_cast<Eigen::Index>(a);
    border[side] = static_cast<Index>(grid.regions.size());
    HermiteRegion region{"border " + std::string(1, "xyz"[a]) + std::to_string(side % 2), true, {}, {}};
    region.normal = (side % 2 == 0 ? -1.0 : 1.0) * Vec3::Unit(e);
    region.point = grid.axes[a][side % 2 == 0 ? 1 : grid.size(a) - 2] * Vec3::Unit(e);
    grid.regions.push_back(region);
  }
  bool crossed_inside = false;
  for_crossed_edges(grid, [&](std::size_t edge, std::size_t node, std::size_t other, std::size_t a) {
    const bool first = grid.inside[node] != 0;
    const std::size_t in = first ? node : other, out = first ? other : node;
    const std::size_t at = grid.position(out)[a];
    grid.edges.push_back(edge);
    if (at == 0 || at + 1 == grid.size(a)) {
      const Index region = border[2 * a + (at == 0 ? 0 : 1)];
      grid.crossings.push_back(
          {grid.point(in), grid.regions[static_cast<std::size_t>(region)].normal, region});
    } else {
      crossed_inside = true;
      grid.crossings.push_back(cross(in, out));
    }
  });
  if (!crossed_inside)
    throw MeshError("no edge of the grid crosses the iso-value: all of it is " +
                    std::string(grid.edges.empty() ? "outside" : "inside"));
}

/// The point on the edge from a (inside) to b where the field is iso; regula falsi, Illinois variant.
template <ScalarField F>
[[nodiscard]] double field_root(const F& field, double iso, const Vec3& a, const Vec3& b) {
  double lo = 0, hi = 1, f_lo = field_value(field, a) - iso, f_hi = field_value(field, b) - iso, t = 0;
  for (int i = 0, side = 0; i < 40 && hi - lo > 1e-12; ++i) {
    const double before = t;
    t = f_lo > f_hi ? lo + (hi - lo) * f_lo / (f_lo - f_hi) : 0.5 * (lo + hi);
    if (i > 0 && std::abs(t - before) < 1e-12) break;
    const double f = field_value(field, a + t * (b - a)) - iso;
    if (f == 0) break;
    if (f > 0) {
      lo = t, f_lo = f;
      if (side > 0) f_hi *= 0.5;
      side = 1;
    } else {
      hi = t, f_hi = f;
      if (side < 0) f_lo *= 0.5;
      side = -1;
    }
  }
  return std::clamp(t, crossing_margin, 1 - crossing_margin);
}

[[nodiscard]] inline Vec3 outward(const Vec3& gradient, const Vec3& towards_outside) {
  const double size = gradient.norm();
  return size > 0 && std::isfinite(size) ? Vec3(-gradient / size) : towards_outside.normalized();
}

}  // namespace detail

/// Inside is field >= iso at the nodes of the axes. Where the inside reaches the border of the grid
/// the surface is closed there. MeshError if no edge crosses the iso-value.
template <ScalarField F>
[[nodiscard]] HermiteGrid hermite_of_field(const F& field, const std::array<std::vector<double>, 3>& axes,
                                           double iso = 0) {
  HermiteGrid grid = detail::padded_grid(axes, [&](std::size_t i, std::size_t j, std::size_t k) {
    return field_value(field, Vec3(axes[0][i], axes[1][j], axes[2][k])) >= iso;
  });
  detail::add_crossings(grid, [&](std::size_t in, std::size_t out) {
    const Vec3 a = grid.point(in), b = grid.point(out);
    const Vec3 x = a + detail::field_root(field, iso, a, b) * (b - a);
    return Crossing{x, detail::outward(field_gradient(field, x, 1e-4 * (b - a).norm()), b - a), 0};
  });
  return grid;
}

/// {value >= iso} of the voxels kept (one byte a voxel, 0 is dropped; empty keeps all) on the image's own
/// grid; normals are interpolated from central differences. MeshError if nothing crosses.
template <class T>
[[nodiscard]] HermiteGrid hermite_of_image(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                           double iso) {
  TUNICA_EXPECT(kept.empty() || kept.size() == image.values.size(), "the mask has one byte for each voxel");
  const std::size_t nx = image.axes[0].size(), ny = image.axes[1].size();
  HermiteGrid grid = detail::padded_grid(image.axes, [&](std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t v = i + nx * (j + ny * k);
    return static_cast<double>(image.values[v]) >= iso && (kept.empty() || kept[v] != 0);
  });
  const std::array<std::size_t, 3> stride{1, nx, nx * ny};
  const auto gradient = [&](const std::array<std::size_t, 3>& p, std::size_t v) {
    Vec3 g;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& x = image.axes[a];
      const std::size_t lo = p[a] > 0 ? 1 : 0, hi = p[a] + 1 < x.size() ? 1 : 0;
      const auto f = [&](std::size_t at) { return static_cast<double>(image.values[at]); };
      g[static_cast<Eigen::Index>(a)] =
          (f(v + hi * stride[a]) - f(v - lo * stride[a])) / (x[p[a] + hi] - x[p[a] - lo]);
    }
    return g;
  };
  detail::add_crossings(grid, [&](std::size_t in, std::size_t out) {
    auto p = grid.position(in), q = grid.position(out);
    for (std::size_t a = 0; a < 3; ++a) --p[a], --q[a];
    const std::size_t v = p[0] + nx * (p[1] + ny * p[2]), w = q[0] + nx * (q[1] + ny * q[2]);
    const double f = static_cast<double>(image.values[v]) - iso,
                 g = static_cast<double>(image.values[w]) - iso;
    const double cut =
        g < 0 && f > g ? f / (f - g) : 0.5;  // half-way where the choice of voxels alone parts them
    const double t = std::clamp(cut, crossing_margin, 1 - crossing_margin);
    const Vec3 a = grid.point(in), b = grid.point(out);
    return Crossing{a + t * (b - a), detail::outward((1 - t) * gradient(p, v) + t * gradient(q, w), b - a),
                    0};
  });
  return grid;
}

}  // namespace tunica::meshing
