// SPDX-License-Identifier: MIT
// What image_to_mesh fills a vessel with: hexahedra, voxels, layers, sizes that follow the vessel.
#include "programs/run_program.hpp"
#include "support/shared.hpp"
#include "support/work_cases.hpp"
#include "tunica/io/vtk_image_write.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace tunica::test;

namespace {

struct Run {
  Outcome outcome;
  std::string report;
  [[nodiscard]] double operator()(const std::vector<std::string>& keys) const { return figure(report, keys); }
};

Run mesh(const Folder& folder, const std::string& image_and_options) {
  Run r;
  r.outcome = run(folder, program("image_to_mesh") + " " + image_and_options + " -o a.vtu --report r.json");
  r.report = text_of(folder.path() / "r.json");
  return r;
}

/// The real bifurcation between its cuts; empty where it is not there.
std::string real() {
  const auto image = shared("data/aorta_bifurcation.vtk");
  if (!image) return "";
  return "\"" + image->string() +
         "\" --iso 1299.5 --seed 30,73,15 --cut 221.567,165.000,22.215,0.0011,0.9996,-0.0283"
         " --cut 207.554,94.976,33.243,-0.2769,-0.9166,0.2883"
         " --cut 237.629,95.025,31.872,0.2506,-0.8866,0.3888";
}

constexpr double true_volume = 10154;  // mm3, of the contour at 1299.5 between the three planes

}  // namespace

TEST_SUITE("job") {
  TEST_CASE("image_to_mesh: hexahedra fill the phantom and the real bifurcation") {
    const auto checker = shared("tools/check_mesh.py");
    const std::string vessel = real();
    if (!checker || vessel.empty() || program("image_to_mesh").empty()) return;
    for (const std::string& image : {std::string("phantom"), vessel}) {
      CAPTURE(image);
      const Folder folder;
      const Run r = mesh(folder, image + " --fill hexes --edge 1.5");
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      MESSAGE(r({"fill", "hexahedra"}), " hexahedra, scaled Jacobian at least ",
              r({"fill", "smallest_scaled_jacobian"}), ", mean ", r({"fill", "mean_scaled_jacobian"}),
              ", volume ", r({"fill", "volume"}), " of ", r({"cut_volume"}), ", surface missed by ",
              r({"fill", "surface_distance_rms"}), " rms, ", r({"fill", "surface_distance_max"}), " at most");
      CHECK(r({"fill", "inverted"}) == 0);
      CHECK(r({"fill", "smallest_scaled_jacobian"}) >= 0.2);
      CHECK(std::abs(r({"fill", "volume"}) / r({"cut_volume"}) - 1) < 0.005);
      CHECK(r({"surface", "patches", "quadrilaterals"}) > 0);
      CHECK(faults(*checker, folder, "a.vtu") == "");
      CHECK(faults(*checker, folder, "a.surface.vtp --closed") == "");
    }
  }

  TEST_CASE("image_to_mesh: every voxel between the cuts becomes a hexahedron") {
    const auto checker = shared("tools/check_mesh.py");
    const std::string vessel = real();
    if (!checker || vessel.empty() || program("image_to_mesh").empty()) return;
    for (const std::string& image : {std::string("phantom"), vessel}) {
      CAPTURE(image);
      const Folder folder;
      const Run r = mesh(folder, image + " --fill voxels");
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      MESSAGE(r({"fill", "hexahedra"}), " voxels of volume ", r({"fill", "volume"}), ", ",
              r({"fill", "voxels_added"}), " of them added where others touched by an edge alone");
      CHECK(r({"fill", "smallest_scaled_jacobian"}) == doctest::Approx(1));
      CHECK(r({"fill", "hexahedra"}) < r({"segmentation", "voxels"}));
      if (image == vessel) CHECK(std::abs(r({"fill", "volume"}) - true_volume) < 0.03 * true_volume);
      CHECK(faults(*checker, folder, "a.vtu") == "");
      CHECK(folder.files() == std::set<std::string>{"a.vtu", "a.surface.vtp", "r.json"});
    }
  }

  TEST_CASE("image_to_mesh: layers stand on the wall of the phantom and of the real bifurcation") {
    const auto checker = shared("tools/check_mesh.py");
    const std::string vessel = real();
    if (!checker || vessel.empty() || program("image_to_mesh").empty()) return;
    for (const std::string& image : {std::string("phantom"), vessel}) {
      CAPTURE(image);
      const Folder folder;
      const Run r = mesh(folder, image + " --edge 2 --layers 3");
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      MESSAGE(r({"fill", "tetrahedra"}), " tetrahedra, ", r({"layers", "tetrahedra"}), " of them in layers, ",
              100 * r({"layers", "full_share"}), " % of the wall with the whole height, at least ",
              100 * r({"layers", "least_share"}), " % of it; smallest dihedral angle ",
              r({"fill", "smallest_dihedral_degrees"}), " degrees");
      CHECK(r({"fill", "inverted"}) == 0);
      CHECK(r({"fill", "volume_error"}) < 1e-12);
      CHECK(r({"layers", "tetrahedra"}) >
            0.8 * 9 * r({"layers", "columns"}));  // two prisms a node, three each
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
      CHECK(faults(*checker, folder, "a.surface.vtp --closed") == "");
    }
  }

  TEST_CASE("image_to_mesh: sizes follow curvature and diameter and the distance from the wall") {
    const auto checker = shared("tools/check_mesh.py");
    const std::string vessel = real();
    if (!checker || vessel.empty() || program("image_to_mesh").empty()) return;
    const Folder even;
    const Run same = mesh(even, vessel + " --edge 2");
    REQUIRE(same.outcome.status == 0);
    for (const std::string from : {"curvature", "distance", "diameter"}) {
      CAPTURE(from);
      const Folder folder;
      const Run r = mesh(folder, vessel + " --edge 2 --size-from " + from);
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      const double angle = r({"fill", "smallest_dihedral_degrees"});
      MESSAGE("size from ", from, ": ", r({"surface", "triangles"}), " triangles, ",
              r({"fill", "tetrahedra"}), " tetrahedra (", same({"fill", "tetrahedra"}),
              " of one size), smallest dihedral angle ", angle);
      CHECK(angle >= 15);
      CHECK(r({"surface", "smallest_angle_degrees"}) >= 15);
      CHECK(std::abs(r({"fill", "volume"}) - true_volume) < 0.005 * true_volume);
      if (from == "distance")
        CHECK(r({"fill", "tetrahedra"}) < same({"fill", "tetrahedra"}));
      else
        CHECK(r({"fill", "tetrahedra"}) > 1.2 * same({"fill", "tetrahedra"}));
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
    }
  }

  TEST_CASE("image_to_mesh: hexahedra that would be inverted are refused and leave no file") {
    if (program("image_to_mesh").empty()) return;
    const Folder folder;
    std::uint64_t at = std::uint64_t{2} << 32;  // noise up to the border, sampled far too coarsely
    tunica::io::write_vtk_image(folder.path() / "noise.vtk",
                                sampled<float>(8, [&](const tunica::Vec3&) { return noise(++at); }));
    const Run r = mesh(folder, "noise.vtk --iso 0 --fill hexes");
    CHECK(r.outcome.status == 1);
    CHECK(has(r.outcome.err, "hexahedra would be inverted, the worst at ("));
    CHECK(folder.files().size() == 1);
  }
}
