// SPDX-License-Identifier: MIT
// The pressure increment, the correction of the velocity and the rotational update. [ONATE06; GUERMOND06]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/coarse_space.hpp"
#include "tunica/fluid/consistent_mass.hpp"
#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/momentum.hpp"
#include "tunica/fluid/pressure_operator.hpp"
#include "tunica/fluid/state.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::fluid {

/// A template of its scalar, so that its parts cost the scenes that take a step and no reader of the header.
template <class Scalar = double>
class PressureStep {
  using Vector = Eigen::VectorX<Scalar>;  // nodes
  using Field = Points<3>;                // 3 x nodes

 public:
  PressureStep(const Pattern& pattern, const Field& x, double volume)
      : operator_(pattern), coarse_(x, volume), mass_(pattern) {}

  /// gamma L + T about the advecting velocity a; gamma = dt / (rho c0) [m3 s/kg].
  template <Rheology R, Stabilization S>
  void assemble(const Domain& domain, const R& fluid, const S& stabilization, const Field& a, const Field& u,
                double gamma) {
    gamma_ = gamma;
    tau_.resize(static_cast<std::size_t>(domain.cells.cols()));
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const ElementFlow flow =
          element_flow(fluid, stabilization, tet, nodal(a, domain.cells, e), nodal(u, domain.cells, e));
      tau_[static_cast<std::size_t>(e)] =
          stabilization.mass(fluid.density, flow.viscosity, tet.size(), length(flow.a));
    });
    prepare(domain);
  }
  /// L alone, times gamma.
  void assemble_laplacian(const Domain& domain, double gamma) {
    gamma_ = gamma;
    tau_.assign(static_cast<std::size_t>(domain.cells.cols()), 0.0);
    prepare(domain);
  }

  /// A x = b with x prescribed (on entry, at the nodes with prescribed pressure); elsewhere guess starts
  /// it. Without any prescribed pressure the mean of x is zero, and b loses what no x can balance.
  /// most: of |b - A x|, on top of the relative tolerance.
  SolveReport solve(const Domain& domain, Vector b, double round_off, const Vector& guess,
                    const la::KrylovOptions& options, Vector& x,
                    double most = std::numeric_limits<double>::infinity()) {
    const auto& prescribed = domain.conditions.pressure_flags();
    operator_.apply(x, product_);
    round_off = std::max(round_off, la::norm(product_));
    b -= product_;
    start_ = guess;
    for (std::size_t i = 0; i < prescribed.size(); ++i)
      if (prescribed[i]) b[static_cast<Eigen::Index>(i)] = start_[static_cast<Eigen::Index>(i)] = 0;
    const Vector mass = domain.inverse_mass.cwiseInverse();
    const bool enclosed = !domain.conditions.any_pressure();
    if (enclosed) b -= (b.sum() / mass.sum()) * mass;
    la::KrylovOptions with_floor = options;
    with_floor.absolute = 1e-14 * round_off;
    const double size = la::norm(b);
    if (most < options.tolerance * size) with_floor.tolerance = most / size;
    SolveReport report = la::cg(operator_, TwoLevel{cholesky_, coarse_}, b, start_, with_floor);
    if (report.status == Status::stalled && report.residual * size < operator_.round_off(start_))
      report.status = Status::converged;  // as exact as double precision can tell
    if (enclosed) start_.array() -= start_.dot(mass) / mass.sum();
    x += start_;
    return report;
  }

  /// From the predicted velocity u (3 x nodes) and the pressure p to those at the end of the pass.
  /// change: of the pressures on the pressure patches, 0 at the other nodes. force: [N/m3] or no columns.
  /// rotational: chi mu [Pa s]. u of the nodes with prescribed velocity stays.
  SolveReport correct(const Domain& domain, const Field& force, double rotational,
                      const la::KrylovOptions& options, const Vector& guess, const Vector& change, Field& u,
                      Vector& p) {
    divergence(domain, u);
    stabilise(domain, p, force);
    if (!domain.conditions.any_pressure() && leaks(domain, u)) return {Status::diverged, 0, 1};
    right_ = -(divergence_ + stabilised_);
    double through = 0, along = 0;
    predicted_flux_.clear();
    for (const Condition& c : domain.conditions.list()) {
      predicted_flux_.push_back(Conditions::flux(domain.position, c.faces, u));
      through += std::abs(predicted_flux_.back()) / 2;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        along +=
            length(column(u, c.faces(0, f))) * length(Conditions::area_vector(domain.position, c.faces, f));
    }
    // The sum of the residual is the mass that is lost: at most sqrt(n) times its norm.
    constexpr double loss = 1e-9, tangential = 1e-8;  // of the flow; of the flow along the boundary: none
    double most = std::numeric_limits<double>::infinity();
    if (through > tangential * along) most = loss * through / std::sqrt(static_cast<double>(p.size()));
    Vector increment = change;
    domain.conditions.keep_prescribed(increment);
    const SolveReport report =
        solve(domain, right_, la::norm(divergence_) + la::norm(stabilised_), guess, options, increment, most);
    operator_.apply_all(increment, product_);
    reaction_ = right_ - product_;  // the flux that leaves at nodes where the pressure is prescribed
    // u = u* - gamma M^-1 int N grad dp
    gradient(domain, increment);
    weigh_edges(domain, increment, change);
    const SolveReport projected = mass_.solve(domain, gradient_);
    if (!projected) return projected;
    for (Eigen::Index i = 0; i < u.size(); ++i) u.data()[i] -= gamma_ * gradient_.data()[i];
    // p = p^k + dp - chi mu M_L^-1 (D u* + T (p^k + dp)). The stabilised divergence, not D u* alone: where
    // dp is prescribed the pressure moves until continuity holds in those rows too, and then it rests.
    p += increment + rotational * domain.inverse_mass.cwiseProduct(reaction_ + gamma_ * laplacian_);
    if (rotational > 0 && domain.conditions.any_pressure()) balance_outlets(domain, force, u, p);
    return report;
  }

  /// Fluxes after correct(): u at the end of the step, w of the grid (3 x nodes).
  [[nodiscard]] MassBalance balance(const Domain& domain, const Field& u, const Field& w) const {
    MassBalance mass;
    std::vector<char> seen(static_cast<std::size_t>(u.cols()), 0);
    for (std::size_t k = 0; k < predicted_flux_.size(); ++k) {
      const Condition& c = domain.conditions.list()[k];
      mass.unbalanced += Conditions::flux(domain.position, c.faces, u);
      double q = predicted_flux_[k];  // int N_i u.n = int N_i u*.n + the reaction of row i, summed
      if (c.kind == Kind::pressure)
        for (const Index n : c.nodes)
          if (!std::exchange(seen[static_cast<std::size_t>(n)], 1)) q += reaction_[n];
      mass.discrete += q;
      if (c.kind == Kind::wall)
        mass.swept += Conditions::flux(domain.position, c.faces, w);
      else
        (q < 0 ? mass.inflow : mass.outflow) += std::abs(q);
    }
    return mass;
  }

 private:
  struct TwoLevel {
    const la::IncompleteCholesky& fine;
    const CoarseSpace<Scalar>& coarse;
    void apply(const Vector& r, Vector& z) const { fine.apply(r, z), coarse.add(r, z); }
  };

  void prepare(const Domain& domain) {
    mass_.assemble(domain);
    operator_.assemble(domain.pattern, domain.cells, domain.tets, tau_, gamma_,
                       domain.conditions.pressure_flags());
    cholesky_.compute(operator_.preconditioning());
    coarse_.compute(operator_.preconditioning(), operator_.entries(), operator_.inverse_mass(),
                    domain.conditions.pressure_flags());
  }

  /// divergence_ = int N div u.
  void divergence(const Domain& domain, const Field& u) {
    divergence_.setZero(u.cols());
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const Nodal3 ue = nodal(u, domain.cells, e);
      double q = 0;
      for (int k = 0; k < 12; ++k) q += ue.data()[k] * tet.grad.data()[k];
      for (int i = 0; i < 4; ++i) divergence_[domain.cells(i, e)] += tet.volume / 4 * q;
    });
  }

  /// gradient_ = int N grad p, laplacian_ = (grad N, grad p).
  void gradient(const Domain& domain, const Vector& p) {
    gradient_.setZero(3, p.size()), laplacian_.setZero(p.size());
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const Vec3 g = fluid::gradient(nodal(p, domain.cells, e), tet.grad);
      for (int i = 0; i < 4; ++i) {
        add(gradient_, domain.cells(i, e), tet.volume / 4, g);
        laplacian_[domain.cells(i, e)] += tet.volume * along(g, tet.grad, i);
      }
    });
  }

  /// The load of a pressure patch changes by what is prescribed, also where dp is free: on its edge.
  void weigh_edges(const Domain& domain, const Vector& increment, const Vector& change) {
    for (const Condition& c : domain.conditions.list()) {
      if (c.kind != Kind::pressure) continue;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f) {
        Vec3 excess;
        for (int i = 0; i < 3; ++i) excess[i] = increment[c.faces(i, f)] - change[c.faces(i, f)];
        if (excess[0] == 0 && excess[1] == 0 && excess[2] == 0) continue;
        const Vec3 n = Conditions::area_vector(domain.position, c.faces, f), load = face_load(1, excess);
        for (int i = 0; i < 3; ++i) add(gradient_, c.faces(i, f), -load[i], n);
      }
    }
  }

  /// stabilised_ = int tau grad N . (r - P r), r = grad p - force.
  void stabilise(const Domain& domain, const Vector& p, const Field& force) {
    const auto residual = [&](Index e) {
      Vec3 r = fluid::gradient(nodal(p, domain.cells, e), domain.tets[e].grad);
      if (force.cols() > 0) {
        const Vec3 f = mean(nodal(force, domain.cells, e));
        for (int c = 0; c < 3; ++c) r[c] -= f[c];
      }
      return r;
    };
    gradient_.setZero(3, p.size());
    domain.pattern.for_each_cell([&](Index e) {
      const double weight = tau_[static_cast<std::size_t>(e)] * domain.tets[e].volume / 4;
      const Vec3 r = residual(e);
      for (int i = 0; i < 4; ++i) add(gradient_, domain.cells(i, e), weight, r);
    });
    scale_columns(gradient_, operator_.inverse_mass());
    stabilised_.setZero(p.size());
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const double weight = tau_[static_cast<std::size_t>(e)] * tet.volume;
      const Vec3 smooth = mean(nodal(gradient_, domain.cells, e)), r = residual(e);
      const Vec3 rough(r[0] - smooth[0], r[1] - smooth[1], r[2] - smooth[2]);
      for (int i = 0; i < 4; ++i) stabilised_[domain.cells(i, e)] += weight * along(rough, tet.grad, i);
    });
  }

  /// The rows of continuity of the nodes where the pressure is prescribed were not solved for, and what they
  /// miss is the mass defect. There too the pressure moves until they hold: p -= omega (D u + T p) / diag(A).
  /// At most 3 nodes of a cell lie on a patch, so diag(A)^-1 A is at most 3 there, and omega < 2/3 is stable.
  void balance_outlets(const Domain& domain, const Field& force, const Field& u, Vector& p) {
    constexpr double omega = 0.5;
    divergence(domain, u);
    stabilise(domain, p, force);
    const Vector diagonal = operator_.preconditioning().diagonal();
    const auto& prescribed = domain.conditions.pressure_flags();
    for (Eigen::Index i = 0; i < p.size(); ++i)
      if (prescribed[static_cast<std::size_t>(i)])
        p[i] -= omega * (divergence_[i] + stabilised_[i]) / diagonal[i];
  }

  /// Without prescribed pressure what flows in must flow out, up to the error of the boundary data.
  [[nodiscard]] bool leaks(const Domain& domain, const Field& u) const {
    constexpr double tolerated = 0.05;  // nodal values of a smooth divergence-free field on a coarse mesh
    double through = 0, sum = 0, round_off = 0;
    for (const Condition& c : domain.conditions.list())
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        through += std::abs(Conditions::flux(domain.position, c.faces, u, f));
    for (Eigen::Index i = 0; i < divergence_.size(); ++i)
      sum += divergence_[i], round_off += 1e-8 * std::abs(divergence_[i]);
    return !(std::abs(sum) <= tolerated * through + round_off);
  }

  PressureOperator operator_;
  la::IncompleteCholesky cholesky_;
  CoarseSpace<Scalar> coarse_;
  ConsistentMass<Scalar> mass_;
  std::vector<double> tau_;  // [m3 s/kg] a cell
  double gamma_ = 0;         // dt / (rho c0) [m3 s/kg]
  Vector divergence_, stabilised_, right_, product_, start_, reaction_, laplacian_;
  Field gradient_;
  std::vector<double> predicted_flux_;  // of u* through each patch [m3/s]
};

}  // namespace tunica::fluid
