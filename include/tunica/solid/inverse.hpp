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
#include <limits>
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
    Point<S> free = given;
    pull_back<reads_frame<Law>>(F, free);
    return solid::stress(law, F, free);
  }
};

template <class Law>
inline constexpr bool reads_fibres = fibre_families<PointOf<Law, double>> != 0;

/// The material of a cell for the inverse problem, as stiff as after infinite time, and its data.
template <class Material>
[[nodiscard]] auto carried_back(Material material) {
  using Law = PointLaw<Material>;
  constexpr double for_ever = std::numeric_limits<double>::infinity();
  if constexpr (Pair<Material>) {
    begin_step(material.isochoric, for_ever);
    if constexpr (reads_fibres<Law>)
      return Hyperelastic{CarriedBack<Law>{material.isochoric}, material.volumetric};
    else
      return material;
  } else {
    begin_step(material, for_ever);
    if constexpr (reads_fibres<Law>)
      return CarriedBack<Law>{material};
    else
      return material;
  }
}
template <class Law>
[[nodiscard]] auto carried_back(const CellData<Law>& data) {
  if constexpr (reads_fibres<Law>)
    return CellData<CarriedBack<Law>>{.points = data.points};
  else
    return data;
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
    return Element::forces(carried_back(body.material(e)), X, u, carried_back(body.data(e)));
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
/// relaxed in the known shape, and fibres are given on it. Laws with a history have carried the loads for
/// ever: they are as stiff as after infinite time. `diverged` with the shape of the load reached if the steps
/// become too small: a shape free of stress need not exist.
///   auto image = ...;  Statics loaded{image, law};  loaded.fix(...);  loaded.pressure(...);
///   const auto free = unloaded_shape(loaded);  image.nodes = free.nodes;  Statics wall{image, law};
///   carry_fibres_back(loaded, wall);  // if the law reads fibres
/// The tangent is not symmetric.
template <la::LinearSolver Solver = la::Lu, class Wall>
[[nodiscard]] InverseReport unloaded_shape(const Wall& wall, const InverseOptions& options = {},
                                           Solver solver = {}) {
  static_assert(!Solver::symmetric,
                "the tangent of the inverse problem is not symmetric: give Lu or the like");
  static_assert(std::remove_cvref_t<decltype(wall.body())>::per_node == 3,
                "inverse design finds nodes alone: give a formulation without pressures at them");
  TUNICA_EXPECT(wall.body().laws().prestress().empty(), "the unloaded shape of a body without prestress");
  wall.body().laws().require_fibres();
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

/// Gives the points of `wall`, composed on the unloaded shape of `loaded`, what those of `loaded` were given,
/// with its fibres carried back by the deformation between the two shapes at the same point: F^-1 a of unit
/// length, as unloaded_shape read them; frames stay orthogonal. `wall` then comes back to the known shape.
/// Laws of regions are not handed on.
template <class Loaded, class Wall>
void carry_fibres_back(const Loaded& loaded, Wall& wall) {
  using Body = std::remove_cvref_t<decltype(loaded.body())>;
  static_assert(std::is_same_v<Body, std::remove_cvref_t<decltype(wall.body())>>,
                "fibres go from a body to one of the same cells and the same kind of law");
  static_assert(detail::reads_fibres<typename Body::Laws::Law>, "this law reads no fibres");
  using Element = typename Body::Element;
  const Body &image = loaded.body(), &free = wall.body();
  TUNICA_EXPECT(image.mesh().cells == free.mesh().cells, "the two shapes are of the same cells");
  TUNICA_EXPECT(free.laws().prestress().empty(), "the unloaded shape has no prestress");
  std::vector<Eigen::Matrix3d> deformation;
  for (Index e = 0; e < image.mesh().cell_count(); ++e) {
    const auto X = free.reference(e);
    for (const auto& F : Element::deformation(X, image.reference(e) - X)) deformation.push_back(F);
  }
  auto laws = image.laws();
  laws.prestress(std::move(deformation));  // carries back what was given
  for (Index e = 0; e < image.mesh().cell_count(); ++e)
    if (const auto* points = laws.data(e).points)
      for (std::size_t q = 0; q < Element::points; ++q) wall.laws().point_data(e, q, points[q]);
}

}  // namespace tunica::solid
