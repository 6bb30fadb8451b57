// SPDX-License-Identifier: MIT
// A subsolver of the coupled loop whose steps are timed, for the table at the end of a run.
#pragma once

#include "stopwatch.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/core/types.hpp"

#include <string>
#include <utility>

namespace tunica::examples {

/// Models coupling::FluidSolver or coupling::StructureSolver if Solver does.
template <class Solver>
class Timed {
 public:
  Timed(Solver& solver, Stopwatch& watch, std::string stage)
      : solver_(solver), watch_(watch), stage_(std::move(stage)) {}

  void move(const Points<3>& displacement, double dt) { solver_.move(displacement, dt); }
  void load(const Points<3>& force) { solver_.load(force); }
  SolveReport step(double dt) {
    return watch_.time(stage_, [&] { return solver_.step(dt); });
  }
  [[nodiscard]] Points<3> interface_force() const { return solver_.interface_force(); }
  [[nodiscard]] Points<3> displacement() const { return solver_.displacement(); }
  void save() { solver_.save(); }
  void restore() { solver_.restore(); }

 private:
  Solver& solver_;
  Stopwatch& watch_;
  std::string stage_;
};

/// The same for a mesh motion.
template <class Motion>
class TimedMotion {
 public:
  TimedMotion(const Motion& motion, Stopwatch& watch, std::string stage)
      : motion_(motion), watch_(watch), stage_(std::move(stage)) {}
  [[nodiscard]] Points<3> extend(const Points<3>& displacement) const {
    return watch_.time(stage_, [&] { return motion_.extend(displacement); });
  }

 private:
  const Motion& motion_;
  Stopwatch& watch_;
  std::string stage_;
};

}  // namespace tunica::examples
