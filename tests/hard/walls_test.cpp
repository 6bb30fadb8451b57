// SPDX-License-Identifier: MIT
// Walls of bifurcations: no inverted cell in the crotch, flat ends, interfaces near to each other.
#include "support/contours.hpp"
#include "support/shared.hpp"
#include "support/stubs.hpp"
#include "support/vessels.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/tetrahedra.hpp"
#include "tunica/meshing/vessel_wall.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

void check_wall(const mesh::Surface& lumen, const meshing::WallResult& result) {
  const auto& wall = result.wall;
  CHECK(result.report.extrusion.quality.inverted == 0);
  CHECK(result.report.extrusion.quality.scaled_jacobian.least > 0);
  const auto planes = meshing::flat_regions(lumen);
  const double size = mesh::bounding_box(lumen.nodes).diagonal();
  for (std::size_t r = 1; r < planes.size(); ++r) {
    REQUIRE(planes[r].has_value());
    for (const Index n : mesh::patch_nodes(wall.patch(lumen.region_names[r])))
      CHECK(std::abs(planes[r]->normal.dot(Vec3(wall.nodes.col(n)) - planes[r]->point)) < 1e-9 * size);
  }
}

void report(const std::string& name, double edge, const meshing::WallResult& r) {
  const auto& e = r.report.extrusion;
  const auto& d = r.report.distance;
  MESSAGE(name << ", edge " << edge << ": " << r.inner.cell_count() << " quadrilaterals, "
               << r.wall.cell_count() << " hexahedra; scaled Jacobian least "
               << e.quality.scaled_jacobian.least << " mean " << e.quality.scaled_jacobian.mean
               << "; thickness gave way at " << e.thinned << " nodes, to " << e.least_share << " at "
               << e.thinnest.transpose() << ", mean " << e.mean_share << "; interfaces apart at most "
               << d.quads_max / edge << " and " << d.wall_max / edge << " (at " << d.wall_place.transpose()
               << "), rms " << d.quads_rms / edge << " and " << d.wall_rms / edge << " edges, beyond a tenth "
               << 100 * d.quads_beyond << " % and " << 100 * d.wall_beyond << " %; grid drawn together "
               << r.report.refinements << " times at " << r.report.lenses << " places");
}

/// Largest distances, of the nodes of the lumen's wall from the bilinear faces, each as 24 x 24 smaller ones,
/// and of the corners of those from the lumen.
struct Apart {
  double wall = 0, faces = 0;
};
Apart farthest(const mesh::QuadSurface& quads, const mesh::Surface& lumen) {
  constexpr Index parts = 24;
  mesh::QuadSurface fine;
  fine.nodes.resize(3, quads.cell_count() * (parts + 1) * (parts + 1));
  fine.cells.resize(4, quads.cell_count() * parts * parts);
  Index node = 0, cell = 0;
  for (Index q = 0; q < quads.cell_count(); ++q) {
    const auto x = [&](int k) { return Vec3(quads.nodes.col(quads.cells(k, q))); };
    for (Index j = 0; j <= parts; ++j)
      for (Index i = 0; i <= parts; ++i) {
        const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
        if (i < parts && j < parts)
          fine.cells.col(cell++) << node, node + 1, node + parts + 2, node + parts + 1;
        fine.nodes.col(node++) = (1 - v) * ((1 - u) * x(0) + u * x(1)) + v * ((1 - u) * x(3) + u * x(2));
      }
  }
  const auto sheet = meshing::triangles_of(fine);
  const meshing::FootFinder back(sheet);
  const meshing::FootFinder there(lumen);
  Apart apart;
  for (const Vec3& x : meshing::wall_points(lumen)) apart.wall = std::max(apart.wall, back.distance(x));
  for (Index n = 0; n < fine.node_count(); ++n)
    apart.faces = std::max(apart.faces, there.distance(fine.nodes.col(n)));
  return apart;
}

/// Least distance of the outer faces (corners, middles of the sides and of the faces) from the inner ones.
double thinnest(const meshing::WallResult& result) {
  const auto sheet = meshing::triangles_of(result.inner);
  const meshing::FootFinder inner(sheet);
  const auto& faces = result.wall.patch("outer").faces;
  double least = 1e9;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    const auto x = [&](int k) { return Vec3(result.wall.nodes.col(faces(k % 4, f))); };
    least = std::min(least, inner.distance(0.25 * (x(0) + x(1) + x(2) + x(3))));
    for (int k = 0; k < 4; ++k)
      least = std::min({least, inner.distance(x(k)), inner.distance(0.5 * (x(k) + x(k + 1)))});
  }
  return least;
}

/// A weak spot would carry the stress of the whole wall.
void check_thickness(const meshing::WallResult& result, double thickness) {
  const double least = thinnest(result) / thickness;
  MESSAGE("least distance of the outer faces from the inner ones " << least << " of the thickness");
  CHECK(result.report.extrusion.least_share >= 0.5);
  CHECK(result.report.extrusion.mean_share >= 0.99);
  CHECK(least >= 0.5);
}

