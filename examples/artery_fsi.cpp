// SPDX-License-Identifier: MIT
// artery_fsi: from a medical image to blood flow in a deforming bifurcation. [PEREZ08, 3, 6.1, 7.1]
#include "artery_figures.hpp"
#include "artery_scene.hpp"
#include "cli.hpp"
#include "image_pipeline.hpp"
#include "run_folder.hpp"
#include "timed.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/octree.hpp"
#include "tunica/coupling/staggered.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/image/number_text.hpp"
#include "tunica/io/crc32.hpp"
#include "tunica/meshing/vessel_wall.hpp"
#include "tunica/motion/laplace.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::examples;
using namespace tunica::literals;

namespace {

enum class Size { coarse, paper };

struct Options {
  ImageOptions image{};
  Size size = Size::coarse;
  double unit = 1_mm;           // of the image [m]
  double end = 0.1, dt = 1e-3;  // [s]
  std::string folder = TUNICA_RESULTS_DIR, report{};
  int checkpoint = 5;  // steps between two
  int threads = 0;     // 0: all of the machine
  bool restart = false;

  [[nodiscard]] int steps() const { return static_cast<int>(std::lround(end / dt)); }
  [[nodiscard]] int frame_every() const { return std::max(1, steps() / 20); }  // at least 20 frames
  [[nodiscard]] bool paper() const { return size == Size::paper; }
  /// Mean edge of the wall's quadrilaterals, in edges of the lumen: 3,000 hexahedra beside 74,000 tetrahedra.
  [[nodiscard]] double wall_edge() const { return *image.edge * (paper() ? 1.55 : 1.0); }
  [[nodiscard]] int layers() const { return paper() ? 2 : 1; }

  void check() {
    if (!(dt > 0 && end > 0 && std::isfinite(end))) throw UsageError("--end and --dt must be positive");
    if (std::abs(steps() * dt - end) > 1e-6 * dt || steps() < 1)
      throw UsageError("--end must be a whole number of steps of --dt");
    if (checkpoint < 1) throw UsageError("--checkpoint must be 1 or more");
    if (threads < 0) throw UsageError("--threads must be 1 or more");
    if (image.fill == Fill::none) throw UsageError("--fill none leaves nothing for the blood to flow in");
    if (!image.edge) image.edge = (paper() ? 1.03_mm : 2_mm) / unit;
    if (!(*image.edge > 0)) throw UsageError("--edge must be positive here: the wall needs it as well");
    if (!image.image.empty() && image.cuts.size() < 2)
      throw UsageError("an image needs a --cut for the inlet and one for each outlet");
  }

