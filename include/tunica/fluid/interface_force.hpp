// SPDX-License-Identifier: MIT
// The force of the fluid on a wall, from the residual of the momentum equation at its nodes. [PEREZ08, (12)]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/momentum.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::fluid {

/// The fields at the end of the step.
struct ForceFields {
  const Points<3>& a;         // u - w [m/s]
  const Points<3>& u;         // [m/s]
  const Points<3>& rate;      // time derivative of u at fixed node [m/s2]
  const Eigen::VectorXd& p;   // [Pa]
  const Points<3>& force;     // [N/m3]; no columns: none
  const Points<3>& smoothed;  // projected (a . grad) u [m/s2]
};

/// int_wall N_i (p n - n.S), n outward: -(the momentum equation tested with N_i), which is consistent
/// with the flow inside, so that its power on the wall is what the flow loses. On nodes that the wall
/// shares with other patches the part of those is taken off.
class InterfaceForce {
 public:
  InterfaceForce() = default;
  InterfaceForce(const Condition& wall, const Conditions& conditions, const Connectivity<4>& cells)
      : nodes_(wall.nodes) {
    for (Index e = 0; e < cells.cols(); ++e)
      for (int a = 0; a < 4; ++a)
        if (on_wall(cells(a, e))) {
          cells_.push_back(e);
          break;
        }
    for (std::size_t k = 0; k < conditions.list().size(); ++k) {
      const Condition& c = conditions.list()[k];
      if (c.name == wall.name) continue;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        if (on_wall(c.faces(0, f)) || on_wall(c.faces(1, f)) || on_wall(c.faces(2, f)))
          rim_.push_back({k, f, c.cells[static_cast<std::size_t>(f)]});
    }
  }

  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }

  /// 3 x nodes() [N]; prescribed: pressures of the pressure patches (nodes).
  template <Rheology R, Stabilization S>
  [[nodiscard]] Points<3> evaluate(const Domain& domain, const R& fluid, const S& stabilization,
                                   const Eigen::VectorXd& prescribed, const ForceFields& fields) const {
    const Connectivity<4>& cells = domain.cells;
    Points<3> force = Points<3>::Zero(3, static_cast<Eigen::Index>(nodes_.size()));
    for (const Index e : cells_) {
      const fem::P1Tet& tet = domain.tets[e];
      const double V = tet.volume;
      const Nodal3 a = nodal(fields.a, cells, e), u = nodal(fields.u, cells, e);
      const Nodal3 rate = nodal(fields.rate, cells, e);
      const ElementFlow flow = element_flow(fluid, stabilization, tet, a, u);
      const Matrix3 grad_u = gradient(u, tet.grad);
      Nodal3 inertia;  // rho du/dt + rho a.grad u - f
      for (int i = 0; i < 4; ++i) {
        const Vec3 convection = product(grad_u, {a(0, i), a(1, i), a(2, i)});
        for (int c = 0; c < 3; ++c) inertia(c, i) = fluid.density * (rate(c, i) + convection[c]);
      }
      if (fields.force.cols() > 0) {
        const Nodal3 f = nodal(fields.force, cells, e);
        for (int k = 0; k < 12; ++k) inertia.data()[k] -= f.data()[k];
      }
      const Vec3 total = sum(inertia), ahead = product(grad_u, flow.a);
      const Vec3 smooth = mean(nodal(fields.smoothed, cells, e));
      const double p = mean(nodal(fields.p, cells, e));
      for (int i = 0; i < 4; ++i) {
        const Index k = find(cells(i, e));
        if (k < 0) continue;
        const Vec3 g(tet.grad(0, i), tet.grad(1, i), tet.grad(2, i)), viscous = product(grad_u, g);
        const double wiggle = flow.stabilisation * V * dot(flow.a, g);
        for (int c = 0; c < 3; ++c)
          force(c, k) -= V / 20 * (total[c] + inertia(c, i)) + V * (flow.viscosity * viscous[c] - p * g[c]) +
                         wiggle * (ahead[c] - smooth[c]);
      }
    }
    for (const Rim& rim : rim_) {
      const Condition& c = domain.conditions.list()[rim.patch];
      const Vec3 n = Conditions::area_vector(domain.position, c.faces, rim.face);
      const auto& values = c.kind == Kind::pressure ? prescribed : fields.p;
      const Vec3 p = face_load(
          1, {values[c.faces(0, rim.face)], values[c.faces(1, rim.face)], values[c.faces(2, rim.face)]});
      Vec3 viscous(0, 0, 0);  // a third of mu (du/dn) area
      if (c.kind != Kind::pressure) {
        const fem::P1Tet& tet = domain.tets[rim.cell];
        const Nodal3 a = nodal(fields.a, cells, rim.cell), u = nodal(fields.u, cells, rim.cell);
        const double third = element_flow(fluid, stabilization, tet, a, u).viscosity / 3;
        const Vec3 slope = product(gradient(u, tet.grad), n);
        viscous = {third * slope[0], third * slope[1], third * slope[2]};
      }
      for (int i = 0; i < 3; ++i)
        if (const Index k = find(c.faces(i, rim.face)); k >= 0) {
          add(force, k, 1, viscous);
          add(force, k, -p[i], n);
        }
    }
    return force;
  }

 private:
  struct Rim {
    std::size_t patch;
    Eigen::Index face;
    Index cell;  // that the face bounds
  };

  [[nodiscard]] Index find(Index node) const {
    const auto it = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    return it != nodes_.end() && *it == node ? static_cast<Index>(it - nodes_.begin()) : -1;
  }
  [[nodiscard]] bool on_wall(Index node) const { return find(node) >= 0; }

  std::vector<Index> nodes_, cells_;
  std::vector<Rim> rim_;
};

}  // namespace tunica::fluid
