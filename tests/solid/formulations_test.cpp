// SPDX-License-Identifier: MIT
// Every cell with every formulation, through Body.
#include "tunica/core/parallel.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/compressible_laws.hpp"
#include "tunica/solid/dynamics.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

constexpr double mu = 2;
using Law = Hyperelastic<Yeoh, Quadratic>;
Law pair_of(double kappa) {
  return {Yeoh{.c10 = 0.5 * mu, .c20 = 0.7}, Quadratic{.kappa = kappa}};
}

template <class Locking>
constexpr const char* name_of = "Pointwise";
template <>
constexpr const char* name_of<MeanVolume> = "MeanVolume";
template <>
constexpr const char* name_of<LinearVolume> = "LinearVolume";
template <>
constexpr const char* name_of<FBar> = "FBar";
/// FBar of a law that is not taken for a pair.
struct WholeFBar {};
template <>
constexpr const char* name_of<WholeFBar> = "FBar of a whole law";
template <>
constexpr const char* name_of<NodalPressure> = "NodalPressure";

/// A cell and the cure of locking it is solved with.
template <class C, class L>
struct Case {
  using Cell = C;
  using Locking = L;
  static std::string name() { return std::to_string(C::nodes) + " nodes, " + name_of<L>; }
};

template <class Locking, class... C, class Check>
void for_each_cell(const Check& check) {
  (check(Case<C, Locking>{}), ...);
}
template <class Check>
void for_each_pair(const Check& check) {
  using namespace mesh;
  for_each_cell<Pointwise, Tet4, Tet10, Hex8, Hex20, Hex27, Wedge6>(check);
  for_each_cell<MeanVolume, Tet4, Tet10, Hex8, Hex20, Hex27, Wedge6>(check);
  for_each_cell<LinearVolume, Hex27>(check);
  for_each_cell<FBar, Hex8, Hex20, Hex27, Wedge6>(check);
}
template <class Check>
void for_each_case(const Check& check) {
  for_each_pair(check);
  for_each_cell<WholeFBar, mesh::Hex8>(check);
  for_each_cell<NodalPressure, mesh::Tet4>(check);
}

/// A pair that is seen as a whole.
struct Whole {
  Law law;
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F) const {
    return law.stress(F);
  }
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F) const {
    return law.response(F);
  }
};

/// What a body under that formulation is given.
template <class Locking>
auto given(double kappa) {
  if constexpr (std::is_same_v<Locking, WholeFBar>)
    return with<FBar>(Whole{pair_of(kappa)});
  else
    return with<Locking>(pair_of(kappa));
}
template <class C, class Given>
using LockingOf = typename Formulation<Given, C>::Locking;
static_assert(std::is_same_v<LockingOf<mesh::Hex8, Law>, MeanVolume>);
static_assert(std::is_same_v<LockingOf<mesh::Hex20, Law>, MeanVolume>);
static_assert(std::is_same_v<LockingOf<mesh::Hex27, Law>, LinearVolume>);
static_assert(std::is_same_v<LockingOf<mesh::Tet10, Law>, MeanVolume>);
static_assert(std::is_same_v<LockingOf<mesh::Hex27, CompressibleNeoHooke>, Pointwise>);
static_assert(std::is_same_v<LockingOf<mesh::Hex8, With<FBar, Law>>, CentreVolume>);
static_assert(std::is_same_v<LockingOf<mesh::Hex8, With<FBar, CompressibleNeoHooke>>, FBar>);

bool inside(const Vec3& x) {
  return (x.array() > 1e-9).all() && (x.array() < 1 - 1e-9).all();
}

template <class Mesh>
void jitter(Mesh& mesh, double by) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-by, by);
  for (Index k = 0; k < mesh.node_count(); ++k)
    if (inside(mesh.nodes.col(k)))
      for (int i = 0; i < 3; ++i) mesh.nodes(i, k) += shift(random);
}

