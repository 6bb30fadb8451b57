// SPDX-License-Identifier: MIT
#include "tunica/solid/kernel.hpp"
#include "tunica/core/counted.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <type_traits>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// Nodes of the reference cell, or of a cube or prism of side 1.
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
    if constexpr (C::nodes == 27 || C::nodes == 9) {
      std::array<int, C::Linear::nodes> all{};
      for (std::size_t a = 0; a < all.size(); ++a) all[a] = static_cast<int>(a);
      mean(C::nodes - 1, all, all.size());
    }
  } else if constexpr (C::nodes == C::dim + 1) {
    for (std::size_t i = 0; i < C::dim; ++i) x[i + 1][i] = 1;
  } else if constexpr (C::nodes == 6) {
    for (std::size_t k = 0; k < 2; ++k)
      x[3 * k + 1][0] = x[3 * k + 2][1] = 1,
                x[3 * k][2] = x[3 * k + 1][2] = x[3 * k + 2][2] = static_cast<double>(k);
  } else {
    for (std::size_t a = 0; a < C::nodes; ++a)
      for (std::size_t i = 0; i < C::dim; ++i)
        x[a][i] = 0.5 * (fem::detail::corners<C::dim, C::nodes>[a][i] + 1);
  }
  return x;
}

/// Distorted cells under large displacements, another in every lane and for every `seed`.
template <class K, class S>
struct State {
  typename K::template Nodal<S> X, u, v;

  explicit State(double seed = 0) {
    using C = typename K::Cell;
    const auto x = unit_cell<C>();
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i) {
        const auto wave = [&](double k, int lane) { return std::sin(k * a + 2.1 * i + 0.7 * lane + seed); };
        const double at = x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
        set(X[a][i], [&](int lane) { return at + 0.04 * wave(1.3, lane); });
        set(u[a][i], [&](int lane) { return 0.1 * at * wave(0, lane) + 0.05 * wave(2.3, lane); });
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

/// Two fibres that turn from point to point.
template <class Law, class S, int Points>
std::array<PointOf<Law, S>, Points> fibres() {
  std::array<PointOf<Law, S>, Points> data;
  if constexpr (needs_point<Law>)
    for (std::size_t q = 0; q < Points; ++q)
      for (std::size_t family = 0; family < 2; ++family) {
        const double angle = (family == 0 ? 0.5 : -0.5) + 0.1 * static_cast<double>(q);
        data[q].set(family, {S(std::cos(angle)), S(std::sin(angle)), S(0)});
      }
  return data;
}

/// The block (a, b) of a tangent, i and k.
template <class K>
double entry(const typename K::template Tangent<double>& t, int a, int b, int i, int k) {
  if (K::Places::count == K::nodes * K::nodes || a <= b) return t.K[K::Places::place(a, b)][K::dim * i + k];
  return t.K[K::Places::place(b, a)][K::dim * k + i];
}

struct Errors {
  double energy = 0, tangent = 0, action = 0;
};

/// f against the derivative of the energy, K v and the action against that of f, along v; relative.
template <class K, class Law>
Errors against_duals(const Law& law) {
  using D = Dual<double, 1>;
  Errors worst;
  for (int seed = 0; seed < 3; ++seed) {
    const State<K, double> at(seed);
    typename K::template Nodal<D> X, u;
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i) X[a][i] = at.X[a][i], u[a][i] = at.u[a][i], u[a][i].d[0] = at.v[a][i];
    const auto data = fibres<Law, double, K::points>();
    const auto dual_data = fibres<Law, D, K::points>();
    auto t = std::make_unique<typename K::template Tangent<double>>();
    typename K::template Forces<D> f;
    typename K::template Nodal<double> Kv;
    K::tangent(law, at.X, at.u, data.data(), *t);
    K::forces(law, X, u, dual_data.data(), f);
    K::action(law, at.X, at.u, data.data(), at.v, Kv);
    REQUIRE(t->smallest_J > 0.2);
    double scale = 0, work = 0;
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i) {
        scale = std::max(scale, std::abs(f.f[a][i].d[0]));
        work += t->f[a][i] * at.v[a][i];
      }
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i) {
        double product = 0;
        for (int b = 0; b < K::nodes; ++b)
          for (int k = 0; k < K::dim; ++k) product += entry<K>(*t, a, b, i, k) * at.v[b][k];
        worst.tangent = std::max(worst.tangent, std::abs(product - f.f[a][i].d[0]) / scale);
        worst.action = std::max(worst.action, std::abs(Kv[a][i] - f.f[a][i].d[0]) / scale);
        worst.energy = std::max(worst.energy, std::abs(t->f[a][i] - f.f[a][i].value) / scale);
      }
    if constexpr (!K::bar) {
      const D W = K::energy(law, X, u, dual_data.data());
      worst.energy = std::max(worst.energy, std::abs(W.d[0] - work) / scale);
    }
  }
  return worst;
}

