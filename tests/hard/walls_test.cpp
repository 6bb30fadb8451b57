// SPDX-License-Identifier: MIT
// Walls of bifurcations: no inverted cell in the crotch, flat ends, interfaces near to each other.
#include "support/contours.hpp"
#include "support/vessels.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/vessel_wall.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace tunica;

namespace {

void check_wall(const mesh::Surface& lumen, const meshing::WallResult& result) {
  const auto& wall = result.wall;
  CHECK(result.report.extrusion.quality.inverted == 0);
  CHECK(result.report.extrusion.quality.scaled_jacobian.least > 0);
  const auto planes = meshing::cap_planes(lumen);
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
               << e.thinnest.transpose() << "; interfaces apart at most " << d.quads_max / edge << " and "
               << d.wall_max / edge << ", rms " << d.quads_rms / edge << " and " << d.wall_rms / edge
               << " edges");
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: wall of the bifurcation has no inverted cell") {
    const auto lumen = test::vessels::bifurcation(0.9);
    for (const double edge : {3.0, 2.0, 1.5, 1.0}) {
      const auto result = meshing::vessel_wall(lumen, {.thickness = 1.5, .edge = edge, .layers = 2});
      report("phantom", edge, result);
      check_wall(lumen, result);
      CHECK(result.report.extrusion.quality.scaled_jacobian.least >= (edge < 2.5 ? 0.2 : 0.1));
    }
  }

  TEST_CASE("meshing: wall of the bifurcation has the same bits twice") {
    const auto lumen = test::vessels::bifurcation(1.5);
    const meshing::WallOptions options{.thickness = 1.5, .edge = 2};
    CHECK(meshing::vessel_wall(lumen, options).wall.nodes == meshing::vessel_wall(lumen, options).wall.nodes);
  }

  TEST_CASE("meshing: a wall too coarse for its vessel is refused") {
    CHECK_THROWS_AS(
        (void)meshing::vessel_wall(test::vessels::cylinder(1, 20, 24), {.thickness = 1, .edge = 10}),
        MeshError);
  }
}
