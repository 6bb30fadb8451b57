// SPDX-License-Identifier: MIT
// What a cell brings beside its nodes: the data of its law at its points, and a stored deformation.
#pragma once

#include "tunica/core/tensor.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/material.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cstddef>

namespace tunica::solid {

/// Both point to one entry for each quadrature point of the cell, or to nothing.
template <class Law>
struct CellData {
  const PointOf<Law, double>* points = nullptr;  // fibres and the like, in the body free of stress
  const Eigen::Matrix3d* prestress = nullptr;    // F_p: the deformation is (1 + du/dX) F_p

  template <class S>
  [[nodiscard]] PointOf<Law, S> point(std::size_t q) const {
    if (points == nullptr) return {};
    return cast_point<Law, S, double>(points[q]);
  }
};

namespace detail {

template <class S>
[[nodiscard]] Tensor<S> tensor_of(const Eigen::Matrix<S, 3, 3>& F) {
  Tensor<S> t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[static_cast<std::size_t>(3 * i + j)] = F(i, j);
  return t;
}

}  // namespace detail

/// Directions a on a body under F_p as unit directions free of stress, F_p^-1 a / |F_p^-1 a|. Of the axes of
/// a frame (Frame) the first goes back so, the second as the part of F_p^-1 a across it: they stay
/// orthogonal.
template <bool Frame = false, class FibreData>
void pull_back(const Eigen::Matrix3d& F_p, FibreData& fibres) {
  static_assert(!Frame || fibre_families<FibreData> == 3, "a frame has three axes");
  const Eigen::Matrix3d inverse = F_p.inverse();
  Eigen::Vector3d back[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t family = 0; family < fibre_families<FibreData>; ++family) {
    const auto given = fibres[family];
    Eigen::Vector3d a = inverse * Eigen::Vector3d(given[0], given[1], given[2]);
    if (Frame && family == 1) a -= a.dot(back[0]) * back[0];
    if (Frame && family == 2)  // on the side where it was
      a = (a.dot(back[0].cross(back[1])) < 0 ? -1 : 1) * back[0].cross(back[1]);
    const double length = a.norm();
    if (!(length > 0)) continue;
    a /= length;
    if (family < 2) back[family] = a;
    fibres.set(family, {a[0], a[1], a[2]});
  }
}

}  // namespace tunica::solid
