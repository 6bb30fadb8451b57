// SPDX-License-Identifier: MIT
// The hexahedra of the inside nodes of a grid [PEREZ08, 3.2.2], and between them and the dual contour a layer
// of cells (a pillow [MITCHELL95]), so that each has one face on a smooth surface.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/contour_sheets.hpp"
#include "tunica/meshing/dual_contouring.hpp"
#include "tunica/meshing/dual_parts.hpp"
#include "tunica/meshing/hex_complex.hpp"
#include "tunica/meshing/loop_cells.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

/// A hexahedron for each inside node: its corners are in the cells around it, one for each part of the inside
/// corners that a cell's loops leave together. So hexahedra that touch across an ambiguous face have corners
/// of their own wherever the contour passes between them, and the layer over the contour always fits.
class DualComplexBuilder {
 public:
  DualComplexBuilder(const HermiteGrid& grid, const mesh::QuadSurface& contour)
      : grid_(grid),
        contour_(contour),
        stride_(grid.strides()),
        cells_(grid),
        sheets_(contour, flat_facets(grid)) {}

  [[nodiscard]] HexComplex run() {
    surface_nodes();
    lattice_nodes();
    lattice_cells();
    layers();
    return std::move(out_);
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] static std::vector<char> flat_facets(const HermiteGrid& grid) {
    std::vector<char> flat;
    for (const auto& r : grid.regions) flat.push_back(r.flat ? 1 : 0);
    return flat;
  }

  Index add(const Vec3& x, const HexSite& site) {
    out_.nodes.push_back(x), out_.sites.push_back(site);
    return static_cast<Index>(out_.nodes.size()) - 1;
  }

  /// The contour's nodes keep their numbers. A node of a rim between two sheets stays on the rim; beside it
  /// each of the two gets a node.
  void surface_nodes() {
    const Index count = contour_.node_count();
    on_sheet_.assign(at(count), {-1, -1});
    for (Index n = 0; n < count; ++n) {
      HexSite site;
      std::array<Index, 2> sheet{-1, -1};
      sheets_.around(n, [&](Index q) {
        const Index f = sheets_.facet(q), s = sheets_.sheet(q);
        if (site.facet < 0) {
          site.facet = f;
        } else if (f != site.facet && site.other < 0) {
          site.other = f;
        } else if (f != site.facet && f != site.other) {
          site.corner = true;
        }
        if (sheet[0] < 0)
          sheet[0] = s;
        else if (s != sheet[0])
          sheet[1] = s;
      });
      if (site.other >= 0 && site.other < site.facet) std::swap(site.other, site.facet);
      add(vec::column(contour_.nodes, n), site);
      if (sheet[1] >= 0) rim_nodes_.push_back(n);
    }
    for (const Index n : rim_nodes_) {
      const HexSite site = out_.sites[at(n)];
      const Vec3 x = out_.nodes[at(n)];
      // the flat facet has the sheet of its own
      const bool first = grid_.regions[at(site.facet)].flat && sheet_of(site.facet, n) != 0;
      const Index flat = first ? site.facet : site.other, wall = first ? site.other : site.facet;
      on_sheet_[at(n)][0] = add(x, {.facet = wall});
      on_sheet_[at(n)][1] = add(x, {.facet = flat});
    }
  }

  [[nodiscard]] Index sheet_of(Index facet, Index node) const {
    Index sheet = 0;
    sheets_.around(node, [&](Index q) {
      if (sheets_.facet(q) == facet) sheet = sheets_.sheet(q);
    });
    return sheet;
  }

  /// The node in which the layer of a sheet ends above a node of the contour.
  [[nodiscard]] Index top(Index node, Index sheet) const {
    const auto& pair = on_sheet_[at(node)];
    return pair[0] < 0 ? node : pair[sheet != 0 ? 1 : 0];
  }

  [[nodiscard]] unsigned signs(std::size_t node) const {
    unsigned set = 0;
    for (unsigned c = 0; c < 8; ++c) set |= unsigned(grid_.inside[corner(node, c)] != 0) << c;
    return set;
  }
  [[nodiscard]] std::size_t corner(std::size_t node, unsigned c) const {
    return node + (c & 1U) + (c & 2U ? stride_[1] : 0) + (c & 4U ? stride_[2] : 0);
  }

  void lattice_nodes() {
    parts_.reserve(cells_.count());
    first_.reserve(cells_.count());
    for (std::size_t c = 0; c < cells_.count(); ++c) {
      const std::size_t node = cells_.node(c);
      parts_.push_back(cell_parts(signs(node), cells_.loops(c)));
      first_.push_back(static_cast<Index>(out_.nodes.size()));
      std::array<Vec3, 8> sum;
      std::array<int, 8> count{};
      sum.fill(Vec3(0, 0, 0));
      for (unsigned k = 0; k < 8; ++k) {
        const std::int8_t p = parts_.back().part[k];
        if (p < 0) continue;
        sum[static_cast<std::size_t>(p)] =
            vec::plus(sum[static_cast<std::size_t>(p)], grid_.point(corner(node, k)));
        ++count[static_cast<std::size_t>(p)];
      }
      // half-way between the inside corners of a part and the contour over it
      for (std::size_t p = 0; p < static_cast<std::size_t>(parts_.back().count); ++p) {
        Vec3 foot(0, 0, 0);
        int feet = 0;
        for (int e = 0; e < 12; ++e) {
          if (cells_.loops(c).loop[static_cast<std::size_t>(e)] < 0) continue;
          const auto& ends = cell_tables.edge_corners[static_cast<std::size_t>(e)];
          const bool low =
              parts_.back().part[static_cast<std::size_t>(ends[0])] == static_cast<std::int8_t>(p);
          const bool high =
              parts_.back().part[static_cast<std::size_t>(ends[1])] == static_cast<std::int8_t>(p);
          if (low || high) foot = vec::plus(foot, vec::column(contour_.nodes, cells_.vertex(c, e))), ++feet;
        }
        add(vec::between(vec::divided(sum[p], count[p]), vec::divided(foot, feet), 0.5), {});
      }
    }
  }

