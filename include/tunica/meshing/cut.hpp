// SPDX-License-Identifier: MIT
// Cuts by planes and discs: what lies in front is taken away and the opening closed by a flat, named cap.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/cut_split.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// A plane, or with a radius a disc. Lengths in the unit of the surface.
struct Cut {
  Vec3 point{0, 0, 0};
  Vec3 normal{1, 0, 0};  // outward, of any length: normal . (x - point) < 0 is kept
  double radius = std::numeric_limits<double>::infinity();
  std::string name{};  // of the cap's region; empty: "cut 1", "cut 2" ... in order
};

struct CutOptions {
  std::optional<Vec3> seed;  // a point of the part that stays behind a disc; none: the larger part
};

/// What a cut made.
struct CutReport {
  std::string name;
  Index region = 0;      // of the cap
  double area = 0;       // of the cap
  Vec3 centre{0, 0, 0};  // of the cap
  Index rim_edges = 0;
  Index snapped = 0;  // nodes that were moved onto the plane
};

struct [[nodiscard]] CutSurface {
  mesh::Surface surface;        // regions: "wall", the cuts in their order, the borders that are left
  std::vector<CutReport> cuts;  // one for each cut, in order
};

namespace detail {

/// The triangles of the sections that a cut severs; MeshError where it severs nothing or only a part.
[[nodiscard]] inline std::vector<char> severed(const mesh::Surface& s, const std::vector<Index>& twin,
                                               const std::vector<double>& distance, const PlaneFrame& frame,
                                               const Cut& cut) {
  const auto [lo, hi] = std::minmax_element(distance.begin(), distance.end());
  if (*lo >= 0) throw MeshError(cut.name + " leaves nothing: all of the surface lies in front of it");
  std::vector<char> active(static_cast<std::size_t>(s.cell_count()), 0);
  double nearest = *hi < 0 ? -*hi : std::numeric_limits<double>::infinity();
  bool met = false;
  for (const Section& part : sections(s, twin, distance, frame)) {
    nearest = std::min(nearest, std::max(0.0, part.nearest - cut.radius));
    if (part.nearest > cut.radius) continue;
    if (part.farthest > cut.radius)
      throw MeshError(cut.name + " does not sever the vessel round " + place(part.centre) + ": its radius " +
                      seven_digits(cut.radius) + " is too small by " +
                      seven_digits(part.farthest - cut.radius));
    met = true;
    for (const Index t : part.triangles) active[static_cast<std::size_t>(t)] = 1;
  }
  if (!met)
    throw MeshError(cut.name + " at " + place(cut.point) +
                    " meets nothing: the nearest part lies at a distance of " + seven_digits(nearest));
  return active;
}

/// Region numbers after a cap is put in front of the borders of the image; regions left empty are dropped.
inline void renumber(mesh::Surface& s, const std::vector<std::string>& before, Index cap_from,
                     const Cut& cut) {
  std::vector<std::string> names;
  std::vector<Index> fresh(before.size(), -1);
  std::vector<char> used(before.size(), 0);
  for (Index t = 0; t < cap_from; ++t)
    used[static_cast<std::size_t>(s.region[static_cast<std::size_t>(t)])] = 1;
  const auto is_border = [](const std::string& name) {
    return name.compare(0, border_prefix.size(), border_prefix) == 0;
  };
  for (std::size_t r = 0; r < before.size(); ++r) {
    if (is_border(before[r])) continue;
    if (!used[r] && r > 0) throw MeshError(cut.name + " removes all of \"" + before[r] + "\"");
    fresh[r] = static_cast<Index>(names.size()), names.push_back(before[r]);
  }
  const auto cap = static_cast<Index>(names.size());
  names.push_back(cut.name);
  for (std::size_t r = 0; r < before.size(); ++r)
    if (is_border(before[r]) && used[r])
      fresh[r] = static_cast<Index>(names.size()), names.push_back(before[r]);
  for (Index t = 0; t < s.cell_count(); ++t) {
    Index& r = s.region[static_cast<std::size_t>(t)];
    r = t < cap_from ? fresh[static_cast<std::size_t>(r)] : cap;
  }
  s.region_names = std::move(names);
}

/// Makes one cut; the number of nodes that were moved onto the plane.
inline Index apply(mesh::Surface& s, Cut cut, const CutOptions& options) {
  TUNICA_EXPECT(vec::length(cut.normal) > 0, "the normal of a cut has a length");
  TUNICA_EXPECT(cut.radius > 0, "the radius of a cut is positive");
  cut.normal = vec::unit(cut.normal);
  for (const auto& name : s.region_names)
    if (name == cut.name) throw MeshError("two regions are named \"" + cut.name + "\"");
  std::vector<Index> avoided;
  constexpr int most_attempts = 4;
  for (int attempt = 1;; ++attempt) {
    Splitter split(s, Plane{cut.point, cut.normal});
    split.split(severed(s, split.twin(), split.distance(), PlaneFrame(cut.point, cut.normal), cut), avoided);
    if (std::isinf(cut.radius))
      split.keep_behind();
    else
      split.keep_part(options.seed, cut.name);
    const auto pinched = split.pinched();
    if (!pinched.empty() && attempt < most_attempts) {
      avoided.insert(avoided.end(), pinched.begin(), pinched.end());
      std::sort(avoided.begin(), avoided.end());
      continue;
    }
    const auto before = s.region_names;
    mesh::Surface closed;
    const Index cap_from = split.close(closed);
    if (cap_from == closed.cell_count()) throw MeshError(cut.name + " only touches the surface");
    s = std::move(closed);
    renumber(s, before, cap_from, cut);
    return split.snapped();
  }
}

/// Area, centre and rim of the cap of a region.
inline void measure(const mesh::Surface& s, CutReport& r) {
  for (std::size_t n = 0; n < s.region_names.size(); ++n)
    if (s.region_names[n] == r.name) r.region = static_cast<Index>(n);
  const auto twin = mesh::twins(s.cells, s.node_count());
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (s.region_of(t) != r.region) continue;
    const mesh::Triangle f = mesh::triangle(s, t);
    r.area += f.area(), r.centre = vec::along(r.centre, f.area(), f.centroid());
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
      r.rim_edges += s.region_of(twin[static_cast<std::size_t>(h)] / 3) != r.region;
  }
  if (r.area > 0) r.centre = vec::divided(r.centre, r.area);
}

}  // namespace detail

/// Cuts a closed surface, one cut after the other. A plane removes all in front of it. A disc severs only the
/// vessel that it crosses: the part with the seed stays (without a seed the larger one), on either side. Rims
/// are sharp, caps lie in their planes to rounding, the result is closed. MeshError where a cut meets nothing
/// (with its distance), does not sever its vessel (with the radius that is missing), leaves nothing, or takes
/// away all of an earlier cap.
[[nodiscard]] inline CutSurface cut(mesh::Surface surface, std::span<const Cut> cuts,
                                    const CutOptions& options = {}) {
  CutSurface result{std::move(surface), {}};
  mesh::Surface& s = result.surface;
  if (s.region_names.empty()) s.region_names.emplace_back("wall");
  if (s.region.empty()) s.region.assign(static_cast<std::size_t>(s.cell_count()), 0);
  for (Cut c : cuts) {
    if (c.name.empty()) c.name = "cut " + std::to_string(result.cuts.size() + 1);
    result.cuts.push_back({.name = c.name, .snapped = detail::apply(s, c, options)});
  }
  for (CutReport& r : result.cuts) detail::measure(s, r);
  return result;
}

}  // namespace tunica::meshing
