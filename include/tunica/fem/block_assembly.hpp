// SPDX-License-Identifier: MIT
// Assembly in block rows of element matrices that come as packs: the lanes are elements.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/pack.hpp"
#include "tunica/fem/cell_chunks.hpp"
#include "tunica/fem/lane_transpose.hpp"
#include "tunica/fem/node_graph.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace tunica::fem {

/// The cells of W lanes, consecutive ones; lanes from `count` on repeat the last cell, and what they compute
/// is dropped.
template <int W>
struct CellPack {
  Index cell[W];
  int count;
};

/// The pattern of a mesh with N unknowns a node and the place of each element block in it, once per mesh.
///   BlockAssembly<Hex8, 3> assembly(mesh, la::BlockStorage::upper);  auto K = assembly.matrix();  // once
///   assembly.for_each_pack<Lanes<S>::count>(K, [&](const auto& pack) {     // S: double or Pack<double>
///     S x[8][3], Ke[assembly.pairs][9];
///     assembly.gather(pack, mesh.nodes, x);  my_kernel(x, Ke);  assembly.add_symmetric(pack, Ke, K);
///   });
/// Chunks of cells are visited colour by colour and the lanes of a pack are added in the order of their
/// cells, so that every sum has the same order, and the matrix the same bits, on any number of threads. The
/// matrix is a BlockMatrix<N>, or for N = 1 an Eigen matrix by rows from rows().
template <mesh::Cell C, int N>
class BlockAssembly {
 public:
  static constexpr int nodes = C::nodes, pairs = nodes * (nodes + 1) / 2, block = N * N;
  static constexpr Index lanes = 16;  // chunks are multiples of it: any width up to it fills its packs

  /// Place of the block (a, b), a <= b, of a symmetric element matrix: row by row.
  [[nodiscard]] static constexpr int pair(int a, int b) { return a * nodes - a * (a - 1) / 2 + b - a; }

