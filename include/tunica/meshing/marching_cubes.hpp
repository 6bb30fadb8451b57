// SPDX-License-Identifier: MIT
// Marching cubes on a rectilinear grid [LORENSEN87]: a closed, manifold, oriented surface for every input.
// A node equal to the iso-value is inside; where the inside meets the border of the image, a flat cap.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/cut_numbers.hpp"
#include "tunica/meshing/marching_caps.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// The cells of a row that the contour passes: 64 at a time, those whose corners are not all alike.
class CellRow {
 public:
  CellRow(const SignBits& bits, std::size_t j, std::size_t k)
      : bits_(bits), row_{bits.row(j, k), bits.row(j + 1, k), bits.row(j, k + 1), bits.row(j + 1, k + 1)} {}

  /// visit(i, case) for each.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t w = 0; w < bits_.words(); ++w) {
      const std::array<std::uint64_t, 4> low{row_[0][w], row_[1][w], row_[2][w], row_[3][w]};
      const std::uint64_t any = low[0] | low[1] | low[2] | low[3], all = low[0] & low[1] & low[2] & low[3];
      if (any == 0 && (w + 1 == bits_.words() ||
                       ((row_[0][w + 1] | row_[1][w + 1] | row_[2][w + 1] | row_[3][w + 1]) & 1U) == 0))
        continue;
      std::array<std::uint64_t, 4> high{};
      for (std::size_t r = 0; r < 4; ++r) high[r] = bits_.next(row_[r], w);
      std::uint64_t mixed =
          ((any | high[0] | high[1] | high[2] | high[3]) & ~(all & high[0] & high[1] & high[2] & high[3])) &
          bits_.with_next(w);
      for (; mixed != 0; mixed &= mixed - 1) {
        const auto n = static_cast<unsigned>(std::countr_zero(mixed));
        unsigned signs = 0;  // corner (x, y, z) is bit x + 2 y + 4 z
        for (unsigned r = 0; r < 4; ++r)
          signs |= static_cast<unsigned>((low[r] >> n & 1U) | (high[r] >> n & 1U) << 1U) << 2 * r;
        visit(word_bits * w + n, signs);
      }
    }
  }

 private:
  const SignBits& bits_;
  std::array<const std::uint64_t*, 4> row_;
};

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
    const std::vector<Index> first = triangles_before();
    const Index wall = first.back();
    Index nodes = cuts_.count(), triangles = wall;
    if (caps_) {
      nodes += static_cast<Index>(caps_->nodes().size());
      for (const auto& face : caps_->triangles()) triangles += static_cast<Index>(face.size() / 3);
    }
    s.nodes.resize(3, nodes), s.cells.resize(3, triangles);
    s.region.assign(static_cast<std::size_t>(triangles), 0);
    s.region_names.emplace_back("wall");
    const std::ptrdiff_t slab = static_cast<std::ptrdiff_t>(nz_ - 2) / thread_count() + 1;  // slices
    parallel_chunks(static_cast<std::ptrdiff_t>(nz_ - 1), slab,
                    [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                      fill(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), first, s);
                    });
    if (caps_) add_caps(wall, result);
    return result;
  }

 private:
  /// Numbers of the cut edges at the nodes of a slice, valid where an edge is cut.
  struct SliceNumbers {
    std::array<std::unique_ptr<Index[]>, 3> of;
    explicit SliceNumbers(std::size_t n) {
      for (auto& o : of) o = std::make_unique_for_overwrite<Index[]>(n);
    }
  };

  [[nodiscard]] std::vector<Index> triangles_before() const {
    const auto& table = marching_table();
    const std::size_t rows = (ny_ - 1) * (nz_ - 1);
    std::vector<Index> first(rows + 1, 0);
    parallel_chunks(
        static_cast<std::ptrdiff_t>(rows), rows_a_chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
            Index count = 0;
            CellRow(bits_, r % (ny_ - 1), r / (ny_ - 1)).for_each([&](std::size_t, unsigned signs) {
              count += table[signs].count;
            });
            first[r + 1] = count;
          }
        });
    for (std::size_t r = 0; r < rows; ++r) first[r + 1] += first[r];
    return first;
  }

  /// The slabs of cells from slice begin to slice end; the flat cuts of slice begin are another's, but of 0.
  void fill(std::size_t begin, std::size_t end, const std::vector<Index>& first, mesh::Surface& s) const {
    SliceNumbers lower(nx_ * ny_), upper(nx_ * ny_);
    double* nodes = s.nodes.data();
    flat(begin, lower, begin == 0 ? nodes : nullptr);
    for (std::size_t k = begin; k < end; ++k) {
      flat(k + 1, upper, nodes);
      upright(k, lower, nodes);
      for (std::size_t j = 0; j + 1 < ny_; ++j) {
        const std::size_t row = j + (ny_ - 1) * k;
        if (first[row] < first[row + 1])
          cells(j, k, lower, upper, s.cells.data() + 3 * std::ptrdiff_t{first[row]});
      }
      std::swap(lower, upper);
    }
  }

  /// Numbers the cut edges within slice k, and writes where they are cut unless nodes is null.
  void flat(std::size_t k, SliceNumbers& numbers, double* nodes) const {
    for (std::size_t j = 0; j < ny_; ++j) {
      auto [number, end] = cuts_.flat(j, k);
      if (number == end) continue;
      const T* v = image_.values.data() + nx_ * (j + ny_ * k);
      for (std::size_t w = 0; w < bits_.words(); ++w) {
        const CutWords cut = cuts_.words(w, j, k);
        for (std::uint64_t some = cut.x | cut.y; some != 0; some &= some - 1) {
          const auto n = static_cast<unsigned>(std::countr_zero(some));
          const std::size_t i = word_bits * w + n, at = i + nx_ * j;
          const bool inside = (bits_.row(j, k)[w] >> n & 1U) != 0;
          if ((cut.x >> n & 1U) != 0) {
            if (nodes) place(nodes, number, {i, j, k}, 0, inside, v[i], v[i + 1]);
            numbers.of[0][at] = number++;
          }
          if ((cut.y >> n & 1U) != 0) {
            if (nodes) place(nodes, number, {i, j, k}, 1, inside, v[i], v[i + nx_]);
            numbers.of[1][at] = number++;
          }
        }
      }
    }
  }

  /// The same of the cut edges from slice k to the next.
  void upright(std::size_t k, SliceNumbers& numbers, double* nodes) const {
    for (std::size_t j = 0; j < ny_; ++j) {
      auto [number, end] = cuts_.upright(j, k);
      if (number == end) continue;
      const T* v = image_.values.data() + nx_ * (j + ny_ * k);
      for (std::size_t w = 0; w < bits_.words(); ++w)
        for (std::uint64_t cut = cuts_.words(w, j, k).z; cut != 0; cut &= cut - 1) {
          const auto n = static_cast<unsigned>(std::countr_zero(cut));
          const std::size_t i = word_bits * w + n;
          place(nodes, number, {i, j, k}, 2, (bits_.row(j, k)[w] >> n & 1U) != 0, v[i], v[i + nx_ * ny_]);
          numbers.of[2][i + nx_ * j] = number++;
        }
    }
  }

  /// The cut of the edge from node (i, j, k) in +axis, p and q the values at its ends.
  void place(double* nodes, Index number, const std::array<std::size_t, 3>& at, std::size_t axis,
             bool first_inside, T p, T q) const {
    double* x = nodes + 3 * std::ptrdiff_t{number};
    for (std::size_t a = 0; a < 3; ++a) x[a] = image_.axes[a][at[a]];
    const double lo = x[axis], hi = image_.axes[axis][at[axis] + 1];
    const auto from = static_cast<double>(p), to = static_cast<double>(q);
    x[axis] = first_inside ? lo + cut_fraction(from, to, iso_) * (hi - lo)
                           : hi - cut_fraction(to, from, iso_) * (hi - lo);
  }

  /// The triangles of the cells (., j, k), three numbers each.
  void cells(std::size_t j, std::size_t k, const SliceNumbers& lower, const SliceNumbers& upper,
             Index* triangles) const {
    const auto& table = marching_table();
    std::array<const Index*, 12> number;  // edge 4a + u + 2v of a cell has offsets u, v along axes a+1, a+2
    for (std::size_t e = 0; e < 12; ++e) {
      const std::size_t a = e / 4;
      std::array<std::size_t, 3> offset{};
      offset[(a + 1) % 3] = e % 4 & 1U, offset[(a + 2) % 3] = e % 4 >> 1U;
      number[e] = (offset[2] == 0 ? lower : upper).of[a].get() + offset[0] + nx_ * (j + offset[1]);
    }
    CellRow(bits_, j, k).for_each([&](std::size_t i, unsigned signs) {
      const MarchingCase& c = table[signs];
      for (std::size_t t = 0; t < static_cast<std::size_t>(c.count); ++t)
        for (const std::int8_t e : c.triangle[t]) *triangles++ = number[static_cast<std::size_t>(e)][i];
    });
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
