// SPDX-License-Identifier: MIT
// What the element kernels of solids cost, beside the peak of the core and a plain kernel, in any build.
#pragma once

#include "support/fma_peak.hpp"
#include "support/plain_eigen_kernel.hpp"
#include "support/stopwatch.hpp"
#include "tunica/core/counted.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/fem/block_assembly.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/kernel.hpp"
#include "tunica/solid/volumetric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

namespace tunica::bench {

struct KernelTime {
  double peak = 0;                                // [GFLOP/s]
  double hex = 0, hex_flops = 0;                  // any law [M elements/s], flop an element
  double closed = 0, closed_flops = 0;            // the shortcut of three terms
  double plain = 0;                               // B^T D B with Eigen
  double tet = 0, tet_flops = 0;                  // Tet10, any law
  double fibres = 0, fibre_flops = 0;             // Hex8, two families, mean volume
  double single = 0;                              // Hex8, any law, packs of floats
  double action = 0;                              // Hex8, any law, K v without K
  double off = 0, off_duals = 0, off_single = 0;  // of the largest entry: to Eigen's; K v to that of duals
  double assembled = 0, work = 0, stiffness = 0;  // [M elements/s], u . f and u . K u of the cube
};

inline constexpr int kernel_side = 40;                        // elements along an edge of the cube
inline constexpr double cube_mu = 80e3, cube_lambda = 120e3;  // [Pa]

/// The displacement of the cube, also that of bench/peers/hyperelastic.py.
[[nodiscard]] inline Vec3 cube_displacement(const Vec3& x) {
  return {0.1 * x[0] * x[1] + 0.05 * x[2], 0.08 * x[1] * x[2], -0.06 * x[0] * x[2]};
}

/// A law seen through P and A alone.
struct AnyLaw {
  solid::CompressibleNeoHooke law;
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return law.stress(F);
  }
  template <class S>
  [[nodiscard]] solid::Response<S> response(const Tensor<S>& F) const {
    return law.response(F);
  }
};

namespace kernel_detail {

using Hex = solid::Kernel<mesh::Hex8>;
using Fibre = solid::Kernel<mesh::Hex8, solid::MeanVolume>;
using Tet = solid::Kernel<mesh::Tet10>;
inline constexpr solid::CompressibleNeoHooke neo_hooke{.mu = cube_mu, .lambda = cube_lambda};
inline constexpr AnyLaw any_law{neo_hooke};
inline const solid::Hyperelastic wall{solid::HolzapfelGasserOgden{.c = 3e3, .k1 = 2.3632e3, .k2 = .8393},
                                      solid::Quadratic{.kappa = 3e5}};

/// Packs of distorted elements, every lane another.
template <class K, class S>
struct Elements {
  static constexpr int count = 32;
  typename K::template Nodal<S> X[count], u[count];

