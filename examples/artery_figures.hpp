// SPDX-License-Identifier: MIT
// The figures of a coupled run: they go into its checkpoints, so that a restarted run reports the same.
#pragma once

#include "json.hpp"
#include "tunica/core/types.hpp"
#include "tunica/mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace tunica::artery {

struct Figures {
  int steps = 0, iterations = 0, most_iterations = 0, halvings = 0;
  double displacement = 0, von_mises = 0, speed = 0;  // peaks [m], [Pa], [m/s]
  double dihedral = 180, scaled_jacobian = 1;         // worst of all frames [degrees], [-]
  double mass_residual = 0;                           // largest of all steps [-]
  double defect = 0, last_defect = 0;                 // mass_defect: largest of all steps, of the last [-]
  double unbalanced = 0, inflow = 0;  // |int (u - w).n| and inflow, summed over the steps [m3/s]
  double largest_inflow = 0;          // [m3/s]

  template <class Archive>
  void archive(Archive& a) {
    a("steps", steps), a("iterations", iterations), a("most_iterations", most_iterations),
        a("halvings", halvings);
    a("displacement", displacement), a("von_mises", von_mises), a("speed", speed);
    a("dihedral", dihedral), a("scaled_jacobian", scaled_jacobian), a("mass_residual", mass_residual);
    a("defect", defect), a("last_defect", last_defect), a("unbalanced", unbalanced), a("inflow", inflow);
    a("largest_inflow", largest_inflow);
  }

  template <class StepReport>
  void count(const StepReport& step) {
    ++steps;
    iterations += step.iterations;
    most_iterations = std::max(most_iterations, step.iterations);
    halvings += step.halvings;
  }

  template <class Fluid, class Wall>
  void watch(const Fluid& blood, const Wall& wall) {
    displacement = std::max(displacement, wall.nodal_displacement().colwise().norm().maxCoeff());
    von_mises = std::max(von_mises, wall.cell_von_mises().maxCoeff());
    speed = std::max(speed, blood.velocity().colwise().norm().maxCoeff());
    const auto& mass = blood.mass_balance();
    mass_residual = std::max(mass_residual, mass.residual());
    last_defect = mass.defect();
    defect = std::max(defect, last_defect);
    unbalanced += std::abs(mass.unbalanced), inflow += mass.inflow;
    largest_inflow = std::max(largest_inflow, mass.inflow);
  }

  void watch(const mesh::TetMesh& lumen, const mesh::HexMesh& wall) {
    dihedral = std::min(dihedral, mesh::quality(lumen).dihedral.least);
    scaled_jacobian = std::min(scaled_jacobian, mesh::quality(wall).scaled_jacobian.least);
  }

  /// Over the run: what is not balanced over what flows in.
  [[nodiscard]] double mean_defect() const { return inflow > 0 ? unbalanced / inflow : 0; }

  void report(examples::Json& j) const {
    j["steps"] = steps, j["step_halvings"] = halvings;
    j["iterations_total"] = iterations, j["iterations_most"] = most_iterations;
    j["iterations_mean"] = static_cast<double>(iterations) / std::max(1, steps);
    j["peak_displacement_m"] = displacement, j["peak_von_mises_Pa"] = von_mises,
    j["peak_velocity_m_s"] = speed;
    j["worst_dihedral_degrees"] = dihedral, j["worst_scaled_jacobian"] = scaled_jacobian;
    j["largest_inflow_m3_s"] = largest_inflow;
    j["mass_residual"] = mass_residual;
    j["mass_defect"] = defect, j["mass_defect_last"] = last_defect, j["mass_defect_mean"] = mean_defect();
  }

  /// The rows of the closing table.
  void print() const;
};

/// One row of the closing table.
inline void row(const char* name, const char* format, auto... values) {
  std::printf("  %-22s ", name);
  std::printf(format, values...);
  std::printf("\n");
}

inline void Figures::print() const {
  row("worst quality", "dihedral angle %.1f degrees, scaled Jacobian %.2f", dihedral, scaled_jacobian);
  row("iterations per step", "%.1f mean, %d most, %d steps halved",
      static_cast<double>(iterations) / std::max(1, steps), most_iterations, halvings);
  row("peak displacement", "%.3f mm", displacement * 1e3);
  row("peak wall stress", "%.1f kPa (von Mises)", von_mises * 1e-3);
  row("peak velocity", "%.3f m/s", speed);
  row("mass residual", "%.1e of the inflow", mass_residual);
  row("mass defect", "%.1e of the inflow at most, %.1e in the mean", defect, mean_defect());
}

}  // namespace tunica::artery