  /// Input and all options that the results depend on.
  [[nodiscard]] std::string fingerprint() const {
    using image::number_text;
    std::string s = "image phantom";
    if (!image.image.empty()) {
      const std::string bytes = io::read_file(image.image);
      s = "image of " + std::to_string(bytes.size()) + " bytes with CRC " + std::to_string(io::crc32(bytes));
    }
    if (image.iso) s += ", iso " + number_text(*image.iso);
    if (const auto& v = image.seed)
      s += ", seed " + std::to_string(v->i) + "," + std::to_string(v->j) + "," + std::to_string(v->k);
    for (const auto& c : image.cuts) {
      s += ", cut";
      for (const double x :
           {c.point[0], c.point[1], c.point[2], c.normal[0], c.normal[1], c.normal[2], c.radius})
        s += " " + number_text(x);
    }
    s += image.surface == Contourer::marching_cubes ? ", marching cubes" : ", dual contouring";
    s += ", edge " + number_text(*image.edge) + ", smooth " + std::to_string(image.smooth) + ", unit " +
         number_text(unit);
    return s + (paper() ? ", size paper" : ", size coarse") + ", end " + number_text(end) + ", dt " +
           number_text(dt);
  }
};

[[nodiscard]] std::string rounded(double x) {
  return image::number_text(std::round(x * 100) / 100);
}

/// The two meshes of the run in SI; patch 0 of the lumen is the wall, 1 the inlet, the others outlets.
struct Meshes {
  mesh::TetMesh lumen;
  mesh::HexMesh wall;
};

Meshes make_meshes(const Options& o, Stages& stage, Json& report) {
  auto [surface, tets] = mesh_image(o.image, stage, report["image_to_mesh"]);
  auto wall = stage("wall", [&] {
    return meshing::vessel_wall(
        surface, {.thickness = artery::thickness / o.unit, .edge = o.wall_edge(), .layers = o.layers()});
  });
  const auto& extrusion = wall.report.extrusion;
  if (extrusion.thinned > 0)
    warn(report["image_to_mesh"], "the wall gives way at " + std::to_string(extrusion.thinned) +
                                      " nodes, down to " + rounded(100 * extrusion.least_share) +
                                      " % of its thickness");
  Json& j = report["wall"];
  j["hexahedra"] = wall.wall.cell_count(), j["nodes"] = wall.wall.node_count();
  j["smallest_scaled_jacobian"] = extrusion.quality.scaled_jacobian.least;
  j["least_share_of_thickness"] = extrusion.least_share;
  tets.nodes *= o.unit;
  wall.wall.nodes *= o.unit;
  return {std::move(tets), std::move(wall.wall)};
}

void run(Options& o) {
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
  Meshes mesh = make_meshes(o, stage, report);
  Stopwatch& watch = stage.watch();

  // --- the scene
  const auto set_up = Stopwatch::Clock::now();
  const auto& inlet = mesh.lumen.patches.at(1);
  const auto profile = fluid::inlet_profile(mesh.lumen, inlet.name);
  double area = 0;
  for (Eigen::Index f = 0; f < inlet.faces.cols(); ++f)
    area += fluid::Conditions::area_vector(mesh.lumen.nodes, inlet.faces, f).norm();
  fluid::Projection blood{
      mesh.lumen,
      fluid::Newtonian{.density = artery::blood_density, .viscosity = artery::blood_viscosity},
      fluid::Fic{.wave_speed = artery::wave_speed(std::sqrt(area / std::numbers::pi))},
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
  if (transfer.gap() > 0.5 * o.wall_edge() * o.unit) {
    const Vec3 at = transfer.farthest() / o.unit;
    warn(report["image_to_mesh"], "the wall does not follow the lumen at (" + rounded(at[0]) + ", " +
                                      rounded(at[1]) + ", " + rounded(at[2]) +
                                      "): " + rounded(transfer.gap() / o.unit) + " apart");
  }
  auto fsi = coupling::staggered(Timed{blood, watch, "flow"}, Timed{wall, watch, "wall dynamics"},
                                 TimedMotion{laplace, watch, "mesh motion"}, transfer, coupling::IqnIls{});
  watch.add("set up", std::chrono::duration<double>(Stopwatch::Clock::now() - set_up).count());

  // --- the state of the run, its frames and checkpoints
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

  // --- in time
  Progress progress(steps);
  for (int n = done + 1; n <= steps; ++n) {
    const auto step = fsi.step(o.dt);
    if (!step)
      throw std::runtime_error("step " + std::to_string(n) + " of " + std::to_string(steps) + " at " +
                               image::number_text((n - 1) * o.dt + step.taken) + " s: the " +
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

  // --- figures
  Json& j = report["run"];
  j["tetrahedra"] = mesh.lumen.cell_count(), j["hexahedra"] = mesh.wall.cell_count();
  j["interface_gap_m"] = transfer.gap();
  j["frames"] = folder.frames();
  figures.report(j);
  for (const auto& [name, seconds] : watch.stages()) report["seconds"][name] = seconds;
  folder.report(report);
  if (!o.report.empty()) io::write_file(o.report, report.text() + "\n");

  using artery::row;
  std::printf("artery_fsi: %d steps of %g s, %zu frames in %s\n", steps, o.dt, folder.frames(),
              o.folder.c_str());
  row("cells", "%d tetrahedra, %d hexahedra", mesh.lumen.cell_count(), mesh.wall.cell_count());
  row("worst quality", "dihedral angle %.1f degrees, scaled Jacobian %.2f", figures.dihedral,
      figures.scaled_jacobian);
  row("iterations per step", "%.1f mean, %d most, %d steps halved",
      double(figures.iterations) / std::max(1, figures.steps), figures.most_iterations, figures.halvings);
  row("peak displacement", "%.3f mm", figures.displacement * 1e3);
  row("peak wall stress", "%.1f kPa (von Mises)", figures.von_mises * 1e-3);
  row("peak velocity", "%.3f m/s", figures.speed);
  row("mass residual", "%.1e of the inflow", figures.mass_residual);
  row("mass defect", "%.2f %% of the inflow at most, %.2f %% in the mean", figures.defect * 100,
      figures.mean_defect() * 100);
  for (const auto& [name, seconds] : watch.stages()) row(name.c_str(), "%.2f s", seconds);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  Cli cli("artery_fsi",
          "From an image (VTK legacy; none: a phantom) to blood flow in a deforming vessel, in SI.");
  cli.optional_argument("IMAGE", "the image; lengths of options are in its unit", o.image.image);
  add_image_options(cli, o.image);
  cli.choice<double>("--unit", "of the image's lengths (mm)",
                     {{"mm", 1_mm}, {"m", 1_m}, {"cm", 10_mm}, {"um", 1_um}}, o.unit);
  cli.choice<Size>("--size", "coarse: edge 2 mm, one layer of hexahedra; paper: 1.03 mm, two",
                   {{"coarse", Size::coarse}, {"paper", Size::paper}}, o.size);
  cli.option("--end", "S", "end of the run [s] (0.1)", o.end);
  cli.option("--dt", "S", "time step [s] (0.001)", o.dt);
  cli.option("--out", "DIR", "folder of the results (" + o.folder + ")", o.folder);
  cli.option("--checkpoint", "N", "steps between checkpoints (5)", o.checkpoint);
  cli.flag("--restart", "go on from the checkpoint in DIR", o.restart);
  cli.option("--threads", "N", "threads (all of the machine); the results do not depend on it", o.threads);
  cli.option("--report", "FILE.json", "figures and seconds of each stage, as in DIR/report.json", o.report);
  return run_program(cli, argc, argv, [&] { run(o); });
}
