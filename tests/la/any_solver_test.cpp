// SPDX-License-Identifier: MIT
// Every linear solver of the project on what breaks solvers: it ends in the right answer or says that it has
// none.
#include "support/tet_operators.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace tunica;

namespace {

struct Outcome {
  Status made = Status::diverged, status = Status::diverged;
  int iterations = 0;
  double residual = 0;  // the true one
  Eigen::VectorXd x;
  [[nodiscard]] bool converged() const { return made == Status::converged && status == Status::converged; }
};

template <class Make>
Outcome solve(const Make& make, const la::RowMatrix& rows, const Eigen::VectorXd& b) {
  const la::SparseMatrix A = rows;
  auto solver = make();
  Outcome out;
  solver.analyse(A);
  out.made = solver.factorise(A).status;
  if (out.made == Status::converged) {
    const auto report = solver.solve(b, out.x);
    out.status = report.status;
    out.iterations = report.iterations;
    if (out.x.size() != b.size()) return out;  // refused
    Eigen::VectorXd product;
    la::multiply(rows, out.x, product);
    product -= b;
    out.residual = b.norm() > 0 ? product.norm() / b.norm() : out.x.norm();
    if (report.status == Status::converged) {
      CHECK(out.x.allFinite());
      CHECK(out.residual <= 1e-6);  // what is called a solution is one
      CHECK(report.residual == doctest::Approx(out.residual).epsilon(0.1).scale(1e-9));
    }
  }
  return out;
}

/// body(name, make, definite): what makes each solver; `definite` for those that want a positive definite
/// matrix.
template <class Body>
void for_each_solver(Body&& body) {
  const la::KrylovOptions options{.tolerance = 1e-8, .max_iterations = 2000};
  using Double = la::Multigrid<1, 1, double>;
  body(
      "Cg<Multigrid>", [&] { return la::Cg<la::Multigrid<>>(options); }, true);
  body(
      "Cg<IncompleteCholesky>", [&] { return la::Cg<>(options); }, true);
  body(
      "Cg<Jacobi>", [&] { return la::Cg<la::Jacobi<>>(options); }, true);
  body(
      "Minres<Multigrid>", [&] { return la::Minres<Double>(options); }, false);
  body(
      "Minres<Identity>", [&] { return la::Minres<>(options); }, false);
  body(
      "Gmres<Ilu0>", [&] { return la::Gmres<>(options); }, false);
  body(
      "Gmres<Multigrid>", [&] { return la::Gmres<la::Multigrid<>>(options); }, false);
  body(
      "BiCgStab<Ilu0>", [&] { return la::BiCgStab<>(options); }, false);
  body(
      "Ldlt", [&] { return la::Ldlt(); }, false);
  body(
      "Lu", [&] { return la::Lu(); }, false);
}

la::RowMatrix from_entries(int n, const std::vector<Eigen::Triplet<double>>& entries) {
  la::RowMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  A.makeCompressed();
  return A;
}
la::RowMatrix diagonal_matrix(const Eigen::VectorXd& d) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < d.size(); ++i) entries.emplace_back(i, i, d[i]);
  return from_entries(static_cast<int>(d.size()), entries);
}
Eigen::VectorXd noise(Eigen::Index n) {
  return test::Noise{}.vector(n);
}

/// A with row and column i put to zero in place.
la::RowMatrix without(la::RowMatrix A, int gone) {
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (la::RowMatrix::InnerIterator it(A, i); it; ++it)
      if (i == gone || it.col() == gone) it.valueRef() = 0;
  return A;
}

