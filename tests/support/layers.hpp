// SPDX-License-Identifier: MIT
// What every mesh with boundary layers must be, tested by other means than the library's own, and vessels
// that images of a field give.
#pragma once

#include "tunica/image/image.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/boundary_layers.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tunica::test::layers {

using Face = std::array<Index, 3>;

/// As it turns, from its smallest node on.
inline Face turned(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

inline std::vector<Face> triangles_of(const Connectivity<3>& cells) {
  std::vector<Face> all;
  for (Eigen::Index t = 0; t < cells.cols(); ++t)
    all.push_back(turned({cells(0, t), cells(1, t), cells(2, t)}));
  std::sort(all.begin(), all.end());
  return all;
}

/// Faces whose reverse no other tetrahedron has, sorted; twice is a face that two cells have alike.
inline std::vector<Face> border(const mesh::TetMesh& m, int& twice) {
  std::vector<Face> all, open;
  for (Index t = 0; t < m.cell_count(); ++t)
    for (const auto& f : mesh::Tet4::faces)
      all.push_back(turned({m.cells(f[0], t), m.cells(f[1], t), m.cells(f[2], t)}));
  std::sort(all.begin(), all.end());
  twice = static_cast<int>(all.end() - std::unique(all.begin(), all.end()));
  for (const Face& f : all)
    if (!std::binary_search(all.begin(), all.end(), turned({f[0], f[2], f[1]}))) open.push_back(f);
  return open;
}

/// Everything that layered_tetrahedra promises.
inline void check(const std::string& name, const mesh::Surface& s, const meshing::LayeredFill& fill) {
  INFO(name);
  const mesh::TetMesh& m = fill.mesh;
  int inverted = 0, twice = 0;
  long double sum = 0;
  for (Index t = 0; t < m.cell_count(); ++t) {
    const auto x = [&](Index i) { return Vec3(m.nodes.col(m.cells(i, t))); };
    inverted += !(meshing::orient3d(x(0), x(1), x(2), x(3)) > 0);
    const Eigen::Matrix<long double, 3, 1> o = x(0).cast<long double>();
    sum +=
        (x(1).cast<long double>() - o).cross(x(2).cast<long double>() - o).dot(x(3).cast<long double>() - o);
  }
  CHECK(inverted == 0);
  CHECK(border(m, twice) == triangles_of(fill.outer.cells));
  CHECK(twice == 0);
  CHECK(std::abs(static_cast<double>(sum) / 6 / mesh::enclosed_volume(fill.outer) - 1) < 1e-12);
  CHECK(fill.report.volume_error < 1e-12);
  CHECK(meshing::self_intersections(fill.outer, 1).empty());
  CHECK(meshing::self_intersections(fill.inner, 1).empty());
  CHECK(fill.report.layer.tetrahedra + fill.report.core.tetrahedra == m.cell_count());
  CHECK(fill.outer.nodes == m.nodes.leftCols(fill.outer.node_count()));

  // Curved regions as they were, flat ones the same area in the same plane.
  const auto planes = meshing::flat_regions(s);
  const std::size_t regions = std::max<std::size_t>(1, s.region_names.size());
  REQUIRE(m.patches.size() == regions);
  const double size = mesh::bounding_box(s.nodes).diagonal();
  for (std::size_t r = 0; r < regions; ++r) {
    CHECK(m.patches[r].name == (s.region_names.empty() ? "wall" : s.region_names[r]));
    std::vector<Face> given;
    double area = 0, now = 0, off = 0;
    for (Index t = 0; t < s.cell_count(); ++t)
      if (static_cast<std::size_t>(s.region_of(t)) == r) {
        given.push_back(turned({s.cells(0, t), s.cells(1, t), s.cells(2, t)}));
        area += mesh::triangle(s, t).area();
      }
    const auto& faces = m.patches[r].faces;
    for (Eigen::Index f = 0; f < faces.cols(); ++f) {
      const Vec3 a = m.nodes.col(faces(0, f)), b = m.nodes.col(faces(1, f)), c = m.nodes.col(faces(2, f));
      now += 0.5 * (b - a).cross(c - a).norm();
      if (planes[r])
        for (int k = 0; k < 3; ++k)
          off = std::max(off, std::abs(planes[r]->distance(Vec3(m.nodes.col(faces(k, f))))));
    }
    CHECK(now == doctest::Approx(area).epsilon(1e-9));
    CHECK(off <= meshing::flat_tolerance * size);
    if (planes[r]) continue;
    std::sort(given.begin(), given.end());
    CHECK(triangles_of(faces) == given);
    for (const Face& f : given)
      for (const Index n : f) CHECK(m.nodes.col(n) == s.nodes.col(n));
  }
}

/// One line of a table.
inline void tell(const std::string& name, const mesh::Surface& s, const meshing::LayeredFill& fill) {
  const auto& r = fill.report;
  MESSAGE(name << ": " << s.cell_count() << " triangles, " << r.layer.tetrahedra << " + " << r.core.tetrahedra
               << " tetrahedra, full height " << r.full_share << ", mean " << r.mean_share << ", least "
               << r.least_share << ", vanished " << r.vanished << ", dihedral of layers "
               << r.layer.min_dihedral << ", of core " << r.core.min_dihedral << ", mean ratio "
               << r.layer.mean_ratio << ", " << r.core.mean_ratio << ", aspect " << r.layer.mean_aspect
               << " (most " << r.layer.most_aspect << ")");
}

/// The vessel where level(x) > 0, sampled at spacing h, cut at the ports (.point, .normal outward, .name),
/// with edges of about `edge`.
template <class Level>
mesh::Surface vessel(const Level& level, const std::vector<meshing::Cut>& ports, const Box& box, double h,
                     double edge) {
  image::Image<float> im;
  for (int a = 0; a < 3; ++a)
    for (double x = box.lo[a]; x < box.hi[a] + h; x += h) im.axes[static_cast<std::size_t>(a)].push_back(x);
  std::vector<std::uint8_t> inside;
  for (const double z : im.axes[2])
    for (const double y : im.axes[1])
      for (const double x : im.axes[0]) {
        im.values.push_back(static_cast<float>(level(Vec3(x, y, z))));
        inside.push_back(im.values.back() >= 0 ? 1 : 0);
      }
  mesh::Surface s = meshing::marching_cubes(im, inside, 0.0).surface;
  (void)meshing::smooth(s);
  if (!ports.empty()) s = meshing::cut(std::move(s), ports).surface;
  return meshing::remesh(s, {.edge = edge}).surface;
}

}  // namespace tunica::test::layers
