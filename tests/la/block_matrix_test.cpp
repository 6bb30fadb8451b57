// SPDX-License-Identifier: MIT
// Block matrices: products against dense ones on one thread and on three, conversions, elimination.
#include "tunica/la/block_matrix.hpp"
#include "tunica/la/block_convert.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

using namespace tunica;

namespace {

/// A symmetric random pattern with the diagonal, near the diagonal and far from it.
template <int N>
la::BlockMatrix<N> random_matrix(Index n, la::BlockStorage storage, bool far = true) {
  std::mt19937 random(7);
  std::vector<std::set<Index>> rows(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const auto add = [&](Index j) {
      rows[static_cast<std::size_t>(i)].insert(j), rows[static_cast<std::size_t>(j)].insert(i);
    };
    add(i), add(std::min(i + 1, n - 1)), add(std::min(i + 40, n - 1));
    if (far) add(static_cast<Index>(random() % static_cast<unsigned>(n)));
  }
  std::vector<Index> start{0}, column;
  for (Index i = 0; i < n; ++i) {
    for (const Index j : rows[static_cast<std::size_t>(i)])
      if (storage == la::BlockStorage::full || j >= i) column.push_back(j);
    start.push_back(static_cast<Index>(column.size()));
  }
  la::BlockMatrix<N> A(start, column, storage);
  for (Index i = 0; i < n; ++i)
    for (Index k = start[static_cast<std::size_t>(i)]; k < start[static_cast<std::size_t>(i) + 1]; ++k) {
      const Index j = column[static_cast<std::size_t>(k)];
      for (int r = 0; r < N; ++r)
        for (int c = 0; c < N; ++c)  // symmetric: a function of the unordered pair of unknowns
          A.block(k)[r * N + c] =
              std::sin(1.0 + std::min(N * i + r, N * j + c) + 0.37 * std::max(N * i + r, N * j + c));
    }
  return A;
}

template <int N>
Eigen::MatrixXd dense(const la::BlockMatrix<N>& A) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  for (Index i = 0; i < A.node_count(); ++i)
    for (Index k = A.start()[static_cast<std::size_t>(i)]; k < A.start()[static_cast<std::size_t>(i) + 1];
         ++k)
      for (int r = 0; r < N; ++r)
        for (int c = 0; c < N; ++c) {
          const Index row = N * i + r, col = N * A.column()[static_cast<std::size_t>(k)] + c;
          D(row, col) = A.block(k)[r * N + c];
          if (A.storage() == la::BlockStorage::upper) D(col, row) = A.block(k)[r * N + c];
        }
  return D;
}

/// What eliminate() asks for: some unknowns with values.
struct Some {
  [[nodiscard]] bool fixed(Index i) const { return i % 7 == 2 || i == 0; }
  [[nodiscard]] double value(Index i) const { return 0.5 - 0.01 * i; }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("la: block matrices multiply as dense ones in both storages", A, la::BlockMatrix<1>,
                     la::BlockMatrix<2>, la::BlockMatrix<3>, la::BlockMatrix<4>) {
    constexpr int N = A::block_rows;
    const auto full = random_matrix<N>(150, la::BlockStorage::full);
    const auto upper = random_matrix<N>(150, la::BlockStorage::upper);
    const Eigen::MatrixXd D = dense<N>(full);
    CHECK((D - D.transpose()).cwiseAbs().maxCoeff() == 0);
    CHECK((D - dense<N>(upper)).cwiseAbs().maxCoeff() == 0);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(full.rows(), -1, 3);
    Eigen::VectorXd y, z;
    full.apply(x, y), upper.apply(x, z);
    CHECK((y - D * x).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((z - D * x).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(reinterpret_cast<std::uintptr_t>(full.values()) % 64 == 0);
    CHECK(full.find(3, 43) >= 0);
    CHECK(full.block(full.find(3, 43))[0] == D(3 * N, 43 * N));
    CHECK(upper.find(43, 3) == -1);
  }

  TEST_CASE("la: products of block matrices have the same bits on any number of threads") {
    for (const auto storage : {la::BlockStorage::full, la::BlockStorage::upper})
      for (const bool far : {false, true}) {
        const auto A = random_matrix<3>(9000, storage, far);
        const Eigen::VectorXd x = Eigen::VectorXd::Random(A.rows());
        Eigen::VectorXd one, three;
        A.apply(x, one);
        thread_count() = 3;
        A.apply(x, three);
        thread_count() = 1;
        CHECK((one.array() == three.array()).all());
        const auto S = la::sparse(A);
        CHECK((S * x - one).cwiseAbs().maxCoeff() < 1e-12);
      }
  }

  TEST_CASE("la: block matrices turn into whole ones and into Eigen's and plain rows") {
    const auto full = random_matrix<3>(90, la::BlockStorage::full);
    const auto upper = random_matrix<3>(90, la::BlockStorage::upper);
    const Eigen::MatrixXd D = dense<3>(full);
    const auto both = la::whole(upper);
    CHECK(both.start() == full.start());
    CHECK(both.column() == full.column());
    CHECK(std::equal(full.values(), full.values() + 9 * full.block_count(), both.values()));
    const Eigen::MatrixXd by_rows = la::sparse(full), by_columns = la::sparse<Eigen::ColMajor>(upper);
    CHECK((by_rows - D).cwiseAbs().maxCoeff() == 0);
    CHECK((by_columns - D).cwiseAbs().maxCoeff() == 0);
    const auto plain = la::csr(upper);
    const auto rows = la::sparse(full);
    CHECK(std::equal(plain.start.begin(), plain.start.end(), rows.outerIndexPtr()));
    CHECK(std::equal(plain.column.begin(), plain.column.end(), rows.innerIndexPtr()));
    CHECK(std::equal(plain.value.begin(), plain.value.end(), rows.valuePtr()));
  }

  TEST_CASE("la: prescribed unknowns are eliminated from both storages alike") {
    const auto original = dense<3>(random_matrix<3>(60, la::BlockStorage::full));
    for (const auto storage : {la::BlockStorage::full, la::BlockStorage::upper}) {
      auto A = random_matrix<3>(60, storage);
      Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), 1, 2);
      Eigen::MatrixXd expected = original;
      Eigen::VectorXd rhs = b;
      const Some some;
      for (Index i = 0; i < A.rows(); ++i)
        if (some.fixed(i)) rhs -= original.col(i) * some.value(i);
      for (Index i = 0; i < A.rows(); ++i)
        if (some.fixed(i)) {
          expected.row(i).setZero(), expected.col(i).setZero();
          expected(i, i) = 5, rhs[i] = 5 * some.value(i);
        }
      la::eliminate(A, some, b, 5);
      CHECK((dense<3>(A) - expected).cwiseAbs().maxCoeff() == 0);
      CHECK((b - rhs).cwiseAbs().maxCoeff() < 1e-13);
    }
  }
}
