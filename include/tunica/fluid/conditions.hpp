// SPDX-License-Identifier: MIT
// What holds on each patch of the flow: a wall, a prescribed velocity, or a prescribed pressure.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/fluid/boundary_function.hpp"
#include "tunica/fluid/field.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/cells_behind.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunica::fluid {

/// A velocity of fixed shape times a waveform: column k belongs to node nodes[k].
struct Profile {
  std::vector<Index> nodes;
  Points<3> velocity;  // of unit mean: 3 x nodes
};

struct Outlet {
  /// beta of the stress -beta rho (a.n)_- u against inflow through the patch; the energy is bounded
  /// from 0.5 on, 0 leaves the pressure alone (inlets driven by pressure). [MOGHADAM11]
  double backflow = 0;
};

enum class Kind { wall, velocity, pressure };

struct Condition {
  std::string name;
  Connectivity<3> faces;
  std::vector<Index> nodes;   // ascending
  std::vector<Index> cells;   // the tetrahedron behind each face
  std::vector<int> loaded{};  // of a pressure: how many faces of that tetrahedron have one
  Kind kind = Kind::wall;
  BoundaryFunction<Vec3> velocity{};  // [m/s]
  BoundaryFunction<double> scalar{};  // a pressure [Pa], or the waveform of a profile
  Points<3> profile{};                // 3 x nodes; no columns: `velocity` counts
  double backflow = 0;
};

/// A patch without a condition is a wall: no slip at the velocity of the grid. On an edge between
/// patches a wall goes before a velocity, a velocity before a pressure, which loads its whole patch all the
/// same.
class Conditions {
 public:
  explicit Conditions(const mesh::TetMesh& mesh) : node_count_(static_cast<std::size_t>(mesh.node_count())) {
    Vec3 sum = Vec3(0, 0, 0);
    double area = 0;
    const mesh::Rows around = mesh::cells_of_nodes(mesh.cells, mesh.node_count());
    for (const auto& patch : mesh.patches) {
      list_.push_back({.name = patch.name,
                       .faces = patch.faces,
                       .nodes = mesh::patch_nodes(patch),
                       .cells = mesh::cells_behind(mesh.cells, around, patch.faces)});
      const auto& behind = list_.back().cells;
      if (std::find(behind.begin(), behind.end(), -1) != behind.end())
        throw MeshError("a face of the fluid's boundary belongs to no tetrahedron");
      for (Eigen::Index f = 0; f < patch.faces.cols(); ++f) {
        const Vec3 n = area_vector(mesh.nodes, patch.faces, f);
        for (int c = 0; c < 3; ++c) sum[c] += n[c];
        area += length(n);
      }
    }
    if (!(area > 0) || !(length(sum) < 1e-8 * area))
      throw MeshError("the patches of the fluid do not close its boundary: their area vectors add up to " +
                      seven_digits(area > 0 ? length(sum) / area : 1.0) + " of its area");
    flag();
  }

  [[nodiscard]] Condition& operator[](std::string_view name) {
    std::string known;
    for (auto& c : list_) {
      if (c.name == name) return c;
      known += (known.empty() ? "" : ", ") + c.name;
    }
    throw MeshError("no patch named \"" + std::string(name) + "\"; there are: " + known);
  }
  [[nodiscard]] const Condition& operator[](std::string_view name) const {
    return const_cast<Conditions&>(*this)[name];
  }
  [[nodiscard]] const std::vector<Condition>& list() const { return list_; }

  /// Marks nodes and cells again after a condition was changed.
  void flag() {
    ++revision_;
    velocity_.assign(node_count_, 0);
    std::vector<Index> behind;
    for (const auto& c : list_) {
      if (c.kind == Kind::pressure)
        behind.insert(behind.end(), c.cells.begin(), c.cells.end());
      else
        for (const Index n : c.nodes) velocity_[static_cast<std::size_t>(n)] = 1;
    }
    any_pressure_ = !behind.empty();
    std::sort(behind.begin(), behind.end());
    for (auto& c : list_) {
      c.loaded.clear();
      if (c.kind != Kind::pressure) continue;
      for (const Index e : c.cells) {
        const auto [first, last] = std::equal_range(behind.begin(), behind.end(), e);
        c.loaded.push_back(static_cast<int>(last - first));
      }
    }
  }

  /// One flag a node: its velocity is prescribed.
  [[nodiscard]] const std::vector<char>& velocity_flags() const { return velocity_; }
  /// Another number after every change of a condition.
  [[nodiscard]] int revision() const { return revision_; }
  /// Else the pressure is known up to a constant.
  [[nodiscard]] bool any_pressure() const { return any_pressure_; }

  /// Writes the prescribed velocities at time t into u (3 x nodes); w: velocity of the grid.
  void impose_velocity(const Points<3>& x, const Points<3>& w, double t, Points<3>& u) const {
    for (const auto& c : list_) {
      if (c.kind != Kind::velocity) continue;
      const double waveform = c.profile.cols() > 0 ? c.scalar(Vec3(0, 0, 0), t) : 0;
      for (std::size_t k = 0; k < c.nodes.size(); ++k) {
        const Index n = c.nodes[k];
        if (c.profile.cols() > 0)
          for (int d = 0; d < 3; ++d) u(d, n) = waveform * c.profile(d, static_cast<Index>(k));
        else
          set_column(u, n, c.velocity(column(x, n), t));
      }
    }
    for (const auto& c : list_)
      if (c.kind == Kind::wall)
        for (const Index n : c.nodes) set_column(u, n, column(w, n));
  }

  /// Writes the pressures at time t on the pressure patches into p (nodes), 0 elsewhere.
  void impose_pressure(const Points<3>& x, double t, Eigen::VectorXd& p) const {
    p.setZero(static_cast<Eigen::Index>(node_count_));
    for (const auto& c : list_)
      if (c.kind == Kind::pressure)
        for (const Index n : c.nodes) p[n] = c.scalar(column(x, n), t);
  }

  /// Normal times area of a face, outward [m2].
  [[nodiscard]] static Vec3 area_vector(const Points<3>& x, const Connectivity<3>& faces, Eigen::Index f) {
    const Vec3 a = column(x, faces(0, f)), b = column(x, faces(1, f)), c = column(x, faces(2, f));
    const double p[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double q[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return {0.5 * (p[1] * q[2] - p[2] * q[1]), 0.5 * (p[2] * q[0] - p[0] * q[2]),
            0.5 * (p[0] * q[1] - p[1] * q[0])};
  }

  /// int v . n over a face, or over all of them, for a nodal field v (3 x nodes).
  [[nodiscard]] static double flux(const Points<3>& x, const Connectivity<3>& faces, const Points<3>& v,
                                   Eigen::Index f) {
    const Vec3 n = area_vector(x, faces, f);
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += n[c] * (v(c, faces(0, f)) + v(c, faces(1, f)) + v(c, faces(2, f)));
    return sum / 3;
  }
  [[nodiscard]] static double flux(const Points<3>& x, const Connectivity<3>& faces, const Points<3>& v) {
    double sum = 0;
    for (Eigen::Index f = 0; f < faces.cols(); ++f) sum += flux(x, faces, v, f);
    return sum;
  }

 private:
  std::size_t node_count_;
  std::vector<Condition> list_;
  std::vector<char> velocity_;
  bool any_pressure_ = false;
  int revision_ = 0;
};

}  // namespace tunica::fluid
