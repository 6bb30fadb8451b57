// SPDX-License-Identifier: MIT
// A meshed hyperelastic body: its internal, inertial and pressure forces and their tangent.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/direct.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/solid/body_mass.hpp"
#include "tunica/solid/interior_of.hpp"
#include "tunica/solid/pressure_load.hpp"
#include "tunica/solid/robin.hpp"
#include "tunica/solid/tangent_matrix.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::solid {

/// A component of the displacement.
enum class Axis { x, y, z };

/// Unknown i of node a is number 3 a + i in every vector; vectors have unknowns() entries: 3 * nodes, and
/// with NodalPressure one more for each node at the end. `Given` is a material, or one with a formulation:
/// with<FBar>(law). All sums run in an order that the mesh alone fixes: the same bits on any number of
/// threads.
template <mesh::Cell C, class Given>
class Body {
  static_assert(
      requires { fem::Lagrange<C>::nodes; },
      "the shape functions of this cell stand in tunica/fem/shape_quadratic.hpp or shape_wedge.hpp");
  static_assert(C::dim == 3, "a solid body is made of cells in three dimensions");

 public:
  using Form = Formulation<std::remove_const_t<Given>, C>;
  using Law = typename Form::Law;
  static_assert(detail::law_is_complete<Law>);
  using Inside = typename detail::InteriorOf<C, Law, typename Form::Locking>::type;
  using Element = typename Inside::Single;
  using Laws = typename Inside::Laws;
  using Patch = mesh::Patch<typename C::Face>;
  using Nodal = Eigen::Matrix<double, 3, C::nodes>;
  static constexpr int per_node = Inside::per_node;
  /// Whether the tangent of the cells is; that of follower pressures is not.
  static constexpr bool symmetric = Inside::symmetric;

  /// Nodes in [m], density in [kg/m3]. MeshError names the first cell that is inverted as it is given.
  Body(const mesh::Mesh<C, 3>& mesh, const Given& material, double density, Mass mass)
      : mesh_(mesh),
        inside_(mesh_, Form::law(material)),
        tangent_(inside_.assembly().matrix()),
        mass_(mesh_, tangent_.blocks(), density, mass),
        fixed_(static_cast<std::size_t>(unknowns()), 0) {}

  [[nodiscard]] const mesh::Mesh<C, 3>& mesh() const { return mesh_; }
  [[nodiscard]] const Inside& inside() const { return inside_; }
  [[nodiscard]] Inside& inside() { return inside_; }
  /// The laws, what they read at the points of the cells, and a stored deformation.
  [[nodiscard]] const Laws& laws() const { return inside_.laws(); }
  [[nodiscard]] Laws& laws() { return inside_.laws(); }
  [[nodiscard]] const Law& material(Index cell) const { return laws().material(cell); }
  [[nodiscard]] auto data(Index cell) const { return laws().data(cell); }
  /// field(cell, x) at every point x of the quadrature [m], for laws that read data there (fibres).
  template <class Field>
  void point_field(const Field& field) {
    for (Index e = 0; e < mesh_.cell_count(); ++e)
      for (std::size_t q = 0; q < Element::points; ++q)
        laws().point_data(e, q, field(e, Element::position(reference(e), q)));
  }
  [[nodiscard]] Index unknowns() const { return per_node * mesh_.node_count(); }
  [[nodiscard]] la::SparseMatrix pattern() const { return tangent_.pattern(); }

  void fix(Index node, Axis axis) {
    fixed_[static_cast<std::size_t>(3 * known(node) + static_cast<int>(axis))] = 1;
  }
  /// Nodes of no cell stay where they are: nothing holds them, and nothing loads them.
  void fix_loose_nodes() {
    std::vector<char> loose(static_cast<std::size_t>(mesh_.node_count()), 1);
    for (const Index n : mesh_.cells.reshaped()) loose[static_cast<std::size_t>(n)] = 0;
    for (Index n = 0; n < mesh_.node_count(); ++n) {
      if (!loose[static_cast<std::size_t>(n)]) continue;
      for (const Axis axis : {Axis::x, Axis::y, Axis::z}) fix(n, axis);
      if constexpr (per_node == 4) fixed_[static_cast<std::size_t>(3 * mesh_.node_count() + n)] = 1;
    }
  }
  /// The node, which the mesh must have.
  [[nodiscard]] Index known(Index node) const {
    TUNICA_EXPECT(node >= 0 && node < mesh_.node_count(), "a node of the mesh");
    return node;
  }
  [[nodiscard]] bool fixed(Index unknown) const { return fixed_[static_cast<std::size_t>(unknown)] != 0; }
  /// v = 0 at the prescribed unknowns.
  void clear_fixed(Eigen::VectorXd& v) const {
    for (Index k = 0; k < unknowns(); ++k)
      if (fixed(k)) v[k] = 0;
  }