/// The largest difference of a lane from the same element in double, of the largest entry.
template <class K, class S, class Law>
double lanes_against_double(const Law& law) {
  using P = typename K::template Tangent<S>;
  auto pack = std::make_unique<P>();
  auto one = std::make_unique<typename K::template Tangent<double>>();
  const State<K, S> at;
  const auto data = fibres<Law, S, K::points>();
  const auto single = fibres<Law, double, K::points>();
  K::tangent(law, at.X, at.u, data.data(), *pack);
  double worst = 0;
  for (int l = 0; l < Lanes<S>::count; ++l) {
    State<K, double> lane;
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i)
        lane.X[a][i] = static_cast<double>(at.X[a][i][l]), lane.u[a][i] = static_cast<double>(at.u[a][i][l]);
    K::tangent(law, lane.X, lane.u, single.data(), *one);
    double scale = 0;
    for (const auto& block : one->K)
      for (const double k : block) scale = std::max(scale, std::abs(k));
    for (int p = 0; p < K::Places::count; ++p)
      for (int k = 0; k < K::dim * K::dim; ++k)
        worst = std::max(worst, std::abs(static_cast<double>(pack->K[p][k][l]) - one->K[p][k]) / scale);
    for (int a = 0; a < K::nodes; ++a)
      for (int i = 0; i < K::dim; ++i)
        worst = std::max(worst, std::abs(static_cast<double>(pack->f[a][i][l]) - one->f[a][i]) / scale);
  }
  return worst;
}

constexpr CompressibleNeoHooke neo_hooke{.mu = 1, .lambda = 3};

/// The same seen through P and A alone: no shortcut.
struct {
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return neo_hooke.stress(F);
  }
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    return neo_hooke.response(F);
  }
} constexpr any_law;

constexpr Hyperelastic pair{MooneyRivlin{.c10 = 0.4, .c01 = 0.2}, SimoTaylor{.kappa = 40}};
constexpr Hyperelastic bent_pair{NeoHooke{.c10 = 0.4}, Logarithmic{.kappa = 40}};
constexpr Hyperelastic wall{HolzapfelGasserOgden{.c = 1, .k1 = 2, .k2 = 0.8}, Quadratic{.kappa = 40}};

std::size_t allocations = 0;  // of this program, by operator new

}  // namespace

// Not inlined: GCC takes an inlined pair for a mismatched one.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto a = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

