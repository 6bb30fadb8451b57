// SPDX-License-Identifier: MIT
#include "tunica/la/bordered_newton.hpp"
#include "tunica/la/direct.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace tunica;
using namespace tunica::la;

namespace {

/// y = x0^3 - 3 x0 + x1 with x1 = x0^2/10, the point fixed by x0 + x0^3/10 at x0 = at: y has two folds on the
/// way.
struct Fold {
  double at;
  double bad = 0;  // added to the residual

  ResidualInfo residual(const Eigen::VectorXd& x, double y, Eigen::VectorXd& r, double) {
    r = Eigen::Vector2d(x[0] * x[0] * x[0] - 3 * x[0] + x[1] - y + bad, x[1] - 0.1 * x[0] * x[0]);
    return {.scale = 1, .merit = r.norm()};
  }
  void direction(const Eigen::VectorXd&) {}
  void tangent(const Eigen::VectorXd& x, double, SparseMatrix& A) {
    A.coeffRef(0, 0) = 3 * x[0] * x[0] - 3;  // 0 at the folds, x0 = +-1 and a little beside
    A.coeffRef(0, 1) = 1;
    A.coeffRef(1, 0) = -0.2 * x[0];
    A.coeffRef(1, 1) = 1;
  }
  [[nodiscard]] Eigen::VectorXd slope(const Eigen::VectorXd&, double) const { return Eigen::Vector2d(-1, 0); }
  [[nodiscard]] Border border(const Eigen::VectorXd& x, double) const {
    const double s = x[0];
    return {.g = s + 0.1 * s * s * s - at - 0.1 * at * at * at, .in_x = Eigen::Vector2d(1 + 0.3 * s * s, 0)};
  }
  [[nodiscard]] SparseMatrix pattern() const {
    SparseMatrix A(2, 2);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) A.insert(i, j) = 1;
    A.makeCompressed();
    return A;
  }
};
static_assert(BorderedProblem<Fold>);

double exact(double x) {
  return x * x * x - 3 * x + 0.1 * x * x;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: bordered Newton walks over both folds of a path and converges quadratically") {
    BorderedNewton<Lu> newton;
    Eigen::VectorXd x = Eigen::Vector2d(-2, 0.4);
    double y = exact(-2);
    for (double at = -1.9; at < 2.05; at += 0.1) {  // past x0 = -1 and x0 = 1, where y has its extremes
      Fold problem{.at = at};
      const auto report = newton.solve(problem, x, y, no_step);
      REQUIRE(report);
      CHECK(x[0] == doctest::Approx(at).scale(0));
      CHECK(y == doctest::Approx(exact(at)).epsilon(1e-9));
      CHECK(report.solve.iterations <= 5);
    }
    Fold far{.at = 4};
    const auto report = newton.solve(far, x, y, no_step);
    REQUIRE(report);
    CHECK(observed_order(report.history, 1e-13) >= 1.9);
    Eigen::VectorXd rate;
    Eigen::VectorXd r;
    (void)far.residual(x, y, r, no_step);
    REQUIRE(newton.rate(far, x, y, rate));
    CHECK(rate[0] == doctest::Approx(1 / (3 * 16 - 3 + 0.8)).scale(0));
  }

  TEST_CASE("la: bordered Newton reports a NaN and a path that has no such point") {
    BorderedNewton<Lu> newton({.max_iterations = 8});
    Eigen::VectorXd x = Eigen::Vector2d(-2, 0.4);
    double y = exact(-2);
    Fold nan{.at = -1.9, .bad = std::numeric_limits<double>::quiet_NaN()};
    CHECK(newton.solve(nan, x, y, no_step).solve.status == Status::diverged);
    Fold lost{.at = std::numeric_limits<double>::quiet_NaN()};
    CHECK(newton.solve(lost, x, y, no_step).solve.status == Status::diverged);
  }
}
