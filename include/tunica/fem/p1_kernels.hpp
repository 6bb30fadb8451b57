// SPDX-License-Identifier: MIT
// Linear tetrahedra assembled in packs: Laplacian, mass and convection-diffusion, integrated exactly.
#pragma once

#include "tunica/core/pack.hpp"
#include "tunica/fem/block_assembly.hpp"

#include <atomic>

namespace tunica::fem {

/// Geometry of a tetrahedron, or of one a lane: c[a] = 6 V grad N_a [m2], six_volume = 6 V [m3].
template <class S>
struct P1Map {
  S c[4][3];
  S six_volume;
};

template <class S>
[[nodiscard]] TUNICA_INLINE P1Map<S> p1_map(const S (&x)[4][3]) {
  S e[3][3];  // edges from node 0
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) e[k][i] = x[k + 1][i] - x[0][i];
  P1Map<S> m;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3, p = (k + 1) % 3, q = (k + 2) % 3;
      m.c[k + 1][i] = e[p][j] * e[q][l] - e[p][l] * e[q][j];  // c_1 = e_1 x e_2, cyclic
    }
  for (int i = 0; i < 3; ++i) m.c[0][i] = -(m.c[1][i] + m.c[2][i] + m.c[3][i]);
  m.six_volume = e[0][0] * m.c[1][0] + e[0][1] * m.c[1][1] + e[0][2] * m.c[1][2];
  return m;
}

/// int grad N_a . grad N_b = c_a . c_b / (6 6V) for a <= b, in the order of BlockAssembly::pair [m].
template <class S>
TUNICA_INLINE void p1_laplacian(const P1Map<S>& m, const S& factor, S (&K)[10][1]) {
  const S scale = factor / (6 * m.six_volume);
  const auto product = [&](int a, int b) {
    return scale * (m.c[a][0] * m.c[b][0] + m.c[a][1] * m.c[b][1] + m.c[a][2] * m.c[b][2]);
  };
  K[4][0] = product(1, 1), K[5][0] = product(1, 2), K[6][0] = product(1, 3);
  K[7][0] = product(2, 2), K[8][0] = product(2, 3), K[9][0] = product(3, 3);
  K[1][0] = -(K[4][0] + K[5][0] + K[6][0]);  // rows sum to zero
  K[2][0] = -(K[5][0] + K[7][0] + K[8][0]);
  K[3][0] = -(K[6][0] + K[8][0] + K[9][0]);
  K[0][0] = -(K[1][0] + K[2][0] + K[3][0]);
}

/// viscosity int grad N_a . grad N_b + int N_a w . grad N_b, the second by
/// int N_a w = V/20 (w_a + sum_c w_c): exact for a linear w [m/s], one column a node.
template <class S>
TUNICA_INLINE void p1_convection_diffusion(const P1Map<S>& m, const S& viscosity, const S (&w)[4][3],
                                           S (&K)[16][1]) {
  const S scale = viscosity / (6 * m.six_volume);
  S d[4][3];  // viscosity grad N_a V, and below the mean velocity
  S mean[3];
  for (int i = 0; i < 3; ++i) mean[i] = w[0][i] + w[1][i] + w[2][i] + w[3][i];
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i) d[a][i] = scale * m.c[a][i] + (mean[i] + w[a][i]) * (1. / 120);
  for (int a = 0; a < 4; ++a) {
    for (int b = 1; b < 4; ++b)
      K[4 * a + b][0] = d[a][0] * m.c[b][0] + d[a][1] * m.c[b][1] + d[a][2] * m.c[b][2];
    K[4 * a][0] = -(K[4 * a + 1][0] + K[4 * a + 2][0] + K[4 * a + 3][0]);
  }
}

using P1Assembly = BlockAssembly<mesh::Tet4, 1>;

namespace detail {

/// kernel(pack, map) for all tetrahedra; the first one whose volume is not positive, or -1.
template <class S, class Kernel>
[[nodiscard]] Index p1_assemble(const P1Assembly& assembly, const Points<3>& x, Kernel&& kernel) {
  std::atomic<bool> sound{true};
  assembly.for_each_pack<Lanes<S>::count>([&](const auto& pack) {  // rows are short: nothing to fetch ahead
    S corner[4][3];
    assembly.gather(pack, x, corner);
    const P1Map<S> map = p1_map(corner);
    if constexpr (Lanes<S>::count == 1) {
      if (!(map.six_volume > 0)) sound.store(false, std::memory_order_relaxed);
    } else if (!all(map.six_volume > S(0))) {
      sound.store(false, std::memory_order_relaxed);
    }
    kernel(pack, map);
  });
  if (sound) return -1;
  const auto& cells = assembly.cells();
  for (Index e = 0; e < static_cast<Index>(cells.cols()); ++e) {
    double corner[4][3];
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 3; ++i) corner[a][i] = x(i, cells(a, e));
    if (!(p1_map(corner).six_volume > 0)) return e;
  }
  return -1;
}

}  // namespace detail

/// A += factor int grad N_a . grad N_b; x: 3 x nodes [m]. The first cell whose volume is not positive, or -1;
/// A is of no use when there is one. S is the scalar of the kernel: double or a pack.
template <class S = Pack<double>, class Matrix>
[[nodiscard]] Index add_laplacian(const P1Assembly& assembly, const Points<3>& x, double factor, Matrix& A) {
  return detail::p1_assemble<S>(assembly, x, [&](const auto& pack, const P1Map<S>& map) {
    S K[10][1];
    p1_laplacian(map, S(factor), K);
    assembly.add_symmetric(pack, K, A);
  });
}

/// A += viscosity int grad N_a . grad N_b + int N_a w . grad N_b for w linear on each cell, integrated
/// exactly; velocity: 3 x nodes [m/s], viscosity [m2/s]. A holds both triangles. Returns as add_laplacian.
template <class S = Pack<double>, class Matrix>
[[nodiscard]] Index add_convection_diffusion(const P1Assembly& assembly, const Points<3>& x, double viscosity,
                                             const Points<3>& velocity, Matrix& A) {
  return detail::p1_assemble<S>(assembly, x, [&](const auto& pack, const P1Map<S>& map) {
    S w[4][3], K[16][1];
    assembly.gather(pack, velocity, w);
    p1_convection_diffusion(map, S(viscosity), w, K);
    assembly.add(pack, K, A);
  });
}

}  // namespace tunica::fem
