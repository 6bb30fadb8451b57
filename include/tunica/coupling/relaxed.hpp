// SPDX-License-Identifier: MIT
// Constant relaxation, and the single pass of the plain explicit scheme. [PEREZ08, 6.1; CGN05]
#pragma once

#include <Eigen/Core>

namespace tunica::coupling {

/// x + omega r. With Dirichlet-Neumann coupling it converges only for
/// 0 < omega < 2 (rho_s h + a dt^2) / (rho_s h + rho_f mu_max + a dt^2): about 0.02 for an artery. [CGN05]
class Relaxed {
 public:
  explicit Relaxed(double omega) : omega_(omega) {}

  void begin(double /*dt*/) {}
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& r) const {
    return x + omega_ * r;
  }
  void accept() {}
  template <class Archive>
  void archive(Archive& a) {
    a("relaxed.omega", omega_);
  }

 private:
  double omega_;  // [-]
};

/// One pass a time step and no test of the interface: the algorithm of the paper as printed. For
/// blood it is unstable at every dt (docs/coupling.md); it is here for heavy walls and to show that.
class Explicit {
 public:
  static constexpr bool one_pass = true;

  void begin(double /*dt*/) {}
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& r) const {
    return x + r;
  }
  void accept() {}
  template <class Archive>
  void archive(Archive&) {}
};

}  // namespace tunica::coupling
