// SPDX-License-Identifier: MIT
// What the flow solver keeps exactly, and how it behaves as a part: state, trouble, threads.
#include "tunica/fluid/projection.hpp"

#include "support/flow.hpp"
#include "tunica/fluid/inlet.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/motion/laplace.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace tunica;

namespace {

constexpr fluid::Newtonian syrup{.density = 1.2, .viscosity = 0.07};

mesh::TetMesh shaken_box(int n) {
  auto mesh = meshing::box_tets(n);
  test::shake(mesh, 0.2 / n);
  return mesh;
}

mesh::TetMesh small_tube() {
  return meshing::lumen(meshing::Lumen{.radius = 5e-3, .length = 20e-3, .cells = {3, 18, 12}});
}

/// A pulse into a tube whose wall moves as asked: the scene of the tests of state.
auto pulsed_tube(const mesh::TetMesh& mesh) {
  fluid::Projection blood{mesh, fluid::Newtonian{.density = 1050, .viscosity = 0.0035}, fluid::Fic{}};
  blood.velocity("inlet", fluid::inlet_profile(mesh, "inlet"),
                 [](double t) { return 0.2 * std::sin(50 * t); });
  blood.pressure("outlet", [](double t) { return 300 * std::sin(80 * t); }, {.backflow = 0.5});
  blood.interface("wall");
  return blood;
}

Points<3> breathe(const mesh::TetMesh& mesh, const motion::Laplace& laplace, double amplitude) {
  Points<3> wall(3, static_cast<Eigen::Index>(laplace.wall_nodes().size()));
  for (std::size_t k = 0; k < laplace.wall_nodes().size(); ++k) {
    const Vec3 x = mesh.nodes.col(laplace.wall_nodes()[k]);
    const double s = std::sin(std::acos(-1.0) * x[2] / 20e-3);
    wall.col(static_cast<Eigen::Index>(k)) << amplitude * s * x[0], amplitude * s * x[1], 0;
  }
  return laplace.extend(wall);
}

/// An archive in memory: writes what it is given, or reads it back, in turn.
struct Memory {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
  std::size_t reading = 0;
  bool read = false;

  template <class T>
  void operator()(const char* name, T& member) {
    if constexpr (std::is_arithmetic_v<T>) {
      if (!read) {
        names.emplace_back(name), values.push_back({static_cast<double>(member)});
      } else {
        REQUIRE(names.at(reading) == name);
        member = static_cast<T>(values[reading++][0]);
      }
    } else {
      if (!read) {
        names.emplace_back(name), values.emplace_back(member.data(), member.data() + member.size());
      } else {
        REQUIRE(names.at(reading) == name);
        const auto& v = values[reading++];
        member.resize(member.rows() == 3 ? 3 : static_cast<Eigen::Index>(v.size()),
                      member.rows() == 3 ? static_cast<Eigen::Index>(v.size()) / 3 : 1);
        std::copy(v.begin(), v.end(), member.data());
      }
    }
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fluid: a uniform stream stays uniform on a shaken mesh") {
    const auto mesh = shaken_box(6);
    const Vec3 stream(0.3, -0.7, 0.5);
    for (const bool outlet : {false, true}) {
      fluid::Projection flow{mesh, syrup, fluid::Fic{}, fluid::FixedMesh{}};
      for (const auto* side : test::box_sides) flow.velocity(side, stream);
      if (outlet) flow.pressure("x1", 0.0);
      flow.set(stream.replicate(1, mesh.node_count()));
      for (int n = 0; n < 20; ++n) REQUIRE(flow.step(0.01));
      CHECK((flow.velocity().colwise() - stream).cwiseAbs().maxCoeff() < 1e-12);
      CHECK(flow.pressure().cwiseAbs().maxCoeff() < 1e-12);
      CHECK(flow.mass_balance().residual() < 1e-12);
      CHECK(flow.mass_balance().defect() < 1e-12);
    }
  }

  TEST_CASE("fluid: a hydrostatic column is at rest from its own start") {
    const auto mesh = shaken_box(6);
    const Vec3 weight(0, 0, -9.81 * syrup.density);
    for (const bool open : {false, true}) {
      fluid::Projection column{mesh, syrup, fluid::Fic{}, fluid::FixedMesh{}};
      column.body_force(weight);
      if (open) column.pressure("z1", 40.0);
      for (int n = 0; n < 20; ++n) REQUIRE(column.step(0.01));
      CHECK(column.velocity().cwiseAbs().maxCoeff() < 1e-12);
      const double top = open ? 40.0 : -0.5 * 9.81 * syrup.density;
      double worst = 0;
      for (Index i = 0; i < mesh.node_count(); ++i)
        worst = std::max(
            worst, std::abs(column.pressure()[i] - top - 9.81 * syrup.density * (1 - mesh.nodes(2, i))));
      CHECK(worst < 1e-12 * 40);
    }
  }

  TEST_CASE("fluid: a wall that expands a closed box is refused and a swirl is solved") {
    const auto mesh = shaken_box(4);
    fluid::Projection flow{mesh, syrup, fluid::Fic{}, fluid::FixedMesh{}};
    flow.velocity("x1", Vec3(1, 0, 0));
    CHECK(flow.step(0.01).status == Status::diverged);
    flow.velocity("x1", Vec3(0, 1, 0));
    REQUIRE(flow.step(0.01));
    CHECK(std::abs(flow.pressure().mean()) < 0.1 * flow.pressure().cwiseAbs().maxCoeff());
  }

