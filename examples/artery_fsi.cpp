// SPDX-License-Identifier: MIT
// artery_fsi: from a medical image to blood flow in a deforming bifurcation. [PEREZ08, 3, 6.1, 7.1]
#include "artery_figures.hpp"
#include "artery_meshes.hpp"
#include "artery_options.hpp"
#include "artery_scene.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "stages.hpp"
#include "timed.hpp"
#include "tunica/core/text.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/octree.hpp"
#include "tunica/coupling/staggered.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/motion/laplace.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

using namespace tunica;
using namespace tunica::examples;

namespace {

void run(artery::Options& o) {
  o.check();
  if (o.threads > 0) thread_count() = o.threads;
  RunFolder folder(o.folder, o.fingerprint());
  const int steps = o.steps();

  int done = 0;
  std::optional<io::CheckpointReader> saved;
  if (o.restart && folder.has_checkpoint()) {
    saved.emplace(folder.open());
    (*saved)("step", done);
    if (done == steps && folder.has_report()) {
      std::printf("the run in %s is finished: nothing to do\n", o.folder.c_str());
      return;
    }
    std::fprintf(stderr, "restart from the checkpoint of step %d of %d\n", done, steps);
  } else if (o.restart) {
    std::fprintf(stderr, "no checkpoint in %s: starting from the beginning\n", o.folder.c_str());
  }

  Json report;
  report["fingerprint"] = o.fingerprint();
  Stages stage(image_stages + 2);
  const artery::Meshes mesh = artery::meshes(o, stage, report);
  Stopwatch& watch = stage.watch();

  // The scene.
  const auto set_up = Stopwatch::Clock::now();
  const auto& inlet = mesh.lumen.patches.at(1);
  const auto profile = fluid::inlet_profile(mesh.lumen, inlet.name);
  fluid::Projection blood{
      mesh.lumen,
      fluid::Newtonian{.density = artery::blood_density, .viscosity = artery::blood_viscosity},
      fluid::Fic{.wave_speed = artery::wave_speed(artery::radius(mesh.lumen, inlet))},
      fluid::MovingMesh{},
      {.passes = 2}};
  blood.velocity(inlet.name, profile, &artery::inlet_velocity);
  for (std::size_t k = 2; k < mesh.lumen.patches.size(); ++k)
    blood.pressure(mesh.lumen.patches[k].name, &artery::outlet_pressure, {.backflow = 0.5});
  blood.interface("wall");
  blood.set(Points<3>::Zero(3, mesh.lumen.node_count()),
            Eigen::VectorXd::Zero(mesh.lumen.node_count()));  // at rest

  const solid::Hyperelastic law{solid::Yeoh{.c10 = artery::c10, .c20 = artery::c20},
                                solid::Quadratic{.kappa = artery::kappa}};
  solid::Dynamics wall{mesh.wall, law, artery::wall_density};
  wall.fix(mesh.wall.patch("ends"));
  wall.interface(mesh.wall.patch("inner"));

  const motion::Laplace laplace{mesh.lumen};
  // Where the lumen has a stub too thin for the wall's hexahedra its nodes move with the nearest of them.
  const coupling::Octree transfer(mesh.lumen.nodes, mesh.lumen.patch("wall"), mesh.wall.nodes,
                                  mesh.wall.patch("inner"), {.largest_gap = 2});
  auto fsi = coupling::staggered(Timed{blood, watch, "flow"}, Timed{wall, watch, "wall dynamics"},
                                 TimedMotion{laplace, watch, "mesh motion"}, transfer, coupling::IqnIls{});
  watch.add("set up", std::chrono::duration<double>(Stopwatch::Clock::now() - set_up).count());

  // The state of the run, its frames and checkpoints.
  artery::Figures figures;
  const auto archive = [&](auto& a) {
    blood.archive(a);
    wall.archive(a);
    fsi.archive(a);
    figures.archive(a);
  };
  mesh::TetMesh lumen_now = mesh.lumen;
  mesh::HexMesh wall_now = mesh.wall;
  const auto frame = [&](double time) {
    lumen_now.nodes = blood.position();
    const Points<3> moved = lumen_now.nodes - mesh.lumen.nodes, u = wall.nodal_displacement();
    wall_now.nodes = mesh.wall.nodes + u;
    figures.watch(lumen_now, wall_now);
    const Eigen::VectorXd at_nodes = wall.nodal_von_mises(), in_cells = wall.cell_von_mises();
    folder.frame(
        time, lumen_now,
        {.points = {{"velocity", blood.velocity()}, {"pressure", blood.pressure()}, {"displacement", moved}}},
        wall_now,
        {.points = {{"displacement", u}, {"von_mises", at_nodes}}, .cells = {{"von_mises", in_cells}}});
  };
  if (saved) {
    folder.restore(*saved, archive);
  } else {
    folder.clear();
    watch.time("write", [&] { frame(0); });
  }

  // In time.
  Progress progress(steps);
  for (int n = done + 1; n <= steps; ++n) {
    const auto step = fsi.step(o.dt);
    if (!step)
      throw std::runtime_error("step " + std::to_string(n) + " of " + std::to_string(steps) + " at " +
                               seven_digits((n - 1) * o.dt + step.taken) + " s: the " +
                               std::string(step.failed) + " ended as " + std::string(name(step.status)) +
                               " after " + std::to_string(step.halvings) + " halvings of the step");
    figures.count(step);
    figures.watch(blood, wall);
    watch.time("write", [&] {
      if (n % o.frame_every() == 0 || n == steps) frame(n * o.dt);
      if (n % o.checkpoint == 0 || n == steps) folder.checkpoint(n, archive);
    });
    char note[96];
    std::snprintf(note, sizeof note, "t %.4f s  %2d iterations  displacement %.3f mm", n * o.dt,
                  step.iterations, wall.nodal_displacement().colwise().norm().maxCoeff() * 1e3);
    progress.tell(n, note);
  }

  // Its figures.
  Json& j = report["run"];
  j["tetrahedra"] = mesh.lumen.cell_count(), j["hexahedra"] = mesh.wall.cell_count();
  j["interface_gap_m"] = transfer.gap();
  j["frames"] = folder.frames();
  figures.report(j);
  for (const auto& [name, seconds] : watch.stages()) report["seconds"][name] = seconds;
  folder.report(report);
  if (!o.report.empty()) io::write_file(o.report, report.text() + "\n");

  std::printf("artery_fsi: %d steps of %g s, %zu frames in %s\n", steps, o.dt, folder.frames(),
              o.folder.c_str());
  artery::row("cells", "%d tetrahedra, %d hexahedra", mesh.lumen.cell_count(), mesh.wall.cell_count());
  figures.print();
  for (const auto& [name, seconds] : watch.stages()) artery::row(name.c_str(), "%.2f s", seconds);
}

}  // namespace

int main(int argc, char** argv) {
  artery::Options o;
  Cli cli = artery::command_line(o);
  return run_program(cli, argc, argv, [&] { run(o); });
}
