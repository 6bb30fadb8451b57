// SPDX-License-Identifier: MIT
// The centre lines of a vessel between its flat ends as a file of polylines, and what a report says of them.
#pragma once

#include "json.hpp"
#include "tunica/io/vtp_lines.hpp"
#include "tunica/meshing/centre_line.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tunica::examples {

/// The centre lines with the sections square to them, branch by branch.
struct MeasuredLine {
  meshing::CentreLine line;
  std::vector<std::vector<meshing::SectionArea>> sections;
};

/// From the largest flat end of the surface (its regions but the first) to all others and to blind ends at
/// points within it; without flat ends from the first point.
[[nodiscard]] inline MeasuredLine measured_line(const mesh::Surface& s, const std::vector<Vec3>& blind) {
  auto ends = meshing::vessel_ends(s);
  std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  for (std::size_t i = 0; i < blind.size(); ++i) {
    meshing::VesselEnd e;
    e.name = "end " + std::to_string(i + 1), e.point = blind[i];
    ends.push_back(e);
  }
  MeasuredLine m{meshing::centre_line(s, ends), {}};
  for (const auto& branch : m.line.branches) m.sections.push_back(meshing::section_areas(s, branch));
  return m;
}

/// Point arrays: arc, radius, tangent, section_area, section_perimeter, section_diameter; of each line branch
/// and parent (-1 at the root).
inline void write_centre_line(const std::filesystem::path& path, const MeasuredLine& m) {
  mesh::Rows rows;
  std::vector<Vec3> place, tangent;
  std::vector<double> arc, radius, area, perimeter, diameter;
  std::vector<Index> branch, parent;
  for (std::size_t b = 0; b < m.line.branches.size(); ++b) {
    const auto& points = m.line.branches[b].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& section = m.sections[b][i];
      rows.item.push_back(static_cast<Index>(place.size()));
      place.push_back(points[i].place), tangent.push_back(points[i].tangent);
      arc.push_back(points[i].arc), radius.push_back(points[i].radius);
      area.push_back(section.area), perimeter.push_back(section.perimeter);
      diameter.push_back(section.equivalent_diameter);
    }
    rows.offset.push_back(static_cast<Index>(rows.item.size()));
    branch.push_back(static_cast<Index>(b)), parent.push_back(m.line.branches[b].parent);
  }
  const Points<3> along = vec::columns(tangent);
  io::write_vtp_lines(path, vec::columns(place), rows,
                      {.points = {{"arc", arc},
                                  {"radius", radius},
                                  {"tangent", along},
                                  {"section_area", area},
                                  {"section_perimeter", perimeter},
                                  {"section_diameter", diameter}},
                       .cells = {{"branch", branch}, {"parent", parent}}});
}

[[nodiscard]] inline Json centre_line_figures(const MeasuredLine& m) {
  Json j;
  j["root"] = m.line.root;
  for (std::size_t b = 0; b < m.line.branches.size(); ++b) {
    const auto& points = m.line.branches[b].points;
    Json branch;
    branch["branch"] = b, branch["parent"] = m.line.branches[b].parent;
    branch["end"] = m.line.branches[b].end;
    branch["from"] = points.front().place, branch["to"] = points.back().place;
    branch["length"] = points.back().arc - points.front().arc;
    double least = points.front().radius, most = least;
    for (const auto& p : points) least = std::min(least, p.radius), most = std::max(most, p.radius);
    branch["least_radius"] = least, branch["largest_radius"] = most;
    j["branches"].push(std::move(branch));
  }
  return j;
}

}  // namespace tunica::examples
