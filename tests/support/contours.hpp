// SPDX-License-Identifier: MIT
// Checks of closed surfaces of triangles or quadrilaterals, and the work cases of the meshing tests.
#pragma once

#include "tunica/image/image.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace tunica::test::contours {

struct Topology {
  int open_edges = 0;      // of one cell
  int wrong_edges = 0;     // of more than two, or of two that run the same way
  int wrong_vertices = 0;  // the cells around them are more than one fan
  int loose_vertices = 0;  // of no cell
  long euler = 0;          // V - E + F of the vertices in use
};

/// Counts what is not closed, not manifold or not consistently oriented.
template <class C>
Topology topology(const mesh::Mesh<C, 3>& m) {
  Topology result;
  std::map<std::pair<Index, Index>, std::vector<std::pair<Index, bool>>> edges;
  std::vector<std::vector<Index>> cells_of(static_cast<std::size_t>(m.node_count()));
  for (Index c = 0; c < m.cell_count(); ++c)
    for (int k = 0; k < C::nodes; ++k) {
      const Index a = m.cells(k, c), b = m.cells((k + 1) % C::nodes, c);
      edges[{std::min(a, b), std::max(a, b)}].emplace_back(c, a < b);
      cells_of[static_cast<std::size_t>(a)].push_back(c);
    }
  for (const auto& [edge, uses] : edges) {
    if (uses.size() == 1)
      ++result.open_edges;
    else if (uses.size() != 2 || uses[0].second == uses[1].second)
      ++result.wrong_edges;
  }
  for (Index v = 0; v < m.node_count(); ++v) {
    const auto& around = cells_of[static_cast<std::size_t>(v)];
    if (around.empty()) {
      ++result.loose_vertices;
      continue;
    }
    std::set<Index> seen{around.front()};
    std::vector<Index> front{around.front()};
    while (!front.empty()) {
      const Index c = front.back();
      front.pop_back();
      for (int k = 0; k < C::nodes; ++k) {
        const Index a = m.cells(k, c), b = m.cells((k + 1) % C::nodes, c);
        if (a != v && b != v) continue;
        for (const auto& [other, forward] : edges[{std::min(a, b), std::max(a, b)}])
          if (seen.insert(other).second) front.push_back(other);
      }
    }
    if (seen.size() != around.size()) ++result.wrong_vertices;
  }
  result.euler = static_cast<long>(m.node_count()) - result.loose_vertices - static_cast<long>(edges.size()) +
                 m.cell_count();
  return result;
}

/// Volume by the divergence theorem; faces are cut into a fan from their first node.
template <class C>
double enclosed_volume(const mesh::Mesh<C, 3>& m) {
  double volume = 0;
  for (Index c = 0; c < m.cell_count(); ++c)
    for (int k = 2; k < C::nodes; ++k) {
      const Vec3 a = m.nodes.col(m.cells(0, c)), b = m.nodes.col(m.cells(k - 1, c)),
                 d = m.nodes.col(m.cells(k, c));
      volume += a.dot(b.cross(d)) / 6;
    }
  return volume;
}

inline std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// The bifurcation of three capsules in the unit cube, positive inside [length]: r - |distance|, blended.
inline double bifurcation(const Vec3& p) {
  const auto capsule = [&](const Vec3& a, const Vec3& b, double r) {
    const Vec3 ab = b - a;
    return (p - a - std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) * ab).norm() - r;
  };
  const auto blend = [](double a, double b, double k) {
    const double d = std::max(k - std::abs(a - b), 0.0);
    return std::min(a, b) - d * d / (4 * k);
  };
  const Vec3 A(.5, .5, .14), B(.5, .5, .5), C(.25, .45, .86), D(.76, .57, .84);
  return -blend(blend(capsule(A, B, .11), capsule(B, C, .08), .06), capsule(B, D, .07), .06);
}

/// n^3 samples of a function of the point over the unit cube.
template <class F>
image::Image<float> sampled(Index n, F&& f) {
  image::Image<float> im;
  for (auto& axis : im.axes)
    for (Index i = 0; i < n; ++i) axis.push_back(static_cast<double>(i) / (n - 1));
  for (Index k = 0; k < n; ++k)
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < n; ++i) im.values.push_back(static_cast<float>(f(im.position({i, j, k}))));
  return im;
}

/// Noise in [-1, 1), or the integers -2 ... 2 of which a fifth equal the iso-value 0. Outside on the border.
inline image::Image<float> noise(Index n, bool integers, std::uint64_t seed = 0) {
  auto im = sampled(n, [](const Vec3&) { return 0.0; });
  for (Index k = 0; k < n; ++k)
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < n; ++i) {
        const std::size_t at = im.offset({i, j, k});
        const std::uint64_t r = splitmix64(1 + at + seed);
        const bool border = i == 0 || j == 0 || k == 0 || i + 1 == n || j + 1 == n || k + 1 == n;
        const double x =
            integers ? static_cast<double>(r % 5) - 2 : static_cast<double>(r >> 11) * 0x1p-52 - 1;
        im.values[at] = static_cast<float>(border ? (integers ? -2 : -1) : x);
      }
  return im;
}

inline std::vector<std::uint8_t> at_least(const image::Image<float>& im, double iso) {
  std::vector<std::uint8_t> kept;
  for (const float v : im.values) kept.push_back(v >= iso ? 1 : 0);
  return kept;
}

}  // namespace tunica::test::contours
