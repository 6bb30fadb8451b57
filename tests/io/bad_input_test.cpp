// SPDX-License-Identifier: MIT
// Walks the collection of bad inputs: every VTK and STL file gets what its index says.
#include "support/shared.hpp"
#include "tunica/image/components.hpp"
#include "tunica/io/closed_surface.hpp"
#include "tunica/io/vtk_image.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

using namespace tunica;

namespace {

/// What loading, segmenting at 1299.5 or closing a file says; empty if nothing.
std::string verdict(const std::filesystem::path& path) {
  try {
    if (path.extension() == ".stl") {
      const auto closed = io::read_closed_stl(path);
      return closed.notices.empty() ? "" : "notice: " + closed.notices[0];
    }
    const auto file = io::read_vtk_image(path);
    try {
      (void)image::segment(file.image, {.iso = 1299.5});
    } catch (const InputError& e) {
      return "loaded, then " + std::string(e.what());
    }
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

/// What must be in the sentence; empty where the file is good.
const std::map<std::string, std::string> expected{
    {"s00_control_closed.stl", ""},
    {"s01_nonmanifold_edge.stl",
     "is shared by 4 facets: a closed surface has two at every edge (1 such edges; 4 edges"},
    {"s02_open_hole.stl", "1 boundary loop: 11 edges around ("},
    {"s04_ascii_junk.stl", "line 31 (byte 589)"},
    {"s06_truncated_binary.stl", "says 1702 facets, the file holds 700 whole ones and 17 stray bytes"},
    {"s08_binary_header_says_solid.stl", ""},
    {"s10_inside_out.stl", "notice: "},
    {"s12_zero_facets.stl", "0 facets"},
    {"v00_control_ok.vtk", ""},
    {"v01_truncated_payload.vtk", "expected 40960 bytes of scalar data, got 24576"},
    {"v02_dims_lie_larger.vtk", "DIMENSIONS product 40960 != POINT_DATA 20480"},
    {"v04_dims_overflow_uint64.vtk", "dimension product 4194304 x 4194304 x 4194304 overflows"},
    {"v06_dims_zero.vtk", "a dimension is 0 (0 x 32 x 20): no voxels"},
    {"v08_nan_inf_values.vtk", "50 values are not finite (48 NaN, 1 +Inf, 1 -Inf), the first at index "},
    {"v09_spacing_zero.vtk", "spacing y is 0: cells have no volume"},
    {"v10_spacing_negative.vtk", "spacing z is -1.50009: it would turn all orientations inside out"},
    {"v12_empty_segmentation.vtk", "loaded, then no voxel at or above 1299.5 (data range 0..0)"},
    {"v13_all_inside.vtk", "touches all six faces"},
    {"v15_unsupported_type_bit.vtk", "scalar type \"bit\" not supported; supported are char, "},
    {"v16_wrong_dataset_kind.vtk", "DATASET UNSTRUCTURED_GRID where STRUCTURED_POINTS is expected"},
    {"v18_crlf_header.vtk", ""},
    {"v20_zero_bytes.vtk", "file is empty"},
    {"v21_touching_one_voxel_neck.vtk", ""},
};

/// Names in the first column of the index that begin with v or s, with their third column.
std::map<std::string, std::string> index_rows(const std::filesystem::path& path) {
  std::map<std::string, std::string> rows;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.size() < 4 || line[0] != '|' || (line[2] != 'v' && line[2] != 's')) continue;
    const auto name_end = line.find(" |", 2), second = line.find("| ", name_end + 2);
    const auto third = line.find("| ", second + 1), end = line.find(" |", third + 2);
    (void)second;
    rows[line.substr(2, name_end - 2)] = line.substr(third + 2, end - third - 2);
  }
  return rows;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: every bad VTK and STL file gets what its index says") {
    const auto folder = test::shared("data/bad");
    if (!folder) return;
    const auto rows = index_rows(*folder / "INDEX.md");
    CHECK(rows.size() == expected.size());
    for (const auto& [name, wanted] : rows) {
      CAPTURE(name);
      CAPTURE(wanted);
      REQUIRE(expected.count(name) == 1);
      const std::string said = verdict(*folder / name), part = expected.at(name);
      CAPTURE(said);
      CHECK(said.empty() == part.empty());
      CHECK(said.find(part) != std::string::npos);
      if (!said.empty() && said.rfind("loaded", 0) != 0) CHECK(said.find(name) != std::string::npos);
      if (wanted.rfind("OK", 0) == 0) CHECK(said.empty());
      if (wanted.rfind("REPAIR", 0) == 0) CHECK(said.rfind("notice: ", 0) == 0);
      if (wanted.rfind("REJECT", 0) == 0) CHECK(said.rfind("notice: ", 0) == std::string::npos);
      if (wanted.rfind("LOAD, then", 0) == 0) CHECK(said.rfind("loaded, then ", 0) == 0);
    }
  }

  TEST_CASE("io: control files hold the data that their index describes") {
    const auto good = test::shared("data/bad/v00_control_ok.vtk"),
               crlf = test::shared("data/bad/v18_crlf_header.vtk");
    const auto whole = test::shared("data/aorta_bifurcation.vtk"),
               neck = test::shared("data/bad/v21_touching_one_voxel_neck.vtk");
    if (!good || !crlf || !whole || !neck) return;
    const auto a = io::read_vtk_image<short>(*good), b = io::read_vtk_image<short>(*crlf);
    CHECK(a.image.values == b.image.values);
    CHECK(a.image.axes == b.image.axes);
    CHECK(image::data_range(a.image).lowest == 0);
    CHECK(image::data_range(a.image).highest == 2346);
    const auto r = io::read_vtk_image(*whole);
    const auto mask = image::at_or_above(r.image, 1299.5);
    CHECK(mask.count() == 13784);
    CHECK(image::components(mask).count() == 15);
    const auto region = image::segment(r.image, {.iso = 1299.5, .seed = image::Voxel{30, 73, 15}});
    CHECK(region.voxels == 13599);
    CHECK(region.touches == std::array<bool, 6>{false, false, true, true, false, false});
    for (const auto& [iso, voxels] : std::map<double, std::size_t>{
             {900, 18111}, {1100, 15718}, {1199.5, 14566}, {1249.5, 14077}, {1300, 13599}, {1400, 12627}})
      CHECK(image::segment(r.image, {.iso = iso, .seed = image::Voxel{30, 73, 15}}).voxels == voxels);
    const auto n = image::at_or_above(io::read_vtk_image(*neck).image, 1299.5);
    CHECK(image::components(n, image::Neighbours::corners).count() < image::components(n).count());
  }
}