  /// Adds a patch under pressure; its number in the list of pressures below.
  std::size_t add_pressure(const Patch& patch) {
    pressures_.emplace_back(mesh_, patch);
    return pressures_.size() - 1;
  }

  /// Adds springs and dashpots on a patch: see Support.
  void add_support(const Patch& patch, const Support& support) {
    supports_.emplace_back(mesh_, patch, support);
  }
  [[nodiscard]] bool supported() const { return !supports_.empty(); }

  /// f = internal forces at displacement u [N]. False if a cell has J <= 0 or NaN: see inverted_cell().
  /// `step`: how far u is along the last direction(), or la::no_step; f_predicted is f with
  /// the pressures predicted along that step in place of U'(theta).
  [[nodiscard]] bool internal_forces(const Eigen::VectorXd& u, double step, Eigen::VectorXd& f,
                                     Eigen::VectorXd& f_predicted) {
    return inside_.forces(u, step, f, f_predicted);
  }
  /// Size of the part of the last internal forces that is rounding: no residual gets below it [N].
  [[nodiscard]] double rounding() const { return inside_.rounding(); }
  /// A step du leaves the u of the last internal_forces(): the pressures go from the ones predicted so
  /// far to U'(theta) + U'' dv.du/V.
  void direction(const Eigen::VectorXd& du) { inside_.direction(du); }
  /// The first cell with J <= 0 in the last internal_forces(), -1 if there was none.
  [[nodiscard]] Index inverted_cell() const { return inside_.inverted_cell(); }

  /// f += factor * M a [N].
  void add_inertia(const Eigen::VectorXd& a, double factor, Eigen::VectorXd& f) const {
    mass_.add_forces(tangent_.blocks(), a, factor, f);
  }

  /// f += the forces of the pressures p [Pa], one a patch, on the surface displaced by u.
  void add_pressure_forces(const Eigen::VectorXd& u, const Eigen::VectorXd& p, Eigen::VectorXd& f) const {
    for (std::size_t k = 0; k < pressures_.size(); ++k) {
      const double value = p[static_cast<Eigen::Index>(k)];
      if (value == 0) continue;
      for (Index face = 0; face < pressures_[k].face_count(); ++face) {
        const Index e = pressures_[k].cell(face);
        add_vector(e, value * pressures_[k].unit_force(face, reference(e) + gather(e, u)), f);
      }
    }
  }

  /// The cavity behind a patch of add_pressure: the cones from an apex to its faces. That is the volume
  /// enclosed if the patch is closed or its border lies in planes through the apex, else this volume and
  /// a constant where the border is held. slope: its derivative, 3 * nodes [m2].
  struct Cavity {
    double volume = 0;  // [m3]
    Eigen::VectorXd slope;
  };
  [[nodiscard]] Cavity cavity(std::size_t number, const Eigen::VectorXd& u, const Vec3& apex) const {
    Cavity cavity{.slope = Eigen::VectorXd::Zero(unknowns())};
    const auto& patch = pressures_[number];
    for (Index face = 0; face < patch.face_count(); ++face) {  // its normals point into the cavity
      const Index e = patch.cell(face);
      const auto cone = patch.cone(face, reference(e) + gather(e, u), apex);
      cavity.volume -= cone.volume;
      add_vector(e, -cone.slope, cavity.slope);
    }
    return cavity;
  }

  /// f += S(spring) u + S(dashpot) v, the forces of the supports on what holds them [N].
  void add_support_forces(const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& f) const {
    for (const auto& support : supports_) support.add_forces(u, v, f);
  }

  /// What a tangent is made of: A = stiffness (K(u) + S(spring) - dF_p/du) + damping S(dashpot)
  /// + mass M.
  struct TangentParts {
    double stiffness = 1;        // factor of the derivative of internal and pressure forces
    double mass = 0;             // factor of the mass matrix
    double damping = 0;          // factor of the dashpots
    bool symmetric_load = true;  // the load stiffness is replaced by its symmetric part
  };

  /// Fills A (from pattern()), with the pressures predicted in the last internal_forces(); prescribed
  /// unknowns get a positive diagonal and zeros elsewhere.
  void tangent(const Eigen::VectorXd& u, const Eigen::VectorXd& p, const TangentParts& parts,
               la::SparseMatrix& A) const {
    const bool alike = assemble(u, p, parts);
    tangent_.columns(alike, A);
  }
  /// The same in the blocks that it is assembled in, both triangles; they stay until the next tangent. With
  /// pressures at the nodes, which stand behind all displacements, it is what no solver reads.
  [[nodiscard]] const auto& tangent_blocks(const Eigen::VectorXd& u, const Eigen::VectorXd& p,
                                           const TangentParts& parts) const {
    assemble(u, p, parts);
    if constexpr (per_node == 3)
      return std::as_const(tangent_).blocks();
    else
      return tangent_;
  }

