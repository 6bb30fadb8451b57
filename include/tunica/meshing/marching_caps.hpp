// SPDX-License-Identifier: MIT
// Flat caps where the inside meets the border of the image: marching squares on its six faces.
#pragma once

#include "tunica/meshing/cut_numbers.hpp"
#include "tunica/meshing/sign_bits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing::detail {

/// The inside nodes of the border are nodes of the surface, numbered after the cut edges.
class MarchingCaps {
 public:
  using Node = std::array<std::size_t, 3>;

  /// size: nodes along each axis.
  MarchingCaps(const SignBits& bits, const CutNumbers& cuts, const Node& size)
      : bits_(bits), cuts_(cuts), size_(size) {
    const auto [nx, ny, nz] = size;
    first_.reserve(ny * nz);
    for (std::size_t k = 0; k < nz; ++k)
      for (std::size_t j = 0; j < ny; ++j) {
        first_.push_back(static_cast<Index>(nodes_.size()));
        if (!bits.any(j, k)) continue;
        for (std::size_t i = 0; i < nx; i += whole(j, k) ? 1 : nx - 1)
          if (bits.inside(i, j, k)) nodes_.push_back({i, j, k});
      }
    if (nodes_.empty()) return;
    for (std::size_t k = 0; k + 1 < nz; ++k) {
      for (std::size_t j = 0; j + 1 < ny; ++j) {
        const std::size_t i = nx - 1;
        cap(0, {{{0, j, k}, {0, j, k + 1}, {0, j + 1, k + 1}, {0, j + 1, k}}});
        cap(1, {{{i, j, k}, {i, j + 1, k}, {i, j + 1, k + 1}, {i, j, k + 1}}});
      }
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        const std::size_t j = ny - 1;
        cap(2, {{{i, 0, k}, {i + 1, 0, k}, {i + 1, 0, k + 1}, {i, 0, k + 1}}});
        cap(3, {{{i, j, k}, {i, j, k + 1}, {i + 1, j, k + 1}, {i + 1, j, k}}});
      }
    }
    for (std::size_t j = 0; j + 1 < ny; ++j)
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        const std::size_t k = nz - 1;
        cap(4, {{{i, j, 0}, {i, j + 1, 0}, {i + 1, j + 1, 0}, {i + 1, j, 0}}});
        cap(5, {{{i, j, k}, {i + 1, j, k}, {i + 1, j + 1, k}, {i, j + 1, k}}});
      }
  }

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Node numbers, three a triangle, of each face of the image.
  [[nodiscard]] const std::array<std::vector<Index>, 6>& triangles() const { return triangles_; }

 private:
  [[nodiscard]] bool inside(const Node& n) const { return bits_.inside(n[0], n[1], n[2]); }

  /// All of the row is border, or its ends only.
  [[nodiscard]] bool whole(std::size_t j, std::size_t k) const {
    return k == 0 || k + 1 == size_[2] || j == 0 || j + 1 == size_[1];
  }

  [[nodiscard]] Index number(const Node& node) const {
    const auto [i, j, k] = node;
    Index n = cuts_.count() + first_[j + size_[1] * k];
    if (!whole(j, k)) return n + (i > 0 && bits_.inside(0, j, k) ? 1 : 0);
    const std::uint64_t* row = bits_.row(j, k);
    for (std::size_t w = 0; w < i / word_bits; ++w) n += bits_set(row[w]);
    return n + bits_set(row[i / word_bits] & first_bits(i % word_bits));
  }

  [[nodiscard]] Index cut_between(const Node& p, const Node& q) const {
    const std::size_t axis = p[0] != q[0] ? 0 : p[1] != q[1] ? 1 : 2;
    const Node& low = p[axis] < q[axis] ? p : q;
    return cuts_.number(axis, low[0], low[1], low[2]);
  }

  /// The inside of one face of the border, corners counter-clockwise from outside: marching squares by the
  /// rule of the table, inside corners of an ambiguous face apart.
  void cap(std::size_t face, const std::array<Node, 4>& corner) {
    const auto in = [&](std::size_t n) { return inside(corner[n % 4]); };
    auto& out = triangles_[face];
    const int count = in(0) + in(1) + in(2) + in(3);
    if (count == 0) return;
    if (count == 4) {
      const std::array<Index, 4> v{number(corner[0]), number(corner[1]), number(corner[2]),
                                   number(corner[3])};
      out.insert(out.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
      return;
    }
    for (std::size_t n = 0; n < 4; ++n) {
      if (in(n) || !in(n + 1)) continue;
      std::array<Index, 5> v{};  // cut, one to three nodes, cut
      std::size_t size = 0, m = n + 1;
      v[size++] = cut_between(corner[n], corner[(n + 1) % 4]);
      for (; in(m); ++m) v[size++] = number(corner[m % 4]);
      v[size++] = cut_between(corner[(m - 1) % 4], corner[m % 4]);
      const std::size_t apex = size / 2;  // a node that is collinear with no two of the others
      for (std::size_t e = 0; e < size; ++e)
        if (const std::size_t f = (e + 1) % size; e != apex && f != apex)
          out.insert(out.end(), {v[apex], v[e], v[f]});
    }
  }

  const SignBits& bits_;
  const CutNumbers& cuts_;
  Node size_;
  std::vector<Node> nodes_;   // row by row
  std::vector<Index> first_;  // of a row
  std::array<std::vector<Index>, 6> triangles_;
};

}  // namespace tunica::meshing::detail
