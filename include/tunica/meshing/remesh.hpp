// SPDX-License-Identifier: MIT
// Isotropic remeshing to a target edge length [BOTSCH04]: split, collapse, flip, relax along the surface.
// Rims, flat regions and the volume are kept; no edit folds the surface or makes it cross itself.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/text.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/edit_flips.hpp"
#include "tunica/meshing/editable_surface.hpp"
#include "tunica/meshing/restore_volume.hpp"
#include "tunica/meshing/surface_target.hpp"
#include "tunica/meshing/wear.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct RemeshOptions {
  double edge = 0;           // target length, in the unit of the surface
  int passes = 8;            // of split, collapse, flip and relax
  double sharp_angle = 180;  // [degrees] edges that turn by more are kept too; 180: only rims of regions
};

struct RemeshReport {
  Index triangles = 0;
  double smallest_angle = 0;  // [degrees]
  double volume_before = 0, volume_after = 0;
  LeftOut left_out;         // edits that would have folded or crossed the surface
  Index kept_features = 0;  // collapses left out because they would have worn down a feature
};

namespace detail {

class Remesher {
 public:
  Remesher(const mesh::Surface& s, const RemeshOptions& o)
      : source_(s),
        options_(o),
        facets_(facets(s, o.sharp_angle)),
        target_(s, facets_),
        edit_(s, facets_, o.edge) {}

  [[nodiscard]] mesh::Surface run(RemeshReport& report) {
    for (int pass = 0; pass < options_.passes; ++pass) {
      split_long();
      collapse_short();
      flip_to_valence(edit_);
      relax();
    }
    for (int pass = 0; pass < 4; ++pass) {
      flip_to_angle(edit_);
      repair_angles();
      relax();
    }
    flip_to_angle(edit_);
    for (int pass = 0; pass < 4; ++pass) fit();
    flip_to_angle(edit_);
    repair_angles();
    mesh::Surface r = edit_.surface();  // labelled by facets: flat ones stay flat, also without regions
    r.region_names.resize(facets_.region.size());
    restore_volume(r, mesh::enclosed_volume(source_), 0.1 * options_.edge);
    for (Index& label : r.region) label = facets_.region[static_cast<std::size_t>(label)];
    r.region_names = source_.region_names;
    report.left_out = edit_.left_out();
    report.kept_features = kept_features_;
    return r;
  }

 private:
  /// x on the facet or rim of node n.
  [[nodiscard]] Vec3 on_target(Index n, const Vec3& x) const {
    const auto f = edit_.facets_at(n);
    if (f.size() == 1) return target_.nearest(x, f[0]).point;
    return f.size() == 2 ? on_rim(x, f[0], f[1]) : x;
  }

  /// x on the rim of two facets, and exactly in the plane of each that is flat.
  [[nodiscard]] Vec3 on_rim(const Vec3& x, Index p, Index q) const {
    Vec3 y = target_.nearest_on_rim(x, p, q);
    for (const Index f : {p, q})
      if (const auto& plane = facets_.planes[static_cast<std::size_t>(f)]) y = plane->projected(y);
    return y;
  }

  void split_long() {
    const double most = 4.0 / 3 * options_.edge;
    auto todo = edges_of(edit_, [&](double l) { return l > most; });
    for (auto e = todo.rbegin(); e != todo.rend(); ++e) {
      if (!has_edge(edit_, e->a, e->b)) continue;
      const auto [s, t] = edit_.sides(e->a, e->b);
      const Vec3 middle = 0.5 * (edit_.x(e->a) + edit_.x(e->b));
      const Index p = edit_.facet(s), q = edit_.facet(t);
      const Vec3 place =
          p == q ? target_.nearest(middle, p).point : on_rim(middle, std::min(p, q), std::max(p, q));
      if (edit_.split(e->a, e->b, place) < 0) (void)edit_.split(e->a, e->b, middle);
    }
  }

  void collapse_short() {
    const double least = 4.0 / 5 * options_.edge;
    for (const EditEdge& e : edges_of(edit_, [&](double l) { return l < least; }))
      if (has_edge(edit_, e.a, e.b) && edit_.length(e.a, e.b) < least)
        (void)collapse(e.a, e.b, 4.0 / 3 * options_.edge);
  }

