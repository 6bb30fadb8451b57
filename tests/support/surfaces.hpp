// SPDX-License-Identifier: MIT
// Closed surfaces for tests: spheres, cubes, tori, tubes, slabs, noise, and the twisted prism.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tunica::test {

struct SurfaceBuilder {
  std::vector<Vec3> nodes;
  std::vector<std::array<Index, 3>> triangles;

  Index node(const Vec3& x) {
    nodes.push_back(x);
    return static_cast<Index>(nodes.size() - 1);
  }
  [[nodiscard]] mesh::Surface surface(const std::string& name = "wall") const {
    mesh::Surface s;
    s.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
    s.cells.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t n = 0; n < nodes.size(); ++n) s.nodes.col(static_cast<Eigen::Index>(n)) = nodes[n];
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        s.cells(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) = triangles[t][i];
    s.region_names = {name};
    return s;
  }
};

/// Every triangle into four, `times` over; project moves the new nodes.
template <class Project>
void subdivide(SurfaceBuilder& b, int times, Project&& project) {
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index i, Index j) {
      const std::pair<Index, Index> key{std::min(i, j), std::max(i, j)};
      const auto it = middle.find(key);
      if (it != middle.end()) return it->second;
      const Vec3 m = 0.5 * (b.nodes[static_cast<std::size_t>(i)] + b.nodes[static_cast<std::size_t>(j)]);
      return middle[key] = b.node(project(m));
    };
    std::vector<std::array<Index, 3>> next;
    for (const auto& [i, j, l] : b.triangles) {
      const Index u = between(i, j), v = between(j, l), w = between(l, i);
      next.push_back({i, u, w}), next.push_back({u, j, v}), next.push_back({w, v, l}),
          next.push_back({u, v, w});
    }
    b.triangles = next;
  }
}

/// 20 * 4^times triangles on a sphere.
[[nodiscard]] inline mesh::Surface icosphere(int times, double radius = 1,
                                             const Vec3& centre = Vec3::Zero()) {
  SurfaceBuilder b;
  const double g = std::numbers::phi;
  for (const auto& [x, y, z] : std::vector<std::array<double, 3>>{{-1, g, 0},
                                                                  {1, g, 0},
                                                                  {-1, -g, 0},
                                                                  {1, -g, 0},
                                                                  {0, -1, g},
                                                                  {0, 1, g},
                                                                  {0, -1, -g},
                                                                  {0, 1, -g},
                                                                  {g, 0, -1},
                                                                  {g, 0, 1},
                                                                  {-g, 0, -1},
                                                                  {-g, 0, 1}})
    b.node(Vec3(x, y, z).normalized());
  b.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  subdivide(b, times, [](const Vec3& x) { return x.normalized(); });
  for (Vec3& x : b.nodes) x = centre + radius * x;
  return b.surface();
}

/// A box of edges `size` with 12 * 4^times triangles; its six sides are regions of their own.
[[nodiscard]] inline mesh::Surface box_surface(int times, const Vec3& size = Vec3::Ones()) {
  SurfaceBuilder b;
  for (int i = 0; i < 8; ++i) b.node(Vec3(i & 1, i >> 1 & 1, i >> 2 & 1).cwiseProduct(size));
  b.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  subdivide(b, times, [](const Vec3& x) { return x; });
  mesh::Surface s = b.surface();
  s.region_names = {"x0", "x1", "y0", "y1", "z0", "z1"};
  const auto side = static_cast<Index>(b.triangles.size() / 6);
  for (Index t = 0; t < s.cell_count(); ++t) s.region.push_back(t / side);
  return s;
}

/// around * along quadrilaterals, each cut in two; at(u, v) with u, v in [0, 1) periodic.
template <class Place>
[[nodiscard]] mesh::Surface periodic_grid(int around, int along, Place&& place) {
  SurfaceBuilder b;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i)
      b.node(place(static_cast<double>(i) / around, static_cast<double>(j) / along));
  const auto at = [&](int i, int j) { return static_cast<Index>((j % along) * around + i % around); };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      b.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      b.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return b.surface();
}

[[nodiscard]] inline mesh::Surface torus(int around, int along, double minor = 0.3, double major = 1) {
  return periodic_grid(around, along, [=](double u, double v) {
    const double a = 2 * std::numbers::pi * u, t = 2 * std::numbers::pi * v;
    const double r = major + minor * std::cos(a);
    return Vec3(r * std::cos(t), r * std::sin(t), -minor * std::sin(a));
  });
}

