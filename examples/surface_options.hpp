// SPDX-License-Identifier: MIT
// What surface_to_mesh is told of a surface from elsewhere and of its mesh.
#pragma once

#include "cli.hpp"
#include "tunica/meshing/repair.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace tunica::examples {

struct SurfaceOptions {
  std::string surface{};  // an STL file
  double edge = 0;        // 0: the surface is kept as given
  bool full_repair = false;
  std::optional<Index> hole_edges{};  // largest hole that is filled
  std::string line_file{};            // of the centre lines; none if empty
  std::vector<Vec3> blind_ends{};     // to which a centre line leads as well
  std::string out{}, report_file{};
};

inline void add_surface_options(Cli& cli, SurfaceOptions& o) {
  cli.argument("SURFACE.stl", "the surface, text or binary", o.surface);
  cli.option("--edge", "L", "edge length to remesh to (none: the surface is kept as given)",
             [&o](const std::string& text) {
               o.edge = number_of<double>(text);
               if (!(o.edge > 0 && std::isfinite(o.edge))) throw UsageError("must be more than 0");
             });
  cli.flag("--repair",
           "also cuts off flaps, sews open edges, fills holes, parts sheets that touch and draws crossings\n"
           "apart (without it equal points, facets without area, duplicates and turned facets only)",
           o.full_repair);
  cli.option("--fill-holes", "N", "with --repair: holes of at most so many edges are filled (100)",
             [&o](const std::string& text) {
               o.hole_edges = number_of<Index>(text);
               if (*o.hole_edges < 0) throw UsageError("must not be negative");
             });
  cli.option("--centre-line", "FILE.vtp",
             "the centre lines from the largest flat end to the others, with the radii of inscribed balls\n"
             "and the sections square to them, in the unit of the surface",
             o.line_file);
  cli.repeated(
      "--end", "X,Y,Z",
      "a point within the vessel to which a centre line leads; without flat ends the first is the root",
      [&o](const std::string& text) {
        const auto x = numbers_of<double>(text);
        if (x.size() != 3) throw UsageError("\"" + text + "\" is not X,Y,Z");
        o.blind_ends.emplace_back(x[0], x[1], x[2]);
      });
  cli.option("-o", "OUT.vtu", "the tetrahedra; their surface goes to OUT.surface.vtp (the surface's name)",
             o.out);
  cli.option("--report", "FILE.json",
             "figures, histograms of quality, worst cells, and elapsed and CPU seconds of each stage;\n"
             "the histograms are also printed",
             o.report_file);
}

/// UsageError for options that have no meaning alone.
inline void require_sense(const SurfaceOptions& o) {
  if (o.hole_edges && !o.full_repair) throw UsageError("--fill-holes needs --repair");
  if (!o.blind_ends.empty() && o.line_file.empty()) throw UsageError("--end needs --centre-line");
}

[[nodiscard]] inline meshing::RepairOptions repair_options(const SurfaceOptions& o) {
  meshing::RepairOptions how;
  how.extent = o.full_repair ? meshing::RepairExtent::full : meshing::RepairExtent::safe;
  how.hole_edges = o.hole_edges.value_or(how.hole_edges);
  return how;
}

}  // namespace tunica::examples
