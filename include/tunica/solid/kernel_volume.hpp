// SPDX-License-Identifier: MIT
// The dilatation of an element in a kernel: one mean, or modes linear in the reference, with their pressures.
// What is summed is J - 1, so that theta - 1 does not hold the roundings of a sum of volumes.
#pragma once

#include "tunica/solid/element.hpp"
#include "tunica/solid/locking.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::solid {

/// The one mode of MeanVolume, phi = 1.
template <mesh::Cell C, class Rule, class S>
struct ConstantMode {
  using Nodal = NodeVectors<S, C>;
  using Pressures = std::array<S, 1>;

  TUNICA_INLINE ConstantMode(const Nodal&, const Tensor<S>*) {}

  /// w phi_i at a point.
  [[nodiscard]] TUNICA_INLINE S times(const S& w, std::size_t, std::size_t) const { return w; }
  /// sum_i p_i phi_i at a point.
  [[nodiscard]] TUNICA_INLINE S at(const Pressures& p, std::size_t) const { return p[0]; }

  /// theta from int phi_i (J - 1) dV, and p and `bulk` from theta.
  template <class U, class Kept>
  TUNICA_INLINE void close(const U& law, Kept& out) const {
    out.theta[0] = S(1) + out.theta[0] / out.volume;
    out.p[0] = law.slope(out.theta[0]);
    out.bulk[0][0] = law.curvature(out.theta[0]);
  }
  /// int U(theta) dV of int phi_i (J - 1) dV.
  template <class U>
  [[nodiscard]] S energy(const U& law, const Pressures& growth, const S& volume) const {
    return volume * law.energy(S(1) + growth[0] / volume);
  }
  /// p at x = X + u, before the points are visited.
  template <class U>
  [[nodiscard]] TUNICA_INLINE Pressures pressures(const U& law, const Nodal& X, const Nodal& x,
                                                  const Tensor<S>* stored) const {
    S volume(0), growth(0);
    for (std::size_t q = 0; q < Rule::size; ++q) {
      S free = map_determinant<C, Rule, S>(X, q);
      if (stored) free = free / determinant(stored[q]);
      volume += S(Rule::weights[q]) * free;
      growth += S(Rule::weights[q]) * (map_determinant<C, Rule, S>(x, q) - free);
    }
    return {law.slope(S(1) + growth / volume)};
  }
};

/// The modes of LinearVolume: 1 and the coordinates X of the reference, made orthonormal in the order of the
/// axes of the cell, which keeps them well scaled on flat cells; volumes are those of the body free of
/// stress.
template <mesh::Cell C, class Rule, class S>
struct LinearModes {
  static constexpr std::size_t count = C::dim + 1, points = Rule::size;
  static_assert(Rule::size > 1 << C::dim, "a linear pressure wants cells and rules of the second degree");
  using Nodal = NodeVectors<S, C>;
  using Pressures = std::array<S, count>;
  S value[points][count], weight[points], volume;

  LinearModes(const Nodal& X, const Tensor<S>* stored) : volume(0) {
    using Centre = fem::Tables<fem::Lagrange<C>, fem::Gauss<C, 1>>;
    S det;
    const auto to_local = detail::adjugate(detail::local_gradient<C>(X, Centre::gradients[0]), det);
    const S scale = S(1) / det;
    for (std::size_t q = 0; q < points; ++q) {
      weight[q] = map_determinant<C, Rule, S>(X, q) * S(Rule::weights[q]);
      if (stored) weight[q] = weight[q] / determinant(stored[q]);
      volume += weight[q];
      S x[C::dim];  // X - X_0
      for (int i = 0; i < C::dim; ++i) {
        x[i] = S(0);
        for (std::size_t a = 0; a < C::nodes; ++a)
          x[i] += S(Values::values[q][a] - Centre::values[0][a]) * X[a][i];
      }
      value[q][0] = S(1);
      for (std::size_t k = 1; k < count; ++k) {
        S sum(0);
        for (int i = 0; i < C::dim; ++i) sum += to_local.m[k - 1][i] * x[i];
        value[q][k] = scale * sum;
      }
    }
    for (std::size_t k = 1; k < count; ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        const S part = mean(k, j);
        for (auto& v : value) v[k] -= part * v[j];
      }
      using std::sqrt;
      const S length = S(1) / sqrt(mean(k, k));
      for (auto& v : value) v[k] *= length;
    }
  }

  [[nodiscard]] TUNICA_INLINE S times(const S& w, std::size_t q, std::size_t i) const {
    return i == 0 ? w : w * value[q][i];
  }
  [[nodiscard]] TUNICA_INLINE S at(const Pressures& p, std::size_t q) const {
    S sum = p[0];
    for (std::size_t i = 1; i < count; ++i) sum += p[i] * value[q][i];
    return sum;
  }
  template <class U, class Kept>
  void close(const U& law, Kept& out) const {
    const S share = S(1) / volume;
    for (auto& theta : out.theta) theta *= share;
    out.theta[0] += S(1);
    out.p = projected(law, out.theta);
    for (auto& row : out.bulk) row.fill(S(0));
    for (std::size_t q = 0; q < points; ++q) {
      const S curvature = share * weight[q] * law.curvature(at(out.theta, q));
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j <= i; ++j) out.bulk[i][j] += times(curvature, q, i) * value[q][j];
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j) out.bulk[j][i] = out.bulk[i][j];
  }
  template <class U>
  [[nodiscard]] S energy(const U& law, Pressures theta, const S&) const {
    for (auto& t : theta) t *= S(1) / volume;
    theta[0] += S(1);
    S sum(0);
    for (std::size_t q = 0; q < points; ++q) sum += weight[q] * law.energy(at(theta, q));
    return sum;
  }
  template <class U>
  [[nodiscard]] Pressures pressures(const U& law, const Nodal&, const Nodal& x, const Tensor<S>*) const {
    Pressures theta;
    theta.fill(S(0));
    const S share = S(1) / volume;
    for (std::size_t q = 0; q < points; ++q) {
      const S growth = share * (map_determinant<C, Rule, S>(x, q) * S(Rule::weights[q]) - weight[q]);
      for (std::size_t i = 0; i < count; ++i) theta[i] += times(growth, q, i);
    }
    theta[0] += S(1);
    return projected(law, theta);
  }

 private:
  using Values = fem::Tables<fem::Lagrange<C>, Rule>;

  [[nodiscard]] S mean(std::size_t i, std::size_t j) const {
    S sum(0);
    for (std::size_t q = 0; q < points; ++q) sum += weight[q] * value[q][i] * value[q][j];
    return sum / volume;
  }
  /// p_i = 1/V int phi_i U'(theta) dV
  template <class U>
  [[nodiscard]] Pressures projected(const U& law, const Pressures& theta) const {
    Pressures p;
    p.fill(S(0));
    for (std::size_t q = 0; q < points; ++q) {
      const S slope = weight[q] / volume * law.slope(at(theta, q));
      for (std::size_t i = 0; i < count; ++i) p[i] += times(slope, q, i);
    }
    return p;
  }
};

}  // namespace tunica::solid
