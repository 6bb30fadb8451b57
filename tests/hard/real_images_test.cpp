// SPDX-License-Identifier: MIT
// Real images at several iso-values, from voxels to tetrahedra: valid meshes, and how far their surfaces lie
// from the isosurface of the trilinear field.
#include "support/shared.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/cavities.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

/// Distances of points from the isosurface: the nearest change of side along the gradient, looked for in
/// steps of a hundredth of a voxel up to a voxel; a point from which none is found there has a whole voxel.
struct Distances {
  double rms = 0, most = 0;  // [voxels]
  double on = 0;             // share of the points that lie on it, within a thousandth of a voxel

  Distances(const image::Image<float>& image, double iso, double voxel, const std::vector<Vec3>& points) {
    double count = 0, sum = 0;
    for (const Vec3& x : points) {
      const Vec3 g = image.gradient(x);
      const double f = image.value(x) - iso;
      const Vec3 way = vec::length(g) > 0 ? vec::scaled((f > 0 ? -1 : 1) / vec::length(g), g) : Vec3(0, 0, 0);
      constexpr int steps = 100;
      int k = 0;
      double last = f, now = f;
      while (f != 0 && k < steps && last * now > 0) {
        last = now;
        now = image.value(vec::along(x, ++k * voxel / steps, way)) - iso;
      }
      const bool met = f == 0 || last * now <= 0;
      const double d = f == 0 ? 0 : met ? (k - 1 + last / (last - now)) / steps : 1;
      on += d < 1e-3, count += 1, sum += d * d, most = std::max(most, d);
    }
    rms = std::sqrt(sum / count), on /= count;
  }
};

std::vector<Vec3> nodes_of_wall(const mesh::Surface& s) {
  std::vector<char> wall(static_cast<std::size_t>(s.node_count()), 1);
  for (Index t = 0; t < s.cell_count(); ++t)
    if (s.region_of(t) != 0)
      for (int k = 0; k < 3; ++k) wall[static_cast<std::size_t>(s.cells(k, t))] = 0;
  std::vector<Vec3> nodes;
  for (Index n = 0; n < s.node_count(); ++n)
    if (wall[static_cast<std::size_t>(n)] != 0) nodes.push_back(s.nodes.col(n));
  return nodes;
}

std::vector<Vec3> middles_of_wall(const mesh::Surface& s) {
  std::vector<Vec3> middles;
  for (Index t = 0; t < s.cell_count(); ++t)
    if (s.region_of(t) == 0) middles.push_back(mesh::triangle(s, t).centroid());
  return middles;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: real images are meshed at several iso-values near to their isosurfaces") {
    const std::vector<std::pair<std::string, std::vector<double>>> cases{
        {"aorta_bifurcation", {1150, 1250, 1299.5, 1400, 1550}}, {"aorta_tree", {1250, 1400}}};
    for (const auto& [name, isos] : cases) {
      const auto path = test::shared("data/" + name + ".vtk");
      if (!path) return;
      const auto image = io::read_vtk_image<float>(*path).image;
      double voxel = 0;
      for (const auto& axis : image.axes) voxel = std::max(voxel, axis[1] - axis[0]);
      const double edge = 1.5 * voxel;
      for (const double iso : isos) {
        CAPTURE(name);
        CAPTURE(iso);
        const auto region = image::segment(image, {.iso = iso});
        auto s = meshing::marching_cubes(image, region.mask.inside, iso).surface;
        const Distances contour(image, iso, voxel, nodes_of_wall(s)),
            faces(image, iso, voxel, middles_of_wall(s));
        CHECK(contour.on > 0.98);  // all but those where the mask alone parts two voxels
        CHECK(faces.rms < 0.1);
        s = meshing::fill_cavities(std::move(s), mesh::topology(s), edge * edge * edge).surface;
        (void)meshing::smooth(s, {.sweeps = 20});
        const Distances smooth(image, iso, voxel, nodes_of_wall(s));
        const auto before = mesh::topology(s);
        s = meshing::remesh(s, {.edge = edge}).surface;
        const Distances even(image, iso, voxel, middles_of_wall(s));
        const auto after = mesh::topology(s);
        CHECK(after.closed());
        CHECK(after.genus() == before.genus());
        const auto fill = meshing::tetrahedra(s);
        MESSAGE(name, " at ", iso, ": genus ", after.genus(), ", ", after.triangles, " triangles, ",
                fill.report.tetrahedra, " tetrahedra, smallest dihedral angle ", fill.report.min_dihedral,
                " (surface ", fill.report.surface_min_angle,
                "); from the trilinear isosurface in voxels: contour ", contour.rms, " rms (on it ",
                100 * contour.on, " %), its faces ", faces.rms, ", smoothed ", smooth.rms, ", remeshed ",
                even.rms, " rms and ", even.most, " at most");
        CHECK(fill.report.volume_error < 1e-12);
        CHECK(fill.report.min_dihedral > 0);
        CHECK(smooth.rms < 0.25);
        CHECK(even.rms < 0.25);
      }
    }
  }
}
