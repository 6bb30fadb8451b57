// SPDX-License-Identifier: MIT
// What a wall shows: Cauchy stress, von Mises, principal stresses, J and fibre stretch, with their names.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/solid/principal.hpp"
#include "tunica/solid/recovery.hpp"
#include "tunica/solid/stress.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// Fields of the nodes or of the cells, one column each.
struct WallFields {
  StressField cauchy;             // xx yy zz xy yz xz, as VTK has it [Pa]
  Eigen::VectorXd von_mises;      // [Pa]
  Points<3> principal;            // descending [Pa]
  Points<3> directions[3];        // of the largest, the middle, the smallest principal stress
  Eigen::VectorXd J;              // current over reference volume [-]
  Eigen::VectorXd fibre_stretch;  // [-]; empty without fibres

  /// take(name, data) for each field: arrays.emplace_back(name, data) makes arrays of a VTU of them.
  template <class Take>
  void for_each(Take&& take) const {
    take("cauchy_stress", cauchy);
    take("von_mises", von_mises);
    take("principal_stress", principal);
    take("principal_direction_1", directions[0]);
    take("principal_direction_2", directions[1]);
    take("principal_direction_3", directions[2]);
    take("J", J);
    if (fibre_stretch.size() > 0) take("fibre_stretch", fibre_stretch);
  }
};

/// J of each cell: its current volume over that of the reference. u: 3 * nodes [m].
template <mesh::Cell C, class Material>
[[nodiscard]] Eigen::VectorXd cell_J(const Body<C, Material>& body, const Eigen::VectorXd& u) {
  using Rule = fem::Gauss<C, C::nodes == 4 ? 1 : C::nodes == 8 ? 3 : C::nodes == 10 ? 2 : 5>;
  using Tables = fem::Tables<fem::Lagrange<C>, Rule>;
  Eigen::VectorXd J(body.mesh().cell_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    double volume = 0, current = 0;
    const auto X = body.reference(e);
    const auto x = (X + body.gather(e, u)).eval();
    for (std::size_t q = 0; q < Rule::size; ++q) {
      volume += Rule::weights[q] * fem::map_point<double, 3>(X, Tables::gradients[q]).det;
      current += Rule::weights[q] * fem::map_point<double, 3>(x, Tables::gradients[q]).det;
    }
    J[e] = current / volume;
  }
  return J;
}

/// |F a| at the middle of each cell, a its fibre in the reference: 3 x cells, of any length but zero.
template <mesh::Cell C, class Material>
[[nodiscard]] Eigen::VectorXd cell_fibre_stretch(const Body<C, Material>& body, const Eigen::VectorXd& u,
                                                 const Points<3>& fibres) {
  TUNICA_EXPECT(fibres.cols() == body.mesh().cell_count(), "one fibre a cell");
  using Rule = fem::Gauss<C, 1>;
  using Tables = fem::Tables<fem::Lagrange<C>, Rule>;
  Eigen::VectorXd stretch(body.mesh().cell_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    const auto map = fem::map_point<double, 3>(body.reference(e), Tables::gradients[0]);
    const Vec3 a = fibres.col(e);
    const Vec3 Fa = a + body.gather(e, u) * (map.gradient.transpose() * a);
    stretch[e] = Fa.norm() / a.norm();
  }
  return stretch;
}

namespace detail {
inline void derive(WallFields& fields) {
  fields.von_mises = von_mises(fields.cauchy);
  const Eigen::Index n = fields.cauchy.cols();
  fields.principal.resize(3, n);
  for (auto& d : fields.directions) d.resize(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Principal p = principal(Symmetric<double>(fields.cauchy.col(k)));
    fields.principal.col(k) = p.values;
    for (int i = 0; i < 3; ++i) fields.directions[i].col(k) = p.directions.col(i);
  }
}
}  // namespace detail

/// Means over the cells. fibres: none, or 3 x cells in the reference.
template <mesh::Cell C, class Material>
[[nodiscard]] WallFields cell_fields(const Body<C, Material>& body, const Eigen::VectorXd& u,
                                     const Points<3>& fibres = Points<3>(3, 0)) {
  WallFields fields;
  fields.cauchy = cell_stress(body, u);
  fields.J = cell_J(body, u);
  if (fibres.cols() > 0) fields.fibre_stretch = cell_fibre_stretch(body, u, fibres);
  detail::derive(fields);
  return fields;
}

/// Recovered to the nodes; what derives from the stress is that of the recovered one.
template <mesh::Cell C, class Material>
[[nodiscard]] WallFields nodal_fields(const Body<C, Material>& body, const Eigen::VectorXd& u,
                                      const Points<3>& fibres = Points<3>(3, 0)) {
  WallFields fields;
  fields.cauchy = recover_at_nodes(body.mesh(), cell_stress(body, u));
  fields.J = recover_at_nodes(body.mesh(), cell_J(body, u).transpose().eval()).transpose();
  if (fibres.cols() > 0)
    fields.fibre_stretch =
        recover_at_nodes(body.mesh(), cell_fibre_stretch(body, u, fibres).transpose().eval()).transpose();
  detail::derive(fields);
  return fields;
}

}  // namespace tunica::solid
