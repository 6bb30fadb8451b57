// SPDX-License-Identifier: MIT
// A meshed hyperelastic body: its internal, inertial and pressure forces and their tangent.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/fem/assembly.hpp"
#include "tunica/la/linear_solver.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/solid/cell_laws.hpp"
#include "tunica/solid/cell_mass.hpp"
#include "tunica/solid/mean_dilatation.hpp"
#include "tunica/solid/pressure_load.hpp"
#include "tunica/solid/robin.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::solid {

/// A component of the displacement.
enum class Axis { x, y, z };

/// Unknown i of node a is number 3 a + i in every vector; vectors have 3 * nodes entries.
/// All sums run in an order that the mesh alone fixes: the same bits on any number of threads.
template <mesh::Cell C, class Material>
class Body {
  static_assert(C::dim == 3, "a solid body is made of cells in three dimensions");
  static_assert(IsochoricEnergy<decltype(Material::isochoric)>,
                "the isochoric law needs `reads` and energy(invariants)");
  static_assert(VolumetricEnergy<decltype(Material::volumetric)>,
                "the volumetric law needs energy(J), slope(J) and curvature(J)");

 public:
  using Element = MeanDilatation<C, DefaultRule<C>>;
  using Patch = mesh::Patch<typename C::Face>;
  using Nodal = typename Element::template Nodal<double>;

  /// Nodes in [m], density in [kg/m3]. MeshError names the first cell that is inverted as it is given.
  Body(const mesh::Mesh<C, 3>& mesh, const Material& material, double density, Mass mass)
      : mesh_(mesh),
        laws_(material, mesh_.region, mesh_.cell_count()),
        assembly_(mesh_),
        fixed_(static_cast<std::size_t>(3 * mesh_.node_count()), 0),
        cells_(static_cast<std::size_t>(mesh_.cell_count())) {
    element_mass_.reserve(static_cast<std::size_t>(mesh_.cell_count()));
    for (Index e = 0; e < mesh_.cell_count(); ++e)
      element_mass_.push_back(cell_mass<C>(e, reference(e), density, mass));
  }

  [[nodiscard]] const mesh::Mesh<C, 3>& mesh() const { return mesh_; }
  /// The laws, what they read at the points of the cells, and a stored deformation.
  using Laws = CellLaws<std::remove_const_t<Material>, Element::points>;
  [[nodiscard]] const Laws& laws() const { return laws_; }
  [[nodiscard]] Laws& laws() { return laws_; }
  [[nodiscard]] const Material& material(Index cell) const { return laws_.material(cell); }
  [[nodiscard]] auto data(Index cell) const { return laws_.data(cell); }
  /// field(cell, x) at every point x of the quadrature [m], for laws that read data there (fibres).
  template <class Field>
  void point_field(const Field& field) {
    for (Index e = 0; e < mesh_.cell_count(); ++e)
      for (std::size_t q = 0; q < Element::points; ++q)
        laws_.point_data(e, q, field(e, Element::position(reference(e), q)));
  }
  [[nodiscard]] Index unknowns() const { return 3 * mesh_.node_count(); }
  [[nodiscard]] la::SparseMatrix pattern() const { return assembly_.matrix(); }

  void fix(Index node, Axis axis) {
    TUNICA_EXPECT(node >= 0 && node < mesh_.node_count(), "a node of the mesh");
    fixed_[static_cast<std::size_t>(3 * node + static_cast<int>(axis))] = 1;
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
    f.setZero(unknowns());
    f_predicted.setZero(unknowns());
    assembly_.for_each_cell([&](Index e) {
      const auto element = Element::forces(material(e), reference(e), gather(e, u), data(e));
      CellState& cell = cells_[static_cast<std::size_t>(e)];
      cell.smallest_J = element.smallest_J;
      cell.volume_slope = element.volume_slope;
      cell.bulk_per_volume = element.bulk / element.volume;
      cell.p = element.p;
      // theta is known to a few roundings only, and the pressure to kappa times as much.
      cell.rounding =
          roundings * std::numeric_limits<double>::epsilon() * element.bulk * element.volume_slope.norm();
      cell.predicted = step < 0 ? element.p : cell.start + step * (cell.target - cell.start);
      assembly_.add(e, element.force, f);
      assembly_.add(e, (element.force + (cell.predicted - element.p) * element.volume_slope).eval(),
                    f_predicted);
    });
    inverted_cell_ = -1;
    rounding_ = 0;
    for (const CellState& cell : cells_) rounding_ += cell.rounding * cell.rounding;
    rounding_ = std::sqrt(rounding_);
    for (Index e = mesh_.cell_count() - 1; e >= 0; --e)
      if (!(cells_[static_cast<std::size_t>(e)].smallest_J > 0)) inverted_cell_ = e;
    return inverted_cell_ < 0;
  }
  /// Size of the part of the last internal forces that is rounding: no residual gets below it [N].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// A step du leaves the u of the last internal_forces(): the pressures go from the ones predicted so
  /// far to U'(theta) + U'' dv.du/V.
  void direction(const Eigen::VectorXd& du) {
    assembly_.for_each_cell([&](Index e) {
      CellState& cell = cells_[static_cast<std::size_t>(e)];
      cell.start = cell.predicted;
      cell.target = cell.p + cell.bulk_per_volume * cell.volume_slope.dot(gather(e, du).reshaped());
    });
  }
  /// The first cell with J <= 0 in the last internal_forces(), -1 if there was none.
  [[nodiscard]] Index inverted_cell() const { return inverted_cell_; }