/// The unit cube in cells of C, n boxes a side, its inner nodes moved: also those in the middle of edges,
/// faces and cells of hexahedra, whose rules integrate that exactly; the edges of Tet10 stay straight.
template <mesh::Cell C>
mesh::Mesh<C, 3> distorted(int n) {
  const double by = 0.2 / n;
  if constexpr (std::is_same_v<C, mesh::Tet4> || std::is_same_v<C, mesh::Tet10>) {
    auto tets = meshing::box_tets(n);
    jitter(tets, by);
    if constexpr (mesh::Quadratic<C>)
      return mesh::quadratic<C>(tets);
    else
      return tets;
  } else {
    auto hexes = meshing::box_hexes(n);
    jitter(hexes, by);
    if constexpr (mesh::Quadratic<C>) {
      auto mesh = mesh::quadratic<C>(hexes);
      jitter(mesh, 0.2 * by);
      return mesh;
    } else if constexpr (std::is_same_v<C, mesh::Wedge6>) {
      mesh::Mesh<C, 3> mesh;
      mesh.nodes = hexes.nodes;
      mesh.cells.resize(6, 2 * hexes.cells.cols());
      const int halves[2][6] = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
      for (Eigen::Index e = 0; e < mesh.cells.cols(); ++e)
        for (int a = 0; a < 6; ++a) mesh.cells(a, e) = hexes.cells(halves[e % 2][a], e / 2);
      return mesh;
    } else {
      return hexes;
    }
  }
}

/// Strains up to 0.2, and pressures of the size of mu where there are any.
template <class Body>
Eigen::VectorXd wavy(const Body& body) {
  Eigen::VectorXd u(body.unknowns());
  for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = 0.02 * std::sin(1.7 * static_cast<double>(k) + 0.3);
  return u;
}

/// The unknowns of an affine displacement: with the pressures that belong to its J.
template <class Body>
Eigen::VectorXd affine(const Body& body, const Eigen::Matrix3d& H, double kappa) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns());
  const Points<3> moved = H * body.mesh().nodes;
  u.head(moved.size()) = moved.reshaped();
  if constexpr (Body::per_node == 4) {
    const double J = (Eigen::Matrix3d::Identity() + H).determinant();
    const double unit = body.inside().pressures(Eigen::VectorXd::Ones(body.unknowns()))[0];
    u.tail(body.mesh().node_count()).setConstant(kappa * (J - 1) / unit);
  }
  return u;
}

Eigen::Matrix3d gradient() {
  Eigen::Matrix3d H;
  H << 0.3, 0.2, -0.1, 0.1, -0.15, 0.2, -0.05, 0.1, 0.1;
  return H * (0.5 / H.norm());
}

