// SPDX-License-Identifier: MIT
// The program on the real volume: every figure that the project promises of it, and every bad input.
#include "programs/run_program.hpp"
#include "support/shared.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

using namespace tunica::test;

namespace {

const std::string seed = " --seed 30,73,15";
const std::string cuts =
    " --cut 221.567,165.000,22.215,0.0011,0.9996,-0.0283 --cut 207.554,94.976,33.243,-0.2769,-0.9166,0.2883"
    " --cut 237.629,95.025,31.872,0.2506,-0.8866,0.3888";
constexpr double true_volume = 10154;  // mm3, of the contour at 1299.5 between the three planes

struct Run {
  Outcome outcome;
  std::string report;
  [[nodiscard]] double operator()(const std::vector<std::string>& keys) const { return figure(report, keys); }
};

/// image_to_mesh on a volume, with a.vtu, a.surface.vtp and r.json in the folder.
Run mesh(const Folder& folder, const std::filesystem::path& image, const std::string& options) {
  Run r;
  r.outcome = run(folder, program("image_to_mesh") + " \"" + image.string() + "\"" + options +
                              " -o a.vtu --report r.json");
  r.report = text_of(folder.path() / "r.json");
  return r;
}

}  // namespace

TEST_SUITE("job") {
  TEST_CASE("image_to_mesh: the real bifurcation becomes tetrahedra of the promised quality") {
    const auto image = shared("data/aorta_bifurcation.vtk"), checker = shared("tools/check_mesh.py");
    if (!image || !checker || program("image_to_mesh").empty()) return;
    for (const std::string smooth : {"", " --smooth 0"}) {
      CAPTURE(smooth);
      const Folder folder;
      const Run r = mesh(folder, *image, " --iso 1299.5" + seed + cuts + smooth);
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      CHECK(r({"segmentation", "voxels"}) == 13599);
      CHECK(r({"contour", "genus"}) == 0);
      const double volume = r({"fill", "volume"}), angle = r({"surface", "smallest_angle_degrees"}),
                   dihedral = r({"fill", "smallest_dihedral_degrees"});
      MESSAGE("volume after cutting ", r({"cut_volume"}), ", filled ", volume, " mm3; ",
              r({"fill", "tetrahedra"}), " tetrahedra, smallest angle ", angle, ", smallest dihedral angle ",
              dihedral, " degrees");
      CHECK(std::abs(r({"cut_volume"}) - true_volume) < 0.005 * true_volume);
      CHECK(std::abs(volume - true_volume) < 0.005 * true_volume);
      CHECK(angle >= 15);
      CHECK(dihedral >= 5);
      CHECK(r({"fill", "inverted"}) == 0);
      CHECK(r({"surface", "genus"}) == 0);
      CHECK(r({"surface", "components"}) == 1);
      if (smooth.empty())
        CHECK(std::abs(r({"smooth", "volume_after"}) / r({"smooth", "volume_before"}) - 1) < 1e-6);
      CHECK(folder.files() == std::set<std::string>{"a.vtu", "a.surface.vtp", "r.json"});
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
      CHECK(faults(*checker, folder, "a.surface.vtp --closed") == "");
    }
  }

  TEST_CASE("image_to_mesh: the size of the coarse scene has about ten thousand tetrahedra") {
    const auto image = shared("data/aorta_bifurcation.vtk");
    if (!image || program("image_to_mesh").empty()) return;
    const Folder folder;
    const Run r = mesh(folder, *image, " --iso 1299.5" + seed + cuts + " --edge 2");
    INFO(r.outcome.err);
    REQUIRE(r.outcome.status == 0);
    const double count = r({"fill", "tetrahedra"}), dihedral = r({"fill", "smallest_dihedral_degrees"});
    MESSAGE("edge 2 mm: ", count, " tetrahedra, smallest dihedral angle ", dihedral, " degrees");
    CHECK(std::abs(count - 10000) < 1000);
    CHECK(dihedral >= 15);
  }

  TEST_CASE("image_to_mesh: an iso-value that meets voxels gives no degenerate triangle") {
    const auto image = shared("data/aorta_bifurcation.vtk"), checker = shared("tools/check_mesh.py");
    if (!image || !checker || program("image_to_mesh").empty()) return;
    const Folder folder;
    const Run r = mesh(folder, *image, " --iso 1300" + seed + " --smooth 0 --edge 0 --fill none");
    INFO(r.outcome.err);
    REQUIRE(r.outcome.status == 0);
    MESSAGE("smallest angle of the bare contour ", r({"surface", "smallest_angle_degrees"}), " degrees");
    CHECK(r({"surface", "smallest_angle_degrees"}) > 0);
    CHECK(r({"surface", "shortest_edge"}) > 0);
    CHECK(folder.files() == std::set<std::string>{"a.surface.vtp", "r.json"});
    CHECK(faults(*checker, folder, "a.surface.vtp --closed") == "");
    const Run whole = mesh(folder, *image, " --iso 1300" + seed + cuts);
    REQUIRE(whole.outcome.status == 0);
    CHECK(whole({"surface", "smallest_angle_degrees"}) >= 15);
    CHECK(whole({"fill", "smallest_dihedral_degrees"}) >= 5);
    CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
  }

  TEST_CASE("image_to_mesh: a handle and borders of the image are told with their places") {
    const auto image = shared("data/aorta_bifurcation.vtk"), checker = shared("tools/check_mesh.py");
    if (!image || !checker || program("image_to_mesh").empty()) return;
    const Folder folder;
    const Run r = mesh(folder, *image, " --iso 1199.5" + seed + " --fill none");
    INFO(r.outcome.err);
    REQUIRE(r.outcome.status == 0);
    CHECK(r({"contour", "genus"}) == 1);
    CHECK(has(r.outcome.err, "warning: the surface has a handle at (217."));
    CHECK(has(r.outcome.err, "border y0"));
    CHECK(has(r.outcome.err, "border y1"));
    CHECK(r({"handles", "length"}) > 0);
    CHECK(has(r.report, "\"touches\": [\"y0\", \"y1\"]"));
    CHECK(faults(*checker, folder, "a.surface.vtp --closed") == "");
  }

  TEST_CASE("image_to_mesh: discs sever only their vessels and dual contouring serves as well") {
    const auto image = shared("data/aorta_bifurcation.vtk"), checker = shared("tools/check_mesh.py");
    if (!image || !checker || program("image_to_mesh").empty()) return;
    const std::string discs =
        " --cut=221.567,165.000,22.215,0.0011,0.9996,-0.0283,12 "
        "--cut=207.554,94.976,33.243,-0.2769,-0.9166,0.2883,8"
        " --cut=237.629,95.025,31.872,0.2506,-0.8866,0.3888,8";
    const Folder folder;
    const Run r = mesh(folder, *image, " --iso 1299.5" + seed + discs + " --surface dual-contouring");
    INFO(r.outcome.err);
    REQUIRE(r.outcome.status == 0);
    MESSAGE("volume by dual contouring ", r({"fill", "volume"}), " mm3, smallest dihedral angle ",
            r({"fill", "smallest_dihedral_degrees"}), " degrees");
    CHECK(r({"surface", "genus"}) == 0);
    CHECK(r({"fill", "inverted"}) == 0);
    CHECK(std::abs(r({"fill", "volume"}) - true_volume) < 0.005 * true_volume);
    CHECK(has(r.report, "\"name\": \"border y0\""));
    CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
    const Folder empty;
    const auto small = mesh(empty, *image, " --iso 1299.5" + seed + " --cut 221.567,165,22.215,0,1,0,5");
    CHECK(small.outcome.status == 1);
    CHECK(has(small.outcome.err, "error: cut 1 does not sever the vessel round "));
    CHECK(has(small.outcome.err, "is too small by "));
    const auto away = mesh(empty, *image, " --iso 1299.5" + seed + " --cut 0,1000,0,0,1,0");
    CHECK(away.outcome.status == 1);
    CHECK(has(away.outcome.err, "meets nothing: the nearest part lies at a distance of 8"));
    CHECK(empty.files().empty());
  }

  TEST_CASE("image_to_mesh: every bad image ends with its sentence and leaves no file") {
    const auto folder_of_bad = shared("data/bad"), good = shared("data/aorta_bifurcation.vtk");
    if (!folder_of_bad || !good || program("image_to_mesh").empty()) return;
    const auto refused = [&](const std::filesystem::path& image, const std::string& options, int status,
                             const std::string& part) {
      CAPTURE(image.string());
      CAPTURE(options);
      const Folder folder;
      const Run r = mesh(folder, image, options);
      CAPTURE(r.outcome.err);
      CHECK(r.outcome.status == status);
      CHECK(has("\n" + r.outcome.err, "\nerror: "));
      CHECK(has(r.outcome.err, part));
      CHECK(folder.files().empty());
    };
    const std::vector<std::pair<std::string, std::string>> bad{
        {"v01_truncated_payload.vtk", "expected 40960 bytes of scalar data, got 24576"},
        {"v02_dims_lie_larger.vtk", "DIMENSIONS product 40960 != POINT_DATA 20480"},
        {"v04_dims_overflow_uint64.vtk", "overflows"},
        {"v06_dims_zero.vtk", "a dimension is 0"},
        {"v08_nan_inf_values.vtk", "50 values are not finite"},
        {"v09_spacing_zero.vtk", "spacing y is 0"},
        {"v10_spacing_negative.vtk", "spacing z is -1.50009"},
        {"v12_empty_segmentation.vtk", "no voxel at or above 1299.5 (data range 0..0)"},
        {"v13_all_inside.vtk", "touches all six faces"},
        {"v15_unsupported_type_bit.vtk", "scalar type \"bit\" not supported"},
        {"v16_wrong_dataset_kind.vtk", "DATASET UNSTRUCTURED_GRID"},
        {"v20_zero_bytes.vtk", "file is empty"},
        {"nothing.vtk", "no such file"},
        {"s00_control_closed.stl", "expected \"# vtk DataFile Version \""}};
    for (const auto& [name, part] : bad) refused(*folder_of_bad / name, " --iso 1299.5", 1, part);
    refused(*folder_of_bad / "v00_control_ok.vtk", " --iso 1e6", 1,
            "iso-value 1e6 outside data range 0..2346");
    refused(*good, " --iso 1299.5 --seed 0,0,0", 1, "seed 0,0,0 has the value ");
    refused(*good, " --iso 1299.5 --seed 68,0,0", 1, "seed 68,0,0 is outside the image of 68,118,34 voxels");
    {
      const Folder folder;  // the meshes can be written, the report cannot: said before the work begins
      const auto o =
          run(folder, program("image_to_mesh") + " \"" + good->string() + "\" --iso 1299.5 --edge 4" + seed +
                          cuts + " -o a.vtu --report no/such/folder.json");
      CHECK(o.status == 1);
      CHECK(has(o.err, "error: no/such/folder.json: cannot be written: No such file or directory"));
      CHECK(!has(o.out + o.err, "segment"));
      CHECK(folder.files().empty());
    }
    refused(*good, " --iso 1299.5 --edge 0.02" + seed + cuts, 1, "an edge length of 0.02 would take 1.");
    refused(*good, " --iso 1299.5 --edge 1e-300" + seed, 1, "tetrahedra, more than 2e+08");
    refused("", " --iso 1299.5", 2, "IMAGE is empty");
    {
      const Folder folder;
      const auto o =
          run(folder, program("image_to_mesh") + " \"" + good->string() + "\" --iso 1299.5 --edge 4" + seed +
                          cuts + " -o a.vtu --report a.surface.vtp");
      CHECK(o.status == 2);
      CHECK(has(o.err, "error: two outputs are named \"a.surface.vtp\""));
      CHECK(folder.files().empty());
      if (std::filesystem::is_character_file("/dev/full")) {  // as a full disk
        const auto full =
            run(folder, program("image_to_mesh") + " \"" + good->string() + "\" --iso 1299.5 --edge 4" +
                            seed + cuts + " -o a.vtu --report /dev/full");
        CHECK(full.status == 1);
        CHECK(has(full.err, "error: /dev/full: cannot be written: No space left on device"));
        CHECK(folder.files().empty());
        CHECK(std::filesystem::is_character_file("/dev/full"));
      }
    }
    refused(*good, "", 2, "--iso is needed");
    refused(*good, " --isso 3", 2, "unknown option --isso; did you mean --iso?");
    refused(*good, " --iso", 2, "--iso: \"-o\" is not a number");
    refused(*good, " --iso 1 --edge -1", 2, "--edge");
    refused(*good, " --iso 1 --smooth 1.5", 2, "--smooth: \"1.5\" is not a whole number");
    refused(*good, " --iso 1 --fill hexagons", 2, "is none of tets|hexes|voxels|none");
    refused(*good, " --iso 1 --fill hexes --layers 2", 2, "--layers needs --fill tets");
    refused(*good, " --iso 1 --layers -1", 2, "--layers: must be from 0 to 30");
    refused(*good, " --iso 1 --layers 31", 2, "--layers: must be from 0 to 30");
    refused(*good, " --iso 1299.5 --fill hexes --edge 0.01" + seed + cuts, 1,
            "an edge length of 0.01 would take a grid of ");
    refused(*good, " --iso 1 --fill voxels --size-from diameter", 2, "--size-from needs --fill tets or none");
    refused(*good, " --iso 1 --size-from curvature --edge 0", 2,
            "--size-from needs an --edge of more than 0");
    refused(*good, " --iso 1 --fill hexes --edge 0", 2, "--fill hexes needs an --edge of more than 0");
    refused(*good, " --iso 1 --fill voxels --edge 1", 2, "--fill voxels has the edges of the voxels");
    refused(*good, " --iso 1299.5 --fill voxels --cut 0,0,0,0,0,1", 1, "cut 1 leaves no voxel");
    refused(*good, " --iso 1 --cut 1,2,3", 2, "a cut is px,py,pz,nx,ny,nz");
    refused(*good, " --iso 1 --cut 1,2,3,0,0,0", 2, "must have a length");
    refused(*good, " --iso 1 -o b.vtk", 2, "-o");
  }

  TEST_CASE("image_to_mesh: specks of noise within the vessel are filled and told") {
    const auto image = shared("data/aorta_tree.vtk"), checker = shared("tools/check_mesh.py");
    if (!image || !checker || program("image_to_mesh").empty()) return;
    for (const std::string how : {"", " --surface dual-contouring"}) {
      CAPTURE(how);
      const Folder folder;
      const Run r = mesh(folder, *image, " --iso 1300" + how);
      INFO(r.outcome.err);
      REQUIRE(r.outcome.status == 0);
      const double volume = r({"fill", "volume"}), edge = r({"edge"});
      MESSAGE(r({"contour", "filled_cavities", "count"}), " cavities filled, ", r({"fill", "tetrahedra"}),
              " tetrahedra of genus ", r({"surface", "genus"}), ", smallest dihedral angle ",
              r({"fill", "smallest_dihedral_degrees"}), " degrees");
      CHECK(has(r.outcome.err, " cavities smaller than the cube of the edge length filled, "));
      CHECK(r({"contour", "filled_cavities", "count"}) > 0);
      CHECK(r({"contour", "filled_cavities", "volume"}) < 0.001 * volume);
      CHECK(r({"surface", "genus"}) == r({"contour", "genus"}));
      // regular tetrahedra of that edge: V / (edge^3 / (6 sqrt 2)); at most three times as many
      CHECK(r({"fill", "tetrahedra"}) < 3 * volume * 6 * std::sqrt(2.0) / (edge * edge * edge));
      CHECK(r({"fill", "inverted"}) == 0);
      for (const std::string border : {"border y1", "border z0", "border z1"})
        CHECK(has(r.outcome.err, "is its flat end at " + border));
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
    }
    const Folder folder;
    const Run r = mesh(folder, *image, " --iso 1300 --edge 0 --smooth 0 --fill none");
    REQUIRE(r.outcome.status == 0);
    CHECK(r({"contour", "filled_cavities", "count"}) == 0);
    CHECK(r({"surface", "components"}) > 1);
    CHECK(has(r.outcome.err, "warning: there is a cavity of volume "));
  }

  TEST_CASE("image_to_mesh: controls are meshed and named after their image") {
    const auto bad = shared("data/bad"), checker = shared("tools/check_mesh.py");
    if (!bad || !checker || program("image_to_mesh").empty()) return;
    for (const std::string name : {"v00_control_ok", "v18_crlf_header", "v21_touching_one_voxel_neck"}) {
      CAPTURE(name);
      const Folder folder;
      const auto o = run(
          folder, program("image_to_mesh") + " \"" + (*bad / (name + ".vtk")).string() + "\" --iso 1299.5");
      INFO(o.err);
      REQUIRE(o.status == 0);
      CHECK(folder.files() == std::set<std::string>{name + ".vtu", name + ".surface.vtp"});
      CHECK(faults(*checker, folder, name + ".vtu --surface " + name + ".surface.vtp --tol 0") == "");
    }
    const Folder folder;
    const auto help = run(folder, program("image_to_mesh") + " --help");
    CHECK(help.status == 0);
    for (const std::string word : {"--iso", "--seed", "--cut", "--surface", "--fill", "--size-from",
                                   "--layers", "--edge", "--smooth", "-o", "--report"})
      CHECK(has(help.out, word));
    CHECK(run(folder, program("image_to_mesh")).status == 2);
  }
}
