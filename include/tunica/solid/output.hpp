// SPDX-License-Identifier: MIT
// What a wall shows: Cauchy stress, von Mises, principal stresses, J and fibre stretch, with their names.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/solid/principal.hpp"
#include "tunica/solid/recovery.hpp"
#include "tunica/solid/stress.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

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

namespace detail {
/// visit(q, F, volume) at the points of a cell: the whole deformation, F_p of a prestress included, and the
/// current volume of the point [m3].
template <mesh::Cell C, class Material, class Visit>
void for_each_point(const Body<C, Material>& body, Index e, const Eigen::VectorXd& u, const Visit& visit) {
  using Element = typename Body<C, Material>::Element;
  const auto X = body.reference(e), ue = body.gather(e, u);
  const auto data = body.data(e);
  const auto volume = Element::stress(body.material(e), X, ue, data).volume;
  const auto increment = Element::deformation(X, ue);
  for (std::size_t q = 0; q < increment.size(); ++q) {
    Eigen::Matrix3d F = increment[q];
    if (data.prestress != nullptr) F = (F * data.prestress[q]).eval();
    visit(q, F, volume[q]);
  }
}
}  // namespace detail

/// Cauchy stress at the nodes: recovered from the means of the cells; where the nodes have pressures of their
/// own, only the rest of it: 6 x nodes [Pa]. Unlike nodal_stress of second order at the boundary, too.
template <mesh::Cell C, class Material>
[[nodiscard]] StressField recovered_stress(const Body<C, Material>& body, const Eigen::VectorXd& u) {
  StressField cells = cell_stress(body, u);
  if constexpr (requires { body.inside().pressures(u); }) {
    for (Eigen::Index e = 0; e < cells.cols(); ++e) cells.col(e) = deviator(Symmetric<double>(cells.col(e)));
    StressField nodes = recover_at_nodes(body.mesh(), cells);
    nodes.topRows<3>().rowwise() += body.inside().pressures(u).transpose();
    return nodes;
  } else {
    return recover_at_nodes(body.mesh(), cells);
  }
}

/// J of each cell: its current volume over the one free of stress. u: 3 * nodes [m].
template <mesh::Cell C, class Material>
[[nodiscard]] Eigen::VectorXd cell_volume_ratio(const Body<C, Material>& body, const Eigen::VectorXd& u) {
  Eigen::VectorXd J(body.mesh().cell_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    double free = 0, current = 0;
    detail::for_each_point(body, e, u, [&](std::size_t, const Eigen::Matrix3d& F, double volume) {
      current += volume;
      free += volume / F.determinant();
    });
    J[e] = current / free;
  }
  return J;
}

/// |F a| of each cell, the mean over its current volume. fibres: 3 x cells, on the mesh, of any length but
/// zero; under a prestress a = F_p^-1 fibre, of unit length.
template <mesh::Cell C, class Material>
[[nodiscard]] Eigen::VectorXd cell_fibre_stretch(const Body<C, Material>& body, const Eigen::VectorXd& u,
                                                 const Points<3>& fibres) {
  TUNICA_EXPECT(fibres.cols() == body.mesh().cell_count(), "one fibre a cell");
  Eigen::VectorXd stretch(body.mesh().cell_count());
  for (Index e = 0; e < body.mesh().cell_count(); ++e) {
    const auto* const stored = body.data(e).prestress;
    double sum = 0, current = 0;
    detail::for_each_point(body, e, u, [&](std::size_t q, const Eigen::Matrix3d& F, double volume) {
      Vec3 a = fibres.col(e);
      if (stored != nullptr) a = (stored[q].inverse() * a).eval();
      sum += volume * (F * a).norm() / a.norm();
      current += volume;
    });
    stretch[e] = sum / current;
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
  fields.J = cell_volume_ratio(body, u);
  if (fibres.cols() > 0) fields.fibre_stretch = cell_fibre_stretch(body, u, fibres);
  detail::derive(fields);
  return fields;
}

/// Recovered to the nodes; what derives from the stress is that of the recovered one.
template <mesh::Cell C, class Material>
[[nodiscard]] WallFields nodal_fields(const Body<C, Material>& body, const Eigen::VectorXd& u,
                                      const Points<3>& fibres = Points<3>(3, 0)) {
  WallFields fields;
  fields.cauchy = recovered_stress(body, u);
  fields.J = recover_at_nodes(body.mesh(), cell_volume_ratio(body, u).transpose().eval()).transpose();
  if (fibres.cols() > 0)
    fields.fibre_stretch =
        recover_at_nodes(body.mesh(), cell_fibre_stretch(body, u, fibres).transpose().eval()).transpose();
  detail::derive(fields);
  return fields;
}

}  // namespace tunica::solid
