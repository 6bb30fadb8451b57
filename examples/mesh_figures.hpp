// SPDX-License-Identifier: MIT
// What a report says of surfaces and tetrahedra: size, topology with places, quality.
#pragma once

#include "cli.hpp"
#include "json.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/quality_report.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/handles.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/repair_report.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

/// Tells a warning on stderr and in the report.
inline void warn(Json& report, const std::string& sentence) {
  warn(sentence);
  report["warnings"].push(sentence);
}

/// Figures of a surface: size, topology with the place of each handle, quality, patches.
[[nodiscard]] inline Json surface_figures(const mesh::Surface& s, const mesh::Topology& t) {
  Json j;
  j["nodes"] = s.node_count(), j["triangles"] = s.cell_count();
  j["volume"] = mesh::enclosed_volume(s), j["area"] = mesh::area(s);
  j["components"] = t.components.size(), j["genus"] = t.genus();
  j["closed"] = t.closed();
  const auto q = mesh::quality(s);
  j["smallest_angle_degrees"] = q.angle.least, j["mean_ratio"] = q.mean_ratio.mean;
  j["shortest_edge"] = q.shortest_edge, j["longest_edge"] = q.longest_edge;
  for (std::size_t r = 0; r < s.region_names.size(); ++r) {
    Json patch;
    patch["patch"] = r, patch["name"] = s.region_names[r];
    patch["area"] = mesh::area_of_region(s, static_cast<Index>(r));
    j["patches"].push(std::move(patch));
  }
  return j;
}