  /// Merges an edge into its more strongly bound node or its middle, unless an edge longer than `most`
  /// results.
  bool collapse(Index a, Index b, double most) {
    NodeKind ka = edit_.kind(a), kb = edit_.kind(b);
    if (kb > ka) std::swap(a, b), std::swap(ka, kb);
    if (kb == NodeKind::corner) return false;
    if (kb == NodeKind::rim && !edit_.on_rim(a, b)) return false;
    Vec3 place = edit_.x(a);
    if (ka == kb) place = on_target(a, 0.5 * (edit_.x(a) + edit_.x(b)));
    const auto tried = [&](Index stays, Index goes, const Vec3& p) {
      for (const Index n : {a, b})
        for (const Index m : edit_.neighbours(n))
          if (m != a && m != b && (edit_.x(m) - p).norm() > most) return false;
      const double lost = wear_.after(edit_, a, b, p);
      if (lost > most_wear * options_.edge) {
        ++kept_features_;
        return false;
      }
      if (!edit_.collapse(stays, goes, p)) return false;
      wear_.set(stays, lost);
      return true;
    };
    if (tried(a, b, place)) return true;
    if (ka != kb) return false;
    return tried(a, b, edit_.x(a)) || tried(b, a, edit_.x(b));
  }

  void relax() {
    for (Index n = 0; n < edit_.node_count(); ++n)
      if (edit_.used(n)) relax_node(n);
  }

  /// Towards the mean of its neighbours, weighted by area, along the surface; on a rim along the rim.
  void relax_node(Index n) {
    const NodeKind kind = edit_.kind(n);
    if (kind == NodeKind::corner) return;
    Vec3 to = Vec3::Zero();
    if (kind == NodeKind::rim) {
      const auto m = edit_.rim_neighbours(n);
      to = 0.5 * (edit_.x(m[0]) + edit_.x(m[1]));
    } else {
      double weight = 0;
      Vec3 normal = Vec3::Zero();
      for (const Index t : edit_.ring(n)) {
        const mesh::Triangle f = edit_.triangle(t);
        const double w = f.area();
        to += w * f.centroid(), weight += w, normal += f.area_vector();
      }
      normal.normalize();
      to /= weight;
      to += normal.dot(edit_.x(n) - to) * normal;
    }
    to = on_target(n, to);
    if (!edit_.move(n, to)) (void)edit_.move(n, on_target(n, 0.5 * (to + edit_.x(n))));
  }

  /// Triangles below `wanted`: a short edge is collapsed, or a corner moved to raise the worst angle there.
  void repair_angles() {
    constexpr double wanted = 0.44;  // [rad] 25 degrees
    std::vector<std::pair<double, Index>> bad;
    for (Index t = 0; t < edit_.triangle_count(); ++t)
      if (edit_.alive(t))
        if (const double a = edit_.triangle(t).smallest_angle(); a < wanted) bad.emplace_back(a, t);
    std::sort(bad.begin(), bad.end());
    for (const auto& [a, t] : bad) {
      if (!edit_.alive(t) || edit_.triangle(t).smallest_angle() >= wanted) continue;
      const auto v = edit_.nodes(t);
      std::size_t shortest = 0;
      for (std::size_t k = 1; k < 3; ++k)
        if (edit_.length(v[k], v[(k + 1) % 3]) < edit_.length(v[shortest], v[(shortest + 1) % 3]))
          shortest = k;
      const Index p = v[shortest], q = v[(shortest + 1) % 3];
      if (edit_.length(p, q) < 0.7 * options_.edge && collapse(p, q, 1.5 * options_.edge)) continue;
      for (const Index n : v) raise(n);
    }
  }

  [[nodiscard]] double worst_about(Index n) const {
    double worst = 4;
    for (const Index t : edit_.ring(n)) worst = std::min(worst, edit_.triangle(t).smallest_angle());
    return worst;
  }

  /// Tries a few places about a node and keeps the one with the largest smallest angle.
  void raise(Index n) {
    const NodeKind kind = edit_.kind(n);
    if (kind == NodeKind::corner) return;
    double best = worst_about(n);
    for (double step : {0.3, 0.15, 0.07, 0.03}) {
      const auto m = kind == NodeKind::rim ? edit_.rim_neighbours(n) : edit_.neighbours(n);
      for (const Index to : m) {
        const Vec3 from = edit_.x(n);
        const Vec3 place = on_target(n, from + step * (edit_.x(to) - from));
        if (!edit_.move(n, place)) continue;
        const double now = worst_about(n);
        if (now > best)
          best = now;
        else
          (void)edit_.move(n, from);
      }
    }
  }

