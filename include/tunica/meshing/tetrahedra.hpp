// SPDX-License-Identifier: MIT
// tetrahedra(surface): fills any closed surface with tetrahedra and keeps every triangle of it.
// A body-centred lattice inside, Delaunay, the surface recovered by exact signs, improvement.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/triangle.hpp"
#include "tunica/meshing/front_recovery.hpp"
#include "tunica/meshing/front_ways.hpp"
#include "tunica/meshing/improve.hpp"
#include "tunica/meshing/lattice.hpp"
#include "tunica/meshing/size_field.hpp"
#include "tunica/meshing/tet_complex.hpp"
#include "tunica/meshing/tet_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct FillOptions {
  double growth = 0.0;        // of the size per distance from the surface, 0: as at the surface; with a size
                              // field of how fast that takes over from shorter edges of the surface, 0: 0.3
  double lattice_edge = 1.0;  // mean edge of the inner lattice over the size; 1: inner tetrahedra as regular
                              // ones on triangles of that size would be
  double clearance = 0.5;     // of the lattice from the surface, over the size of its triangles
  double target_angle = 18;   // [degrees] dihedral angles below it (or above 180 minus it) are worked on
};

/// What was filled and how well. Angles in degrees, volumes in the cube of the surface's unit.
struct FillReport {
  Index nodes = 0, tetrahedra = 0;
  double min_dihedral = 0, max_dihedral = 0;
  double mean_ratio = 0;                // mean over the tetrahedra, 1: regular
  double volume = 0, volume_error = 0;  // error relative to the volume that the surface bounds
  double surface_min_angle = 0;         // smallest angle of a triangle: a bound for the tetrahedra
  double surface_min_dihedral = 0;      // smallest inner angle between two triangles
  Index below_target = 0;               // tetrahedra that miss the target angle
  Index missing_edges = 0, missing_faces = 0, steiner = 0;  // of the recovery
  ImproveCounts improvement;
};

struct [[nodiscard]] FillResult {
  mesh::TetMesh mesh;
  FillReport report;
};

namespace detail {

/// Six times the enclosed volume about `origin`, in long double.
[[nodiscard]] inline long double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto to = [&a](const Vec3& p, Eigen::Index k) {
    return static_cast<long double>(p[k]) - static_cast<long double>(a[k]);
  };
  const auto minor = [&](Eigen::Index i, Eigen::Index j) {
    return to(b, i) * to(c, j) - to(b, j) * to(c, i);
  };
  return minor(1, 2) * to(d, 0) + minor(2, 0) * to(d, 1) + minor(0, 1) * to(d, 2);
}

inline void measure_surface(const FrontSurface& s, const std::vector<Vec3>& nodes, FillReport& r) {
  const auto p = [&](Index n) { return nodes[static_cast<std::size_t>(n)]; };
  double least = std::numbers::pi, fold = 2 * std::numbers::pi;
  for (const Triple& t : s.triangles)
    least = std::min(least, mesh::Triangle{p(t[0]), p(t[1]), p(t[2])}.smallest_angle());
  for (const auto& e : s.edges) {
    const auto apex = [&](Index f) {
      for (const Index n : s.triangles[static_cast<std::size_t>(f)])
        if (n != e.a && n != e.b) return p(n);
      return p(e.a);
    };
    using vec::dot, vec::minus;
    const Vec3 axis = vec::unit(minus(p(e.b), p(e.a)));
    const Vec3 u = minus(apex(e.triangles[0]), p(e.a)), v = minus(apex(e.triangles[1]), p(e.a));
    const Vec3 un = vec::along(u, -dot(u, axis), axis), vn = vec::along(v, -dot(v, axis), axis);
    // The inside lies below triangle 0, which runs from a to b: turn from u to v against the axis.
    double angle = std::atan2(dot(vec::cross(vn, un), axis), dot(un, vn));
    if (angle < 0) angle += 2 * std::numbers::pi;
    fold = std::min(fold, angle);
  }
  long double volume = 0;
  for (const Triple& t : s.triangles) volume += six_volumes(p(s.triangles[0][0]), p(t[0]), p(t[1]), p(t[2]));
  if (volume < 0) throw MeshError("the surface is inward: the volume that it bounds is negative");
  r.surface_min_angle = least * 180 / std::numbers::pi;
  r.surface_min_dihedral = fold * 180 / std::numbers::pi;
}