/// A tube along z; its ends are fans of rings. Regions: wall, inlet, outlet.
[[nodiscard]] inline mesh::Surface tube_surface(int around, int along, int rings, double radius = 1,
                                                double length = 4) {
  SurfaceBuilder b;
  const auto ring = [&](double r, double z) {
    const auto first = static_cast<Index>(b.nodes.size());
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      b.node({r * std::cos(a), r * std::sin(a), z});
    }
    return first;
  };
  std::vector<Index> region;
  const auto band = [&](Index lower, Index upper, Index label) {
    for (int i = 0; i < around; ++i) {
      const auto k = static_cast<Index>(i), n = static_cast<Index>((i + 1) % around);
      b.triangles.push_back({lower + k, lower + n, upper + n});
      b.triangles.push_back({lower + k, upper + n, upper + k});
      region.insert(region.end(), 2, label);
    }
  };
  std::vector<Index> wall;
  for (int j = 0; j <= along; ++j) wall.push_back(ring(radius, length * j / along));
  for (int j = 0; j < along; ++j)
    band(wall[static_cast<std::size_t>(j)], wall[static_cast<std::size_t>(j) + 1], 0);
  for (const bool top : {false, true}) {
    Index outer = top ? wall.back() : wall.front();
    const double z = top ? length : 0;
    for (int k = rings - 1; k >= 1; --k) {
      const Index inner = ring(radius * k / rings, z);
      top ? band(outer, inner, 2) : band(inner, outer, 1);
      outer = inner;
    }
    const Index middle = b.node({0, 0, z});
    for (int i = 0; i < around; ++i) {
      const auto k = static_cast<Index>(i), n = static_cast<Index>((i + 1) % around);
      if (top)
        b.triangles.push_back({outer + k, outer + n, middle});
      else
        b.triangles.push_back({outer + n, outer + k, middle});
      region.push_back(top ? 2 : 1);
    }
  }
  mesh::Surface s = b.surface();
  s.region = region;
  s.region_names = {"wall", "inlet", "outlet"};
  return s;
}

/// The twisted prism of Schoenhardt: no tetrahedron of its own nodes fits inside.
[[nodiscard]] inline mesh::Surface schoenhardt_prism(double twist = std::numbers::pi / 6) {
  SurfaceBuilder b;
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i < 3; ++i) {
      const double a = 2 * std::numbers::pi * i / 3 - level * twist;
      b.node({std::cos(a), std::sin(a), static_cast<double>(level)});
    }
  b.triangles = {{0, 2, 1}, {3, 4, 5}};
  for (int i = 0; i < 3; ++i) {  // the diagonals that fold inward
    const auto k = static_cast<Index>(i), n = static_cast<Index>((i + 1) % 3);
    b.triangles.push_back({k, n, 3 + k});
    b.triangles.push_back({n, 3 + n, 3 + k});
  }
  return b.surface();
}

/// The parts of both, the regions of b after those of a when they have other names.
[[nodiscard]] inline mesh::Surface joined(const mesh::Surface& a, const mesh::Surface& b) {
  mesh::Surface s = a;
  s.nodes.resize(3, a.nodes.cols() + b.nodes.cols());
  s.nodes << a.nodes, b.nodes;
  s.cells.resize(3, a.cells.cols() + b.cells.cols());
  s.cells << a.cells, (b.cells.array() + a.node_count()).matrix();
  s.region.clear();
  for (Index t = 0; t < a.cell_count(); ++t) s.region.push_back(a.region_of(t));
  const bool same = a.region_names == b.region_names;
  for (Index t = 0; t < b.cell_count(); ++t)
    s.region.push_back(b.region_of(t) + (same ? 0 : static_cast<Index>(a.region_names.size())));
  if (!same) s.region_names.insert(s.region_names.end(), b.region_names.begin(), b.region_names.end());
  return s;
}

/// The same surface seen from the other side.
[[nodiscard]] inline mesh::Surface reversed(mesh::Surface s) {
  s.cells.row(0).swap(s.cells.row(1));
  return s;
}

/// A number in [-1, 1) that depends on i alone.
[[nodiscard]] inline double node_noise(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15u;
  i = (i ^ i >> 30) * 0xbf58476d1ce4e5b9u;
  i = (i ^ i >> 27) * 0x94d049bb133111ebu;
  i ^= i >> 31;
  return std::ldexp(static_cast<double>(i >> 11), -52) - 1;
}

/// A sphere whose nodes have radii 1 +- amplitude at random: star-shaped, so it never crosses itself.
[[nodiscard]] inline mesh::Surface noisy_sphere(int times, double amplitude, std::uint64_t seed) {
  mesh::Surface s = icosphere(times);
  for (Index n = 0; n < s.node_count(); ++n)
    s.nodes.col(n) *= 1 + amplitude * node_noise(seed * 1000003 + static_cast<std::uint64_t>(n));
  return s;
}

}  // namespace tunica::test
