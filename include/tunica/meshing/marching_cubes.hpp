// SPDX-License-Identifier: MIT
// Marching cubes on a rectilinear grid [LORENSEN87]: a closed, manifold, oriented surface for every input.
// A node equal to the iso-value is inside; where the inside meets the border of the image, a flat cap.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Cut parameters from the inside node are held in [least_cut, 1 - least_cut]: no triangle is degenerate.
inline constexpr double least_cut = 1e-4;

namespace detail {

/// Where the contour cuts an edge, as a fraction of it from the inside node. Half-way where both nodes reach
/// the iso-value and the segmentation alone parts them.
[[nodiscard]] inline double cut_fraction(double inside, double outside, double iso) {
  if (outside >= iso) return 0.5;
  const double t = (inside - iso) / (inside - outside);
  if (!(t > least_cut)) return least_cut;  // NaN too
  return t < 1 - least_cut ? t : 1 - least_cut;
}

/// Sweep over the slices of the image: only two slices of edge numbers are in memory.
template <class T>
class MarchingSweep {
 public:
  MarchingSweep(const image::Image<T>& image, std::span<const std::uint8_t> kept, double iso, Border border)
      : image_(image),
        kept_(kept),
        iso_(iso),
        capped_(border == Border::capped),
        nx_(image.axes[0].size()),
        ny_(image.axes[1].size()),
        nz_(image.axes[2].size()) {
    for (Slice& s : slice_) {
      s.inside.assign(nx_ * ny_, 0);
      for (auto& e : s.number) e.assign(nx_ * ny_, -1);
    }
  }

  [[nodiscard]] Contour run() {
    load(slice_[0], 0);
    for (std::size_t k = 0; k + 1 < nz_; ++k) {
      load(slice_[1], k + 1);
      columns(k);
      for (std::size_t j = 0; j + 1 < ny_; ++j) cells(j, k);
      if (capped_) cap_layer(k);
      std::swap(slice_[0], slice_[1]);
    }
    return finish();
  }

 private:
  enum { x_edge, y_edge, z_edge, node };  // numbers of cut edges in +x, +y, +z and of border nodes, at a node

  struct Slice {
    std::size_t k = 0;
    std::vector<std::uint8_t> inside;
    std::array<std::vector<Index>, 4> number;
  };

  [[nodiscard]] double value(std::size_t i, std::size_t j, std::size_t k) const {
    return static_cast<double>(image_.values[i + nx_ * (j + ny_ * k)]);
  }

  Index add(const Vec3& x) {
    points_.insert(points_.end(), {x[0], x[1], x[2]});
    return static_cast<Index>(points_.size() / 3 - 1);
  }

  [[nodiscard]] Vec3 position(std::size_t i, std::size_t j, std::size_t k) const {
    return {image_.axes[0][i], image_.axes[1][j], image_.axes[2][k]};
  }

  /// The cut of the edge from node (i, j, k) in +axis.
  Index cut(std::array<std::size_t, 3> at, std::size_t axis, bool first_inside) {
    auto to = at;
    ++to[axis];
    const double p = value(at[0], at[1], at[2]), q = value(to[0], to[1], to[2]);
    Vec3 x = position(at[0], at[1], at[2]);
    const double lo = image_.axes[axis][at[axis]], hi = image_.axes[axis][to[axis]];
    const auto a = static_cast<Eigen::Index>(axis);
    x[a] =
        first_inside ? lo + cut_fraction(p, q, iso_) * (hi - lo) : hi - cut_fraction(q, p, iso_) * (hi - lo);
    ++cuts_;
    return add(x);
  }

  void load(Slice& s, std::size_t k) {
    s.k = k;
    const std::size_t base = nx_ * ny_ * k;
    for (std::size_t n = 0; n < nx_ * ny_; ++n)
      s.inside[n] =
          static_cast<double>(image_.values[base + n]) >= iso_ && (kept_.empty() || kept_[base + n] != 0);
    for (std::size_t j = 0; j < ny_; ++j)
      for (std::size_t i = 0; i < nx_; ++i) {
        const std::size_t n = i + nx_ * j;
        if (i + 1 < nx_ && s.inside[n] != s.inside[n + 1])
          s.number[x_edge][n] = cut({i, j, k}, 0, s.inside[n] != 0);
        if (j + 1 < ny_ && s.inside[n] != s.inside[n + nx_])
          s.number[y_edge][n] = cut({i, j, k}, 1, s.inside[n] != 0);
        s.number[node][n] = -1;
      }
  }