/// A sheet of that mean edge has A / edge^2 quadrilaterals, those that follow a blind branch among them.
void check_count(const mesh::Surface& lumen, const meshing::WallResult& result, double edge) {
  const double asked = mesh::area_of_region(lumen, 0) / (edge * edge);
  MESSAGE("quadrilaterals over those asked for " << result.inner.cell_count() / asked << ", of them grown "
                                                 << result.report.grown);
  CHECK(result.inner.cell_count() == doctest::Approx(asked).epsilon(0.06));
}

/// The smoothed surface of the real bifurcation between its three cuts.
mesh::Surface real_lumen(const image::Image<short>& image) {
  const auto region = image::segment(image, {.iso = 1299.5, .seed = image::Voxel{30, 73, 15}});
  auto contour = meshing::marching_cubes(image, region.mask.inside, 1299.5);
  (void)meshing::smooth(contour.surface, {.sweeps = 20});
  const std::array<meshing::Cut, 3> cuts{
      {{.point = {221.567, 165.000, 22.215}, .normal = {0.0011, 0.9996, -0.0283}, .name = "inlet"},
       {.point = {207.554, 94.976, 33.243}, .normal = {-0.2769, -0.9166, 0.2883}, .name = "outlet 1"},
       {.point = {237.629, 95.025, 31.872}, .normal = {0.2506, -0.8866, 0.3888}, .name = "outlet 2"}}};
  return meshing::cut(std::move(contour.surface), cuts).surface;
}

/// Shortest side of the quadrilaterals.
double shortest_side(const mesh::QuadSurface& quads) {
  double least = 1e9;
  for (Index q = 0; q < quads.cell_count(); ++q)
    for (int k = 0; k < 4; ++k)
      least = std::min(
          least, (quads.nodes.col(quads.cells(k, q)) - quads.nodes.col(quads.cells((k + 1) % 4, q))).norm());
  return least;
}

