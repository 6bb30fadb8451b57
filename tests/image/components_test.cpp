// SPDX-License-Identifier: MIT
#include "tunica/image/components.hpp"
#include "tunica/image/threshold.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::image;

namespace {

Image<short> grid(Index nx, Index ny, Index nz) {
  Image<short> image;
  const std::array<Index, 3> n{nx, ny, nz};
  for (std::size_t a = 0; a < 3; ++a)
    for (Index i = 0; i < n[a]; ++i) image.axes[a].push_back(i);
  image.values.assign(static_cast<std::size_t>(nx * ny * nz), 0);
  return image;
}

std::string message(const Image<short>& image, const Segmentation& how) {
  try {
    (void)segment(image, how);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("image: neighbours by face and edge and corner join different components") {
    auto image = grid(5, 5, 5);
    for (const Voxel v : {Voxel{0, 0, 0}, Voxel{1, 1, 0}, Voxel{2, 2, 1}, Voxel{2, 3, 1}, Voxel{4, 4, 4}})
      image.values[image.offset(v)] = 100;
    const Mask mask = at_or_above(image, 50);
    CHECK(mask.count() == 5);
    CHECK(components(mask, Neighbours::faces).count() == 4);
    CHECK(components(mask, Neighbours::edges).count() == 3);
    CHECK(components(mask, Neighbours::corners).count() == 2);
    const auto r = segment(image, {.iso = 50, .neighbours = Neighbours::corners});
    CHECK(r.voxels == 4);
    CHECK(r.lowest == Voxel{0, 0, 0});
    CHECK(r.highest == Voxel{2, 3, 1});
    CHECK(r.touches == std::array<bool, 6>{true, false, true, false, true, false});
    const auto s = segment(image, {.iso = 50, .seed = Voxel{4, 4, 4}});
    CHECK(s.voxels == 1);
    CHECK(s.touches == std::array<bool, 6>{false, true, false, true, false, true});
    const auto kept = keep_only(image, s, 50);
    CHECK(at_or_above(kept, 50).count() == 1);
    CHECK(kept({4, 4, 4}) == 100);
    CHECK(kept({0, 0, 0}) == 0);
  }

  TEST_CASE("image: a band keeps both its ends") {
    auto image = grid(4, 1, 1);
    image.values = {1, 2, 3, 4};
    CHECK(within(image, {.lowest = 2, .highest = 3}).inside == std::vector<std::uint8_t>{0, 1, 1, 0});
    CHECK(at_or_above(image, 2).inside == std::vector<std::uint8_t>{0, 1, 1, 1});
  }

  TEST_CASE("image: what cannot be segmented is named with the range of the data") {
    auto image = grid(2, 2, 2);
    CHECK(message(image, {.iso = 1299.5}) == "no voxel at or above 1299.5 (data range 0..0)");
    image.values.assign(8, 2000);
    CHECK(
        message(image, {.iso = 1299.5}) ==
        "every voxel is at or above 1299.5 (data range 2000..2000): the region touches all six faces of the "
        "image and there is no surface");
    image.values[0] = 0, image.values[7] = 2346;
    CHECK(message(image, {.iso = 1e6}) == "iso-value 1e6 outside data range 0..2346");
    CHECK(message(image, {.iso = -5}) == "iso-value -5 outside data range 0..2346");
    CHECK(message(image, {.iso = 0}).find("touches all six faces") != std::string::npos);
    CHECK(message(image, {.iso = 100, .seed = Voxel{2, 0, 0}}) ==
          "seed 2,0,0 is outside the image of 2,2,2 voxels");
    CHECK(message(image, {.iso = 100, .seed = Voxel{0, 0, 0}}) ==
          "seed 0,0,0 has the value 0, below the iso-value 100");
    CHECK(message(image, {.iso = 2346}).empty());
    CHECK(message(image, {.iso = std::nan("")}).find("not a number") != std::string::npos);
    CHECK(message(Image<short>{}, {.iso = 1}) == "the image has no voxels");
  }

  TEST_CASE("image: component labels are dense and agree with the counts on noise") {
    auto image = grid(17, 13, 11);
    std::uint32_t s = 1;
    for (auto& v : image.values) s = s * 1664525u + 1013904223u, v = static_cast<short>(s >> 24);
    for (const auto n : {Neighbours::faces, Neighbours::edges, Neighbours::corners}) {
      const Mask mask = at_or_above(image, 140);
      const Components all = components(mask, n);
      std::vector<std::size_t> voxels(all.count());
      for (std::size_t i = 0; i < all.label.size(); ++i) {
        REQUIRE((all.label[i] >= 0) == (mask.inside[i] != 0));
        if (all.label[i] >= 0) ++voxels[static_cast<std::size_t>(all.label[i])];
      }
      CHECK(voxels == all.voxels);
      const auto r = region_of(all, all.largest());
      CHECK(r.mask.count() == r.voxels);
      for (Index k = 0; k < 11; ++k)  // no two neighbours bear different labels
        for (Index j = 0; j < 13; ++j)
          for (Index i = 0; i + 1 < 17; ++i) {
            const auto a = all.label[mask.offset({i, j, k})], b = all.label[mask.offset({i + 1, j, k})];
            REQUIRE((a < 0 || b < 0 || a == b));
          }
    }
  }
}
