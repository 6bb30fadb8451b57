// SPDX-License-Identifier: MIT
// Centre lines of a vessel tree between its ends: cheapest paths through its middle, drawn to the centres of
// inscribed balls, as branches with arc length, tangent and radius at each point.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/solid_angle.hpp"
#include "tunica/meshing/centre_curve.hpp"
#include "tunica/meshing/centre_tree.hpp"
#include "tunica/meshing/inside_grid.hpp"
#include "tunica/meshing/section_areas.hpp"
#include "tunica/meshing/vessel_ends.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct CentreLineOptions {
  double step = 0;     // between points, in the unit of the surface; 0: half the radius of the smallest end
  double spacing = 0;  // of the grid of the first paths; 0: a third of that radius, finer where need be
};

struct CentrePoint {
  Vec3 place, tangent;  // the tangent is a unit vector that leads away from the root
  double arc = 0;       // length along the tree from the root
  double radius = 0;    // of the inscribed ball: the distance to the wall
};

struct CentreBranch {
  std::vector<CentrePoint> points;  // the last point of its parent first
  Index parent = -1;                // the branch that it leaves, -1 at the root
  std::string end;                  // the end that it leads to, empty at a fork
};

struct [[nodiscard]] CentreLine {
  std::string root;
  std::vector<CentreBranch> branches;  // parents before their children
  double spacing = 0;                  // of the grid that was used

  /// The branch that leads to an end; MeshError when there is none.
  [[nodiscard]] const CentreBranch& to(const std::string& end) const {
    for (const CentreBranch& b : branches)
      if (b.end == end) return b;
    throw MeshError("no centre line leads to \"" + end + "\"");
  }
};

namespace detail {

/// A length for the radius of the smallest end: from the areas of flat ends, or of the whole, 2 V / A.
[[nodiscard]] inline double smallest_radius(const mesh::Surface& s, const std::vector<VesselEnd>& ends) {
  double least = 2 * std::abs(mesh::enclosed_volume(s)) / mesh::area(s);
  for (const VesselEnd& e : ends)
    if (e.area > 0) least = std::min(least, std::sqrt(e.area / std::numbers::pi));
  return least;
}

/// Paths on a grid that is made finer until every end is reached, from the first end to each other.
struct GridPaths {
  std::vector<std::vector<Vec3>> lines;
  double spacing = 0;
};

[[nodiscard]] inline GridPaths grid_paths(const mesh::Surface& s, const std::vector<VesselEnd>& ends,
                                          const WallDistance& wall, double spacing) {
  constexpr int most_grids = 4;
  std::string missed;
  for (int n = 0; n < most_grids; ++n, spacing *= 0.5) {
    const InsideGrid grid(s, wall, spacing);
    if (grid.size() == 0) continue;
    const auto before = grid.paths_from(grid.nearest(ends.front().point));
    GridPaths paths{{}, grid.spacing()};
    missed.clear();
    for (std::size_t e = 1; e < ends.size(); ++e) {
      std::vector<Vec3> line;
      const Index target = grid.nearest(ends[e].point);
      if (before[static_cast<std::size_t>(target)] < -1) missed = ends[e].name;
      for (Index p = target; p >= 0; p = before[static_cast<std::size_t>(p)]) line.push_back(grid.place(p));
      std::reverse(line.begin(), line.end());
      paths.lines.push_back(std::move(line));
    }
    if (missed.empty()) return paths;
  }
  throw MeshError("no way leads from the end \"" + ends.front().name + "\" to " +
                  (missed.empty() ? "another" : "\"" + missed + "\"") + " within the surface");
}

/// A path drawn to the middle of the vessel. At a flat end it ends in the centre of the largest disc there.
[[nodiscard]] inline std::vector<Vec3> centred(std::vector<Vec3> x, const VesselEnd& from,
                                               const VesselEnd& to, const WallDistance& wall, double step) {
  constexpr int rounds = 8, sweeps = 3;
  constexpr double coarse = 1e-2, fine = 1e-7;  // of the radius
  const auto place = [&](const VesselEnd& e) { return most_inner(e.point, e.normal, wall, fine); };
  if (from.region >= 0)
    x.insert(x.begin(), place(from));
  else
    x.front() = from.point;
  if (to.region >= 0)
    x.push_back(place(to));
  else if (x.size() > 1)
    x.back() = to.point;
  else
    x.push_back(to.point);
  const auto draw = [&](double accuracy) {
    const auto t = tangents(x);
    for (std::size_t i = 1; i + 1 < x.size(); ++i) x[i] = most_inner(x[i], t[i], wall, accuracy);
  };
  for (int n = 0; n < rounds; ++n) {
    x = resampled(x, step);
    smooth_curve(x, sweeps);
    draw(coarse);
  }
  x = resampled(x, step);
  smooth_curve(x, 1);
  draw(fine);
  return x;
}

}  // namespace detail