/// Checks everything that is promised and measures the rest: signs, border, volume, angles. RecoveryFailure
/// where a promise is broken.
inline void verify(const TetComplex& c, const FrontSurface& s, const FillOptions& options, FillReport& r) {
  std::vector<char> found(s.triangles.size(), 0);
  constexpr Index block = 1024;  // sums of blocks: equal terms would round to the same side
  long double volume = 0, part = 0, bounded = 0;
  double least = std::numbers::pi, most = 0, ratio = 0;
  const double target = options.target_angle * std::numbers::pi / 180;
  for (Index t = 0; t < c.size(); ++t) {
    if (t % block == 0) volume += part, part = 0;
    if (!c.alive(t)) continue;
    const Quad& n = c.nodes(t);
    if (!(c.orient(n) > 0)) throw RecoveryFailure{c.point(n[0]), "a tetrahedron is inverted"};
    ++r.tetrahedra;
    for (int f = 0; f < 4; ++f) {
      if (c.across(t, f) >= 0) continue;
      const Index m = s.triangle_of(c.face(t, f));
      if (m < 0 || found[static_cast<std::size_t>(m)] != 0)
        throw RecoveryFailure{c.point(n[0]), "a face of the border is no triangle of the surface"};
      found[static_cast<std::size_t>(m)] = 1;
    }
    const std::array<Vec3, 4> p{c.point(n[0]), c.point(n[1]), c.point(n[2]), c.point(n[3])};
    part += six_volumes(p[0], p[1], p[2], p[3]);
    const auto angles = dihedral_angles(p[0], p[1], p[2], p[3]);
    double lo = angles[0], hi = angles[0];
    for (const double a : angles) lo = std::min(lo, a), hi = std::max(hi, a);
    least = std::min(least, lo), most = std::max(most, hi);
    r.below_target += lo < target || hi > std::numbers::pi - target;
    ratio += mean_ratio(p[0], p[1], p[2], p[3]);
  }
  volume += part;
  for (std::size_t f = 0; f < found.size(); ++f)
    if (found[f] == 0)
      throw RecoveryFailure{c.point(s.triangles[f][0]), "a triangle of the surface is not in the filling"};
  const Vec3 o = c.point(s.triangles[0][0]);
  for (const Triple& t : s.triangles) bounded += six_volumes(o, c.point(t[0]), c.point(t[1]), c.point(t[2]));
  r.volume = static_cast<double>(volume / 6);
  r.volume_error = static_cast<double>(std::abs(volume - bounded) / std::abs(bounded));
  r.min_dihedral = least * 180 / std::numbers::pi;
  r.max_dihedral = most * 180 / std::numbers::pi;
  r.mean_ratio = ratio / std::max<double>(1, r.tetrahedra);
}

/// The mesh: nodes of the surface first, then the inner ones in the order of their making.
[[nodiscard]] inline mesh::TetMesh to_mesh(const TetComplex& c, const mesh::Surface& surface) {
  mesh::TetMesh m;
  const Index kept = surface.node_count();
  std::vector<Index> number(c.points.size(), -1);
  Index nodes = kept, cells = 0;
  for (std::size_t n = 0; n < number.size(); ++n)
    number[n] = static_cast<Index>(n) < kept ? static_cast<Index>(n) : c.tet_of[n] >= 0 ? nodes++ : -1;
  for (Index t = 0; t < c.size(); ++t) cells += c.alive(t);
  m.nodes.resize(3, nodes);
  for (Index n = 0; n < kept; ++n) vec::set_column(m.nodes, n, vec::column(surface.nodes, n));
  for (std::size_t n = static_cast<std::size_t>(kept); n < number.size(); ++n)
    if (number[n] >= 0) vec::set_column(m.nodes, number[n], c.points[n]);
  m.cells.resize(4, cells);
  cells = 0;
  for (Index t = 0; t < c.size(); ++t) {
    if (!c.alive(t)) continue;
    for (std::size_t i = 0; i < 4; ++i)
      m.cells(static_cast<Eigen::Index>(i), cells) = number[static_cast<std::size_t>(c.nodes(t)[i])];
    ++cells;
  }
  const std::size_t regions = std::max<std::size_t>(1, surface.region_names.size());
  std::vector<Index> size(regions, 0);
  for (Index f = 0; f < surface.cell_count(); ++f) ++size[static_cast<std::size_t>(surface.region_of(f))];
  for (std::size_t r = 0; r < regions; ++r) {
    mesh::Patch<mesh::Tri3> patch{r < surface.region_names.size() ? surface.region_names[r] : "wall", {}};
    patch.faces.resize(3, size[r]);
    Index at = 0;
    for (Index f = 0; f < surface.cell_count(); ++f)
      if (static_cast<std::size_t>(surface.region_of(f)) == r) {
        for (Eigen::Index i = 0; i < 3; ++i) patch.faces(i, at) = surface.cells(i, f);
        ++at;
      }
    m.patches.push_back(std::move(patch));
  }
  return m;
}

}  // namespace detail

