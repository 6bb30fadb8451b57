// SPDX-License-Identifier: MIT
// IQN-ILS: the inverse of the interface Jacobian by least squares on differences of iterations, with
// reuse of earlier steps and the QR2 filter. [DEGROOTE09; HAELTERMAN16]
#pragma once

#include "tunica/core/types.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tunica::coupling {

struct IqnIlsOptions {
  int reuse = 8;            // converged time steps whose differences are kept
  double filter = 1e-2;     // [-] a difference that adds less than this of itself is dropped (QR2)
  double relaxation = 0.1;  // [-] of an iteration that has no difference to use
  int patience = 6;         // iterations without a better residual before the reused ones are dropped
};

/// With x~ = x + r: V = [r^k - r^{k-1} ...], W = [x~^k - x~^{k-1} ...], newest first,
///   c = argmin |V c + r|,  x^{k+1} = x~^k + W c.
/// Zero columns, dependent columns and a stall never end the iteration: they are dropped.
class IqnIls {
 public:
  explicit IqnIls(IqnIlsOptions options = {}) : options_(options) {}

  /// Opens a time step. The Jacobian goes with dt^2, so differences of another dt are dropped.
  void begin(double dt) {
    if (dt != dt_)
      forget(columns());
    else
      forget(columns() - sum(per_step_));  // what a failed step left behind
    dt_ = dt;
    last_r_.resize(0);
    waited_ = 0;
    fresh_ = 0;
  }

  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& r) {
    const Eigen::VectorXd image = x + r;  // x~
    if (V_.rows() != r.size()) forget(columns());
    if (last_r_.size() == r.size()) learn(r - last_r_, image - last_image_, r.norm());
    watch(r.norm());
    last_r_ = r;
    last_image_ = image;
    if (columns() == 0) return x + options_.relaxation * r;
    const Eigen::VectorXd guess = solve(r, image);
    // The guess of before once more would give the residual of before once more, for ever.
    if (!((guess - x).norm() > stall * r.norm())) return x + options_.relaxation * r;
    return guess;
  }

  /// Closes a converged step: its differences become the newest of the reused ones.
  void accept() {
    per_step_.push_back(fresh_);
    fresh_ = 0;
    while (static_cast<int>(per_step_.size()) > options_.reuse) {
      drop_oldest(per_step_.front());
      per_step_.erase(per_step_.begin());
    }
    last_r_.resize(0);
  }

  /// Number of differences in use.
  [[nodiscard]] Index columns() const { return static_cast<Index>(V_.cols()); }

  template <class Archive>
  void archive(Archive& a) {
    a("iqn_ils.V", V_);
    a("iqn_ils.W", W_);
    a("iqn_ils.per_step", per_step_);
    a("iqn_ils.dt", dt_);
  }

 private:
  static constexpr double nothing = 1e-14;  // |v| / |r| of a difference that is round-off
  static constexpr double stall = 1e-10;    // |x^{k+1} - x^k| / |r| of an iteration that stands still

  static Index sum(const std::vector<Index>& counts) {
    Index n = 0;
    for (const Index c : counts) n += c;
    return n;
  }

  /// Keeps a difference as the newest column, the last one.
  void learn(const Eigen::VectorXd& v, const Eigen::VectorXd& w, double scale) {
    if (!(v.norm() > nothing * scale)) return;  // a zero column would make V singular; NaN as well
    const Eigen::Index n = V_.cols();
    V_.conservativeResize(v.size(), n + 1);
    W_.conservativeResize(w.size(), n + 1);
    V_.col(n) = v;
    W_.col(n) = w;
    ++fresh_;
  }

  /// Drops the reused differences when they do not help any more.
  void watch(double norm) {
    if (last_r_.size() == 0 || norm < best_) {
      best_ = norm;
      waited_ = 0;
    } else if (++waited_ >= options_.patience) {
      drop_oldest(columns() - fresh_);
      per_step_.clear();
      waited_ = 0;
    }
  }

  /// x~ + W c by Gram-Schmidt from the newest column to the oldest; filtered columns leave V and W.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& r, const Eigen::VectorXd& image) {
    const Eigen::Index most = std::min<Eigen::Index>(V_.cols(), V_.rows());
    Eigen::MatrixXd Q(V_.rows(), most), R = Eigen::MatrixXd::Zero(most, most);
    std::vector<Index> kept, filtered;  // newest first
    for (Index j = columns() - 1; j >= 0; --j) {
      const auto m = static_cast<Eigen::Index>(kept.size());
      if (m == most) {
        filtered.push_back(j);
        continue;
      }
      Eigen::VectorXd q = V_.col(j);
      const double length = q.norm();
      Eigen::VectorXd h = Eigen::VectorXd::Zero(m);
      for (int pass = 0; pass < 2; ++pass) {  // twice is enough for orthogonality to round-off
        const Eigen::VectorXd part = Q.leftCols(m).transpose() * q;
        q -= Q.leftCols(m) * part;
        h += part;
      }
      if (!(q.norm() > options_.filter * length)) {
        filtered.push_back(j);
        continue;
      }
      R.col(m).head(m) = h;
      R(m, m) = q.norm();
      Q.col(m) = q / R(m, m);
      kept.push_back(j);
    }
    const auto m = static_cast<Eigen::Index>(kept.size());
    Eigen::VectorXd c = -(Q.leftCols(m).transpose() * r);  // R c = -Q^T r
    R.topLeftCorner(m, m).triangularView<Eigen::Upper>().solveInPlace(c);
    Eigen::VectorXd guess = image;
    for (Eigen::Index i = 0; i < m; ++i) guess += c[i] * W_.col(kept[static_cast<std::size_t>(i)]);
    for (const Index j : filtered) erase(j);  // newest first: the numbers of older ones stay
    return guess;
  }

  /// Removes one column and its count; column 0 is the oldest.
  void erase(Index j) {
    const Eigen::Index behind = V_.cols() - 1 - j;
    V_.middleCols(j, behind) = V_.rightCols(behind).eval();
    W_.middleCols(j, behind) = W_.rightCols(behind).eval();
    V_.conservativeResize(Eigen::NoChange, V_.cols() - 1);
    W_.conservativeResize(Eigen::NoChange, W_.cols() - 1);
    Index end = 0;
    for (Index& count : per_step_) {
      end += count;
      if (j >= end) continue;
      --count;
      return;
    }
    --fresh_;
  }

  void drop_oldest(Index n) {
    if (n <= 0) return;
    V_ = V_.rightCols(V_.cols() - n).eval();
    W_ = W_.rightCols(W_.cols() - n).eval();
  }

  /// Drops the n newest columns; with all of them the counts go as well.
  void forget(Index n) {
    if (n == columns()) per_step_.clear();
    V_ = V_.leftCols(V_.cols() - n).eval();
    W_ = W_.leftCols(W_.cols() - n).eval();
    fresh_ = 0;
  }

  IqnIlsOptions options_;
  Eigen::MatrixXd V_, W_;        // n x columns, oldest first
  std::vector<Index> per_step_;  // columns of each reused step, oldest first
  Index fresh_ = 0;              // columns of the open step
  double dt_ = 0;                // [s] of the columns
  Eigen::VectorXd last_r_, last_image_;
  double best_ = 0;  // least |r| of the open step
  int waited_ = 0;
};

}  // namespace tunica::coupling