/// The centre lines from the first end to all others. The surface is closed; flat ends are regions of it
/// (vessel_ends), blind ends are points within. MeshError with fewer than two ends, where one is not within
/// the surface, or where no way leads.
[[nodiscard]] inline CentreLine centre_line(const mesh::Surface& s, const std::vector<VesselEnd>& ends,
                                            const CentreLineOptions& options = {}) {
  if (ends.size() < 2)
    throw MeshError("a centre line needs two ends or more, flat ends of the vessel or points within; there " +
                    std::string(ends.empty() ? "are none" : "is one"));
  for (const VesselEnd& e : ends)  // NaN is not within either
    if (e.region < 0 && !(std::abs(mesh::solid_angle(s, e.point)) > 2 * std::numbers::pi))
      throw MeshError("the end \"" + e.name + "\" at " + place(e.point) + " is not within the surface");
  const WallDistance wall(s, ends);
  const double radius = detail::smallest_radius(s, ends);
  const double step = options.step > 0 ? options.step : radius / 2;
  auto paths = detail::grid_paths(s, ends, wall, options.spacing > 0 ? options.spacing : radius / 3);
  std::vector<std::vector<Vec3>> tangent;
  std::vector<std::vector<double>> radii;
  for (std::size_t k = 0; k < paths.lines.size(); ++k) {
    const VesselEnd &from = ends.front(), &to = ends[k + 1];
    auto& x = paths.lines[k];
    x = detail::centred(std::move(x), from, to, wall, step);
    tangent.push_back(detail::tangents(x));
    // the line meets flat ends at a right angle
    if (from.region >= 0) tangent.back().front() = vec::scaled(-1, from.normal);
    if (to.region >= 0) tangent.back().back() = to.normal;
    radii.emplace_back();
    for (const Vec3& p : x) radii.back().push_back(wall(p));
  }
  CentreLine line{ends.front().name, {}, paths.spacing};
  for (const auto& piece : detail::LineTree(paths.lines, radii).pieces) {
    CentreBranch branch;
    branch.parent = piece.parent;
    const auto& x = paths.lines[piece.line];
    if (piece.parent >= 0)
      branch.points.push_back(line.branches[static_cast<std::size_t>(piece.parent)].points.back());
    for (std::size_t i = piece.first; i <= piece.last; ++i) {
      const double arc = branch.points.empty()
                             ? 0
                             : branch.points.back().arc + vec::distance(branch.points.back().place, x[i]);
      branch.points.push_back({x[i], tangent[piece.line][i], arc, radii[piece.line][i]});
    }
    if (piece.last + 1 == x.size()) branch.end = ends[piece.line + 1].name;
    line.branches.push_back(std::move(branch));
  }
  return line;
}

/// The sections square to a branch, one a point: the part that holds the point. At flat ends the plane is
/// drawn into the vessel by a thousandth of the radius.
[[nodiscard]] inline std::vector<SectionArea> section_areas(const mesh::Surface& s,
                                                            const CentreBranch& branch) {
  SectionFinder find(s);
  std::vector<SectionArea> areas;
  constexpr double into = 1e-3;
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const CentrePoint& p = branch.points[i];
    const double shift = i == 0 ? into : i + 1 == branch.points.size() ? -into : 0;
    areas.push_back(find.at({vec::along(p.place, shift * p.radius, p.tangent), p.tangent}));
  }
  return areas;
}

}  // namespace tunica::meshing
