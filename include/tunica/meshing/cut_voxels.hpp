// SPDX-License-Identifier: MIT
// Cuts by planes and discs of a segmentation: the voxels whose centres stay.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/image/image.hpp"
#include "tunica/meshing/cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

namespace detail {

/// Flood fills of a mask over faces of voxels that no disc severs.
template <class T>
class SeveredVoxels {
 public:
  SeveredVoxels(const image::Image<T>& image, const std::vector<std::uint8_t>& kept, const Cut& disc)
      : image_(image), kept_(kept), disc_(disc), normal_(vec::unit(disc.normal)), part_(kept.size(), 0) {
    std::vector<std::size_t> stack;
    for (std::size_t start = 0; start < kept.size(); ++start) {
      if (kept[start] == 0 || part_[start] != 0) continue;
      sizes_.push_back(0);
      part_[start] = static_cast<Index>(sizes_.size());
      stack.assign(1, start);
      while (!stack.empty()) {
        const std::size_t at = stack.back();
        stack.pop_back();
        ++sizes_.back();
        spread(at, stack);
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return sizes_.size(); }
  [[nodiscard]] Index part(std::size_t voxel) const { return part_[voxel]; }
  [[nodiscard]] Index largest() const {
    return static_cast<Index>(std::max_element(sizes_.begin(), sizes_.end()) - sizes_.begin() + 1);
  }
  [[nodiscard]] bool met() const { return met_; }

 private:
  void spread(std::size_t at, std::vector<std::size_t>& stack) {
    const std::size_t nx = image_.axes[0].size(), ny = image_.axes[1].size(), nz = image_.axes[2].size();
    const std::array<std::size_t, 3> i{at % nx, at / nx % ny, at / (nx * ny)}, size{nx, ny, nz},
        stride{1, nx, nx * ny};
    for (std::size_t a = 0; a < 3; ++a)
      for (const bool up : {false, true}) {
        if (up ? i[a] + 1 == size[a] : i[a] == 0) continue;
        const std::size_t to = up ? at + stride[a] : at - stride[a];
        if (kept_[to] == 0 || part_[to] != 0) continue;
        auto j = i;
        j[a] = up ? i[a] + 1 : i[a] - 1;
        if (severs(centre(i), centre(j))) continue;
        part_[to] = static_cast<Index>(sizes_.size());
        stack.push_back(to);
      }
  }

  [[nodiscard]] Vec3 centre(const std::array<std::size_t, 3>& i) const {
    return {image_.axes[0][i[0]], image_.axes[1][i[1]], image_.axes[2][i[2]]};
  }

  /// The way from x to y passes the disc.
  [[nodiscard]] bool severs(const Vec3& x, const Vec3& y) {
    const double from = vec::dot(normal_, vec::minus(x, disc_.point)),
                 to = vec::dot(normal_, vec::minus(y, disc_.point));
    if ((from < 0) == (to < 0)) return false;
    const Vec3 at = vec::along(x, from / (from - to), vec::minus(y, x));
    if (vec::distance(at, disc_.point) > disc_.radius) return false;
    met_ = true;
    return true;
  }

  const image::Image<T>& image_;
  const std::vector<std::uint8_t>& kept_;
  Cut disc_;
  Vec3 normal_;
  std::vector<Index> part_;  // 1 ..., 0 for those that are not kept
  std::vector<std::size_t> sizes_;
  bool met_ = false;
};

}  // namespace detail

/// One byte a voxel: those of `kept` (one byte a voxel, 0 is dropped) that the cuts leave, one after the
/// other. A plane removes all voxels in front of it; a disc severs the faces between voxels that it passes,
/// and the part with the seed stays (without a seed the largest). MeshError where a cut leaves nothing, meets
/// nothing or does not sever what it passes, or where the seed is not in what is kept.
template <class T>
[[nodiscard]] std::vector<std::uint8_t> cut_voxels(const image::Image<T>& image,
                                                   std::vector<std::uint8_t> kept, std::span<const Cut> cuts,
                                                   const std::optional<image::Voxel>& seed = std::nullopt) {
  TUNICA_EXPECT(kept.size() == image.values.size(), "the mask has one byte for each voxel");
  for (std::size_t n = 0; n < cuts.size(); ++n) {
    const Cut& cut = cuts[n];
    TUNICA_EXPECT(vec::length(cut.normal) > 0, "the normal of a cut has a length");
    const std::string name = cut.name.empty() ? "cut " + std::to_string(n + 1) : cut.name;
    if (std::isinf(cut.radius)) {
      std::size_t at = 0;
      for (const double z : image.axes[2])
        for (const double y : image.axes[1])
          for (const double x : image.axes[0]) {
            if (!(vec::dot(cut.normal, vec::minus(Vec3(x, y, z), cut.point)) < 0)) kept[at] = 0;
            ++at;
          }
    } else {
      const detail::SeveredVoxels<T> parts(image, kept, cut);
      if (!parts.met())
        throw MeshError(name + " at " + place(cut.point) + " passes no face between two voxels");
      if (parts.count() < 2)
        throw MeshError(name + " does not sever the voxels round " + place(cut.point) + ": its radius " +
                        seven_digits(cut.radius) + " is too small");
      const Index stays = seed ? parts.part(image.offset(*seed)) : parts.largest();
      for (std::size_t at = 0; at < kept.size(); ++at)
        if (parts.part(at) != stays) kept[at] = 0;
    }
    if (seed && kept[image.offset(*seed)] == 0) throw MeshError(name + " removes the voxel of the seed");
    if (std::find_if(kept.begin(), kept.end(), [](std::uint8_t k) { return k != 0; }) == kept.end())
      throw MeshError(name + " leaves no voxel");
  }
  return kept;
}

}  // namespace tunica::meshing
