// SPDX-License-Identifier: MIT
// surface_to_mesh: a closed STL surface from anywhere to tetrahedra.
#include "centre_line_file.hpp"
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
#include "tunica/meshing/repair.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::examples;

namespace {

/// Repairs what was read; each change is told.
void mend(io::StlFile& file, const std::string& name, const meshing::RepairOptions& options, Json& report) {
  try {
    auto mended = meshing::repair(std::move(file.surface), options);
    file.surface = std::move(mended.surface);
    for (const auto& sentence : mended.report.sentences()) warn(report, name + ": " + sentence);
    report["repair"] = repair_figures(mended.report);
  } catch (const MeshError& e) {
    throw InputError(name + ": " + e.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string in, out, report_file, line_file;
  double edge = 0;
  meshing::RepairOptions repair;
  bool full_repair = false;
  std::vector<Vec3> blind_ends;
  Cli cli("surface_to_mesh", "Fills a closed surface with tetrahedra, in the unit of the surface.");
  cli.argument("SURFACE.stl", "the surface, text or binary", in);
  cli.option("--edge", "L", "edge length to remesh to (none: the surface is kept as given)",
             [&](const std::string& text) {
               edge = number_of<double>(text);
               if (!(edge > 0 && std::isfinite(edge))) throw UsageError("must be more than 0");
             });
  cli.flag("--repair",
           "also cuts off flaps, sews open edges, fills holes, parts sheets that touch and draws crossings\n"
           "apart (without it equal points, facets without area, duplicates and turned facets only)",
           full_repair);
  cli.option("--fill-holes", "N", "with --repair: holes of at most so many edges are filled (100)",
             [&](const std::string& text) {
               repair.hole_edges = number_of<Index>(text);
               if (repair.hole_edges < 0) throw UsageError("must not be negative");
             });
  cli.option("--centre-line", "FILE.vtp",
             "the centre lines from the largest flat end to the others, with the radii of inscribed balls\n"
             "and the sections square to them, in the unit of the surface",
             line_file);
  cli.repeated(
      "--end", "X,Y,Z",
      "a point within the vessel to which a centre line leads; without flat ends the first is the root",
      [&](const std::string& text) {
        const auto x = numbers_of<double>(text);
        if (x.size() != 3) throw UsageError("\"" + text + "\" is not X,Y,Z");
        blind_ends.emplace_back(x[0], x[1], x[2]);
      });
  cli.option("-o", "OUT.vtu", "the tetrahedra; their surface goes to OUT.surface.vtp (the surface's name)",
             out);
  cli.option("--report", "FILE.json",
             "figures, histograms of quality, worst cells, and elapsed and CPU seconds of each stage;\n"
             "the histograms are also printed",
             report_file);

  return run_program(cli, argc, argv, [&] {
    const auto volume = mesh_file(out, in);
    expect_outputs(volume, report_file);
    if (!line_file.empty()) io::expect_writable(line_file);
    Stages stage(4);
    Json report;
    report["warnings"] = Json(std::vector<std::string>{});
    auto closed = stage("read", [&] {
      io::StlFile file = io::read_stl(in);
      repair.extent = full_repair ? meshing::RepairExtent::full : meshing::RepairExtent::safe;
      mend(file, in, repair, report);
      return io::closed_surface(in, std::move(file));
    });
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
    std::optional<MeasuredLine> line;
    if (!line_file.empty()) {
      line = measured_line(surface, blind_ends);
      report["centre_line"] = centre_line_figures(*line);
    }
    const auto filled = stage("fill", [&] { return meshing::tetrahedra(surface); });
    tell_tetrahedra(filled.report, filled.mesh, report);
    if (!report_file.empty())
      tell_quality("surface", surface, report), tell_quality("tetrahedra", filled.mesh, report);
    OutputFiles files;
    stage("write", [&] {
      files.write(volume, [&](const auto& path) { io::write_vtu(path, filled.mesh); });
      files.write(surface_file(volume), [&](const auto& path) { io::write_vtp(path, surface); });
      if (line) files.write(line_file, [&](const auto& path) { write_centre_line(path, *line); });
    });
    finish(files, stage, report, report_file);
  });
}
