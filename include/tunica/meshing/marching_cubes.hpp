// SPDX-License-Identifier: MIT
// Marching cubes on a rectilinear grid [LORENSEN87]: a closed, manifold, oriented surface for every input.
// A node equal to the iso-value is inside; where the inside meets the border of the image, a flat cap.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/image/require_grid.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/cut_numbers.hpp"
#include "tunica/meshing/large_pages.hpp"
#include "tunica/meshing/marching_caps.hpp"
#include "tunica/meshing/marching_cells.hpp"
#include "tunica/meshing/marching_triangles.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
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

/// All cut edges and triangles are counted first, so that each row knows where its own go: rows are filled in
/// slabs of slices, on any number of threads, to the same bits.
template <class T>
class MarchingSweep {
 public:
  MarchingSweep(const image::Image<T>& image, std::span<const std::uint8_t> kept, double iso, Border border)
      : image_(image),
        iso_(iso),
        nx_(image.axes[0].size()),
        ny_(image.axes[1].size()),
        nz_(image.axes[2].size()),
        bits_(image, kept, iso),
        cuts_(bits_, ny_, nz_) {
    if (cuts_.count() == 0) throw MeshError(nothing_crosses());
    if (border == Border::capped) caps_.emplace(bits_, cuts_, MarchingCaps::Node{nx_, ny_, nz_});
  }

