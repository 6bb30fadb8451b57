// SPDX-License-Identifier: MIT
#include "tunica/meshing/cut_voxels.hpp"

#include "support/work_cases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace tunica;

namespace {

/// Voxels of the bifurcation in the unit cube.
struct Vessel {
  image::Image<float> image = test::sampled<float>(48, [](const Vec3& x) { return -test::bifurcation(x); });
  std::vector<std::uint8_t> kept;

  Vessel() {
    for (const float v : image.values) kept.push_back(v >= 0 ? 1 : 0);
  }
  [[nodiscard]] std::vector<Vec3> centres(const std::vector<std::uint8_t>& mask) const {
    std::vector<Vec3> result;
    for (Index k = 0; k < image.size(2); ++k)
      for (Index j = 0; j < image.size(1); ++j)
        for (Index i = 0; i < image.size(0); ++i)
          if (mask[image.offset({i, j, k})] != 0) result.push_back(image.position({i, j, k}));
    return result;
  }
};

std::string refusal(const Vessel& v, const meshing::Cut& cut, const std::optional<image::Voxel>& seed = {}) {
  try {
    (void)meshing::cut_voxels(v.image, v.kept, std::vector{cut}, seed);
  } catch (const MeshError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: a plane keeps the voxels behind it and a disc the vessel with the seed") {
    const Vessel v;
    const auto all = v.centres(v.kept).size();
    const auto behind = v.centres(meshing::cut_voxels(
        v.image, v.kept, std::vector<meshing::Cut>{{.point = {0, 0, 0.7}, .normal = {0, 0, 2}}}));
    CHECK(behind.size() > all / 2);
    CHECK(behind.size() < all);
    for (const Vec3& x : behind) CHECK(x[2] < 0.7);

    // across one of the two branches, which both reach as high
    const meshing::Cut disc{.point = {0.3, 0.46, 0.78}, .normal = {-0.5, -0.1, 0.8}, .radius = 0.16};
    const auto larger = v.centres(meshing::cut_voxels(v.image, v.kept, std::vector{disc}));
    const auto tip =
        v.centres(meshing::cut_voxels(v.image, v.kept, std::vector{disc}, image::Voxel{11, 21, 41}));
    CHECK(larger.size() + tip.size() == all);
    CHECK(larger.size() > tip.size());
    CHECK(tip.size() > 20);
    double highest = 0;
    for (const Vec3& x : larger) highest = std::max(highest, x[2]);
    CHECK(highest > 0.8);  // the other branch is whole
    for (const Vec3& x : tip) CHECK(disc.normal.dot(x - disc.point) > 0);
  }

  TEST_CASE("meshing: cuts of voxels that cannot be made are refused by name") {
    const Vessel v;
    CHECK(refusal(v, {.point = {0, 0, -1}, .normal = {0, 0, 1}}).find("cut 1 leaves no voxel") == 0);
    CHECK(refusal(v, {.point = {0.5, 0.5, 0.3}, .normal = {0, 0, 1}, .radius = 0.05, .name = "low"})
              .find("low does not sever the voxels round") == 0);
    CHECK(refusal(v, {.point = {0.05, 0.5, 0.3}, .normal = {0, 0, 1}, .radius = 0.05})
              .find("passes no face between two voxels") != std::string::npos);
    CHECK(refusal(v, {.point = {0, 0, 0.4}, .normal = {0, 0, 1}}, image::Voxel{23, 23, 30}) ==
          "cut 1 removes the voxel of the seed");
  }
}
