// SPDX-License-Identifier: MIT
// The inside of a body: forces, tangent and energy of all its cells, by packs of cells through one kernel.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/fem/block_assembly.hpp"
#include "tunica/la/block_matrix.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/cell_laws.hpp"
#include "tunica/solid/kernel.hpp"
#include "tunica/solid/single_element.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace tunica::solid {

/// Cells C of a pair of laws under MeanVolume, LinearVolume or CentreVolume, or of any material under
/// Pointwise or FBar. Vectors have 3 numbers a node. All sums run in an order that the mesh alone fixes.
template <mesh::Cell C, class Material, class Locking>
class Interior {
  static_assert(!std::is_same_v<Locking, LinearVolume> || detail::holds_linear_pressure<C>,
                "the displacements of Hex27 alone hold a linear pressure");

 public:
  using Element = Kernel<C, Locking>;
  using Single = SingleElement<C, Locking>;
  static constexpr int per_node = 3;
  using Laws = CellLaws<Material, Element::points>;
  using Assembly = fem::BlockAssembly<C, 3>;
  static constexpr bool symmetric = Locking::blocks == Blocks::upper;

  Interior(const mesh::Mesh<C, 3>& mesh, const Material& material)
      : nodes_(mesh.nodes),
        assembly_(mesh),
        laws_(material, mesh.region, mesh.cell_count()),
        smallest_J_(static_cast<std::size_t>(mesh.cell_count()), 1) {
    if constexpr (keeps) cells_.resize(smallest_J_.size());
  }

  [[nodiscard]] const Laws& laws() const { return laws_; }
  [[nodiscard]] Laws& laws() { return laws_; }
  [[nodiscard]] const Assembly& assembly() const { return assembly_; }

  /// f = internal forces at u [N]. False if a cell has J <= 0 or NaN: see inverted_cell(). `step`: how far u
  /// is along the last direction(), negative on no step; f_predicted is f with the pressures predicted along
  /// that step in place of U'(theta), and f itself where the cells keep no pressure.
  [[nodiscard]] bool forces(const Eigen::VectorXd& u, double step, Eigen::VectorXd& f,
                            Eigen::VectorXd& f_predicted) {
    if constexpr (Element::bar)
      TUNICA_EXPECT(laws_.prestress().empty(), "F-bar takes no prestress: it knows F at the centre alone");
    laws_.require_fibres();
    f.setZero(u.size());
    if constexpr (keeps) f_predicted.setZero(u.size());
    for_each_pack([&](const auto& pack, const auto& law, const auto* data, const auto* stored) {
      S X[nodes][3], x[nodes][3];
      assembly_.gather(pack, nodes_, X);
      assembly_.gather(pack, u, x);
      typename Element::template Forces<S> out;
      Element::forces(law, X, x, data, stored, out);
      for (int l = 0; l < pack.count; ++l) smallest_J_[at(pack.cell[l])] = out.smallest_J[l];
      if constexpr (keeps) {
        keep(pack, out, step);
        if (augmented_)
          add_pressures(pack, out, [](const CellState& c, std::size_t k) { return c.multiplier[k]; });
      }
      assembly_.add(pack, out.f, f);
      if constexpr (keeps) {
        add_pressures(pack, out, [](const CellState& c, std::size_t k) { return c.predicted[k] - c.p[k]; });
        assembly_.add(pack, out.f, f_predicted);
      }
    });
    if constexpr (!keeps) f_predicted = f;
    rounding_ = 0;
    if constexpr (keeps) {
      for (const CellState& cell : cells_) rounding_ += cell.rounding * cell.rounding;
      rounding_ = std::sqrt(rounding_);
    }
    inverted_cell_ = -1;
    for (std::size_t e = 0; e < smallest_J_.size() && inverted_cell_ < 0; ++e)
      if (!(smallest_J_[e] > 0)) inverted_cell_ = static_cast<Index>(e);
    return inverted_cell_ < 0;
  }
  /// Size of the part of the last forces that is rounding: no residual gets below it [N].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// The first cell with J <= 0 in the last forces(), -1 if there was none.
  [[nodiscard]] Index inverted_cell() const { return inverted_cell_; }

