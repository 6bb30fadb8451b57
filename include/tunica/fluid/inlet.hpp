// SPDX-License-Identifier: MIT
// The velocity profile of an inlet of any shape: blunt in the middle, zero on the rim.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/fluid/conditions.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::fluid {

namespace detail {

/// The edges of a patch that only one of its faces has.
[[nodiscard]] inline std::vector<std::array<Index, 2>> rim_edges(const Connectivity<3>& faces) {
  std::vector<std::array<Index, 2>> edges, rim;
  for (Eigen::Index f = 0; f < faces.cols(); ++f)
    for (int i = 0; i < 3; ++i) {
      const Index a = faces(i, f), b = faces((i + 1) % 3, f);
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const bool again =
        (k > 0 && edges[k - 1] == edges[k]) || (k + 1 < edges.size() && edges[k + 1] == edges[k]);
    if (!again) rim.push_back(edges[k]);
  }
  return rim;
}

}  // namespace detail

/// u = -n s (1 - (1 - d/d_max)^2), d the distance to the rim of the patch, n its mean outward normal;
/// s is such that the discrete flux is exactly -area: times a mean velocity it is the inflow asked for.
[[nodiscard]] inline Profile inlet_profile(const mesh::TetMesh& mesh, std::string_view name) {
  const auto& patch = mesh.patch(name);
  const auto rim = detail::rim_edges(patch.faces);
  Profile profile{.nodes = mesh::patch_nodes(patch), .velocity = {}};
  Vec3 normal = Vec3::Zero();
  for (Eigen::Index f = 0; f < patch.faces.cols(); ++f)
    normal += Conditions::area_vector(mesh.nodes, patch.faces, f);
  const double area = normal.norm();
  if (rim.empty() || !(area > 0)) throw MeshError("the inlet \"" + std::string(name) + "\" has no rim");

  const auto count = static_cast<Eigen::Index>(profile.nodes.size());
  Eigen::VectorXd distance(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec3 x = mesh.nodes.col(profile.nodes[static_cast<std::size_t>(k)]);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [i, j] : rim) {
      const Vec3 a = mesh.nodes.col(i), ab = mesh.nodes.col(j) - a;
      const double s = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + s * ab - x).squaredNorm());
    }
    distance[k] = std::sqrt(nearest);
  }
  const double largest = distance.maxCoeff();
  if (!(largest > 0)) throw MeshError("the inlet \"" + std::string(name) + "\" has no node inside its rim");
  const Eigen::ArrayXd from_middle = 1 - distance.array() / largest;
  profile.velocity = -normal / area * (1 - from_middle.square()).matrix().transpose();

  Points<3> field = Points<3>::Zero(3, mesh.nodes.cols());
  for (Eigen::Index k = 0; k < count; ++k)
    field.col(profile.nodes[static_cast<std::size_t>(k)]) = profile.velocity.col(k);
  profile.velocity *= -area / Conditions::flux(mesh.nodes, patch.faces, field);
  return profile;
}

}  // namespace tunica::fluid
