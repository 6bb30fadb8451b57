// SPDX-License-Identifier: MIT
// The inside of an image cut by planes and discs before it is contoured: nodes in front are dropped, and
// edges that a plane crosses first are crossed in the plane.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/flat_vertex.hpp"
#include "tunica/meshing/grid_crossing.hpp"
#include "tunica/meshing/grid_sections.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/vertex_placer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tunica::meshing::detail {

/// Crossings of the image and of the cuts: what is met first on the way out.
template <class T>
class CutCrossings {
 public:
  CutCrossings(const image::Image<T>& image, std::span<const std::uint8_t> kept, double iso,
               const std::vector<GridCut>& cuts, double nearest)
      : image_(image), field_(image, iso), kept_(kept), cuts_(cuts), nearest_(nearest) {}

  [[nodiscard]] static Vec3 along(std::size_t axis, bool up) { return GridCrossings<T>::along(axis, up); }

  template <std::size_t Axis>
  [[nodiscard]] GridCrossing cross(const GridNode& node, bool first_inside) const {
    GridNode in = node, out = node;
    ++(first_inside ? out : in)[Axis];
    const auto point = [&](const GridNode& n) {
      return Vec3(image_.axes[0][n[0]], image_.axes[1][n[1]], image_.axes[2][n[2]]);
    };
    const Vec3 p = point(in), q = point(out);
    const std::size_t beyond = field_.offset(out);
    const bool leaves = !field_.reaches(beyond) || (!kept_.empty() && kept_[beyond] == 0);
    GridCrossing first = field_.template cross<Axis>(node, first_inside);
    double least =
        leaves ? (first_inside ? first.at : 1 - first.at) : std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < cuts_.size(); ++c) {
      const GridCut& cut = cuts_[c];
      const double d = plane_distance(cut.plane, p, nearest_), e = plane_distance(cut.plane, q, nearest_);
      if (!(d < 0 && e >= 0)) continue;
      const double t = d / (d - e);
      if (t > least || !cut.holds(vec::between(p, q, t))) continue;
      least = t;
      first = {first_inside ? t : 1 - t, cut.plane.normal, static_cast<Index>(c) + 1};
    }
    return first;
  }

 private:
  const image::Image<T>& image_;
  GridCrossings<T> field_;
  std::span<const std::uint8_t> kept_;
  const std::vector<GridCut>& cuts_;
  double nearest_;
};

/// Takes the nodes of one cut after the other out of the signs of an image.
class GridCutter {
 public:
  GridCutter(const std::array<std::vector<double>, 3>& axes, PaddedBits& bits) : sections_(axes, bits) {}

  [[nodiscard]] const std::vector<GridCut>& cuts() const { return cuts_; }
  [[nodiscard]] double nearest() const { return sections_.nearest(); }

  void apply(const Cut& cut, const CutOptions& options) {
    TUNICA_EXPECT(vec::length(cut.normal) > 0, "the normal of a cut has a length");
    TUNICA_EXPECT(cut.radius > 0, "the radius of a cut is positive");
    if (cuts_.size() + 1 >= most_cuts)
      throw MeshError("more than " + std::to_string(most_cuts - 2) + " cuts");
    GridCut made{{cut.name.empty() ? "cut " + std::to_string(cuts_.size() + 1) : cut.name, true, cut.point,
                  vec::unit(cut.normal)},
                 cut.radius};
    for (const GridCut& other : cuts_)
      if (other.plane.name == made.plane.name)
        throw MeshError("two regions are named \"" + made.plane.name + "\"");
    if (std::isinf(cut.radius))
      halve(made);
    else
      sever(made, options);
    cuts_.push_back(made);
  }

 private:
  /// All in front of a plane goes.
  void halve(const GridCut& cut) {
    double behind = std::numeric_limits<double>::infinity();
    std::vector<GridNode> front;
    bool left = false;
    sections_.for_inside([&](const GridNode& n) {
      const double d = sections_.distance(cut, n);
      if (d < 0)
        left = true, behind = std::min(behind, -d);
      else
        front.push_back(n);
    });
    if (!left) throw MeshError(cut.plane.name + " leaves nothing: all of the surface lies in front of it");
    if (front.empty()) throw MeshError(nothing_met(cut, behind));
    for (const GridNode& n : front) sections_.drop(n);
  }

  /// Of the parts that a disc severs one stays: that with the seed, or the larger one.
  void sever(GridCut& cut, const CutOptions& options) {
    cut.slack = sections_.widest();
    const std::vector<GridSection> sections = sections_.sections(cut);
    std::vector<GridEdge> severed;
    double nearest = std::numeric_limits<double>::infinity();
    for (const GridSection& s : sections) {
      nearest = std::min(nearest, std::max(0.0, s.nearest - cut.radius));
      if (s.nearest > cut.radius) continue;
      if (s.farthest > cut.radius)
        throw MeshError(cut.plane.name + " does not sever the vessel round " + place(s.centre) +
                        ": its radius " + seven_digits(cut.radius) + " is too small by " +
                        seven_digits(s.farthest - cut.radius));
      severed.insert(severed.end(), s.edges.begin(), s.edges.end());
    }
    if (severed.empty()) throw MeshError(nothing_met(cut, nearest));
    std::sort(severed.begin(), severed.end());
    const GridParts parts(sections_, severed);
    if (parts.leaks())
      throw MeshError(cut.plane.name + " opens the vessel but the two sides stay connected round it");
    const std::size_t stays = options.seed ? parts.nearest_to(*options.seed) : parts.largest();
    if (!parts.behind(stays)) cut.plane.normal = vec::scaled(-1, cut.plane.normal);
    sections_.for_inside([&](const GridNode& n) {
      const std::size_t part = parts.of(n);
      const bool in_plane = part == stays && sections_.distance(cut, n) == 0 && cut.holds(sections_.point(n));
      if (in_plane || (part != GridParts::none && part != stays)) sections_.drop(n);
    });
  }

  [[nodiscard]] static std::string nothing_met(const GridCut& cut, double distance) {
    return cut.plane.name + " at " + place(cut.plane.point) +
           " meets nothing: the nearest part lies at a distance of " + seven_digits(distance);
  }

  GridSections sections_;
  std::vector<GridCut> cuts_;
};

}  // namespace tunica::meshing::detail
