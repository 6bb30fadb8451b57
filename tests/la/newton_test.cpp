// SPDX-License-Identifier: MIT
#include "tunica/la/newton.hpp"
#include "tunica/la/direct.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

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

/// The slope of |x|^2/2 + k/2 sum <b.x - e>_+^2 - f.x: cables that pull when they are taut alone, each k
/// times as stiff as the ground. The plain iteration goes to and fro between sets of taut cables.
template <bool Energy>
struct Cables {
  double k;
  Eigen::MatrixXd b;  // a row a cable
  Eigen::VectorXd slack, f, r_{};

  [[nodiscard]] Eigen::VectorXd taut(const Eigen::VectorXd& x) const {
    return (b * x - slack).unaryExpr([](double e) { return e > 0 ? 1.0 : 0.0; });
  }
  la::ResidualInfo residual(const Eigen::VectorXd& x, Eigen::VectorXd& r, double) {
    r_ = x + k * b.transpose() * taut(x).cwiseProduct(b * x - slack) - f;
    r = r_;
    return {.scale = f.norm(), .merit = r.norm()};
  }
  void direction(const Eigen::VectorXd&) const {}
  [[nodiscard]] double work(const Eigen::VectorXd& dx) const requires(Energy) { return r_.dot(dx); }
  void tangent(const Eigen::VectorXd& x, la::SparseMatrix& A) const {
    const Eigen::MatrixXd K =
        Eigen::MatrixXd::Identity(x.size(), x.size()) + k * b.transpose() * taut(x).asDiagonal() * b;
    for (Eigen::Index i = 0; i < K.rows(); ++i)
      for (Eigen::Index j = 0; j < K.cols(); ++j) A.coeffRef(i, j) = K(i, j);
  }
  [[nodiscard]] la::SparseMatrix pattern() const {
    return Eigen::MatrixXd::Ones(f.size(), f.size()).sparseView();
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

  TEST_CASE("la: Newton finds which cables are taut where the stiffness jumps a hundred thousandfold") {
    constexpr int n = 40, cables = 60;
    int most = 0, plain = 0, tried = 0;
    for (const double k : {1e1, 1e3, 1e5})
      for (unsigned seed = 1; seed <= 10; ++seed, ++tried) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1, 1);
        const auto noise = [&] { return any(random); };
        const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(cables, n, noise);
        const Eigen::VectorXd slack = Eigen::VectorXd::Zero(cables),
                              f = Eigen::VectorXd::NullaryExpr(n, noise);
        Cables<true> problem{.k = k, .b = b, .slack = slack, .f = f};  // all about to be taut
        Cables<false> blind{.k = k, .b = b, .slack = slack, .f = f};
        la::Newton<la::Ldlt> newton({.tolerance = 1e-9, .max_iterations = 100});
        Eigen::VectorXd x = Eigen::VectorXd::Zero(n), y = x;
        const auto report = newton.solve(problem, x);
        CAPTURE(k);
        CAPTURE(seed);
        REQUIRE(report);
        most = std::max(most, report.solve.iterations);
        plain += newton.solve(blind, y) ? 1 : 0;
      }
    MESSAGE("at most " << most << " iterations; without the work of the residual " << plain << " of " << tried
                       << " are solved");
    CHECK(most <= cables);  // not more than one for each cable
  }

  TEST_CASE("la: a step is taken to where its work ends") {
    // A spring that is a thousand times as stiff beyond a thousandth of the step.
    const auto g = [](double s) { return -1 + s + 1e3 * std::max(0.0, s - 1e-3); };
    la::StepSearch search(g(0));
    CHECK(search.goes_down());
    CHECK(search.takes(-0.9));
    CHECK(search.takes(1));
    CHECK_FALSE(search.takes(g(1)));
    double s = 1;
    int tries = 0;
    while (!search.takes(g(s)) && ++tries < 20) s = search.next(s, g(s));
    MESSAGE("found " << s << " in " << tries << " tries");
    CHECK(tries <= 6);
    CHECK(std::abs(g(s)) <= 0.5);
    // Nothing is known beyond 1e-5 of the step: it is shortened until there is something.
    la::StepSearch blind(-1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto h = [&](double t) { return t > 1e-5 ? nan : -1 + t; };
    for (s = 1, tries = 0; !std::isfinite(h(s)) && tries < 20; ++tries) s = blind.next(s, h(s));
    CHECK(tries <= 9);
    CHECK(blind.next(s, h(s)) > s);
    CHECK(blind.safe() == s);
    CHECK_FALSE(la::StepSearch(0.1).goes_down());
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
