// SPDX-License-Identifier: MIT
// The inside of a body of linear tetrahedra with pressures at their nodes, by packs of cells: see MixedTet.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/fem/block_assembly.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/cell_laws.hpp"
#include "tunica/solid/law_packs.hpp"
#include "tunica/solid/mixed_tet.hpp"
#include "tunica/solid/single_element.hpp"
#include "tunica/solid/volumetric.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::solid {

/// Vectors hold 3 displacements a node [m] and then the scaled pressures of the nodes [m].
template <class Material>
class MixedInterior {
  static_assert(Pair<Material>, "nodal pressures want a law in two parts, as Hyperelastic");
  static_assert(
      requires(const Material& law) { law.volumetric.complement(1.0); },
      "nodal pressures want complement(p) of the volumetric law, the inverse of p = U'(J)");

 public:
  /// For positions and deformations; stresses are those of stress().
  using Single = SingleElement<mesh::Tet4, MeanVolume>;
  static constexpr int per_node = MixedTet::size;
  using Laws = CellLaws<Material, MixedTet::points>;
  using Assembly = fem::BlockAssembly<mesh::Tet4, per_node>;
  static constexpr bool symmetric = true;

  MixedInterior(const mesh::TetMesh& mesh, const Material& material)
      : nodes_(mesh.nodes),
        assembly_(mesh),
        laws_(material, mesh.region, mesh.cell_count()),
        J_(static_cast<std::size_t>(mesh.cell_count()), 1) {
    double volume = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const Vec3 at = mesh.nodes.col(mesh.cells(0, e));
      const auto edge = [&](int a) { return Vec3(mesh.nodes.col(mesh.cells(a, e)) - at); };
      volume += vec::dot(edge(1), vec::cross(edge(2), edge(3))) / 6;
    }
    pressure_scale_ = shear_modulus(material) / std::cbrt(volume / static_cast<double>(J_.size()));
  }

  [[nodiscard]] const Laws& laws() const { return laws_; }
  [[nodiscard]] Laws& laws() { return laws_; }
  [[nodiscard]] const Assembly& assembly() const { return assembly_; }

  /// f = dPi/d(u, q) [N]; the pressures are unknowns, so none is predicted: f_predicted = f. False if a cell
  /// has J <= 0 or NaN.
  [[nodiscard]] bool forces(const Eigen::VectorXd& x, double, Eigen::VectorXd& f,
                            Eigen::VectorXd& f_predicted) {
    laws_.require_fibres();
    f.setZero(x.size());
    for_each_pack(x, [&](const Cells& pack, const Material& law, const At& at) {
      MixedTet::Forces<S> out;
      MixedTet::forces(law, at.moduli, at.X, at.u, at.q, at.data, at.stored(), out);
      for (int l = 0; l < pack.count; ++l) J_[index(pack.cell[l])] = out.J[l];
      alignas(64) double row[width][4 * per_node];
      fem::lanes_to_rows<4 * per_node>(&out.f[0][0], &row[0][0], 4 * per_node);
      for (int l = 0; l < pack.count; ++l)
        for (int a = 0; a < 4; ++a) {
          const Index n = assembly_.cells()(a, pack.cell[l]);
          for (int i = 0; i < 3; ++i) f[3 * n + i] += row[l][per_node * a + i];
          f[3 * nodes() + n] += row[l][per_node * a + 3];
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
  void add_tangent(const Eigen::VectorXd& x, double scale, la::BlockMatrix<per_node>& A) const {
    for_each_pack(
        x,
        [&](const Cells& pack, const Material& law, const At& at) {
          MixedTet::Tangent<S> out;
          MixedTet::tangent(law, at.moduli, at.X, at.u, at.q, at.data, at.stored(), out);
          if (scale != 1)
            for (auto& block : out.K)
              for (auto& entry : block) entry *= S(scale);
          assembly_.add_symmetric(pack, out.K, A);
        },
        &A);
  }

  /// Pi [J] of MixedTet: where the pressures belong to u it is the strain energy, and no cell pays
  /// kappa (J - 1)^2/2 for a volume that only the pressures around it are to hold.
  [[nodiscard]] double energy(const Eigen::VectorXd& x) const {
    std::vector<double> of_cell(J_.size());
    for_each_pack(x, [&](const Cells& pack, const Material& law, const At& at) {
      const S energy = MixedTet::energy(law, at.moduli, at.X, at.u, at.q, at.data, at.stored());
      for (int l = 0; l < pack.count; ++l) of_cell[index(pack.cell[l])] = energy[l];
    });
    double sum = 0;
    for (const double e : of_cell) sum += e;
    return sum;
  }

  /// The Cauchy stress of a cell [Pa] and its current volume [m3]: that of the law, which has no trace, and
  /// the mean of the pressures of its nodes.
  [[nodiscard]] Single::Stress stress(Index cell, const Eigen::VectorXd& x) const {
    Cells pack;
    pack.count = 1;
    for (Index& e : pack.cell) e = cell;
    const Material& law = laws_.material(cell);
    At at;
    gather(pack, shear_modulus(law), x, at);
    S volume;
    const Tensor<S> sigma = MixedTet::stress(law, at.moduli, at.X, at.u, at.q, at.data, at.stored(), volume);
    Single::Stress out;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = symmetric_pairs[k];
      out.sigma(static_cast<int>(k), 0) = sigma(i, j)[0];
    }
    out.volume[0] = volume[0];
    return out;
  }

  /// The pressures of the nodes [Pa]: positive in tension, as sigma = p 1 + ...
  [[nodiscard]] Eigen::VectorXd pressures(const Eigen::VectorXd& x) const {
    return pressure_scale_ * x.tail(nodes());
  }
  /// Shear modulus of a law at rest, the mean of its three dP_ij/dF_ij at F = 1 [Pa]; of one that reads a
  /// frame of fibres, along the axes.
  [[nodiscard]] static double shear_modulus(const Material& law) {
    typename Laws::PointData frame{};
    for (std::size_t k = 0; k < 9 && frame.m.size() >= 9; k += 4) frame.m[k] = 1;
    const auto A = solid::response(law.isochoric, identity<double>(), frame).A;
    const double mu = (A[9 * 1 + 1] + A[9 * 2 + 2] + A[9 * 5 + 5]) / 3;
    TUNICA_EXPECT(mu > 0, "nodal pressures are held by the stiffness in shear that a law has at rest");
    return mu;
  }

 private:
  using S = Pack<double>;
  static constexpr int width = Lanes<S>::count;
  using Cells = fem::CellPack<width>;

  /// What the kernel is called with.
  struct At {
    MixedTet::Moduli moduli{};
    S X[4][3], u[4][3], q[4];
    PointOf<typename Laws::Law, S> data;
    Tensor<S> F_p;
    bool prestressed = false;
    [[nodiscard]] const Tensor<S>* stored() const { return prestressed ? &F_p : nullptr; }
  };

  static std::size_t index(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index nodes() const { return assembly_.node_count(); }

  void gather(const Cells& pack, double mu, const Eigen::VectorXd& x, At& at) const {
    at.moduli = {.mu = mu, .pressure_scale = pressure_scale_};
    S q[4][1];
    assembly_.gather(pack, nodes_, at.X);
    assembly_.gather(pack, x, at.u);
    assembly_.gather(pack, x.tail(nodes()), q);
    for (int a = 0; a < 4; ++a) at.q[a] = q[a][0];
    gather_points<S>(laws_, pack, &at.data, &at.F_p);
    at.prestressed = !laws_.prestress().empty();
  }

  /// body(pack, law, at) for packs of cells of one law.
  template <class Body>
  void for_each_pack(const Eigen::VectorXd& x, Body&& body,
                     const la::BlockMatrix<per_node>* A = nullptr) const {
    std::vector<double> mu;
    for (const Material& law : laws_.materials()) mu.push_back(shear_modulus(law));
    for_each_law_pack<width>(assembly_, laws_, A, [&](const Cells& pack, const Material& law) {
      At at;
      gather(pack, mu[laws_.number(pack.cell[0])], x, at);
      body(pack, law, at);
    });
  }

  Points<3> nodes_;
  Assembly assembly_;
  Laws laws_;
  std::vector<double> J_;
  double pressure_scale_ = 1;  // [Pa/m]
  Index inverted_cell_ = -1;
};

}  // namespace tunica::solid
