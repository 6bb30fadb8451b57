// SPDX-License-Identifier: MIT
// [COOK74]'s membrane with every cure of locking: quasi-incompressible in plane strain, compressible and
// free.
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "support/thick_tube.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double shear = 80.194e6, limit = 6.933;  // [Pa], converged tip [mm]

/// The membrane of 48 x 44/16 mm, n x n boxes and one of 1 mm across, in cells of C [m].
template <mesh::Cell C>
mesh::Mesh<C, 3> membrane(int n) {
  const auto bent = [](auto mesh) {
    for (Index k = 0; k < mesh.node_count(); ++k) {
      const double s = mesh.nodes(0, k), t = mesh.nodes(1, k);
      mesh.nodes.col(k) = 1e-3 * Vec3(48 * s, 44 * s + t * (44 - 28 * s), mesh.nodes(2, k));
    }
    return mesh;
  };
  const meshing::Block block{.cells = {n, n, 1}, .lo = Vec3::Zero(), .hi = Vec3::Ones()};
  if constexpr (std::is_same_v<C, mesh::Tet4>)
    return bent(meshing::box_tets(block));
  else if constexpr (std::is_same_v<C, mesh::Hex8>)
    return bent(meshing::box_hexes(block));
  else if constexpr (std::is_same_v<C, mesh::Tet10>)
    return mesh::quadratic<C>(bent(meshing::box_tets(block)));
  else
    return mesh::quadratic<C>(bent(meshing::box_hexes(block)));
}

/// Nodal forces of a traction [Pa] on a patch: int N_a dA.
template <class Wall, mesh::Cell C>
void pull(Wall& wall, const mesh::Mesh<C, 3>& mesh, const mesh::Patch<typename C::Face>& patch,
          const Vec3& traction) {
  using Face = typename C::Face;
  using Rule = FaceRule<Face>;
  using Tables = fem::Tables<fem::Lagrange<Face>, Rule>;
  std::vector<double> area(static_cast<std::size_t>(mesh.node_count()), 0);
  for (Eigen::Index f = 0; f < patch.faces.cols(); ++f)
    for (std::size_t q = 0; q < Rule::size; ++q) {
      Vec3 d[2] = {Vec3::Zero(), Vec3::Zero()};
      for (int a = 0; a < Face::nodes; ++a)
        for (std::size_t k = 0; k < 2; ++k)
          d[k] += Tables::gradients[q][static_cast<std::size_t>(a)][k] * mesh.nodes.col(patch.faces(a, f));
      const double weight = Rule::weights[q] * Vec3(d[0][1] * d[1][2] - d[0][2] * d[1][1],
                                                    d[0][2] * d[1][0] - d[0][0] * d[1][2],
                                                    d[0][0] * d[1][1] - d[0][1] * d[1][0])
                                                   .norm();
      for (int a = 0; a < Face::nodes; ++a)
        area[static_cast<std::size_t>(patch.faces(a, f))] +=
            weight * Tables::values[q][static_cast<std::size_t>(a)];
    }
  for (const Index k : mesh::patch_nodes(patch)) wall.force(k, area[static_cast<std::size_t>(k)] * traction);
}

enum class Faces { slide, free };

struct Tip {
  double u = 0;  // of the upper right corner [mm]
  int most_iterations = 0;
  /// Of ln |r| after an iteration against ln |r| before it, 2 for Newton: near the solution by shaken_slope,
  /// and of the last three residuals above rounding, the first of which may be far from it.
  double slope = 0, last_slope = 0;
  double seconds = 0;
  StaticsReport report;
  double variation = 0, alternating = 0;  // of the nodal pressures, where there are any [Pa mm]
};

/// int |p_i+1 - p_i| over the lines of nodes of the front along both directions, and what of it alternates
/// from node to node: second differences over 4. Each line counts with its share of a breadth of 1.
std::array<double, 2> variation(const Eigen::VectorXd& p, int n) {
  const auto at = [&](int i, int j) { return p[i + (n + 1) * j]; };
  double total = 0, alternating = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < n; ++i) {
      total += (std::abs(at(i + 1, j) - at(i, j)) + std::abs(at(j, i + 1) - at(j, i))) / (n + 1);
      if (i + 2 <= n)
        alternating += (std::abs(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j)) +
                        std::abs(at(j, i + 2) - 2 * at(j, i + 1) + at(j, i))) /
                       (4 * (n + 1));
    }
  return {total, alternating};
}