#define TUNICA_CELLS                                                                                  \
  mesh::Tri3, mesh::Tri6, mesh::Quad4, mesh::Quad9, mesh::Tet4, mesh::Tet10, mesh::Hex8, mesh::Hex20, \
      mesh::Hex27, mesh::Wedge6

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("solid: kernel forces and tangents and actions are derivatives on every cell", C,
                     TUNICA_CELLS) {
    const auto check = [](const std::string& label, const Errors& e) {
      MESSAGE(C::nodes << " nodes in " << C::dim << "-D, " << label << ": energy " << e.energy << ", tangent "
                       << e.tangent << ", action " << e.action);
      CHECK(e.energy < 1e-12);
      CHECK(e.tangent < 1e-12);
      CHECK(e.action < 1e-12);
    };
    check("pointwise", against_duals<Kernel<C>>(neo_hooke));
    check("mean volume", against_duals<Kernel<C, MeanVolume>>(pair));
    if constexpr (C::nodes != C::dim + 1) {
      check("F-bar", against_duals<Kernel<C, FBar>>(pair));
      check("F-bar, its pressure apart", against_duals<Kernel<C, CentreVolume>>(pair));
    }
    if constexpr (C::nodes >= 9 && C::nodes != 10) {
      check("linear volume", against_duals<Kernel<C, LinearVolume>>(pair));
      check("linear volume, U'' as it comes", against_duals<Kernel<C, LinearVolume>>(bent_pair));
    }
  }

  TEST_CASE("solid: kernels of fibre laws have their derivatives") {
    for (const auto& e :
         {against_duals<Kernel<mesh::Hex8>>(wall), against_duals<Kernel<mesh::Hex8, MeanVolume>>(wall),
          against_duals<Kernel<mesh::Tet10>>(wall), against_duals<Kernel<mesh::Hex8, FBar>>(wall)}) {
      CHECK(e.energy < 1e-12);
      CHECK(e.tangent < 1e-12);
      CHECK(e.action < 1e-12);
    }
  }

  TEST_CASE("solid: the shortcut of three terms gives the tangent of P and A") {
    const auto check = [&]<class K>(K) {
      const State<K, double> at;
      typename K::template Tangent<double> t, want;
      K::tangent(neo_hooke, at.X, at.u, nullptr, t);
      K::tangent(any_law, at.X, at.u, nullptr, want);
      for (int p = 0; p < K::Places::count; ++p)
        for (int k = 0; k < K::dim * K::dim; ++k)
          CHECK(t.K[p][k] == doctest::Approx(want.K[p][k]).epsilon(1e-12).scale(1));
      for (int a = 0; a < K::nodes; ++a)
        for (int i = 0; i < K::dim; ++i)
          CHECK(t.f[a][i] == doctest::Approx(want.f[a][i]).epsilon(1e-12).scale(1));
    };
    check(Kernel<mesh::Hex8>{});
    check(Kernel<mesh::Tet4>{});
    check(Kernel<mesh::Quad4>{});
  }

  TEST_CASE("solid: lanes of kernels are the elements that they hold") {
    const auto check = [](const std::string& label, double wide, double plain, double single) {
      MESSAGE(label << ": packs of double " << wide << ", plain ones " << plain << ", of float " << single);
      CHECK(wide < 1e-13);
      CHECK(plain < 1e-13);
      CHECK(single < 1e-5);
    };
    const auto all = [&]<class K>(K, const std::string& label, const auto& law) {
      check(label, lanes_against_double<K, Pack<double>>(law),
            lanes_against_double<K, Pack<double, 4, 1>>(law), lanes_against_double<K, Pack<float>>(law));
    };
    all(Kernel<mesh::Hex8>{}, "Hex8, neo-Hooke", neo_hooke);
    all(Kernel<mesh::Hex8, MeanVolume>{}, "Hex8, fibres, mean volume", wall);
    all(Kernel<mesh::Hex8, FBar>{}, "Hex8, Mooney-Rivlin, F-bar", pair);
    all(Kernel<mesh::Tet10>{}, "Tet10, fibres", wall);
    all(Kernel<mesh::Hex20, LinearVolume>{}, "Hex20, fibres, linear volume", wall);
    all(Kernel<mesh::Hex8, CentreVolume>{}, "Hex8, fibres, F-bar with its pressure apart", wall);
    all(Kernel<mesh::Quad4, FBar>{}, "Quad4, Mooney-Rivlin, F-bar", pair);
  }

  TEST_CASE("solid: kernels that keep pressures take those that Newton predicts") {
    const auto check = [&]<class K>(K) {
      const State<K, double> at;
      typename K::template Tangent<double> exact, predicted, other;
      K::tangent(pair, at.X, at.u, nullptr, exact);
      auto p = exact.p;
      K::tangent(pair, at.X, at.u, nullptr, p, predicted);
      for (std::size_t k = 0; k < p.size(); ++k) p[k] += 7 - 3 * static_cast<double>(k);
      K::tangent(pair, at.X, at.u, nullptr, p, other);
      double same = 0, turned = 0, scale = 0;
      for (int n = 0; n < K::Places::count; ++n)
        for (int k = 0; k < 9; ++k) {
          scale = std::max(scale, std::abs(exact.K[n][k]));
          same = std::max(same, std::abs(predicted.K[n][k] - exact.K[n][k]));
          turned = std::max(turned, std::abs(other.K[n][k] - exact.K[n][k]));
        }
      CHECK(same < 1e-14 * scale);
      CHECK(turned > 0.1);
      // What the pressures more leave in K is the derivative of their forces: sum_k (p_k - exact.p_k)
      // slope_k.
      constexpr double h = 1e-6;
      for (int b = 0; b < K::nodes; b += 3) {
        State<K, double> moved[2];
        typename K::template Forces<double> f[2];
        for (int side = 0; side < 2; ++side) {
          moved[side].u[b][1] += side == 0 ? -h : h;
          K::forces(pair, moved[side].X, moved[side].u, nullptr, f[side]);
        }
        for (int a = 0; a < K::nodes; ++a)
          for (int i = 0; i < 3; ++i) {
            double want = 0;
            for (std::size_t k = 0; k < p.size(); ++k)
              want += (p[k] - exact.p[k]) * (f[1].slope[k][a][i] - f[0].slope[k][a][i]) / (2 * h);
            CHECK(std::abs(entry<K>(other, a, b, i, 1) - entry<K>(exact, a, b, i, 1) - want) < 1e-8 * scale);
          }
        // and the rates of the dilatation are its derivatives
        for (std::size_t k = 0; k < p.size(); ++k)
          CHECK((f[1].p[k] - f[0].p[k]) / (2 * h) == doctest::Approx([&] {
                                                       double dp = 0;
                                                       for (std::size_t j = 0; j < p.size(); ++j)
                                                         dp += exact.gain(k, j) * exact.rate(j)[b][1];
                                                       return dp;
                                                     }())
                                                         .epsilon(1e-6)
                                                         .scale(1));
      }
    };
    check(Kernel<mesh::Hex8, MeanVolume>{});
    check(Kernel<mesh::Hex8, CentreVolume>{});
    check(Kernel<mesh::Hex20, LinearVolume>{});
  }

  TEST_CASE("solid: F-bar of a pair has the same forces and tangent with its pressure apart") {
    const auto check = [&]<class C>(C, const auto& law) {
      using K = Kernel<C, CentreVolume>;
      const State<K, double> at;
      const auto data = fibres<std::remove_cvref_t<decltype(law)>, double, K::points>();
      typename K::template Tangent<double> apart;
      typename Kernel<C, FBar>::template Tangent<double> whole;
      K::tangent(law, at.X, at.u, data.data(), apart);
      Kernel<C, FBar>::tangent(law, at.X, at.u, data.data(), whole);
      double worst = 0, scale = 0;
      for (int n = 0; n < K::Places::count; ++n)
        for (int k = 0; k < K::dim * K::dim; ++k) {
          worst = std::max(worst, std::abs(apart.K[n][k] - whole.K[n][k]));
          scale = std::max(scale, std::abs(whole.K[n][k]));
        }
      for (int a = 0; a < K::nodes; ++a)
        for (int i = 0; i < K::dim; ++i) worst = std::max(worst, std::abs(apart.f[a][i] - whole.f[a][i]));
      CHECK(worst < 1e-13 * scale);
    };
    check(mesh::Hex8{}, pair);
    check(mesh::Hex8{}, wall);
    check(mesh::Wedge6{}, pair);
    check(mesh::Hex27{}, pair);
    check(mesh::Quad4{}, pair);
  }

  TEST_CASE(
      "solid: a linear volume sees a linear dilatation as it is and orders of it above as their means") {
    using K = Kernel<mesh::Hex27, LinearVolume>;
    State<K, double> at;  // u = (0, 0, (a + b.X) z) on a distorted cell: J = 1 + a + b.X where b_z = 0
    for (int a = 0; a < 27; ++a) {
      at.u[a][0] = at.u[a][1] = 0;
      at.u[a][2] = 0.1 * at.X[a][2];
    }
    K::Forces<double> f;
    K::forces(pair, at.X, at.u, nullptr, f);
    CHECK(f.theta[0] == doctest::Approx(1.1).epsilon(1e-14));
    for (std::size_t k = 1; k < 4; ++k) CHECK(std::abs(f.theta[k]) < 1e-14);
    const auto x = unit_cell<mesh::Hex27>();
    for (std::size_t a = 0; a < 27; ++a)
      for (int i = 0; i < 3; ++i) at.X[a][i] = x[a][static_cast<std::size_t>(i)] * (i + 1);
    for (int a = 0; a < 27; ++a) at.u[a][2] = (0.1 + 0.2 * at.X[a][0] - 0.05 * at.X[a][1]) * at.X[a][2];
    K::forces(pair, at.X, at.u, nullptr, f);
    // modes sqrt(12) (x - 1/2) and sqrt(12) (y/2 - 1/2), z/3 alike
    CHECK(f.theta[0] == doctest::Approx(1 + 0.1 + 0.2 * 0.5 - 0.05 * 1).epsilon(1e-14));
    CHECK(f.theta[1] == doctest::Approx(0.2 / std::sqrt(12.)).epsilon(1e-13));
    CHECK(f.theta[2] == doctest::Approx(-0.1 / std::sqrt(12.)).epsilon(1e-13));
    CHECK(std::abs(f.theta[3]) < 1e-14);
    for (std::size_t k = 0; k < 4; ++k)
      CHECK(f.p[k] == doctest::Approx(0.5 * 40 * ([&] {
                                        // U' = kappa/2 (J - 1/J) of SimoTaylor, projected by a rule of its
                                        // own
                                        double sum = 0;
                                        constexpr int n = 400;
                                        for (int i = 0; i < n; ++i)
                                          for (int j = 0; j < n; ++j) {
                                            const double s = (i + 0.5) / n, t = (j + 0.5) / n,
                                                         J = 1.1 + 0.2 * s - 0.05 * 2 * t,
                                                         mode = k == 0   ? 1
                                                                : k == 1 ? std::sqrt(12.) * (s - 0.5)
                                                                : k == 2 ? std::sqrt(12.) * (t - 0.5)
                                                                         : 0;
                                            sum += mode * (J - 1 / J) / (n * n);
                                          }
                                        return sum;
                                      }()))
                          .epsilon(1e-5)
                          .scale(1));
  }

  TEST_CASE("solid: a plane element is a brick of unit depth held from moving across") {
    using Plane = Kernel<mesh::Quad4>;
    using Brick = Kernel<mesh::Hex8>;
    const State<Plane, double> at;
    State<Brick, double> deep;
    for (int a = 0; a < 8; ++a) {
      for (int i = 0; i < 2; ++i) deep.X[a][i] = at.X[a % 4][i], deep.u[a][i] = at.u[a % 4][i];
      deep.X[a][2] = a / 4, deep.u[a][2] = 0;
    }
    Plane::Tangent<double> flat;
    Brick::Tangent<double> brick;
    Plane::tangent(pair, at.X, at.u, nullptr, flat);
    Brick::tangent(pair, deep.X, deep.u, nullptr, brick);
    CHECK(Plane::energy(pair, at.X, at.u, nullptr) ==
          doctest::Approx(Brick::energy(pair, deep.X, deep.u, nullptr)).epsilon(1e-13));
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 2; ++i) {
        CHECK(flat.f[a][i] == doctest::Approx(brick.f[a][i] + brick.f[a + 4][i]).epsilon(1e-12));
        for (int b = 0; b < 4; ++b)
          for (int k = 0; k < 2; ++k) {
            double sum = 0;
            for (const int c : {a, a + 4})
              for (const int d : {b, b + 4}) sum += entry<Brick>(brick, c, d, i, k);
            CHECK(entry<Plane>(flat, a, b, i, k) == doctest::Approx(sum).epsilon(1e-11));
          }
      }
  }

  TEST_CASE("solid: kernels spend the flops that their algorithm has and allocate nothing") {
    const auto flops = []<class K>(K, const auto& law) {
      State<K, Counted> at;
      typename K::template Tangent<Counted> t;
      Counted::count() = {};
      K::tangent(law, at.X, at.u, nullptr, t);
      return Counted::count();
    };
    const FlopCount hex = flops(Kernel<mesh::Hex8>{}, any_law), tet = flops(Kernel<mesh::Tet10>{}, any_law);
    const FlopCount short_hex = flops(Kernel<mesh::Hex8>{}, neo_hooke);
    MESSAGE("residual and tangent of neo-Hooke: Hex8 " << hex.total() << " flop, " << short_hex.total()
                                                       << " by three terms, Tet10 " << tet.total());
    CHECK(hex.total() <= 32120);
    CHECK(tet.total() <= 21796);
    CHECK(3 * short_hex.total() < 2 * hex.total());
    CHECK(hex.function == 8);  // one ln J a point

    using P = Pack<double>;
    const auto silent = []<class K>(K, const auto& law) {
      static_assert(!std::is_polymorphic_v<K> && !std::is_polymorphic_v<std::remove_cvref_t<decltype(law)>>);
      const auto at = std::make_unique<State<K, P>>();
      const auto t = std::make_unique<typename K::template Tangent<P>>();
      const auto f = std::make_unique<typename K::template Forces<P>>();
      const auto data = fibres<std::remove_cvref_t<decltype(law)>, P, K::points>();
      typename K::template Nodal<P> Kv;
      const std::size_t before = allocations;
      K::tangent(law, at->X, at->u, data.data(), *t);
      K::forces(law, at->X, at->u, data.data(), *f);
      K::action(law, at->X, at->u, data.data(), at->v, Kv);
      return allocations - before;
    };
    CHECK(allocations > 0);
    CHECK(silent(Kernel<mesh::Hex8>{}, wall) == 0);
    CHECK(silent(Kernel<mesh::Hex8, MeanVolume>{}, wall) == 0);
    CHECK(silent(Kernel<mesh::Hex27, FBar>{}, pair) == 0);
    CHECK(silent(Kernel<mesh::Hex20, LinearVolume>{}, wall) == 0);
    CHECK(silent(Kernel<mesh::Tet10>{}, neo_hooke) == 0);
  }

  TEST_CASE("solid: an element under a stored deformation is the element free of it") {
    const auto check = [&]<class K>(K) {
      const State<K, double> at;
      State<K, double> relaxed;  // X_0 = F_p^-1 X with the same current nodes
      const Tensor<double> F_p{.m = {1.1, .1, 0, -.05, .9, .02, .03, 0, 1.2}}, back = inverse(F_p);
      for (int a = 0; a < K::nodes; ++a) {
        const auto X = product(back, Vector3<double>{at.X[a][0], at.X[a][1], at.X[a][2]});
        for (int i = 0; i < 3; ++i) {
          relaxed.X[a][i] = X[static_cast<std::size_t>(i)];
          relaxed.u[a][i] = at.X[a][i] + at.u[a][i] - relaxed.X[a][i];
        }
      }
      std::array<Tensor<double>, K::points> stored;
      stored.fill(F_p);
      typename K::template Tangent<double> t, want;
      K::tangent(pair, at.X, at.u, nullptr, stored.data(), t);
      K::tangent(pair, relaxed.X, relaxed.u, nullptr, want);
      CHECK(K::energy(pair, at.X, at.u, nullptr, stored.data()) ==
            doctest::Approx(K::energy(pair, relaxed.X, relaxed.u, nullptr)).epsilon(1e-12));
      double worst = 0, scale = 0;
      for (int p = 0; p < K::Places::count; ++p)
        for (int k = 0; k < 9; ++k) {
          worst = std::max(worst, std::abs(t.K[p][k] - want.K[p][k]));
          scale = std::max(scale, std::abs(want.K[p][k]));
        }
      for (int a = 0; a < K::nodes; ++a)
        for (int i = 0; i < 3; ++i) worst = std::max(worst, std::abs(t.f[a][i] - want.f[a][i]));
      CHECK(worst < 1e-13 * scale);
    };
    check(Kernel<mesh::Hex8>{});
    check(Kernel<mesh::Hex8, MeanVolume>{});
    check(Kernel<mesh::Hex20, LinearVolume>{});
    check(Kernel<mesh::Tet10>{});
  }

  TEST_CASE("solid: the kernel tells an inverted element in its lane") {
    using K = Kernel<mesh::Hex8>;
    using P = Pack<double>;
    State<K, P> at;
    for (int i = 0; i < 3; ++i) at.u[6][i].set(1, -1.6);
    auto f = std::make_unique<K::Forces<P>>();
    K::forces(neo_hooke, at.X, at.u, nullptr, *f);
    for (int l = 0; l < P::size; ++l) CHECK((f->smallest_J[l] > 0) == (l != 1));
  }
}