  Elements() {
    std::array<std::array<double, 3>, K::nodes> x{};
    if constexpr (K::nodes == 8) {
      for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t i = 0; i < 3; ++i) x[a][i] = 0.5 * (fem::detail::corners<3, 8>[a][i] + 1);
    } else {
      for (std::size_t i = 0; i < 3; ++i) x[i + 1][i] = 1;
      for (const auto& e : K::Cell::edges)
        for (std::size_t i = 0; i < 3; ++i)
          x[static_cast<std::size_t>(e[2])][i] =
              0.5 * (x[static_cast<std::size_t>(e[0])][i] + x[static_cast<std::size_t>(e[1])][i]);
    }
    for (int e = 0; e < count; ++e)
      for (int a = 0; a < K::nodes; ++a)
        for (int i = 0; i < 3; ++i) {
          const auto wave = [&](double k, int lane) {
            return std::sin(k * a + 2.1 * i + 0.7 * (lane + 8 * e));
          };
          const double at = x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
          set(X[e][a][i], [&](int lane) { return at + 0.04 * wave(1.3, lane); });
          set(u[e][a][i], [&](int lane) { return 0.1 * at * wave(0, lane) + 0.03 * wave(2.3, lane); });
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

/// Two families at +-30 degrees, at every point.
template <class Law, class S, int Points>
[[nodiscard]] std::array<solid::PointOf<Law, S>, Points> fibre_data() {
  std::array<solid::PointOf<Law, S>, Points> data;
  if constexpr (solid::needs_point<Law>)
    for (auto& point : data)
      for (std::size_t k = 0; k < 2; ++k)
        point.set(k, {S(std::cos(0.5)), S(k == 0 ? std::sin(0.5) : -std::sin(0.5)), S(0)});
  return data;
}

/// kernel(e, data, tangent) over all packs [M elements/s].
template <class K, class S, class Law, class Work>
[[nodiscard]] double rate(const Law&, Work&& work) {
  const auto elements = std::make_unique<Elements<K, S>>();
  const auto data = fibre_data<Law, S, K::points>();
  const auto out = std::make_unique<typename K::template Tangent<S>>();
  constexpr int repeats = 30;
  const double seconds = best_cpu_seconds(9, [&] {
    for (int r = 0; r < repeats; ++r)
      for (int e = 0; e < elements->count; ++e) {
        work(elements->X[e], elements->u[e], data.data(), *out);
        asm volatile("" : : "r"(out.get()) : "memory");  // each result is used
      }
  });
  return 1e-6 * repeats * elements->count * Lanes<S>::count / seconds;
}
template <class K, class S, class Law>
[[nodiscard]] double tangent_rate(const Law& law) {
  return rate<K, S>(law, [&](const auto& X, const auto& u, const auto* data, auto& out) {
    K::tangent(law, X, u, data, out);
  });
}
template <class K, class Law>
[[nodiscard]] double flops(const Law& law) {
  const auto elements = std::make_unique<Elements<K, Counted>>();
  const auto data = fibre_data<Law, Counted, K::points>();
  const auto out = std::make_unique<typename K::template Tangent<Counted>>();
  Counted::count() = {};
  K::tangent(law, elements->X[0], elements->u[0], data.data(), *out);
  return static_cast<double>(Counted::count().total());
}

using PlainNodes = Eigen::Matrix<double, 3, 8>;

inline double plain_rate() {
  const auto elements = std::make_unique<Elements<Hex, double>>();
  PlainNodes X[8], u[8];
  for (int e = 0; e < 8; ++e)
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) X[e](i, a) = elements->X[e][a][i], u[e](i, a) = elements->u[e][a][i];
  Eigen::Matrix<double, 24, 1> f;
  Eigen::Matrix<double, 24, 24> K;
  constexpr int repeats = 40;
  const double seconds = best_cpu_seconds(9, [&] {
    for (int r = 0; r < repeats; ++r)
      for (int e = 0; e < 8; ++e) {
        plain_eigen_kernel(cube_mu, cube_lambda, X[e], u[e], f, K);
        asm volatile("" : : "r"(K.data()), "r"(f.data()) : "memory");
      }
  });
  return 1e-6 * repeats * 8 / seconds;
}

/// Every lane of a pack's tangent and forces to those of Eigen, of the largest entry.
template <class S, class Law>
[[nodiscard]] double off_plain(const Law& law) {
  const auto elements = std::make_unique<Elements<Hex, S>>();
  const auto out = std::make_unique<Hex::Tangent<S>>();
  Hex::tangent(law, elements->X[0], elements->u[0], nullptr, *out);
  double worst = 0;
  for (int l = 0; l < Lanes<S>::count; ++l) {
    PlainNodes X, u;
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        X(i, a) = static_cast<double>(elements->X[0][a][i][l]),
             u(i, a) = static_cast<double>(elements->u[0][a][i][l]);
    Eigen::Matrix<double, 24, 1> f;
    Eigen::Matrix<double, 24, 24> K;
    plain_eigen_kernel(cube_mu, cube_lambda, X, u, f, K);
    const double scale = K.cwiseAbs().maxCoeff();
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(out->f[a][i][l]) - f[3 * a + i]) / scale);
        for (int b = a; b < 8; ++b)
          for (int k = 0; k < 3; ++k)
            worst =
                std::max(worst, std::abs(static_cast<double>(out->K[Hex::Places::place(a, b)][3 * i + k][l]) -
                                         K(3 * a + i, 3 * b + k)) /
                                    scale);
      }
  }
  return worst;
}

