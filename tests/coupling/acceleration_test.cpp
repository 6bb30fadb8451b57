// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "coupling/models.hpp"
#include "tunica/coupling/aitken.hpp"
#include "tunica/coupling/concepts.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/relaxed.hpp"

#include <Eigen/LU>

#include <limits>
#include <random>

using namespace tunica;

namespace {

static_assert(coupling::Acceleration<coupling::Relaxed>);
static_assert(coupling::Acceleration<coupling::Explicit>);
static_assert(coupling::Acceleration<coupling::Aitken>);
static_assert(coupling::Acceleration<coupling::IqnIls>);

/// A linear fixed point x~ = J x + b with eigenvalues of J from -40 to 0.9: plain iteration blows up.
struct Linear {
  Eigen::MatrixXd J;
  Eigen::VectorXd b, solution;

  explicit Linear(Eigen::Index n, unsigned seed = 7) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::MatrixXd X(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) X(i, j) = (i == j ? 3 : 0) + uniform(random);
    Eigen::VectorXd eigenvalues(n);
    for (Eigen::Index i = 0; i < n; ++i) eigenvalues[i] = i == 0 ? 0.9 : -40.0 / static_cast<double>(i * i);
    J = X * eigenvalues.asDiagonal() * X.inverse();
    b = Eigen::VectorXd::LinSpaced(n, 1, 2);
    solution = (Eigen::MatrixXd::Identity(n, n) - J).lu().solve(b);
  }

  template <class A>
  int solve(A& acceleration, double dt, int most = 200) const {
    acceleration.begin(dt);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    for (int k = 1; k <= most; ++k) {
      const Eigen::VectorXd r = J * x + b - x;
      if (r.norm() < 1e-9 * b.norm()) {
        acceleration.accept();
        CHECK((x - solution).norm() < 1e-7 * solution.norm());
        return k;
      }
      x = acceleration.next(x, r);
    }
    return most + 1;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("coupling: constant relaxation converges inside the bound of Causin and diverges outside") {
    // J = -mu: 0 < omega < 2 / (1 + mu)
    const double mu = 9;
    for (const double omega : {0.05, 0.19, 0.21}) {
      coupling::Relaxed relaxed(omega);
      relaxed.begin(1);
      Eigen::VectorXd x = Eigen::VectorXd::Ones(1);
      for (int k = 0; k < 400; ++k) x = relaxed.next(x, -mu * x - x);
      CHECK((std::abs(x[0]) < 1e-3) == (omega < 2 / (1 + mu)));
      relaxed.accept();
    }
    coupling::Explicit once;
    CHECK(once.next(Eigen::VectorXd::Ones(2), Eigen::VectorXd::Ones(2))
              .isApprox(Eigen::VectorXd::Constant(2, 2.0)));
  }

  TEST_CASE("coupling: Aitken is exact after two iterations of a scalar problem") {
    coupling::Aitken aitken;
    aitken.begin(1);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(1);
    const auto residual = [](const Eigen::VectorXd& y) {
      return Eigen::VectorXd((-25.0 * y).array() + 3.0 - y.array());
    };
    x = aitken.next(x, residual(x));
    x = aitken.next(x, residual(x));
    CHECK(x[0] == doctest::Approx(3.0 / 26).epsilon(1e-12));
    CHECK(aitken.relaxation() == doctest::Approx(1.0 / 26));
  }

  TEST_CASE("coupling: IQN-ILS solves a linear problem in at most its size plus two iterations") {
    for (const Eigen::Index n : {1, 2, 5, 12}) {
      const Linear problem(n);
      coupling::IqnIls iqn({.reuse = 0, .filter = 1e-10});
      const int iterations = problem.solve(iqn, 1.0);
      MESSAGE("n = " << n << ": " << iterations << " iterations");
      CHECK(iterations <= n + 3);
      CHECK(iqn.columns() == 0);
    }
  }

  TEST_CASE("coupling: IQN-ILS with reuse solves the same problem again in two iterations") {
    const Linear problem(8);
    coupling::IqnIls iqn({.reuse = 8, .filter = 1e-8});
    const int first = problem.solve(iqn, 1.0), again = problem.solve(iqn, 1.0);
    MESSAGE(first << " then " << again);
    CHECK(first > 6);
    CHECK(again <= 3);
    const int other_dt = problem.solve(iqn, 0.5);  // the columns of the old dt are dropped
    CHECK(other_dt == first);
  }

  TEST_CASE("coupling: IQN-ILS keeps the differences of as many steps as it was told") {
    coupling::IqnIls iqn({.reuse = 3});
    for (Eigen::Index step = 0; step < 7; ++step) {  // each step adds one difference along an axis of its own
      const Eigen::VectorXd e = Eigen::VectorXd::Unit(10, step);
      iqn.begin(1.0);
      (void)iqn.next(e, e);
      (void)iqn.next(1.1 * e, 0.5 * e);
      iqn.accept();
      CHECK(iqn.columns() == std::min<Eigen::Index>(3, step + 1));
    }
    iqn.begin(2.0);
    CHECK(iqn.columns() == 0);
  }

  TEST_CASE("coupling: IQN-ILS survives zero columns and dependent columns and a stall") {
    coupling::IqnIls iqn;
    iqn.begin(1);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, 0, 1), r = Eigen::VectorXd::Ones(6);
    for (int k = 0; k < 5; ++k) {  // the same residual again and again: differences are zero
      const Eigen::VectorXd next = iqn.next(x, r);
      CHECK(next.allFinite());
      CHECK((next - x).norm() > 0);
      CHECK(iqn.columns() == 0);
    }
    iqn.begin(1);
    for (int k = 0; k < 8; ++k) {  // differences that are all parallel
      const Eigen::VectorXd next = iqn.next(x, (1.0 + k) * r);
      CHECK(next.allFinite());
      CHECK(iqn.columns() <= 1);
    }
    iqn.begin(1);
    Eigen::VectorXd bad = r;
    bad[2] = std::numeric_limits<double>::quiet_NaN();
    (void)iqn.next(x, r);
    (void)iqn.next(x, bad);
    CHECK(iqn.columns() == 0);
  }

  TEST_CASE("coupling: what a failed step of IQN-ILS left behind is dropped") {
    const Linear problem(8);
    coupling::IqnIls iqn({.reuse = 8, .filter = 1e-8});
    problem.solve(iqn, 1.0);
    const Index kept = iqn.columns();
    iqn.begin(1.0);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 4; ++k) {
      const auto noise = [&] {
        return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(8, [&] { return uniform(random); }));
      };
      const Eigen::VectorXd x = noise(), r = noise();
      (void)iqn.next(x, r);
    }
    iqn.begin(1.0);
    CHECK(iqn.columns() <= kept);
  }

  TEST_CASE("coupling: an archived IQN-ILS goes on with the same bits") {
    const Linear problem(10);
    coupling::IqnIls one({.reuse = 4, .filter = 1e-6});
    problem.solve(one, 1.0);
    test::Memory memory;
    one.archive(memory);
    memory.mode = test::Memory::Mode::read;
    coupling::IqnIls two({.reuse = 4, .filter = 1e-6});
    two.archive(memory);
    const Linear other(10, 99);
    one.begin(1.0), two.begin(1.0);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(10), y = x;
    for (int k = 0; k < 6; ++k) {
      x = one.next(x, other.J * x + other.b - x);
      y = two.next(y, other.J * y + other.b - y);
      CHECK(x == y);
    }
  }
}
