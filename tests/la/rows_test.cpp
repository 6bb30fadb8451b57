// SPDX-License-Identifier: MIT
// What the multigrid is built of: rows of blocks, aligned vectors, aggregates, dense factors.
#include "support/tet_operators.hpp"
#include "tunica/la/aggregate.hpp"
#include "tunica/la/aligned.hpp"
#include "tunica/la/block_rows.hpp"
#include "tunica/la/dense_factors.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

using namespace tunica;
using la::detail::at;

namespace {

/// Blocks of a dense matrix, those that are not zero and those on the diagonal.
template <int B>
la::detail::BlockRows<double, B, B> rows_of(const Eigen::MatrixXd& dense) {
  la::detail::BlockRows<double, B, B> rows;
  rows.rows = rows.cols = static_cast<Index>(dense.rows() / B);
  rows.start.assign(1, 0);
  for (Index i = 0; i < rows.rows; ++i) {
    for (Index j = 0; j < rows.cols; ++j) {
      const auto block = dense.block<B, B>(B * i, B * j);
      if (i != j && block.norm() == 0) continue;
      rows.column.push_back(j);
      for (int r = 0; r < B; ++r)
        for (int c = 0; c < B; ++c) rows.value.push_back(block(r, c));
    }
    rows.start.push_back(static_cast<Index>(rows.column.size()));
  }
  return rows;
}

Eigen::MatrixXd chain(int n) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    A(i, i) = 2;
    if (i > 0) A(i, i - 1) = A(i - 1, i) = -1;
  }
  return A;
}