  template <int Dim>
  explicit BlockAssembly(const mesh::Mesh<C, Dim>& mesh, la::BlockStorage storage = la::BlockStorage::full)
      : cells_(mesh.cells),
        graph_(node_graph<C::nodes>(mesh.cells, mesh.node_count())),
        chunks_(mesh.cells, mesh.node_count(), lanes),
        storage_(storage),
        stride_(storage == la::BlockStorage::full ? nodes * nodes : pairs) {
    if (storage == la::BlockStorage::upper) keep_upper(graph_);
    place_.resize(static_cast<std::size_t>(cells_.cols()) * stride_);
    at_end_.assign(static_cast<std::size_t>(cells_.cols() / lanes) + 1, 0);
    for (Eigen::Index k = 0; k < cells_.size(); ++k)
      if (cells_.data()[k] == node_count() - 1) at_end_[static_cast<std::size_t>(k / nodes / lanes)] = 1;
    parallel_chunks(cells_.cols(), 1024, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t e = begin; e < end; ++e) find_places(static_cast<Index>(e));
    });
  }

  [[nodiscard]] la::BlockStorage storage() const { return storage_; }
  [[nodiscard]] Index node_count() const { return static_cast<Index>(graph_.start.size()) - 1; }
  [[nodiscard]] Index unknowns() const { return N * node_count(); }
  [[nodiscard]] const Connectivity<C::nodes>& cells() const { return cells_; }

  /// Zeros in the pattern of the mesh.
  template <class T = double>
  [[nodiscard]] la::BlockMatrix<N, T> matrix() const {
    return {graph_.start, graph_.neighbour, storage_};
  }
  /// The same as Eigen's compressed rows, for one unknown a node.
  [[nodiscard]] Eigen::SparseMatrix<double, Eigen::RowMajor> rows() const requires(N == 1) {
    TUNICA_EXPECT(storage_ == la::BlockStorage::full, "Eigen's rows hold both triangles");
    Eigen::SparseMatrix<double, Eigen::RowMajor> A(unknowns(), unknowns());
    A.resizeNonZeros(static_cast<Eigen::Index>(graph_.neighbour.size()));
    std::copy(graph_.start.begin(), graph_.start.end(), A.outerIndexPtr());
    std::copy(graph_.neighbour.begin(), graph_.neighbour.end(), A.innerIndexPtr());
    std::fill(A.valuePtr(), A.valuePtr() + A.nonZeros(), 0.0);
    return A;
  }

  /// body(pack) for all cells in packs of W; the blocks of A that the next pack adds to are fetched
  /// meanwhile.
  template <int W, class Matrix, class Body>
  void for_each_pack(const Matrix& A, Body&& body) const {
    for_each_pack_then<W>(body, [&](const CellPack<W>& next) { prefetch(next, values_of(A)); });
  }
  /// The same without a matrix: residuals, actions of a tangent.
  template <int W, class Body>
  void for_each_pack(Body&& body) const {
    for_each_pack_then<W>(body, [](const CellPack<W>&) {});
  }

  /// x[a][i]: component i of column `node a` of the points (Dim x nodes) or of a vector of Dim numbers a
  /// node.
  template <class S, int Dim, class Values>
  TUNICA_INLINE void gather(const CellPack<Lanes<S>::count>& pack, const Values& values,
                            S (&x)[nodes][Dim]) const {
    if constexpr (Dim == 3 && has_wide_registers<S>) {
      if (!at_end(pack.cell[0]) && !at_end(pack.cell[Lanes<S>::count - 1])) {
        for (int a = 0; a < nodes; ++a)
          triples_to_lanes(
              values.data(), [&](int l) { return corners(pack.cell[l])[a]; }, x[a]);
        return;
      }
    }
    gather_by_rows(pack, values.data(), x);
  }

  /// A += symmetric element matrices, of which blocks (a, b) with a <= b are given by rows, at K[pair(a, b)].
  template <class S, class Matrix>
  TUNICA_INLINE void add_symmetric(const CellPack<Lanes<S>::count>& pack, const S (&K)[pairs][block],
                                   Matrix& A) const {
    const Elements<S, pairs> elements(K);
    auto* const values = values_of(A);
    for (int l = 0; l < pack.count; ++l) {
      const Index* const place = places_of(pack.cell[l]);
      if (storage_ == la::BlockStorage::upper) {
        for (int p = 0; p < pairs; ++p) {
          if (place[p] >= 0)
            elements.add(l, p, values + block * std::ptrdiff_t{place[p]});
          else
            elements.add_turned(l, p, values + block * std::ptrdiff_t{~place[p]});
        }
      } else {
        for (int a = 0, p = 0; a < nodes; ++a)
          for (int b = a; b < nodes; ++b, ++p) {
            elements.add(l, p, values + block * std::ptrdiff_t{place[nodes * a + b]});
            if (b > a) elements.add_turned(l, p, values + block * std::ptrdiff_t{place[nodes * b + a]});
          }
      }
    }
  }

  /// A += element matrices of any kind, each block by rows: K[nodes * a + b]. The storage is full.
  template <class S, class Matrix>
  TUNICA_INLINE void add(const CellPack<Lanes<S>::count>& pack, const S (&K)[nodes * nodes][block],
                         Matrix& A) const {
    TUNICA_EXPECT(storage_ == la::BlockStorage::full, "the upper triangle takes symmetric element matrices");
    const Elements<S, nodes * nodes> elements(K);
    auto* const values = values_of(A);
    for (int l = 0; l < pack.count; ++l) {
      const Index* const place = places_of(pack.cell[l]);
      for (int p = 0; p < nodes * nodes; ++p) elements.add(l, p, values + block * std::ptrdiff_t{place[p]});
    }
  }

  /// b += element vectors f[a][i], b with N numbers a node.
  template <class S, class Vector>
  TUNICA_INLINE void add(const CellPack<Lanes<S>::count>& pack, const S (&f)[nodes][N], Vector& b) const {
    using T = typename Lanes<S>::type;
    alignas(64) T row[Lanes<S>::count][nodes * N];
    lanes_to_rows<nodes * N>(&f[0][0], &row[0][0], nodes * N);
    for (int l = 0; l < pack.count; ++l) {
      const Index* const node = corners(pack.cell[l]);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < N; ++i) b.data()[std::ptrdiff_t{N} * node[a] + i] += row[l][N * a + i];
    }
  }

 private:
  /// The blocks of a pack, lane by lane: numbers of a block are brought together, single ones stay where they
  /// are.
  template <class S, int Blocks>
  struct Elements {
    using T = typename Lanes<S>::type;
    static constexpr int width = Lanes<S>::count, size = Blocks * block;
    static constexpr bool brought = block > 1 && width > 1;
    const S* K;
    alignas(64) T row[brought ? size * width : 1];

    TUNICA_INLINE explicit Elements(const S (&blocks)[Blocks][block]) : K(&blocks[0][0]) {
      if constexpr (brought) lanes_to_rows<size>(K, row, size);
    }
    /// Number k of all blocks in a row.
    [[nodiscard]] TUNICA_INLINE T number(int lane, int k) const {
      if constexpr (brought) return row[lane * size + k];
      T value;
      __builtin_memcpy(&value, reinterpret_cast<const char*>(K + k) + sizeof(T) * static_cast<unsigned>(lane),
                       sizeof value);
      return value;
    }
    template <class To>
    TUNICA_INLINE void add(int lane, int p, To* to) const {
#pragma GCC unroll 16
      for (int k = 0; k < block; ++k) to[k] += number(lane, block * p + k);
    }
    template <class To>
    TUNICA_INLINE void add_turned(int lane, int p, To* to) const {
#pragma GCC unroll 4
      for (int r = 0; r < N; ++r)
#pragma GCC unroll 4
        for (int c = 0; c < N; ++c) to[r * N + c] += number(lane, block * p + c * N + r);
    }
  };

  template <class S, int Dim, class T>
  void gather_by_rows(const CellPack<Lanes<S>::count>& pack, const T* values, S (&x)[nodes][Dim]) const {
    using To = typename Lanes<S>::type;
    alignas(64) To row[Lanes<S>::count][nodes * Dim];
    for (int l = 0; l < Lanes<S>::count; ++l) {
      const Index* const node = corners(pack.cell[l]);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < Dim; ++i)
          row[l][Dim * a + i] = static_cast<To>(values[std::ptrdiff_t{Dim} * node[a] + i]);
    }
    rows_to_lanes<nodes * Dim>(&row[0][0], nodes * Dim, &x[0][0]);
  }

  /// True if the cell, or one beside it, has the last node, behind which nothing may be read.
  [[nodiscard]] bool at_end(Index cell) const {
    return at_end_[static_cast<std::size_t>(cell / lanes)] != 0;
  }

  template <int W, class Body, class Next>
  void for_each_pack_then(Body& body, Next&& fetch) const {
    static_assert(lanes % W == 0, "a pack has at most 16 lanes");
    chunks_.for_each([&](Index begin, Index end) {
      CellPack<W> pack = pack_at<W>(begin, end);
      for (Index e = begin; e < end; e += W) {
        const CellPack<W> next = pack_at<W>(std::min(e + W, end - 1), end);
        fetch(next);
        body(pack);
        pack = next;
      }
    });
  }

  template <int W>
  static CellPack<W> pack_at(Index first, Index end) {
    CellPack<W> pack;
    for (int l = 0; l < W; ++l) pack.cell[l] = std::min<Index>(first + l, end - 1);
    pack.count = std::min<Index>(W, end - first);
    return pack;
  }

  template <int W, class T>
  TUNICA_INLINE void prefetch(const CellPack<W>& pack, const T* values) const {
    constexpr int line = 64 / static_cast<int>(sizeof(T));
    for (int l = 0; l < pack.count; ++l) {
      const Index* const place = places_of(pack.cell[l]);
      for (std::size_t p = 0; p < stride_; ++p) {
        const T* const at = values + block * std::ptrdiff_t{place[p] < 0 ? ~place[p] : place[p]};
        for (int k = 0; k < block; k += line) __builtin_prefetch(at + k, 1);
        if constexpr ((block - 1) % line != 0) __builtin_prefetch(at + block - 1, 1);
      }
    }
  }

  template <class Matrix>
  static auto* values_of(Matrix& A) {
    if constexpr (requires { A.valuePtr(); }) {
      static_assert(N == 1 && std::remove_cvref_t<Matrix>::IsRowMajor,
                    "Eigen's rows take one unknown a node");
      return A.valuePtr();
    } else {
      static_assert(std::remove_cvref_t<Matrix>::block_rows == N, "a matrix has N unknowns a node");
      return A.values();
    }
  }

  [[nodiscard]] const Index* corners(Index cell) const {
    return cells_.data() + std::ptrdiff_t{nodes} * cell;
  }
  [[nodiscard]] const Index* places_of(Index cell) const {
    return place_.data() + stride_ * static_cast<std::size_t>(cell);
  }

  void find_places(Index cell) {
    const Index* const node = corners(cell);
    Index* place = place_.data() + stride_ * static_cast<std::size_t>(cell);
    const bool full = storage_ == la::BlockStorage::full;
    for (int a = 0; a < nodes; ++a)
      for (int b = full ? 0 : a; b < nodes; ++b) {
        const Index row = node[a], column = node[b];
        if (full || row <= column)
          *place++ =
              graph_.find(column, row);  // the graph's columns are the rows here: the pattern is symmetric
        else
          *place++ = ~graph_.find(row, column);
      }
  }

  Connectivity<C::nodes> cells_;
  NodeGraph graph_;  // with `upper`, of each node those from itself on
  CellChunks chunks_;
  la::BlockStorage storage_;
  std::size_t stride_;        // places of a cell: nodes a + b of the block (a, b), or pair(a, b) with `upper`
  std::vector<char> at_end_;  // of 16 cells each: one of them has the last node
  std::vector<Index> place_;  // in the blocks of the matrix; ~place where it lies turned
};

}  // namespace tunica::fem
