// SPDX-License-Identifier: MIT
// artery_fsi: from a medical image to blood flow in a deforming bifurcation. [PEREZ08, 3, 6.1, 7.1]
#include "artery_conditions.hpp"
#include "artery_meshes.hpp"
#include "artery_options.hpp"
#include "artery_run.hpp"
#include "artery_scene.hpp"
#include "stages.hpp"
#include "timed.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/octree.hpp"
#include "tunica/coupling/staggered.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/motion/laplace.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"

using namespace tunica;
using namespace tunica::examples;

namespace {

void run(artery::Options& o) {
  o.check();
  if (o.threads > 0) thread_count() = o.threads;
  RunFolder folder(o.folder, o.fingerprint());
  auto from = artery::beginning(o, folder);
  if (from.finished) return;
  artery::check_report(o);

  // Section 3: tetrahedra of the lumen and hexahedra of the wall.
  Json report;
  report["fingerprint"] = o.fingerprint();
  Stages stage(image_stages + 2);
  const artery::Meshes mesh = artery::meshes(o, stage, report);

  // Section 7.1: blood (1), its wall (17), and the motion of the blood's mesh (15).
  Stopwatch& watch = stage.watch();
  auto set_up = watch.start("set up");
  fluid::Projection blood{
      mesh.lumen,
      fluid::Newtonian{.density = artery::blood_density, .viscosity = artery::blood_viscosity},
      fluid::Fic{.wave_speed = artery::wave_speed(artery::inlet_radius(mesh.lumen))},
      fluid::MovingMesh{},
      {.passes = 2}};
  artery::set_conditions(blood, mesh.lumen);

  const solid::Hyperelastic law{solid::Yeoh{.c10 = artery::c10, .c20 = artery::c20},
                                solid::Quadratic{.kappa = artery::kappa}};
  solid::Dynamics wall{mesh.wall, law, artery::wall_density};
  artery::set_conditions(wall, mesh.wall);

  const motion::Laplace laplace{mesh.lumen};

  // Section 6.1: the staggered algorithm between meshes that do not match, (11) and (12).
  const coupling::Octree transfer(mesh.lumen.nodes, mesh.lumen.patch("wall"), mesh.wall.nodes,
                                  mesh.wall.patch("inner"), {.largest_gap = artery::longest_stub});
  auto fsi = coupling::staggered(Timed{blood, watch, "flow"}, Timed{wall, watch, "wall dynamics"},
                                 TimedMotion{laplace, watch, "mesh motion"}, transfer, coupling::IqnIls{});
  set_up.stop();

  artery::Record record(o, mesh, folder, watch);
  const artery::State state{blood, wall, fsi};
  record.begin(from, state);
  for (int n = from.step + 1; n <= o.steps(); ++n) {
    const auto step = fsi.step(o.dt);
    if (!step) throw artery::failure(step, n, o);
    record.step(n, step, state);
  }
  record.finish(transfer.gap(), report);
}

}  // namespace

int main(int argc, char** argv) {
  artery::Options o;
  Cli cli = artery::command_line(o);
  return run_program(cli, argc, argv, [&] { run(o); });
}
