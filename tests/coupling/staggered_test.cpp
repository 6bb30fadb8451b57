// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "coupling/models.hpp"
#include "tunica/coupling/aitken.hpp"
#include "tunica/coupling/extrapolation.hpp"
#include "tunica/coupling/iqn_ils.hpp"
#include "tunica/coupling/matching.hpp"
#include "tunica/coupling/relaxed.hpp"
#include "tunica/coupling/staggered.hpp"

#include <limits>

using namespace tunica;
using test::Column;
using test::NoMesh;
using test::PotentialFlow;
using test::RingWall;
using test::Spring;

namespace {

static_assert(coupling::FluidSolver<Column> && coupling::FluidSolver<PotentialFlow>);
static_assert(coupling::StructureSolver<Spring> && coupling::StructureSolver<RingWall>);
static_assert(coupling::MeshMotion<NoMesh>);
static_assert(!coupling::FluidSolver<Spring> && !coupling::StructureSolver<Column>);
static_assert(!coupling::Transfer<NoMesh> && !coupling::Acceleration<NoMesh>);

/// Displacement of the piston at T = 1 with n steps; fluid 20 times as heavy as the structure.
template <class Accelerator>
double piston(int n, Accelerator&& acceleration) {
  Column fluid{.mass = 20, .drive = 5};
  Spring wall{.mass = 1, .stiffness = 84};
  auto fsi =
      coupling::staggered(fluid, wall, NoMesh{}, coupling::Matching{}, acceleration, {.tolerance = 1e-11});
  for (int i = 0; i < n; ++i) CHECK(fsi.step(1.0 / n));
  return wall.x;
}

/// A structure that fails on demand.
struct Brittle : Spring {
  double largest_dt = 1;      // [s]
  double poison_after = 1e9;  // steps
  SolveReport step(double dt) {
    if (dt > largest_dt) return {Status::max_iterations, 20, 1};
    const SolveReport done = Spring::step(dt);
    if (steps > poison_after) x = std::numeric_limits<double>::quiet_NaN();
    return done;
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("coupling: a predictor is exact for its degree at uneven steps") {
    const auto path = [](double t) { return Points<3>(Vec3(1, 2 - 3 * t, 4 + t - 5 * t * t)); };
    coupling::Extrapolation history;
    CHECK(history.empty());
    history.push(path(0), 0);
    CHECK(history.extrapolate(0.3, 2) == path(0));
    history.push(path(0.1), 0.1);
    CHECK(history.extrapolate(0.3, 2).row(1).isApprox(path(0.4).row(1), 1e-14));
    history.push(path(0.35), 0.25);
    CHECK(history.extrapolate(0.05, 2).isApprox(path(0.40), 1e-14));
    CHECK(history.extrapolate(0.05, 0) == path(0.35));
    CHECK(history.extrapolate(0.05, 1).row(1).isApprox(path(0.40).row(1), 1e-14));
  }

  TEST_CASE("coupling: a piston moves as the monolithic solution and with second order") {
    // (m_f + m_s) x'' + k x = F: x = F/k (1 - cos(omega t)), omega = 2
    const double exact = 5.0 / 84 * (1 - std::cos(2.0));
    Spring whole{.mass = 21, .stiffness = 84};  // the monolithic problem, same scheme
    whole.load(Vec3(5, 0, 0));
    for (int i = 0; i < 40; ++i) (void)whole.step(1.0 / 40);
    const double iqn = piston(40, coupling::IqnIls{}), aitken = piston(40, coupling::Aitken{});
    CHECK(iqn == doctest::Approx(whole.x).epsilon(1e-10));
    CHECK(aitken == doctest::Approx(whole.x).epsilon(1e-10));
    double before = 0;
    for (const int n : {40, 80, 160, 320}) {
      const double error = std::abs(piston(n, coupling::IqnIls{}) - exact);
      MESSAGE("dt = 1/" << n << " error " << error << " order " << std::log2(before / error));
      if (before > 0) CHECK(std::log2(before / error) > 1.8);
      before = error;
    }
  }

  TEST_CASE("coupling: a step is rolled back and halved until the structure follows") {
    Column fluid{.mass = 2, .drive = 1};
    Brittle wall;
    wall.stiffness = 10;
    wall.largest_dt = 0.03;
    auto fsi = coupling::staggered(fluid, wall, NoMesh{}, coupling::Matching{}, coupling::IqnIls{});
    const auto step = fsi.step(0.1);
    CHECK(step);
    CHECK(step.halvings == 3);
    CHECK(step.taken == doctest::Approx(0.1).epsilon(1e-15));
    CHECK(fluid.steps == 4);
    CHECK(wall.steps == 4);
    CHECK(step.failed.empty());
  }

  TEST_CASE(
      "coupling: a step that cannot be halved any further stops with a report and the last good state") {
    Column fluid{.mass = 2, .drive = 1};
    Brittle wall;
    wall.stiffness = 10;
    wall.largest_dt = 0;
    auto fsi = coupling::staggered(fluid, wall, NoMesh{}, coupling::Matching{}, coupling::IqnIls{},
                                   {.max_halvings = 4});
    const auto step = fsi.step(0.1);
    CHECK_FALSE(step);
    CHECK(step.status == Status::max_iterations);
    CHECK(step.failed == "structure");
    CHECK(step.halvings == 4);
    CHECK(step.taken == 0);
    CHECK(fluid.x == 0);
    CHECK(fluid.steps == 0);
    CHECK(wall.steps == 0);
  }

  TEST_CASE("coupling: NaN in a subsolver ends as diverged") {
    Column fluid{.mass = 2, .drive = 1};
    Brittle wall;
    wall.stiffness = 10;
    wall.poison_after = 3;
    auto fsi = coupling::staggered(fluid, wall, NoMesh{}, coupling::Matching{}, coupling::IqnIls{},
                                   {.max_halvings = 2});
    for (int i = 0; i < 3; ++i) CHECK(fsi.step(0.01));
    const double x = wall.x;
    const auto step = fsi.step(0.01);
    CHECK_FALSE(step);
    CHECK(step.status == Status::diverged);
    CHECK(step.failed == "interface");
    CHECK(wall.x == x);
    CHECK(std::isfinite(fluid.x));
  }

  TEST_CASE("coupling: relaxation beyond its bound ends as max_iterations or diverged") {
    Column fluid{.mass = 20, .drive = 5};
    Spring wall{.mass = 1, .stiffness = 84};
    auto fsi = coupling::staggered(fluid, wall, NoMesh{}, coupling::Matching{}, coupling::Relaxed(1.0),
                                   {.max_halvings = 1});
    const auto step = fsi.step(0.01);
    CHECK_FALSE(step);
    CHECK(step.failed == "interface");
    CHECK(wall.x == 0);
  }

  TEST_CASE("coupling: a problem at rest converges at once") {
    const test::TubeData tube;
    PotentialFlow flow(tube);
    flow.pulse = 0;
    RingWall wall(tube);
    auto fsi = coupling::staggered(flow, wall, NoMesh{}, coupling::Matching{}, coupling::IqnIls{});
    const auto step = fsi.step(1e-4);
    CHECK(step);
    CHECK(step.iterations == 1);
    CHECK(step.residual == 0);
  }

  TEST_CASE("coupling: a restart from an archive goes on with the same bits") {
    const test::TubeData tube;
    const auto run = [&](int restart_at) {
      PotentialFlow flow(tube);
      RingWall wall(tube);
      test::Memory memory;
      for (int n = 0; n < 40;) {
        PotentialFlow fresh_flow(tube);
        RingWall fresh_wall(tube);
        auto fsi = coupling::staggered(fresh_flow, fresh_wall, NoMesh{}, coupling::Matching{},
                                       coupling::IqnIls{}, {.resolution = 1e-7});
        if (n > 0) {
          memory.mode = test::Memory::Mode::read;
          fresh_flow.archive(memory), fresh_wall.archive(memory), fsi.archive(memory);
        }
        for (; n < 40 && (n != restart_at || n == 0); ++n) CHECK(fsi.step(n == 7 ? 5e-5 : 1e-4));
        if (n == restart_at) restart_at = -1;
        memory.mode = test::Memory::Mode::write;
        fresh_flow.archive(memory), fresh_wall.archive(memory), fsi.archive(memory);
        flow = fresh_flow, wall = fresh_wall;
      }
      return wall.eta;
    };
    const Eigen::VectorXd unbroken = run(-1);
    CHECK(unbroken.cwiseAbs().maxCoeff() > 1e-4);
    for (const int at : {1, 2, 8, 20, 39}) CHECK(run(at) == unbroken);
  }
}