  void columns(std::size_t k) {
    for (std::size_t j = 0; j < ny_; ++j)
      for (std::size_t i = 0; i < nx_; ++i) {
        const std::size_t n = i + nx_ * j;
        if (slice_[0].inside[n] != slice_[1].inside[n])
          slice_[0].number[z_edge][n] = cut({i, j, k}, 2, slice_[0].inside[n] != 0);
      }
  }

  /// Number of the vertex on an edge of the cell at (i, j): edge 4a + u + 2v, offsets along axes a+1 and a+2.
  [[nodiscard]] Index on_edge(int edge, std::size_t n) const {
    const int a = edge / 4, u = edge % 4 & 1, v = edge % 4 >> 1;
    std::array<int, 3> offset{};
    offset[static_cast<std::size_t>((a + 1) % 3)] = u, offset[static_cast<std::size_t>((a + 2) % 3)] = v;
    return slice_[static_cast<std::size_t>(offset[2])].number[static_cast<std::size_t>(
        a)][n + static_cast<std::size_t>(offset[0]) + nx_ * static_cast<std::size_t>(offset[1])];
  }

  void cells(std::size_t j, std::size_t) {
    const auto& table = marching_table();
    const std::uint8_t *p = slice_[0].inside.data() + nx_ * j, *q = slice_[1].inside.data() + nx_ * j;
    const auto column = [&](std::size_t i) {  // bits of the corners with x offset 0
      return static_cast<unsigned>(p[i] | p[i + nx_] << 2 | q[i] << 4 | q[i + nx_] << 6);
    };
    unsigned left = column(0);
    for (std::size_t i = 0; i + 1 < nx_; ++i) {
      const unsigned right = column(i + 1), signs = left | right << 1;
      left = right;
      if (signs == 0 || signs == 255) continue;
      const MarchingCase& c = table[signs];
      for (std::size_t t = 0; t < static_cast<std::size_t>(c.count); ++t)
        for (const std::int8_t e : c.triangle[t]) wall_.push_back(on_edge(e, i + nx_ * j));
    }
  }

  /// A corner of a face of the border: its slice and its place there.
  struct Corner {
    std::size_t slice, i, j;
  };

  Index border_node(const Corner& c) {
    Slice& s = slice_[c.slice];
    Index& number = s.number[node][c.i + nx_ * c.j];
    if (number < 0) number = add(position(c.i, c.j, s.k));
    return number;
  }

  [[nodiscard]] Index border_cut(const Corner& p, const Corner& q) const {
    const int axis = p.i != q.i ? x_edge : p.j != q.j ? y_edge : z_edge;
    const Corner& low = p.i < q.i || p.j < q.j || p.slice < q.slice ? p : q;
    return slice_[low.slice].number[static_cast<std::size_t>(axis)][low.i + nx_ * low.j];
  }

