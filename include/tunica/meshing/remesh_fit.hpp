// SPDX-License-Identifier: MIT
// Nodes move off the surface that is followed, so that the triangles lie on it in the mean.
#pragma once

#include "tunica/meshing/remesh_state.hpp"

#include <cstddef>
#include <vector>

namespace tunica::meshing::detail {

/// What the triangles at each node say: their area, their mean deviation from the target times it, and the
/// sum of their area vectors.
struct Deviation {
  std::vector<double> weight, rise;
  std::vector<Vec3> normal;
};

/// The mean of the deviation of a triangle is that of its edges' middles (exact for a quadratic).
template <class Size>
[[nodiscard]] Deviation deviation(const RemeshState<Size>& w) {
  const EditableSurface& s = w.edit;
  const auto count = static_cast<std::size_t>(s.node_count());
  Deviation d{std::vector<double>(count, 0), std::vector<double>(count, 0),
              std::vector<Vec3>(count, Vec3::Zero())};
  for (Index t = 0; t < s.triangle_count(); ++t) {
    if (!s.alive(t) || w.plane(s.facet(t))) continue;
    const auto& v = s.nodes(t);
    const mesh::Triangle f = s.triangle(t);
    const Vec3 area = f.area_vector();
    const double a = area.norm();
    double mean = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 middle = 0.5 * (s.x(v[k]) + s.x(v[(k + 1) % 3]));
      mean += (w.target.nearest(middle, s.facet(t)).point - middle).dot(area) / a / 3;
    }
    for (const Index n : v) {
      const auto i = static_cast<std::size_t>(n);
      d.weight[i] += a, d.rise[i] += a * mean, d.normal[i] += area;
    }
  }
  return d;
}

/// The mean deviation of the rim edges at n along a direction, each by Simpson's rule.
template <class Size>
[[nodiscard]] double rim_rise(const RemeshState<Size>& w, Index n, const Vec3& direction) {
  const EditableSurface& s = w.edit;
  const auto f = facets_at(s, n);
  double sum = 0, length = 0;
  for (const Index m : rim_neighbours(s, n)) {
    const auto off = [&](const Vec3& x) { return (w.on_rim(x, f[0], f[1]) - x).dot(direction); };
    const double l = s.length(n, m);
    sum += l * (off(s.x(n)) + 4 * off(0.5 * (s.x(n) + s.x(m))) + off(s.x(m))) / 6;
    length += l;
  }
  return sum / length;
}

template <class Size>
void fit(RemeshState<Size>& w) {
  EditableSurface& s = w.edit;
  const Deviation d = deviation(w);
  constexpr double across = 1e-6;  // sine to the plane: below it the surface is level with a flat end
  for (Index n = 0; n < s.node_count(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (!s.used(n) || d.weight[i] == 0) continue;
    const NodeKind kind = kind_of(s, n);
    if (kind == NodeKind::corner) continue;
    Vec3 direction = d.normal[i];
    double by = d.rise[i] / d.weight[i];
    if (kind == NodeKind::rim) {
      for (const Index p : facets_at(s, n))
        if (const auto& flat = w.plane(p)) direction -= flat->normal.dot(direction) * flat->normal;
      if (direction.norm() <= across * d.normal[i].norm()) continue;
      direction.normalize();
      by = rim_rise(w, n, direction);
    }
    (void)s.move(n, s.x(n) + by * direction.normalized());
  }
}

}  // namespace tunica::meshing::detail
