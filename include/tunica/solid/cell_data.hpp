// SPDX-License-Identifier: MIT
// What a cell brings beside its nodes: the data of its law at its points, and a stored deformation.
#pragma once

#include "tunica/core/tensor.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/material.hpp"

#include <Eigen/Core>

#include <cmath>
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

/// Directions a on a body under F (J > 0) as unit directions free of stress, F^-1 a / |F^-1 a|; zero: a
/// family that is not there. Of the axes of a frame (Frame) the first goes back so, the second as the part of
/// F^-1 a across it: they stay orthogonal.
template <bool Frame = false, class S, class FibreData>
void pull_back(const Tensor<S>& F, FibreData& fibres) {
  static_assert(!Frame || fibre_families<FibreData> == 3, "a frame has three axes");
  using std::sqrt;
  const Tensor<S> cof = cofactor(F);  // J F^-T
  Vector3<S> back[2] = {{S(0), S(0), S(0)}, {S(0), S(0), S(0)}};
  for (std::size_t family = 0; family < fibre_families<FibreData>; ++family) {
    const Vector3<S> given = fibres[family];
    Vector3<S> a;
    for (std::size_t j = 0; j < 3; ++j)
      a[j] = cof.m[j] * given[0] + cof.m[3 + j] * given[1] + cof.m[6 + j] * given[2];
    if (Frame && family == 1) {
      const S along = dot(a, back[0]);
      for (std::size_t j = 0; j < 3; ++j) a[j] -= along * back[0][j];
    }
    if (Frame && family == 2) {  // on the side where it was
      const Vector3<S>&f = back[0], &s = back[1];
      const Vector3<S> normal{f[1] * s[2] - f[2] * s[1], f[2] * s[0] - f[0] * s[2],
                              f[0] * s[1] - f[1] * s[0]};
      const S side = dot(a, normal) < S(0) ? S(-1) : S(1);
      for (std::size_t j = 0; j < 3; ++j) a[j] = side * normal[j];
    }
    const S square = dot(a, a);
    if (!(square > S(0))) continue;
    const S scale = S(1) / sqrt(square);
    for (std::size_t j = 0; j < 3; ++j) a[j] = scale * a[j];
    if (family < 2) back[family] = a;
    fibres.set(family, a);
  }
}
template <bool Frame = false, class FibreData>
void pull_back(const Eigen::Matrix3d& F_p, FibreData& fibres) {
  pull_back<Frame>(detail::tensor_of(F_p), fibres);
}

}  // namespace tunica::solid
