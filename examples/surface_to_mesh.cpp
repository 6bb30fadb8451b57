// SPDX-License-Identifier: MIT
// surface_to_mesh: a closed STL surface from anywhere to tetrahedra.
#include "centre_line_file.hpp"
#include "cli.hpp"
#include "flat_ends.hpp"
#include "json.hpp"
#include "mended_surface.hpp"
#include "mesh_figures.hpp"
#include "output_files.hpp"
#include "stages.hpp"
#include "surface_options.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::examples;

namespace {

/// Triangles of the edge length asked for.
mesh::Surface remeshed(mesh::Surface given, double edge, Json& report) {
  if (!(edge > 0)) return given;
  require_countable(given, edge);
  auto even = meshing::remesh(given, {.edge = edge});
  report["remesh"] = remesh_figures(even.report);
  return std::move(even.surface);
}

}  // namespace

int main(int argc, char** argv) {
  SurfaceOptions o;
  Cli cli("surface_to_mesh", "Fills a closed surface with tetrahedra, in the unit of the surface.");
  add_surface_options(cli, o);

  return run_program(cli, argc, argv, [&] {
    require_sense(o);
    const auto volume = mesh_file(o.out, o.surface);
    expect_outputs(volume, o.report_file);
    if (!o.line_file.empty()) io::expect_writable(o.line_file);
    Stages stage(o.line_file.empty() ? 4 : 5);
    Json report;
    report["warnings"] = Json(std::vector<std::string>{});

    auto given = stage("read", [&] { return mended_surface(o, report); });
    name_flat_ends(given);  // their rims stay sharp, and they are patches of their own
    const auto topology = mesh::topology(given);
    report["given"] = surface_figures(given, topology);
    tell_topology(given, topology, report);

    const auto surface = stage("remesh", [&] { return remeshed(std::move(given), o.edge, report); });
    report["surface"] = surface_figures(surface, mesh::topology(surface));
    std::optional<MeasuredLine> line;
    if (!o.line_file.empty()) {
      line = stage("centre line", [&] { return measured_line(surface, o.blind_ends); });
      report["centre_line"] = centre_line_figures(*line);
    }
    const auto filled = stage("fill", [&] { return meshing::tetrahedra(surface); });
    tell_tetrahedra(filled.report, filled.mesh, report);
    if (!o.report_file.empty()) {
      tell_quality("surface", surface, report);
      tell_quality("tetrahedra", filled.mesh, report);
    }

    OutputFiles files;
    stage("write", [&] {
      files.write(volume, [&](const auto& path) { io::write_vtu(path, filled.mesh); });
      files.write(surface_file(volume), [&](const auto& path) { io::write_vtp(path, surface); });
      if (line) files.write(o.line_file, [&](const auto& path) { write_centre_line(path, *line); });
    });
    finish(files, stage, report, o.report_file);
  });
}
