// SPDX-License-Identifier: MIT
// Aitken's dynamic relaxation of the interface displacement. [KUETTLER08]
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace tunica::coupling {

struct AitkenOptions {
  double first = 0.1;    // [-] relaxation of the first iteration of the first step
  double largest = 0.5;  // [-] bound of the first relaxation of a later step
};

/// x + omega_k r_k with omega_k = -omega_{k-1} r_{k-1}.(r_k - r_{k-1}) / |r_k - r_{k-1}|^2.
class Aitken {
 public:
  explicit Aitken(AitkenOptions options = {}) : options_(options), omega_(options.first) {}

  void begin(double /*dt*/) {
    omega_ = std::copysign(std::min(std::abs(omega_), options_.largest), omega_);
    if (!(std::abs(omega_) > 1e-4)) omega_ = options_.first;  // a relaxation that died away, or NaN
    last_.resize(0);
  }

  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& r) {
    if (last_.size() == r.size()) {
      const Eigen::VectorXd dr = r - last_;
      const double squared = dr.squaredNorm();
      if (squared > 0) omega_ *= -last_.dot(dr) / squared;  // [KUETTLER08]
    }
    last_ = r;
    return x + omega_ * r;
  }

  void accept() { last_.resize(0); }

  [[nodiscard]] double relaxation() const { return omega_; }

  template <class Archive>
  void archive(Archive& a) {
    a("aitken.omega", omega_);
  }

 private:
  AitkenOptions options_;
  double omega_;          // [-]
  Eigen::VectorXd last_;  // residual of the iteration before; empty at the start of a step
};

}  // namespace tunica::coupling
