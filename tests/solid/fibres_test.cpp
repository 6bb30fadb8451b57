// SPDX-License-Identifier: MIT
#include "support/laws.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/fibre_field.hpp"
#include "tunica/solid/fibre_helix.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace tunica;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr solid::HolzapfelGasserOgden media{.c = 3.0e3, .k1 = 2.3632e3, .k2 = .8393};
constexpr solid::HolzapfelGasserOgden adventitia{.c = .3e3, .k1 = .5620e3, .k2 = .7112};

/// r(R) of an incompressible tube with r_i at R_i, stretched along by z.
double radius(double R, double r_i, double R_i, double z) {
  return std::sqrt(r_i * r_i + (R * R - R_i * R_i) / z);
}

/// int (s_tt - s_rr)/r dr over a layer [Pa]: F = diag(R/(r z), r/R, z) in the axes r, t, z.
double pressure_of_layer(const solid::HolzapfelGasserOgden& law, double angle, double from, double to,
                         double r_i, double R_i, double z) {
  solid::Fibres<double, 2> fibres;
  fibres.set(0, {0, std::cos(angle), std::sin(angle)});
  fibres.set(1, {0, std::cos(angle), -std::sin(angle)});
  constexpr std::array<double, 3> at{-0.7745966692414834, 0, 0.7745966692414834},
      weight{5. / 9, 8. / 9, 5. / 9};
  constexpr int panels = 40;
  double p = 0;
  for (int n = 0; n < panels; ++n)
    for (std::size_t q = 0; q < 3; ++q) {
      const double h = (to - from) / panels, R = from + h * (n + 0.5 + 0.5 * at[q]);
      const double r = radius(R, r_i, R_i, z);
      const Tensor<double> F{.m = {R / (r * z), 0, 0, 0, r / R, 0, 0, 0, z}};
      const auto s = test::cauchy(solid::stress(law, F, fibres), F);
      p += 0.5 * h * weight[q] * (s(1, 1) - s(0, 0)) / r * R / (r * z);  // dr = R/(r z) dR
    }
  return p;
}