  /// The inside of one face of the border, corners counter-clockwise from outside: marching squares by the
  /// rule of the table, inside corners of an ambiguous face apart.
  void cap(std::size_t face, const std::array<Corner, 4>& corner) {
    const auto inside = [&](std::size_t n) {
      const Corner& c = corner[n % 4];
      return slice_[c.slice].inside[c.i + nx_ * c.j] != 0;
    };
    auto& out = caps_[face];
    if (inside(0) && inside(1) && inside(2) && inside(3)) {
      const std::array<Index, 4> v{border_node(corner[0]), border_node(corner[1]), border_node(corner[2]),
                                   border_node(corner[3])};
      out.insert(out.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
      return;
    }
    for (std::size_t n = 0; n < 4; ++n) {
      if (inside(n) || !inside(n + 1)) continue;
      std::array<Index, 5> v{};  // cut, one to three nodes, cut
      std::size_t size = 0, m = n + 1;
      v[size++] = border_cut(corner[n], corner[(n + 1) % 4]);
      for (; inside(m); ++m) v[size++] = border_node(corner[m % 4]);
      v[size++] = border_cut(corner[(m - 1) % 4], corner[m % 4]);
      const std::size_t apex = size / 2;  // a node that is collinear with no two of the others
      for (std::size_t e = 0; e < size; ++e)
        if (const std::size_t f = (e + 1) % size; e != apex && f != apex)
          out.insert(out.end(), {v[apex], v[e], v[f]});
    }
  }

  void cap_layer(std::size_t k) {
    for (std::size_t j = 0; j + 1 < ny_; ++j) {
      const std::size_t i = nx_ - 1;
      cap(0, {{{0, 0, j}, {1, 0, j}, {1, 0, j + 1}, {0, 0, j + 1}}});
      cap(1, {{{0, i, j}, {0, i, j + 1}, {1, i, j + 1}, {1, i, j}}});
    }
    for (std::size_t i = 0; i + 1 < nx_; ++i) {
      const std::size_t j = ny_ - 1;
      cap(2, {{{0, i, 0}, {0, i + 1, 0}, {1, i + 1, 0}, {1, i, 0}}});
      cap(3, {{{0, i, j}, {1, i, j}, {1, i + 1, j}, {0, i + 1, j}}});
    }
    for (std::size_t s = 0; s < 2; ++s) {
      if (k != (s == 0 ? 0 : nz_ - 2)) continue;
      for (std::size_t j = 0; j + 1 < ny_; ++j)
        for (std::size_t i = 0; i + 1 < nx_; ++i) {
          std::array<Corner, 4> c{{{s, i, j}, {s, i, j + 1}, {s, i + 1, j + 1}, {s, i + 1, j}}};
          if (s == 1) std::swap(c[1], c[3]);
          cap(4 + s, c);
        }
    }
  }

  [[nodiscard]] Contour finish() {
    if (cuts_ == 0) throw MeshError(nothing_crosses());
    Contour result;
    mesh::Surface& s = result.surface;
    s.nodes = Eigen::Map<const Points<3>>(points_.data(), 3, static_cast<Eigen::Index>(points_.size() / 3));
    std::vector<Index> cells = std::move(wall_);
    s.region.assign(cells.size() / 3, 0);
    s.region_names.emplace_back("wall");
    for (std::size_t f = 0; f < 6; ++f) {
      if (caps_[f].empty()) continue;
      const auto region = static_cast<Index>(s.region_names.size());
      s.region_names.emplace_back(border_names[f]);
      s.region.insert(s.region.end(), caps_[f].size() / 3, region);
      cells.insert(cells.end(), caps_[f].begin(), caps_[f].end());
      result.borders.push_back({.name = border_names[f], .region = region});
    }
    s.cells = Eigen::Map<const Connectivity<3>>(cells.data(), 3, static_cast<Eigen::Index>(cells.size() / 3));
    for (BorderContact& b : result.borders) {
      for (Index t = 0; t < s.cell_count(); ++t) {
        if (s.region_of(t) != b.region) continue;
        const mesh::Triangle f = mesh::triangle(s, t);
        b.area += f.area(), b.centre += f.area() * f.centroid();
      }
      b.centre /= b.area;
    }
    return result;
  }

  [[nodiscard]] std::string nothing_crosses() const {
    bool some_inside = false;
    for (std::size_t n = 0; n < image_.values.size() && !some_inside; ++n)
      some_inside = static_cast<double>(image_.values[n]) >= iso_ && (kept_.empty() || kept_[n] != 0);
    return "no edge of the grid crosses the iso-value " + seven_digits(iso_) + ": all of the image is " +
           (some_inside ? "inside" : "outside");
  }

  const image::Image<T>& image_;
  std::span<const std::uint8_t> kept_;
  double iso_;
  bool capped_;
  std::size_t nx_, ny_, nz_, cuts_ = 0;
  std::array<Slice, 2> slice_;
  std::vector<double> points_;
  std::vector<Index> wall_;
  std::array<std::vector<Index>, 6> caps_;
};

}  // namespace detail

/// The surface of {value >= iso} on the voxels kept (one byte a voxel, 0 is dropped; empty keeps all).
/// Vertices stand on the edges of the grid where the values of their nodes, linear along the edge, reach iso:
/// O(h^2) from the true surface. Normals point outward, the volume is positive, in the unit of the image.
/// MeshError when nothing crosses or an axis has a single sample.
template <class T>
[[nodiscard]] Contour marching_cubes(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                     double iso, const MarchingCubesOptions& options = {}) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& axis = image.axes[a];
    if (axis.size() < 2)
      throw MeshError("no edge of the grid crosses the iso-value: the image has " +
                      std::to_string(axis.size()) + " sample along axis " + std::string(1, "xyz"[a]) +
                      ", two are needed");
    for (std::size_t i = 0; i + 1 < axis.size(); ++i)
      TUNICA_EXPECT(axis[i] < axis[i + 1], "the coordinates of an axis increase");
  }
  TUNICA_EXPECT(image.values.size() == image.axes[0].size() * image.axes[1].size() * image.axes[2].size(),
                "an image has a value for each node of its grid");
  TUNICA_EXPECT(kept.empty() || kept.size() == image.values.size(), "the mask has one byte for each voxel");
  return detail::MarchingSweep<T>(image, kept, iso, options.border).run();
}

template <class T>
[[nodiscard]] Contour marching_cubes(const image::Image<T>& image, double iso,
                                     const MarchingCubesOptions& options = {}) {
  return marching_cubes(image, {}, iso, options);
}

}  // namespace tunica::meshing
