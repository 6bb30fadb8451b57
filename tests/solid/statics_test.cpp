// SPDX-License-Identifier: MIT
#include "tunica/solid/statics.hpp"
#include "tunica/la/iterative.hpp"
#include "tunica/la/multigrid.hpp"
#include "tunica/la/rigid_modes.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/arc_length.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/inverse.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/pressure_load.hpp"
#include "tunica/solid/stress.hpp"
#include "tunica/solid/volume_control.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

const Hyperelastic wall_law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}};

bool on_box(const Vec3& x) {
  return (x.array() <= 0).any() || (x.array() >= 1).any();
}

/// Cells of a unit box with the inner nodes moved at random.
mesh::HexMesh distorted_box(int n, double by) {
  auto mesh = meshing::box_hexes(n);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> jitter(-by / n, by / n);
  for (Index k = 0; k < mesh.node_count(); ++k)
    if (!on_box(mesh.nodes.col(k)))
      for (int i = 0; i < 3; ++i) mesh.nodes(i, k) += jitter(random);
  return mesh;
}

struct Counts {
  int analysed = 0, factorised = 0, solved = 0;
};

/// A direct solver that cannot be made from nothing and tells what it has done.
template <class Direct>
class Counted {
 public:
  static constexpr bool symmetric = Direct::symmetric;

  explicit Counted(Counts& counts) : counts_(&counts) {}
  void analyse(const la::SparseMatrix& A) {
    ++counts_->analysed;
    direct_.analyse(A);
  }
  SolveReport factorise(const la::SparseMatrix& A) {
    ++counts_->factorised;
    return direct_.factorise(A);
  }
  SolveReport solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    ++counts_->solved;
    return direct_.solve(b, x);
  }

 private:
  Counts* counts_;
  Direct direct_;
};

/// A multigrid that tells how often it was made and how often refreshed.
class CountedMultigrid {
 public:
  explicit CountedMultigrid(const Eigen::MatrixXd& modes) { multigrid_.near_null_space(modes); }
  SolveReport compute(const la::RowMatrix& A) {
    ++made;
    return multigrid_.compute(A);
  }
  SolveReport refresh(const la::RowMatrix& A) {
    ++refreshed;
    return multigrid_.refresh(A);
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { multigrid_.apply(r, z); }

  int made = 0, refreshed = 0;

 private:
  la::Multigrid<3, 6> multigrid_;
};

Eigen::Matrix3d gradient() {
  Eigen::Matrix3d H;
  H << 0.3, 0.2, -0.1, 0.1, -0.15, 0.2, -0.05, 0.1, 0.1;
  return H;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: patch test with an affine displacement on distorted cells") {
    const auto mesh = distorted_box(3, 0.25);
    const Hyperelastic law{Yeoh{.c10 = 1, .c20 = 2}, SimoTaylor{.kappa = 100}};
    const Eigen::Matrix3d H = gradient();
    CHECK(H.norm() > 0.45);
    Body body(mesh, law, 1.0, Mass::consistent);
    const Points<3> exact = H * mesh.nodes;
    Eigen::VectorXd f, predicted;
    REQUIRE(body.internal_forces(exact.reshaped(), la::no_step, f, predicted));
    double inside = 0;
    for (Index n = 0; n < mesh.node_count(); ++n)
      if (!on_box(mesh.nodes.col(n))) inside = std::max(inside, f.segment<3>(3 * n).norm());
    MESSAGE("residual of the affine field at the inner nodes " << inside / f.norm());
    CHECK(inside < 1e-13 * f.norm());

    // It is also found: only the boundary is prescribed.
    Statics statics{mesh, law, {.newton = {.tolerance = 1e-13}}};
    for (Index n = 0; n < mesh.node_count(); ++n)
      if (on_box(mesh.nodes.col(n)))
        for (const Axis axis : {Axis::x, Axis::y, Axis::z})
          statics.prescribe(n, axis, exact(static_cast<int>(axis), n));
    const auto report = statics.solve();
    REQUIRE(report);
    const double error = (statics.displacement() - exact).cwiseAbs().maxCoeff();
    MESSAGE("error of the solution " << error << ", order of Newton "
                                     << la::observed_order(report.history, 1e-14));
    CHECK(error < 1e-13);

    // One stress everywhere, the one of the law by hand: sigma = U' 1 + 2/J dev(Phi_1 b).
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + H, b = F * F.transpose();
    const double J = F.determinant(), I1 = b.trace() * std::pow(J, -2. / 3);
    const Eigen::Matrix3d deviatoric = b - b.trace() / 3 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d sigma = 50 * (J - 1 / J) * Eigen::Matrix3d::Identity() +
                                  2 / J * (1 + 4 * (I1 - 3)) * std::pow(J, -2. / 3) * deviatoric;
    for (const auto& field :
         {cell_stress(statics.body(), statics.unknowns()), nodal_stress(statics.body(), statics.unknowns())})
      for (Eigen::Index k = 0; k < field.cols(); ++k)
        CHECK((field.col(k) - symmetric_part<double>(sigma)).norm() < 1e-11 * sigma.norm());
    const Eigen::Matrix3d s = sigma - sigma.trace() / 3 * Eigen::Matrix3d::Identity();
    CHECK(von_mises(symmetric_part<double>(sigma)) == doctest::Approx(std::sqrt(1.5) * s.norm()));
  }

