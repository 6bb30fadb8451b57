// SPDX-License-Identifier: MIT
// Springs and dashpots per area on a patch: the tissue round a vessel   [MOIREAU12].
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/solid/load_faces.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <vector>

namespace tunica::solid {

/// What a support works against: any motion, or that along the normal of the reference surface.
enum class Motion { any, normal };

/// The traction -(spring u + dashpot v) on the reference area.
struct Support {
  double spring = 0;   // [N/m3]
  double dashpot = 0;  // [N s/m3]
  Motion against = Motion::any;
};

/// The unit matrix of each face of a patch, S = int N_a N_b D dA over the reference area with D = 1 or
/// n n^T: the forces are -(spring S u + dashpot S v), linear, so the tangent is exact and symmetric.
template <mesh::Cell C>
class RobinSupport {
 public:
  using Face = typename C::Face;
  static constexpr int size = 3 * Face::nodes;

  /// MeshError if a face of the patch belongs to no cell.
  RobinSupport(const mesh::Mesh<C, 3>& mesh, const mesh::Patch<Face>& patch, const Support& support)
      : support_(support), faces_(load_faces(mesh, patch)) {
    TUNICA_EXPECT(support.spring >= 0 && support.dashpot >= 0, "supports neither push nor drive");
    unit_.reserve(faces_.size());
    for (const auto& face : faces_) {
      Eigen::Matrix<double, 3, Face::nodes> X;
      FaceNodes nodes;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        nodes[k] = mesh.cells(face.local[k], face.cell);
        X.col(static_cast<int>(k)) = mesh.nodes.col(nodes[k]);
      }
      nodes_.push_back(nodes);
      unit_.push_back(unit_of(X));
    }
  }

  /// f += S (spring u + dashpot v): the forces on what holds the body [N].
  void add_forces(const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& f) const {
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      Eigen::Matrix<double, size, 1> w;
      for (std::size_t k = 0; k < face_nodes; ++k)
        w.template segment<3>(3 * static_cast<int>(k)) = support_.spring * u.segment<3>(3 * nodes_[face][k]) +
                                                         support_.dashpot * v.segment<3>(3 * nodes_[face][k]);
      const Eigen::Matrix<double, size, 1> force = unit_[face] * w;
      for (std::size_t k = 0; k < face_nodes; ++k)
        f.segment<3>(3 * nodes_[face][k]) += force.template segment<3>(3 * static_cast<int>(k));
    }
  }

  /// scatter(cell, K) for each face, K = (stiffness spring + damping dashpot) S in the unknowns of its cell.
  template <class Scatter>
  void for_each_stiffness(double stiffness, double damping, const Scatter& scatter) const {
    const double factor = stiffness * support_.spring + damping * support_.dashpot;
    for (std::size_t face = 0; factor != 0 && face < faces_.size(); ++face) {
      const auto& local = faces_[face].local;
      Eigen::Matrix<double, 3 * C::nodes, 3 * C::nodes> K;
      K.setZero();
      for (std::size_t b = 0; b < face_nodes; ++b)
        for (std::size_t a = 0; a < face_nodes; ++a)
          K.template block<3, 3>(3 * local[a], 3 * local[b]) =
              factor * unit_[face].template block<3, 3>(3 * static_cast<int>(a), 3 * static_cast<int>(b));
      scatter(faces_[face].cell, K);
    }
  }

 private:
  static constexpr std::size_t face_nodes = static_cast<std::size_t>(Face::nodes);
  using FaceNodes = std::array<Index, face_nodes>;
  using FaceMatrix = Eigen::Matrix<double, size, size>;  // 3 k + i for component i of node k
  using Rule = FaceRule<Face>;
  using Tables = fem::Tables<fem::Lagrange<Face>, Rule>;

  [[nodiscard]] FaceMatrix unit_of(const Eigen::Matrix<double, 3, Face::nodes>& X) const {
    FaceMatrix S = FaceMatrix::Zero();
    for (std::size_t q = 0; q < Rule::size; ++q) {
      Vec3 t1 = Vec3::Zero(), t2 = Vec3::Zero();
      for (int a = 0; a < Face::nodes; ++a) {
        t1 += Tables::gradients[q][static_cast<std::size_t>(a)][0] * X.col(a);
        t2 += Tables::gradients[q][static_cast<std::size_t>(a)][1] * X.col(a);
      }
      const Vec3 n = t1.cross(t2);
      const double area = n.norm();
      Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
      if (support_.against == Motion::normal) D = n * n.transpose() / (area * area);
      D *= area * Rule::weights[q];
      for (std::size_t a = 0; a < Face::nodes; ++a)
        for (std::size_t b = 0; b < Face::nodes; ++b)
          S.template block<3, 3>(3 * static_cast<int>(a), 3 * static_cast<int>(b)) +=
              Tables::values[q][a] * Tables::values[q][b] * D;
    }
    return S;
  }

  Support support_;
  std::vector<LoadFace<C>> faces_;
  std::vector<FaceNodes> nodes_;
  std::vector<FaceMatrix> unit_;  // S [m2]
};

}  // namespace tunica::solid
