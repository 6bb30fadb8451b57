// SPDX-License-Identifier: MIT
// Matrices of linear tetrahedra in a perturbed cube: diffusion and linear elasticity, faces x0 and x1 held.
#pragma once

#include "tunica/fem/p1_tets.hpp"
#include "tunica/la/vector_ops.hpp"
#include "tunica/meshing/box.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tunica::test {

/// Numbers in [-1, 1) from a generator of fixed definition.
class Noise {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1;
  }
  Eigen::VectorXd vector(Eigen::Index n) {
    Eigen::VectorXd v(n);
    for (double& x : v) x = (*this)();
    return v;
  }

 private:
  std::uint64_t state_ = 7;
};

/// The unit cube in 6 n^3 Kuhn tetrahedra whose nodes move by up to `noise` of a spacing each way, those of
/// a side within it.
[[nodiscard]] inline mesh::TetMesh perturbed_cube(int n, double noise = 0.15) {
  auto mesh = meshing::box_tets({.cells = {n, n, n}});
  Noise random;
  for (Index node = 0; node < mesh.nodes.cols(); ++node)
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double move = noise / n * random(), x = mesh.nodes(a, node);
      if (x > 1e-9 && x < 1 - 1e-9) mesh.nodes(a, node) = x + move;
    }
  return mesh;
}

/// The nodes that are not held in the order of the mesh: node -> unknown, -1 on x = 0 and x = 1.
struct FreeNodes {
  std::vector<int> of;
  int count = 0;

  explicit FreeNodes(const mesh::TetMesh& mesh, bool hold = true) {
    for (Index node = 0; node < mesh.nodes.cols(); ++node) {
      const double x = mesh.nodes(0, node);
      of.push_back(hold && (x == 0 || x == 1) ? -1 : count++);
    }
  }
};

/// Rows of C x C blocks as a matrix of scalars; block(e, tet, a, b, out) makes those of cell e.
template <int C, class Block>
[[nodiscard]] la::RowMatrix tet_matrix(const mesh::TetMesh& mesh, const FreeNodes& nodes, Block&& block) {
  using Entry = std::pair<int, std::array<double, std::size_t{C} * C>>;
  std::vector<std::vector<Entry>> rows(static_cast<std::size_t>(nodes.count));
  for (auto& row : rows) row.reserve(16);
  for (Index e = 0; e < mesh.cells.cols(); ++e) {
    const auto tet = fem::p1_tet(mesh.nodes, mesh.cells, e);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const int i = nodes.of[static_cast<std::size_t>(mesh.cells(a, e))];
        const int j = nodes.of[static_cast<std::size_t>(mesh.cells(b, e))];
        if (i < 0 || j < 0) continue;
        auto& row = rows[static_cast<std::size_t>(i)];
        auto at = std::find_if(row.begin(), row.end(), [&](const Entry& entry) { return entry.first == j; });
        if (at == row.end()) at = row.insert(row.end(), Entry{j, {}});
        block(e, tet, a, b, at->second);
      }
  }
  la::RowMatrix A(C * nodes.count, C * nodes.count);
  std::size_t entries = 0;
  for (const auto& row : rows) entries += row.size() * C * C;
  A.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int at = 0, line = 0;
  A.outerIndexPtr()[0] = 0;
  for (auto& row : rows) {
    std::sort(row.begin(), row.end(), [](const Entry& l, const Entry& r) { return l.first < r.first; });
    for (std::size_t r = 0; r < C; ++r) {
      for (const auto& [column, values] : row)
        for (std::size_t c = 0; c < C; ++c) {
          A.innerIndexPtr()[at] = C * column + static_cast<int>(c);
          A.valuePtr()[at++] = values[r * C + c];
        }
      A.outerIndexPtr()[++line] = at;
    }
  }
  return A;
}

/// - div (k grad u), k(e) of a cell.
template <class Coefficient>
[[nodiscard]] la::RowMatrix diffusion(const mesh::TetMesh& mesh, const FreeNodes& nodes, Coefficient&& k) {
  return tet_matrix<1>(mesh, nodes, [&](Index e, const fem::P1Tet& tet, int a, int b, auto& out) {
    out[0] += k(e) * tet.volume * tet.grad.col(a).dot(tet.grad.col(b));
  });
}
[[nodiscard]] inline la::RowMatrix diffusion(const mesh::TetMesh& mesh, bool hold = true) {
  return diffusion(mesh, FreeNodes(mesh, hold), [](Index) { return 1.0; });
}

/// Linear elasticity, mu = 1, three unknowns a node.
[[nodiscard]] inline la::RowMatrix elasticity(const mesh::TetMesh& mesh, const FreeNodes& nodes,
                                              double kappa) {
  const double lambda = kappa - 2.0 / 3;
  return tet_matrix<3>(mesh, nodes, [&](Index, const fem::P1Tet& tet, int a, int b, auto& out) {
    const Vec3 p = tet.grad.col(a), q = tet.grad.col(b);
    for (Eigen::Index r = 0; r < 3; ++r)
      for (Eigen::Index c = 0; c < 3; ++c)
        out[static_cast<std::size_t>(3 * r + c)] +=
            tet.volume * (lambda * p[r] * q[c] + p[c] * q[r] + (r == c ? p.dot(q) : 0.0));
  });
}

/// Points of the free nodes.
[[nodiscard]] inline Points<3> free_points(const mesh::TetMesh& mesh, const FreeNodes& nodes) {
  Points<3> x(3, nodes.count);
  for (std::size_t node = 0; node < nodes.of.size(); ++node)
    if (nodes.of[node] >= 0) x.col(nodes.of[node]) = mesh.nodes.col(static_cast<Eigen::Index>(node));
  return x;
}

}  // namespace tunica::test
