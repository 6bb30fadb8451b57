// SPDX-License-Identifier: MIT
// A pressure that follows the deformed surface, with its load stiffness   [BONET08, ch. 8.5 and 9.4].
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/load_faces.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace tunica::solid {

/// Faces with the cells behind them: the load stiffness is scattered through the cell's own block map.
template <mesh::Cell C>
class PressureLoad {
 public:
  using Face = typename C::Face;
  static constexpr int face_nodes = Face::nodes, size = 3 * C::nodes;
  using FacePoints = Eigen::Matrix<double, 3, face_nodes>;

  /// MeshError if a face of the patch belongs to no cell.
  PressureLoad(const mesh::Mesh<C, 3>& mesh, const mesh::Patch<Face>& patch)
      : faces_(load_faces(mesh, patch)) {}

  [[nodiscard]] Index face_count() const { return static_cast<Index>(faces_.size()); }
  [[nodiscard]] Index cell(Index face) const { return faces_[static_cast<std::size_t>(face)].cell; }

  /// Nodal forces of a pressure of 1 Pa on a face, x the current nodes of its cell: 3 nodes of the
  /// cell, f_a = - int N_a (x,1 x x,2), towards the body since faces are oriented outward [N/Pa].
  [[nodiscard]] Eigen::Matrix<double, size, 1> unit_force(Index face,
                                                          const Eigen::Matrix<double, 3, C::nodes>& x) const {
    const auto& local = faces_[static_cast<std::size_t>(face)].local;
    const FacePoints y = face_points<C>(faces_[static_cast<std::size_t>(face)], x);
    Eigen::Matrix<double, size, 1> f = Eigen::Matrix<double, size, 1>::Zero();
    for (std::size_t q = 0; q < Rule::size; ++q) {
      const auto [t1, t2] = tangents(y, q);
      const Vec3 n = t1.cross(t2) * Rule::weights[q];
      for (std::size_t a = 0; a < face_nodes; ++a)
        f.template segment<3>(3 * local[a]) -= Tables::values[q][a] * n;
    }
    return f;
  }

  /// d unit_force / du. Not symmetric face by face; the sum over a surface is, if its border is held
  /// or moves in a plane that the surface meets.
  [[nodiscard]] Eigen::Matrix<double, size, size> unit_stiffness(
      Index face, const Eigen::Matrix<double, 3, C::nodes>& x) const {
    const auto& local = faces_[static_cast<std::size_t>(face)].local;
    const FacePoints y = face_points<C>(faces_[static_cast<std::size_t>(face)], x);
    Eigen::Matrix<double, size, size> K = Eigen::Matrix<double, size, size>::Zero();
    for (std::size_t q = 0; q < Rule::size; ++q) {
      const auto [t1, t2] = tangents(y, q);
      for (std::size_t b = 0; b < face_nodes; ++b) {
        // d(x,1 x x,2) = Nb,1 du x x,2 - Nb,2 du x x,1 = du x c = -[c] du
        const Vec3 c = Tables::gradients[q][b][0] * t2 - Tables::gradients[q][b][1] * t1;
        Eigen::Matrix3d cross;
        cross << 0, -c[2], c[1], c[2], 0, -c[0], -c[1], c[0], 0;
        cross *= Rule::weights[q];
        for (std::size_t a = 0; a < face_nodes; ++a)
          K.template block<3, 3>(3 * local[a], 3 * local[b]) += Tables::values[q][a] * cross;
      }
    }
    return K;
  }

  /// The volume of the cone from an apex to a face, (1/3) int (x - apex) . (x,1 x x,2) [m3], and its
  /// derivative in the nodes of the cell [m2].
  struct Cone {
    double volume = 0;
    Eigen::Matrix<double, size, 1> slope = Eigen::Matrix<double, size, 1>::Zero();
  };
  [[nodiscard]] Cone cone(Index face, const Eigen::Matrix<double, 3, C::nodes>& x, const Vec3& apex) const {
    const auto& local = faces_[static_cast<std::size_t>(face)].local;
    const FacePoints y = face_points<C>(faces_[static_cast<std::size_t>(face)], x).colwise() - apex;
    Cone cone;
    for (std::size_t q = 0; q < VolumeRule::size; ++q) {
      using VolumeTables = fem::Tables<fem::Lagrange<Face>, VolumeRule>;
      Vec3 at = Vec3::Zero(), t1 = Vec3::Zero(), t2 = Vec3::Zero();
      for (std::size_t a = 0; a < face_nodes; ++a) {
        const auto column = y.col(static_cast<int>(a));
        at += VolumeTables::values[q][a] * column;
        t1 += VolumeTables::gradients[q][a][0] * column;
        t2 += VolumeTables::gradients[q][a][1] * column;
      }
      const double third = VolumeRule::weights[q] / 3;
      const Vec3 n = t1.cross(t2);
      cone.volume += third * at.dot(n);
      for (std::size_t a = 0; a < face_nodes; ++a) {
        const auto& g = VolumeTables::gradients[q][a];
        cone.slope.template segment<3>(3 * local[a]) +=
            third * (VolumeTables::values[q][a] * n + g[0] * t2.cross(at) + g[1] * at.cross(t1));
      }
    }
    return cone;
  }

 private:
  // The integrand of a cone is of degree 2 in each coordinate on Quad4, constant on Tri3.
  using VolumeRule = std::conditional_t<Face::nodes == 3, fem::Gauss<mesh::Tri3, 1>, FaceRule<Face>>;
  // Exact: the normal is constant on Tri3 and bilinear on Quad4.
  using Rule = std::conditional_t<Face::nodes == 3, fem::Gauss<mesh::Tri3, 1>, FaceRule<Face>>;
  using Tables = fem::Tables<fem::Lagrange<Face>, Rule>;
  struct Tangents {
    Vec3 t1, t2;
  };

  static Tangents tangents(const FacePoints& y, std::size_t q) {
    Tangents t{Vec3::Zero(), Vec3::Zero()};
    for (int a = 0; a < face_nodes; ++a) {
      const auto& g = Tables::gradients[q][static_cast<std::size_t>(a)];
      t.t1 += g[0] * y.col(a);
      t.t2 += g[1] * y.col(a);
    }
    return t;
  }

  std::vector<LoadFace<C>> faces_;
};

}  // namespace tunica::solid
