// SPDX-License-Identifier: MIT
#include "tunica/solid/prestress.hpp"
#include "support/tube_cells.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/inverse.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/viscoelastic.hpp"

#include <doctest/doctest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

const Hyperelastic artery{HolzapfelGasserOgden{.c = 30e3, .k1 = 20e3, .k2 = 2}, Quadratic{.kappa = 3e6}};
constexpr double side = 0.01;  // [m]

/// Fibres at 35 degrees to x in the planes z, as they are on the mesh.
Fibres<double, 2> fibres() {
  Fibres<double, 2> f;
  const double angle = 35 * std::acos(-1.0) / 180;
  f.set(0, {std::cos(angle), std::sin(angle), 0});
  f.set(1, {std::cos(angle), -std::sin(angle), 0});
  return f;
}

/// A cube that slides on three of its sides, pulled along x by a traction that is given on its mesh.
template <class Wall>
void pull(Wall& wall, const mesh::HexMesh& mesh, double traction) {
  wall.fix(mesh.patch("x0"), Axis::x);
  wall.fix(mesh.patch("y0"), Axis::y);
  wall.fix(mesh.patch("z0"), Axis::z);
  const auto& faces = mesh.patch("x1").faces;
  std::vector<double> share(static_cast<std::size_t>(mesh.node_count()), 0);
  for (Eigen::Index f = 0; f < faces.cols(); ++f)
    for (const Index n : faces.col(f))
      share[static_cast<std::size_t>(n)] += traction * side * side / static_cast<double>(4 * faces.cols());
  for (Index n = 0; n < mesh.node_count(); ++n) wall.force(n, Vec3(share[static_cast<std::size_t>(n)], 0, 0));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: the tangent of the inverse problem is the derivative of its residual") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 2, 1}, .hi = Vec3::Constant(side)});
    Statics wall{mesh, Hyperelastic{Yeoh{.c10 = 50e3, .c20 = 100e3}, SimoTaylor{.kappa = 1e6}}};
    pull(wall, mesh, 1e4);
    detail::InverseProblem problem(wall);
    problem.load = 0.5;
    Eigen::VectorXd w(wall.body().unknowns()), dw = w, ahead, behind;
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      w[k] = 0.05 * side * std::sin(0.7 * static_cast<double>(k));
      dw[k] = std::cos(1.3 * static_cast<double>(k));
    }
    wall.body().clear_fixed(w);
    wall.body().clear_fixed(dw);
    const double h = 1e-5 * side;
    REQUIRE(problem.residual(w + h * dw, ahead, la::no_step).admissible);
    REQUIRE(problem.residual(w - h * dw, behind, la::no_step).admissible);
    la::SparseMatrix A = problem.pattern();
    problem.tangent(w, A);
    const Eigen::VectorXd slope = (ahead - behind) / (2 * h);
    CHECK((A * dw - slope).norm() < 1e-8 * slope.norm());
  }

  TEST_CASE("solid: in a homogeneous body the prestress is the inverse of the unloaded shape") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 1, 1}, .hi = Vec3::Constant(side)});
    // The law without its fibres first: the unloaded shape is found on the image's own frame there.
    const Hyperelastic rubber{NeoHooke{.c10 = 15e3}, Quadratic{.kappa = 3e6}};
    Statics wall{mesh, rubber}, imaged{mesh, rubber};
    pull(wall, mesh, 20e3);
    pull(imaged, mesh, 20e3);
    const auto free = unloaded_shape(imaged);
    REQUIRE(free);
    const Vec3 size = free.nodes.rowwise().maxCoeff();
    const Vec3 stretch = side * size.cwiseInverse();
    const auto report = prestress(wall, {.steps = 200});
    REQUIRE(report);
    const Eigen::Matrix3d F = wall.body().laws().prestress().front();
    MESSAGE("stretches " << stretch.transpose() << ", stored " << F.diagonal().transpose() << ", drift "
                         << report.drift / side << ", residual " << report.residual);
    CHECK((F.diagonal() - stretch).norm() < 2e-3 * (stretch - Vec3::Ones()).norm());
    CHECK((F - Eigen::Matrix3d(F.diagonal().asDiagonal())).norm() < 1e-10);
    // The stress is what the traction asks for.
    const auto sigma = Body<mesh::Hex8, Hyperelastic<NeoHooke, Quadratic>>::Element::stress(
        rubber, wall.body().reference(0), wall.body().gather(0, wall.unknowns()), wall.body().data(0));
    CHECK(sigma.sigma(0, 0) == doctest::Approx(20e3).epsilon(1e-3));
    CHECK(std::abs(sigma.sigma(1, 0)) < 20);
  }

  TEST_CASE("solid: the unloaded shape of a fibrous body comes back to its image with its fibres") {
    auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 2, 1}, .hi = Vec3::Constant(side)});
    const Points<3> image = mesh.nodes;
    Statics imaged{mesh, artery};
    imaged.point_field([](Index, const Vec3&) { return fibres(); });
    pull(imaged, mesh, 30e3);
    const auto free = unloaded_shape(imaged);
    REQUIRE(free);
    MESSAGE("residual " << free.solve.residual << " in " << free.solve.iterations << " iterations, order "
                        << la::observed_order(free.history, 1e-10));
    CHECK(la::observed_order(free.history, 1e-10) >= 1.9);
    // Homogeneous: one F, by which the fibres go back.
    const Vec3 stretch = side * free.nodes.rowwise().maxCoeff().cwiseInverse();
    CHECK(stretch[0] > 1.05);
    Fibres<double, 2> back = fibres();
    pull_back(stretch.asDiagonal().toDenseMatrix(), back);
    mesh.nodes = free.nodes;
    Statics wall{mesh, artery};
    wall.point_field([&](Index, const Vec3&) { return back; });
    wall.fix(mesh.patch("x0"), Axis::x);
    wall.fix(mesh.patch("y0"), Axis::y);
    wall.fix(mesh.patch("z0"), Axis::z);
    for (Index n = 0; n < mesh.node_count(); ++n)
      wall.force(n, imaged.external(imaged.unknowns(), 1).segment<3>(3 * n));
    REQUIRE(wall.solve());
    const double off = (mesh.nodes + wall.displacement() - image).cwiseAbs().maxCoeff();
    MESSAGE("loaded again it is off its image by " << off / side << " of its side, stretches "
                                                   << stretch.transpose());
    CHECK(off < 1e-9 * side);
  }

  TEST_CASE("solid: fibres are carried back by the stored deformation and the tangent knows of both") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 1, 1}, .hi = Vec3::Constant(side)});
    Statics wall{mesh, artery};
    for (Index e = 0; e < mesh.cell_count(); ++e) wall.laws().point_data(e, fibres());
    pull(wall, mesh, 30e3);
    const auto report = prestress(wall, {.steps = 20});
    REQUIRE(report);
    const auto data = wall.body().data(0);
    const Eigen::Matrix3d F = data.prestress[0];
    const Vec3 given(fibres()[0][0], fibres()[0][1], 0);
    const Vec3 back(data.points[0][0][0], data.points[0][0][1], data.points[0][0][2]);
    CHECK(back.norm() == doctest::Approx(1).epsilon(1e-14));
    CHECK((F * back).normalized().dot(given) == doctest::Approx(1).epsilon(1e-14));
    CHECK(back.dot(given) < 1 - 1e-5);  // they had been turned towards the pull

    // Forces and tangent with fibres and prestress against each other and against the energy.
    auto body = wall.body();
    Eigen::VectorXd u(body.unknowns()), du = u, f, ahead, behind, predicted;
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      u[k] = 0.03 * side * std::sin(0.7 * static_cast<double>(k));
      du[k] = std::cos(1.3 * static_cast<double>(k));
    }
    const double h = 1e-5 * side;
    REQUIRE(body.internal_forces(u + h * du, la::no_step, ahead, predicted));
    REQUIRE(body.internal_forces(u - h * du, la::no_step, behind, predicted));
    REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
    const double work = (body.strain_energy(u + h * du) - body.strain_energy(u - h * du)) / (2 * h);
    CHECK(f.dot(du) == doctest::Approx(work).epsilon(1e-6));
    auto free = Body(mesh, artery, 1.0, Mass::lumped);  // the same without fixed unknowns
    for (Index e = 0; e < mesh.cell_count(); ++e) free.laws().point_data(e, fibres());
    free.laws().prestress(body.laws().prestress());
    REQUIRE(free.internal_forces(u, la::no_step, f, predicted));
    la::SparseMatrix K = free.pattern();
    free.tangent(u, Eigen::VectorXd(0), {}, K);
    const Eigen::VectorXd slope = (ahead - behind) / (2 * h);
    CHECK((K * du - slope).norm() < 1e-6 * slope.norm());
  }

  TEST_CASE("solid: a prestressed wall in dynamics stays where it was imaged") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 2, 2}, .hi = Vec3::Constant(side)});
    const Hyperelastic rubber{NeoHooke{.c10 = 15e3}, Quadratic{.kappa = 3e6}};
    Statics wall{mesh, rubber};
    pull(wall, mesh, 5e3);
    REQUIRE(prestress(wall, {.steps = 20}));
    Dynamics moving{mesh, rubber, 1100.0}, bare{mesh, rubber, 1100.0};
    moving.laws().prestress(wall.body().laws().prestress());
    for (auto* d : {&moving, &bare}) {
      pull(*d, mesh, 5e3);
      REQUIRE(d->start(wall.displacement(), Points<3>::Zero(3, mesh.node_count())));
      for (int k = 0; k < 20; ++k) REQUIRE(d->step(1e-4));
    }
    const double moved = (moving.nodal_displacement() - wall.displacement()).cwiseAbs().maxCoeff(),
                 swung = bare.nodal_displacement().cwiseAbs().maxCoeff();
    MESSAGE("moved " << moved / side << " of its side, without prestress " << swung / side);
    CHECK(moved < 1e-8 * side);
    CHECK(swung > 1e-2 * side);
  }

  TEST_CASE("solid: a wall of linear tetrahedra with nodal pressures stays where it was imaged") {
    const test::ThickTube tube;
    const double inner = 5.2688758130e-3, outer = 6.7090276741e-3, p = 15998.687;
    const auto mesh = test::quarter_of_tube<mesh::Tet4>(3, inner, outer);
    const Hyperelastic law{Yeoh{.c10 = tube.c10, .c20 = tube.c20}, SimoTaylor{.kappa = 1e4 * 2 * tube.c10}};
    auto wall = test::wall_of_tube(mesh, with<NodalPressure>(law), p);
    const auto report = prestress(wall, {.steps = 20});
    REQUIRE(report);
    MESSAGE("settled " << report.settlings << " times, " << report.solve.iterations
                       << " iterations: residual " << report.residual << ", drift "
                       << report.drift / (2 * outer) << " of the diameter");
    CHECK(report.residual <= 1e-6);
    CHECK(report.drift < 1e-6 * 2 * outer);
    // Another wall with what was stored finds the same place, under its pressures from nothing.
    auto again = test::wall_of_tube(mesh, with<NodalPressure>(law), p);
    again.laws().prestress(wall.body().laws().prestress());
    REQUIRE(again.solve());
    const double moved = again.displacement().cwiseAbs().maxCoeff();
    const Eigen::VectorXd there = again.body().inside().pressures(again.unknowns()),
                          here = wall.body().inside().pressures(wall.unknowns());
    MESSAGE("a wall that takes it moves by " << moved / (2 * outer) << " of the diameter, its pressures by "
                                             << (there - here).norm() / here.norm());
    CHECK(moved < 1e-6 * outer);
    CHECK((there - here).norm() < 1e-4 * here.norm());
    // Mean hoop stress p r/t, and without the stored deformation the wall swells.
    const StressField sigma = cell_stress(wall.body(), wall.unknowns());
    double force = 0, area = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Vec3 x = Vec3::Zero();
      for (const Index k : mesh.cells.col(e)) x += mesh.nodes.col(k) / 4;
      const double r = x.head<2>().norm(), c = x[0] / r, s = x[1] / r;
      force += (s * s * sigma(0, e) + c * c * sigma(1, e) - 2 * c * s * sigma(3, e)) / r;
      area += 1 / r;  // cells of one angle and one thickness: volumes as r, int s_tt dr over them
    }
    const double mean = p * inner / (outer - inner);
    MESSAGE("mean hoop stress " << force / area / mean << " of p r/t");
    CHECK(force / area == doctest::Approx(mean).epsilon(0.02));
    auto bare = test::wall_of_tube(mesh, with<NodalPressure>(law), p);
    REQUIRE(bare.solve());
    CHECK(bare.displacement().cwiseAbs().maxCoeff() > 0.03 * inner);
    // In motion it rests, from its first step on: the pressures that belong to it are found at the start.
    Dynamics moving{mesh, with<NodalPressure>(law), 1100.0};
    for (const char* end : {"z0", "z1"}) moving.fix(mesh.patch(end), Axis::z);
    moving.fix(mesh.patch("y0"), Axis::y);
    moving.fix(mesh.patch("y1"), Axis::x);
    moving.pressure(mesh.patch("x0"), p);
    moving.laws().prestress(wall.body().laws().prestress());
    REQUIRE(moving.start(wall.displacement(), Points<3>::Zero(3, mesh.node_count())));
    CHECK(moving.nodal_acceleration().cwiseAbs().maxCoeff() < 1e-5 * p / (1100 * (outer - inner)));
    for (int k = 0; k < 10; ++k) REQUIRE(moving.step(1e-4));
    const double drifted = (moving.nodal_displacement() - wall.displacement()).cwiseAbs().maxCoeff();
    MESSAGE("in ten steps it moves by " << drifted / (2 * outer) << " of the diameter");
    CHECK(drifted < 1e-6 * outer);
  }

  TEST_CASE(
      "solid: tetrahedra with nodal pressures start to swing from a stretched state with all its energy") {
    const auto mesh = meshing::box_tets(meshing::Block{.cells = {2, 2, 4}, .hi = Vec3(2e-3, 2e-3, 8e-3)});
    const Hyperelastic law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, SimoTaylor{.kappa = 348e5}};
    Statics held{mesh, with<NodalPressure>(law)};
    held.fix(mesh.patch("z0"));
    for (const Index n : mesh::patch_nodes(mesh.patch("z1"))) held.prescribe(n, Axis::x, 1e-3);
    REQUIRE(held.solve());
    Dynamics rod{mesh, with<NodalPressure>(law), 1100.0};
    rod.fix(mesh.patch("z0"));
    REQUIRE(rod.start(held.displacement(), Points<3>::Zero(3, mesh.node_count())));
    const double first = rod.strain_energy(), there = held.body().strain_energy(held.unknowns());
    double most = 0, kinetic = 0;
    for (int k = 0; k < 40; ++k) {
      REQUIRE(rod.step(5e-5));
      most = std::max(most, rod.strain_energy() + rod.kinetic_energy());
      kinetic = std::max(kinetic, rod.kinetic_energy());
    }
    MESSAGE("energy at first " << first << " J, of the held rod " << there << " J; later at most " << most
                               << " J, of it in motion " << kinetic << " J");
    CHECK(first == doctest::Approx(there).epsilon(1e-9));
    CHECK(most < 1.02 * first);
    CHECK(kinetic > 0.5 * first);
  }

  TEST_CASE("solid: a viscoelastic fibrous wall remembers its prestress as long past and rests in it") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {2, 1, 1}, .hi = Vec3::Constant(side)});
    const Hyperelastic slow{Viscoelastic{artery.isochoric, std::array{Prony{.ratio = 0.8, .time = 0.02}}},
                            artery.volumetric};
    using Slow = decltype(slow.isochoric);
    const auto given = Slow::at_rest(fibres());
    Statics wall{mesh, slow};
    Statics elastic{mesh, artery};
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      wall.laws().point_data(e, given);
      elastic.laws().point_data(e, fibres());
    }
    pull(wall, mesh, 30e3);
    pull(elastic, mesh, 30e3);
    const auto report = prestress(wall, {.steps = 20});
    REQUIRE(report);
    REQUIRE(prestress(elastic, {.steps = 20}));
    // It is that of the law which is left when all is forgotten, with its fibres carried back.
    const auto data = wall.body().data(0);
    const auto other = elastic.body().data(0);
    CHECK((data.prestress[0] - other.prestress[0]).norm() < 1e-9);
    CHECK((data.prestress[0] - Eigen::Matrix3d::Identity()).norm() > 0.05);
    for (std::size_t k = 0; k < 6; ++k)
      CHECK(data.points[0].m[k] == doctest::Approx(other.points[0].m[k]).epsilon(1e-9));
    CHECK(std::abs(data.points[0].m[0] - fibres().m[0]) > 1e-3);

    Dynamics moving{mesh, slow, 1100.0}, forgetful{mesh, slow, 1100.0};
    for (auto* d : {&moving, &forgetful}) {
      for (Index e = 0; e < mesh.cell_count(); ++e) d->laws().point_data(e, given);
      d->laws().prestress(wall.body().laws().prestress());
      pull(*d, mesh, 30e3);
    }
    remember(moving.laws(), remembered(wall.laws()));
    for (auto* d : {&moving, &forgetful}) {
      REQUIRE(d->start(wall.displacement(), Points<3>::Zero(3, mesh.node_count())));
      for (int k = 0; k < 40; ++k) REQUIRE(d->step(1e-3));  // two times that of the branch
    }
    const double moved = (moving.nodal_displacement() - wall.displacement()).cwiseAbs().maxCoeff(),
                 swung = (forgetful.nodal_displacement() - wall.displacement()).cwiseAbs().maxCoeff();
    MESSAGE("drift " << report.drift / side << "; moved " << moved / side
                     << " of its side, without its memory " << swung / side);
    CHECK(moved < 1e-6 * side);
    CHECK(swung > 1e-3 * side);
  }

  TEST_CASE("solid: a frame of fibres under a prestress stays orthogonal and three families do not") {
    const auto mesh = meshing::box_hexes(1);
    const Hyperelastic muscle{Isochoric{Guccione{.C = 2e3, .bf = 8, .bt = 2, .bfs = 4}},
                              Quadratic{.kappa = 1e6}};
    Statics wall{mesh, muscle};
    Fibres<double, 3> axes;
    axes.set(0, {0.6, 0.8, 0});
    axes.set(1, {-0.8, 0.6, 0});
    axes.set(2, {0, 0, 1});
    wall.laws().point_data(0, axes);
    Eigen::Matrix3d F;
    F << 1.2, 0.3, 0, 0, 0.9, 0.1, 0.05, 0, 1;
    wall.laws().prestress(std::vector<Eigen::Matrix3d>(8, F));
    const auto& at = wall.body().data(0).points[0];
    Eigen::Matrix3d Q;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) Q(i, k) = at[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
    CHECK((Q.transpose() * Q - Eigen::Matrix3d::Identity()).norm() < 1e-14);
    CHECK(Q.determinant() == doctest::Approx(1));
    CHECK((F * Q.col(0)).normalized().dot(Vec3(0.6, 0.8, 0)) == doctest::Approx(1).epsilon(1e-14));
    CHECK(std::abs(Q.col(1).dot((F.inverse() * Vec3(-0.8, 0.6, 0)).cross(Q.col(0)).normalized())) < 1e-14);
    Fibres<double, 3> families = axes;
    pull_back(F, families);
    CHECK(std::abs(dot(families[0], families[1])) > 0.01);
  }
}