  /// f += factor * M a [N].
  void add_inertia(const Eigen::VectorXd& a, double factor, Eigen::VectorXd& f) const {
    assembly_.for_each_cell([&](Index e) {
      const Nodal ma = factor * gather(e, a) * element_mass_[static_cast<std::size_t>(e)];
      assembly_.add(e, ma.reshaped(), f);
    });
  }

  /// f += the forces of the pressures p [Pa], one a patch, on the surface displaced by u.
  void add_pressure_forces(const Eigen::VectorXd& u, const Eigen::VectorXd& p, Eigen::VectorXd& f) const {
    for (std::size_t k = 0; k < pressures_.size(); ++k) {
      const double value = p[static_cast<Eigen::Index>(k)];
      if (value == 0) continue;
      for (Index face = 0; face < pressures_[k].face_count(); ++face) {
        const Index e = pressures_[k].cell(face);
        assembly_.add(e, (value * pressures_[k].unit_force(face, reference(e) + gather(e, u))).eval(), f);
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
      assembly_.add(e, (-cone.slope).eval(), cavity.slope);
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
    assembly_.clear(A);
    assembly_.for_each_cell([&](Index e) {
      auto K = Element::tangent(material(e), reference(e), gather(e, u),
                                cells_[static_cast<std::size_t>(e)].predicted, data(e))
                   .stiffness;
      K *= parts.stiffness;
      if (parts.mass != 0) {
        const auto& m = element_mass_[static_cast<std::size_t>(e)];
        for (int b = 0; b < C::nodes; ++b)
          for (int a = 0; a < C::nodes; ++a)
            for (int i = 0; i < 3; ++i) K(3 * a + i, 3 * b + i) += parts.mass * m(a, b);
      }
      const double diagonal = K.diagonal().cwiseAbs().maxCoeff();
      scatter(e, K, diagonal, A);
    });
    for (std::size_t k = 0; k < pressures_.size(); ++k) {
      const double value = p[static_cast<Eigen::Index>(k)];
      if (value == 0) continue;
      for (Index face = 0; face < pressures_[k].face_count(); ++face) {
        const Index e = pressures_[k].cell(face);
        auto K = pressures_[k].unit_stiffness(face, reference(e) + gather(e, u));
        if (parts.symmetric_load) K = (0.5 * (K + K.transpose())).eval();
        K *= -value * parts.stiffness;
        scatter(e, K, 0, A);
      }
    }
    for (const auto& support : supports_)
      support.for_each_stiffness(parts.stiffness, parts.damping,
                                 [&](Index e, ElementMatrix& K) { scatter(e, K, 0, A); });
  }

  /// Strain energy [J] at u, that of the springs, and kinetic energy at velocity v.
  [[nodiscard]] double strain_energy(const Eigen::VectorXd& u) const {
    double sum = 0;
    for (Index e = 0; e < mesh_.cell_count(); ++e)
      sum += Element::energy(material(e), reference(e), gather(e, u), data(e));
    return sum;
  }
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
  static constexpr double roundings = 2;  // measured: residuals stall at 0.2 to 0.6 of this bound
  struct CellState {
    double smallest_J = 1, rounding = 0;
    double p = 0, bulk_per_volume = 0;  // U'(theta) and U''/V at the last forces
    Eigen::Matrix<double, 3 * C::nodes, 1> volume_slope = Eigen::Matrix<double, 3 * C::nodes, 1>::Zero();
    double start = 0, target = 0, predicted = 0;  // pressures along a step of Newton [Pa]
  };
  using NodePairs = Eigen::Matrix<double, C::nodes, C::nodes>;
  using ElementMatrix = Eigen::Matrix<double, 3 * C::nodes, 3 * C::nodes>;

  void scatter(Index e, ElementMatrix& K, double diagonal, la::SparseMatrix& A) const {
    for (int a = 0; a < C::nodes; ++a)
      for (int i = 0; i < 3; ++i)
        if (fixed(3 * mesh_.cells(a, e) + i)) {
          K.row(3 * a + i).setZero();
          K.col(3 * a + i).setZero();
          K(3 * a + i, 3 * a + i) = diagonal;
        }
    assembly_.add(e, K, A);
  }

  mesh::Mesh<C, 3> mesh_;
  Laws laws_;
  fem::Assembly<C, 3> assembly_;
  std::vector<char> fixed_;
  std::vector<PressureLoad<C>> pressures_;
  std::vector<RobinSupport<C>> supports_;
  std::vector<NodePairs> element_mass_;  // of one component [kg]
  std::vector<CellState> cells_;
  Index inverted_cell_ = -1;
  double rounding_ = 0;
};

}  // namespace tunica::solid
