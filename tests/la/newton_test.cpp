// SPDX-License-Identifier: MIT
#include "tunica/la/newton.hpp"
#include "tunica/la/direct.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace tunica;

namespace {

/// r_k = atan-like or cubic springs, uncoupled: r(x) = g(x) - b.
struct Springs {
  enum class Kind { cubic, arctangent, logarithm };
  Kind kind;
  Eigen::VectorXd b;

  la::ResidualInfo residual(const Eigen::VectorXd& x, Eigen::VectorXd& r, double) const {
    bool admissible = true;
    r.resize(x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (kind == Kind::cubic) r[k] = x[k] + x[k] * x[k] * x[k];
      if (kind == Kind::arctangent) r[k] = std::atan(x[k]);
      if (kind == Kind::logarithm) {
        admissible = admissible && x[k] > 0;
        r[k] = x[k] > 0 ? std::log(x[k]) : 0;
      }
    }
    r -= b;
    return {.admissible = admissible, .scale = 1, .merit = r.norm()};
  }
  void direction(const Eigen::VectorXd&) const {}
  void tangent(const Eigen::VectorXd& x, la::SparseMatrix& A) const {
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (kind == Kind::cubic) A.coeffRef(k, k) = 1 + 3 * x[k] * x[k];
      if (kind == Kind::arctangent) A.coeffRef(k, k) = 1 / (1 + x[k] * x[k]);
      if (kind == Kind::logarithm) A.coeffRef(k, k) = 1 / x[k];
    }
  }
  la::SparseMatrix pattern() const {
    la::SparseMatrix A(b.size(), b.size());
    A.setIdentity();
    return A;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: Newton converges at second order and counts what it did") {
    Springs problem{Springs::Kind::cubic, Eigen::Vector3d(1, 2, 30)};
    la::Newton<la::Ldlt> newton({.tolerance = 1e-13});
    Eigen::VectorXd x = Eigen::VectorXd::Constant(3, 3);
    const auto report = newton.solve(problem, x);
    REQUIRE(report);
    CHECK(x[2] + x[2] * x[2] * x[2] == doctest::Approx(30).epsilon(1e-13));
    const double order = la::observed_order(report.history, 1e-13);
    MESSAGE("order " << order << " in " << report.solve.iterations << " iterations");
    CHECK(order >= 1.9);
    CHECK(report.factorisations == report.solve.iterations);
    CHECK(report.history.size() == static_cast<std::size_t>(report.solve.iterations) + 1);
  }

  TEST_CASE("la: modified Newton keeps its tangent while it contracts and reaches the same root") {
    Springs problem{Springs::Kind::cubic, Eigen::Vector3d(1, 2, 3)};
    la::Newton<la::Ldlt> full({.tolerance = 1e-12}), modified({.tolerance = 1e-12, .refresh_above = 0.3});
    Eigen::VectorXd x = Eigen::VectorXd::Constant(3, 1), y = x;
    REQUIRE(full.solve(problem, x));
    const auto first = modified.solve(problem, y);
    REQUIRE(first);
    CHECK((x - y).norm() < 1e-10);
    CHECK(first.factorisations < first.solve.iterations);
    problem.b *= 1.001;
    const auto second = modified.solve(problem, y);
    REQUIRE(second);
    CHECK(second.factorisations == 0);
  }

  TEST_CASE("la: Newton cuts its step where a full one diverges or leaves the domain") {
    Springs arctangent{Springs::Kind::arctangent, Eigen::VectorXd::Zero(2)};
    la::Newton<la::Ldlt> newton({.tolerance = 1e-13, .growth = 1});
    Eigen::VectorXd x = Eigen::Vector2d(3, -4);  // the plain iteration diverges from |x| > 1.39
    REQUIRE(newton.solve(arctangent, x));
    CHECK(x.norm() < 1e-12);
    Springs logarithm{Springs::Kind::logarithm, Eigen::VectorXd::Zero(2)};
    x = Eigen::Vector2d(9, 20);  // the first full step leads to x < 0
    newton.forget();
    REQUIRE(newton.solve(logarithm, x));
    CHECK((x - Eigen::Vector2d(1, 1)).norm() < 1e-12);
  }

  TEST_CASE("la: Newton ends on NaN and on a start outside of the domain and on its last iteration") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    la::Newton<la::Ldlt> newton({.max_iterations = 3});
    Springs problem{Springs::Kind::cubic, Eigen::Vector2d(1, nan)};
    Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
    CHECK(newton.solve(problem, x).solve.status == Status::diverged);
    Springs logarithm{Springs::Kind::logarithm, Eigen::VectorXd::Zero(2)};
    x = Eigen::Vector2d(1, -1);
    const auto outside = newton.solve(logarithm, x);
    CHECK(outside.solve.status == Status::diverged);
    CHECK(outside.inadmissible);
    Springs far{Springs::Kind::cubic, Eigen::Vector2d(1e9, 1)};
    x = Eigen::VectorXd::Constant(2, 1e6);
    CHECK(newton.solve(far, x).solve.status == Status::max_iterations);
  }
}
