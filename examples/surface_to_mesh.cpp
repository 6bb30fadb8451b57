// SPDX-License-Identifier: MIT
// surface_to_mesh: a closed STL surface from anywhere to tetrahedra.
#include "cli.hpp"
#include "flat_ends.hpp"
#include "json.hpp"
#include "mesh_figures.hpp"
#include "output_files.hpp"
#include "stages.hpp"
#include "tunica/io/closed_surface.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <cmath>
#include <string>

using namespace tunica;
using namespace tunica::examples;

int main(int argc, char** argv) {
  std::string in, out, report_file;
  double edge = 0;
  Cli cli("surface_to_mesh", "Fills a closed surface with tetrahedra, in the unit of the surface.");
  cli.argument("SURFACE.stl", "the surface, text or binary", in);
  cli.option("--edge", "L", "edge length to remesh to (none: the surface is kept as given)",
             [&](const std::string& text) {
               edge = number_of<double>(text);
               if (!(edge > 0 && std::isfinite(edge))) throw UsageError("must be more than 0");
             });
  cli.option("-o", "OUT.vtu", "the tetrahedra; their surface goes to OUT.surface.vtp (the surface's name)",
             out);
  cli.option("--report", "FILE.json", "figures, and elapsed and CPU seconds of each stage", report_file);

  return run_program(cli, argc, argv, [&] {
    const auto volume = mesh_file(out, in);
    expect_outputs(volume, report_file);
    Stages stage(4);
    Json report;
    report["warnings"] = Json(std::vector<std::string>{});
    auto closed = stage("read", [&] { return io::read_closed_stl(in); });
    for (const auto& notice : closed.notices) warn(report, notice);
    mesh::Surface& surface = closed.surface;
    name_flat_ends(surface);  // their rims stay sharp, and they are patches of their own
    const auto topology = mesh::topology(surface);
    report["given"] = surface_figures(surface, topology);
    tell_topology(surface, topology, report);
    stage("remesh", [&] {
      if (!(edge > 0)) return;
      require_countable(surface, edge);
      auto remeshed = meshing::remesh(surface, {.edge = edge});
      surface = std::move(remeshed.surface);
      report["remesh"] = remesh_figures(remeshed.report);
    });
    report["surface"] = surface_figures(surface, mesh::topology(surface));
    const auto filled = stage("fill", [&] { return meshing::tetrahedra(surface); });
    tell_tetrahedra(filled.report, filled.mesh, report);
    OutputFiles files;
    stage("write", [&] {
      files.write(volume, [&](const auto& path) { io::write_vtu(path, filled.mesh); });
      files.write(surface_file(volume), [&](const auto& path) { io::write_vtp(path, surface); });
    });
    finish(files, stage, report, report_file);
  });
}
