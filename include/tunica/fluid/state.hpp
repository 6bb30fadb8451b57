// SPDX-License-Identifier: MIT
// Everything that a flow carries from one time step to the next, and what the last step reports.
#pragma once

#include "tunica/core/types.hpp"

#include <algorithm>
#include <cmath>

namespace tunica::fluid {

/// Fluxes of the last step [m3/s]; what leaves the domain is positive.
struct [[nodiscard]] MassBalance {
  double inflow = 0;      // through all ports that take in
  double outflow = 0;     // through all ports that give out
  double swept = 0;       // int w . n over the walls
  double discrete = 0;    // the discrete continuity equation summed over all nodes
  double unbalanced = 0;  // int u . n over the whole boundary: ports and moving walls

  /// |discrete| / inflow; 0 without any flow.
  [[nodiscard]] double residual() const { return relative(discrete); }
  /// |unbalanced| / inflow.
  [[nodiscard]] double defect() const { return relative(unbalanced); }

 private:
  [[nodiscard]] double relative(double q) const {
    const double scale = std::max({inflow, outflow, std::abs(swept)});
    return scale > 0 ? std::abs(q) / scale : 0;
  }
};

/// At time t^n: fields with the suffix _old belong to t^{n-1}.
struct State {
  double time = 0;                         // [s]
  double dt_last = 0;                      // t^n - t^{n-1} [s]; 0 before the first step
  int started = 0;                         // 1: velocity and pressure are those of a flow
  Points<3> velocity, velocity_old;        // 3 x nodes [m/s]
  Eigen::VectorXd pressure, pressure_old;  // nodes [Pa]
  Points<3> position, position_old;        // 3 x nodes [m]
  Points<3> force;                         // on the interface nodes [N]
  MassBalance mass;

  template <class Archive>
  void archive(Archive& a) {
    a("fluid.time", time);
    a("fluid.dt_last", dt_last);
    a("fluid.started", started);
    a("fluid.velocity", velocity);
    a("fluid.velocity_old", velocity_old);
    a("fluid.pressure", pressure);
    a("fluid.pressure_old", pressure_old);
    a("fluid.position", position);
    a("fluid.position_old", position_old);
    a("fluid.force", force);
    a("fluid.inflow", mass.inflow);
    a("fluid.outflow", mass.outflow);
    a("fluid.swept", mass.swept);
    a("fluid.discrete", mass.discrete);
    a("fluid.unbalanced", mass.unbalanced);
  }
};

}  // namespace tunica::fluid
