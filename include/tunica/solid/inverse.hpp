// SPDX-License-Identifier: MIT
// Inverse design: the unloaded shape of a body that is known loaded, by one Newton problem on the known
// shape [GOVINDJEE96]: X is the unknown, F = (dX/dx)^-1, equilibrium holds on x.
#pragma once

#include "tunica/core/dual.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/fem/assembly.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/solid/cell_data.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/statics.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::solid {

struct InverseOptions {
  double first_step = 1;        // of the load, whose end is 1
  double smallest_step = 1e-3;  // below it the solution is given up: there may be no unloaded shape
  double growth = 2;            // of the step after one that held
  la::NewtonOptions newton{};
};

struct [[nodiscard]] InverseReport {
  SolveReport solve{};            // iterations: in all; residual: |r| / scale of the last step that held
  double load = 0;                // reached factor of the loads: 1 if it converged
  int steps = 0, cuts = 0;        // that held; rolled back and halved
  Index inverted_cell = -1;       // where J <= 0 in the last failed step, -1 if nowhere
  std::vector<double> history{};  // |r| / scale of the last Newton solve
  Points<3> nodes{};              // of the shape free of that load, 3 x nodes [m]

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

namespace detail {

/// A law whose fibres are known on the deformed shape: it reads them as they are free of load, F^-1 a of
/// unit length.
template <class Law>
struct CarriedBack {
  Law law;

  template <class S>
  using Point = PointOf<Law, S>;

  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F, const Point<S>& given) const {
    using std::sqrt;
    const Tensor<S> cof = cofactor(F);  // J F^-T
    Point<S> free = given;
    for (std::size_t family = 0; 3 * family < given.m.size(); ++family) {
      const Vector3<S> a = given[family];
      Vector3<S> b;
      for (std::size_t j = 0; j < 3; ++j) b[j] = cof.m[j] * a[0] + cof.m[3 + j] * a[1] + cof.m[6 + j] * a[2];
      const S square = dot(b, b);
      if (!(square > S(0))) continue;  // a family that is not there
      const S scale = S(1) / sqrt(square);
      free.set(family, {b[0] * scale, b[1] * scale, b[2] * scale});
    }
    return solid::stress(law, F, free);
  }
};

/// The material of a cell for the inverse problem, and its data.
template <class Material>
[[nodiscard]] auto carried_back(const Material& material) {
  if constexpr (requires { typename decltype(material.isochoric)::template Point<double>; }) {
    using Law = std::remove_cvref_t<decltype(material.isochoric)>;
    if constexpr (needs_point<Law>)
      return Hyperelastic{CarriedBack<Law>{material.isochoric}, material.volumetric};
    else
      return material;
  } else {
    static_assert(!needs_point<Material>, "fibres in the inverse problem need a pair of laws: Hyperelastic");
    return material;
  }
}
template <class Law>
[[nodiscard]] CellData<CarriedBack<Law>> carried_back(const CellData<Law>& data) {
  return {.points = data.points};
}

/// r(w) = f_int(X = x - w, u = w) - load f_ext with x and f_ext known; w is the displacement that the
/// loads have caused, zero at fixed unknowns.
template <class Wall>
class InverseProblem {
 public:
  explicit InverseProblem(const Wall& wall)
      : wall_(wall),
        assembly_(wall.body().mesh()),
        external_(wall.external(Eigen::VectorXd::Zero(wall.body().unknowns()), 1)),
        smallest_J_(static_cast<std::size_t>(wall.body().mesh().cell_count())) {}

  double load = 0;

