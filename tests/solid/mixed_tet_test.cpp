// SPDX-License-Identifier: MIT
#include "tunica/solid/mixed_tet.hpp"
#include "support/tube_cells.hpp"
#include "tunica/core/counted.hpp"
#include "tunica/core/dual.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/output.hpp"
#include "tunica/solid/recovery.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double X[4][3] = {{0.1, 0, 0}, {1.2, 0.1, -0.1}, {0.2, 0.9, 0.2}, {-0.1, 0.3, 1.1}};
constexpr MixedTet::Moduli moduli{.mu = 80, .pressure_scale = 70};

/// Unknown k of node a is number 4 a + k.
template <class S>
struct Unknowns {
  S X[4][3], u[4][3], q[4];
  Tensor<S> stored = identity<S>();

  explicit Unknowns(double phase = 0.4) {
    for (int a = 0; a < 4; ++a) {
      for (int i = 0; i < 3; ++i) X[a][i] = S(::X[a][i]), u[a][i] = S(wave(4 * a + i, phase));
      q[a] = S(wave(4 * a + 3, phase));
    }
    const double p[9] = {1.1, 0.05, -0.1, 0.02, 0.9, 0.07, 0.03, -0.04, 1.05};
    for (std::size_t k = 0; k < 9; ++k) stored.m[k] = S(p[k]);
  }
  static double wave(int k, double phase) { return 0.15 * std::sin(2.3 * k + phase); }
  S& operator[](int k) { return k % 4 < 3 ? u[k / 4][k % 4] : q[k / 4]; }
};

double volume() {
  const Unknowns<double> x;
  return element_point<mesh::Tet4, MixedTet::Quadrature>(x.X, 0).weight;
}