  [[nodiscard]] Contour run() {
    Contour result;
    mesh::Surface& s = result.surface;
    const std::ptrdiff_t layers = static_cast<std::ptrdiff_t>(nz_ - 1);
    const std::ptrdiff_t slab = (layers - 1) / thread_count() + 1;
    std::vector<MarchingCells> cells(static_cast<std::size_t>((layers + slab - 1) / slab));
    parallel_chunks(layers, slab, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      cells[static_cast<std::size_t>(begin / slab)] =
          MarchingCells(bits_, nx_, ny_, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    });
    std::vector<Index> first(1, 0);  // triangle of a slab
    for (const MarchingCells& c : cells) first.push_back(first.back() + c.triangles());
    const Index wall = first.back();
    Index nodes = cuts_.count(), triangles = wall;
    if (caps_) {
      nodes += static_cast<Index>(caps_->nodes().size());
      for (const auto& face : caps_->triangles()) triangles += static_cast<Index>(face.size() / 3);
    }
    s.nodes.resize(3, nodes), s.cells.resize(3, triangles);
    s.region.reserve(static_cast<std::size_t>(triangles));
    large_pages(s.nodes.data(), sizeof(double) * static_cast<std::size_t>(s.nodes.size()));
    large_pages(s.cells.data(), sizeof(Index) * static_cast<std::size_t>(s.cells.size()));
    large_pages(s.region.data(), sizeof(Index) * s.region.capacity());
    s.region.assign(static_cast<std::size_t>(triangles), 0);
    s.region_names.emplace_back("wall");
    parallel_chunks(layers, slab, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const auto c = static_cast<std::size_t>(begin / slab);
      fill(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), cells[c],
           {s.cells.data() + 3 * std::ptrdiff_t{first[c]}, s.cells.data() + 3 * std::ptrdiff_t{first[c + 1]}},
           s.nodes.data());
    });
    if (caps_) add_caps(wall, result);
    return result;
  }

 private:
  /// The slabs of cells from slice begin to slice end; the flat cuts of slice begin are another's, but of 0.
  void fill(std::size_t begin, std::size_t end, const MarchingCells& cells, std::span<Index> triangles,
            double* nodes) const {
    const MarchingSteps& steps = marching_steps();
    const std::uint8_t* signs = cells.signs();
    const Index* in_row = cells.in_row();
    Index* out = triangles.data();
    const Index* limit = out + triangles.size();
    if (begin == 0) flat(0, nodes);
    for (std::size_t k = begin; k < end; ++k) {
      flat(k + 1, nodes);
      upright(k, nodes);
      for (std::size_t j = 0; j + 1 < ny_; ++j, ++in_row) {
        if (*in_row == 0) continue;
        const auto a = cuts_.starts(j, k), b = cuts_.starts(j + 1, k), c = cuts_.starts(j, k + 1),
                   d = cuts_.starts(j + 1, k + 1);
        out = write_triangles(signs, *in_row, {a.x, b.x, c.x, d.x, a.y, c.y, a.z, b.z}, steps, out, limit);
        signs += *in_row;
      }
    }
  }

  /// Where the edges within slice k are cut.
  void flat(std::size_t k, double* nodes) const {
    for (std::size_t j = 0; j < ny_; ++j) {
      const auto here = cuts_.starts(j, k), next = cuts_.starts(j + 1, k);
      if (here.x < here.y) place<0>(j, k, nodes + 3 * std::ptrdiff_t{here.x});
      if (here.y < next.x) place<1>(j, k, nodes + 3 * std::ptrdiff_t{here.y});
    }
  }

  /// Where the edges from slice k to the next are cut.
  void upright(std::size_t k, double* nodes) const {
    for (std::size_t j = 0; j < ny_; ++j) {
      const Index here = cuts_.starts(j, k).z;
      if (here < cuts_.starts(j + 1, k).z) place<2>(j, k, nodes + 3 * std::ptrdiff_t{here});
    }
  }

  /// The cuts of a row in +axis, one after the other.
  template <std::size_t axis>
  void place(std::size_t j, std::size_t k, double* x) const {
    const std::array<std::size_t, 3> stride{1, nx_, nx_ * ny_}, at{0, j, k};
    const T* v = image_.values.data() + nx_ * (j + ny_ * k);
    const double* along = image_.axes[0].data();
    const std::array<double, 3> here{0, image_.axes[1][j], image_.axes[2][k]};
    // of an edge in +y or +z: where it starts and how it goes on, from its outside node if that is the lower
    // one
    std::array<double, 2> from{}, step{};
    if constexpr (axis != 0) {
      from = {image_.axes[axis][at[axis] + 1], image_.axes[axis][at[axis]]};
      step = {from[1] - from[0], from[0] - from[1]};
    }
    const std::uint64_t* row = bits_.row(j, k);
    for (std::size_t w = 0; w < bits_.words(); ++w) {
      std::uint64_t cut = 0;
      if constexpr (axis == 0) cut = (row[w] ^ bits_.next(row, w)) & bits_.with_next(w);
      if constexpr (axis == 1) cut = row[w] ^ bits_.row(j + 1, k)[w];
      if constexpr (axis == 2) cut = row[w] ^ bits_.row(j, k + 1)[w];
      for (; cut != 0; cut &= cut - 1, x += 3) {
        const auto n = static_cast<unsigned>(std::countr_zero(cut));
        const std::size_t i = word_bits * w + n, inside = row[w] >> n & 1U, outside = inside ^ 1U;
        const double t = cut_fraction(static_cast<double>(v[i + outside * stride[axis]]),
                                      static_cast<double>(v[i + inside * stride[axis]]), iso_);
        x[0] = along[i], x[1] = here[1], x[2] = here[2];
        if constexpr (axis == 0)
          x[0] = along[i + outside] + t * (along[i + inside] - along[i + outside]);
        else
          x[axis] = from[inside] + t * step[inside];
      }
    }
  }

  void add_caps(Index triangle, Contour& result) const {
    mesh::Surface& s = result.surface;
    Index node = cuts_.count();
    for (const auto& at : caps_->nodes())
      s.nodes.col(node++) = Vec3(image_.axes[0][at[0]], image_.axes[1][at[1]], image_.axes[2][at[2]]);
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& corners = caps_->triangles()[f];
      if (corners.empty()) continue;
      BorderContact contact{.name = border_names[f], .region = static_cast<Index>(s.region_names.size())};
      s.region_names.emplace_back(border_names[f]);
      for (std::size_t c = 0; c < corners.size(); c += 3, ++triangle) {
        s.cells.col(triangle) << corners[c], corners[c + 1], corners[c + 2];
        s.region[static_cast<std::size_t>(triangle)] = contact.region;
        const mesh::Triangle t = mesh::triangle(s, triangle);
        contact.area += t.area(), contact.centre += t.area() * t.centroid();
      }
      contact.centre /= contact.area;
      result.borders.push_back(contact);
    }
  }

  [[nodiscard]] std::string nothing_crosses() const {
    return "no edge of the grid crosses the iso-value " + seven_digits(iso_) + ": all of the image is " +
           (bits_.any() ? "inside" : "outside");
  }

  const image::Image<T>& image_;
  double iso_;
  std::size_t nx_, ny_, nz_;
  SignBits bits_;
  CutNumbers cuts_;
  std::optional<MarchingCaps> caps_;
};

}  // namespace detail

/// The surface of {value >= iso} on the voxels kept (one byte a voxel, 0 is dropped; empty keeps all).
/// Vertices stand on the edges of the grid where the values of their nodes, linear along the edge, reach iso:
/// O(h^2) from the true surface. Normals point outward, the volume is positive, in the unit of the image.
/// The same bits on any number of threads. MeshError when nothing crosses or an axis has a single sample.
template <class T>
[[nodiscard]] Contour marching_cubes(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                     double iso, const MarchingCubesOptions& options = {}) {
  image::require_grid(image, kept);
  return detail::MarchingSweep<T>(image, kept, iso, options.border).run();
}

template <class T>
[[nodiscard]] Contour marching_cubes(const image::Image<T>& image, double iso,
                                     const MarchingCubesOptions& options = {}) {
  return marching_cubes(image, {}, iso, options);
}

}  // namespace tunica::meshing
