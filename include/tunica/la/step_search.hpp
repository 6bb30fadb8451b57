// SPDX-License-Identifier: MIT
// How much of a step to take: up to where the residual does no more work along it [MATTHIES79].
#pragma once

#include <algorithm>
#include <cmath>

namespace tunica::la {

/// g(s) = dx . r(x + s dx), the slope of the energy along a step where r is the slope of one: g(0) < 0 goes
/// down, and a g(1) above -g(0) tells of a rise on the far side. Such a step ends near the root of g, found
/// by the regula falsi of which the end that stays is halved in weight.
class StepSearch {
 public:
  explicit StepSearch(double start) : start_(start), g_low_(start) {}

  /// Whether the step goes down at all; if not there is nothing to search for.
  [[nodiscard]] bool goes_down() const { return start_ < 0; }
  /// Whether s, with that g, is to be taken: not beyond a rise, and once such a rise was seen near the root.
  [[nodiscard]] bool takes(double g) const {
    return high_ > 0 ? std::abs(g) <= close * -start_ : g <= -start_;
  }
  /// The next s to be tried after one whose g (NaN or infinite where there is none) was not taken.
  [[nodiscard]] double next(double s, double g) {
    const bool usable = std::isfinite(g);
    if (usable && g < 0) {
      low_ = s;
      g_low_ = g;
      if (last_low_ && high_ > 0) g_high_ *= 0.5;
      last_low_ = true;
    } else {
      if (!last_low_ && high_ > 0) g_low_ *= 0.5;
      high_ = s;
      g_high_ = usable ? g : far * -start_;
      last_low_ = false;
    }
    const double root = (low_ * g_high_ - high_ * g_low_) / (g_high_ - g_low_),
                 margin = 0.05 * (high_ - low_);
    if (!usable) return low_ > 0 ? 0.5 * (low_ + high_) : 0.25 * high_;
    return std::clamp(root, low_ + margin, high_ - margin);
  }
  /// The longest step seen that still went down, 0 if there was none.
  [[nodiscard]] double safe() const { return low_; }

 private:
  static constexpr double close = 0.5, far = 1e3;
  double start_, low_ = 0, g_low_, high_ = 0, g_high_ = 0;
  bool last_low_ = true;
};

}  // namespace tunica::la