/// Off by how much forces and tangent are the derivatives of the energy, of the largest of each.
template <class Law>
std::array<double, 2> off_energy(const Law& law, bool prestressed) {
  using D = Dual<double, 16>;
  using DD = Dual<D, 16>;
  Unknowns<DD> y;
  for (int k = 0; k < 16; ++k) y[k] = DD::variable(D::variable(y[k].value.value, k), k);
  const Unknowns<double> x;
  const DD energy =
      MixedTet::energy(law, moduli, y.X, y.u, y.q, PointOf<Law, DD>{}, prestressed ? &y.stored : nullptr);
  const auto* const stored = prestressed ? &x.stored : nullptr;
  CHECK(energy.value.value ==
        doctest::Approx(MixedTet::energy(law, moduli, x.X, x.u, x.q, PointOf<Law, double>{}, stored))
            .epsilon(1e-13));
  MixedTet::Tangent<double> at;
  MixedTet::Forces<double> alone;
  MixedTet::tangent(law, moduli, x.X, x.u, x.q, {}, stored, at);
  MixedTet::forces(law, moduli, x.X, x.u, x.q, {}, stored, alone);
  double f_scale = 0, K_scale = 0, f_off = 0, K_off = 0;
  for (int r = 0; r < 16; ++r) {
    const double f = at.f[r / 4][r % 4], exact = energy.d[static_cast<std::size_t>(r)].value;
    f_scale = std::max(f_scale, std::abs(f));
    f_off = std::max({f_off, std::abs(f - exact), std::abs(f - alone.f[r / 4][r % 4])});
    for (int c = 4 * (r / 4); c < 16; ++c) {
      const double K = at.K[MixedTet::Places::place(r / 4, c / 4)][4 * (r % 4) + c % 4];
      K_scale = std::max(K_scale, std::abs(K));
      K_off =
          std::max(K_off, std::abs(K - energy.d[static_cast<std::size_t>(r)].d[static_cast<std::size_t>(c)]));
    }
  }
  return {f_off / f_scale, K_off / K_scale};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: forces and tangent of the mixed tetrahedron are the derivatives of its energy") {
    const auto check = [](const auto& law) {
      for (const bool prestressed : {false, true}) {
        const auto [f, K] = off_energy(law, prestressed);
        CHECK(f < 1e-13);
        CHECK(K < 1e-13);
      }
    };
    check(Hyperelastic{NeoHooke{.c10 = 40}, Quadratic{.kappa = 4e5}});
    check(Hyperelastic{MooneyRivlin{.c10 = 40, .c01 = 7}, Quadratic{.kappa = 4e2}});
    check(Hyperelastic{MooneyRivlin{.c10 = 40, .c01 = 7}, SimoTaylor{.kappa = 4e5}});  // both branches of U*
    check(Hyperelastic{NeoHooke{.c10 = 40}, SimoTaylor{.kappa = 60}});
    check(Hyperelastic{NeoHooke{.c10 = 40}, SimoTaylor{.kappa = std::numeric_limits<double>::infinity()}});
  }

  TEST_CASE("solid: the complement of a volumetric law is the inverse of its slope") {
    const auto check = [](const auto& law, double J) {
      const double p = law.slope(J);
      const auto c = law.complement(p);
      CHECK(c.dilatation == doctest::Approx(J - 1).epsilon(1e-12));
      CHECK(c.compliance * law.curvature(J) == doctest::Approx(1).epsilon(1e-12));
      // U is a difference of terms of the size of kappa
      CHECK(std::abs(c.energy - (p * (J - 1) - law.energy(J))) <
            (std::numeric_limits<double>::epsilon() + 1e-13 * std::abs(J - 1)) * law.kappa);
      using D = Dual<double, 1>;
      CHECK(law.complement(D::variable(p, 0)).energy.d[0] == doctest::Approx(J - 1).epsilon(1e-9));
    };
    for (const double J : {0.2, 0.9, 0.99, 0.9901, 0.9999, 1.0001, 1.0099, 1.01, 1.1, 3.0}) {
      check(Quadratic{.kappa = 3e5}, J);
      check(SimoTaylor{.kappa = 3e5}, J);
    }
    CHECK(SimoTaylor{.kappa = 3e5}.complement(0.0).energy == 0);
  }

  TEST_CASE("solid: packs of mixed tetrahedra are their lanes and their flops are counted") {
    using S = Pack<double>;
    const Hyperelastic law{HolzapfelGasserOgden{.c = 80, .k1 = 50, .k2 = 0.8}, SimoTaylor{.kappa = 4e3}};
    const auto wave = [](int k, int lane) { return Unknowns<double>::wave(k, 0.4 + 0.3 * lane); };
    Unknowns<S> x;
    for (int k = 0; k < 16; ++k) x[k] = S::generate([&](int lane) { return wave(k, lane); });
    Fibres<S, 2> fibres;
    fibres.set(0, {S(0.6), S(0.8), S(0)});
    fibres.set(1, {S(0.6), S(-0.8), S(0)});
    MixedTet::Tangent<S> packs;
    MixedTet::tangent(law, moduli, x.X, x.u, x.q, fibres, &x.stored, packs);
    for (int lane = 0; lane < S::size; ++lane) {
      Unknowns<double> y(0.4 + 0.3 * lane);
      Fibres<double, 2> one;
      for (std::size_t k = 0; k < 6; ++k) one.m[k] = fibres.m[k][lane];
      MixedTet::Tangent<double> alone;
      MixedTet::tangent(law, moduli, y.X, y.u, y.q, one, &y.stored, alone);
      double off = 0, size = 0;
      for (int p = 0; p < MixedTet::Places::count; ++p)
        for (int k = 0; k < 16; ++k) {
          off = std::max(off, std::abs(packs.K[p][k][lane] - alone.K[p][k]));
          size = std::max(size, std::abs(alone.K[p][k]));
        }
      CHECK(off < 1e-14 * size);
    }
    const Hyperelastic plain{NeoHooke{.c10 = 40}, Quadratic{.kappa = 4e5}};
    const Unknowns<Counted> c;
    MixedTet::Tangent<Counted> counted;
    Counted::count() = {};
    MixedTet::tangent(plain, moduli, c.X, c.u, c.q, {}, nullptr, counted);
    const auto flops = Counted::count().total();
    MESSAGE("forces and tangent of a mixed tetrahedron under a neo-Hooke: " << flops << " flop");
    CHECK(flops > 1800);  // P, A, T_a and ten blocks alone
    CHECK(flops < 3600);
  }

  TEST_CASE("solid: a constant pressure costs the mixed tetrahedron nothing but its compression") {
    Unknowns<double> x;
    for (int k = 0; k < 16; ++k) x[k] = k % 4 == 3 ? 0.3 : 0;
    const double p = 0.3 * moduli.pressure_scale, kappa = 4e5;
    const Hyperelastic law{NeoHooke{.c10 = 40}, Quadratic{.kappa = kappa}};
    CHECK(MixedTet::energy(law, moduli, x.X, x.u, x.q, {}) ==
          doctest::Approx(-0.5 * p * p / kappa * volume()).epsilon(1e-12));
    // any other pressure costs int (p - mean p)^2 / (2 mu): here p = p1 N_1, whose variance is V (1/10 -
    // 1/16)
    for (int k = 0; k < 16; ++k) x[k] = k == 7 ? 0.3 : 0;
    const Hyperelastic incompressible{NeoHooke{.c10 = 40},
                                      Quadratic{.kappa = std::numeric_limits<double>::infinity()}};
    CHECK(MixedTet::energy(incompressible, moduli, x.X, x.u, x.q, {}) ==
          doctest::Approx(-p * p / (2 * 80) * volume() * (0.1 - 0.0625)).epsilon(1e-12));
  }

  TEST_CASE("solid: tetrahedra with nodal pressures under two laws are two bodies on any number of threads") {
    auto mesh = test::box_of<mesh::Tet4>(meshing::Block{.cells = {5, 4, 4}});
    mesh.region_names = {"a", "b"};
    for (Index e = 0; e < mesh.cell_count(); ++e) mesh.region.push_back((e * 5 / 3) % 2);
    const Hyperelastic soft{NeoHooke{.c10 = 1}, SimoTaylor{.kappa = 200}};
    auto stiff = soft;
    stiff.isochoric.c10 = 9;
    stiff.volumetric.kappa = 900;
    Body whole{mesh, with<NodalPressure>(soft), 0.0, Mass::lumped};
    whole.laws().material(1, stiff);
    Eigen::VectorXd u(whole.unknowns()), f, part, predicted, sum = Eigen::VectorXd::Zero(u.size()), Ku = sum;
    for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = 0.01 * std::sin(1.7 * static_cast<double>(k));
    REQUIRE(whole.internal_forces(u, la::no_step, f, predicted));
    la::SparseMatrix K = whole.pattern();
    whole.tangent(u, Eigen::VectorXd(0), {}, K);
    double energy = 0;
    for (const Index region : {0, 1}) {
      auto half = mesh;
      half.region.clear();
      Eigen::Index count = 0;
      for (Index e = 0; e < mesh.cell_count(); ++e)
        if (mesh.region[static_cast<std::size_t>(e)] == region) half.cells.col(count++) = mesh.cells.col(e);
      half.cells.conservativeResize(Eigen::NoChange, count);
      Body body{half, with<NodalPressure>(soft), 0.0, Mass::lumped};  // one scale of pressures for both
      if (region == 1) body.laws().material(0, stiff);
      REQUIRE(body.internal_forces(u, la::no_step, part, predicted));
      sum += part;
      la::SparseMatrix A = body.pattern();
      body.tangent(u, Eigen::VectorXd(0), {}, A);
      Ku += A * u;
      energy += body.strain_energy(u);
    }
    CHECK((f - sum).norm() < 1e-14 * f.norm());
    CHECK((K * u - Ku).norm() < 1e-14 * Ku.norm());
    CHECK(whole.strain_energy(u) == doctest::Approx(energy).epsilon(1e-14));
    thread_count() = 2;
    REQUIRE(whole.internal_forces(u, la::no_step, part, predicted));
    la::SparseMatrix A = whole.pattern();
    whole.tangent(u, Eigen::VectorXd(0), {}, A);
    thread_count() = 1;
    CHECK(part == f);
    CHECK((A.coeffs() == K.coeffs()).all());
  }

  TEST_CASE("solid: nodal pressures know the shear modulus of a law with a frame of fibres") {
    const Hyperelastic frame{Isochoric{Guccione{.C = 2e3, .bf = 8, .bt = 2, .bfs = 4}},
                             Quadratic{.kappa = 1e6}};
    using Inside = MixedInterior<std::remove_const_t<decltype(frame)>>;
    CHECK(Inside::shear_modulus(frame) == doctest::Approx(2e3 * (4 + 4 + 2) / 3. / 2).epsilon(1e-12));
  }
}