  /// Offsets that let the triangles, not only their corners, follow the target: the mean of the deviation of
  /// a triangle is that of its edges' middles (exact for a quadratic), of a rim edge by Simpson's rule.
  void fit() {
    const auto count = static_cast<std::size_t>(edit_.node_count());
    std::vector<double> weight(count, 0), rise(count, 0);
    std::vector<Vec3> normal(count, Vec3::Zero());
    for (Index t = 0; t < edit_.triangle_count(); ++t) {
      if (!edit_.alive(t) || facets_.planes[static_cast<std::size_t>(edit_.facet(t))]) continue;
      const auto& v = edit_.nodes(t);
      const mesh::Triangle f = edit_.triangle(t);
      const Vec3 area = f.area_vector();
      const double a = area.norm();
      double mean = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 middle = 0.5 * (edit_.x(v[k]) + edit_.x(v[(k + 1) % 3]));
        mean += (target_.nearest(middle, edit_.facet(t)).point - middle).dot(area) / a / 3;
      }
      for (const Index n : v) {
        const auto i = static_cast<std::size_t>(n);
        weight[i] += a, rise[i] += a * mean, normal[i] += area;
      }
    }
    for (Index n = 0; n < edit_.node_count(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      if (!edit_.used(n) || weight[i] == 0) continue;
      const NodeKind kind = edit_.kind(n);
      if (kind == NodeKind::corner) continue;
      Vec3 direction = normal[i];
      double by = rise[i] / weight[i];
      if (kind == NodeKind::rim) {
        const auto f = edit_.facets_at(n);
        for (const Index p : f)
          if (const auto& plane = facets_.planes[static_cast<std::size_t>(p)])
            direction -= plane->normal.dot(direction) * plane->normal;
        if (direction.norm() <= 1e-6 * normal[i].norm()) continue;
        direction.normalize();
        double sum = 0, length = 0;
        for (const Index m : edit_.rim_neighbours(n)) {
          const auto off = [&](const Vec3& x) { return (on_rim(x, f[0], f[1]) - x).dot(direction); };
          const double l = edit_.length(n, m);
          sum += l * (off(edit_.x(n)) + 4 * off(0.5 * (edit_.x(n) + edit_.x(m))) + off(edit_.x(m))) / 6;
          length += l;
        }
        by = sum / length;
      }
      (void)edit_.move(n, edit_.x(n) + by * direction.normalized());
    }
  }

  const mesh::Surface& source_;
  RemeshOptions options_;
  Facets facets_;
  SurfaceTarget target_;
  EditableSurface edit_;
  static constexpr double most_wear = 0.3;  // of the edge length: halves the rms distance at a thin stub
  Wear wear_;
  Index kept_features_ = 0;
};

}  // namespace detail

struct [[nodiscard]] Remeshed {
  mesh::Surface surface;
  RemeshReport report;
};

/// Remeshes a closed surface to triangles whose edges are about options.edge long. Regions, their rims and
/// their planes are kept, and the enclosed volume. MeshError if the surface is not closed or crosses itself,
/// with a place.
[[nodiscard]] inline Remeshed remesh(const mesh::Surface& s, const RemeshOptions& options) {
  TUNICA_EXPECT(options.edge > 0, "the target edge length is positive");
  constexpr double most_triangles = 2e7;  // they would not be held in memory
  if (const double wanted = mesh::area(s) / options.edge / options.edge / 0.433; !(wanted <= most_triangles))
    throw MeshError("an edge length of " + seven_digits(options.edge) + " would take " +
                    seven_digits(wanted) + " triangles, more than " + seven_digits(most_triangles));
  require_no_crossing(s);
  Remeshed r;
  r.report.volume_before = mesh::enclosed_volume(s);
  r.surface = detail::Remesher(s, options).run(r.report);
  r.report.volume_after = mesh::enclosed_volume(r.surface);
  r.report.triangles = r.surface.cell_count();
  r.report.smallest_angle = mesh::quality(r.surface).angle.least;
  return r;
}

}  // namespace tunica::meshing