std::string told(const std::string& name, const Outcome& out) {
  return name + ": set-up " + std::to_string(int(out.made)) + ", status " + std::to_string(int(out.status)) +
         ", " + std::to_string(out.iterations) + " iterations to " + std::to_string(out.residual);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("la: every solver solves systems of one unknown and of none coupled") {
    for_each_solver([&](const std::string& name, const auto& make, bool) {
      CAPTURE(name);
      const auto one = solve(make, from_entries(1, {{0, 0, 4.0}}), Eigen::VectorXd::Constant(1, 2.0));
      CHECK(one.converged());
      if (one.converged()) CHECK(one.x[0] == doctest::Approx(0.5));
      const Eigen::VectorXd d = noise(200).array().abs() + 0.1, b = noise(200);
      const auto alone = solve(make, diagonal_matrix(d), b);
      CHECK(alone.converged());
      if (alone.converged()) CHECK((alone.x - b.cwiseQuotient(d)).norm() < 1e-5 * alone.x.norm());
      const auto nothing = solve(make, diagonal_matrix(d), Eigen::VectorXd::Zero(200));
      CHECK(nothing.converged());
      if (nothing.converged()) CHECK(nothing.x.norm() == 0);
    });
  }

  TEST_CASE("la: every solver solves disconnected parts and jumps and signs") {
    const auto mesh = test::perturbed_cube(9);
    const test::FreeNodes nodes(mesh);
    const auto middle = [&](Index e) {
      Vec3 x = Vec3::Zero();
      for (int a = 0; a < 4; ++a) x += 0.25 * mesh.nodes.col(mesh.cells(a, e));
      return x;
    };
    // Jumps by a million in blocks.
    const auto jumps = test::diffusion(mesh, nodes, [&](Index e) {
      const Vec3 x = middle(e);
      return (static_cast<int>(3 * x[0]) + static_cast<int>(3 * x[1]) + static_cast<int>(3 * x[2])) % 2 ? 1e6
                                                                                                        : 1.0;
    });
    // Cells a thousand times as long as high.
    auto flat_mesh = test::perturbed_cube(9, 0);
    flat_mesh.nodes.row(2) /= 1000;
    const auto flat = test::diffusion(flat_mesh);
    // Couplings of either sign: S A S with signs S.
    auto signs = test::diffusion(mesh);
    const Eigen::VectorXd sign = noise(signs.rows()).unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; });
    for (Eigen::Index i = 0; i < signs.rows(); ++i)
      for (la::RowMatrix::InnerIterator it(signs, i); it; ++it) it.valueRef() *= sign[i] * sign[it.col()];
    // Two parts that know nothing of each other, one a thousand times the other.
    const auto part = test::diffusion(test::perturbed_cube(6));
    std::vector<Eigen::Triplet<double>> entries;
    const int n = static_cast<int>(part.rows());
    for (int i = 0; i < n; ++i)
      for (la::RowMatrix::InnerIterator it(part, i); it; ++it) {
        entries.emplace_back(i, int(it.col()), it.value());
        entries.emplace_back(n + i, n + int(it.col()), 1e3 * it.value());
      }
    const auto parts = from_entries(2 * n, entries);
    struct Case {
      const char* what;
      const la::RowMatrix& A;
      int most;  // iterations of conjugate gradients with multigrid
    };
    const std::vector<Case> cases{
        {"jumps", jumps, 30}, {"flat", flat, 30}, {"signs", signs, 200}, {"parts", parts, 20}};
    for (const auto& c : cases)
      for_each_solver([&](const std::string& name, const auto& make, bool) {
        CAPTURE(name);
        const auto out = solve(make, c.A, noise(c.A.rows()));
        const bool plain = name == "Minres<Identity>" || name == "Cg<Jacobi>";
        if (!plain) CHECK_MESSAGE(out.converged(), std::string(c.what) << ", " << told(name, out));
        if (name == "Cg<Multigrid>") {
          CHECK(out.iterations <= c.most);
          MESSAGE(std::string(c.what) << ": " << out.iterations << " iterations");
        }
      });
  }

  TEST_CASE("la: every solver ends singular systems in a solution or in a status") {
    const auto A = test::diffusion(test::perturbed_cube(7));
    const auto free = test::diffusion(test::perturbed_cube(7), false);  // constants are free
    const auto holed = without(A, 17);
    Eigen::VectorXd asked = noise(A.rows()), spared = asked;
    asked[17] = 1, spared[17] = 0;
    const Eigen::VectorXd in_range = free * noise(free.rows());
    const Eigen::VectorXd outside = in_range + 0.1 * in_range.norm() / std::sqrt(double(free.rows())) *
                                                   Eigen::VectorXd::Ones(free.rows());
    const la::RowMatrix nothing = diagonal_matrix(Eigen::VectorXd::Zero(20));
    for_each_solver([&](const std::string& name, const auto& make, bool) {
      CAPTURE(name);
      const bool ours = name.find("Cg<") == 0 || name.find("Minres") == 0 || name.find("Gmres") == 0;
      // A row of zeros of which nothing is asked, and one that is asked for what cannot be.
      const auto spares = solve(make, holed, spared), asks = solve(make, holed, asked);
      if (ours && name != "Cg<Jacobi>") CHECK_MESSAGE(spares.converged(), told(name, spares));
      CHECK(!asks.converged());
      // Constants.
      const auto ranged = solve(make, free, in_range), unranged = solve(make, free, outside);
      if (ours) CHECK_MESSAGE(ranged.converged(), told(name, ranged));
      CHECK_MESSAGE(!unranged.converged(), told(name, unranged));
      // Zeros alone.
      CHECK(!solve(make, nothing, Eigen::VectorXd::Ones(20)).converged());
      MESSAGE("zero row " << told(name, asks) << "; constants " << told(name, unranged));
    });
  }

  TEST_CASE("la: every solver ends indefinite systems and bad numbers in a solution or in a status") {
    auto I = test::diffusion(test::perturbed_cube(7));
    for (Eigen::Index i = 0; i < I.rows(); i += 5) I.coeffRef(i, i) *= -1;
    const Eigen::VectorXd b = noise(I.rows());
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for_each_solver([&](const std::string& name, const auto& make, bool definite) {
      CAPTURE(name);
      const auto out = solve(make, I, b);  // solve() checks what is called converged
      MESSAGE("indefinite " << told(name, out));
      if (definite && name.find("Cg<") == 0) CHECK(out.status == Status::diverged);
      if (name == "Ldlt" || name == "Lu") CHECK(out.converged());
      if (name == "Minres<Identity>" || name == "Gmres<Ilu0>")
        CHECK_MESSAGE(out.converged(), told(name, out));
      for (const double bad : {nan, inf}) {
        auto N = I;
        N.coeffRef(3, 3) = bad;
        CHECK(!solve(make, N, b).converged());
        Eigen::VectorXd c = b;
        c[3] = bad;
        const auto A = test::diffusion(test::perturbed_cube(7));
        CHECK(solve(make, A, c).status == Status::diverged);
      }
    });
  }

  TEST_CASE("la: every solver solves what is very small and very large") {
    const auto A = test::diffusion(test::perturbed_cube(6));
    const Eigen::VectorXd exact = noise(A.rows());
    for_each_solver([&](const std::string& name, const auto& make, bool) {
      CAPTURE(name);
      for (const double scale : {1e-120, 1e-30, 1e30, 1e120}) {
        const la::RowMatrix S = scale * A;
        const auto out = solve(make, S, S * exact);
        CHECK_MESSAGE(out.converged(), scale << ", " << told(name, out));
        if (out.converged()) CHECK((out.x - exact).norm() < 1e-5 * exact.norm());
      }
    });
  }
}
