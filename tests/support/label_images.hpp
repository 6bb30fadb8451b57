// SPDX-License-Identifier: MIT
// Label images for tests, and what a mesh of several materials has to fulfil, counted anew.
#pragma once

#include "tunica/image/sampling.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/multi_region.hpp"

#include <Eigen/Geometry>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace tunica::test {

template <class Label>
[[nodiscard]] image::Image<int> label_image(const std::array<Index, 3>& size, const Vec3& h, Label&& label) {
  image::Image<int> g;
  for (std::size_t a = 0; a < 3; ++a)
    for (Index i = 0; i < size[a]; ++i) g.axes[a].push_back(i * h[static_cast<Eigen::Index>(a)]);
  for (Index k = 0; k < size[2]; ++k)
    for (Index j = 0; j < size[1]; ++j)
      for (Index i = 0; i < size[0]; ++i) g.values.push_back(label(g.position({i, j, k})));
  return g;
}

/// Labels 0 .. labels - 1 by chance.
[[nodiscard]] inline image::Image<int> label_noise(const std::array<Index, 3>& size, int labels,
                                                   std::uint64_t seed) {
  std::uint64_t count = 0;
  return label_image(size, {1, 1, 1}, [&](const Vec3&) {
    return static_cast<int>(image::splitmix64(seed * 1000003u + count++) %
                            static_cast<std::uint64_t>(labels));
  });
}

/// Every labelled region is bounded by closed, oriented manifolds.
inline void check_manifold(const meshing::Interfaces& s, const image::LabelRegions& regions) {
  const auto surfaces = meshing::detail::region_surfaces(s, regions.regions.size());
  for (std::size_t r = 0; r < surfaces.size(); ++r)
    if (regions.regions[r].label != 0) CHECK(mesh::topology(surfaces[r].surface).closed());
}

/// All tetrahedra positive, every face in one or two of them; those in two of different materials are the
/// faces of the patches between these, those in one the faces of the other patches; volumes add up.
inline void check_conforming(const meshing::MultiRegionResult& result) {
  const mesh::TetMesh& m = result.mesh;
  REQUIRE(m.region.size() == static_cast<std::size_t>(m.cell_count()));
  REQUIRE(result.material.size() == m.region.size());
  const auto sorted = [](std::array<Index, 3> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  struct Face {
    std::vector<Index> cells;
    std::array<Index, 3> turned{};  // as the first cell has it, outward
  };
  std::map<std::array<Index, 3>, Face> faces;
  std::vector<char> used(static_cast<std::size_t>(m.node_count()), 0);
  std::vector<long double> volume(m.region_names.size(), 0);
  int inverted = 0;
  for (Index t = 0; t < m.cell_count(); ++t) {
    const auto n = m.cells.col(t);
    const Vec3 a = m.nodes.col(n[0]), b = m.nodes.col(n[1]), c = m.nodes.col(n[2]), d = m.nodes.col(n[3]);
    inverted += !(meshing::orient3d(a, b, c, d) > 0);
    volume[static_cast<std::size_t>(m.region[static_cast<std::size_t>(t)])] +=
        (b - a).cross(c - a).dot(d - a) / 6;
    for (const Index node : n) used[static_cast<std::size_t>(node)] = 1;
    for (const auto& f : mesh::Tet4::faces) {
      const std::array<Index, 3> face{n[f[0]], n[f[1]], n[f[2]]};
      Face& entry = faces[sorted(face)];
      if (entry.cells.empty()) entry.turned = face;
      entry.cells.push_back(t);
    }
  }
  CHECK(inverted == 0);
  CHECK(std::count(used.begin(), used.end(), char{0}) == 0);
  const auto material = [&](Index t) { return m.region[static_cast<std::size_t>(t)]; };
  std::size_t between = 0, border = 0, thrice = 0;
  for (const auto& [key, f] : faces) {
    thrice += f.cells.size() > 2;
    border += f.cells.size() == 1;
    between += f.cells.size() == 2 && material(f.cells[0]) != material(f.cells[1]);
  }
  CHECK(thrice == 0);
  std::size_t patch_between = 0, patch_border = 0, astray = 0;
  std::set<std::array<Index, 3>> seen;
  for (const auto& p : m.patches) {
    const auto bar = p.name.find('|');
    const std::string first = p.name.substr(0, bar), second = p.name.substr(bar + 1);
    const bool inner = std::count(m.region_names.begin(), m.region_names.end(), second) > 0;
    for (Eigen::Index k = 0; k < p.faces.cols(); ++k) {
      const std::array<Index, 3> face{p.faces(0, k), p.faces(1, k), p.faces(2, k)};
      const auto it = faces.find(sorted(face));
      if (it == faces.end() || !seen.insert(it->first).second) {
        ++astray;
        continue;
      }
      (inner ? patch_between : patch_border) += 1;
      const Face& f = it->second;
      if (f.cells.size() != (inner ? 2U : 1U)) {
        ++astray;
        continue;
      }
      auto turned = f.turned;  // outward of its first cell
      std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), face[0]), turned.end());
      const bool outward = turned == face;
      const Index own = f.cells[outward ? 0 : f.cells.size() - 1];
      astray += !outward && !inner;
      astray += m.region_names[static_cast<std::size_t>(material(own))] != first;
      if (inner)
        astray += m.region_names[static_cast<std::size_t>(material(f.cells[outward ? 1 : 0]))] != second;
    }
  }
  CHECK(astray == 0);
  CHECK(patch_between == between);
  CHECK(patch_border == border);
  for (std::size_t i = 0; i < volume.size(); ++i) {
    const auto& one = result.report.materials[i];
    CHECK(std::abs(static_cast<double>(volume[i]) - one.volume) <= 1e-12 * one.volume);
  }
  CHECK(result.report.volume_error <= 1e-12);
}

}  // namespace tunica::test
