// SPDX-License-Identifier: MIT
// Single cells in the plane and in space, distorted and deformed, each lane of a pack in its own way.
#pragma once

#include "tunica/core/pack.hpp"
#include "tunica/fem/shape.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/quadratic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::test {

/// Nodes of a simplex, or of a square, cube or prism of side 1.
template <class C>
std::array<std::array<double, C::dim>, C::nodes> unit_cell() {
  std::array<std::array<double, C::dim>, C::nodes> x{};
  const auto mean = [&](std::size_t to, const auto& of, std::size_t count) {
    for (std::size_t i = 0; i < C::dim; ++i) {
      x[to][i] = 0;
      for (std::size_t k = 0; k < count; ++k)
        x[to][i] += x[static_cast<std::size_t>(of[k])][i] / static_cast<double>(count);
    }
  };
  if constexpr (mesh::Quadratic<C>) {
    const auto corners = unit_cell<typename C::Linear>();
    std::copy(corners.begin(), corners.end(), x.begin());
    for (const auto& e : C::edges) mean(static_cast<std::size_t>(e[2]), e, 2);
    for (std::size_t f = 0; f < C::face_centres.size(); ++f)
      mean(static_cast<std::size_t>(C::face_centres[f]), C::Linear::faces[f], C::Linear::faces[f].size());
    if constexpr (C::nodes == 27) {
      std::array<int, 8> all{0, 1, 2, 3, 4, 5, 6, 7};
      mean(C::nodes - 1, all, all.size());
    }
  } else if constexpr (C::nodes == C::dim + 1) {
    for (std::size_t i = 0; i < C::dim; ++i) x[i + 1][i] = 1;
  } else if constexpr (C::nodes == 6) {
    for (std::size_t k = 0; k < 2; ++k) {
      x[3 * k + 1][0] = x[3 * k + 2][1] = 1;
      for (std::size_t a = 0; a < 3; ++a) x[3 * k + a][2] = static_cast<double>(k);
    }
  } else {
    for (std::size_t a = 0; a < C::nodes; ++a)
      for (std::size_t i = 0; i < C::dim; ++i)
        x[a][i] = 0.5 * (fem::detail::corners<C::dim, C::nodes>[a][i] + 1);
  }
  return x;
}

/// X distorted by some 4 % of the cell, u of strains up to 0.2, v a direction; another in every lane and for
/// every `seed`.
template <class C, class S>
struct DeformedCell {
  S X[C::nodes][C::dim], u[C::nodes][C::dim], v[C::nodes][C::dim];

  explicit DeformedCell(double seed = 0) {
    const auto x = unit_cell<C>();
    for (int a = 0; a < C::nodes; ++a)
      for (int i = 0; i < C::dim; ++i) {
        const auto wave = [&](double k, int lane) { return std::sin(k * a + 2.1 * i + 0.7 * lane + seed); };
        const double at = x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
        set(X[a][i], [&](int lane) { return at + 0.04 * wave(1.3, lane); });
        set(u[a][i], [&](int lane) { return 0.1 * at * wave(0, lane) + 0.04 * wave(2.3, lane); });
        set(v[a][i], [&](int lane) { return wave(3.1, lane); });
      }
  }

 private:
  template <class F>
  static void set(S& to, F f) {
    if constexpr (Lanes<S>::count > 1)
      to = S::generate(f);
    else
      to = S(f(0));
  }
};

}  // namespace tunica::test
