// SPDX-License-Identifier: MIT
// What must hold of a mesh of hexahedra: faces that match, and a positive determinant at any point.
#pragma once

#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/quality.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace tunica::test {

/// Faces of one cell only, as the patches have them; each inner face must have two cells that run it in
/// opposite directions.
struct HexFaces {
  int border = 0, unmatched = 0, in_patches = 0, missing = 0;
};
[[nodiscard]] inline HexFaces hex_faces(const mesh::HexMesh& m) {
  std::map<std::array<Index, 4>, std::vector<std::array<Index, 4>>> all;
  const auto key = [](std::array<Index, 4> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  const auto turned = [](std::array<Index, 4> f) {  // to begin with the least node
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    return f;
  };
  for (Index c = 0; c < m.cell_count(); ++c)
    for (const auto& face : mesh::Hex8::faces) {
      const std::array<Index, 4> f{m.cells(face[0], c), m.cells(face[1], c), m.cells(face[2], c),
                                   m.cells(face[3], c)};
      all[key(f)].push_back(turned(f));
    }
  HexFaces result;
  std::set<std::array<Index, 4>> border;
  for (auto& [nodes, uses] : all) {
    if (uses.size() == 1) {
      ++result.border, border.insert(uses.front());
    } else {
      auto back = uses[1];
      std::reverse(back.begin() + 1, back.end());
      if (uses.size() != 2 || back != uses[0]) ++result.unmatched;
    }
  }
  for (const auto& p : m.patches)
    for (Eigen::Index q = 0; q < p.faces.cols(); ++q) {
      ++result.in_patches;
      if (border.erase(turned({p.faces(0, q), p.faces(1, q), p.faces(2, q), p.faces(3, q)})) == 0)
        ++result.missing;
    }
  result.missing += static_cast<int>(border.size());
  return result;
}

[[nodiscard]] inline mesh::QuadSurface border_of(const mesh::HexMesh& m) {
  mesh::QuadSurface s;
  s.nodes = m.nodes;
  for (const auto& p : m.patches) {
    const Eigen::Index before = s.cells.cols();
    s.cells.conservativeResize(4, before + p.faces.cols());
    s.cells.rightCols(p.faces.cols()) = p.faces;
  }
  return s;
}

/// The least determinant of the trilinear map over that at the centre, at so many random points of each cell.
[[nodiscard]] inline double least_determinant(const mesh::HexMesh& m, int points) {
  constexpr std::array<std::array<int, 3>, 8> side{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  std::uint64_t seed = 1;
  const auto random = [&] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed >> 11) * 0x1p-53;
  };
  double least = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < m.cell_count(); ++c) {
    const auto x = mesh::corners(m, c);
    const auto determinant = [&](const Vec3& t) {
      Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
      for (std::size_t k = 0; k < 8; ++k)
        for (int a = 0; a < 3; ++a) {
          double w = side[k][static_cast<std::size_t>(a)] != 0 ? 1 : -1;
          for (int b = 0; b < 3; ++b)
            if (b != a) w *= side[k][static_cast<std::size_t>(b)] != 0 ? t[b] : 1 - t[b];
          J.col(a) += w * x[k];
        }
      return J.determinant();
    };
    const double centre = determinant(Vec3::Constant(0.5));
    for (int p = 0; p < points; ++p)
      least = std::min(least, determinant(Vec3(random(), random(), random())) / std::abs(centre));
    least = std::min(least, centre / std::abs(centre));
  }
  return least;
}

}  // namespace tunica::test
