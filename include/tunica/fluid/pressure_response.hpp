// SPDX-License-Identifier: MIT
// What increments of the pressure do to the velocity on one shape of the mesh, kept while that stays.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/fluid/consistent_mass.hpp"
#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/total_flux.hpp"
#include "tunica/fluid/unit_response.hpp"

#include <algorithm>
#include <cstddef>

namespace tunica::fluid {

/// A template of its scalar: only the scenes that take a step pay for it.
template <class Scalar = double>
class PressureResponse {
 public:
  explicit PressureResponse(const Pattern& pattern) : mass_(pattern) {}

  /// Of the velocity at these positions and under these conditions. MeshError when a patch has no free node.
  void of_velocity(const Domain& domain) {
    const auto same = [&] {
      return position_.cols() == domain.position.cols() &&
             std::equal(position_.data(), position_.data() + position_.size(), domain.position.data());
    };
    if (revision_ == domain.conditions.revision() && same()) return;
    const auto& fixed = domain.conditions.velocity_flags();
    for (const Condition& c : domain.conditions.list())
      if (c.kind == Kind::pressure && std::all_of(c.nodes.begin(), c.nodes.end(), [&](Index n) {
            return fixed[static_cast<std::size_t>(n)] != 0;
          }))
        throw MeshError("no flow can pass the patch \"" + c.name +
                        "\": all its nodes lie on walls; refine the mesh there");
    mass_.assemble(domain);
    unit_ = mass_.response(domain);
    total_ = total_flux(domain, unit_);
    revision_ = domain.conditions.revision(), position_ = domain.position;
  }
  /// Of the Laplacian itself.
  void whole(const Domain& domain) {
    unit_ = UnitResponse::whole(domain.position.cols()), total_ = {}, revision_ = -1;
  }

  [[nodiscard]] const UnitResponse& unit() const { return unit_; }
  [[nodiscard]] const TotalFlux& total() const { return total_; }
  /// field (3 x nodes): g on entry, M^-1 g on return.
  [[nodiscard]] SolveReport project(const Domain& domain, Points<3>& field) {
    return mass_.solve(domain, field);
  }

 private:
  ConsistentMass<Scalar> mass_;
  UnitResponse unit_;
  TotalFlux total_;
  Points<3> position_;
  int revision_ = -1;  // of the conditions; -1: not of the velocity
};

}  // namespace tunica::fluid
