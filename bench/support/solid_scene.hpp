// SPDX-License-Identifier: MIT
// The thick tube of law (17) and Cook's membrane [COOK74] in any cell: what the scene `solids` solves.
#pragma once

#include "support/thick_tube.hpp"
#include "tunica/fem/quadrature.hpp"
#include "tunica/fem/shape.hpp"
#include "tunica/fem/shape_quadratic.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/mesh/quadratic.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/load_faces.hpp"
#include "tunica/solid/statics.hpp"

#include <cmath>
#include <concepts>
#include <numbers>
#include <string>

namespace tunica::bench {

/// A slab of the unit square as cells of C with all nodes, the middle ones too, moved by place(X).
template <mesh::Cell C, class Place>
[[nodiscard]] mesh::Mesh<C, 3> slab(int nx, int ny, double height, Place&& place) {
  const meshing::Block block{.cells = {nx, ny, 1}, .hi = Vec3(1, 1, height)};
  mesh::Mesh<C, 3> mesh = [&] {
    if constexpr (std::same_as<C, mesh::Hex8>)
      return meshing::box_hexes(block);
    else if constexpr (std::same_as<C, mesh::Tet4>)
      return meshing::box_tets(block);
    else if constexpr (std::same_as<typename C::Linear, mesh::Hex8>)
      return mesh::quadratic<C>(meshing::box_hexes(block));
    else
      return mesh::quadratic<C>(meshing::box_tets(block));
  }();
  for (Index n = 0; n < mesh.node_count(); ++n) {
    const Vec3 X = mesh.nodes.col(n);
    mesh.nodes.col(n) = place(X);
  }
  return mesh;
}

/// How a solution was reached and what it shows.
struct [[nodiscard]] SolidValue {
  bool converged = false;
  double value = 0;  // tube: inner stretch, mean over the nodes; membrane: rise of its corner [mm]
  Index dofs = 0;
  int iterations = 0, steps = 0, cuts = 0;
};

template <class Statics>
[[nodiscard]] SolidValue solved(Statics& wall) {
  const auto report = wall.solve();
  return {.converged = static_cast<bool>(report),
          .dofs = wall.body().unknowns(),
          .iterations = report.solve.iterations,
          .steps = report.steps,
          .cuts = report.cuts};
}

/// A quarter of a slice of the tube, n cells through its wall and 4 n around, bent onto the circle.
struct TubeScene {
  static constexpr const char* name = "thick tube";
  static constexpr const char* peer = "tube";
  static constexpr double stretch = 1.10;
  test::ThickTube tube{};

  [[nodiscard]] double size(int n) const { return (tube.outer - tube.inner) / n; }  // [m]
  [[nodiscard]] double error(double value) const { return std::abs(value - stretch); }

  /// law (17), kappa so large that its own error, linear in 1/kappa, stays below that of the meshes.
  [[nodiscard]] auto law() const {
    return solid::Hyperelastic{solid::Yeoh{.c10 = tube.c10, .c20 = tube.c20},
                               solid::Quadratic{.kappa = 2e6 * tube.c10}};
  }
  template <mesh::Cell C>
  [[nodiscard]] mesh::Mesh<C, 3> mesh(int n) const {
    return slab<C>(n, 4 * n, 1e-3, [&](const Vec3& X) -> Vec3 {
      const double r = tube.inner + (tube.outer - tube.inner) * X[0], angle = 0.5 * std::numbers::pi * X[1];
      return {r * std::cos(angle), r * std::sin(angle), X[2]};
    });
  }
  template <mesh::Cell C, class Material>
  [[nodiscard]] SolidValue solve(const mesh::Mesh<C, 3>& mesh, const Material& material,
                                 const solid::StaticsOptions& options = {}) const {
    solid::Statics wall{mesh, material, options};
    for (const char* end : {"z0", "z1"}) wall.fix(mesh.patch(end), solid::Axis::z);
    wall.fix(mesh.patch("y0"), solid::Axis::y);
    wall.fix(mesh.patch("y1"), solid::Axis::x);
    wall.pressure(mesh.patch("x0"), tube.pressure(stretch));
    SolidValue r = solved(wall);
    const Points<3> u = wall.displacement();
    const auto inner = mesh::patch_nodes(mesh.patch("x0"));
    for (const Index k : inner)
      r.value += (mesh.nodes.col(k) + u.col(k)).template head<2>().norm() /
                 (tube.inner * static_cast<double>(inner.size()));
    return r;
  }
};

/// The quasi-incompressible membrane in plane strain, n x n cells and one of 1 mm across.
struct CookScene {
  static constexpr const char* name = "Cook's membrane";
  static constexpr const char* peer = "cook-i";
  static constexpr double rise = 6.933;                        // of the corner [mm]
  static constexpr double mu = 80.194e6, lambda = 400889.8e6;  // [Pa]
  static constexpr double traction = 100e3 / 16e-3;            // 100 N per mm of thickness [Pa]

  [[nodiscard]] double size(int n) const { return 48e-3 / n; }  // [m]
  [[nodiscard]] double error(double value) const { return std::abs(value / rise - 1); }
  [[nodiscard]] auto law() const {
    return solid::Hyperelastic{solid::NeoHooke{.c10 = 0.5 * mu}, solid::Quadratic{.kappa = lambda}};
  }
  template <mesh::Cell C>
  [[nodiscard]] mesh::Mesh<C, 3> mesh(int n) const {
    return slab<C>(n, n, 1e-3, [](const Vec3& X) -> Vec3 {
      return {48e-3 * X[0], 44e-3 * X[0] + (44e-3 - 28e-3 * X[0]) * X[1], X[2]};
    });
  }
  template <mesh::Cell C, class Material>
  [[nodiscard]] SolidValue solve(const mesh::Mesh<C, 3>& mesh, const Material& material,
                                 const solid::StaticsOptions& options = {}) const {
    solid::Statics wall{mesh, material, options};
    wall.fix(mesh.patch("x0"));
    for (const char* side : {"z0", "z1"}) wall.fix(mesh.patch(side), solid::Axis::z);
    const auto& right = mesh.patch("x1");
    Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.node_count());  // int N dA, the faces being alike
    using Rule = solid::FaceRule<typename C::Face>;
    const double face = 16e-3 * 1e-3 / static_cast<double>(right.faces.cols());
    double reference = 0;
    for (std::size_t q = 0; q < Rule::size; ++q) reference += Rule::weights[q];
    for (std::size_t q = 0; q < Rule::size; ++q) {
      const auto N = fem::Lagrange<typename C::Face>::values(Rule::points[q]);
      for (Eigen::Index f = 0; f < right.faces.cols(); ++f)
        for (int k = 0; k < C::Face::nodes; ++k)
          area[right.faces(k, f)] += face * Rule::weights[q] / reference * N[static_cast<std::size_t>(k)];
    }
    for (const Index k : mesh::patch_nodes(right)) wall.force(k, Vec3(0, traction * area[k], 0));
    SolidValue r = solved(wall);
    for (Index k = 0; k < mesh.node_count(); ++k)
      if ((mesh.nodes.col(k) - Vec3(48e-3, 60e-3, 0)).norm() < 1e-9)
        r.value = 1e3 * wall.displacement()(1, k);
    return r;
  }
};

}  // namespace tunica::bench
