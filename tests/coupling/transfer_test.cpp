// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "tunica/coupling/closest_point.hpp"
#include "tunica/coupling/concepts.hpp"
#include "tunica/coupling/matching.hpp"
#include "tunica/coupling/octree.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

using namespace tunica;

namespace {

static_assert(coupling::Transfer<coupling::Matching>);
static_assert(coupling::Transfer<coupling::Octree<mesh::Quad4>>);
static_assert(coupling::Transfer<coupling::Octree<mesh::Tri3>>);

struct Side {
  Points<3> nodes;
  mesh::Patch<mesh::Quad4> quads;
  mesh::Patch<mesh::Tri3> triangles;
};

/// nx * ny quadrilaterals (and twice as many triangles) over the unit square, mapped.
template <class Map>
Side grid(Index nx, Index ny, Map&& map) {
  Side side;
  side.nodes.resize(3, (nx + 1) * (ny + 1));
  for (Index j = 0; j <= ny; ++j)
    for (Index i = 0; i <= nx; ++i)
      side.nodes.col(j * (nx + 1) + i) = map(static_cast<double>(i) / nx, static_cast<double>(j) / ny);
  side.quads.faces.resize(4, nx * ny);
  side.triangles.faces.resize(3, 2 * nx * ny);
  for (Index j = 0; j < ny; ++j)
    for (Index i = 0; i < nx; ++i) {
      const Index a = j * (nx + 1) + i, b = a + 1, c = b + nx + 1, d = a + nx + 1, f = j * nx + i;
      side.quads.faces.col(f) << a, b, c, d;
      side.triangles.faces.col(2 * f) << a, b, c;
      side.triangles.faces.col(2 * f + 1) << a, c, d;
    }
  return side;
}

/// A half tube of radius 5 mm and length 50 mm.
Vec3 half_tube(double s, double t) {
  const double angle = std::numbers::pi * s;
  return {5e-3 * std::cos(angle), 5e-3 * std::sin(angle), 50e-3 * t};
}

Points<3> noise(Eigen::Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Points<3>::NullaryExpr(3, n, [&] { return uniform(random); });
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("coupling: the closest point of a bilinear quadrilateral beats every sampled point") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    double excess = 0;
    for (int trial = 0; trial < 300; ++trial) {
      coupling::FaceNodes<mesh::Quad4> q;
      q << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
      q += 0.5 * coupling::FaceNodes<mesh::Quad4>(noise(4, static_cast<unsigned>(trial)));
      const Vec3 x(2 * uniform(random), 2 * uniform(random), uniform(random));
      const auto point = coupling::closest_point(mesh::Quad4{}, q, x);
      CHECK(point.weights.minCoeff() >= 0);
      CHECK(point.weights.sum() == doctest::Approx(1).epsilon(1e-15));
      CHECK(std::abs((q * point.weights - x).squaredNorm() - point.squared_distance) <
            1e-12 * (x.squaredNorm() + 1));
      for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j) {
          const double sampled = (q * coupling::detail::bilinear(i / 40.0, j / 40.0) - x).norm();
          excess = std::max(excess, std::sqrt(point.squared_distance) - sampled);
        }
    }
    MESSAGE("largest excess over a sampled point: " << excess);
    CHECK(excess < 1e-12);
  }

  TEST_CASE("coupling: a degenerate quadrilateral still has a closest point") {
    coupling::FaceNodes<mesh::Quad4> q;
    q << 0, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0;  // two corners coincide
    const auto inside = coupling::closest_point(mesh::Quad4{}, q, Vec3(0.7, 0.3, 2));
    CHECK(inside.squared_distance == doctest::Approx(4));
    q.setConstant(1);  // all corners coincide
    CHECK(coupling::closest_point(mesh::Quad4{}, q, Vec3(1, 1, 4)).squared_distance == doctest::Approx(9));
  }

  TEST_CASE("coupling: matching interfaces are paired whatever their numbering") {
    const Side side = grid(7, 5, half_tube);
    Points<3> shuffled = side.nodes;
    std::vector<Index> order(static_cast<std::size_t>(shuffled.cols()));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>((i * 31 + 5) % order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      shuffled.col(static_cast<Eigen::Index>(i)) = side.nodes.col(order[i]);
    const coupling::Matching pairs(shuffled, side.nodes, 1e-9);
    CHECK(pairs.to_fluid(side.nodes) == shuffled);
    CHECK(pairs.to_structure(shuffled) == side.nodes);
    CHECK(coupling::Matching{}.to_fluid(shuffled) == shuffled);
    Points<3> moved = shuffled;
    moved(2, 11) += 1e-5;
    CHECK_THROWS_AS(coupling::Matching(moved, side.nodes, 1e-9), MeshError);
    CHECK_THROWS_AS(coupling::Matching(moved.leftCols(3), side.nodes, 1e-9), MeshError);
  }

  TEST_CASE("coupling: octree transfer keeps force and work on a curved interface") {
    // fluid to structure edge ratios from 1:4 to 4:1, the fluid rotated about the axis by 30 degrees of a
    // cell
    for (const Index n : {6, 12, 24, 48, 96}) {
      const Side fluid = grid(n, n, [](double s, double t) { return half_tube(0.02 + 0.95 * s, t); });
      const Side solid = grid(24, 24, half_tube);
      const coupling::Octree transfer(fluid.nodes, fluid.triangles, solid.nodes, solid.quads);
      const Points<3> f = noise(fluid.nodes.cols(), 1), u = noise(solid.nodes.cols(), 2);
      const Points<3> g = transfer.to_structure(f), v = transfer.to_fluid(u);
      const double force = (f.rowwise().sum() - g.rowwise().sum()).norm() / f.cwiseAbs().sum();
      const double work =
          std::abs(f.cwiseProduct(v).sum() - g.cwiseProduct(u).sum()) / f.cwiseProduct(v).cwiseAbs().sum();
      // about the projected points the moment is exact; about the nodes it may err by the gap
      const Points<3> projected = transfer.to_fluid(solid.nodes);
      Vec3 moment = Vec3::Zero(), nodal = Vec3::Zero();
      double size = 0;
      for (Eigen::Index i = 0; i < f.cols(); ++i) {
        const Vec3 x = projected.col(i), at = fluid.nodes.col(i), fi = f.col(i);
        moment += x.cross(fi);
        nodal += at.cross(fi);
        size += x.norm() * fi.norm();
      }
      const double gap = transfer.gap() * f.colwise().norm().sum();
      for (Eigen::Index i = 0; i < g.cols(); ++i) {
        const Vec3 x = solid.nodes.col(i), gi = g.col(i);
        moment -= x.cross(gi);
        nodal -= x.cross(gi);
      }
      MESSAGE("edge ratio " << 24.0 / n << ": force " << force << " work " << work << " moment "
                            << moment.norm() / size << " gap " << transfer.gap());
      CHECK(force < 1e-13);
      CHECK(work < 1e-13);
      CHECK(moment.norm() < 1e-13 * size);
      CHECK(nodal.norm() <= gap);
      CHECK(transfer.gap() <
            5e-3 * (1 - std::cos(std::numbers::pi / 48)) * 1.01);  // sagitta of a structure's edge
      CHECK(transfer.to_fluid(Points<3>::Constant(3, solid.nodes.cols(), 3)).isApproxToConstant(3, 1e-14));
    }
  }

  TEST_CASE("coupling: octree transfer is exact for linear displacements of a planar interface") {
    // both sides irregular, rotated by 30 degrees against each other within the plane
    const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const auto wavy = [](double s, double t) {
      return Vec3(s + 0.08 * std::sin(5 * t), t + 0.08 * std::sin(4 * s), 0);
    };
    const double a = std::numbers::pi / 6;
    const auto rotated = [&](double s, double t) {
      const double x = 0.5 * (s - 0.5), y = 0.5 * (t - 0.5);
      return Vec3(tilt *
                  Vec3(0.5 + std::cos(a) * x - std::sin(a) * y, 0.55 + std::sin(a) * x + std::cos(a) * y, 0));
    };
    const Side solid = grid(9, 7, [&](double s, double t) { return Vec3(tilt * wavy(s, t)); });
    Eigen::Matrix3d A;
    A << 1, 2, 3, -4, 5, 6, 7, -8, 9;
    for (const Index n : {3, 13, 40}) {
      const Side fluid = grid(n, n, rotated);
      const auto error = [&](const auto& transfer) {
        const Points<3> u = (A * solid.nodes).colwise() + Vec3(1, -1, 2);
        const Points<3> exact = (A * fluid.nodes).colwise() + Vec3(1, -1, 2);
        return (transfer.to_fluid(u) - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
      };
      const coupling::Octree quads(fluid.nodes, fluid.triangles, solid.nodes, solid.quads);
      const coupling::Octree triangles(fluid.nodes, fluid.quads, solid.nodes, solid.triangles);
      MESSAGE("n = " << n << ": quadrilaterals " << error(quads) << " triangles " << error(triangles));
      CHECK(error(quads) < 1e-13);
      CHECK(error(triangles) < 1e-13);
    }
  }

  TEST_CASE("coupling: octree transfer of a smooth displacement is of second order") {
    const auto field = [](const Points<3>& x) {
      Points<3> u(3, x.cols());
      for (Eigen::Index i = 0; i < x.cols(); ++i)
        u.col(i) << std::sin(200 * x(2, i)) * x(0, i), x(1, i) * std::cos(150 * x(2, i)),
            std::sin(400 * x(0, i));
      return u;
    };
    double before = 0;
    for (const Index n : {8, 16, 32, 64}) {
      const Side fluid = grid(199, 211, half_tube), solid = grid(n, n, half_tube);
      const coupling::Octree transfer(fluid.nodes, fluid.triangles, solid.nodes, solid.quads);
      const double error = (transfer.to_fluid(field(solid.nodes)) - field(fluid.nodes)).cwiseAbs().maxCoeff();
      MESSAGE("n = " << n << " error " << error << " order " << std::log2(before / error));
      if (before > 0) CHECK(before / error > 3.2);
      before = error;
    }
  }

  TEST_CASE("coupling: interfaces that lie apart are refused with the place") {
    const Side solid = grid(6, 6, half_tube);
    const Side far = grid(6, 6, [](double s, double t) { return Vec3(half_tube(s, t) + Vec3(0.1, 0, 0)); });
    CHECK_THROWS_WITH_AS(coupling::Octree(far.nodes, far.triangles, solid.nodes, solid.quads),
                         doctest::Contains("lies 0."), MeshError);
    mesh::Patch<mesh::Quad4> nothing;
    CHECK_THROWS_AS(coupling::Octree(far.nodes, far.triangles, solid.nodes, nothing), MeshError);
  }
}
