// SPDX-License-Identifier: MIT
// Straight tubes: a structured wall of Hex8, whole or a quarter, and its lumen filled with Tet4.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/faces_on.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// The wall of a straight tube about the z axis, 0 <= z <= length.
struct Tube {
  double inner_radius;                  // [m]
  double thickness;                     // [m]
  double length;                        // [m]
  std::array<int, 3> cells{1, 24, 20};  // radial, around, along
};

/// The inside of a straight tube about the z axis, 0 <= z <= length. Triangles of the section are
/// nearly equilateral when cells[1] = 6 cells[0].
struct Lumen {
  double radius;                        // [m]
  double length;                        // [m]
  std::array<int, 3> cells{4, 24, 20};  // across the radius, around, along
};

namespace detail {

/// Point j of n on the unit circle; exact on the axes.
[[nodiscard]] inline Point<2> circle_point(Index j, Index n) {
  static constexpr std::array<std::array<double, 2>, 4> axis{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  if (4 * j % n == 0) {
    const auto& p = axis[static_cast<std::size_t>(4 * j / n % 4)];
    return {p[0], p[1]};
  }
  const double angle = 2 * std::numbers::pi * j / n;
  return {std::cos(angle), std::sin(angle)};
}

/// The wall from angle 0 over `around` of `circle` divisions; closed when they are equal.
/// Node (i radial, j around, k along) is i + (radial+1) (j + columns k).
[[nodiscard]] inline mesh::HexMesh tube_sector(const Tube& tube, Index circle) {
  const auto [radial, around, along] = tube.cells;
  TUNICA_EXPECT(radial > 0 && around > 0 && along > 0 && circle >= 3, "a tube needs cells in each direction");
  TUNICA_EXPECT(tube.inner_radius > 0 && tube.thickness > 0 && tube.length > 0, "a tube has positive sizes");
  const Index columns = around == circle ? around : around + 1, rows = radial + 1;
  mesh::HexMesh mesh;
  mesh.nodes.resize(3, rows * columns * (along + 1));
  const auto node = [&](Index i, Index j, Index k) { return i + rows * (j % columns + columns * k); };
  for (Index k = 0; k <= along; ++k)
    for (Index j = 0; j < columns; ++j)
      for (Index i = 0; i < rows; ++i) {
        const double r = tube.inner_radius + tube.thickness * i / radial;
        mesh.nodes.col(node(i, j, k)) << r * circle_point(j, circle), tube.length * k / along;
      }
  mesh.cells.resize(8, radial * around * along);
  Eigen::Index cell = 0;
  for (Index k = 0; k < along; ++k)
    for (Index j = 0; j < around; ++j)
      for (Index i = 0; i < radial; ++i, ++cell)
        for (std::size_t c = 0; c < 8; ++c) {
          const auto& o = box_corners[c];
          mesh.cells(static_cast<Eigen::Index>(c), cell) = node(i + o[0], j + o[1], k + o[2]);
        }
  const Index layer = rows * columns;
  mesh.patches.push_back(faces_on(mesh, "inner", [&](Index n) { return n % rows == 0; }));
  mesh.patches.push_back(faces_on(mesh, "outer", [&](Index n) { return n % rows == radial; }));
  mesh.patches.push_back(faces_on(mesh, "end0", [&](Index n) { return n / layer == 0; }));
  mesh.patches.push_back(faces_on(mesh, "end1", [&](Index n) { return n / layer == along; }));
  mesh::Patch<mesh::Quad4> ends{"ends", {}};
  const auto &end0 = mesh.patches[2].faces, &end1 = mesh.patches[3].faces;
  ends.faces.resize(4, end0.cols() + end1.cols());
  ends.faces << end0, end1;
  mesh.patches.push_back(std::move(ends));
  if (columns > around) {
    mesh.patches.push_back(faces_on(mesh, "sym_y", [&](Index n) { return n / rows % columns == 0; }));
    mesh.patches.push_back(faces_on(mesh, "sym_x", [&](Index n) { return n / rows % columns == around; }));
  }
  return mesh;
}

/// A triangulated disc of radius 1: the centre, then concentric rings of ever more points; the
/// outer ring holds the last `around` points.
struct Disc {
  Points<2> points;
  std::vector<std::array<Index, 3>> triangles;  // counter-clockwise
  Index rim;                                    // the first point of the outer ring
};

[[nodiscard]] inline Disc disc(Index across, Index around) {
  TUNICA_EXPECT(across > 0 && around >= 3, "a disc needs a ring of at least three points");
  std::vector<Index> count{1}, first{0};
  for (Index r = 1; r <= across; ++r) {
    first.push_back(first.back() + count.back());
    count.push_back(std::max<Index>(3, (2 * around * r + across) / (2 * across)));
  }
  count.back() = around;
  Disc disc;
  disc.rim = first.back();
  disc.points.resize(2, disc.rim + around);
  disc.points.col(0).setZero();
  for (Index r = 1; r <= across; ++r) {
    const auto ring = static_cast<std::size_t>(r);
    const Index in = first[ring - 1], out = first[ring], m = count[ring - 1], n = count[ring];
    for (Index j = 0; j < n; ++j) disc.points.col(out + j) = circle_point(j, n) * (double(r) / across);
    // Between two rings the edge whose middle comes first around the circle is joined next.
    for (Index i = 0, j = 0; i < (m > 1 ? m : 0) || j < n;) {
      if (j < n && (m == 1 || (2 * j + 1) * m <= (2 * i + 1) * n)) {
        disc.triangles.push_back({in + i % m, out + j, out + (j + 1) % n});
        ++j;
      } else {
        disc.triangles.push_back({in + i, out + j % n, in + (i + 1) % m});
        ++i;
      }
    }
  }
  return disc;
}

}  // namespace detail

/// Structured Hex8 wall. Patches "inner", "outer", "end0" (z = 0), "end1" (z = length), "ends".
[[nodiscard]] inline mesh::HexMesh tube(const Tube& shape) {
  return detail::tube_sector(shape, shape.cells[1]);
}

/// The quarter x, y >= 0 with cells[1] cells around the quarter. Also "sym_x" (x = 0), "sym_y" (y = 0).
[[nodiscard]] inline mesh::HexMesh quarter_tube(const Tube& shape) {
  return detail::tube_sector(shape, 4 * shape.cells[1]);
}

/// Tetrahedra: a triangulated disc, extruded; each prism is three tetrahedra whose diagonals follow
/// the numbering of the disc, up in even layers and down in odd ones, so that no twist is favoured.
/// Patches "wall" (nodes exactly on the radius), "inlet" (z = 0), "outlet" (z = length).
[[nodiscard]] inline mesh::TetMesh lumen(const Lumen& shape) {
  const auto [across, around, along] = shape.cells;
  TUNICA_EXPECT(along > 0, "a lumen needs cells along it");
  TUNICA_EXPECT(shape.radius > 0 && shape.length > 0, "a lumen has positive sizes");
  const detail::Disc disc = detail::disc(across, around);
  const auto layer = static_cast<Index>(disc.points.cols());
  mesh::TetMesh mesh;
  mesh.nodes.resize(3, layer * (along + 1));
  for (Index k = 0; k <= along; ++k)
    for (Index n = 0; n < layer; ++n)
      mesh.nodes.col(k * layer + n) << shape.radius * disc.points.col(n), shape.length * k / along;
  mesh.cells.resize(4, 3 * static_cast<Eigen::Index>(disc.triangles.size()) * along);
  Eigen::Index cell = 0;
  for (Index k = 0; k < along; ++k)
    for (const auto& triangle : disc.triangles) {
      // Rotate the lowest number to the front; the order of the other two is the parity.
      auto [a, b, c] = triangle;
      while (a > b || a > c) a = std::exchange(b, std::exchange(c, a));
      const bool rising = k % 2 == 0;
      const Index lo = rising ? k * layer : (k + 1) * layer, hi = rising ? (k + 1) * layer : k * layer;
      const bool odd = b > c;
      if (odd) std::swap(b, c);
      // a < b < c: every upright face is cut from its lower number at lo to its higher one at hi.
      const std::array<std::array<Index, 4>, 3> tets{{{lo + a, lo + b, lo + c, hi + c},
                                                      {lo + a, lo + b, hi + c, hi + b},
                                                      {lo + a, hi + a, hi + b, hi + c}}};
      for (const auto& tet : tets) {
        mesh.cells.col(cell) << tet[0], tet[1], tet[2], tet[3];
        if (odd == rising) std::swap(mesh.cells(2, cell), mesh.cells(3, cell));
        ++cell;
      }
    }
  mesh.patches.push_back(faces_on(mesh, "wall", [&](Index n) { return n % layer >= disc.rim; }));
  mesh.patches.push_back(faces_on(mesh, "inlet", [&](Index n) { return n / layer == 0; }));
  mesh.patches.push_back(faces_on(mesh, "outlet", [&](Index n) { return n / layer == along; }));
  return mesh;
}

/// The lumen of that tube, its wall nodes those of the tube's "inner" (matching interfaces).
[[nodiscard]] inline mesh::TetMesh lumen(const Tube& shape) {
  return lumen(Lumen{.radius = shape.inner_radius,
                     .length = shape.length,
                     .cells = {std::max(1, (shape.cells[1] + 3) / 6), shape.cells[1], shape.cells[2]}});
}

}  // namespace tunica::meshing