/// The two interfaces within a tenth of the edge, everywhere, and the report says so.
void check_near(const mesh::Surface& lumen, const meshing::WallResult& result, double edge) {
  // a side that has shrunk to nothing makes a cell that turns over when the wall bends
  const double shortest = shortest_side(result.inner) / edge;
  MESSAGE("shortest side of the inner faces " << shortest << " edges");
  CHECK(shortest >= 0.15);
  CHECK(result.report.shortest_side == doctest::Approx(shortest));
  CHECK(result.report.extrusion.quality.scaled_jacobian.least >= 0.2);
  CHECK(result.report.within);
  CHECK(result.report.distance.quads_max < 0.1 * edge);
  CHECK(result.report.distance.wall_max < 0.1 * edge);
  const Apart apart = farthest(result.inner, lumen);
  MESSAGE("between the places that settling looks at: faces " << apart.faces / edge << ", points of the wall "
                                                              << apart.wall / edge << " edges");
  CHECK(apart.wall < 0.1 * edge);
  CHECK(apart.faces < 0.1 * edge);
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: wall of the bifurcation has no inverted cell and follows the lumen") {
    const auto lumen = test::vessels::bifurcation(0.9);
    for (const double edge : {3.0, 2.0, 1.5, 1.0}) {
      const auto result = meshing::vessel_wall(lumen, {.thickness = 1.5, .edge = edge, .layers = 2});
      report("phantom", edge, result);
      check_wall(lumen, result);
      check_thickness(result, 1.5);
      check_count(lumen, result, edge);
      check_near(lumen, result, edge);
    }
  }

  TEST_CASE("meshing: wall of the real bifurcation has no inverted cell") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto image = io::read_vtk_image<short>(*path).image;
    const auto lumen = real_lumen(image);
    const auto even = meshing::remesh(lumen, {.edge = 2}).surface;
    for (const double edge : {2.0, 1.5}) {
      const auto result = meshing::vessel_wall(even, {.thickness = 1.5, .edge = edge, .layers = 2});
      report("real, remeshed to 2 mm", edge, result);
      check_wall(even, result);
      check_thickness(result, 1.5);
      check_count(even, result, edge);
      check_near(even, result, edge);
    }
    const auto rough = meshing::vessel_wall(lumen, {.thickness = 1.5, .edge = 2});
    report("real, triangles as cut", 2, rough);
    check_wall(lumen, rough);
    check_thickness(rough, 1.5);
    check_near(lumen, rough, 2);
  }

  TEST_CASE("meshing: voxels of the real bifurcation become both meshes of the size of the paper") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto image = io::read_vtk_image<short>(*path).image;
    const auto cpu_seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    const double start = cpu_seconds();
    const auto lumen = meshing::remesh(real_lumen(image), {.edge = 1.03}).surface;
    const auto tets = meshing::tetrahedra(lumen);
    const double filled = cpu_seconds() - start, edge = 1.55 * 1.03;
    const auto wall = meshing::vessel_wall(lumen, {.thickness = 1.5, .edge = edge, .layers = 2});
    MESSAGE(tets.report.tetrahedra, " tetrahedra after ", filled, " s and ", wall.wall.cell_count(),
            " hexahedra after ", cpu_seconds() - start, " s of CPU time, with all checks on");
    report("real, remeshed to 1.03 mm", edge, wall);
    CHECK(tets.report.tetrahedra == doctest::Approx(74000).epsilon(0.05));  // [PEREZ08, fig. 12]
    CHECK(wall.wall.cell_count() == doctest::Approx(3000).epsilon(0.06));
    CHECK(tets.report.min_dihedral >= 18);
    check_wall(lumen, wall);
    check_thickness(wall, 1.5);
    check_near(lumen, wall, edge);
  }

  TEST_CASE("meshing: walls of blind branches follow them or say where they do not") {
    constexpr double edge = 2, tolerance = 0.1 * edge;
    Index grown = 0;
    const auto wall_of = [&](const test::stubs::Branch& branch, bool follows) {
      const auto lumen = test::stubs::tube(branch, std::min(0.6, branch.radius));
      const auto result = meshing::vessel_wall(lumen, {.thickness = 1.0, .edge = edge});
      const auto apart = farthest(result.inner, lumen);
      const auto& d = result.report.distance;
      const auto& e = result.report.extrusion;
      MESSAGE("branch of radius " << branch.radius << " and length " << branch.length << " leaning by "
                                  << branch.lean << ": " << result.inner.cell_count() << " quadrilaterals, "
                                  << result.report.grown << " grown, grid drawn together at "
                                  << result.report.lenses << " places, interfaces apart at most "
                                  << d.quads_max / edge << " and " << d.wall_max / edge << " (between, "
                                  << apart.faces / edge << " and " << apart.wall / edge
                                  << ") edges, scaled Jacobian least " << e.quality.scaled_jacobian.least
                                  << ", thickness " << e.least_share << " and " << e.least_between);
      check_wall(lumen, result);
      const auto topology = test::contours::topology(result.inner);
      CHECK(topology.euler == 0);
      CHECK(topology.wrong_edges + topology.wrong_vertices + topology.loose_vertices == 0);
      CHECK(result.report.within == (d.quads_max <= tolerance && d.wall_max <= tolerance));
      CHECK(apart.wall == doctest::Approx(d.wall_max).epsilon(0.05));
      grown += result.report.grown;
      if (!follows) return;
      // whether the grid meets the branch or it is grown
      CHECK(result.report.within);
      CHECK(d.quads_max <= tolerance);
      CHECK(apart.wall <= tolerance);
      CHECK(apart.faces <= tolerance);
      CHECK(e.quality.scaled_jacobian.least >= 0.2);
      CHECK(std::min(e.least_share, e.least_between) >= 0.5);
    };
    for (const double radius : {0.4, 0.7, 1.0, 1.5})
      for (const double length : {1.5, 3.0}) wall_of({.radius = radius, .length = length}, true);
    // no grid of that edge meets the thinnest
    CHECK(grown > 0);
    wall_of({.radius = 1.5, .length = 3.0, .lean = 0.6}, true);
    // The acute valley below a leaning branch leaves less room than a wall of that edge needs where the
    // branch is thin: within the tolerance or not, the report must be right.
    wall_of({.radius = 0.7, .length = 1.5, .lean = 0.6}, false);
  }

  TEST_CASE(
      "meshing: a thin spot or a flat or pinched cell outweighs a few far places in the choice of a sheet") {
    meshing::WallReport sound;
    sound.extrusion.quality.scaled_jacobian.least = 0.3;
    sound.shortest_side = 0.3;
    auto thin = sound, flat = sound, inverted = sound, pinched = sound;
    pinched.shortest_side = 0.01;
    thin.extrusion.least_between = 0.35;
    flat.extrusion.quality.scaled_jacobian.least = 0.1;
    inverted.extrusion.quality.inverted = 1;
    const std::vector<meshing::FarPlace> far(20, {Vec3::Zero(), 0.3});
    const auto badness = [&](const meshing::WallReport& r, bool away) {
      return meshing::detail::wall_badness(r, away ? far : std::vector<meshing::FarPlace>{}, 0.1);
    };
    CHECK(badness(sound, false) == 0);
    CHECK(badness(sound, true) < badness(thin, false));
    CHECK(badness(sound, true) < badness(pinched, false));
    CHECK(badness(thin, false) < badness(flat, false));
    CHECK(badness(flat, true) < badness(inverted, false));
  }

  TEST_CASE("meshing: wall of the bifurcation has the same bits twice") {
    const auto lumen = test::vessels::bifurcation(1.5);
    const meshing::WallOptions<> options{.thickness = 1.5, .edge = 2};
    CHECK(meshing::vessel_wall(lumen, options).wall.nodes == meshing::vessel_wall(lumen, options).wall.nodes);
  }

  TEST_CASE("meshing: a wall too coarse for its vessel is refused") {
    CHECK_THROWS_AS(
        (void)meshing::vessel_wall(test::vessels::cylinder(1, 20, 24), {.thickness = 1, .edge = 10}),
        MeshError);
  }
}