template <class Make>
std::string refusal(const Make& make) {
  try {
    (void)make();
  } catch (const MeshError& e) {
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: two layers of fibres carry the pressures of the two-layer tube") {
    // Exact for the law, the stress-free closed ring: R .71 - .97 - 1.10 mm, fibres at 29 and 62 degrees.
    struct Row {
      double r_i, z, p;  // mm, -, kPa
    };
    constexpr std::array<Row, 9> rows{{{0.7, 1.5, 0.687842},
                                       {0.7, 1.9, 2.105628},
                                       {0.9, 1.7, 2.208631},
                                       {1.0, 1.5, 2.757800},
                                       {1.1, 1.5, 4.919317},
                                       {1.1, 1.9, 10.328069},
                                       {1.2, 1.7, 14.757691},
                                       {1.3, 1.5, 30.414137},
                                       {1.3, 1.9, 78.984322}}};
    double worst = 0;
    for (const auto& [r_i, z, p] : rows) {
      const double got = 1e-3 * (pressure_of_layer(media, 29 * degree, .71, .97, r_i, .71, z) +
                                 pressure_of_layer(adventitia, 62 * degree, .97, 1.10, r_i, .71, z));
      worst = std::max(worst, std::abs(got / p - 1));
    }
    MESSAGE("largest error of nine pressures: " << worst);
    CHECK(worst < 1e-6);
  }

  TEST_CASE("solid: no dispersion is the law of aligned fibres and full dispersion sees no direction") {
    const solid::GasserOgdenHolzapfel none{.c = media.c, .k1 = media.k1, .k2 = media.k2, .kappa = 0};
    const solid::GasserOgdenHolzapfel full{.c = 1e3, .k1 = 2e3, .k2 = 0.7, .kappa = 1. / 3};
    for (const auto& F : test::states) {
      const auto a = solid::response(none, F, test::crossed(0.6)),
                 b = solid::response(media, F, test::crossed(0.6));
      const double scale = test::largest(b.A);
      for (std::size_t k = 0; k < 81; ++k) CHECK(std::abs(a.A[k] - b.A[k]) < 1e-13 * scale);
      const auto x = solid::response(full, F, test::crossed(0.2)),
                 y = solid::response(full, F, test::crossed(1.3));
      for (std::size_t k = 0; k < 81; ++k) CHECK(std::abs(x.A[k] - y.A[k]) < 1e-12 * test::largest(y.A));
    }
  }

  TEST_CASE("solid: helical fibres lie at their angle on the walls of a tube") {
    const auto tube = meshing::tube({.inner_radius = 5, .thickness = 1.5, .length = 10, .cells = {3, 24, 6}});
    Points<3> axis(3, 5);
    axis << 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 2, 5, 8, 11;
    const solid::CentreLines line({axis});
    const auto layer = solid::radial_layers(tube, line, {5.5, 6.0});
    const auto field = solid::helical_fibres(
        tube, line, solid::angles_of_layers(layer, {29 * degree, 45 * degree, 62 * degree}));
    std::array<int, 3> count{};
    for (Index c = 0; c < tube.cell_count(); ++c) {
      const Vec3 x = solid::cell_middle(tube, c), around = Vec3(-x[1], x[0], 0).normalized();
      const auto k = static_cast<std::size_t>(layer[static_cast<std::size_t>(c)]);
      ++count[k];
      const double angle = std::array{29, 45, 62}[k] * degree;
      for (std::size_t f = 0; f < 2; ++f) {
        const Vec3 a = field.family[f].col(c);
        CHECK(a.norm() == doctest::Approx(1).epsilon(1e-14));
        CHECK(std::abs(a.dot(Vec3(x[0], x[1], 0).normalized())) < 1e-14);
        CHECK(std::abs(a.dot(around)) == doctest::Approx(std::cos(angle)).epsilon(1e-12));
        CHECK(a[2] == doctest::Approx(f == 0 ? std::sin(angle) : -std::sin(angle)).epsilon(1e-12));
      }
    }
    CHECK(count == std::array{144, 144, 144});
    CHECK(field[7].m == solid::checked(field, tube.cell_count())[7].m);

    // About an arc of radius 30, in cells around it: outward points away from the arc, along follows it.
    Points<3> arc(3, 181);
    for (int k = 0; k <= 180; ++k)
      arc.col(k) = 30 * Vec3(std::cos(k * 0.5 * degree), std::sin(k * 0.5 * degree), 0);
    const solid::CentreLines bend({arc});
    double worst = 0;
    for (double s = 0.1; s < 1.4; s += 0.0137)
      for (double t = 0; t < 6; t += 0.5) {
        const Vec3 e(std::cos(s), std::sin(s), 0), out = std::cos(t) * e + std::sin(t) * Vec3(0, 0, 1);
        const auto f = bend.at(30 * e + 5 * out);
        worst = std::max({worst, (f.outward - out).norm(), (f.along - Vec3(-e[1], e[0], 0)).norm(),
                          std::abs(f.radius - 5)});
      }
    MESSAGE("largest error of directions about an arc of 0.5 degrees a chord: " << worst);
    CHECK(worst < 5e-3);

    CHECK(says(refusal([&] {
                 return solid::angles_of_layers({0, 0, 3}, {1.0});
               }),
               "cell 2: no angle for layer 3"));
    CHECK(
        says(refusal([&] { return solid::helical_fibres(tube, line, std::vector<double>(3)); }), "3 angles"));
    CHECK(says(refusal([] { return solid::CentreLines({Points<3>::Zero(3, 1)}); }), "less than two points"));
    CHECK(says(refusal([] { return solid::CentreLines({Points<3>::Zero(3, 3)}); }), "behind point 0"));
    Points<3> through(3, 2);
    through << solid::cell_middle(tube, 5) - Vec3(0, 0, 1), solid::cell_middle(tube, 5) + Vec3(0, 0, 1);
    CHECK(says(refusal([&] { return solid::helical_fibres(tube, solid::CentreLines({through}), 0.5); }),
               "lies on the centre line"));
  }

  TEST_CASE(
      "solid: fibre fields are refused by cell where they are not numbers or missing or not of length 1") {
    const auto good = solid::uniform_fibres<2>(6, {Vec3(3, 4, 0), Vec3(0, 0, 2)});
    CHECK(good.family[0].col(5) == Vec3(0.6, 0.8, 0));
    CHECK(solid::checked(good, 6, {.frame = true}).family[1] == good.family[1]);
    const auto with = [&](Index cell, const Vec3& a) {
      auto field = good;
      field.family[1].col(cell) = a;
      return field;
    };
    const auto why = [&](const auto& field, const solid::FibreCheck& options = {}) {
      return refusal([&] { return solid::checked(field, 6, options); });
    };
    CHECK(says(why(with(3, Vec3(0, std::nan(""), 1))), "cell 3, family 2: a direction that is not a number"));
    CHECK(says(why(with(4, Vec3(0, 0, 0))), "cell 4, family 2: no fibres are given"));
    CHECK(says(why(with(2, Vec3(0, 0, 1.01))), "cell 2, family 2: a direction of length 1.01"));
    CHECK(says(why(with(2, Vec3(0.6, 0.8, 0)), {.frame = true}),
               "cell 2, family 2: a direction not orthogonal"));
    CHECK(why(with(4, Vec3(0, 0, 0)), {.gaps = true}).empty());
    CHECK(solid::checked(with(1, Vec3(0, 0, 1.0004)), 6).family[1].col(1) == Vec3(0, 0, 1));
    CHECK(says(refusal([&] { return solid::checked(good, 7); }), "6 directions, the mesh has 7 cells"));
    CHECK(says(refusal([] { return solid::uniform_fibres<1>(2, {Vec3(0, 0, 0)}); }), "has no direction"));

    const auto other = solid::uniform_fibres<2>(6, {Vec3(1, 0, 0), Vec3(0, 1, 0)});
    const std::vector<Index> layer{0, 1, 1, 0, 0, 1};
    const auto both = solid::layered_fibres<2>(layer, {good, other});
    for (Index c = 0; c < 6; ++c)
      CHECK(both[c].m == (layer[static_cast<std::size_t>(c)] == 0 ? good : other)[c].m);
    CHECK(says(refusal([&] {
                 return solid::layered_fibres<2>({0, 2}, {good, other});
               }),
               "cell 1: no fibres for layer 2"));
  }

  TEST_CASE("solid: fibres about lines that bend sharply or fork or pass through a cell") {
    // A corner of 90 degrees and one of 170, and a fork: unit vectors everywhere off the lines.
    const auto line = [](std::initializer_list<Vec3> points) {
      Points<3> p(3, static_cast<Eigen::Index>(points.size()));
      Eigen::Index k = 0;
      for (const Vec3& x : points) p.col(k++) = x;
      return p;
    };
    const double back = 170 * degree;
    const Vec3 o(0, 0, 0);
    const std::vector<std::vector<Points<3>>> trees{
        {line({Vec3(-10, 0, 0), o, Vec3(0, 10, 0)})},
        {line({Vec3(-10, 0, 0), o, Vec3(10 * std::cos(back), 10 * std::sin(back), 0)})},
        {line({Vec3(-10, 0, 0), o}), line({o, Vec3(7, 7, 0)}), line({o, Vec3(7, -7, 0)})}};
    const auto box = meshing::box_hexes(
        meshing::Block{.cells = {8, 8, 4}, .lo = Vec3(-4, -4.1, -2.2), .hi = Vec3(4.2, 4, 2)});
    for (const auto& tree : trees) {
      const auto field = solid::helical_fibres(box, solid::CentreLines(tree), 35 * degree);
      CHECK(refusal([&] { return solid::checked(field, box.cell_count()); }).empty());
      for (Index c = 0; c < box.cell_count(); ++c) {
        const auto at = solid::CentreLines(tree).at(solid::cell_middle(box, c));
        const Vec3 a = field.family[0].col(c);
        CHECK(a.dot(at.around) == doctest::Approx(std::cos(35 * degree)).epsilon(1e-12));
        CHECK(std::abs(a.dot(at.outward)) < 1e-14);
      }
    }
    // Round the outside of the corner of 90 degrees the frame turns evenly: no jump from cell to cell.
    const solid::CentreLines corner(trees[0]);
    Vec3 before = corner.at(Vec3(1, -1, 0) + Vec3(-3, 0, 0)).along;
    double jump = 0;
    for (double t = -3; t < 3; t += 0.01) {
      const Vec3 now = corner.at(Vec3(1, -1, 0) + (t < 0 ? Vec3(t, 0, 0) : Vec3(0, t, 0))).along;
      jump = std::max(jump, (now - before).norm());
      before = now;
    }
    MESSAGE("largest turn of the frame between points 0.01 apart: " << jump);
    CHECK(jump < 0.02);
    // On the line to the last bits there is no direction, and where it turns straight back neither.
    const solid::CentreLines straight({line({Vec3(-1, 3, 7), Vec3(11, 3, 7)})});
    for (const double off : {0.0, 1e-16, -8e-16}) {
      const auto at = straight.at(Vec3(5, 3 + off, 7));
      CHECK(at.around.norm() == 0);
      CHECK(at.outward.norm() == 0);
      CHECK(at.along.norm() == doctest::Approx(1));
    }
    CHECK(straight.at(Vec3(5, 3 + 1e-9, 7)).outward.dot(Vec3(0, 1, 0)) == doctest::Approx(1));
    CHECK(straight.at(Vec3(5, std::nan(""), 7)).around.norm() == 0);
    CHECK(says(refusal([&] {
                 Points<3> broken = trees[0][0];
                 broken(1, 1) = std::nan("");
                 return solid::CentreLines({broken});
               }),
               "line 0 has no direction behind point 0"));
    for (const std::vector<double>& radii :
         {std::vector{2.0, 1.0}, {1.0, 1.0}, {-1.0, 2.0}, {1.0, std::nan("")}})
      CHECK(says(refusal([&] { return solid::radial_layers(box, straight, radii); }),
                 "not above the one before"));
    CHECK(says(refusal([&] { return solid::helical_fibres(box, straight, std::nan("")); }),
               "cell 0 has an angle that is not a number"));
  }

  TEST_CASE("solid: fields of fibres with parts of a frame or with infinities are refused") {
    auto frame = solid::uniform_fibres<3>(4, {Vec3(1, 0, 0), Vec3(0, 2e-9, 0), Vec3(0, 0, 3e9)});
    CHECK(solid::checked(frame, 4, {.frame = true})[2].m[4] == 1);
    frame.family[1].col(2).setZero();
    CHECK(says(refusal([&] { return solid::checked(frame, 4, {.frame = true, .gaps = true}); }),
               "cell 2, family 2: an axis is missing beside others"));
    for (auto& f : frame.family) f.col(2).setZero();
    CHECK(refusal([&] { return solid::checked(frame, 4, {.frame = true, .gaps = true}); }).empty());
    const double infinity = std::numeric_limits<double>::infinity();
    frame.family[0].col(1) = Vec3(infinity, 0, 0);
    CHECK(says(refusal([&] { return solid::checked(frame, 4, {.gaps = true}); }),
               "cell 1, family 1: a direction that is not a number"));
    CHECK(says(refusal([&] { return solid::uniform_fibres<1>(2, {Vec3(infinity, 0, 0)}); }),
               "has no direction"));
    CHECK(says(refusal([&] { return solid::uniform_fibres<1>(2, {Vec3(0, std::nan(""), 0)}); }),
               "has no direction"));
    frame.family[1].resize(3, 3);
    CHECK(says(refusal([&] { return solid::checked(frame, 4); }), "family 2 has 3 directions"));
    CHECK(says(refusal([&] {
                 return solid::layered_fibres<1>({0, -1}, {solid::uniform_fibres<1>(2, {Vec3(1, 0, 0)})});
               }),
               "cell 1: no fibres for layer -1"));
  }
}