  /// Strain energy [J] at u, that of the springs, and kinetic energy at velocity v.
  [[nodiscard]] double strain_energy(const Eigen::VectorXd& u) const { return inside_.energy(u); }
  [[nodiscard]] double spring_energy(const Eigen::VectorXd& u) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(unknowns());
    add_support_forces(u, Eigen::VectorXd::Zero(unknowns()), f);
    return 0.5 * u.dot(f);
  }
  [[nodiscard]] double kinetic_energy(const Eigen::VectorXd& v) const {
    Eigen::VectorXd momentum = Eigen::VectorXd::Zero(unknowns());
    add_inertia(v, 1, momentum);
    return 0.5 * v.dot(momentum);
  }

  /// The displacements (or velocities) of a vector, 3 x nodes.
  [[nodiscard]] Points<3> at_nodes(const Eigen::VectorXd& u) const {
    return u.head(3 * mesh_.node_count()).reshaped(3, mesh_.node_count());
  }
  [[nodiscard]] Nodal reference(Index e) const {
    Nodal X;
    for (int a = 0; a < C::nodes; ++a) X.col(a) = mesh_.nodes.col(mesh_.cells(a, e));
    return X;
  }
  [[nodiscard]] Nodal gather(Index e, const Eigen::VectorXd& u) const {
    Nodal ue;
    for (int a = 0; a < C::nodes; ++a) ue.col(a) = u.segment<3>(3 * mesh_.cells(a, e));
    return ue;
  }

 private:
  using ElementMatrix = Eigen::Matrix<double, 3 * C::nodes, 3 * C::nodes>;

  /// The tangent in blocks; whether it is symmetric.
  bool assemble(const Eigen::VectorXd& u, const Eigen::VectorXd& p, const TangentParts& parts) const {
    la::BlockMatrix<per_node>& K = tangent_.blocks();
    K.set_zero();
    if (parts.stiffness != 0) inside_.add_tangent(u, parts.stiffness, K);
    if (parts.mass != 0) mass_.add_to(parts.mass, K);
    bool loaded = false;
    for (std::size_t k = 0; k < pressures_.size(); ++k) {
      const double value = p[static_cast<Eigen::Index>(k)];
      if (value == 0) continue;
      loaded = true;
      for (Index face = 0; face < pressures_[k].face_count(); ++face) {
        const Index e = pressures_[k].cell(face);
        auto unit = pressures_[k].unit_stiffness(face, reference(e) + gather(e, u));
        if (parts.symmetric_load) unit = (0.5 * (unit + unit.transpose())).eval();
        add_matrix(e, -value * parts.stiffness * unit, K);
      }
    }
    for (const auto& support : supports_)
      support.for_each_stiffness(parts.stiffness, parts.damping,
                                 [&](Index e, const ElementMatrix& S) { add_matrix(e, S, K); });
    if constexpr (per_node == 4)
      if (parts.stiffness == 0)  // the mass alone does not see pressures: it leaves them as they are
        for (Index n = 0; n < mesh_.node_count(); ++n) K.block(K.find(n, n))[per_node * per_node - 1] = 1;
    tangent_.constrain(fixed_);
    return symmetric && (!loaded || parts.symmetric_load);
  }

  template <class Vector>
  void add_vector(Index e, const Vector& fe, Eigen::VectorXd& f) const {
    const Eigen::Matrix<double, 3 * C::nodes, 1> values = fe;
    for (int a = 0; a < C::nodes; ++a)
      f.segment<3>(3 * mesh_.cells(a, e)) += values.template segment<3>(3 * a);
  }
  template <class Matrix>
  void add_matrix(Index e, const Matrix& Ke, la::BlockMatrix<per_node>& K) const {
    const ElementMatrix values = Ke;
    for (int a = 0; a < C::nodes; ++a)
      for (int b = 0; b < C::nodes; ++b) {
        double* const block = K.block(K.find(mesh_.cells(a, e), mesh_.cells(b, e)));
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) block[per_node * i + k] += values(3 * a + i, 3 * b + k);
      }
  }

  mesh::Mesh<C, 3> mesh_;
  Inside inside_;
  mutable TangentMatrix<per_node> tangent_;  // scratch of tangent()
  BodyMass<C, per_node> mass_;
  std::vector<char> fixed_;
  std::vector<PressureLoad<C>> pressures_;
  std::vector<RobinSupport<C>> supports_;
};

/// LDL^T where the tangent is symmetric.
template <mesh::Cell C, class Material>
using DefaultSolver = std::conditional_t<Body<C, Material>::symmetric, la::Ldlt, la::Lu>;

}  // namespace tunica::solid
