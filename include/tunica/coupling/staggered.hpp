// SPDX-License-Identifier: MIT
// The staggered algorithm of Fig. 9, iterated within each time step until velocity (11) and force
// (12) agree on the interface. [PEREZ08, 6.1; CGN05]
#pragma once

#include "tunica/core/solve_report.hpp"
#include "tunica/core/types.hpp"
#include "tunica/coupling/concepts.hpp"
#include "tunica/coupling/extrapolation.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

namespace tunica::coupling {

struct StaggeredOptions {
  double tolerance = 1e-6;   // [-] root mean square residual over that of the step's displacement
  double resolution = 1e-9;  // [m] steps smaller than this are not resolved any finer: round-off
  int max_iterations = 50;   // of one step; then it is rolled back and halved
  int max_halvings = 6;      // depth; then the run stops with a report
  int predictor = 2;         // degree of the extrapolation that starts a step: 0, 1 or 2
};

/// How a step of the coupled problem ended. status is converged when the whole of dt was covered.
struct [[nodiscard]] StepReport {
  Status status = Status::converged;
  int iterations = 0;         // passes through both solvers, failed attempts included
  double residual = 0;        // of the last attempt, relative (see StaggeredOptions::tolerance)
  int halvings = 0;           // of dt
  double taken = 0;           // [s] how far the state has advanced; dt when converged
  std::string_view failed{};  // "fluid", "structure" or "interface": what stopped the last attempt

  [[nodiscard]] constexpr explicit operator bool() const { return status == Status::converged; }
};

/// The coupled problem. An lvalue solver is referred to, a temporary is kept.
template <class Fluid, class Structure, class Motion, class Transfers, class Accelerator>
class Staggered {
 public:
  Staggered(Fluid&& fluid, Structure&& structure, Motion&& motion, Transfers&& transfer,
            Accelerator&& acceleration, StaggeredOptions options)
      : fluid_(std::forward<Fluid>(fluid)),
        structure_(std::forward<Structure>(structure)),
        motion_(std::forward<Motion>(motion)),
        transfer_(std::forward<Transfers>(transfer)),
        acceleration_(std::forward<Accelerator>(acceleration)),
        options_(options) {}

  /// Advances by exactly dt [s], in shorter steps where it must. When even the shortest fails the
  /// state is the last one that converged, report.taken after the start.
  StepReport step(double dt) {
    StepReport report;
    cover(dt, 0, report);
    return report;
  }

  /// What a restart needs beside the states of the two solvers.
  template <class Archive>
  void archive(Archive& a) {
    history_.archive(a);
    acceleration_.archive(a);
  }

 private:
  static constexpr bool one_pass = requires { std::remove_reference_t<Accelerator>::one_pass; };

  bool cover(double dt, int depth, StepReport& report) {
    if (advance(dt, report)) return true;
    if (depth == options_.max_halvings) return false;
    ++report.halvings;
    return cover(dt / 2, depth + 1, report) && cover(dt / 2, depth + 1, report);
  }

  /// One step: sub-iterations on the displacement eta of the interface.
  bool advance(double dt, StepReport& report) {
    fluid_.save();
    structure_.save();
    acceleration_.begin(dt);
    const Points<3> start = structure_.displacement();
    if (history_.empty()) history_.push(start, 0.0);
    Points<3> eta = history_.extrapolate(dt, options_.predictor);
    report.status = Status::max_iterations;
    report.failed = "interface";
    for (int k = 1; k <= options_.max_iterations; ++k, ++report.iterations) {
      if (k > 1) fluid_.restore(), structure_.restore();
      fluid_.move(motion_.extend(transfer_.to_fluid(eta)), dt);  // (13)-(16): new domain, grid velocity
      if (!solved(fluid_.step(dt), "fluid", report)) break;      // (1): ALE Navier-Stokes
      structure_.load(transfer_.to_structure(fluid_.interface_force()));  // (12): Phi = -P n + n.S
      if (!solved(structure_.step(dt), "structure", report)) break;       // (6)-(10): the wall
      const Points<3> reached = structure_.displacement();
      const Points<3> r = reached - eta;  // (11): v = d eta/dt on Gamma_C
      report.residual = rms(r) / std::max(rms(reached - start), options_.resolution);
      if (!std::isfinite(report.residual)) {
        report.status = Status::diverged;
        break;
      }
      if (one_pass || report.residual < options_.tolerance) {
        ++report.iterations;
        acceleration_.accept();
        history_.push(reached, dt);
        report.status = Status::converged;
        report.failed = {};
        report.taken += dt;
        return true;
      }
      eta = shaped(acceleration_.next(flat(eta), flat(r)));
    }
    fluid_.restore();
    structure_.restore();
    return false;
  }

  static bool solved(const SolveReport& solver, std::string_view who, StepReport& report) {
    if (solver) return true;
    report.status = solver.status;
    report.failed = who;
    ++report.iterations;
    return false;
  }

  [[nodiscard]] static double rms(const Points<3>& x) {
    return std::sqrt(x.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, x.cols())));
  }
  [[nodiscard]] static Eigen::VectorXd flat(const Points<3>& x) { return x.reshaped(); }
  [[nodiscard]] static Points<3> shaped(const Eigen::VectorXd& x) { return x.reshaped(3, x.size() / 3); }

  Fluid fluid_;
  Structure structure_;
  Motion motion_;
  Transfers transfer_;
  Accelerator acceleration_;
  StaggeredOptions options_;
  Extrapolation history_;
};

/// Couples a fluid and a structure: auto fsi = staggered(blood, wall, motion, transfer, IqnIls{});
/// then fsi.step(dt) until the end.
template <class F, class S, class M, class T, class A>
[[nodiscard]] auto staggered(F&& fluid, S&& structure, M&& motion, T&& transfer, A&& acceleration,
                             StaggeredOptions options = {}) {
  static_assert(FluidSolver<std::remove_reference_t<F>>,
                "staggered: the first argument must be a fluid solver: move(displacement, dt), step(dt) -> "
                "SolveReport, interface_force(), save(), restore(); see coupling::FluidSolver.");
  static_assert(
      StructureSolver<std::remove_reference_t<S>>,
      "staggered: the second argument must be a structure solver: load(force), step(dt) -> SolveReport, "
      "displacement(), save(), restore(); see coupling::StructureSolver.");
  static_assert(MeshMotion<std::remove_reference_t<M>>,
                "staggered: the third argument must move the mesh: extend(interface displacement) -> nodal "
                "displacement; see coupling::MeshMotion.");
  static_assert(
      Transfer<std::remove_reference_t<T>>,
      "staggered: the fourth argument must transfer: to_fluid(displacement) and to_structure(force), "
      "both const; see coupling::Transfer.");
  static_assert(
      Acceleration<std::remove_reference_t<A>>,
      "staggered: the fifth argument must accelerate: begin(dt), next(guess, residual), accept(); see "
      "coupling::Acceleration.");
  return Staggered<F, S, M, T, A>(std::forward<F>(fluid), std::forward<S>(structure), std::forward<M>(motion),
                                  std::forward<T>(transfer), std::forward<A>(acceleration), options);
}

}  // namespace tunica::coupling
