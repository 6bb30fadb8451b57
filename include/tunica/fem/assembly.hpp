// SPDX-License-Identifier: MIT
// Sparsity pattern of a mesh and the scatter map from element matrices to its values, once per mesh.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::fem {

/// Which nodes share a cell with which, in compressed columns, each ascending and with the node itself.
struct NodeGraph {
  std::vector<Index> start;  // node count + 1
  std::vector<Index> neighbour;

  [[nodiscard]] Index degree(Index node) const {
    return start[static_cast<std::size_t>(node) + 1] - start[static_cast<std::size_t>(node)];
  }
};

template <int Nodes>
[[nodiscard]] NodeGraph node_graph(const Connectivity<Nodes>& cells, Index node_count) {
  const auto n = static_cast<std::size_t>(node_count);
  std::vector<Index> first(n + 1, 0), cell_of(static_cast<std::size_t>(cells.size()));
  for (Eigen::Index k = 0; k < cells.size(); ++k) ++first[static_cast<std::size_t>(cells.data()[k]) + 1];
  for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
  std::vector<Index> fill(first.begin(), first.end() - 1);
  for (Eigen::Index e = 0; e < cells.cols(); ++e)
    for (int a = 0; a < Nodes; ++a)
      cell_of[static_cast<std::size_t>(fill[static_cast<std::size_t>(cells(a, e))]++)] =
          static_cast<Index>(e);
  NodeGraph graph;
  graph.start.assign(n + 1, 0);
  std::vector<Index> around;
  for (std::size_t i = 0; i < n; ++i) {
    around.assign(1, static_cast<Index>(i));
    for (Index k = first[i]; k < first[i + 1]; ++k)
      for (int a = 0; a < Nodes; ++a) around.push_back(cells(a, cell_of[static_cast<std::size_t>(k)]));
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    graph.neighbour.insert(graph.neighbour.end(), around.begin(), around.end());
    graph.start[i + 1] = static_cast<Index>(graph.neighbour.size());
  }
  return graph;
}

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
      : cells_(mesh.cells), graph_(node_graph<C::nodes>(mesh.cells, mesh.node_count())) {
    position_.resize(static_cast<std::size_t>(cells_.cols()) * C::nodes * C::nodes);
    std::size_t k = 0;
    for (Eigen::Index e = 0; e < cells_.cols(); ++e)
      for (int b = 0; b < C::nodes; ++b)
        for (int a = 0; a < C::nodes; ++a) position_[k++] = find(cells_(a, e), cells_(b, e));
    colour_chunks(mesh.node_count());
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
    for (std::size_t colour = 0; colour + 1 < colour_start_.size(); ++colour) {
      const std::size_t first = colour_start_[colour];
      const auto chunks = static_cast<std::ptrdiff_t>(colour_start_[colour + 1] - first);
      parallel_chunks(chunks, 1, [&](std::ptrdiff_t b, std::ptrdiff_t) {
        const Index begin = chunk_[first + static_cast<std::size_t>(b)] * chunk_size_;
        const Index end = std::min(begin + chunk_size_, static_cast<Index>(cells_.cols()));
        for (Index e = begin; e < end; ++e) body(e);
      });
    }
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
  [[nodiscard]] Index find(Index row, Index column) const {
    const auto begin = graph_.neighbour.begin() + at(graph_.start, column);
    const auto end = graph_.neighbour.begin() + at(graph_.start, column + 1);
    const auto it = std::lower_bound(begin, end, row);
    TUNICA_EXPECT(it != end && *it == row, "the two nodes share no cell");
    return static_cast<Index>(it - graph_.neighbour.begin());
  }

  /// Places of the pairs (a, b) of a cell in graph().neighbour, column by column: C::nodes^2 numbers.
  [[nodiscard]] const Index* positions(Index cell) const {
    return position_.data() + static_cast<std::size_t>(cell) * C::nodes * C::nodes;
  }

 private:
  static Index at(const std::vector<Index>& v, Index i) { return v[static_cast<std::size_t>(i)]; }

  void colour_chunks(Index node_count) {
    constexpr int colours = 64;  // a chunk that finds none of them free gets a colour of its own
    const auto cells = static_cast<Index>(cells_.cols());
    chunk_size_ = std::clamp<Index>(cells / 64, 16, 1024);
    const Index chunks = (cells + chunk_size_ - 1) / chunk_size_;
    std::vector<std::uint64_t> used(static_cast<std::size_t>(node_count), 0);
    std::array<std::vector<Index>, colours> of_colour;
    std::vector<Index> alone;
    for (Index k = 0; k < chunks; ++k) {
      const Index end = std::min(cells, (k + 1) * chunk_size_);
      std::uint64_t taken = 0;
      for (Index e = k * chunk_size_; e < end; ++e)
        for (int a = 0; a < C::nodes; ++a) taken |= used[static_cast<std::size_t>(cells_(a, e))];
      const int colour = std::countr_one(taken);
      if (colour == colours) {
        alone.push_back(k);
        continue;
      }
      for (Index e = k * chunk_size_; e < end; ++e)
        for (int a = 0; a < C::nodes; ++a)
          used[static_cast<std::size_t>(cells_(a, e))] |= std::uint64_t{1} << colour;
      of_colour[static_cast<std::size_t>(colour)].push_back(k);
    }
    colour_start_.assign(1, 0);
    for (const auto& list : of_colour) {
      if (list.empty()) continue;
      chunk_.insert(chunk_.end(), list.begin(), list.end());
      colour_start_.push_back(chunk_.size());
    }
    for (const Index k : alone) {
      chunk_.push_back(k);
      colour_start_.push_back(chunk_.size());
    }
  }

  Connectivity<C::nodes> cells_;
  NodeGraph graph_;
  std::vector<Index> position_;            // of the block (a, b) of a cell in graph_.neighbour
  std::vector<Index> chunk_;               // chunk numbers, colour by colour
  std::vector<std::size_t> colour_start_;  // in chunk_
  Index chunk_size_ = 1;                   // [cells]
};

}  // namespace tunica::fem
