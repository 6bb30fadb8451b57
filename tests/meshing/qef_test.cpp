// SPDX-License-Identifier: MIT
// The quadratic error function: planes stay, edges and corners are found, noise does no harm.
#include "tunica/meshing/qef.hpp"

#include "tunica/meshing/least_error.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <random>

using namespace tunica;
using meshing::Qef;

namespace {

struct Random {
  std::mt19937 engine{7};
  double operator()(double lo, double hi) {  // the same on every standard library
    return lo + (hi - lo) * (double(engine()) / 4294967296.0);
  }
  Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

// A point of the plane through `on`, within reach of it.
Vec3 point_of(Random& random, const Vec3& on, const Vec3& n) {
  Vec3 x = random.vector(0.5);
  return on + x - n * n.dot(x);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: qef eigenvectors diagonalise a symmetric matrix") {
    Random random;
    for (int trial = 0; trial < 100; ++trial) {
      Eigen::Matrix3d B;
      for (int k = 0; k < 3; ++k) B.col(k) = random.vector(1);
      const Eigen::Matrix3d A = B * B.transpose();
      const meshing::detail::SymmetricEigen e(A);
      CHECK((A * e.vectors - e.vectors * e.values.asDiagonal()).norm() < 1e-14);
      CHECK((e.vectors.transpose() * e.vectors - Eigen::Matrix3d::Identity()).norm() < 1e-14);
    }
  }

  TEST_CASE("meshing: qef of a plane keeps the mass point") {
    Random random;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 on = random.vector(10) + Vec3::Constant(1000), n = random.vector(1).normalized();
      Qef qef;
      for (int i = 0; i < 5; ++i) qef.add(point_of(random, on, n), n);
      const auto best = qef.minimum();
      CHECK(best.rank == 1);
      CHECK((best.position - qef.mass_point()).norm() < 1e-11);
      CHECK(std::abs(n.dot(best.position - on)) < 1e-12 * 1000);
    }
  }

  TEST_CASE("meshing: qef finds edges and corners exactly") {
    Random random;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 on = random.vector(10);
      const Vec3 n = random.vector(1).normalized();
      const Vec3 m = (n.cross(random.vector(1)).normalized() + 0.3 * n).normalized();
      const Vec3 l = (n.cross(m).normalized() + 0.2 * n).normalized();
      Qef edge;
      for (int i = 0; i < 3; ++i) edge.add(point_of(random, on, n), n), edge.add(point_of(random, on, m), m);
      const auto on_edge = edge.minimum();
      CHECK(on_edge.rank == 2);
      CHECK(std::abs(n.dot(on_edge.position - on)) < 1e-12);
      CHECK(std::abs(m.dot(on_edge.position - on)) < 1e-12);
      // least norm: along the edge it stays level with the mass point
      CHECK(std::abs(n.cross(m).dot(on_edge.position - edge.mass_point())) < 1e-12);
      Qef corner = edge;
      corner.add(point_of(random, on, l), l);
      const auto at = corner.minimum();
      CHECK(at.rank == 3);
      CHECK((at.position - on).norm() < 1e-11);
      CHECK(at.error < 1e-14);  // rounding of a sum of squares of order one
    }
  }

  TEST_CASE("meshing: qef is stable against noise in the normals of a plane") {
    Random random;
    const Vec3 n = Vec3(1, 2, 3).normalized();
    double worst = 0;
    for (int trial = 0; trial < 500; ++trial) {
      Qef qef;
      for (int i = 0; i < 6; ++i)
        qef.add(point_of(random, Vec3::Zero(), n), (n + random.vector(0.03)).normalized());
      const auto best = qef.minimum();
      CHECK(best.rank == 1);
      worst = std::max(worst, (best.position - qef.mass_point()).norm());
    }
    CHECK(worst < 0.05);  // normals are off by 0.03 sqrt 3 over half a cell
  }

  TEST_CASE("meshing: qef is held in its box at the least error") {
    Random random;
    const Box box{Vec3::Zero(), Vec3::Ones()};
    for (int trial = 0; trial < 200; ++trial) {
      Qef qef;
      for (int i = 0; i < 4; ++i)
        qef.add(Vec3::Constant(0.5) + random.vector(0.5), random.vector(1).normalized());
      const auto held = qef.minimum_in(box, {.cut = 0});
      CHECK((held.position.array() >= 0).all());
      CHECK((held.position.array() <= 1).all());
      for (int k = 0; k < 200; ++k)
        CHECK(held.error <= qef.error(Vec3::Constant(0.5) + random.vector(0.5)) + 1e-14);
    }
    Qef outside;  // the corner of these planes lies outside: the nearest point of the box wins
    outside.add({2, 0.5, 0.5}, {1, 0, 0}), outside.add({0.5, 0.25, 0.5}, {0, 1, 0});
    const auto held = outside.minimum_in(box);
    CHECK((held.position - Vec3(1, 0.25, 0.5)).norm() < 1e-15);
  }

  TEST_CASE("meshing: the closed form of the least error is that of the eigenvectors") {
    Random random;
    const Box box{Vec3::Zero(), Vec3::Ones()}, wide{Vec3::Constant(-9), Vec3::Constant(9)};
    double worst = 0;
    std::array<int, 4> ranks{};
    for (int trial = 0; trial < 4000; ++trial) {
      const double bend = trial % 4 == 0 ? 1e-9 : trial % 4 == 1 ? 0.1 : trial % 4 == 2 ? 0.4 : 3.0;
      const Vec3 n = random.vector(1).normalized();
      Qef qef;
      meshing::detail::PlaneSums sums;
      for (int i = 0; i < 3 + trial % 5; ++i) {
        const Vec3 p = Vec3::Constant(0.5) + random.vector(0.5), m = (n + random.vector(bend)).normalized();
        qef.add(p, m), sums.add(p, m);
      }
      for (const Box& hold : {wide, box}) {
        const auto free = qef.minimum_in(hold);
        ++ranks[static_cast<std::size_t>(free.rank)];
        worst = std::max(worst, (meshing::detail::least_error(sums, hold, {}) - free.position).norm());
        // half-way from the mass point on a smooth surface, and nowhere else
        if (qef.minimum().rank > 1 || (qef.minimum().position - free.position).norm() > 0) continue;
        const Vec3 half = meshing::detail::least_error(sums, hold, {.smooth = 0.5});
        CHECK((half - 0.5 * (free.position + qef.mass_point())).norm() < 1e-11);
      }
    }
    MESSAGE("apart by at most ", worst, "; ranks 0 to 3: ", ranks[0], ", ", ranks[1], ", ", ranks[2], ", ",
            ranks[3]);
    CHECK(worst < 1e-11);
    for (const std::size_t r : {1U, 2U, 3U}) CHECK(ranks[r] > 1000);
  }
}
