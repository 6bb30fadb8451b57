// SPDX-License-Identifier: MIT
// Fibres wound about centre lines: two families at plus and minus an angle from the circumferential
// direction.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/fibre_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tunica::solid {

/// Unit vectors at a point of a vessel, right-handed: along = outward x around.
struct VesselFrame {
  Vec3 outward{0, 0, 0}, around{0, 0, 0}, along{0, 0, 0};
  double radius = 0;  // distance from the centre line, in its unit
};

/// Centre lines as polygons, of one vessel or of a tree; a point belongs to the nearest one. Between the
/// corners the tangent turns evenly, so that neighbours have fibres alike.
class CentreLines {
 public:
  /// One column a point, two or more a line. MeshError names a line with less, or with two points at one
  /// place.
  explicit CentreLines(std::vector<Points<3>> lines) : lines_(std::move(lines)) {
    if (lines_.empty()) throw MeshError("centre lines: there are none");
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const auto n = static_cast<Index>(lines_[l].cols());
      if (n < 2) throw MeshError("centre lines: line " + std::to_string(l) + " has less than two points");
      std::vector<Vec3> step;
      for (Index k = 0; k + 1 < n; ++k) {
        const Vec3 d = vec::minus(vec::column(lines_[l], k + 1), vec::column(lines_[l], k));
        if (!(vec::squared(d) > 0) || !std::isfinite(vec::squared(d)))
          throw MeshError("centre lines: line " + std::to_string(l) + " has no direction behind point " +
                          std::to_string(k));
        step.push_back(vec::unit(d));
      }
      Points<3> tangent(3, n);
      for (Index k = 0; k < n; ++k) {
        const Vec3& a = step[static_cast<std::size_t>(std::max(k - 1, 0))];
        const Vec3& b = step[static_cast<std::size_t>(std::min(k, n - 2))];
        const Vec3 mean = vec::plus(a, b);
        vec::set_column(tangent, k, vec::squared(mean) > 0 ? vec::unit(mean) : b);
      }
      tangents_.push_back(std::move(tangent));
    }
  }

  /// Zeros for outward and around on the line itself, to rounding, and where it turns straight back.
  [[nodiscard]] VesselFrame at(const Vec3& x) const {
    double least = std::numeric_limits<double>::infinity();
    Vec3 foot(0, 0, 0), tangent(0, 0, 0);
    for (std::size_t l = 0; l < lines_.size(); ++l)
      for (Index k = 0; k + 1 < static_cast<Index>(lines_[l].cols()); ++k) {
        const Vec3 a = vec::column(lines_[l], k), way = vec::minus(vec::column(lines_[l], k + 1), a);
        const double t = std::clamp(vec::dot(vec::minus(x, a), way) / vec::squared(way), 0.0, 1.0);
        const Vec3 here = vec::along(a, t, way);
        const double d = vec::squared(vec::minus(x, here));
        if (!(d < least)) continue;
        least = d, foot = here;
        tangent = vec::between(vec::column(tangents_[l], k), vec::column(tangents_[l], k + 1), t);
      }
    VesselFrame f;
    f.along = vec::unit(tangent);
    const Vec3 off = vec::minus(x, foot);
    const Vec3 across = vec::along(off, -vec::dot(off, f.along), f.along);
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();  // of x and foot: no direction
    if (vec::squared(across) > rounding * rounding * std::max(vec::squared(x), vec::squared(foot)))
      f.outward = vec::unit(across);
    f.around = vec::cross(f.along, f.outward);
    f.radius = std::sqrt(least);
    return f;
  }

 private:
  std::vector<Points<3>> lines_, tangents_;
};

/// The mean of the nodes of a cell.
template <mesh::Cell C>
[[nodiscard]] Vec3 cell_middle(const mesh::Mesh<C, 3>& mesh, Index cell) {
  Vec3 sum(0, 0, 0);
  for (int a = 0; a < C::nodes; ++a) sum = vec::plus(sum, vec::column(mesh.nodes, mesh.cells(a, cell)));
  return vec::divided(sum, C::nodes);
}

/// Two families, cos(angle) around + and - sin(angle) along, at the middles of the cells. angle: one a cell,
/// from the circumferential direction [rad]. MeshError names a cell on the centre line or with an angle not a
/// number.
template <mesh::Cell C>
[[nodiscard]] FibreField<2> helical_fibres(const mesh::Mesh<C, 3>& mesh, const CentreLines& lines,
                                           const std::vector<double>& angle) {
  if (angle.size() != static_cast<std::size_t>(mesh.cell_count()))
    throw MeshError("fibres: " + std::to_string(angle.size()) + " angles for " +
                    std::to_string(mesh.cell_count()) + " cells");
  FibreField<2> field;
  for (auto& f : field.family) f.resize(3, mesh.cell_count());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const VesselFrame at = lines.at(cell_middle(mesh, c));
    const double a = angle[static_cast<std::size_t>(c)];
    if (!(vec::squared(at.around) > 0.5) || !std::isfinite(a))
      throw MeshError("fibres: cell " + std::to_string(c) +
                      (std::isfinite(a) ? " lies on the centre line, or where it turns straight back"
                                        : " has an angle that is not a number"));
    const Vec3 around = vec::scaled(std::cos(a), at.around);
    vec::set_column(field.family[0], c, vec::along(around, std::sin(a), at.along));
    vec::set_column(field.family[1], c, vec::along(around, -std::sin(a), at.along));
  }
  return field;
}

/// One angle everywhere [rad].
template <mesh::Cell C>
[[nodiscard]] FibreField<2> helical_fibres(const mesh::Mesh<C, 3>& mesh, const CentreLines& lines,
                                           double angle) {
  return helical_fibres(mesh, lines, std::vector<double>(static_cast<std::size_t>(mesh.cell_count()), angle));
}

/// The angle of each cell from that of its layer [rad]. MeshError names the cell of a layer without one.
[[nodiscard]] inline std::vector<double> angles_of_layers(const std::vector<Index>& layer,
                                                          const std::vector<double>& angles) {
  std::vector<double> out;
  out.reserve(layer.size());
  for (std::size_t c = 0; c < layer.size(); ++c) {
    if (layer[c] < 0 || static_cast<std::size_t>(layer[c]) >= angles.size())
      throw MeshError("fibres: cell " + std::to_string(c) + ": no angle for layer " +
                      std::to_string(layer[c]));
    out.push_back(angles[static_cast<std::size_t>(layer[c])]);
  }
  return out;
}

/// Layers of a round vessel: cells nearer to the centre line than radii[0] are in layer 0, those nearer than
/// radii[1] in layer 1, and so on; all others in the last one, radii.size(). radii rise, in the unit of the
/// mesh; MeshError names the first that does not.
template <mesh::Cell C>
[[nodiscard]] std::vector<Index> radial_layers(const mesh::Mesh<C, 3>& mesh, const CentreLines& lines,
                                               const std::vector<double>& radii) {
  for (std::size_t k = 0; k < radii.size(); ++k)
    if (!(radii[k] > (k > 0 ? radii[k - 1] : 0)))
      throw MeshError("layers: radius " + std::to_string(k) + " is " + seven_digits(radii[k]) +
                      ", not above the one before it");
  std::vector<Index> layer;
  layer.reserve(static_cast<std::size_t>(mesh.cell_count()));
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const double r = lines.at(cell_middle(mesh, c)).radius;
    layer.push_back(static_cast<Index>(std::upper_bound(radii.begin(), radii.end(), r) - radii.begin()));
  }
  return layer;
}

}  // namespace tunica::solid