  /// A step du leaves the u of the last forces(): the pressures go from the ones predicted so far to
  /// p_i + sum_j bulk_ij dtheta_j(du).
  void direction(const Eigen::VectorXd& du) {
    if constexpr (keeps)
      parallel_chunks(static_cast<std::ptrdiff_t>(cells_.size()), 512,
                      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                        for (std::ptrdiff_t e = begin; e < end; ++e) {
                          CellState& cell = cells_[static_cast<std::size_t>(e)];
                          cell.start = cell.predicted;
                          cell.target = cell.p;
                          for (std::size_t k = 0; k < modes; ++k) {
                            double change = 0;
                            for (int a = 0; a < nodes; ++a)
                              for (int i = 0; i < 3; ++i)
                                change += cell.rate[k][a][i] * du[3 * assembly_.cells()(a, e) + i];
                            for (std::size_t j = 0; j < modes; ++j)
                              cell.target[j] += cell.gain[j][k] * change;
                          }
                        }
                      });
  }

  /// The pressures of the last forces() become multipliers of the cells' volumes: equilibrium under the same
  /// loads is then nearer to theta = 1 (augmented Lagrangian [SIMO91]). The largest of all cells of the root
  /// of the mean of (theta - 1)^2, with MeanVolume |v/V - 1|, in the last forces().
  double augment() requires(Element::keeps) {
    double off = 0;
    for (CellState& cell : cells_) {
      if (!(cell.off <= off)) off = cell.off;
      cell.multiplier = cell.p;
    }
    augmented_ = true;
    return off;
  }
  /// What augment() left at the points of a cell [Pa].
  [[nodiscard]] Eigen::Array<double, 1, Element::points> multiplier(Index cell) const {
    if constexpr (keeps)
      if (augmented_) {
        typename Single::template Nodal<double> X;
        for (int a = 0; a < nodes; ++a) X.col(a) = nodes_.col(assembly_.cells()(a, cell));
        return Single::pressure(cells_[at(cell)].multiplier, X, laws_.data(cell));
      }
    return Eigen::Array<double, 1, Element::points>::Zero();
  }

  /// A += scale K(u), with the pressures predicted in the last forces().
  void add_tangent(const Eigen::VectorXd& u, double scale, la::BlockMatrix<3>& A) const {
    for_each_pack(
        [&](const auto& pack, const auto& law, const auto* data, const auto* stored) {
          S X[nodes][3], x[nodes][3];
          assembly_.gather(pack, nodes_, X);
          assembly_.gather(pack, u, x);
          typename Element::template Tangent<S> out;
          if constexpr (keeps) {
            typename Element::template Pressures<S> p;
            for (std::size_t k = 0; k < modes; ++k)
              p[k] = lanes(pack, [&](Index e) { return cells_[at(e)].predicted[k]; });
            Element::tangent(law, X, x, data, stored, p, out);
          } else {
            Element::tangent(law, X, x, data, stored, out);
          }
          if (scale != 1)
            for (auto& block : out.K)
              for (auto& entry : block) entry *= S(scale);
          if constexpr (symmetric)
            assembly_.add_symmetric(pack, out.K, A);
          else
            assembly_.add(pack, out.K, A);
        },
        &A);
  }

  /// Strain energy [J].
  [[nodiscard]] double energy(const Eigen::VectorXd& u) const requires(!Element::bar) {
    std::vector<double> of_cell(smallest_J_.size());
    for_each_pack([&](const auto& pack, const auto& law, const auto* data, const auto* stored) {
      S X[nodes][3], x[nodes][3];
      assembly_.gather(pack, nodes_, X);
      assembly_.gather(pack, u, x);
      const S energy = Element::energy(law, X, x, data, stored);
      for (int l = 0; l < pack.count; ++l) of_cell[at(pack.cell[l])] = energy[l];
    });
    double sum = 0;
    for (const double e : of_cell) sum += e;
    return sum;
  }

 private:
  static constexpr int nodes = C::nodes;
  static constexpr bool keeps = Element::keeps;
  static constexpr std::size_t modes = Element::modes;
  static constexpr double roundings = 2;  // measured: residuals stall at 0.2 to 0.6 of this bound
  using S = Pack<double>;
  static constexpr int width = Lanes<S>::count;
  using Cells = fem::CellPack<width>;

  struct CellState {
    using Pressures = std::array<double, modes>;
    double rounding = 0, off = 0;              // off: root of the mean of (theta - 1)^2
    Pressures p{};                             // of U'(theta), with the multipliers, at the last forces
    std::array<Pressures, modes> gain{};       // dp_i = sum_j gain_ij rate_j . du
    Pressures multiplier{};                    // what augment() left [Pa]
    Pressures start{}, target{}, predicted{};  // along a step of Newton [Pa]
    double rate[modes == 0 ? 1 : modes][nodes][3] = {};  // V dtheta_i/du [m2], dJ0/du of CentreVolume [1/m]
  };

  static std::size_t at(Index e) { return static_cast<std::size_t>(e); }

  template <class Value>
  static S lanes(const Cells& pack, Value&& value) {
    S s;
    for (int l = 0; l < width; ++l) s.set(l, value(pack.cell[l]));
    return s;
  }

  /// out.f += sum_k pressure(cell, k) slope_k
  template <class Pressure>
  void add_pressures(const Cells& pack, typename Element::template Forces<S>& out,
                     Pressure&& pressure) const {
    for (std::size_t k = 0; k < modes; ++k) {
      const S p = lanes(pack, [&](Index e) { return pressure(cells_[at(e)], k); });
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i) out.f[a][i] += p * out.slope[k][a][i];
    }
  }

  void keep(const Cells& pack, const typename Element::template Forces<S>& out, double step) {
    for (int l = 0; l < pack.count; ++l) {
      CellState& cell = cells_[at(pack.cell[l])];
      double off = 0, rounding = 0;
      for (std::size_t k = 0; k < modes; ++k) {
        double size = 0;
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < 3; ++i) {
            size += out.slope[k][a][i][l] * out.slope[k][a][i][l];
            cell.rate[k][a][i] = out.rate(k)[a][i][l];
          }
        const double error = out.theta[k][l] - (k == 0 ? 1 : 0), bulk = out.bulk[k][k][l];
        off += error * error;
        rounding += bulk * bulk * size;
        cell.p[k] = out.p[k][l] + cell.multiplier[k];
        for (std::size_t j = 0; j < modes; ++j) cell.gain[k][j] = out.gain(k, j)[l];
        cell.predicted[k] = step < 0 ? cell.p[k] : cell.start[k] + step * (cell.target[k] - cell.start[k]);
      }
      cell.off = std::sqrt(off);
      // theta is known to a few roundings only, and the pressure to kappa times as much.
      cell.rounding = roundings * std::numeric_limits<double>::epsilon() * std::sqrt(rounding);
    }
  }

  /// body(pack, law, data, stored) for packs of cells of one law; what a pack adds to A is fetched ahead.
  template <class Body>
  void for_each_pack(Body&& body, const la::BlockMatrix<3>* A = nullptr) const {
    const auto visit = [&](const Cells& pack) {
      for (int first = 0; first < pack.count;) {  // runs of cells under one law
        const Material& law = laws_.material(pack.cell[first]);
        Cells part;
        part.count = 0;
        while (first < pack.count && &laws_.material(pack.cell[first]) == &law)
          part.cell[part.count++] = pack.cell[first++];
        for (int l = part.count; l < width; ++l) part.cell[l] = part.cell[part.count - 1];
        with_data(part, law, body);
      }
    };
    if (A)
      assembly_.template for_each_pack<width>(*A, visit);
    else
      assembly_.template for_each_pack<width>(visit);
  }

  template <class Body>
  void with_data(const Cells& pack, const Material& law, Body& body) const {
    typename Element::template Data<typename Laws::Law, S> data[Element::points];
    Tensor<S> stored[Element::points];
    const bool points = needs_point<typename Laws::Law>;
    const bool prestressed = !laws_.prestress().empty();
    for (std::size_t q = 0; q < Element::points; ++q) {
      if constexpr (needs_point<typename Laws::Law>)
        for (std::size_t k = 0; k < data[q].m.size(); ++k)
          data[q].m[k] = lanes(pack, [&](Index e) {
            const auto* given = laws_.data(e).points;
            return given ? given[q].m[k] : 0.0;
          });
      if (prestressed)
        for (int k = 0; k < 9; ++k)
          stored[q].m[at(k)] = lanes(pack, [&](Index e) { return laws_.data(e).prestress[q](k / 3, k % 3); });
    }
    body(pack, law, points ? data : nullptr, prestressed ? stored : nullptr);
  }

  Points<3> nodes_;
  Assembly assembly_;
  Laws laws_;
  std::vector<double> smallest_J_;
  std::vector<CellState> cells_;  // where they keep pressures
  bool augmented_ = false;
  Index inverted_cell_ = -1;
  double rounding_ = 0;
};

}  // namespace tunica::solid
