// SPDX-License-Identifier: MIT
// The frames of a coupled run: both meshes where they are now, with their fields.
#pragma once

#include "artery_figures.hpp"
#include "artery_meshes.hpp"
#include "run_folder.hpp"
#include "tunica/core/types.hpp"

namespace tunica::artery {

/// Writes frames to the folder of the run; their worst cells go to its figures.
class Frames {
 public:
  Frames(const Meshes& reference, examples::RunFolder& folder, Figures& figures)
      : reference_(reference), now_(reference), folder_(folder), figures_(figures) {}

  template <class Fluid, class Structure>
  void write(double time, const Fluid& blood, const Structure& wall) {
    const Points<3> u = wall.nodal_displacement();
    now_.lumen.nodes = blood.position();
    now_.wall.nodes = reference_.wall.nodes + u;
    figures_.watch(now_.lumen, now_.wall);
    const Points<3> moved = now_.lumen.nodes - reference_.lumen.nodes;
    const Eigen::VectorXd at_nodes = wall.nodal_von_mises(), in_cells = wall.cell_von_mises();
    folder_.frame(
        time, now_.lumen,
        {.points = {{"velocity", blood.velocity()}, {"pressure", blood.pressure()}, {"displacement", moved}}},
        now_.wall,
        {.points = {{"displacement", u}, {"von_mises", at_nodes}}, .cells = {{"von_mises", in_cells}}});
  }

 private:
  const Meshes& reference_;
  Meshes now_;
  examples::RunFolder& folder_;
  Figures& figures_;
};

}  // namespace tunica::artery
