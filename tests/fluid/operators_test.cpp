// SPDX-License-Identifier: MIT
// The discrete operators of a step, each against what it must do to simple fields.
#include "support/flow.hpp"
#include "tunica/fluid/bdf.hpp"
#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/coarse_space.hpp"
#include "tunica/fluid/consistent_mass.hpp"
#include "tunica/fluid/divergence.hpp"
#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/element.hpp"
#include "tunica/fluid/field.hpp"
#include "tunica/fluid/interface_force.hpp"
#include "tunica/fluid/momentum.hpp"
#include "tunica/fluid/predictor.hpp"
#include "tunica/fluid/pressure_operator.hpp"
#include "tunica/fluid/pressure_response.hpp"
#include "tunica/fluid/pressure_step.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/fluid/rheology.hpp"
#include "tunica/fluid/stabilization.hpp"
#include "tunica/fluid/start.hpp"
#include "tunica/fluid/state.hpp"
#include "tunica/fluid/total_flux.hpp"
#include "tunica/fluid/unit_response.hpp"
#include "tunica/fluid/weak_pressure.hpp"
#include "tunica/la/vector_ops.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"

#include <doctest/doctest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

/// A shaken box of unit edges with all that a Domain refers to.
struct Cube {
  explicit Cube(int n) : mesh(shaken(n)), pattern(mesh), conditions(mesh) {
    REQUIRE(tets.update(mesh.nodes, mesh.cells));
    inverse_mass.setZero(mesh.node_count());
    for (Index e = 0; e < mesh.cell_count(); ++e)
      for (int a = 0; a < 4; ++a) inverse_mass[mesh.cells(a, e)] += tets[e].volume / 4;
    inverse_mass = inverse_mass.cwiseInverse().eval();
  }
  static mesh::TetMesh shaken(int n) {
    auto mesh = meshing::box_tets(n);
    test::shake(mesh, 0.2 / n);
    return mesh;
  }
  [[nodiscard]] fluid::Domain domain() const {
    return {pattern, mesh.cells, tets, mesh.nodes, inverse_mass, conditions};
  }

  mesh::TetMesh mesh;
  fluid::Pattern pattern;
  fluid::Conditions conditions;
  fem::P1Tets tets;
  Eigen::VectorXd inverse_mass;
};

/// Every inner node moved at random, as far as each of its tetrahedra keeps a twentieth of their mean volume.
mesh::TetMesh ruined(mesh::TetMesh mesh, std::uint64_t seed) {
  std::vector<char> boundary(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const auto& patch : mesh.patches)
    for (const Index n : mesh::patch_nodes(patch)) boundary[static_cast<std::size_t>(n)] = 1;
  const mesh::Rows around = mesh::cells_of_nodes(mesh.cells, mesh.node_count());
  test::Noise next(seed);
  for (Index n = 0; n < mesh.node_count(); ++n) {
    if (boundary[static_cast<std::size_t>(n)]) continue;
    double mean = 0;
    for (const Index e : around[n])
      mean += fem::p1_tet(mesh.nodes, mesh.cells, e).volume / static_cast<double>(around[n].size());
    const Vec3 was = mesh.nodes.col(n);
    Vec3 step = 3 * std::cbrt(mean) * Vec3(next(), next(), next());
    const auto sound = [&] {
      return std::all_of(around[n].begin(), around[n].end(),
                         [&](Index e) { return fem::p1_tet(mesh.nodes, mesh.cells, e).volume > mean / 20; });
    };
    for (int k = 0; k < 12; ++k, step *= 0.6) {
      mesh.nodes.col(n) = was + step;
      if (sound()) break;
      mesh.nodes.col(n) = was;
    }
  }
  return mesh;
}

