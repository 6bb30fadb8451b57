// SPDX-License-Identifier: MIT
// Sparsity pattern of a mesh and the scatter map from element matrices to its values, once per mesh.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/fem/cell_chunks.hpp"
#include "tunica/fem/node_graph.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::fem {

/// Assembly of matrices and vectors with N components a node; unknown c of node i is number N i + c.
///   Assembly<Hex8, 3> assembly(mesh);  auto K = assembly.matrix();          // once
///   assembly.clear(K);  assembly.for_each_cell([&](Index e) { assembly.add(e, Ke, K); });
/// for_each_cell visits chunks of cells colour by colour: no two chunks of a colour share a node, so
/// body may add to matrices and vectors on any number of threads, and the order of every sum, and so
/// its bits, depends on the mesh alone. The pattern is symmetric: both storage orders have the same.
template <mesh::Cell C, int N>
class Assembly {
 public:
  static constexpr int size = N * C::nodes;
  using ElementMatrix = Eigen::Matrix<double, size, size>;
  using ElementVector = Eigen::Matrix<double, size, 1>;

  template <int Dim>
  explicit Assembly(const mesh::Mesh<C, Dim>& mesh)
      : cells_(mesh.cells),
        graph_(node_graph<C::nodes>(mesh.cells, mesh.node_count())),
        chunks_(mesh.cells, mesh.node_count()) {
    position_.resize(static_cast<std::size_t>(cells_.cols()) * C::nodes * C::nodes);
    parallel_chunks(cells_.cols(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      std::size_t k = static_cast<std::size_t>(begin) * C::nodes * C::nodes;
      for (std::ptrdiff_t e = begin; e < end; ++e)
        for (int b = 0; b < C::nodes; ++b)
          for (int a = 0; a < C::nodes; ++a) position_[k++] = find(cells_(a, e), cells_(b, e));
    });
  }

  [[nodiscard]] const NodeGraph& graph() const { return graph_; }
  [[nodiscard]] Index node_count() const { return static_cast<Index>(graph_.start.size()) - 1; }
  [[nodiscard]] Index unknowns() const { return N * node_count(); }

  /// A matrix of zeros with the pattern of the mesh: unknowns() x unknowns(), compressed.
  template <int StorageOrder = Eigen::ColMajor>
  [[nodiscard]] Eigen::SparseMatrix<double, StorageOrder> matrix() const {
    Eigen::SparseMatrix<double, StorageOrder> A(unknowns(), unknowns());
    A.resizeNonZeros(static_cast<Eigen::Index>(graph_.neighbour.size()) * N * N);
    int* outer = A.outerIndexPtr();
    int* inner = A.innerIndexPtr();
    int k = 0;
    for (Index j = 0; j < node_count(); ++j)
      for (int c = 0; c < N; ++c) {
        outer[N * j + c] = k;
        for (Index p = at(graph_.start, j); p < at(graph_.start, j + 1); ++p)
          for (int r = 0; r < N; ++r) inner[k++] = N * at(graph_.neighbour, p) + r;
      }
    outer[unknowns()] = k;
    clear(A);
    return A;
  }

  template <class Matrix>
  void clear(Matrix& A) const {
    std::fill(A.valuePtr(), A.valuePtr() + A.nonZeros(), 0.0);
  }

  /// body(cell) for every cell, see above.
  template <class Body>
  void for_each_cell(Body&& body) const {
    chunks_.for_each([&](Index begin, Index end) {
      for (Index e = begin; e < end; ++e) body(e);
    });
  }

  /// A += scattered Ke (size x size); A came from matrix() and may be of either storage order.
  template <class Block, int StorageOrder>
  void add(Index cell, const Eigen::MatrixBase<Block>& Ke,
           Eigen::SparseMatrix<double, StorageOrder>& A) const {
    TUNICA_EXPECT(A.nonZeros() == static_cast<Eigen::Index>(graph_.neighbour.size()) * N * N,
                  "the matrix has not the pattern of this mesh");
    const Index* position = position_.data() + static_cast<std::size_t>(cell) * C::nodes * C::nodes;
    double* values = A.valuePtr();
    for (int b = 0; b < C::nodes; ++b) {
      const Index j = cells_(b, cell), start = at(graph_.start, j);
      const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(N) * graph_.degree(j);
      double* column = values + static_cast<std::ptrdiff_t>(start) * N * N;
      for (int a = 0; a < C::nodes; ++a, ++position)
        for (int c = 0; c < N; ++c)
          for (int r = 0; r < N; ++r) {
            double& value = column[c * stride + (*position - start) * N + r];
            if constexpr (StorageOrder == Eigen::RowMajor)
              value += Ke(N * b + c, N * a + r);
            else
              value += Ke(N * a + r, N * b + c);
          }
    }
  }

  /// b += scattered fe (size).
  template <class Block, class Vector>
  void add(Index cell, const Eigen::MatrixBase<Block>& fe, Eigen::MatrixBase<Vector>& b) const {
    for (int a = 0; a < C::nodes; ++a)
      b.template segment<N>(N * cells_(a, cell)) += fe.template segment<N>(N * a);
  }

  /// The values of x (unknowns) at the nodes of the cell.
  template <class Vector>
  [[nodiscard]] ElementVector gather(Index cell, const Eigen::MatrixBase<Vector>& x) const {
    ElementVector xe;
    for (int a = 0; a < C::nodes; ++a)
      xe.template segment<N>(N * a) = x.template segment<N>(N * cells_(a, cell));
    return xe;
  }

  /// Place of the pair (node, neighbour) in graph().neighbour: with N = 1 also in the values.
  [[nodiscard]] Index find(Index row, Index column) const { return graph_.find(row, column); }

  /// Places of the pairs (a, b) of a cell in graph().neighbour, column by column: C::nodes^2 numbers.
  [[nodiscard]] const Index* positions(Index cell) const {
    return position_.data() + static_cast<std::size_t>(cell) * C::nodes * C::nodes;
  }

 private:
  static Index at(const std::vector<Index>& v, Index i) { return v[static_cast<std::size_t>(i)]; }

  Connectivity<C::nodes> cells_;
  NodeGraph graph_;
  CellChunks chunks_;
  std::vector<Index> position_;  // of the block (a, b) of a cell in graph_.neighbour
};

}  // namespace tunica::fem