/// How the load is laid on, and the strain of the cells [-] in the larger of two shakes of the solution, 0
/// for none. Where pressures follow the volumes of cells, the residual of a strain is kappa/mu times larger.
struct Way {
  double shake, first_step = 1;
};
constexpr Way of_volumes{.shake = 4e-6}, of_forces{.shake = 4e-4};

/// ln |r| after an iteration against ln |r| before it, from two shakes in the same pattern, one 4 times the
/// other.
template <class Wall, mesh::Cell C>
double shaken_slope(Wall& wall, const mesh::Mesh<C, 3>& mesh, double size) {
  const Points<3> reached = wall.displacement();
  double before[2], after[2];
  for (const int k : {0, 1}) {
    Points<3> u = reached;
    for (Index n = 0; n < mesh.node_count(); ++n)
      for (int i = 0; i < 3; ++i)
        if (!wall.body().fixed(3 * n + i))
          u(i, n) += (k == 0 ? size : size / 4) * std::sin(3.7 * n + 2.3 * i + 1);
    wall.start(u);
    Eigen::VectorXd r;
    (void)wall.residual(wall.unknowns(), 1, r, la::no_step);
    const StaticsStep again = wall.step();
    REQUIRE(again);
    REQUIRE(again.history.size() > 1);
    before[k] = r.norm(), after[k] = again.history[1];
  }
  CHECK(after[1] > 1e-9);  // residuals stall, rounded, below 1e-10 of the forces
  return std::log(after[0] / after[1]) / std::log(before[0] / before[1]);
}

/// F: the force per mm of thickness [N/mm].
template <mesh::Cell C, class Given>
Tip cook(int n, const Given& law, double F, Faces faces, const Way& way) {
  const auto start = std::chrono::steady_clock::now();
  const auto mesh = membrane<C>(n);
  Statics wall{mesh, law, {.first_step = way.first_step}};
  wall.fix(mesh.patch("x0"));
  if (faces == Faces::slide)
    for (const char* side : {"z0", "z1"}) wall.fix(mesh.patch(side), Axis::z);
  pull(wall, mesh, mesh.patch("x1"), Vec3(0, F / 16 * 1e6, 0));
  Tip tip{.report = wall.solve()};
  for (const StaticsStep& step : tip.report.path)
    tip.most_iterations = std::max(tip.most_iterations, step.iterations);
  tip.last_slope = la::observed_order(tip.report.history, 1e-9);
  for (Index k = 0; k < mesh.node_count(); ++k)
    if ((mesh.nodes.col(k).template head<2>() - 1e-3 * Eigen::Vector2d(48, 60)).norm() < 1e-9)
      tip.u = 1e3 * wall.displacement()(1, k);
  if constexpr (Body<C, Given>::per_node == 4) {
    const auto v = variation(wall.body().inside().pressures(wall.unknowns()), n);
    tip.variation = v[0], tip.alternating = v[1];
  }
  tip.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (tip.report && way.shake > 0) tip.slope = shaken_slope(wall, mesh, 48e-3 / n * way.shake);
  return tip;
}

Hyperelastic<NeoHooke, Quadratic> nearly(double kappa) {
  return {NeoHooke{.c10 = 0.5 * shear}, Quadratic{.kappa = kappa}};
}
const auto law = nearly(400889.8e6);

struct Inflated {
  StaticsReport report;
  double stretch = 0;  // inner, the mean over the nodes
};