  la::ResidualInfo residual(const Eigen::VectorXd& w, Eigen::VectorXd& r, double) {
    const auto& body = wall_.body();
    r.setZero(w.size());
    assembly_.for_each_cell([&](Index e) {
      const Nodal<double> we = body.gather(e, w);
      const auto element = forces<double>(e, body.reference(e) - we, we);
      smallest_J_[static_cast<std::size_t>(e)] = element.smallest_J;
      assembly_.add(e, element.force, r);
    });
    const auto lowest =
        std::find_if(smallest_J_.begin(), smallest_J_.end(), [](double J) { return !(J > 0); });
    inverted_cell_ = lowest == smallest_J_.end() ? -1 : static_cast<Index>(lowest - smallest_J_.begin());
    const double scale = std::hypot(r.norm(), load * external_.norm());
    r -= load * external_;
    body.clear_fixed(r);
    // No merit to fall: the volume error of a step, times kappa, grows before it falls quadratically.
    return {.admissible = inverted_cell_ < 0, .scale = scale, .rounding = 0, .merit = 1};
  }
  void direction(const Eigen::VectorXd&) {}
  void tangent(const Eigen::VectorXd& w, la::SparseMatrix& A) const {
    const auto& body = wall_.body();
    assembly_.clear(A);
    assembly_.for_each_cell([&](Index e) {
      const Nodal<double> x = body.reference(e), we = body.gather(e, w);
      Nodal<D> X, u;
      for (int a = 0; a < Element::nodes; ++a)
        for (int i = 0; i < 3; ++i) {
          u(i, a) = D::variable(we(i, a), 3 * a + i);
          X(i, a) = D(x(i, a)) - u(i, a);
        }
      const auto element = forces<D>(e, X, u);
      Eigen::Matrix<double, size, size> K;
      for (int r = 0; r < size; ++r)
        for (int c = 0; c < size; ++c) K(r, c) = element.force[r].d[static_cast<std::size_t>(c)];
      const double diagonal = K.diagonal().cwiseAbs().maxCoeff();
      const auto cell = body.mesh().cells.col(e);
      for (int k = 0; k < size; ++k)
        if (body.fixed(3 * cell[k / 3] + k % 3)) {
          K.row(k).setZero();
          K.col(k).setZero();
          K(k, k) = diagonal;
        }
      assembly_.add(e, K, A);
    });
  }
  [[nodiscard]] la::SparseMatrix pattern() const { return assembly_.matrix(); }
  [[nodiscard]] Index inverted_cell() const { return inverted_cell_; }

 private:
  using Element = typename Wall::Element;
  static constexpr int size = 3 * Element::nodes;
  template <class S>
  using Nodal = typename Element::template Nodal<S>;
  using D = Dual<double, size>;

  template <class S>
  [[nodiscard]] auto forces(Index e, const Nodal<S>& X, const Nodal<S>& u) const {
    const auto& body = wall_.body();
    const auto material = carried_back(body.material(e));
    if constexpr (std::is_same_v<std::remove_const_t<decltype(material)>,
                                 std::remove_cvref_t<decltype(body.material(e))>>)
      return Element::forces(material, X, u);
    else
      return Element::forces(material, X, u, carried_back(body.data(e)));
  }

  const Wall& wall_;
  fem::Assembly<typename Wall::Cell, 3> assembly_;
  Eigen::VectorXd external_;
  std::vector<double> smallest_J_;
  Index inverted_cell_ = -1;
};

}  // namespace detail

/// `wall` is composed on the mesh of the known shape, with the loads that act there as end values: its
/// follower pressures, dead forces and fixed unknowns count, prescribed displacements do not. Supports are
/// relaxed in the known shape, and fibres are given on it. `diverged` with the shape of the load reached if
/// the steps become too small: a shape free of stress need not exist.
///   auto image = ...;  Statics loaded{image, law};  loaded.fix(...);  loaded.pressure(...);
///   const auto free = unloaded_shape(loaded);  image.nodes = free.nodes;  Statics wall{image, law};
/// The tangent is not symmetric.
template <la::LinearSolver Solver = la::Lu, class Wall>
[[nodiscard]] InverseReport unloaded_shape(const Wall& wall, const InverseOptions& options = {},
                                           Solver solver = {}) {
  static_assert(!Solver::symmetric,
                "the tangent of the inverse problem is not symmetric: give Lu or the like");
  TUNICA_EXPECT(wall.body().laws().prestress().empty(), "the unloaded shape of a body without prestress");
  InverseReport report;
  detail::InverseProblem<Wall> problem(wall);
  la::Newton<Solver> newton(options.newton, std::move(solver));
  Eigen::VectorXd w = Eigen::VectorXd::Zero(wall.body().unknowns());
  double step = std::min(1.0, options.first_step);
  while (report.load < 1) {
    problem.load = report.load + step > 1 - 1e-9 ? 1 : report.load + step;
    Eigen::VectorXd next = w;
    newton.forget();
    const la::NewtonReport attempt = newton.solve(problem, next);
    report.solve.iterations += attempt.solve.iterations;
    report.solve.status = attempt.solve.status;
    report.history = attempt.history;
    if (attempt) {
      w = next;
      report.load = problem.load;
      report.solve.residual = attempt.solve.residual;
      ++report.steps;
      step *= options.growth;
      continue;
    }
    if (attempt.inadmissible) report.inverted_cell = problem.inverted_cell();
    ++report.cuts;
    step = 0.5 * (problem.load - report.load);
    if (step < options.smallest_step) break;
  }
  report.nodes = wall.body().mesh().nodes - w.reshaped(3, wall.body().mesh().node_count());
  return report;
}

}  // namespace tunica::solid
