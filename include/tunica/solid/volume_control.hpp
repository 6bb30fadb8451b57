// SPDX-License-Identifier: MIT
// A cavity filled to a volume, its pressure being what that takes: balloons past their limit point.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/bordered_newton.hpp"
#include "tunica/solid/statics.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

struct VolumeControlOptions {
  Vec3 apex = Vec3::Zero();     // of the cones that make up the volume, see Body::cavity [m]
  double smallest_step = 1e-4;  // of the way to the volume asked for, below which it is given up
};

struct [[nodiscard]] VolumeStep {
  SolveReport solve{};       // iterations: of all attempts
  double volume = 0;         // reached [m3]
  double pressure = 0;       // [Pa]
  int cuts = 0;              // attempts rolled back and halved
  Index inverted_cell = -1;  // where J <= 0 in the last failed attempt, -1 if nowhere

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

/// Fills the cavity behind the pressure of that number in a Statics; all other loads stay as reached.
///   const auto lumen = balloon.pressure(mesh.patch("inner"), 0);
///   VolumeControl filling{balloon, lumen};
///   for (...) { const auto at = filling.step(volume); ... at.pressure ... }
template <class Wall>
class VolumeControl {
 public:
  VolumeControl(Wall& wall, std::size_t number, const VolumeControlOptions& options = {})
      : wall_(wall),
        number_(number),
        options_(options),
        newton_(wall.options().newton, la::Borrowed(wall.borrow_solver())) {
    wall_.hold();
  }

  [[nodiscard]] double volume() const {
    return wall_.body().cavity(number_, wall_.unknowns(), options_.apex).volume;
  }
  [[nodiscard]] double pressure() const {
    return wall_.pressures(wall_.load())[static_cast<Eigen::Index>(number_)];
  }

  /// Goes to that volume [m3], in halved steps if it must. The wall stays at the last one that held.
  VolumeStep step(double volume) {
    VolumeStep report{.volume = this->volume(), .pressure = pressure()};
    const double from = report.volume;
    report.solve.status = Status::converged;
    for (double done = 0, length = 1; done < 1;) {
      const double next = done + length > 1 - 1e-9 ? 1 : done + length;
      wall_.hold();
      wall_.pressure(number_, pressure() + 1);  // so that the load is the pressure's increment in Pa
      Problem problem{wall_, number_, options_.apex, from + next * (volume - from), std::abs(volume - from)};
      Eigen::VectorXd u = wall_.unknowns();
      double load = 0;
      const la::NewtonReport newton = newton_.solve(problem, u, load, la::no_step);
      report.solve.iterations += newton.solve.iterations;
      report.solve.residual = newton.solve.residual;
      report.solve.status = newton.solve.status;
      if (newton) {
        wall_.accept(u, load);
        wall_.hold();
        done = next;
        length *= 2;
        continue;
      }
      if (newton.inadmissible) report.inverted_cell = wall_.body().inverted_cell();
      ++report.cuts;
      length = 0.5 * (next - done);
      if (length < options_.smallest_step) break;
    }
    wall_.hold();
    report.volume = this->volume();
    report.pressure = pressure();
    return report;
  }

 private:
  struct Problem {
    Wall& wall;
    std::size_t number;
    Vec3 apex;
    double volume, change;  // asked for, and the whole step [m3]

    la::ResidualInfo residual(const Eigen::VectorXd& u, double load, Eigen::VectorXd& r, double step) {
      return wall.residual(u, load, r, step);
    }
    void direction(const Eigen::VectorXd& du) { wall.direction(du); }
    void tangent(const Eigen::VectorXd& u, double load, la::SparseMatrix& A) { wall.tangent(u, load, A); }
    [[nodiscard]] Eigen::VectorXd slope(const Eigen::VectorXd& u, double) const {
      return -wall.load_slope(u);
    }
    [[nodiscard]] la::Border border(const Eigen::VectorXd& u, double) const {
      auto cavity = wall.body().cavity(number, u, apex);
      wall.body().clear_fixed(cavity.slope);
      return {.g = cavity.volume - volume,
              .scale = std::max(change, 1e-6 * std::abs(volume)),
              .in_x = std::move(cavity.slope)};
    }
    [[nodiscard]] la::SparseMatrix pattern() const { return wall.body().pattern(); }
  };

  Wall& wall_;
  std::size_t number_;
  VolumeControlOptions options_;
  la::BorderedNewton<la::Borrowed<typename Wall::linear_solver>> newton_;
};

}  // namespace tunica::solid
