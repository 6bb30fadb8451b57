// SPDX-License-Identifier: MIT
// A pressure that follows the deformed surface, with its load stiffness   [BONET08, ch. 8.5 and 9.4].
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/types.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/cells_behind.hpp"
#include "tunica/mesh/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
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
  PressureLoad(const mesh::Mesh<C, 3>& mesh, const mesh::Patch<Face>& patch) {
    const mesh::Rows around = mesh::cells_of_nodes(mesh.cells, mesh.node_count());
    const auto behind = mesh::cells_behind(mesh.cells, around, patch.faces);
    for (std::size_t f = 0; f < behind.size(); ++f) {
      if (behind[f] < 0)
        throw MeshError("patch \"" + patch.name + "\": face " + std::to_string(f) + " belongs to no cell");
      Loaded face{.cell = behind[f], .local = {}};
      const auto cell = mesh.cells.col(behind[f]);
      for (int k = 0; k < face_nodes; ++k)
        face.local[static_cast<std::size_t>(k)] = static_cast<int>(
            std::find(cell.data(), cell.data() + C::nodes, patch.faces(k, static_cast<Eigen::Index>(f))) -
            cell.data());
      faces_.push_back(face);
    }
  }

  [[nodiscard]] Index face_count() const { return static_cast<Index>(faces_.size()); }
  [[nodiscard]] Index cell(Index face) const { return faces_[static_cast<std::size_t>(face)].cell; }

  /// Nodal forces of a pressure of 1 Pa on a face, x the current nodes of its cell: 3 nodes of the
  /// cell, f_a = - int N_a (x,1 x x,2), towards the body since faces are oriented outward [N/Pa].
  [[nodiscard]] Eigen::Matrix<double, size, 1> unit_force(Index face,
                                                          const Eigen::Matrix<double, 3, C::nodes>& x) const {
    const auto& local = faces_[static_cast<std::size_t>(face)].local;
    const FacePoints y = of_face(local, x);
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
    const FacePoints y = of_face(local, x);
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

 private:
  using Rule = fem::Gauss<Face, std::is_same_v<Face, mesh::Quad4> ? 3 : 1>;  // exact: bilinear normals
  using Tables = fem::Tables<fem::Lagrange<Face>, Rule>;
  struct Loaded {
    Index cell;
    std::array<int, static_cast<std::size_t>(face_nodes)> local;  // its nodes in the cell's numbering
  };
  struct Tangents {
    Vec3 t1, t2;
  };

  static FacePoints of_face(const std::array<int, static_cast<std::size_t>(face_nodes)>& local,
                            const Eigen::Matrix<double, 3, C::nodes>& x) {
    FacePoints y;
    for (int k = 0; k < face_nodes; ++k) y.col(k) = x.col(local[static_cast<std::size_t>(k)]);
    return y;
  }
  static Tangents tangents(const FacePoints& y, std::size_t q) {
    Tangents t{Vec3::Zero(), Vec3::Zero()};
    for (int a = 0; a < face_nodes; ++a) {
      const auto& g = Tables::gradients[q][static_cast<std::size_t>(a)];
      t.t1 += g[0] * y.col(a);
      t.t2 += g[1] * y.col(a);
    }
    return t;
  }

  std::vector<Loaded> faces_;
};

}  // namespace tunica::solid
