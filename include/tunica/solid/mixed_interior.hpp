// SPDX-License-Identifier: MIT
// The inside of a body of linear tetrahedra with pressures at their nodes: see MixedTet.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/fem/block_assembly.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/cell_laws.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/mixed_tet.hpp"
#include "tunica/solid/single_element.hpp"
#include "tunica/solid/volumetric.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace tunica::solid {

/// Vectors hold 3 displacements a node [m] and then the scaled pressures of the nodes [m].
template <class Material>
class MixedInterior {
  static_assert(std::is_same_v<decltype(Material::volumetric), Quadratic>,
                "nodal pressures are those of U = kappa/2 (J - 1)^2");

 public:
  using Single =
      SingleElement<mesh::Tet4, MeanVolume>;  // for stresses, which are those at the cell's own volume
  static constexpr int per_node = 4;
  using Laws = CellLaws<Material, 1>;
  using Assembly = fem::BlockAssembly<mesh::Tet4, 4>;
  static constexpr bool symmetric = true;

  MixedInterior(const mesh::TetMesh& mesh, const Material& material)
      : assembly_(mesh), laws_(material, mesh.region, mesh.cell_count()), J_(cells(mesh), 1) {
    cells_.reserve(J_.size());
    double volume = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      MixedTet::Nodes X;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t i = 0; i < 3; ++i)
          X[a][i] = mesh.nodes(static_cast<int>(i), mesh.cells(static_cast<int>(a), e));
      volume += cells_.emplace_back(X).volume;
    }
    const double edge = std::cbrt(volume / static_cast<double>(J_.size()));
    pressure_scale_ = shear_modulus(material) / edge;
  }

  [[nodiscard]] const Laws& laws() const { return laws_; }
  [[nodiscard]] Laws& laws() { return laws_; }
  [[nodiscard]] const Assembly& assembly() const { return assembly_; }

  /// f = dPi/d(u, q) [N]; the pressures are unknowns, so none is predicted: f_predicted = f. False if a cell
  /// has J <= 0 or NaN.
  [[nodiscard]] bool forces(const Eigen::VectorXd& x, double, Eigen::VectorXd& f,
                            Eigen::VectorXd& f_predicted) {
    TUNICA_EXPECT(laws_.prestress().empty(), "nodal pressures take no prestress");
    f.setZero(x.size());
    assembly_.template for_each_pack<1>([&](const fem::CellPack<1>& pack) {
      const Index e = pack.cell[0];
      const Material& law = laws_.material(e);
      const auto out = cells_[at(e)].forces(law.isochoric, laws_.data(e).template point<double>(0),
                                            moduli(law), gather(e, x));
      J_[at(e)] = out.J;
      for (int a = 0; a < 4; ++a) {
        const Index n = assembly_.cells()(a, e);
        for (int i = 0; i < 3; ++i) f[3 * n + i] += out.r[at(3 * a + i)];
        f[3 * nodes() + n] += out.r[at(12 + a)];
      }
    });
    f_predicted = f;
    inverted_cell_ = -1;
    for (std::size_t e = 0; e < J_.size() && inverted_cell_ < 0; ++e)
      if (!(J_[e] > 0)) inverted_cell_ = static_cast<Index>(e);
    return inverted_cell_ < 0;
  }
  [[nodiscard]] double rounding() const { return 0; }
  [[nodiscard]] Index inverted_cell() const { return inverted_cell_; }
  void direction(const Eigen::VectorXd&) {}
  [[nodiscard]] double multiplier(Index) const { return 0; }

  /// A += scale d2Pi.
  void add_tangent(const Eigen::VectorXd& x, double scale, la::BlockMatrix<4>& A) const {
    assembly_.template for_each_pack<1>(A, [&](const fem::CellPack<1>& pack) {
      const Index e = pack.cell[0];
      const Material& law = laws_.material(e);
      const auto out = cells_[at(e)].tangent(law.isochoric, laws_.data(e).template point<double>(0),
                                             moduli(law), gather(e, x));
      double K[Assembly::pairs][16];
      const auto place = [](int node, int c) { return at(c < 3 ? 3 * node + c : 12 + node); };
      for (int a = 0; a < 4; ++a)
        for (int b = a; b < 4; ++b)
          for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
              K[Assembly::pair(a, b)][4 * r + c] = scale * out.K[MixedTet::size * place(a, r) + place(b, c)];
      assembly_.add_symmetric(pack, K, A);
    });
  }

  /// Pi [J] of MixedTet: where the pressures belong to u it is the strain energy, and no cell pays
  /// kappa (J - 1)^2/2 for a volume that only the pressures around it are to hold.
  [[nodiscard]] double energy(const Eigen::VectorXd& x) const {
    double sum = 0;
    for (Index e = 0; e < static_cast<Index>(cells_.size()); ++e) {
      const Material& law = laws_.material(e);
      sum += cells_[at(e)].energy(law.isochoric, laws_.data(e).template point<double>(0), moduli(law),
                                  gather(e, x));
    }
    return sum;
  }

  /// The pressures of the nodes [Pa]: positive in tension, as sigma = p 1 + ...
  [[nodiscard]] Eigen::VectorXd pressures(const Eigen::VectorXd& x) const {
    return pressure_scale_ * x.tail(nodes());
  }
  /// Initial shear modulus of a law: dP_xy/dF_xy at F = 1 [Pa].
  [[nodiscard]] static double shear_modulus(const Material& law) {
    return solid::response(law.isochoric, identity<double>(), {}).A[9 + 1];
  }

 private:
  template <class I>
  static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }
  static std::size_t cells(const mesh::TetMesh& mesh) { return static_cast<std::size_t>(mesh.cell_count()); }
  [[nodiscard]] Index nodes() const { return assembly_.node_count(); }

  [[nodiscard]] MixedTet::Moduli moduli(const Material& law) const {
    return {.mu = shear_modulus(law),
            .inverse_kappa = 1 / law.volumetric.kappa,
            .pressure_scale = pressure_scale_};
  }
  [[nodiscard]] MixedTet::Unknowns<double> gather(Index e, const Eigen::VectorXd& x) const {
    MixedTet::Unknowns<double> xe;
    for (int a = 0; a < 4; ++a) {
      const Index n = assembly_.cells()(a, e);
      for (int i = 0; i < 3; ++i) xe[at(3 * a + i)] = x[3 * n + i];
      xe[at(12 + a)] = x[3 * nodes() + n];
    }
    return xe;
  }

  Assembly assembly_;
  Laws laws_;
  std::vector<MixedTet> cells_;
  std::vector<double> J_;
  double pressure_scale_ = 1;  // [Pa/m]
  Index inverted_cell_ = -1;
};

}  // namespace tunica::solid