  TEST_CASE("solid: a body turned by prescribed displacements stays free of stress") {
    const auto mesh = distorted_box(2, 0.25);
    Statics statics{mesh, wall_law, {.first_step = 0.125}};
    const Eigen::Matrix3d R = Eigen::AngleAxisd(1.0, Vec3(1, 1, 0).normalized()).toRotationMatrix();
    for (Index n = 0; n < mesh.node_count(); ++n)
      if (on_box(mesh.nodes.col(n)))
        for (const Axis axis : {Axis::x, Axis::y, Axis::z})
          statics.prescribe(n, axis, (R * mesh.nodes.col(n) - mesh.nodes.col(n))[static_cast<int>(axis)]);
    REQUIRE(statics.solve());
    const double worst = cell_stress(statics.body(), statics.unknowns()).cwiseAbs().maxCoeff();
    MESSAGE("stress " << worst / 348e3 << " mu");
    CHECK(worst < 1e-11 * 348e3);
    CHECK((statics.displacement() - (R * mesh.nodes - mesh.nodes)).cwiseAbs().maxCoeff() < 1e-11);
  }

  TEST_CASE("solid: follower pressure has its exact stiffness and is symmetric on a held border") {
    auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 4e-3, .cells = {1, 8, 3}});
    Body body(mesh, wall_law, 1.0, Mass::lumped);
    body.add_pressure(mesh.patch("inner"));
    const Eigen::VectorXd p = Eigen::VectorXd::Constant(1, 2e4);
    Eigen::VectorXd u(body.unknowns());
    for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = 2e-4 * std::sin(0.7 * static_cast<double>(k));
    Eigen::VectorXd du(body.unknowns());
    for (Eigen::Index k = 0; k < u.size(); ++k) du[k] = 1e-3 * std::cos(1.3 * static_cast<double>(k));

    // The tangent with and without pressure differ by the load stiffness alone.
    const auto load_stiffness = [&](bool symmetric) {
      Eigen::VectorXd f, predicted;
      REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
      la::SparseMatrix with = body.pattern(), without = body.pattern();
      body.tangent(u, p, {.symmetric_load = symmetric}, with);
      body.tangent(u, Eigen::VectorXd::Zero(1), {}, without);
      return la::SparseMatrix(with - without);
    };
    const auto force = [&](const Eigen::VectorXd& at) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(body.unknowns());
      body.add_pressure_forces(at, p, f);
      return f;
    };
    const double h = 1e-3;  // forces are quadratic in u: the central difference is exact
    const Eigen::VectorXd slope = (force(u + h * du) - force(u - h * du)) / (2 * h);
    const la::SparseMatrix K = load_stiffness(false);
    CHECK((K * du + slope).norm() < 1e-9 * slope.norm());
    // A closed surface under pressure is in balance; this one is short of its two ends, along z only.
    const Eigen::VectorXd rest = force(Eigen::VectorXd::Zero(body.unknowns()));
    Vec3 sum = Vec3::Zero();
    for (Index n = 0; n < mesh.node_count(); ++n) sum += rest.segment<3>(3 * n);
    CHECK(sum.norm() < 1e-12 * rest.norm());

    for (const Index n : mesh::patch_nodes(mesh.patch("ends")))
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) body.fix(n, axis);
    const la::SparseMatrix held = load_stiffness(false);
    CHECK(la::SparseMatrix(held - la::SparseMatrix(held.transpose())).norm() < 1e-9 * held.norm());
    CHECK(la::SparseMatrix(held - load_stiffness(true)).norm() < 1e-9 * held.norm());
    CHECK(la::SparseMatrix(K - la::SparseMatrix(K.transpose())).norm() > 1e-3 * K.norm());
  }

  TEST_CASE("solid: statics with Lu and with Ldlt agree and loads go up and down again") {
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 8e-3, .cells = {1, 12, 4}});
    const auto inflated = [&](auto& wall) {
      wall.fix(mesh.patch("ends"));
      wall.pressure(mesh.patch("inner"), 10e3);
      REQUIRE(wall.solve());
      return wall.displacement();
    };
    Statics symmetric{mesh, wall_law};
    Statics<mesh::Hex8, decltype(wall_law), la::Lu> full{mesh, wall_law};
    const Points<3> a = inflated(symmetric), b = inflated(full);
    CHECK((a - b).norm() < 1e-9 * a.norm());
    symmetric.pressure(0, 0);
    REQUIRE(symmetric.solve());
    CHECK(symmetric.displacement().norm() < 1e-8 * a.norm());
  }

  TEST_CASE("solid: statics takes a multigrid with rigid modes and refreshes it from tangent to tangent") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {24, 6, 6}, .hi = Vec3(0.04, 0.01, 0.01)});
    const Hyperelastic law{NeoHooke{.c10 = 100e3}, Quadratic{.kappa = 2e6}};
    const auto bent = [&](auto wall) {
      wall.fix(mesh.patch("x0"));
      for (const Index n :
           mesh::patch_nodes(mesh.patch("x1"))) {  // prescribed: the start follows the tangent
        wall.prescribe(n, Axis::y, 0.004);
        wall.prescribe(n, Axis::x, -0.0004);
      }
      wall.pressure(mesh.patch("z1"), 500);
      const auto report = wall.solve();
      REQUIRE(report);
      return std::pair{report, std::move(wall)};
    };
    const auto [direct, exact] = bent(Statics{mesh, law});
    using Cg = la::Cg<CountedMultigrid>;
    const auto [iterative, wall] = bent(
        Statics{mesh, law, {}, Cg{{.tolerance = 1e-10}, CountedMultigrid(la::rigid_body_modes(mesh.nodes))}});
    const Points<3> u = exact.displacement();
    const auto& multigrid = wall.solver().preconditioner();
    MESSAGE("off by " << (wall.displacement() - u).norm() / u.norm() << ", hierarchy made " << multigrid.made
                      << " times and refreshed " << multigrid.refreshed << " times; iterations of Newton "
                      << iterative.solve.iterations << " and " << direct.solve.iterations);
    CHECK((wall.displacement() - u).norm() < 1e-9 * u.norm());
    CHECK(multigrid.made == 1);
    CHECK(multigrid.refreshed >= iterative.solve.iterations);
    CHECK(iterative.solve.iterations == direct.solve.iterations);
    CHECK(u.row(0).cwiseAbs().maxCoeff() > 1e-4);
  }

  TEST_CASE("solid: whatever solves takes a solver that is handed in and makes no other") {
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 8e-3, .cells = {1, 12, 4}});
    using Symmetric = Counted<la::Ldlt>;
    Counts counts;
    Statics wall{mesh, wall_law, {}, Symmetric(counts)};
    wall.fix(mesh.patch("ends"));
    for (const Index n : mesh::patch_nodes(mesh.patch("end1"))) wall.prescribe(n, Axis::z, 1e-4);
    const auto lumen = wall.pressure(mesh.patch("inner"), 5e3);
    const auto report = wall.solve();
    REQUIRE(report);
    CHECK(counts.analysed == 1);
    CHECK(counts.factorised == report.solve.iterations + report.steps);  // with the start that follows

    ArcLength arc{wall, {.first_step = 1e-6, .largest_step = 1e-4, .smallest_step = 1e-8}};
    wall.hold();
    wall.pressure(lumen, 10e3);
    Counts before = counts;
    REQUIRE(arc.step());
    CHECK(counts.factorised > before.factorised);
    before = counts;
    VolumeControl filling{wall, lumen};
    REQUIRE(filling.step(1.02 * filling.volume()));
    CHECK(counts.factorised > before.factorised);

    Counts moving;
    Dynamics dynamics{mesh, wall_law, 1100, {}, Symmetric(moving)};
    dynamics.fix(mesh.patch("ends"));
    REQUIRE(dynamics.start(wall.displacement(), Points<3>::Zero(3, mesh.node_count())));
    CHECK(moving.solved == 1);
    REQUIRE(dynamics.step(1e-4));
    CHECK(moving.analysed == 2);  // the mass is another matrix
    Dynamics newmark{mesh, wall_law, 1100, la::Newmark{}, {}, Symmetric(moving)};

    Counts inverse;
    Statics image{mesh, wall_law};
    image.fix(mesh.patch("ends"));
    image.pressure(mesh.patch("inner"), 5e3);
    REQUIRE(unloaded_shape(image, {}, Counted<la::Lu>(inverse)));
    CHECK(inverse.factorised > 0);
  }

  TEST_CASE("solid: load steps taken one by one are those of solve and loads may change on the way") {
    const auto mesh =
        meshing::tube({.inner_radius = 5e-3, .thickness = 1.5e-3, .length = 8e-3, .cells = {1, 12, 4}});
    const StaticsOptions options{.first_step = 0.3};
    Statics whole{mesh, wall_law, options}, stepped{mesh, wall_law, options};
    for (auto* wall : {&whole, &stepped}) {
      wall->fix(mesh.patch("ends"));
      wall->pressure(mesh.patch("inner"), 10e3);
    }
    const auto report = whole.solve();
    REQUIRE(report);
    std::vector<double> loads;
    while (!stepped.done()) {
      const auto step = stepped.step();
      REQUIRE(step);
      loads.push_back(step.load);
    }
    REQUIRE(report.path.size() == loads.size());
    CHECK(report.steps == static_cast<int>(loads.size()));
    int iterations = 0;
    for (std::size_t k = 0; k < loads.size(); ++k) {
      CHECK(report.path[k].load == loads[k]);
      CHECK(report.path[k].solve.residual < 1e-8);
      iterations += report.path[k].iterations;
    }
    CHECK(loads.front() == 0.3);
    CHECK(iterations == report.solve.iterations);
    CHECK(stepped.displacement() == whole.displacement());

    // A new end on the way: the path starts anew where it is. Not further than it is told.
    Statics turned{mesh, wall_law, options};
    turned.fix(mesh.patch("ends"));
    turned.pressure(mesh.patch("inner"), 16e3);
    REQUIRE(turned.step(0.1));
    CHECK(turned.load() == 0.1);
    turned.pressure(0, 10e3);
    CHECK(turned.load() == 0);
    CHECK(turned.pressures(0)[0] == doctest::Approx(1.6e3));
    REQUIRE(turned.solve());
    CHECK((turned.displacement() - whole.displacement()).norm() < 1e-9 * whole.displacement().norm());
  }

  TEST_CASE("solid: a mesh with an inverted cell is refused by name") {
    auto mesh = meshing::box_hexes(2);
    mesh.cells.col(3).head<4>().swap(mesh.cells.col(3).tail<4>());
    CHECK_THROWS_WITH_AS((Statics{mesh, wall_law}), "solid: cell 3 is inverted as it is given", MeshError);
  }

  TEST_CASE("solid: a node of no cell stays where it is and one that is not a number is refused by name") {
    auto mesh = meshing::box_hexes(2);
    mesh.nodes.conservativeResize(3, mesh.node_count() + 1);
    mesh.nodes.rightCols<1>() = Vec3(2, 0, 0);
    const auto pulled = [](const mesh::HexMesh& m) {
      Statics wall{m, wall_law};
      wall.fix(m.patch("x0"));
      for (const Index n : mesh::patch_nodes(m.patch("x1"))) wall.force(n, Vec3(1e3, 0, 0));
      REQUIRE(wall.solve());
      return wall.displacement();
    };
    const Points<3> with_loose = pulled(mesh), without = pulled(meshing::box_hexes(2));
    CHECK(with_loose.rightCols<1>().isZero(0));
    CHECK((with_loose.leftCols(without.cols()) - without).norm() < 1e-12 * without.norm());
    auto broken = meshing::box_hexes(2);
    broken.nodes(1, broken.cells(0, 5)) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS((Statics{broken, wall_law}), "solid: cell 0 has a node that is not a number",
                         MeshError);
  }

  TEST_CASE("solid: statics refuse a NaN displacement and tell of an equilibrium that a body would leave") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {1, 1, 20}, .hi = Vec3(1, 1, 20)});
    Statics wrong{mesh, wall_law};
    wrong.fix(mesh.patch("z0"));
    wrong.prescribe(mesh::patch_nodes(mesh.patch("z1")).front(), Axis::x,
                    std::numeric_limits<double>::quiet_NaN());
    CHECK(wrong.solve().solve.status == Status::diverged);
    CHECK(wrong.displacement().isZero(0));
    CHECK_THROWS_AS(wrong.force(mesh.node_count(), Vec3::Zero()), ContractError);
    // A straight column of slenderness 20, clamped and guided: it buckles at a strain of (2 pi/20)^2/12,
    // about 0.8 %, in both directions across alike.
    for (const auto& [pressed, unstable] : {std::pair{0.002, 0}, {0.02, 2}}) {
      Statics straight{mesh, Hyperelastic{NeoHooke{.c10 = 1e5}, Quadratic{.kappa = 1e5}}};
      straight.fix(mesh.patch("z0"));
      straight.fix(mesh.patch("z1"));
      for (const Index n : mesh::patch_nodes(mesh.patch("z1"))) straight.prescribe(n, Axis::z, -20 * pressed);
      const auto report = straight.solve();
      REQUIRE(report);
      CHECK(report.unstable == unstable);
    }
  }

  TEST_CASE("solid: a body whose law reads fibres is refused until it was given some") {
    const auto mesh = meshing::box_hexes(2);
    Statics wall{mesh,
                 Hyperelastic{HolzapfelGasserOgden{.c = 1e3, .k1 = 1e4, .k2 = 1}, Quadratic{.kappa = 1e5}}};
    wall.fix(mesh.patch("x0"));
    CHECK_THROWS_WITH_AS(wall.solve(),
                         "solid: the law reads fibres, and the body was given none: see point_field",
                         InputError);
    wall.point_field([](Index, const Vec3&) { return Fibres<double, 2>{}; });  // none, and said so
    CHECK(wall.solve());
  }
}