  TEST_CASE("fluid: what cannot be numbers diverges and leaves the state") {
    const auto mesh = small_tube();
    auto blood = pulsed_tube(mesh);
    REQUIRE(blood.step(1e-3));
    const Points<3> u = blood.velocity();
    blood.velocity("inlet", Vec3(0, 0, std::numeric_limits<double>::quiet_NaN()));
    CHECK(blood.step(1e-3).status == Status::diverged);
    CHECK((blood.velocity().array() == u.array()).all());
    CHECK(blood.time() == 1e-3);
    blood.velocity("inlet", Vec3(0, 0, 0.01));
    blood.pressure("outlet",
                   [](double t) { return t > 1.5e-3 ? std::numeric_limits<double>::quiet_NaN() : 0.0; });
    CHECK(blood.step(1e-3).status == Status::diverged);
    CHECK((blood.velocity().array() == u.array()).all());
  }

  TEST_CASE("fluid: an inverted cell is found and named and the next step is sound again") {
    const auto mesh = small_tube();
    auto blood = pulsed_tube(mesh);
    REQUIRE(blood.step(1e-3));
    CHECK(blood.inverted() == -1);
    Points<3> d = Points<3>::Zero(3, mesh.node_count());
    d(0, mesh.cells(0, 100)) = 4e-3;
    blood.move(d, 1e-3);
    CHECK(blood.step(1e-3).status == Status::diverged);
    const Index e = blood.inverted();
    REQUIRE(e >= 0);
    CHECK(fem::p1_tet(mesh.nodes + d, mesh.cells, e).volume <= 0);
    d(0, mesh.cells(0, 100)) = std::numeric_limits<double>::quiet_NaN();
    blood.move(d, 1e-3);
    CHECK(blood.step(1e-3).status == Status::diverged);
    blood.move(Points<3>::Zero(3, mesh.node_count()), 1e-3);
    CHECK(bool(blood.step(1e-3)));
  }

  TEST_CASE("fluid: displacement to force is a function and threads leave no trace") {
    const auto mesh = small_tube();
    const motion::Laplace laplace(mesh);
    auto blood = pulsed_tube(mesh);
    CHECK(blood.interface_nodes() == mesh::patch_nodes(mesh.patch("wall")));
    for (int n = 1; n <= 3; ++n) {
      blood.save();
      const auto once = [&](double amplitude) {
        blood.restore();
        blood.move(breathe(mesh, laplace, amplitude), 1e-3);
        REQUIRE(blood.step(1e-3));
        return Points<3>(blood.interface_force());
      };
      const Points<3> first = once(0.01 * n);
      once(0.02 * n);
      thread_count() = 2;
      const Points<3> again = once(0.01 * n);
      thread_count() = 1;
      CHECK((first.array() == again.array()).all());
      CHECK(first.norm() > 0);
    }
  }

  TEST_CASE("fluid: a restart goes on to the last bit") {
    const auto mesh = small_tube();
    const motion::Laplace laplace(mesh);
    auto whole = pulsed_tube(mesh), half = pulsed_tube(mesh);
    Memory file;
    for (int n = 1; n <= 6; ++n) {
      if (n == 4) whole.archive(file), file.read = true, half.archive(file);
      const Points<3> d = breathe(mesh, laplace, 0.01 * n);
      whole.move(d, 1e-3);
      REQUIRE(whole.step(1e-3));
      if (n < 4) continue;
      half.move(d, 1e-3);
      REQUIRE(half.step(1e-3));
    }
    CHECK((whole.velocity().array() == half.velocity().array()).all());
    CHECK((whole.pressure().array() == half.pressure().array()).all());
    CHECK((whole.interface_force().array() == half.interface_force().array()).all());
    CHECK(whole.time() == half.time());
    CHECK(whole.mass_balance().discrete == half.mass_balance().discrete);
  }

  TEST_CASE("fluid: mass is balanced to the tolerance of the pressure") {
    const auto mesh = small_tube();
    const motion::Laplace laplace(mesh);
    auto blood = pulsed_tube(mesh);
    for (int n = 1; n <= 20; ++n) {
      blood.move(breathe(mesh, laplace, 0.05 * std::sin(0.3 * n)), 1e-3);
      REQUIRE(blood.step(1e-3));
      CHECK(blood.mass_balance().residual() < 1e-8);
    }
    MESSAGE("mass defect " << blood.mass_balance().defect());
  }

  TEST_CASE("fluid: the inlet takes in exactly what is asked for") {
    const auto mesh = small_tube();
    const auto profile = fluid::inlet_profile(mesh, "inlet");
    double area = 0;
    for (Eigen::Index f = 0; f < mesh.patch("inlet").faces.cols(); ++f)
      area += fluid::Conditions::area_vector(mesh.nodes, mesh.patch("inlet").faces, f).norm();
    auto blood = pulsed_tube(mesh);
    blood.velocity("inlet", profile, 0.25);
    REQUIRE(blood.step(1e-3));
    CHECK(blood.mass_balance().inflow == doctest::Approx(0.25 * area).epsilon(1e-13));
    for (std::size_t k = 0; k < profile.nodes.size(); ++k) {
      const double r = mesh.nodes.col(profile.nodes[k]).head<2>().norm() / 5e-3;
      CHECK(profile.velocity.col(static_cast<Eigen::Index>(k)).head<2>().norm() < 1e-12);
      if (r > 1 - 1e-9) CHECK(profile.velocity(2, static_cast<Eigen::Index>(k)) == 0.0);
    }
  }

  TEST_CASE("fluid: an open boundary or an unknown patch is an error that says so") {
    auto mesh = small_tube();
    CHECK_THROWS_WITH_AS((fluid::Projection{mesh, syrup, fluid::Fic{}}.pressure("side", 0.0)),
                         "no patch named \"side\"; there are: wall, inlet, outlet", MeshError);
    mesh.patches.pop_back();
    CHECK_THROWS_AS((fluid::Projection{mesh, syrup, fluid::Fic{}}), MeshError);
  }
}
