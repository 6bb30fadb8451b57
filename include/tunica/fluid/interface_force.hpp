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
          rim_.push_back({k, f, owner(cells, c.faces.col(f))});
    }
  }

  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }

  /// 3 x nodes() [N]; x: 3 x nodes of the mesh, prescribed: pressures of the pressure patches (nodes).
  /// fields: ForceFields.
  template <Rheology R, Stabilization S, class Tets, class Fields>
  [[nodiscard]] Points<3> evaluate(const Connectivity<4>& cells, const Tets& tets, const R& fluid,
                                   const S& stabilization, const Conditions& conditions, const Points<3>& x,
                                   const Eigen::VectorXd& prescribed, const Fields& fields) const {
    Points<3> force = Points<3>::Zero(3, static_cast<Eigen::Index>(nodes_.size()));
    for (const Index e : cells_) {
      const auto& tet = tets[e];
      const double V = tet.volume;
      const Eigen::Matrix<double, 3, 4> a = nodal<3>(fields.a, cells, e), u = nodal<3>(fields.u, cells, e);
      const ElementFlow flow = element_flow(fluid, stabilization, tet, a, u);
      const Eigen::Matrix3d grad_u = u * tet.grad.transpose();
      Eigen::Matrix<double, 3, 4> inertia = fluid.density * (nodal<3>(fields.rate, cells, e) + grad_u * a);
      if (fields.force.cols() > 0) inertia -= nodal<3>(fields.force, cells, e);
      const Vec3 total = inertia.rowwise().sum();
      const Vec3 wiggle =
          flow.stabilisation * V * (grad_u * flow.a - nodal<3>(fields.smoothed, cells, e).rowwise().mean());
      const double p = nodal(fields.p, cells, e).mean();
      for (int i = 0; i < 4; ++i) {
        const Index k = find(cells(i, e));
        if (k < 0) continue;
        force.col(k) -= V / 20 * (total + inertia.col(i))  // rho du/dt + rho a.grad u - f
                        + V * (flow.viscosity * grad_u - p * Eigen::Matrix3d::Identity()) * tet.grad.col(i) +
                        flow.a.dot(tet.grad.col(i)) * wiggle;
      }
    }
    for (const Rim& rim : rim_) {
      const Condition& c = conditions.list()[rim.patch];
      const Vec3 n = Conditions::area_vector(x, c.faces, rim.face);
      const auto& values = c.kind == Kind::pressure ? prescribed : fields.p;
      const Vec3 p = face_load(
          1, {values[c.faces(0, rim.face)], values[c.faces(1, rim.face)], values[c.faces(2, rim.face)]});
      Vec3 viscous = Vec3::Zero();
      if (c.kind != Kind::pressure) {
        const auto& tet = tets[rim.cell];
        const Eigen::Matrix<double, 3, 4> u = nodal<3>(fields.u, cells, rim.cell);
        const ElementFlow flow =
            element_flow(fluid, stabilization, tet, nodal<3>(fields.a, cells, rim.cell), u);
        viscous = flow.viscosity * (u * tet.grad.transpose()) * n / 3;
      }
      for (int i = 0; i < 3; ++i)
        if (const Index k = find(c.faces(i, rim.face)); k >= 0) force.col(k) += viscous - p[i] * n;
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

  [[nodiscard]] Index owner(const Connectivity<4>& cells, const Eigen::Matrix<Index, 3, 1>& face) const {
    for (const Index e : cells_)
      if (std::all_of(face.begin(), face.end(), [&](Index n) { return (cells.col(e).array() == n).any(); }))
        return e;
    throw MeshError("a face of the fluid's boundary belongs to no tetrahedron");
  }

  std::vector<Index> nodes_, cells_;
  std::vector<Rim> rim_;
};

}  // namespace tunica::fluid