template <class C, class Given>
Body<C, Given> body_of(const mesh::Mesh<C, 3>& mesh, const Given& law) {
  return {mesh, law, 0.0, Mass::lumped};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: tangents of all cells and formulations are the differences of their forces") {
    for_each_case([](auto one) {
      using T = decltype(one);
      INFO(T::name());
      using C = typename T::Cell;
      const auto mesh = distorted<C>(std::is_same_v<C, mesh::Hex27> ? 1 : 2);
      auto body = body_of(mesh, given<typename T::Locking>(100 * mu));
      const Eigen::VectorXd u = wavy(body), none;
      Eigen::VectorXd f, plus, minus, predicted;
      REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
      la::SparseMatrix K = body.pattern();
      body.tangent(u, none, {}, K);
      const double size = K.coeffs().abs().maxCoeff(), h = 1e-5;
      double worst = 0;
      for (Index k = 0; k < body.unknowns(); k += 1 + body.unknowns() / 97) {
        Eigen::VectorXd v = u;
        v[k] = u[k] + h;
        REQUIRE(body.internal_forces(v, la::no_step, plus, predicted));
        v[k] = u[k] - h;
        REQUIRE(body.internal_forces(v, la::no_step, minus, predicted));
        const Eigen::VectorXd slope = (plus - minus) / (2 * h);
        worst = std::max(worst, (Eigen::VectorXd(K.col(k)) - slope).cwiseAbs().maxCoeff() / size);
      }
      const double skew = la::SparseMatrix(K - la::SparseMatrix(K.transpose())).coeffs().abs().maxCoeff();
      MESSAGE(T::name() << ": tangent off by " << worst << ", skew part " << skew / size);
      CHECK(worst < 1e-7);
      CHECK((skew < 1e-14 * size) == body.symmetric);
    });
  }

  TEST_CASE("solid: patch test of all cells and formulations") {
    for_each_case([](auto one) {
      using T = decltype(one);
      INFO(T::name());
      using C = typename T::Cell;
      const double kappa = 50 * mu;
      const auto mesh = distorted<C>(2);
      auto body = body_of(mesh, given<typename T::Locking>(kappa));
      Eigen::VectorXd f, predicted;
      REQUIRE(body.internal_forces(affine(body, gradient(), kappa), la::no_step, f, predicted));
      double residual = 0;
      int count = 0;
      for (Index n = 0; n < mesh.node_count(); ++n)
        if (inside(mesh.nodes.col(n))) {
          residual = std::max(residual, f.segment<3>(3 * n).norm());
          ++count;
        }
      if constexpr (body.per_node == 4)
        residual = std::max(residual, f.tail(mesh.node_count()).cwiseAbs().maxCoeff());
      MESSAGE(T::name() << ": residual inside " << residual / f.norm() << " at " << count << " nodes");
      CHECK(count > 0);
      CHECK(residual < 1e-13 * f.norm());
    });
  }

  TEST_CASE("solid: a full turn in all cells and formulations wakes no stress") {
    for_each_case([](auto one) {
      using T = decltype(one);
      INFO(T::name());
      using C = typename T::Cell;
      const double kappa = 1000 * mu;
      auto mesh = distorted<C>(1);
      mesh.cells = mesh.cells.leftCols(1).eval();
      auto body = body_of(mesh, given<typename T::Locking>(kappa));
      double stress = 0, deviatoric = 0, force = 0;
      Eigen::VectorXd f, predicted;
      for (int k = 0; k <= 12; ++k) {
        const Eigen::AngleAxisd turn(k * std::numbers::pi / 6, Vec3(1, 2, -0.5).normalized());
        const Eigen::VectorXd u = affine(body, turn.toRotationMatrix() - Eigen::Matrix3d::Identity(), kappa);
        REQUIRE(body.internal_forces(u, la::no_step, f, predicted));
        const StressField sigma = cell_stress(body, u);
        stress = std::max(stress, sigma.cwiseAbs().maxCoeff());
        deviatoric = std::max(deviatoric, von_mises(sigma).maxCoeff());
        force = std::max(force, f.cwiseAbs().maxCoeff());
      }
      MESSAGE(T::name() << ": stress " << stress / mu << " mu, von Mises " << deviatoric / mu
                        << " mu, forces " << force / mu << " mu L^2");
      // det(r F) = J0 of a whole law holds to the roundings of r three times.
      const double apart = std::is_same_v<typename T::Locking, WholeFBar> ? 3 : 0;
      CHECK(stress < 1e-12 * mu + apart * std::numeric_limits<double>::epsilon() * kappa);
      CHECK(deviatoric < 1e-12 * mu);
      CHECK(force < 1e-12 * mu);
    });
  }

  TEST_CASE("solid: all cells and formulations give the same bits on one and two threads") {
    for_each_case([](auto one) {
      using T = decltype(one);
      INFO(T::name());
      using C = typename T::Cell;
      const auto mesh = distorted<C>(mesh::Quadratic<C> ? 3 : 4);
      auto body = body_of(mesh, given<typename T::Locking>(100 * mu));
      const Eigen::VectorXd u = 0.5 * wavy(body), none;
      Eigen::VectorXd f[2], predicted;
      la::SparseMatrix K[2] = {body.pattern(), body.pattern()};
      for (const int threads : {1, 2}) {
        thread_count() = threads;
        CHECK(body.internal_forces(u, la::no_step, f[threads - 1], predicted));
        body.tangent(u, none, {}, K[threads - 1]);
      }
      thread_count() = 1;
      CHECK(f[0] == f[1]);
      CHECK((K[0].coeffs() == K[1].coeffs()).all());
    });
  }

  TEST_CASE("solid: regions under two laws in one pack are two bodies") {
    for_each_pair([](auto one) {
      using T = decltype(one);
      INFO(T::name());
      using C = typename T::Cell;
      auto mesh = distorted<C>(2);
      mesh.region_names = {"a", "b"};
      for (Index e = 0; e < mesh.cell_count(); ++e) mesh.region.push_back((e * 5 / 3) % 2);
      const auto soft = given<typename T::Locking>(60 * mu);
      Law stiff_law = pair_of(300 * mu);
      stiff_law.isochoric.c10 *= 7;
      auto whole = body_of(mesh, soft);
      whole.laws().material(1, stiff_law);
      const Eigen::VectorXd u = 0.5 * wavy(whole), none;
      Eigen::VectorXd f, part, predicted, sum = Eigen::VectorXd::Zero(u.size()), Ku = sum;
      REQUIRE(whole.internal_forces(u, la::no_step, f, predicted));
      la::SparseMatrix K = whole.pattern();
      whole.tangent(u, none, {}, K);
      for (const Index region : {0, 1}) {
        auto half = mesh;
        half.region.clear();
        Eigen::Index count = 0;
        for (Index e = 0; e < mesh.cell_count(); ++e)
          if (mesh.region[static_cast<std::size_t>(e)] == region) half.cells.col(count++) = mesh.cells.col(e);
        CHECK(count > 0);
        CHECK(count < mesh.cells.cols());
        half.cells.conservativeResize(Eigen::NoChange, count);
        auto body = body_of(half, soft);
        if (region == 1) body.laws().material(0, stiff_law);
        REQUIRE(body.internal_forces(u, la::no_step, part, predicted));
        sum += part;
        la::SparseMatrix A = body.pattern();
        body.tangent(u, none, {}, A);
        Ku += A * u;
      }
      CHECK((f - sum).norm() < 1e-14 * f.norm());
      CHECK((K * u - Ku).norm() < 1e-14 * Ku.norm());
    });
  }

  TEST_CASE("solid: quadratic and mixed tetrahedra swing through twenty steps") {
    const Hyperelastic law{Yeoh{.c10 = 174e3, .c20 = 1880e3}, Quadratic{.kappa = 348e6}};
    const auto tets = meshing::box_tets(meshing::Block{.cells = {2, 2, 6}, .hi = Vec3(2e-3, 2e-3, 10e-3)});
    const auto swing = [](const std::string& name, const auto& mesh, const auto& material) {
      Dynamics rod{mesh, material, 1100.0};
      rod.fix(mesh.patch("z0"));
      Points<3> v = Points<3>::Zero(3, mesh.node_count());
      for (Index n = 0; n < mesh.node_count(); ++n)
        v(0, n) = 3.0 * std::pow(mesh.nodes(2, n) / 10e-3, 2);  // bends [m/s]
      REQUIRE(rod.start(Points<3>::Zero(3, mesh.node_count()), v));
      const double first = rod.kinetic_energy();
      double most_strain = 0, highest = 0;
      int iterations = 0;
      for (int k = 0; k < 20; ++k) {
        const SolveReport step = rod.step(1e-4);
        REQUIRE(step);
        iterations = std::max(iterations, step.iterations);
        const double strain = rod.strain_energy(), kinetic = rod.kinetic_energy();
        CHECK(std::isfinite(strain + kinetic));
        most_strain = std::max(most_strain, strain);
        highest = std::max(highest, strain + kinetic);
      }
      MESSAGE(name << ": energy " << first << " J at first and at most " << highest
                   << " J, in strain at most " << most_strain << " J, at most " << iterations
                   << " iterations a step");
      CHECK(highest < 1.05 * first);
      CHECK(most_strain > 0.3 * first);  // it swings
    };
    swing("Tet10", mesh::quadratic<mesh::Tet10>(tets), law);
    swing("Tet4 with NodalPressure", tets, with<NodalPressure>(law));
  }
}