template <int B>
la::detail::Aggregates aggregates_of(const la::detail::BlockRows<double, B, B>& A, double threshold) {
  return la::detail::aggregate<B>(A.view(), la::detail::strong_couplings<B>(A.view(), threshold));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: aligned vectors start at a cache line however they grow") {
    la::AlignedVector<float> a;
    la::AlignedVector<double> b(3, 1.5);
    for (int k = 0; k < 1000; ++k) {
      a.push_back(static_cast<float>(k));
      REQUIRE(reinterpret_cast<std::uintptr_t>(a.data()) % 64 == 0);
    }
    CHECK(a[999] == 999.0F);
    CHECK(reinterpret_cast<std::uintptr_t>(b.data()) % 64 == 0);
    const la::AlignedVector<double> moved = std::move(b);
    CHECK(moved == la::AlignedVector<double>{1.5, 1.5, 1.5});
    CHECK(la::AlignedAllocator<float>() == la::AlignedAllocator<float>(la::AlignedAllocator<double>()));
  }

  TEST_CASE("la: the inverse of a block skips what is not there") {
    test::Noise noise;
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::Matrix<double, 4, 4, Eigen::RowMajor> A, inverse;
      for (int k = 0; k < 16; ++k) A.data()[k] = noise();
      A = (A * A.transpose()).eval();  // elimination on the diagonal is for definite blocks
      for (int c = 0; c < 4; ++c) A(c, c) += 0.1;
      la::detail::invert<4>(A.data(), inverse.data());
      CHECK((A * inverse - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() < 1e-12);
    }
    // A component that is missing, and one that depends on another, stay as they are.
    const std::array<double, 9> missing{2, 0, 0, 0, 0, 0, 0, 0, 5};
    std::array<double, 9> inverse{};
    la::detail::invert<3>(missing.data(), inverse.data());
    CHECK(inverse == std::array<double, 9>{0.5, 0, 0, 0, 0, 0, 0, 0, 0.2});
    const std::array<double, 4> twice{1, 2, 2, 4};
    std::array<double, 4> of_twice{};
    la::detail::invert<2>(twice.data(), of_twice.data());
    CHECK(of_twice == std::array<double, 4>{1, 0, 0, 0});
    double one = 0;
    for (const double bad : {0.0, HUGE_VAL, std::nan("")}) {
      la::detail::invert<1>(&bad, &one);
      CHECK(one == 0);
    }
  }

  TEST_CASE("la: products and sizes of small blocks are those of Eigen") {
    test::Noise noise;
    Eigen::Matrix<double, 3, 2, Eigen::RowMajor> a;
    Eigen::Matrix<double, 2, 4, Eigen::RowMajor> b;
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> c, exact;
    for (int k = 0; k < 6; ++k) a.data()[k] = noise();
    for (int k = 0; k < 8; ++k) b.data()[k] = noise();
    for (int k = 0; k < 12; ++k) c.data()[k] = noise();
    exact = c + a * b;
    la::detail::add_product<3, 2, 4>(a.data(), b.data(), c.data());
    CHECK((c - exact).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(la::detail::squared_size<12>(c.data()) == doctest::Approx(c.squaredNorm()));
  }

  TEST_CASE("la: numbers come to blocks and unknowns that are coupled to nothing are found") {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(9, 9);
    dense(0, 0) = 3, dense(1, 1) = 7, dense(0, 5) = dense(5, 0) = -1, dense(2, 8) = dense(8, 2) = 4;
    dense(3, 3) = dense(4, 4) = dense(5, 5) = dense(8, 8) = 9, dense(6, 7) = dense(7, 6) = 2;
    const la::RowMatrix A = dense.sparseView();
    la::detail::Blocked<3> blocked;
    blocked.set_up(A);
    const auto view = blocked.view();
    CHECK(view.rows == 3);
    CHECK(blocked.entries() == A.nonZeros());
    Eigen::MatrixXd back = Eigen::MatrixXd::Zero(9, 9);
    for (Index i = 0; i < 3; ++i)
      for (Index k = view.start[i]; k < view.start[i + 1]; ++k)
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) back(3 * i + r, 3 * view.column[k] + c) = view.block(k)[3 * r + c];
    CHECK((back - dense).cwiseAbs().maxCoeff() == 0);
    CHECK(la::detail::coupled_unknowns(view, 0) == std::array<bool, 3>{true, false, true});
    CHECK(la::detail::coupled_unknowns(view, 1) == std::array<bool, 3>{false, false, true});
    CHECK(la::detail::coupled_unknowns(view, 2) == std::array<bool, 3>{true, true, true});
    la::detail::Blocked<1> plain;
    plain.set_up(A);
    CHECK(plain.view().value == A.valuePtr());  // nothing is copied
    CHECK(plain.entries() == A.nonZeros());
  }

  TEST_CASE("la: aggregates of a chain are threes around their roots") {
    const auto aggregates = aggregates_of<1>(rows_of<1>(chain(12)), 0.08);
    CHECK(aggregates.count <= 5);
    std::vector<std::vector<int>> members(at(aggregates.count));
    for (int i = 0; i < 12; ++i) {
      REQUIRE(aggregates.of[at(i)] >= 0);
      members[at(aggregates.of[at(i)])].push_back(i);
    }
    for (const auto& m : members) {
      CHECK(m.size() >= 2);
      CHECK(m.back() - m.front() == static_cast<int>(m.size()) - 1);  // neighbours all
    }
    // Nodes that nothing couples belong to none, weak couplings do not count.
    Eigen::MatrixXd weak = chain(12);
    for (int i = 6; i < 12; ++i) weak.row(i) *= 0, weak.col(i) *= 0, weak(i, i) = 1;
    const auto some = aggregates_of<1>(rows_of<1>(weak), 0.08);
    for (int i = 0; i < 12; ++i) CHECK((some.of[at(i)] == la::detail::Aggregates::none) == (i >= 6));
    Eigen::MatrixXd two = chain(12);
    two(5, 6) = two(6, 5) = -0.1;
    const auto parts = aggregates_of<1>(rows_of<1>(two), 0.08);
    const std::set<Index> left(parts.of.begin(), parts.of.begin() + 6),
        right(parts.of.begin() + 6, parts.of.end());
    for (const Index a : left) CHECK(right.count(a) == 0);
    CHECK(aggregates_of<1>(rows_of<1>(Eigen::MatrixXd(0, 0)), 0.08).count == 0);
  }

  TEST_CASE("la: how large the diagonal of a prescribed unknown is does not matter to aggregates") {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(24, 24);
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) A(2 * i + c, 2 * j + c) = chain(12)(i, j);
    for (int i = 0; i < 12; ++i)  // the second component is prescribed at every third node
      if (i % 3 == 0) A.row(2 * i + 1) *= 0, A.col(2 * i + 1) *= 0;
    std::vector<Index> first;
    for (const double diagonal : {1.0, 1e-9, 1e9}) {
      for (int i = 0; i < 12; i += 3) A(2 * i + 1, 2 * i + 1) = diagonal;
      const auto aggregates = aggregates_of<2>(rows_of<2>(A), 0.08);
      if (first.empty()) first = aggregates.of;
      CHECK(aggregates.of == first);
      CHECK(aggregates.count >= 3);
    }
  }

  TEST_CASE("la: dense factors solve and leave the null space at zero") {
    test::Noise noise;
    Eigen::MatrixXd A = chain(12);
    la::detail::DenseFactors<double> factors;
    factors.compute(rows_of<3>(A).view(), 0.5);
    Eigen::VectorXd b = noise.vector(12), x(12);
    factors.solve(b.data(), x.data());
    CHECK((0.5 * A * x - b).cwiseAbs().maxCoeff() < 1e-14);
    CHECK(factors.bytes() == 144 * sizeof(double));

    la::detail::DenseFactors<float> single;
    single.compute(rows_of<1>(A).view(), 1);
    const Eigen::VectorXf c = b.cast<float>();
    Eigen::VectorXf y(12);
    single.solve(c.data(), y.data());
    CHECK((A * y.cast<double>() - b).cwiseAbs().maxCoeff() < 1e-5);

    // Constants are free, and a row of zeros is: solutions wherever b is in the range.
    Eigen::MatrixXd free = A;
    free(0, 0) = free(10, 10) = 1, free(10, 11) = free(11, 10) = free(11, 11) = 0;
    factors.compute(rows_of<1>(free).view(), 1);
    b = free * noise.vector(12);
    factors.solve(b.data(), x.data());
    CHECK((free * x - b).cwiseAbs().maxCoeff() < 1e-13);
    CHECK(x[11] == 0);
    CHECK(x[10] == 0);
    // Not symmetric, with a diagonal that dominates.
    Eigen::MatrixXd skew = A;
    for (int i = 0; i + 1 < 12; ++i) skew(i, i + 1) += 0.7, skew(i + 1, i) -= 0.7;
    factors.compute(rows_of<1>(skew).view(), 1);
    b = noise.vector(12);
    factors.solve(b.data(), x.data());
    CHECK((skew * x - b).cwiseAbs().maxCoeff() < 1e-13);
  }
}