Eigen::VectorXd noise(Eigen::Index n, std::uint64_t seed) {
  test::Noise next(seed);
  Eigen::VectorXd x(n);
  for (double& value : x) value = next();
  return x;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fluid: backward differences are exact for parabolas at any ratio of steps") {
    const auto f = [](double t) { return 3 - 2 * t + 5 * t * t; };
    for (const double last : {0.1, 0.05, 0.4}) {
      const double t = 0.7, dt = 0.1;
      const fluid::Bdf bdf = fluid::bdf2(dt, last);
      const double rate = bdf.now * f(t) + bdf.last * f(t - dt) + bdf.before * f(t - dt - last);
      CHECK(rate == doctest::Approx(-2 + 10 * t));
      CHECK(bdf.extrapolate_last * (t - dt) + bdf.extrapolate_before * (t - dt - last) == doctest::Approx(t));
    }
    CHECK(fluid::bdf1(0.1).now == doctest::Approx(10));
  }

  TEST_CASE("fluid: stabilisation times follow their limits and hold no time step") {
    const fluid::Fic fic;
    CHECK(fic.mass(1050, 0.0035, 1e-3, 0) == doctest::Approx(1e-6 / (8 * 0.0035)));
    CHECK(fic.mass(1050, 1e-9, 1e-3, 0.5) == doctest::Approx(1e-3 / (2 * 1050 * 0.5)));
    CHECK(fic.momentum(1050, 1e-9, 1e-3, 2e-4, 0.5) == doctest::Approx(2e-4 / (2 * 1050 * 0.5)));
    CHECK(fluid::Fic{.wave_speed = 5}.mass(1050, 1e-9, 1e-3, 0) == doctest::Approx(1e-3 / (2 * 1050 * 5)));
    CHECK(fluid::Unstabilized{}.mass(1050, 0.0035, 1e-3, 1) == 0);
    CHECK(fluid::constant_viscosity<fluid::Newtonian>);
  }

  TEST_CASE("fluid: gradients on an element are those of a linear field") {
    const Cube box(3);
    Eigen::Matrix3d slope;
    slope << 1, 2, -3, 0.5, -1, 4, 2, 0, 7;
    const Points<3> u = slope * box.mesh.nodes;
    const Eigen::VectorXd p = (slope.row(0) * box.mesh.nodes).transpose();
    for (Index e = 0; e < box.mesh.cell_count(); e += 7) {
      const auto& tet = box.tets[e];
      const auto ue = fluid::nodal(u, box.mesh.cells, e);
      const auto pe = fluid::nodal(p, box.mesh.cells, e);
      CHECK((fluid::gradient(ue, tet.grad) - slope).norm() < 1e-12);
      CHECK((fluid::gradient(pe, tet.grad) - slope.row(0).transpose()).norm() < 1e-12);
      CHECK((fluid::mean(ue) - ue.rowwise().mean()).norm() < 1e-14);
      CHECK(fluid::along(Vec3(1, 2, 3), tet.grad, 2) == doctest::Approx(Vec3(1, 2, 3).dot(tet.grad.col(2))));
      // t_m and h_a know the direction: along an axis of a box the element is as long as its edge at most
      const auto flow =
          fluid::element_flow(fluid::Newtonian{.density = 1, .viscosity = 1e-9}, fluid::Fic{}, tet, ue, ue);
      CHECK(flow.viscosity == 1e-9);
      CHECK(flow.stabilisation > 0);
    }
  }

  TEST_CASE("fluid: nodal fields add and scale and a NaN among them is found") {
    Points<3> a = Points<3>::Constant(3, 4, 2), b = Points<3>::Constant(3, 4, 5), y;
    fluid::combine(3, a, -1, b, y);
    CHECK((y.array() == 1).all());
    fluid::combine(2, y, 1, y, y);  // in place
    CHECK((y.array() == 3).all());
    fluid::add(y, 1, 2, Vec3(1, 2, 3));
    CHECK(fluid::column(y, 1) == Vec3(5, 7, 9));
    fluid::scale_columns(y, Eigen::Vector4d(1, 10, 1, 1));
    CHECK(fluid::column(y, 1) == Vec3(50, 70, 90));
    CHECK(fluid::finite(y.data(), y.size()));
    y(2, 3) = std::numeric_limits<double>::quiet_NaN();
    CHECK(!fluid::finite(y.data(), y.size()));
    y(2, 3) = std::numeric_limits<double>::infinity();
    CHECK(!fluid::finite(y.data(), y.size()));
    CHECK((fluid::face_load(12, Vec3(1, 2, 3)) - Vec3(7, 8, 9)).norm() < 1e-14);
  }

  TEST_CASE("fluid: the pressure operator is symmetric and its stabilisation spares linear pressures") {
    const Cube box(4);
    const Index n = box.mesh.node_count();
    const std::vector<double> tau(static_cast<std::size_t>(box.mesh.cell_count()), 0.3);
    fluid::PressureOperator T(box.pattern);
    const auto whole = fluid::UnitResponse::whole(n);
    T.assemble(box.domain(), whole, tau, 0);
    Eigen::VectorXd y, z;
    T.apply(Eigen::VectorXd(Eigen::VectorXd::Ones(n)), y);
    CHECK(y.norm() < 1e-13);
    const Eigen::VectorXd linear = (Vec3(1, -2, 3).transpose() * box.mesh.nodes).transpose();
    T.apply(linear, y);
    CHECK(y.norm() < 1e-13);
    for (int k = 1; k < 5; ++k) {
      const Eigen::VectorXd p = noise(n, std::uint64_t(k)), q = noise(n, std::uint64_t(k) + 50);
      T.apply(p, y), T.apply(q, z);
      CHECK(q.dot(y) == doctest::Approx(p.dot(z)));
      CHECK(p.dot(y) > 0);
      CHECK(T.round_off(p) < 1e-10 * y.norm());
    }
    // With gamma alone it is the Laplacian: (grad x, grad x) is the volume.
    T.assemble(box.domain(), whole, std::vector<double>(tau.size(), 0), 2);
    const Eigen::VectorXd x = box.mesh.nodes.row(0).transpose();
    T.apply(x, y);
    CHECK(x.dot(y) == doctest::Approx(2));
  }

  TEST_CASE("fluid: a weakly prescribed pressure leaves no row of a linear pressure out") {
    Cube box(4);
    for (const auto* side : test::box_sides) box.conditions[side].kind = fluid::Kind::pressure;
    box.conditions.flag();
    const Index n = box.mesh.node_count();
    fluid::PressureOperator A(box.pattern);
    const auto whole = fluid::UnitResponse::whole(n);
    A.assemble(box.domain(), whole, std::vector<double>(static_cast<std::size_t>(box.mesh.cell_count()), 0),
               1);
    // (grad q, grad p) - <q, dp/dn> = 0 for every q, also on the patches: there p is what is prescribed.
    const Eigen::VectorXd linear = (Vec3(1, -2, 3).transpose() * box.mesh.nodes).transpose();
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd y, z;
    A.apply(linear, y);
    fluid::for_each_weak_face(box.domain(), whole, [&](const fluid::WeakFace& face) {
      for (int i = 0; i < 4; ++i) y[face.node(i)] += face.form(i, zero, linear);
    });
    CHECK(y.norm() < 1e-12);
    for (std::uint64_t k = 0; k < 20; ++k) {
      const Eigen::VectorXd p = noise(n, k), q = noise(n, k + 50);
      A.apply(p, y), A.apply(q, z);
      CHECK(q.dot(y) == doctest::Approx(p.dot(z)));
      CHECK(p.dot(y) > 0);
    }
  }

  TEST_CASE("fluid: the weak form is positive on any tetrahedron however many of its faces count") {
    test::Noise next(7);
    for (int trial = 0; trial < 200; ++trial) {
      mesh::TetMesh mesh;
      mesh.nodes.resize(3, 4), mesh.cells.resize(4, 1);
      for (Eigen::Index k = 0; k < 12; ++k) mesh.nodes.data()[k] = next();
      const Vec3 a = mesh.nodes.col(0), b = mesh.nodes.col(1), c = mesh.nodes.col(2), d = mesh.nodes.col(3);
      mesh.cells.col(0) << 0, 1, 2, 3;
      if ((b - a).cross(c - a).dot(d - a) < 0) mesh.cells.col(0) << 0, 2, 1, 3;
      for (int f = 0; f < 4; ++f) {
        mesh::Patch<mesh::Tri3> side{.name = std::to_string(f), .faces = Connectivity<3>(3, 1)};
        for (int k = 0; k < 3; ++k) side.faces(k, 0) = mesh.cells((f + (f % 2 == 0 ? 1 + k : 3 - k)) % 4, 0);
        mesh.patches.push_back(side);
      }
      fluid::Conditions conditions(mesh);
      fem::P1Tets tets;
      REQUIRE(tets.update(mesh.nodes, mesh.cells));
      const fluid::Pattern pattern(mesh);
      const Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(4, 4 / tets[0].volume);
      for (int patches = 1; patches <= 4; ++patches) {
        conditions[std::to_string(patches - 1)].kind = fluid::Kind::pressure;
        conditions.flag();
        fluid::PressureOperator A(pattern);
        A.assemble({pattern, mesh.cells, tets, mesh.nodes, inverse_mass, conditions},
                   fluid::UnitResponse::whole(4), {0.0}, 1);
        Eigen::Matrix4d dense;
        Eigen::VectorXd column;
        for (Index i = 0; i < 4; ++i) {
          A.apply(Eigen::VectorXd(Eigen::VectorXd::Unit(4, i)), column);
          dense.col(i) = column;
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(dense, Eigen::EigenvaluesOnly);
        CHECK(eigen.eigenvalues().minCoeff() > 0);
      }
    }
  }

  TEST_CASE("fluid: linear increments and uniform loads bring the flux that the velocity gets") {
    Cube box(5);
    box.conditions["x1"].kind = fluid::Kind::pressure;
    box.conditions.flag();
    const fluid::Condition& outlet = std::as_const(box.conditions)["x1"];
    fluid::ConsistentMass<> mass(box.pattern);
    mass.assemble(box.domain());
    auto response = mass.response(box.domain());
    response.least = 0;  // the loads as they are, not as much as keeps the form positive
    for (const Index n : std::as_const(box.conditions)["y0"].nodes) CHECK(response.gradient[n] == 0);
    const auto flux = [&](const Points<3>& v) {
      return fluid::Conditions::flux(box.mesh.nodes, outlet.faces, v);
    };
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(box.mesh.node_count());
    const auto form = [&](const Eigen::VectorXd& p, const Eigen::VectorXd& c) {
      double sum = 0;
      fluid::for_each_weak_face(box.domain(), response, [&](const fluid::WeakFace& face) {
        for (int i = 0; i < 4; ++i) sum += face.form(i, p, c);
      });
      return sum;
    };
    // dp = c = g.x: the velocity gets -P g
    const Vec3 g(3, -2, 1);
    const Eigen::VectorXd p = (g.transpose() * box.mesh.nodes).transpose();
    const Points<3> v = -g * response.gradient.transpose();
    CHECK(form(p, p) == doctest::Approx(flux(v)).epsilon(1e-5));
    // dp = 0, c = -1: the velocity gets P <N n>
    CHECK(form(zero, Eigen::VectorXd::Constant(zero.size(), -1)) ==
          doctest::Approx(flux(response.load)).epsilon(1e-5));
  }

  TEST_CASE("fluid: the divergence of a linear velocity is its trace times the share of each node") {
    const Cube box(3);
    const Points<3> u = Vec3(2, -5, 4).asDiagonal() * box.mesh.nodes;
    Eigen::VectorXd div;
    fluid::divergence(box.domain(), u, div);
    CHECK((div - box.inverse_mass.cwiseInverse()).norm() < 1e-13);
  }

  TEST_CASE("fluid: the updated form has the flux that the velocity gets for any increment") {
    Cube box(5);
    for (const auto* side : {"x1", "y1"}) box.conditions[side].kind = fluid::Kind::pressure;
    box.conditions.flag();
    const auto& ports = std::as_const(box.conditions).list();
    const Index n = box.mesh.node_count();
    fluid::ConsistentMass<> mass(box.pattern);
    mass.assemble(box.domain());
    const auto response = mass.response(box.domain());
    const auto total = fluid::total_flux(box.domain(), response);
    CHECK(total.f_sum > 0);
    CHECK(total.g_sum > 0);
    fluid::PressureOperator A(box.pattern), updated(box.pattern);
    const std::vector<double> tau(static_cast<std::size_t>(box.mesh.cell_count()), 0);
    A.assemble(box.domain(), response, tau, 2);
    updated.assemble(box.domain(), response, tau, 2, total);
    Eigen::VectorXd y, z;
    A.apply(Eigen::VectorXd(Eigen::VectorXd::Ones(n)), y);
    CHECK((y - 2 * total.g).norm() < 1e-12 * y.norm());
    updated.apply(Eigen::VectorXd(Eigen::VectorXd::Ones(n)), y);
    CHECK((y - 2 * total.f).norm() < 1e-12 * y.norm());
    for (std::uint64_t k = 0; k < 10; ++k) {
      const Eigen::VectorXd p = noise(n, k), q = noise(n, k + 50);
      updated.apply(p, y), updated.apply(q, z);
      CHECK(q.dot(y) == doctest::Approx(p.dot(z)));
      CHECK(p.dot(y) > 0);
      // u = -M^-1 (int N grad p - <N (p - c) n>), all its flux
      Eigen::VectorXd c = Eigen::VectorXd::Zero(n);
      Points<3> u = Points<3>::Zero(3, n);
      for (Index e = 0; e < box.mesh.cell_count(); ++e)
        for (int a = 0; a < 4; ++a)
          u.col(box.mesh.cells(a, e)) -=
              box.tets[e].volume / 4 * fluid::gradient(fluid::nodal(p, box.mesh.cells, e), box.tets[e].grad);
      for (const auto& port : ports) {
        if (port.kind != fluid::Kind::pressure) continue;
        for (const Index i : port.nodes) c[i] = q[i];
        for (Eigen::Index f = 0; f < port.faces.cols(); ++f) {
          Vec3 excess;
          for (int i = 0; i < 3; ++i) excess[i] = p[port.faces(i, f)] - q[port.faces(i, f)];
          const Vec3 load = fluid::face_load(1, excess),
                     area = fluid::Conditions::area_vector(box.mesh.nodes, port.faces, f);
          for (int i = 0; i < 3; ++i) u.col(port.faces(i, f)) += load[i] * area;
        }
      }
      REQUIRE(mass.solve(box.domain(), u, {.tolerance = 1e-12}));
      double flux = 0;
      for (const auto& port : ports) flux += fluid::Conditions::flux(box.mesh.nodes, port.faces, u);
      CHECK(total.of_velocity(p, c) == doctest::Approx(flux).epsilon(1e-6));
    }
  }

  TEST_CASE("fluid: the weak form is positive on flat and on ruined elements") {
    const auto check = [](mesh::TetMesh mesh, const std::string& name) {
      fluid::Conditions conditions(mesh);
      conditions["outlet"].kind = fluid::Kind::pressure;
      conditions.flag();
      fem::P1Tets tets;
      REQUIRE(tets.update(mesh.nodes, mesh.cells));
      Eigen::VectorXd inverse_mass = Eigen::VectorXd::Zero(mesh.node_count());
      for (Index e = 0; e < mesh.cell_count(); ++e)
        for (int a = 0; a < 4; ++a) inverse_mass[mesh.cells(a, e)] += tets[e].volume / 4;
      inverse_mass = inverse_mass.cwiseInverse().eval();
      const fluid::Pattern pattern(mesh);
      const fluid::Domain domain{pattern, mesh.cells, tets, mesh.nodes, inverse_mass, conditions};
      fluid::ConsistentMass<> mass(pattern);
      mass.assemble(domain);
      fluid::PressureOperator A(pattern);
      A.assemble(domain, mass.response(domain),
                 std::vector<double>(static_cast<std::size_t>(mesh.cell_count()), 0), 1);
      const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors(A.preconditioning());
      CAPTURE(name);
      CHECK(factors.info() == Eigen::Success);
    };
    for (const int n : {3, 4}) {
      for (const int along : {n / 2, 2 * n, 10 * n}) {
        const auto tube =
            meshing::lumen(meshing::Lumen{.radius = 5, .length = 10, .cells = {n, 6 * n, along}});
        check(tube, "tube " + std::to_string(along));
        for (const std::uint64_t seed : {1, 2}) check(ruined(tube, seed), "ruined " + std::to_string(along));
      }
    }
  }

  TEST_CASE("fluid: a patch without a free node is refused by its name") {
    fluid::Projection flow{meshing::box_tets(1), fluid::Newtonian{.density = 1, .viscosity = 1},
                           fluid::Fic{}};
    flow.pressure("x1", 0.0);
    CHECK_THROWS_WITH_AS(
        (void)flow.step(0.1),
        "no flow can pass the patch \"x1\": all its nodes lie on walls; refine the mesh there", MeshError);
  }

  TEST_CASE("fluid: the weak form is near to what an increment does to the divergence of the velocity") {
    // The largest p.S p / p.A p with S = D M^-1 D^T, by power iteration. Far above 1 the passes would
    // overshoot, far below the rows at the patch would lag.
    Cube box(6);
    box.conditions["x1"].kind = fluid::Kind::pressure;
    box.conditions.flag();
    const Index n = box.mesh.node_count();
    fluid::PressureStep<> step(box.pattern, box.mesh.nodes, 1);
    step.assemble_projection(box.domain(), 1);
    fluid::ConsistentMass<> mass(box.pattern);
    mass.assemble(box.domain());
    const auto divergence_of_correction = [&](const Eigen::VectorXd& p) {
      Points<3> v = Points<3>::Zero(3, n);  // D^T p = -(div N_i, p) for each component
      for (Index e = 0; e < box.mesh.cell_count(); ++e)
        for (int a = 0; a < 4; ++a)
          v.col(box.mesh.cells(a, e)) -=
              box.tets[e].volume * fluid::mean(fluid::nodal(p, box.mesh.cells, e)) * box.tets[e].grad.col(a);
      REQUIRE(mass.solve(box.domain(), v));
      Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
      for (Index e = 0; e < box.mesh.cell_count(); ++e) {
        const double div = fluid::nodal(v, box.mesh.cells, e).cwiseProduct(box.tets[e].grad).sum();
        for (int a = 0; a < 4; ++a) y[box.mesh.cells(a, e)] -= box.tets[e].volume / 4 * div;
      }
      return y;
    };
    Eigen::VectorXd p = noise(n, 1);
    double ratio = 0;
    for (int k = 0; k < 60; ++k) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(n);
      REQUIRE(step.solve(box.domain(), divergence_of_correction(p), 0, {.tolerance = 1e-6}, q));
      ratio = q.norm() / p.norm();
      p = q / q.norm();
    }
    MESSAGE("largest ratio " << ratio);
    CHECK(ratio < 1.2);
    CHECK(ratio > 0.7);
  }

  TEST_CASE("fluid: the consistent mass projects a field of the velocities on itself") {
    Cube box(4);
    for (const auto* side : test::box_sides) box.conditions[side].kind = fluid::Kind::pressure;
    for (const bool open : {true, false}) {
      if (!open) box.conditions["x0"].kind = fluid::Kind::wall;
      box.conditions.flag();
      fluid::ConsistentMass<> mass(box.pattern);
      mass.assemble(box.domain());
      Points<3> w(3, box.mesh.node_count());
      for (Eigen::Index i = 0; i < w.cols(); ++i) {
        const Vec3 x = box.mesh.nodes.col(i);
        w.col(i) = open ? Vec3(1 + x[0], x[1] * x[2], -2) : Vec3(x[0], 0, 2 * x[0]);  // 0 on the wall
      }
      Points<3> g = Points<3>::Zero(3, w.cols());
      for (Index e = 0; e < box.mesh.cell_count(); ++e) {
        const auto we = fluid::nodal(w, box.mesh.cells, e);
        for (int a = 0; a < 4; ++a)
          g.col(box.mesh.cells(a, e)) += box.tets[e].volume / 20 * (we.rowwise().sum() + we.col(a));
      }
      REQUIRE(mass.solve(box.domain(), g));
      CHECK((g - w).norm() < 1e-3 * w.norm());
    }
  }

  TEST_CASE("fluid: the coarse space holds linear pressures exactly") {
    // L p = r on the coarse space alone: a linear p is one of its functions.
    Cube box(8);
    box.conditions["x0"].kind = fluid::Kind::pressure;
    box.conditions.flag();
    const Index n = box.mesh.node_count();
    const std::vector<double> tau(static_cast<std::size_t>(box.mesh.cell_count()), 0);
    fluid::PressureOperator L(box.pattern);
    L.assemble(box.domain(), fluid::UnitResponse::whole(n), tau, 1);
    fluid::CoarseSpace<> coarse(box.mesh.nodes, 1);
    CHECK(coarse.size() > 8);
    coarse.compute(L.preconditioning(), L.entries(), L.inverse_mass(), fluid::NullSpace::none);
    const Eigen::VectorXd p = box.mesh.nodes.row(0).transpose();  // 0 where it is prescribed
    Eigen::VectorXd r, z = Eigen::VectorXd::Zero(n);
    L.apply(p, r);
    coarse.add(r, z);
    CHECK((z - p).norm() < 1e-10 * p.norm());
  }

  TEST_CASE("fluid: the momentum matrix transports a linear field exactly") {
    // (C + K) u for u linear, a constant: row sums against 1 give rho a.grad u times the volume.
    const Cube box(3);
    const Index n = box.mesh.node_count();
    const Vec3 a(1, -2, 0.5);
    const Points<3> stream = a.replicate(1, n), zero = Points<3>::Zero(3, n), none(3, 0);
    const Eigen::VectorXd p = Eigen::VectorXd::Zero(n);
    auto matrix = box.pattern.matrix<Eigen::RowMajor>();
    Points<3> right;
    const fluid::Newtonian fluid{.density = 2, .viscosity = 0.1};
    fluid::assemble_momentum(
        box.domain(), fluid, fluid::Fic{},
        {.a = stream, .u = stream, .history = zero, .p = p, .force = none, .smoothed = zero, .rate = 0},
        matrix, right);
    const Eigen::VectorXd x = box.mesh.nodes.row(1).transpose();
    Eigen::VectorXd y;
    la::multiply<1>(matrix, x, y);
    CHECK(y.sum() == doctest::Approx(2 * a[1]));
    la::multiply<1>(matrix, Eigen::VectorXd::Ones(n), y);
    CHECK(y.norm() < 1e-13);
    CHECK(right.norm() == 0);
    Points<3> smooth;
    const Points<3> u = Eigen::Vector3d(1, 2, 3).asDiagonal() * box.mesh.nodes;
    fluid::smooth_convection(box.domain(), stream, u, smooth);
    CHECK((smooth.colwise() - Vec3(1, -4, 1.5)).cwiseAbs().maxCoeff() < 1e-12);
  }

  TEST_CASE("fluid: a mass balance is relative to the largest flow") {
    const fluid::MassBalance flow{.inflow = 2, .outflow = 1.5, .discrete = -1e-9, .unbalanced = 0.02};
    CHECK(flow.residual() == doctest::Approx(5e-10));
    CHECK(flow.defect() == doctest::Approx(0.01));
    CHECK(fluid::MassBalance{.swept = -4, .unbalanced = 1}.defect() == doctest::Approx(0.25));
    CHECK(fluid::MassBalance{}.defect() == 0);
  }

  TEST_CASE("fluid: the source of the first pressure is the force less the convection") {
    const Cube box(3);
    const Index n = box.mesh.node_count();
    const Points<3> zero = Points<3>::Zero(3, n), none(3, 0), gravity = Vec3(1, -2, 3).replicate(1, n);
    const Eigen::VectorXd x = box.mesh.nodes.row(0).transpose();
    const Eigen::VectorXd still = fluid::initial_source(box.domain(), 1000, zero, zero, gravity);
    CHECK(std::abs(still.sum()) < 1e-13);
    CHECK(x.dot(still) == doctest::Approx(1));  // int grad x . f
    Points<3> u = zero;                         // u = (x, -y, 0): u.grad u = (x, y, 0), of mean 1/2
    u.row(0) = box.mesh.nodes.row(0), u.row(1) = -box.mesh.nodes.row(1);
    CHECK(x.dot(fluid::initial_source(box.domain(), 4, u, zero, none)) == doctest::Approx(-2));
  }

  TEST_CASE("fluid: the predictor finds a linear velocity from its boundary") {
    Cube box(4);
    for (const auto* side : test::box_sides) box.conditions[side].kind = fluid::Kind::velocity;
    box.conditions.flag();
    const Index n = box.mesh.node_count();
    const Points<3> zero = Points<3>::Zero(3, n), none(3, 0);
    Eigen::Matrix3d slope;
    slope << 1, 2, 0, 0, -3, 1, 4, 0, 2;
    const Points<3> exact = slope * box.mesh.nodes;
    Points<3> u = exact;
    test::Noise noise_of(3);
    for (Index i = 0; i < n; ++i)
      if (box.conditions.velocity_flags()[std::size_t(i)] == 0)
        u.col(i) += Vec3(noise_of(), noise_of(), noise_of());
    const Eigen::VectorXd p = Eigen::VectorXd::Zero(n);
    fluid::Predictor predictor(box.pattern);
    const fluid::MomentumFields fields{.a = zero,
                                       .u = u,
                                       .history = zero,
                                       .p = p,
                                       .force = none,
                                       .smoothed = predictor.smoothed(),
                                       .rate = 0};
    Points<3> found = u;
    REQUIRE(predictor.solve(box.domain(), fluid::Newtonian{.density = 2, .viscosity = 0.1}, fluid::Fic{},
                            fields, p, {.tolerance = 1e-12}, found));
    CHECK((found - exact).cwiseAbs().maxCoeff() < 1e-10);
  }

  TEST_CASE("fluid: the pressure step finds a linear pressure from its boundary") {
    Cube box(5);
    for (const auto* side : test::box_sides) box.conditions[side].kind = fluid::Kind::pressure;
    box.conditions.flag();
    fluid::PressureStep<> step(box.pattern, box.mesh.nodes, 1);
    step.assemble_laplacian(box.domain());
    const Eigen::VectorXd exact = (Vec3(1, -2, 3).transpose() * box.mesh.nodes).transpose();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(exact.size());
    REQUIRE(step.solve(box.domain(), step.prescribe(box.domain(), exact), 0, {.tolerance = 1e-12}, x));
    CHECK((x - exact).cwiseAbs().maxCoeff() < 1e-10);
  }

  TEST_CASE("fluid: the force of a fluid at rest is its pressure on every node of the wall") {
    const Cube box(4);
    const Index n = box.mesh.node_count();
    const Points<3> zero = Points<3>::Zero(3, n), force = Vec3(0, 3, 0).replicate(1, n);
    const Eigen::VectorXd p = 3 * box.mesh.nodes.row(1).transpose();  // grad p = f
    const auto& wall = box.conditions["x1"];
    const fluid::InterfaceForce on_wall(wall, box.conditions, box.mesh.cells);
    const Points<3> nodal =
        on_wall.evaluate(box.domain(), fluid::Newtonian{.density = 2, .viscosity = 0.1}, fluid::Fic{}, p,
                         {.a = zero, .u = zero, .rate = zero, .p = p, .force = force, .smoothed = zero});
    Points<3> exact = zero;
    for (Eigen::Index f = 0; f < wall.faces.cols(); ++f) {
      const Vec3 area = fluid::Conditions::area_vector(box.mesh.nodes, wall.faces, f);
      const Vec3 load = fluid::face_load(1, {p[wall.faces(0, f)], p[wall.faces(1, f)], p[wall.faces(2, f)]});
      for (int i = 0; i < 3; ++i) exact.col(wall.faces(i, f)) += load[i] * area;
    }
    for (std::size_t k = 0; k < on_wall.nodes().size(); ++k)
      CHECK((nodal.col(Eigen::Index(k)) - exact.col(on_wall.nodes()[k])).norm() < 1e-14);
    CHECK((nodal.rowwise().sum() - Vec3(1.5, 0, 0)).norm() < 1e-13);
  }
}