  void lattice_cells() {
    const std::size_t nx = grid_.size(0), ny = grid_.size(1), nz = grid_.size(2);
    std::vector<Index> number(nx * ny * nz, -1);  // of the node in each cell; below -1: its place in the list
    for (std::size_t c = 0; c < cells_.count(); ++c) number[cells_.node(c)] = -2 - static_cast<Index>(c);
    for (std::size_t k = 1; k + 1 < nz; ++k)
      for (std::size_t j = 1; j + 1 < ny; ++j)
        for (std::size_t i = 1; i + 1 < nx; ++i) {
          const std::size_t node = i + nx * (j + ny * k);
          if (grid_.inside[node] == 0) continue;
          std::array<Index, 8> hex{};
          for (std::size_t c = 0; c < 8; ++c) {
            const auto& [u, v, w] = hex_offsets[c];
            const std::size_t cell = node - (1 - u) - (1 - v) * stride_[1] - (1 - w) * stride_[2];
            Index& n = number[cell];
            if (n == -1) {
              const Vec3 lo = grid_.point(cell), hi = grid_.point(corner(cell, 7));
              n = add(vec::between(lo, hi, 0.5), {});
            }
            const std::size_t own =
                (1 - u) | (1 - v) << 1 | (1 - w) << 2;  // the node as a corner of the cell
            hex[c] = n >= 0 ? n : first_[at(-2 - n)] + parts_[at(-2 - n)].part[own];
          }
          out_.cells.push_back(hex);
        }
    out_.lattice_cells = static_cast<Index>(out_.cells.size());
  }

  /// The lattice node below a corner of a quadrilateral of the contour.
  [[nodiscard]] std::array<Index, 4> below(Index q) const {
    const std::size_t edge = grid_.edges[at(q)], node = edge / 3, a = edge % 3, b = (a + 1) % 3,
                      c = (a + 2) % 3;
    const bool low_inside = grid_.inside[node] != 0;
    // as in dual_contour: the cells round the edge, with the edge's offsets in them
    const std::array<std::pair<std::size_t, unsigned>, 4> ring{
        {{node - stride_[b] - stride_[c], 3}, {node - stride_[c], 2}, {node, 0}, {node - stride_[b], 1}}};
    std::array<Index, 4> result{};
    for (std::size_t n = 0; n < 4; ++n) {
      const auto& [cell, offsets] = ring[low_inside ? n : 3 - n];
      const std::size_t own = (low_inside ? 0 : 1U) << a | (offsets & 1U) << b | (offsets >> 1) << c;
      const std::size_t place = cells_.find(cell);
      result[n] = first_[place] + parts_[place].part[own];
    }
    return result;
  }

  void face(Index a, Index b, Index c, Index d, Index facet) {
    out_.border.push_back({a, b, c, d}), out_.facet.push_back(facet);
  }

  void layers() {
    for (Index q = 0; q < contour_.cell_count(); ++q) {
      const auto b = below(q);
      const Index sheet = sheets_.sheet(q), facet = sheets_.facet(q);
      std::array<Index, 4> t{};
      for (int k = 0; k < 4; ++k) t[at(k)] = top(contour_.cells(k, q), sheet);
      out_.cells.push_back({b[0], b[1], b[2], b[3], t[0], t[1], t[2], t[3]});
      face(t[0], t[1], t[2], t[3], facet);
      if (sheet != 0) continue;
      for (int k = 0; k < 4; ++k) {
        const Index across = sheets_.twin(4 * q + k) / 4;
        if (sheets_.sheet(across) == 0) continue;
        // a cell along the rim: from a to b, from the lattice to the wall, from the lattice to the end
        const Index l = (k + 1) % 4, ra = contour_.cells(k, q), rb = contour_.cells(l, q);
        const Index ca = on_sheet_[at(ra)][1], cb = on_sheet_[at(rb)][1], wa = t[at(k)], wb = t[at(l)];
        out_.cells.push_back({b[at(k)], b[at(l)], wb, wa, ca, cb, rb, ra});
        face(wb, wa, ra, rb, facet);
        face(ca, cb, rb, ra, sheets_.facet(across));
      }
    }
  }

  const HermiteGrid& grid_;
  const mesh::QuadSurface& contour_;
  std::array<std::size_t, 3> stride_;
  LoopCells cells_;
  ContourSheets sheets_;
  std::vector<std::array<Index, 2>>
      on_sheet_;  // of a rim node: the nodes beside it on sheet 0 and on the end
  std::vector<Index> rim_nodes_;
  std::vector<CellParts> parts_;  // of the cells that the contour crosses
  std::vector<Index> first_;      // node of the first part
  HexComplex out_;
};

}  // namespace detail

/// contour: dual_contour of the grid. Each of its faces bears one cell, each edge of the rim of a flat end
/// one more, which has a face on the wall and one on the end.
[[nodiscard]] inline HexComplex dual_complex(const HermiteGrid& grid, const mesh::QuadSurface& contour) {
  return detail::DualComplexBuilder(grid, contour).run();
}

}  // namespace tunica::meshing