/// A quarter of the thick tube of law (17), all nodes on the circles, under the pressure of an inner stretch
/// of 1.1; n cells through the wall and 4 n around.
template <mesh::Cell C, class Cured>
Inflated inflate(int n, const Cured& cured) {
  const test::ThickTube exact;
  auto mesh = [&] {
    const auto hexes = meshing::box_hexes(meshing::Block{.cells = {n, 4 * n, 1}, .hi = Vec3(1, 1, 1e-3)});
    if constexpr (mesh::Quadratic<C>)
      return mesh::quadratic<C>(hexes);
    else
      return hexes;
  }();
  for (Index k = 0; k < mesh.node_count(); ++k) {
    const double r = exact.inner + (exact.outer - exact.inner) * mesh.nodes(0, k),
                 angle = 0.5 * std::numbers::pi * mesh.nodes(1, k);
    mesh.nodes.col(k).template head<2>() = r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  Statics wall{mesh, cured(Hyperelastic{Yeoh{.c10 = exact.c10, .c20 = exact.c20},
                                        Quadratic{.kappa = 2e6 * exact.c10}})};
  for (const char* end : {"z0", "z1"}) wall.fix(mesh.patch(end), Axis::z);
  wall.fix(mesh.patch("y0"), Axis::y);
  wall.fix(mesh.patch("y1"), Axis::x);
  wall.pressure(mesh.patch("x0"), exact.pressure(1.1));
  Inflated tube{.report = wall.solve()};
  const Points<3> u = wall.displacement();
  const auto inner = mesh::patch_nodes(mesh.patch("x0"));
  for (const Index k : inner)
    tube.stretch += (mesh.nodes.col(k) + u.col(k)).template head<2>().norm() /
                    (exact.inner * static_cast<double>(inner.size()));
  return tube;
}

/// The inf-sup constants of displacements and pressures on n^3 cells of the unit cube held all round: square
/// roots of the eigenvalues of B A^-1 B^T, A = int grad u : grad v and B = int phi div u with orthonormal
/// phi.
template <mesh::Cell C, class Locking>
Eigen::VectorXd inf_sup(int n) {
  using K = Kernel<C, Locking>;
  const auto mesh = mesh::quadratic<C>(meshing::box_hexes(n));
  Eigen::VectorXi place = Eigen::VectorXi::Zero(mesh.node_count());
  for (const auto& patch : mesh.patches)
    for (const Index k : mesh::patch_nodes(patch)) place[k] = -1;
  int count = 0;
  for (int& k : place)
    if (k >= 0) k = count++;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, count),
                  B = Eigen::MatrixXd::Zero(K::modes * mesh.cell_count(), 3 * count);
  for (Index e = 0; e < mesh.cell_count(); ++e) {
    typename K::template Nodal<double> X, rest{};
    for (int a = 0; a < C::nodes; ++a)
      for (int i = 0; i < 3; ++i) X[a][i] = mesh.nodes(i, mesh.cells(a, e));
    typename K::template Forces<double> f;
    K::forces(law, X, rest, nullptr, f);
    for (int a = 0; a < C::nodes; ++a) {
      const int r = place[mesh.cells(a, e)];
      if (r < 0) continue;
      for (int k = 0; k < K::modes; ++k)
        for (int i = 0; i < 3; ++i) B(K::modes * e + k, 3 * r + i) = f.slope[k][a][i] / std::sqrt(f.volume);
      for (std::size_t q = 0; q < K::points; ++q) {
        const auto at = element_point<C, typename K::Quadrature>(X, q);
        for (int b = 0; b < C::nodes; ++b) {
          const int c = place[mesh.cells(b, e)];
          for (int i = 0; c >= 0 && i < 3; ++i) A(r, c) += at.weight * at.G[a][i] * at.G[b][i];
        }
      }
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(A);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(B.rows(), B.rows());
  for (int i = 0; i < 3; ++i) {
    const Eigen::MatrixXd Bi = B(Eigen::all, Eigen::seqN(i, count, 3));
    S += Bi * factors.solve(Bi.transpose());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues().cwiseMax(0).cwiseSqrt();
}

/// [%]
double error(const Tip& tip, double known = limit) {
  return 100 * (tip.u / known - 1);
}

Tip told(const std::string& name, int n, const Tip& tip, double known = limit) {
  REQUIRE(tip.report);
  MESSAGE(name << ", n " << n << ": " << tip.u << " mm, off by " << error(tip, known) << " %, "
               << tip.report.steps << " steps, " << tip.report.cuts << " cuts, at most "
               << tip.most_iterations << " iterations a step, slope of Newton " << tip.slope
               << ", of its last residuals " << tip.last_slope << ", " << tip.seconds << " s");
  return tip;
}

/// The whole load at once in at most 6 iterations a step; Newton ends quadratically, and the error falls with
/// n.
template <mesh::Cell C, class Given>
std::vector<Tip> ladder(const std::string& name, const Given& given, std::initializer_list<int> sizes,
                        const Way& way = of_volumes) {
  std::vector<Tip> tips;
  for (const int n : sizes) {
    tips.push_back(told(name, n, cook<C>(n, given, 100, Faces::slide, way)));
    CHECK(tips.back().slope >= 1.9);
    CHECK(tips.back().slope <= 2.1);
    CHECK(tips.back().most_iterations <= 6);
    if (tips.size() > 1) CHECK(std::abs(error(tips.back())) < std::abs(error(tips[tips.size() - 2])));
  }
  return tips;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("solid: quadratic cells with mean volumes bend a quasi-incompressible membrane") {
    const auto tets = ladder<mesh::Tet10>("Tet10", law, {8, 16});
    CHECK(std::abs(error(tets.back())) < 0.3);
    const auto full = ladder<mesh::Hex27>("Hex27", law, {4, 8, 16});
    CHECK(std::abs(error(full.back())) < 0.3);
    // One pressure is too few for a Hex20, and soft; more than one do not hold.
    const auto serendipity = ladder<mesh::Hex20>("Hex20", law, {8, 16});
    CHECK(error(serendipity[0]) > 1.8 * error(serendipity[1]));
  }

  TEST_CASE("solid: F-bar bends a quasi-incompressible membrane") {
    const auto tips = ladder<mesh::Hex8>("Hex8 with FBar", with<FBar>(law), {8, 16});
    CHECK(std::abs(error(tips.back())) < 2);
  }

  TEST_CASE("solid: F-bar and linear volumes inflate the thick tube at kappa 2e6 c10 in one step") {
    const auto check = []<mesh::Cell C>(C, const std::string& name, const auto& cured, double order) {
      std::vector<double> errors;
      for (const int n : {1, 2, 4}) {
        const Inflated tube = inflate<C>(n, cured);
        REQUIRE(tube.report);
        errors.push_back(std::abs(tube.stretch / 1.1 - 1));
        MESSAGE(name << ", " << n << " cells through the wall: inner stretch off by " << errors.back() << ", "
                     << tube.report.solve.iterations << " iterations");
        CHECK(tube.report.steps == 1);
        CHECK(tube.report.cuts == 0);
        CHECK(tube.report.solve.iterations <= 6);
        if (errors.size() > 1) CHECK(std::log2(errors[errors.size() - 2] / errors.back()) > order - 0.15);
      }
      CHECK(errors.back() < 1e-3);
    };
    check(
        mesh::Hex8{}, "Hex8 with FBar", [](const auto& pair) { return with<FBar>(pair); }, 2);
    check(
        mesh::Hex27{}, "Hex27", [](const auto& pair) { return pair; }, 3);
  }

  TEST_CASE("solid: nearly incompressible membranes bend alike from nu 0.4999 to 0.4999999") {
    const auto check = []<mesh::Cell C>(C, const std::string& name, const auto& cured) {
      std::vector<Tip> tips;
      for (const double nu : {0.4999, 0.4999999}) {
        const double kappa = 2 * shear * (1 + nu) / (3 * (1 - 2 * nu));
        tips.push_back(
            told(name + ", nu " + std::to_string(nu), 16,
                 cook<C>(16, cured(nearly(kappa)), 100, Faces::slide, {.shake = 0, .first_step = 0.25})));
        CHECK(tips.back().report.cuts == 0);
        CHECK(tips.back().most_iterations <= 6);
      }
      CHECK(std::abs(tips[1].u - tips[0].u) < 5e-3 * tips[0].u);
    };
    const auto given = [](const auto& pair) { return pair; };
    check(mesh::Hex27{}, "Hex27", given);
    check(mesh::Hex20{}, "Hex20", given);
    check(mesh::Tet10{}, "Tet10", given);
    check(mesh::Hex8{}, "Hex8 with FBar", [](const auto& pair) { return with<FBar>(pair); });
    check(mesh::Tet4{}, "Tet4 with NodalPressure",
          [](const auto& pair) { return with<NodalPressure>(pair); });
  }

  TEST_CASE("solid: displacements of Hex27 hold four pressures a cell and those of Hex20 one") {
    for (const int n : {2, 3}) {
      const Eigen::VectorXd full = inf_sup<mesh::Hex27, LinearVolume>(n),
                            one = inf_sup<mesh::Hex20, MeanVolume>(n),
                            four = inf_sup<mesh::Hex20, LinearVolume>(n);
      MESSAGE("n " << n << ": least constants of Hex27 with LinearVolume " << full[0] << " " << full[1]
                   << ", of Hex20 with MeanVolume " << one[0] << " " << one[2] << ", with LinearVolume "
                   << four[1] << " " << four[8]);
      CHECK(full[0] < 1e-6);  // the constant pressure
      CHECK(full[1] > 0.35);
      CHECK(one[2] > 0.35);   // but for the checkerboard that held faces all round leave it
      CHECK(four[8] < 1e-6);  // these alternate freely
    }
  }

  TEST_CASE("solid: linear tetrahedra with nodal pressures bend a quasi-incompressible membrane") {
    const auto tips =
        ladder<mesh::Tet4>("Tet4 with NodalPressure", with<NodalPressure>(law), {8, 16, 32}, of_forces);
    for (const Tip& tip : tips)
      MESSAGE("variation of the pressure " << 1e-6 * tip.variation << " MPa, alternating "
                                           << 1e-6 * tip.alternating << " MPa");
    CHECK(tips[2].variation < 1.3 * tips[1].variation);
    CHECK(tips[2].alternating < 0.5 * tips[2].variation);
    CHECK(tips[2].alternating < tips[1].alternating);
    const Tip locked = told("Tet4 with Pointwise", 16,
                            cook<mesh::Tet4>(16, with<Pointwise>(law), 100, Faces::slide, of_volumes));
    CHECK(error(locked) < -30);
  }

  TEST_CASE("solid: the compressible membrane between free faces reads as in two other codes") {
    constexpr double mu = 422.5e3;
    const auto given = with<Pointwise>(
        Hyperelastic{NeoHooke{.c10 = 0.5 * mu}, SimoTaylor{.kappa = 2 * mu * 1.3 / (3 * 0.4)}});
    const struct {
      int n;
      double known, within;  // [mm]
    } cases[] = {{8, 13.6081, 1e-3}, {16, 14.13, 1e-2}, {32, 14.28, 1e-2}};
    for (const auto& [n, known, within] : cases) {
      const Tip tip = told("Hex8", n, cook<mesh::Hex8>(n, given, 1, Faces::free, of_forces), 14.33);
      CHECK(std::abs(tip.u - known) < within);
      CHECK(tip.slope >= 1.9);
      if (n == 32) CHECK(tip.u == doctest::Approx(14.33).epsilon(5e-3).scale(0));
    }
    const Tip fine = told("Hex27", 8, cook<mesh::Hex27>(8, given, 1, Faces::free, of_forces), 14.33);
    CHECK(std::abs(fine.u - 14.30059) < 1e-3);
    CHECK(fine.slope >= 1.9);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("solid: quadratic cells and F-bar near 6.933 mm of the quasi-incompressible membrane") {
    const auto tets = ladder<mesh::Tet10>("Tet10", law, {32});
    CHECK(std::abs(error(tets.back())) < 0.3);
    const auto bar = ladder<mesh::Hex8>("Hex8 with FBar", with<FBar>(law), {32});
    CHECK(std::abs(error(bar.back())) < 1);
    const auto serendipity = ladder<mesh::Hex20>("Hex20", law, {16, 32});
    CHECK(error(serendipity[0]) > 1.8 * error(serendipity[1]));
    const auto full = ladder<mesh::Hex27>("Hex27", law, {16, 32});
    CHECK(std::abs(error(full.back())) < 0.3);
  }
}
