// SPDX-License-Identifier: MIT
#include "tunica/solid/single_element.hpp"
#include "tunica/core/types.hpp"
#include "tunica/solid/energy.hpp"
#include "tunica/solid/hyperelastic.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/volumetric.hpp"

#include <doctest/doctest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// A law that gives its energy alone: its derivatives come from duals.
struct Exponential {
  double mu;  // [Pa]
  double a;   // [-]
  static constexpr std::array reads{Invariant::I1, Invariant::I2};
  template <class S>
  S energy(const std::array<S, 2>& I) const {
    return S(mu / (2 * a)) * (exp(S(a) * (I[0] - S(3))) - S(1)) + S(0.2 * mu) * (I[0] - S(3)) * (I[1] - S(3));
  }
};

using Hex = SingleElement<mesh::Hex8, MeanVolume>;
using Tet = SingleElement<mesh::Tet4, MeanVolume>;

template <class Element>
typename Element::template Nodal<double> distorted(std::mt19937& random, double by) {
  std::uniform_real_distribution<double> jitter(-by, by);
  typename Element::template Nodal<double> X;
  for (int a = 0; a < Element::nodes; ++a) {
    if constexpr (Element::nodes == 8) {
      for (int i = 0; i < 3; ++i)
        X(i, a) =
            0.5 * (fem::detail::corners<3, 8>[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] + 1);
    } else {
      X.col(a) = a == 0 ? Vec3::Zero().eval() : Vec3::Unit(a - 1).eval();
    }
    for (int i = 0; i < 3; ++i) X(i, a) += jitter(random);
  }
  return X;
}

template <class Element, class Material>
double worst_derivative_error(const Material& material) {
  constexpr int n = Element::size;
  using D = Dual<double, n>;
  std::mt19937 random(7);
  double worst = 0;
  for (int state = 0; state < 5; ++state) {
    const auto X = distorted<Element>(random, 0.1);
    std::uniform_real_distribution<double> jitter(-0.05 * state, 0.05 * state);
    typename Element::template Nodal<double> u;
    Eigen::Matrix3d H;
    for (int k = 0; k < 9; ++k) H.data()[k] = jitter(random);
    for (int a = 0; a < Element::nodes; ++a)
      u.col(a) = H * X.col(a) + 0.3 * Vec3(jitter(random), jitter(random), jitter(random));
    typename Element::template Nodal<D> Xd, ud;
    for (int k = 0; k < n; ++k) Xd.data()[k] = D(X.data()[k]), ud.data()[k] = D::variable(u.data()[k], k);
    const auto t = Element::tangent(material, X, u);
    REQUIRE(t.smallest_J > 0.1);
    const auto f = Element::forces(material, X, u);
    const auto fd = Element::forces(material, Xd, ud);
    const D e = Element::energy(material, Xd, ud);
    const double scale = t.stiffness.cwiseAbs().maxCoeff();
    for (int r = 0; r < n; ++r) {
      const auto i = static_cast<std::size_t>(r);
      worst = std::max(worst, std::abs(e.d[i] - t.force[r]) / scale);
      worst = std::max(worst, std::abs(f.force[r] - t.force[r]) / scale);
      for (int c = 0; c < n; ++c)
        worst =
            std::max(worst, std::abs(fd.force[r].d[static_cast<std::size_t>(c)] - t.stiffness(r, c)) / scale);
    }
    CHECK((t.stiffness - t.stiffness.transpose()).cwiseAbs().maxCoeff() <= 1e-14 * scale);
  }
  return worst;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE(
      "solid: forces and tangent of a single element are the derivatives of its energy in all unknowns") {
    const auto all = [](const auto& law, const std::string& label) {
      const double a = worst_derivative_error<Hex>(Hyperelastic{law, Quadratic{.kappa = 50}});
      const double b = worst_derivative_error<Hex>(Hyperelastic{law, Logarithmic{.kappa = 5}});
      const double c = worst_derivative_error<Hex>(Hyperelastic{law, SimoTaylor{.kappa = 500}});
      const double d = worst_derivative_error<Tet>(Hyperelastic{law, SimoTaylor{.kappa = 50}});
      MESSAGE(label << ": against duals " << a << " " << b << " " << c << " tet " << d);
      CHECK(std::max({a, b, c, d}) < 1e-10);
    };
    all(NeoHooke{.c10 = 1}, "neo-Hooke");
    all(Yeoh{.c10 = 1, .c20 = 10}, "Yeoh");
    all(MooneyRivlin{.c10 = 1, .c01 = 0.5}, "Mooney-Rivlin");
    all(Exponential{.mu = 2, .a = 0.8}, "energy alone");
  }

  TEST_CASE("solid: a rigid motion gives no stress and superposed rotations turn the forces") {
    std::mt19937 random(3);
    const auto X = distorted<Hex>(random, 0.1);
    const Hyperelastic wall{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}};
    const double mu = 2 * wall.isochoric.c10;
    double worst = 0, turned = 0;
    Hex::Nodal<double> u;
    for (int k = 0; k < 24; ++k) u.data()[k] = 0.02 * std::sin(3.0 * k);
    const auto f = Hex::forces(wall, X, u).force;
    for (int degrees = 0; degrees <= 360; degrees += 15) {
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, Vec3(1, 2, -0.5).normalized())
              .toRotationMatrix();
      const Hex::Nodal<double> spin = (R * X).colwise() + Vec3(0.3, -0.2, 0.1) - X;
      worst = std::max(worst, Hex::stress(wall, X, spin).sigma.cwiseAbs().maxCoeff() / mu);
      const Hex::Nodal<double> both = R * (X + u) - X;
      const auto g = Hex::forces(wall, X, both).force;
      for (int a = 0; a < 8; ++a)
        turned = std::max(turned, (g.segment<3>(3 * a) - R * f.segment<3>(3 * a)).norm() / f.norm());
    }
    MESSAGE("stress of a rigid motion " << worst << " mu; forces turned within " << turned);
    CHECK(worst < 1e-12);
    CHECK(turned < 1e-12);
  }

  TEST_CASE("solid: Hex8 forces balance and the tangent at rest has just the six rigid modes") {
    std::mt19937 random(5);
    const auto X = distorted<Hex>(random, 0.1);
    const Hyperelastic wall{Yeoh{.c10 = 1, .c20 = 10}, Quadratic{.kappa = 1000}};
    Hex::Nodal<double> u;
    for (int k = 0; k < 24; ++k) u.data()[k] = 0.02 * std::sin(3.0 * k);
    const auto f = Hex::forces(wall, X, u).force;
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (int a = 0; a < 8; ++a) {
      sum += f.segment<3>(3 * a);
      moment += Vec3(X.col(a) + u.col(a)).cross(Vec3(f.segment<3>(3 * a)));
    }
    CHECK(sum.norm() < 1e-13 * f.norm());
    CHECK(moment.norm() < 1e-13 * f.norm());
    u.setZero();
    const Eigen::Matrix<double, 24, 24> K = Hex::tangent(wall, X, u).stiffness;
    const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    MESSAGE("eigenvalues 6 and 7 of 24: " << lambda[5] << " " << lambda[6] << ", largest " << lambda[23]);
    CHECK(std::abs(lambda[5]) < 1e-12 * lambda[23]);
    CHECK(lambda[6] > 1e-3);
  }
}
