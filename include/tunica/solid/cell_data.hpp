// SPDX-License-Identifier: MIT
// What a cell brings beside its nodes: the data of its law at its points, and a stored deformation; and the
// law's answer to it in space.
#pragma once

#include "tunica/core/tensor.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/isochoric.hpp"
#include "tunica/solid/isochoric_part.hpp"

#include <Eigen/Core>

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

/// The isochoric energy, stress and response of a law at a point q of a cell; J is that of F.
template <class Law, class S>
[[nodiscard]] S energy_at(const Law& law, const CellData<Law>& data, std::size_t q,
                          const Eigen::Matrix<S, 3, 3>& F, const S& J) {
  if constexpr (needs_point<Law>)
    return energy(law, detail::tensor_of(F), data.template point<S>(q));
  else
    return isochoric_energy(law, F, J);
}

/// tau = P F^T where the law reads data at its points.
template <class Law, class S>
[[nodiscard]] Symmetric<S> stress_at(const Law& law, const CellData<Law>& data, std::size_t q,
                                     const Eigen::Matrix<S, 3, 3>& F, const S& J) {
  if constexpr (needs_point<Law>) {
    const Tensor<S> P = stress(law, detail::tensor_of(F), data.template point<S>(q));
    Symmetric<S> tau;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = symmetric_pairs[k];
      S sum(0);
      for (int J_ = 0; J_ < 3; ++J_) sum += P.m[static_cast<std::size_t>(3 * i + J_)] * F(j, J_);
      tau[static_cast<int>(k)] = sum;
    }
    return tau;
  } else {
    return isochoric_stress(law, F, J);
  }
}

/// c_ijkl = F_jJ F_lL dP_iJ/dF_kL - d_ik tau_jl there.
template <class Law, class S>
[[nodiscard]] SpatialResponse<S> response_at(const Law& law, const CellData<Law>& data, std::size_t q,
                                             const Eigen::Matrix<S, 3, 3>& F, const S& J) {
  if constexpr (needs_point<Law>) {
    const auto [P, A] = response(law, detail::tensor_of(F), data.template point<S>(q));
    SpatialResponse<S> r;
    const auto at = [](int a, int b) { return static_cast<std::size_t>(3 * a + b); };
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = symmetric_pairs[k];
      r.tau[static_cast<int>(k)] =
          P.m[at(i, 0)] * F(j, 0) + P.m[at(i, 1)] * F(j, 1) + P.m[at(i, 2)] * F(j, 2);
    }
    for (std::size_t a = 0; a < 6; ++a) {
      const auto [i, j] = symmetric_pairs[a];
      Eigen::Matrix<S, 3, 3> half;  // F_jJ A_iJkL
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L)
          half(k, L) = A[9 * at(i, 0) + at(k, L)] * F(j, 0) + A[9 * at(i, 1) + at(k, L)] * F(j, 1) +
                       A[9 * at(i, 2) + at(k, L)] * F(j, 2);
      for (std::size_t b = a; b < 6; ++b) {
        const auto [k, l] = symmetric_pairs[b];
        S c = half(k, 0) * F(l, 0) + half(k, 1) * F(l, 1) + half(k, 2) * F(l, 2);
        if (i == k) c -= r.tau[symmetric_index[static_cast<std::size_t>(j)][static_cast<std::size_t>(l)]];
        r.modulus(static_cast<int>(a), static_cast<int>(b)) = c;
        r.modulus(static_cast<int>(b), static_cast<int>(a)) = c;
      }
    }
    return r;
  } else {
    return isochoric_response(law, F, J);
  }
}

}  // namespace tunica::solid
