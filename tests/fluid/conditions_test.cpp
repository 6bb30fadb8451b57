// SPDX-License-Identifier: MIT
// What may be prescribed on a patch, and which node answers to what where patches meet.
#include "tunica/fluid/conditions.hpp"

#include "tunica/fluid/boundary_function.hpp"
#include "tunica/meshing/box.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace tunica;

namespace {

double ramp(double t) {
  return 3 * t;
}
double slope(const Vec3& x, double t) {
  return x[1] + t;
}
Vec3 swirl(const Vec3& x, double t) {
  return {-x[1] * t, x[0] * t, 0};
}

template <class Value, class F>
fluid::BoundaryFunction<Value> given(F&& f) {
  return fluid::BoundaryFunction<Value>(std::forward<F>(f));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fluid: constants and functions of time and place are boundary values") {
    const Vec3 x(1, 2, 3);
    CHECK(given<double>(7)(x, 5) == 7);
    CHECK(given<double>(ramp)(x, 2) == 6);
    CHECK(given<double>(&ramp)(x, 2) == 6);
    CHECK(given<double>(slope)(x, 2) == 4);
    CHECK(given<double>([c = 4.0](double t) { return c * t; })(x, 2) == 8);
    CHECK(given<Vec3>(swirl)(x, 2) == Vec3(-4, 2, 0));
    CHECK(given<Vec3>(2 * x)(x, 0) == Vec3(2, 4, 6));
    CHECK(fluid::BoundaryFunction<Vec3>()(x, 1) == Vec3(0, 0, 0));
    const fluid::BoundaryFunction<double> first = ramp, copy = first;
    CHECK(copy(x, 1) == 3);
  }

  TEST_CASE("fluid: a wall goes before a velocity and a velocity before a pressure") {
    const auto mesh = meshing::box_tets(4);
    fluid::Conditions conditions(mesh);
    conditions["x0"].kind = fluid::Kind::velocity;
    conditions["x0"].velocity = Vec3(1, 0, 0);
    conditions["x1"].kind = fluid::Kind::pressure;
    conditions["x1"].scalar = 5;
    conditions.flag();
    CHECK(conditions.any_pressure());
    Points<3> u = Points<3>::Constant(3, mesh.node_count(), 9);
    conditions.impose_velocity(mesh.nodes, Points<3>::Zero(3, mesh.node_count()), 0, u);
    Eigen::VectorXd load;
    conditions.impose_pressure(mesh.nodes, 0, load);
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const Vec3 x = mesh.nodes.col(n);
      bool side = false;
      for (int d = 1; d < 3; ++d) side = side || x[d] < 1e-9 || x[d] > 1 - 1e-9;
      const bool in = x[0]<1e-9, out = x[0]> 1 - 1e-9;
      const auto k = static_cast<std::size_t>(n);
      CHECK(bool(conditions.velocity_flags()[k]) == (side || in));
      CHECK(load[n] == (out ? 5 : 0));
      CHECK(u(0, n) == (side ? 0 : in ? 1 : 9));
    }
  }

  TEST_CASE("fluid: every face of a patch knows the tetrahedron behind it") {
    const auto mesh = meshing::box_tets(3);
    const fluid::Conditions conditions(mesh);
    for (const auto& c : conditions.list()) {
      REQUIRE(Index(c.cells.size()) == c.faces.cols());
      for (Index f = 0; f < c.faces.cols(); ++f)
        for (int i = 0; i < 3; ++i)
          CHECK((mesh.cells.col(c.cells[std::size_t(f)]).array() == c.faces(i, f)).count() == 1);
    }
  }

  TEST_CASE("fluid: the flux of a linear field is its divergence times the volume") {
    const auto mesh = meshing::box_tets(3);
    const fluid::Conditions conditions(mesh);
    const Points<3> u = Eigen::Vector3d(1, -4, 5).asDiagonal() * mesh.nodes;
    double through = 0;
    for (const auto& c : conditions.list()) {
      double faces = 0;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        faces += fluid::Conditions::flux(mesh.nodes, c.faces, u, f);
      CHECK(faces == doctest::Approx(fluid::Conditions::flux(mesh.nodes, c.faces, u)));
      through += faces;
    }
    CHECK(through == doctest::Approx(2));
  }
}