/// "1.24": three digits, for sentences.
[[nodiscard]] inline std::string short_text(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

/// "1 cavity", "2 cavities".
[[nodiscard]] inline std::string count_text(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Warns of handles and of cavities, with their places.
inline void tell_topology(const mesh::Surface& s, const mesh::Topology& t, Json& report) {
  report["handles"] = Json(std::vector<double>{});
  if (t.genus() > 0)
    for (const auto& h : meshing::handles(s, t)) {
      warn(report, "the surface has a handle at " + place(h.place) + ", its ring is " + short_text(h.length) +
                       " long");
      Json j;
      j["place"] = h.place, j["length"] = h.length;
      report["handles"].push(std::move(j));
    }
  for (const auto& c : t.components)
    if (c.volume < 0)
      warn(report, "there is a cavity of volume " + short_text(-c.volume) + " at " + place(c.centre));
}

/// Tetrahedra of an edge length that would not be held in memory are refused before any is made.
inline void require_countable(const mesh::Surface& s, double edge) {
  constexpr double most = 2e8;
  const double wanted = 6 * std::numbers::sqrt2 * mesh::enclosed_volume(s) / (edge * edge * edge);
  if (!(wanted <= most))
    throw MeshError("an edge length of " + short_text(edge) + " would take " + short_text(wanted) +
                    " tetrahedra, more than " + short_text(most));
}

/// What a run made, on stdout: "9194 tetrahedra: smallest dihedral angle 18 degrees, mean ratio 0.886".
inline void tell_cells(Index count, const std::string& cells, const std::string& quality) {
  std::printf("%d %s: %s\n", static_cast<int>(count), cells.c_str(), quality.c_str());
}
inline void tell_cells(Index tetrahedra, double dihedral_degrees, double ratio) {
  tell_cells(tetrahedra, "tetrahedra",
             "smallest dihedral angle " + short_text(dihedral_degrees) + " degrees, mean ratio " +
                 short_text(ratio));
}

/// Figures of the tetrahedra; a warning where some are flat to rounding: a solver would refuse them.
inline void tell_tetrahedra(const meshing::FillReport& r, const mesh::TetMesh& tets, Json& report) {
  const auto q = mesh::quality(tets);
  Json& j = report["fill"];
  j["nodes"] = r.nodes, j["tetrahedra"] = r.tetrahedra, j["inverted"] = q.inverted;
  j["volume"] = r.volume, j["volume_error"] = r.volume_error;
  j["smallest_dihedral_degrees"] = r.min_dihedral, j["largest_dihedral_degrees"] = r.max_dihedral;
  j["one_percent_dihedral_degrees"] = q.dihedral.quantile(0.01);
  j["mean_ratio"] = r.mean_ratio, j["worst_place"] = q.worst_place;
  j["surface_smallest_angle_degrees"] = r.surface_min_angle;
  j["surface_smallest_dihedral_degrees"] = r.surface_min_dihedral;
  tell_cells(r.tetrahedra, r.min_dihedral, r.mean_ratio);
  if (q.inverted > 0)
    warn(report, count_text(static_cast<std::size_t>(q.inverted), "tetrahedron", "tetrahedra") +
                     " flat to rounding, the flattest at " + place(q.worst_place) +
                     "; the smallest angle of the surface is " + short_text(r.surface_min_angle) +
                     " degrees");
}

[[nodiscard]] inline Json remesh_figures(const meshing::RemeshReport& r) {
  Json j;
  j["triangles"] = r.triangles, j["smallest_angle_degrees"] = r.smallest_angle;
  j["volume_before"] = r.volume_before, j["volume_after"] = r.volume_after;
  j["left_out_folds"] = r.left_out.folds, j["left_out_crossings"] = r.left_out.crosses;
  j["kept_features"] = r.kept_features;
  return j;
}

/// Histograms and worst cells of a mesh for a report.
[[nodiscard]] inline Json quality_figures(const std::vector<mesh::FigureReport>& figures) {
  Json list;
  for (const auto& f : figures) {
    Json j;
    j["figure"] = f.histogram.figure, j["unit"] = f.histogram.unit;
    j["least"] = f.least, j["mean"] = f.mean;
    j["edges"] = f.histogram.edges, j["histogram"] = f.histogram.count;
    j["below"] = f.histogram.below, j["above"] = f.histogram.above;
    j["worst"] = Json(std::vector<double>{});
    for (const auto& w : f.worst) {
      Json cell;
      cell["cell"] = w.cell, cell["value"] = w.value, cell["place"] = w.place;
      j["worst"].push(std::move(cell));
    }
    list.push(std::move(j));
  }
  return list;
}

/// The same as a short table: bins that hold something, and the three worst cells.
[[nodiscard]] inline std::string quality_table(const std::string& name,
                                               const std::vector<mesh::FigureReport>& figures) {
  std::string text;
  for (const auto& f : figures) {
    const auto& h = f.histogram;
    const std::string unit = h.unit == "-" ? "" : " [" + h.unit + "]";
    text += name + ": " + h.figure + unit + ", least " + short_text(f.least) + ", mean " +
            short_text(f.mean) + "\n";
    double all = h.below + h.above;
    for (const Index c : h.count) all += c;
    const auto row = [&](const std::string& range, Index count) {
      if (count == 0) return;
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "  %-14s %10d  %6.2f %%\n", range.c_str(),
                    static_cast<int>(count), 100 * count / all);
      text += line.data();
    };
    row("below " + short_text(h.edges.front()), h.below);
    for (std::size_t i = 0; i < h.count.size(); ++i)
      row(short_text(h.edges[i]) + " to " + short_text(h.edges[i + 1]), h.count[i]);
    row("above " + short_text(h.edges.back()), h.above);
    constexpr std::size_t shown = 3;
    for (std::size_t i = 0; i < std::min(shown, f.worst.size()); ++i)
      text += std::string(i == 0 ? "  worst " : "        ") + short_text(f.worst[i].value) + " at " +
              place(f.worst[i].place) + "\n";
  }
  return text;
}

/// Histograms and worst cells of a mesh go to the report, under "quality", and as a table to stdout.
template <class Mesh>
void tell_quality(const std::string& name, const Mesh& m, Json& report) {
  const auto figures = mesh::quality_report(m);
  report["quality"][name] = quality_figures(figures);
  std::fputs(quality_table(name, figures).c_str(), stdout);
}

/// What a repair changed: a count of each kind, and the places of holes.
[[nodiscard]] inline Json repair_figures(const meshing::RepairReport& r) {
  Json j;
  j["welded"] = r.welded.count, j["degenerate"] = r.degenerate.count, j["duplicates"] = r.duplicates.count;
  j["back_to_back"] = r.folded_sheets.count, j["turned"] = r.turned.count;
  j["flaps"] = r.flaps.count, j["strays"] = r.strays.count, j["sewn"] = r.sewn.count;
  j["parts_turned"] = r.parts_turned.count, j["split_edges"] = r.split_edges.count;
  j["split_nodes"] = r.split_nodes.count;
  j["crossings_before"] = r.crossings_before, j["crossings_after"] = r.crossings_after;
  for (const bool filled : {true, false}) {
    Json& list = j[filled ? "filled_holes" : "holes_left"];
    list = Json(std::vector<double>{});
    for (const auto& h : filled ? r.filled : r.left) {
      Json hole;
      hole["edges"] = h.edges, hole["triangles"] = h.triangles, hole["place"] = h.centre;
      list.push(std::move(hole));
    }
  }
  return j;
}

}  // namespace tunica::examples
