// SPDX-License-Identifier: MIT
// The pressure increment, the correction of the velocity and the rotational update. [ONATE06; GUERMOND06]
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/coarse_space.hpp"
#include "tunica/fluid/divergence.hpp"
#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/momentum.hpp"
#include "tunica/fluid/pressure_operator.hpp"
#include "tunica/fluid/pressure_response.hpp"
#include "tunica/fluid/state.hpp"
#include "tunica/fluid/weak_pressure.hpp"
#include "tunica/la/cg.hpp"
#include "tunica/la/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace tunica::fluid {

/// A template of its scalar, so that its parts cost the scenes that take a step and no reader of the header.
template <class Scalar = double>
class PressureStep {
  using Vector = Eigen::VectorX<Scalar>;  // nodes
  using Field = Points<3>;                // 3 x nodes

 public:
  PressureStep(const Pattern& pattern, const Field& x, double volume)
      : operator_(pattern), coarse_(x, volume), response_(pattern) {}

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
    response_.of_velocity(domain);
    prepare(domain);
  }
  /// gamma L alone: what divergence a correction takes away.
  void assemble_projection(const Domain& domain, double gamma) {
    response_.of_velocity(domain);
    unstabilised(domain, gamma);
  }
  /// The Laplacian (grad N, grad N) itself with its weakly prescribed values.
  void assemble_laplacian(const Domain& domain) {
    response_.whole(domain);
    unstabilised(domain, 1);
  }

  /// A x = b; x starts from what it holds. The prescribed increments are weighed in b. Without any prescribed
  /// pressure the mean of x is zero, and b loses what no x can balance. most: of |b - A x|, on top of the
  /// relative tolerance.
  SolveReport solve(const Domain& domain, Vector b, double round_off, const la::KrylovOptions& options,
                    Vector& x, double most = std::numeric_limits<double>::infinity()) {
    const Vector mass = domain.inverse_mass.cwiseInverse();
    const bool enclosed = !domain.conditions.any_pressure();
    if (enclosed) b -= (b.sum() / mass.sum()) * mass;
    la::KrylovOptions with_floor = options;
    with_floor.absolute = 1e-14 * round_off;
    const double size = la::norm(b);
    if (most < options.tolerance * size) with_floor.tolerance = most / size;
    SolveReport report = la::cg(operator_, TwoLevel{cholesky_, coarse_}, b, x, with_floor);
    if (report.status == Status::stalled && report.residual * size < operator_.round_off(x))
      report.status = Status::converged;  // as exact as double precision can tell
    if (enclosed) x.array() -= x.dot(mass) / mass.sum();
    return report;
  }

  /// gamma times what the prescribed increments (nodes) add to the right-hand side.
  [[nodiscard]] Vector prescribe(const Domain& domain, const Vector& prescribed) {
    const Vector none = Vector::Zero(prescribed.size());
    Vector right = none;
    for_each_weak_face(domain, response_.unit(), [&](const WeakFace& face) {
      for (int i = 0; i < 4; ++i) right[face.node(i)] -= gamma_ * face.form(i, none, prescribed);
    });
    if (const TotalFlux& total = response_.total(); !total.none())
      total.update(-gamma_, total.of_form(none, prescribed), total.of_velocity(none, prescribed), right);
    return right;
  }

  /// From the predicted velocity u (3 x nodes) and the pressure p to those at the end of the pass.
  /// change: of the pressures on the pressure patches, 0 at the other nodes. force: [N/m3] or no columns.
  /// rotational: chi mu [Pa s]. u of the nodes with prescribed velocity stays.
  SolveReport correct(const Domain& domain, const Field& force, double rotational,
                      const la::KrylovOptions& options, const Vector& guess, const Vector& change, Field& u,
                      Vector& p) {
    divergence(domain, u, divergence_);
    stabilise(domain, p, force);
    if (!domain.conditions.any_pressure() && leaks(domain, u)) return {Status::diverged, 0, 1};
    right_ = prescribe(domain, change) - (divergence_ + stabilised_);
    std::vector<double> predicted;  // through each patch
    double along = 0;
    for (const Condition& c : domain.conditions.list()) {
      predicted.push_back(Conditions::flux(domain.position, c.faces, u));
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f)
        along +=
            length(column(u, c.faces(0, f))) * length(Conditions::area_vector(domain.position, c.faces, f));
    }
    // The sum of the residual is the mass that is lost: at most sqrt(n) times its norm.
    constexpr double loss = 1e-9, tangential = 1e-8;  // of the flow; of the flow along the boundary: none
    const auto most = [&](const std::vector<double>& flux) {
      double through = 0;
      for (const double q : flux) through += std::abs(q) / 2;
      return through > tangential * along ? loss * through / std::sqrt(static_cast<double>(p.size()))
                                          : std::numeric_limits<double>::infinity();
    };
    const double round_off = la::norm(divergence_) + la::norm(stabilised_), size = la::norm(right_);
    increment_ = guess;
    SolveReport report = solve(domain, right_, round_off, options, increment_, most(predicted));
    consistent_flux_ = corrected(domain, predicted, change);
    if (report && report.residual * size > most(consistent_flux_)) {  // pressures drive it only now
      const SolveReport more = solve(domain, right_, round_off, options, increment_, most(consistent_flux_));
      report = {report.status, report.iterations + more.iterations, more.residual};
      consistent_flux_ = corrected(domain, predicted, change);
    }
    if (!report) return report;
    // u = u* - gamma M^-1 (int N grad dp - <N (dp - change) n>)
    gradient(domain, increment_);
    load_patches(domain, increment_, change);
    const SolveReport projected = response_.project(domain, gradient_);
    if (!projected) return projected;
    for (Eigen::Index i = 0; i < u.size(); ++i) u.data()[i] -= gamma_ * gradient_.data()[i];
    // p = p^k + dp - chi mu M_L^-1 (D u* + T (p^k + dp)), where D u* + T (p^k + dp) = -gamma L dp. Where
    // elements are flat and viscous chi mu T outweighs M_L, and the update would overshoot. The diagonal of
    // L_tau bounds T up to its largest eigenvalue over the diagonal, 4/3 on a regular tetrahedron.
    constexpr double bound = 4.0 / 3;
    p += increment_;
    for (Eigen::Index i = 0; i < p.size(); ++i)
      p[i] += rotational * gamma_ * laplacian_[i] /
              std::max(1 / domain.inverse_mass[i], bound * rotational * diagonal_[i]);
    return report;
  }

  /// Fluxes after correct(): u at the end of the step, w of the grid (3 x nodes).
  [[nodiscard]] MassBalance balance(const Domain& domain, const Field& u, const Field& w) const {
    MassBalance mass;
    for (std::size_t k = 0; k < consistent_flux_.size(); ++k) {
      const Condition& c = domain.conditions.list()[k];
      mass.unbalanced += Conditions::flux(domain.position, c.faces, u);
      const double q = consistent_flux_[k];
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

  void unstabilised(const Domain& domain, double gamma) {
    gamma_ = gamma;
    tau_.assign(static_cast<std::size_t>(domain.cells.cols()), 0.0);
    prepare(domain);
  }

  void prepare(const Domain& domain) {
    diagonal_.setZero(domain.position.cols());
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const double weight = tau_[static_cast<std::size_t>(e)] * tet.volume;
      for (int i = 0; i < 4; ++i) {
        const Vec3 g(tet.grad(0, i), tet.grad(1, i), tet.grad(2, i));
        diagonal_[domain.cells(i, e)] += weight * dot(g, g);
      }
    });
    operator_.assemble(domain, response_.unit(), tau_, gamma_, response_.total());
    cholesky_.compute(operator_.preconditioning());
    coarse_.compute(operator_.preconditioning(), operator_.entries(), operator_.inverse_mass(),
                    domain.conditions.any_pressure() ? NullSpace::none : NullSpace::constants);
  }

  /// gradient_ = int N grad p, laplacian_ = (w grad N, grad p).
  void gradient(const Domain& domain, const Vector& p) {
    gradient_.setZero(3, p.size()), laplacian_.setZero(p.size());
    domain.pattern.for_each_cell([&](Index e) {
      const fem::P1Tet& tet = domain.tets[e];
      const Vec3 g = fluid::gradient(nodal(p, domain.cells, e), tet.grad);
      const double weight =
          response_.unit().arriving(domain.cells.data() + 4 * std::ptrdiff_t{e}) * tet.volume;
      for (int i = 0; i < 4; ++i) {
        add(gradient_, domain.cells(i, e), tet.volume / 4, g);
        laplacian_[domain.cells(i, e)] += weight * along(g, tet.grad, i);
      }
    });
  }

  /// On pressure patches: the load changes by what is prescribed and not by dp, gradient_ -= <N (dp - c) n>,
  /// and the weak form adds its terms to laplacian_.
  void load_patches(const Domain& domain, const Vector& increment, const Vector& change) {
    for (const Condition& c : domain.conditions.list()) {
      if (c.kind != Kind::pressure) continue;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f) {
        Vec3 excess;
        for (int i = 0; i < 3; ++i) excess[i] = increment[c.faces(i, f)] - change[c.faces(i, f)];
        const Vec3 n = Conditions::area_vector(domain.position, c.faces, f), load = face_load(1, excess);
        for (int i = 0; i < 3; ++i) add(gradient_, c.faces(i, f), -load[i], n);
        const WeakFace face(domain, response_.unit(), c, f);
        for (int i = 0; i < 4; ++i) laplacian_[face.node(i)] += face.form(i, increment, change);
      }
    }
    if (const TotalFlux& total = response_.total(); !total.none())
      total.update(1, total.of_form(increment, change), total.of_velocity(increment, change), laplacian_);
  }

  /// Fluxes through the patches with what the weak form adds to those of u*.
  [[nodiscard]] std::vector<double> corrected(const Domain& domain, std::vector<double> flux,
                                              const Vector& change) const {
    for (std::size_t k = 0; k < flux.size(); ++k) {
      const Condition& c = domain.conditions.list()[k];
      if (c.kind != Kind::pressure) continue;
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f) {
        const WeakFace face(domain, response_.unit(), c, f);
        for (int i = 0; i < 4; ++i) flux[k] += gamma_ * face.form(i, increment_, change);
      }
    }
    if (const TotalFlux& total = response_.total(); !total.none()) {
      const double more =
          gamma_ * (total.of_velocity(increment_, change) - total.of_form(increment_, change));
      for (std::size_t k = 0; k < flux.size(); ++k) flux[k] += total.share[k] * more;
    }
    return flux;
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
  PressureResponse<Scalar> response_;
  std::vector<double> tau_;  // [m3 s/kg] a cell
  double gamma_ = 0;         // dt / (rho c0) [m3 s/kg]
  Vector divergence_, stabilised_, right_, increment_, laplacian_;
  Vector diagonal_;  // of L_t
  Field gradient_;
  std::vector<double> consistent_flux_;  // through each patch: int N u.n of the continuity equation [m3/s]
};

}  // namespace tunica::fluid
