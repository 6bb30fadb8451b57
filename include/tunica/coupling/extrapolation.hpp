// SPDX-License-Identifier: MIT
// The predictor: the polynomial through the last converged displacements, at uneven steps.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace tunica::coupling {

/// Keeps the last three displacements (3 x n [m]) and the steps between them [s].
class Extrapolation {
 public:
  [[nodiscard]] bool empty() const { return known_ == 0; }

  /// The displacement reached a time dt after the one pushed before.
  void push(const Points<3>& x, double dt) {
    x_[2] = std::move(x_[1]), x_[1] = std::move(x_[0]), x_[0] = x;
    step_[1] = step_[0], step_[0] = dt;
    known_ = std::min(known_ + 1, depth);
  }

  /// Lagrange's polynomial through the last degree + 1 of them (fewer at the start), dt ahead.
  [[nodiscard]] Points<3> extrapolate(double dt, int degree) const {
    TUNICA_EXPECT(!empty(), "extrapolation needs at least one displacement");
    const int points = std::min(degree + 1, known_);
    const std::array<double, depth> ago{0.0, step_[0], step_[0] + step_[1]};  // [s]
    Points<3> x = Points<3>::Zero(3, x_[0].cols());
    for (int i = 0; i < points; ++i) {
      double weight = 1;
      for (int j = 0; j < points; ++j)
        if (j != i) weight *= (dt + ago[at(j)]) / (ago[at(j)] - ago[at(i)]);
      x += weight * x_[at(i)];
    }
    return x;
  }

  template <class Archive>
  void archive(Archive& a) {
    a("extrapolation.known", known_);
    a("extrapolation.x0", x_[0]);
    a("extrapolation.x1", x_[1]);
    a("extrapolation.x2", x_[2]);
    a("extrapolation.step0", step_[0]);
    a("extrapolation.step1", step_[1]);
  }

 private:
  static constexpr int depth = 3;
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::array<Points<3>, depth> x_;  // newest first
  std::array<double, 2> step_{};    // [s] x_[i] was reached step_[i] after x_[i + 1]
  int known_ = 0;
};

}  // namespace tunica::coupling
