// SPDX-License-Identifier: MIT
// Flows and meshes that several tests of the fluid share, and their error norms.
#pragma once

#include "tunica/fem/p1_tets.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <vector>

namespace tunica::test {

/// Numbers in [-1, 1] that are the same everywhere.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(state_ >> 11) / 4503599627370496.0 - 1;
  }

 private:
  std::uint64_t state_;
};

/// Moves the nodes inside by up to `size` [m] along each axis.
inline void shake(mesh::TetMesh& mesh, double size, std::uint64_t seed = 1) {
  std::vector<char> boundary(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const auto& patch : mesh.patches)
    for (const Index n : mesh::patch_nodes(patch)) boundary[static_cast<std::size_t>(n)] = 1;
  Noise noise(seed);
  for (Index n = 0; n < mesh.node_count(); ++n)
    if (!boundary[static_cast<std::size_t>(n)])
      for (int c = 0; c < 3; ++c) mesh.nodes(c, n) += size * noise();
}

/// L2 norms over the mesh at nodes x of nodal fields minus exact ones, by a rule of degree 2; divided
/// by the norm of the exact field.
struct FlowError {
  double velocity = 0, pressure = 0;
};

/// u(x) -> Vec3, p(x) -> double. The pressure is compared up to a constant when `level` is set.
template <class U, class P>
[[nodiscard]] FlowError flow_error(const Points<3>& x, const Connectivity<4>& cells, const Points<3>& uh,
                                   const Eigen::VectorXd& ph, U&& u, P&& p, double level = 0) {
  constexpr double near = 0.58541019662496845, far = 0.13819660112501052;
  double eu = 0, nu = 0, ep = 0, np = 0, shift = 0, volume = 0;
  for (int round = 0; round < 2; ++round)
    for (Index e = 0; e < cells.cols(); ++e) {
      const double w = fem::p1_tet(x, cells, e).volume / 4;
      for (int q = 0; q < 4; ++q) {
        Vec3 at = Vec3::Zero(), value = Vec3::Zero();
        double pressure = 0;
        for (int a = 0; a < 4; ++a) {
          const double s = a == q ? near : far;
          at += s * x.col(cells(a, e)), value += s * uh.col(cells(a, e)), pressure += s * ph[cells(a, e)];
        }
        if (round == 0) {
          volume += w, shift += w * (pressure - p(at));
          continue;
        }
        eu += w * (value - u(at)).squaredNorm(), nu += w * u(at).squaredNorm();
        ep += w * std::pow(pressure - p(at) - level * shift / volume, 2), np += w * std::pow(p(at), 2);
      }
    }
  return {std::sqrt(eu / nu), std::sqrt(ep / np)};
}

/// Taylor-Green vortices in a slab, rho = 1: u = (sin x cos y, -cos x sin y, 0) exp(-2 nu t).
struct TaylorGreen {
  double nu;
  [[nodiscard]] Vec3 u(const Vec3& x, double t) const {
    const double s = std::exp(-2 * nu * t);
    return {s * std::sin(x[0]) * std::cos(x[1]), -s * std::cos(x[0]) * std::sin(x[1]), 0};
  }
  [[nodiscard]] double p(const Vec3& x, double t) const {
    return 0.25 * (std::cos(2 * x[0]) + std::cos(2 * x[1])) * std::exp(-4 * nu * t);
  }
};

/// The three-dimensional solution of Ethier and Steinman, rho = 1, a = pi/4, d = pi/2. [ETHIER94]
struct EthierSteinman {
  double nu;
  static constexpr double a = 0.78539816339744831, d = 1.5707963267948966;
  [[nodiscard]] Vec3 u(const Vec3& x, double t) const {
    const double s = -a * std::exp(-nu * d * d * t);
    const auto part = [&](double x1, double y, double z) {
      return std::exp(a * x1) * std::sin(a * y + d * z) + std::exp(a * z) * std::cos(a * x1 + d * y);
    };
    return {s * part(x[0], x[1], x[2]), s * part(x[1], x[2], x[0]), s * part(x[2], x[0], x[1])};
  }
  [[nodiscard]] double p(const Vec3& x, double t) const {
    const auto part = [&](double x1, double y, double z) {
      return std::exp(2 * a * x1) +
             2 * std::sin(a * x1 + d * y) * std::cos(a * z + d * x1) * std::exp(a * (y + z));
    };
    return -0.5 * a * a * std::exp(-2 * nu * d * d * t) *
           (part(x[0], x[1], x[2]) + part(x[1], x[2], x[0]) + part(x[2], x[0], x[1]));
  }
};

inline constexpr const char* box_sides[] = {"x0", "x1", "y0", "y1", "z0", "z1"};

template <class Field>
[[nodiscard]] auto nodal_values(const Points<3>& x, Field&& f) {
  Points<3> values(3, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) values.col(i) = f(Vec3(x.col(i)));
  return values;
}
template <class Field>
[[nodiscard]] Eigen::VectorXd nodal_scalars(const Points<3>& x, Field&& f) {
  Eigen::VectorXd values(x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) values[i] = f(Vec3(x.col(i)));
  return values;
}

}  // namespace tunica::test
