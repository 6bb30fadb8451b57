// SPDX-License-Identifier: MIT
// Mesh motion by Laplace's equation for the displacement from the reference shape. [PEREZ08, (15)]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/fem/assembly.hpp"
#include "tunica/fem/p1_tets.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/motion/interleaved_cholesky.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::motion {

/// What the patches other than the moving wall do.
enum class Ends {
  fixed,   // stay where they are: the ends of the wall are held
  follow,  // are stretched like a membrane by the wall at their rims: within their planes if those are
};

struct LaplaceOptions {
  std::string wall = "wall";  // the patch that moves
  Ends ends = Ends::fixed;
  double stiffening = 1;  // chi: conductivity gamma = (mean volume / volume)^chi of a cell; 0: plain
};

/// Solves div(gamma grad d) = 0 on the reference mesh, d = the displacement of the wall. The operator is
/// factored once and serves the three components; nothing is remembered, so a wall that comes back
/// brings the whole mesh back. Symmetric positive definite.
class Laplace {
 public:
  explicit Laplace(const mesh::TetMesh& mesh, LaplaceOptions options = {})
      : wall_(mesh::patch_nodes(mesh.patch(options.wall))), node_count_(mesh.node_count()) {
    std::vector<char> known(static_cast<std::size_t>(node_count_), 0);
    for (const Index n : wall_) known[static_cast<std::size_t>(n)] = 1;
    if (options.ends == Ends::follow)
      for (const auto& patch : mesh.patches)
        if (patch.name != options.wall) {
          membranes_.push_back(membrane(mesh, patch, known));
          for (const Index n : membranes_.back().unknowns()) known[static_cast<std::size_t>(n)] = 1;
        }
    for (const auto& patch : mesh.patches)
      for (const Index n : mesh::patch_nodes(patch)) known[static_cast<std::size_t>(n)] = 1;

    fem::P1Tets tets;
    if (!tets.update(mesh.nodes, mesh.cells))
      throw MeshError("mesh motion: tetrahedron " + std::to_string(tets.inverted()) + " is inverted");
    double mean = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) mean += tets[e].volume / mesh.cell_count();
    const fem::Assembly<mesh::Tet4, 1> assembly(mesh);
    auto matrix = assembly.matrix();
    assembly.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = tets[e];
      const double weight = std::pow(mean / tet.volume, options.stiffening) * tet.volume;
      Eigen::Matrix4d Ke;  // gamma (grad N_i, grad N_j)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          Ke(i, j) = weight * (tet.grad(0, i) * tet.grad(0, j) + tet.grad(1, i) * tet.grad(1, j) +
                               tet.grad(2, i) * tet.grad(2, j));
      assembly.add(e, Ke, matrix);
    });
    volume_ = InterleavedCholesky(matrix, known);
  }

  /// Displacements of the wall's nodes (3 x wall nodes, ascending) to those of all nodes (3 x nodes) [m].
  [[nodiscard]] Points<3> extend(const Points<3>& wall_displacement) const {
    TUNICA_EXPECT(wall_displacement.cols() == static_cast<Eigen::Index>(wall_.size()),
                  "one column a wall node");
    Points<3> d = Points<3>::Zero(3, node_count_);
    for (std::size_t k = 0; k < wall_.size(); ++k)
      d.col(wall_[k]) = wall_displacement.col(static_cast<Eigen::Index>(k));
    for (const InterleavedCholesky& membrane : membranes_) membrane.solve(d);
    volume_.solve(d);
    return d;
  }

  [[nodiscard]] const std::vector<Index>& wall_nodes() const { return wall_; }  // ascending

 private:
  /// Laplace's equation on the triangles of a patch, for its nodes that are not known yet.
  static InterleavedCholesky membrane(const mesh::TetMesh& mesh, const mesh::Patch<mesh::Tri3>& patch,
                                      std::vector<char> known) {
    std::vector<char> here(known.size(), 0);
    for (const Index n : mesh::patch_nodes(patch)) here[static_cast<std::size_t>(n)] = 1;
    for (std::size_t n = 0; n < known.size(); ++n) known[n] = static_cast<char>(known[n] || !here[n]);
    mesh::Surface surface;
    surface.nodes = mesh.nodes;
    surface.cells = patch.faces;
    const fem::Assembly<mesh::Tri3, 1> assembly(surface);
    auto matrix = assembly.matrix();
    for (Index f = 0; f < surface.cell_count(); ++f) {
      double edge[3][3], product[3][3];  // edges opposite to each corner
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
          edge[i][c] =
              mesh.nodes(c, patch.faces((i + 2) % 3, f)) - mesh.nodes(c, patch.faces((i + 1) % 3, f));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          product[i][j] = edge[i][0] * edge[j][0] + edge[i][1] * edge[j][1] + edge[i][2] * edge[j][2];
      const double four_areas =  // |e0 x e1| = 2 area
          2 * std::sqrt(product[0][0] * product[1][1] - product[0][1] * product[0][1]);
      Eigen::Matrix<double, 3, 3> Ke;  // (grad N_i, grad N_j)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) Ke(i, j) = product[i][j] / four_areas;
      assembly.add(f, Ke, matrix);
    }
    return InterleavedCholesky(matrix, known);
  }

  std::vector<Index> wall_;
  Index node_count_;
  std::vector<InterleavedCholesky> membranes_;
  InterleavedCholesky volume_;
};

}  // namespace tunica::motion