/// K v to the derivative of the forces along v = X by duals, of the largest component.
template <class K, class Law>
[[nodiscard]] double off_duals(const Law& law) {
  using D = Dual<double, 1>;
  const auto elements = std::make_unique<Elements<K, double>>();
  const auto data = fibre_data<Law, double, K::points>();
  const auto dual_data = fibre_data<Law, D, K::points>();
  const auto& X = elements->X[0];
  typename K::template Nodal<D> Xd, ud;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < 3; ++i) Xd[a][i] = X[a][i], ud[a][i] = elements->u[0][a][i], ud[a][i].d[0] = X[a][i];
  typename K::template Tangent<double> t;
  typename K::template Forces<D> f;
  K::tangent(law, X, elements->u[0], data.data(), t);
  K::forces(law, Xd, ud, dual_data.data(), f);
  double worst = 0, scale = 0;
  for (int a = 0; a < K::nodes; ++a)
    for (int i = 0; i < 3; ++i) {
      double product = 0;
      for (int b = 0; b < K::nodes; ++b)
        for (int k = 0; k < 3; ++k)
          product += X[b][k] * (a <= b ? t.K[K::Places::place(a, b)][3 * i + k]
                                       : t.K[K::Places::place(b, a)][3 * k + i]);
      worst = std::max(worst, std::abs(product - f.f[a][i].d[0]));
      scale = std::max(scale, std::abs(f.f[a][i].d[0]));
    }
  return worst / scale;
}

/// Forces and tangent of a cube in block rows, upper triangle, zeroing included.
inline void assemble_cube(KernelTime& t) {
  using S = Pack<double>;
  const auto mesh = meshing::box_hexes(kernel_side);
  const fem::BlockAssembly<mesh::Hex8, 3> assembly(mesh, la::BlockStorage::upper);
  Eigen::VectorXd u(assembly.unknowns()), f(assembly.unknowns()), Ku;
  for (Index n = 0; n < mesh.node_count(); ++n) u.segment<3>(3 * n) = cube_displacement(mesh.nodes.col(n));
  auto K = assembly.matrix();
  const double seconds = best_cpu_seconds(7, [&] {
    K.set_zero();
    f.setZero();
    assembly.for_each_pack<Lanes<S>::count>(K, [&](const auto& pack) {
      S X[8][3], ue[8][3];
      Hex::Tangent<S> out;
      assembly.gather(pack, mesh.nodes, X);
      assembly.gather(pack, u, ue);
      Hex::tangent(neo_hooke, X, ue, nullptr, out);
      assembly.add_symmetric(pack, out.K, K);
      assembly.add(pack, out.f, f);
    });
  });
  t.assembled = 1e-6 * mesh.cell_count() / seconds;
  K.apply(u, Ku);
  t.work = u.dot(f);
  t.stiffness = u.dot(Ku);
}

}  // namespace kernel_detail

[[nodiscard]] inline KernelTime kernel_time() {
  using namespace kernel_detail;
  using S = Pack<double>;
  KernelTime t;
  t.peak = fma_peak();
  t.hex = tangent_rate<Hex, S>(any_law), t.hex_flops = flops<Hex>(any_law);
  t.closed = tangent_rate<Hex, S>(neo_hooke), t.closed_flops = flops<Hex>(neo_hooke);
  t.plain = plain_rate();
  t.tet = tangent_rate<Tet, S>(any_law), t.tet_flops = flops<Tet>(any_law);
  t.fibres = tangent_rate<Fibre, S>(wall), t.fibre_flops = flops<Fibre>(wall);
  t.single = tangent_rate<Hex, Pack<float>>(any_law);
  t.action = rate<Hex, S>(any_law, [](const auto& X, const auto& u, const auto* data, auto& out) {
    Hex::action(any_law, X, u, data, X, out.f);
  });
  t.peak = std::max(t.peak, fma_peak());  // the machine may have been busy the first time
  t.off = std::max(off_plain<S>(any_law), off_plain<S>(neo_hooke));
  t.off_single = off_plain<Pack<float>>(any_law);
  t.off_duals = std::max({off_duals<Hex>(any_law), off_duals<Tet>(any_law), off_duals<Fibre>(wall)});
  assemble_cube(t);
  return t;
}

}  // namespace tunica::bench