TEST_SUITE("convergence") {
  TEST_CASE("solid: nodal pressures give the stresses of the thick tube where the volumes of cells do not") {
    const test::ThickTube tube;
    const double l = 1.10, p = tube.pressure(l);
    const Hyperelastic law{Yeoh{.c10 = tube.c10, .c20 = tube.c20}, SimoTaylor{.kappa = 1e4 * 2 * tube.c10}};
    std::vector<test::StressError> cells, nodes;
    for (const int n : {2, 4, 8}) {
      const auto mesh = test::quarter_of_tube<mesh::Tet4>(n, tube.inner, tube.outer);
      auto wall = test::wall_of_tube(mesh, with<NodalPressure>(law), p);
      const auto report = wall.solve();
      REQUIRE(report);
      const auto& body = wall.body();
      const Points<3> x = mesh.nodes + wall.displacement();
      StressField own(6, mesh.cell_count());  // of the cell's own volume
      for (Index e = 0; e < mesh.cell_count(); ++e)
        own.col(e) = std::remove_cvref_t<decltype(body)>::Element::stress(
                         law, body.reference(e), body.gather(e, wall.unknowns()), body.data(e))
                         .sigma;
      const auto error = [&](const Points<3>& at, const StressField& s) {
        return test::stress_error(tube, l, at, s);
      };
      const Points<3> middle = test::middles(mesh, x);
      cells.push_back(error(middle, cell_stress(body, wall.unknowns())));
      nodes.push_back(error(x, recovered_stress(body, wall.unknowns())));
      const auto locked = error(middle, own), spread = error(x, recover_at_nodes(mesh, own));
      MESSAGE(n << " cells, " << report.solve.iterations << " iterations: stresses of cells off by "
                << 100 * cells.back().mean << " % (at most " << 100 * cells.back().largest << " %), at nodes "
                << 100 * nodes.back().mean << " % (" << 100 * nodes.back().largest
                << " %); with the pressure of the cell's own volume " << 100 * locked.mean << " % ("
                << 100 * locked.largest << " %), at nodes " << 100 * spread.mean << " % ("
                << 100 * spread.largest << " %)");
      CHECK(cells.back().mean < 0.5 * locked.mean);
      CHECK(nodes.back().mean < 0.5 * spread.mean);
    }
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const double cell = std::log2(cells[k - 1].mean / cells[k].mean),
                   node = std::log2(nodes[k - 1].mean / nodes[k].mean);
      MESSAGE("order: cells " << cell << ", nodes " << node);
      CHECK(cell > 0.9);  // constant in a cell
      CHECK(node > 1.4);  // 3/2 of the pressures
    }
    CHECK(nodes.back().mean < 0.01);
  }
}
