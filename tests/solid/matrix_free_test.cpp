// SPDX-License-Identifier: MIT
#include "tunica/solid/matrix_free.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/la/preconditioner.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

const Hyperelastic rubber{Yeoh{.c10 = 0.5, .c20 = 0.3}, Quadratic{.kappa = 30}};

/// Some numbers between -size and size.
Eigen::VectorXd numbers(Eigen::Index n, double size, double phase) {
  Eigen::VectorXd v(n);
  for (Eigen::Index k = 0; k < n; ++k) v[k] = size * std::sin(1.7 * static_cast<double>(k) + phase);
  return v;
}

/// K v against the assembled matrix at a deformed state, on one and two threads, some nodes being held.
template <class Body>
void check(const std::string& name, Body& body) {
  body.fix(0, Axis::x), body.fix(1, Axis::y), body.fix(body.mesh().node_count() - 1, Axis::z);
  const Eigen::VectorXd u = numbers(body.unknowns(), 0.01, 0.3), v = numbers(body.unknowns(), 1, 1.1);
  Eigen::VectorXd f, predicted, y, again;
  REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
  la::SparseMatrix K = body.pattern();
  body.tangent(u, Eigen::VectorXd(), {}, K);
  const TangentAction action{body, u};
  action.apply(v, y);
  Eigen::VectorXd w = v;
  body.clear_fixed(w);
  Eigen::VectorXd want = K * w;
  double off = 0, size = 0;
  for (Index k = 0; k < body.unknowns(); ++k) {
    if (body.fixed(k)) want[k] = v[k];
    off = std::max(off, std::abs(y[k] - want[k]));
    size = std::max(size, std::abs(want[k]));
  }
  MESSAGE(name << ": K v without a matrix is off by " << off / size);
  CHECK(off < 1e-13 * size);
  thread_count() = 2;
  action.apply(v, again);
  thread_count() = 1;
  CHECK(y == again);
}

template <mesh::Cell C, class Given>
Body<C, Given> body_of(const mesh::Mesh<C, 3>& mesh, const Given& law) {
  return {mesh, law, 0.0, Mass::lumped};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: the tangent of a body acts without a matrix as with one") {
    const auto hexes = meshing::box_hexes(3);
    auto mean = body_of(hexes, rubber);
    check("Hex8", mean);
    auto bar = body_of(hexes, with<FBar>(rubber));
    check("Hex8 with FBar", bar);
    auto full = body_of(mesh::quadratic<mesh::Hex27>(meshing::box_hexes(2)), rubber);
    check("Hex27", full);
    auto tets = body_of(mesh::quadratic<mesh::Tet10>(meshing::box_tets(2)), with<Pointwise>(rubber));
    check("Tet10 with Pointwise", tets);
  }

  TEST_CASE("solid: the action without a matrix knows of regions and fibres and a stored deformation") {
    auto mesh = meshing::box_hexes(3);
    mesh.region_names = {"a", "b"};
    for (Index e = 0; e < mesh.cell_count(); ++e) mesh.region.push_back((e * 5 / 3) % 2);
    const auto law = [](double k1) {
      return Hyperelastic{HolzapfelGasserOgden{.c = 1, .k1 = k1, .k2 = 0.8}, Quadratic{.kappa = 30}};
    };
    auto body = body_of(mesh, law(2));
    body.laws().material(1, law(7));
    body.point_field([](Index, const Vec3& x) {
      Fibres<double, 2> f;
      f.set(0, {std::cos(x[0]), std::sin(x[0]), 0});
      f.set(1, {std::cos(x[1]), -std::sin(x[1]), 0});
      return f;
    });
    check("Hex8 with fibres in two regions", body);
    Eigen::Matrix3d F_p;
    F_p << 1.1, 0.1, 0, -0.05, 0.95, 0.02, 0.03, 0, 1.05;
    body.laws().prestress(std::vector<Eigen::Matrix3d>(static_cast<std::size_t>(8 * mesh.cell_count()), F_p));
    check("and a prestress", body);
  }

  TEST_CASE("solid: conjugate gradients without a matrix find what the direct solver finds") {
    const auto mesh = meshing::box_hexes(4);
    auto body = body_of(mesh, rubber);
    for (const Index n : mesh::patch_nodes(mesh.patch("x0")))
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) body.fix(n, axis);
    const Eigen::VectorXd u = numbers(body.unknowns(), 0.001, 0.2);
    Eigen::VectorXd b = numbers(body.unknowns(), 1, 2.2), f, predicted, x = Eigen::VectorXd::Zero(b.size()),
                    want;
    body.clear_fixed(b);
    REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
    la::SparseMatrix K = body.pattern();
    body.tangent(u, Eigen::VectorXd(), {}, K);
    la::Ldlt direct;
    direct.analyse(K);
    REQUIRE(direct.factorise(K));
    REQUIRE(direct.solve(b, want));
    const TangentAction action{body, u};
    const auto report =
        la::cg(action, la::Identity{}, b, x, {.tolerance = 1e-11, .max_iterations = 2000, .stall = 2000});
    INFO(name(report.status) << " at " << report.residual << " after " << report.iterations);
    REQUIRE(report);
    MESSAGE(report.iterations << " iterations, off by " << (x - want).norm() / want.norm());
    CHECK((x - want).norm() < 1e-9 * want.norm());
  }
}
