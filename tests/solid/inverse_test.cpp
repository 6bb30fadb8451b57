// SPDX-License-Identifier: MIT
#include "tunica/solid/inverse.hpp"
#include "support/tube_cells.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/guccione_law.hpp"
#include "tunica/solid/history.hpp"
#include "tunica/solid/isochoric_law.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/viscoelastic.hpp"

#include <doctest/doctest.h>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double inner = 5e-3, outer = 6.5e-3;  // of the image [m]
const Hyperelastic artery{HolzapfelGasserOgden{.c = 30e3, .k1 = 20e3, .k2 = 2}, Quadratic{.kappa = 1e6}};

/// Axes at x on a tube: round it, along it, through its wall.
std::array<Vector3<double>, 3> axes(const Vec3& x) {
  const double r = x.head<2>().norm();
  return {Vector3<double>{-x[1] / r, x[0] / r, 0}, {0, 0, 1}, {x[0] / r, x[1] / r, 0}};
}
/// Two helices at 35 degrees; every third cell has one of them alone.
Fibres<double, 2> helices(Index cell, const Vec3& x) {
  const double angle = 35 * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const auto at = axes(x);
  Fibres<double, 2> f;
  f.set(0, {c * at[0][0], c * at[0][1], s});
  if (cell % 3 != 0) f.set(1, {c * at[0][0], c * at[0][1], -s});
  return f;
}
/// A frame whose fibre turns through the wall.
Fibres<double, 3> frame(Index, const Vec3& x) {
  const auto at = axes(x);
  const double angle = (x.head<2>().norm() - inner) / (outer - inner) - 0.4, c = std::cos(angle),
               s = std::sin(angle);
  Fibres<double, 3> f;
  for (std::size_t i = 0; i < 3; ++i) {
    f.m[i] = c * at[0][i] + s * at[1][i];
    f.m[3 + i] = c * at[1][i] - s * at[0][i];
    f.m[6 + i] = at[2][i];
  }
  return f;
}

/// A quarter of a tube, clamped at one of its ends and free at the other, under a pressure inside [Pa].
template <mesh::Cell C, class Law>
auto clamped_tube(const mesh::Mesh<C, 3>& mesh, const Law& law, double pressure) {
  Statics<C, Law, la::Lu> wall{mesh, law, {.newton = {.tolerance = 1e-13}}};
  wall.fix(mesh.patch("z0"));
  wall.fix(mesh.patch("y0"), Axis::y);
  wall.fix(mesh.patch("y1"), Axis::x);
  wall.pressure(mesh.patch("x0"), pressure);
  return wall;
}

struct WaysBack {
  double swollen, carried,
      image;  // how far a wall under load is from the shape free of it, and off its image
};