/// Fills the closed, oriented surface. Its nodes come first, with their numbers and coordinates;
/// every triangle of it is a face of the border; its regions become the patches, with their names,
/// in their order. Parts that lie inside one another are cavities, parts beside one another are
/// filled each. Inner edges follow the size field, but near the surface they are no longer than its
/// triangles. MeshError names the place when the surface is open, not manifold, inward, crosses itself, or
/// could not be filled.
template <SizeField Size>
FillResult tetrahedra(const mesh::Surface& surface, const FillOptions& options, const Size& size) {
  const FrontSurface front(surface.nodes, surface.cells);
  std::vector<Vec3> nodes;
  for (Index n = 0; n < surface.node_count(); ++n) nodes.push_back(vec::column(surface.nodes, n));
  for (const Index r : surface.region)
    if (r < 0 || static_cast<std::size_t>(r) >= std::max<std::size_t>(1, surface.region_names.size()))
      throw MeshError("a triangle of the surface has region " + std::to_string(r) + ", which has no name");
  const SurfaceSize distances(surface.nodes, surface.cells, SizeWithin<Size>::growth(options.growth));
  const SizeWithin<Size> inner_size(distances, size);

  FillReport measured;
  detail::measure_surface(front, nodes, measured);
  // Flat tetrahedra that the surface does not ask for send the filler on to the next way.
  constexpr double flat = 0.1;  // [degrees]
  constexpr int most_fillings = 3;
  int fillings = 0;
  const double bound = std::min(measured.surface_min_angle, measured.surface_min_dihedral);
  const double poor = bound > flat ? std::min(flat, 0.5 * bound) : 0;
  const double target = std::sin(options.target_angle * std::numbers::pi / 180);
  FillResult best;
  const detail::Stretch axes = detail::along_axes(front, nodes);
  const detail::Stretch all_directions = detail::in_all_directions(front, nodes);
  std::string first_failure;
  for (const detail::FillWay& way : detail::fill_ways) {
    const bool some = best.report.tetrahedra > 0;
    if (some && (best.report.min_dihedral >= poor || fillings == most_fillings)) break;
    const detail::Stretch stretch = way.space == detail::axes             ? axes
                                    : way.space == detail::all_directions ? all_directions
                                                                          : detail::Stretch{};
    if (way.space != detail::own && stretch.even) continue;
    LatticeOptions lattice{.edge = options.lattice_edge, .clearance = options.clearance};
    lattice.shift = vec::scaled(way.lattice, Vec3(0.37, 0.23, 0.11));
    std::vector<Vec3> inner;
    if (way.with_inner) inner = Lattice(distances, inner_size, lattice).points();
    TetComplex complex;
    FillReport report = measured;
    try {
      auto start = way.shake > 0 ? detail::shaken(front, nodes, way.shake) : nodes;
      const RecoveryCounts counts = FrontRecovery::run(complex, front, detail::mapped(start, stretch.to),
                                                       detail::mapped(std::move(inner), stretch.to), way.way);
      report.missing_edges = counts.missing_edges;
      report.missing_faces = counts.missing_faces;
      report.steiner = counts.steiner;
      complex.points = detail::mapped(std::move(complex.points), stretch.back);
      std::copy(start.begin(), start.end(), complex.points.begin());
      report.improvement = Improve::run(complex, detail::surface_limits(front, nodes), target);
      std::copy(nodes.begin(), nodes.end(), complex.points.begin());
      detail::verify(complex, front, options, report);
    } catch (const MeshError&) {
      if (way.shake == 0 && way.space == detail::own) throw;
      continue;  // moved too far by the shake or by rounding
    } catch (const RecoveryFailure& failure) {
      if (first_failure.empty()) first_failure = std::string(failure.what) + ", at " + place(failure.place);
      continue;
    }
    ++fillings;
    if (best.report.tetrahedra > 0 && !(report.min_dihedral > best.report.min_dihedral)) continue;
    best.mesh = detail::to_mesh(complex, surface);
    report.nodes = best.mesh.node_count();
    best.report = report;
  }
  if (best.report.tetrahedra == 0) throw MeshError("the surface could not be filled: " + first_failure);
  return best;
}

/// As above, with the size of the surface carried into the inside.
[[nodiscard]] inline FillResult tetrahedra(const mesh::Surface& surface, const FillOptions& options = {}) {
  const SurfaceSize size(surface.nodes, surface.cells, options.growth);
  return tetrahedra(surface, options, size);
}

}  // namespace tunica::meshing
