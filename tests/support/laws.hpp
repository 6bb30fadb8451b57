// SPDX-License-Identifier: MIT
// States of deformation, and the checks that every law of solid takes: duals, differences, frames, symmetry.
#pragma once

#include "tunica/solid/fibres.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::test {

/// About x by a, then about z by b [rad].
inline Tensor<double> rotation(double a, double b) {
  const Tensor<double> x{.m = {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)}};
  const Tensor<double> z{.m = {std::cos(b), -std::sin(b), 0, std::sin(b), std::cos(b), 0, 0, 0, 1}};
  return product(z, x);
}

/// General; strong shear; compression; a stretch turned by 130 degrees and more; next to the reference.
inline const std::array<Tensor<double>, 5> states{
    {{.m = {1.2, .3, -.1, .2, .9, .15, -.05, .1, 1.1}},
     {.m = {1, 1.8, 0, 0, 1, 0, 0, .4, 1}},
     {.m = {.6, 0, .05, 0, .8, 0, -.1, 0, .7}},
     product(rotation(1.1, 2.3), Tensor<double>{.m = {1.3, 0, 0, 0, 1 / 1.3, 0, 0, 0, 1}}),
     {.m = {1 + 1e-3, 2e-4, 0, 0, 1 - 5e-4, 1e-4, -3e-4, 0, 1}}}};

/// Two families at +-angle [rad] from x in the plane x-y.
inline solid::Fibres<double, 2> crossed(double angle) {
  solid::Fibres<double, 2> f;
  f.set(0, {std::cos(angle), std::sin(angle), 0});
  f.set(1, {std::cos(angle), -std::sin(angle), 0});
  return f;
}

/// A frame: the columns of a rotation.
inline solid::Fibres<double, 3> frame(double a, double b) {
  const Tensor<double> q = rotation(a, b);
  solid::Fibres<double, 3> f;
  for (std::size_t k = 0; k < 3; ++k) f.set(k, {q.m[k], q.m[k + 3], q.m[k + 6]});
  return f;
}

/// Another law's energy and nothing else: what duals make of it is right by construction.
template <class Law>
struct EnergyAlone {
  Law law;
  template <class S>
  using Point = solid::PointOf<Law, S>;

  template <class S>
  requires(!solid::needs_point<Law>) S energy(const Tensor<S>& F)
  const { return solid::energy(law, F); }
  template <class S>
  S energy(const Tensor<S>& F, const Point<S>& point) const {
    return solid::energy(law, F, point);
  }
};

struct LawErrors {
  double duals = 0;        // P and A against nested duals, of the largest entry of A
  double differences = 0;  // A against central differences of P
  double frame = 0;        // W(QF) - W(F), P(QF) - Q P(F) and A likewise
  double symmetry = 0;     // A_pq - A_qp, and P F^T against its transpose
};

inline double largest(const std::array<double, 81>& A) {
  double most = 0;
  for (const double a : A) most = std::max(most, std::abs(a));
  return most;
}

/// The worst of the five states.
template <class Law>
LawErrors errors_of(const Law& law, const solid::PointOf<Law, double>& point = {}) {
  LawErrors worst;
  const Tensor<double> Q = rotation(0.7, -1.9);
  for (const auto& F : states) {
    const auto own = solid::response(law, F, point);
    const auto P = solid::stress(law, F, point);
    const auto dual = solid::dual_response(EnergyAlone<Law>{law}, F, point);
    const double scale = largest(dual.A);
    const auto keep = [&](double& to, double error) { to = error / scale <= to ? to : error / scale; };
    for (std::size_t p = 0; p < 9; ++p) {
      keep(worst.duals, std::abs(own.P.m[p] - dual.P.m[p]));
      keep(worst.duals, std::abs(P.m[p] - dual.P.m[p]));
      for (std::size_t q = 0; q < 9; ++q) {
        keep(worst.duals, std::abs(own.A[9 * p + q] - dual.A[9 * p + q]));
        keep(worst.symmetry, std::abs(own.A[9 * p + q] - own.A[9 * q + p]));
      }
    }
    constexpr double h = 1e-6;
    for (std::size_t q = 0; q < 9; ++q) {
      Tensor<double> more = F, less = F;
      more.m[q] += h, less.m[q] -= h;
      const auto d = solid::stress(law, more, point) - solid::stress(law, less, point);
      for (std::size_t p = 0; p < 9; ++p)
        keep(worst.differences, std::abs(d.m[p] / (2 * h) - own.A[9 * p + q]));
    }
    const Tensor<double> QF = product(Q, F), QP = product(Q, own.P);
    const auto turned = solid::response(law, QF, point);
    keep(worst.frame, std::abs(solid::energy(law, QF, point) - solid::energy(law, F, point)));
    for (std::size_t p = 0; p < 9; ++p) keep(worst.frame, std::abs(turned.P.m[p] - QP.m[p]));
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int J = 0; J < 3; ++J)
          for (int L = 0; L < 3; ++L) {
            double A = 0;
            for (int m = 0; m < 3; ++m)
              for (int n = 0; n < 3; ++n)
                A += Q(i, m) * Q(k, n) * own.A[static_cast<std::size_t>(9 * (3 * m + J) + 3 * n + L)];
            keep(worst.frame, std::abs(A - turned.A[static_cast<std::size_t>(9 * (3 * i + J) + 3 * k + L)]));
          }
    const Tensor<double> tau = product(own.P, transpose(F));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) keep(worst.symmetry, std::abs(tau(i, j) - tau(j, i)));
  }
  return worst;
}

/// P F^T / J [Pa]
inline Tensor<double> cauchy(const Tensor<double>& P, const Tensor<double>& F) {
  return (1 / determinant(F)) * product(P, transpose(F));
}

}  // namespace tunica::test