/// From an image to the shape free of load, and loaded again, with fibres carried back and with the image's.
template <mesh::Cell C, class Law, class Field>
WaysBack there_and_back(const std::string& name, const Law& law, double pressure, const Field& fibres) {
  auto mesh = test::quarter_of_tube<C>(2, inner, outer);
  const Points<3> image = mesh.nodes;
  auto imaged = clamped_tube(mesh, law, pressure);
  imaged.point_field(fibres);
  const auto free = unloaded_shape(imaged, {.newton = {.tolerance = 1e-13}});
  REQUIRE(free);
  CHECK(la::observed_order(free.history, 1e-8) >= 1.9);
  mesh.nodes = free.nodes;
  auto carried = clamped_tube(mesh, law, pressure), astray = clamped_tube(mesh, law, pressure);
  carry_fibres_back(imaged, carried);
  for (Index e = 0; e < mesh.cell_count(); ++e)
    for (std::size_t q = 0; q < decltype(imaged)::Element::points; ++q)
      astray.laws().point_data(e, q, imaged.body().data(e).points[q]);
  for (auto* wall : {&carried, &astray}) {
    if constexpr (has_history<Body<C, Law>>)
      REQUIRE(hold(*wall, std::numeric_limits<double>::infinity()));
    else
      REQUIRE(wall->solve());
  }
  const auto off = [&](const auto& wall) {
    return (mesh.nodes + wall.displacement() - image).cwiseAbs().maxCoeff();
  };
  const WaysBack ways{(free.nodes - image).cwiseAbs().maxCoeff() / outer, off(carried) / outer,
                      off(astray) / outer};
  MESSAGE(name << ": moved by " << ways.swollen << " of the outer radius, inverse order "
               << la::observed_order(free.history, 1e-8) << "; back on its image to " << ways.carried
               << ", with the fibres of the image to " << ways.image);
  CHECK(ways.swollen > 0.02);
  CHECK(ways.carried < 1e-9);
  CHECK(ways.image > 1e-4);
  return ways;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: a clamped tube of fibres comes back to its image with the fibres carried back") {
    (void)there_and_back<mesh::Hex8>("Hex8 of two families", artery, 20e3, helices);
    (void)there_and_back<mesh::Tet4>("Tet4 of two families", artery, 20e3, helices);
  }
  TEST_CASE("solid: frames of fibres are carried back as frames by inverse design") {
    const Guccione muscle{.C = 15e3, .bf = 8, .bt = 2, .bfs = 4};
    (void)there_and_back<mesh::Hex8>("Hex8 of frames",
                                     Hyperelastic{Isochoric{muscle}, Quadratic{.kappa = 1e6}}, 8e3, frame);
    (void)there_and_back<mesh::Hex8>("Hex8 of frames and no pair of laws", muscle, 4e3, frame);
  }
  TEST_CASE(
      "solid: the unloaded shape of a law with a history is that of its stiffness after infinite time") {
    const Hyperelastic slow{Viscoelastic{artery.isochoric, std::array{Prony{.ratio = 0.8, .time = 0.02}}},
                            artery.volumetric};
    const auto at_rest = [](Index e, const Vec3& x) {
      return decltype(slow.isochoric)::at_rest(helices(e, x));
    };
    (void)there_and_back<mesh::Hex8>("Hex8 of two viscoelastic families", slow, 20e3, at_rest);
    const auto mesh = test::quarter_of_tube<mesh::Hex8>(2, inner, outer);
    const Hyperelastic rubber{NeoHooke{.c10 = 30e3}, Quadratic{.kappa = 1e6}};
    const Hyperelastic creeping{Viscoelastic{rubber.isochoric, std::array{Prony{.ratio = 0.8, .time = 0.02}}},
                                rubber.volumetric};
    const auto same = [&](const auto& lasting, const auto& given) {
      const auto one = unloaded_shape(lasting), other = unloaded_shape(given);
      REQUIRE(one);
      REQUIRE(other);
      return (one.nodes - other.nodes).cwiseAbs().maxCoeff() / outer;
    };
    auto fibrous = clamped_tube(mesh, artery, 8e3);
    auto slowly = clamped_tube(mesh, slow, 8e3);
    fibrous.point_field(helices);
    slowly.point_field(at_rest);
    const double fibres = same(fibrous, slowly),
                 none = same(clamped_tube(mesh, rubber, 4e3), clamped_tube(mesh, creeping, 4e3));
    MESSAGE("off that of the elastic law by " << fibres << " of the outer radius, without fibres " << none);
    CHECK(fibres < 1e-10);
    CHECK(none < 1e-10);
    // A branch that forgets nothing is part of that stiffness.
    constexpr double never = std::numeric_limits<double>::infinity();
    const Hyperelastic lasting{Viscoelastic{rubber.isochoric, std::array{Prony{.ratio = 0.5, .time = never}}},
                               rubber.volumetric};
    const Hyperelastic stiffer{NeoHooke{.c10 = 45e3}, rubber.volumetric};
    CHECK(same(clamped_tube(mesh, stiffer, 4e3), clamped_tube(mesh, lasting, 4e3)) < 1e-10);
    // What it remembers of a load that acts already does not count.
    REQUIRE(hold(slowly, 0.01));
    CHECK(same(fibrous, slowly) < 1e-10);
  }
}
