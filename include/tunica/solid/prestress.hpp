// SPDX-License-Identifier: MIT
// Prestress of an imaged shape that carries its load already: modified updated Lagrange (MULF) [GEE10]; what
// drift is left settles by Anderson's acceleration [WALKER11, section 1].
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/solid/history.hpp"
#include "tunica/solid/statics.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::solid {

struct PrestressOptions {
  int steps = 20;          // of the load; drift and residual after them fall with 1/steps
  double residual = 1e-6;  // of the image itself: above it the drift is stored too, again and again
  int settlings = 60;      // how often at most; none with residual = 1
};

struct [[nodiscard]] PrestressReport {
  SolveReport solve{};       // iterations: in all; status: of the last step
  double load = 0;           // reached factor of the loads: 1 if it converged
  int steps = 0, cuts = 0;   // that held; halved by Statics
  int settlings = 0;         // drifts stored after them
  Index inverted_cell = -1;  // where J <= 0 in the last failed step, -1 if nowhere
  double residual = 0;       // |r| / scale of the imaged shape itself under the whole load
  double drift = 0;          // max |u| of the equilibrium next to it [m]

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(solve); }
};

namespace detail {

/// What to store so that the drift vanishes. To store the drift u itself leaves K_geo K^-1 of it, which is
/// slow where stress holds a soft wall; the changes seen so far tell more [WALKER11, (1.1)].
class Settling {
 public:
  /// `drift` is u after what was told last has been stored, 3 nodes [m].
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& drift) {
    if (drift_.size() > 0) {
      if (changes_.size() == window) changes_.erase(changes_.begin());
      changes_.push_back({drift - drift_, stored_ + drift - drift_});
    }
    drift_ = drift;
    // u - sum c q is least; with the same c the sum of what had been stored, and has drifted, goes off.
    Eigen::VectorXd left = drift, off = Eigen::VectorXd::Zero(drift.size());
    std::vector<Change> basis;  // newest first: the oldest are dropped where they tell nothing new
    for (auto change = changes_.rbegin(); change != changes_.rend(); ++change) {
      Change next = *change;
      const double size = next.drift.norm();
      for (const Change& b : basis) {
        const double c = b.drift.dot(next.drift);
        next.drift -= c * b.drift;
        next.stored -= c * b.stored;
      }
      const double fresh = next.drift.norm();
      if (!(fresh > smallest_angle * size)) continue;
      next.drift /= fresh;
      next.stored /= fresh;
      const double c = next.drift.dot(left);
      left -= c * next.drift;
      off += c * next.stored;
      basis.push_back(std::move(next));
    }
    const double reach = longest * drift.norm(), length = off.norm();
    stored_ = drift - (length > reach ? reach / length : 1.0) * off;
    return stored_;
  }
  [[nodiscard]] bool learnt() const { return !changes_.empty(); }

 private:
  static constexpr std::size_t window = 10;       // changes that are kept
  static constexpr double smallest_angle = 1e-6;  // of a change to those kept already
  static constexpr double longest = 5;            // times the drift: what is learnt holds nearby

  struct Change {
    Eigen::VectorXd drift, stored;
  };
  std::vector<Change> changes_;
  Eigen::VectorXd drift_, stored_;
};

/// No force to balance, and nothing moved or stored.
template <class Wall>
[[nodiscard]] bool idle(const Wall& wall) {
  return wall.body().laws().prestress().empty() && (wall.unknowns().array() == 0).all() &&
         (wall.external(wall.unknowns(), 1).array() == 0).all();
}

template <class Wall>
[[nodiscard]] PrestressReport balanced_image(Wall& wall, const PrestressOptions& options) {
  PrestressReport report;
  if (idle(wall)) {
    wall.absorb();
    wall.accept(wall.unknowns(), 1);
    report.solve.status = Status::converged;
    report.load = 1;
    return report;
  }
  for (int left = options.steps; left > 0; --left) {
    const double limit = 1.0 / left;  // of what is left of the load
    while (wall.load() < limit) {
      const StaticsStep step = wall.step(limit);
      report.solve.iterations += step.iterations;
      report.solve.status = step.solve.status;
      report.solve.residual = step.solve.residual;
      report.cuts += step.cuts;
      report.inverted_cell = step.inverted_cell;
      if (!step) return report;
    }
    wall.absorb();
    ++report.steps;
    report.load = static_cast<double>(report.steps) / options.steps;
  }
  const Eigen::Index moved = 3 * wall.body().mesh().node_count();
  Settling settling;
  auto before = wall.body().laws().prestress();
  Eigen::VectorXd drift;
  while (true) {
    Eigen::VectorXd r;
    const auto info = wall.residual(wall.unknowns(), 1, r, la::no_step);
    report.residual = r.norm() > info.rounding ? r.norm() / info.scale : 0;
    const StaticsReport free = wall.solve();
    report.solve.iterations += free.solve.iterations;
    report.solve.status = free.solve.status;
    report.solve.residual = free.solve.residual;
    if (free) {
      report.drift = wall.displacement().colwise().norm().maxCoeff();
      if (report.residual <= options.residual) return report;
      if (report.settlings == options.settlings) break;
      drift = wall.unknowns();
      before = wall.body().laws().prestress();
      Eigen::VectorXd store = drift;  // with pressures of nodes as they are
      store.head(moved) = settling.next(drift.head(moved));
      wall.accept(store, 1);
    } else {  // too far: the drift alone after all
      if (!settling.learnt() || report.settlings == options.settlings) return report;
      settling = {};
      wall.laws().prestress(before);
      wall.accept(drift, 1);
    }
    wall.absorb();
    ++report.settlings;
  }
  report.solve.status = Status::max_iterations;
  return report;
}

}  // namespace detail

/// `wall` is composed on the mesh of the imaged shape, with the loads that act there as end values. Raises
/// them in steps and stores the deformation of each, so that the mesh stays the image and its stresses
/// balance the loads; then stores what drift is left, learning from each time what the next has to store. The
/// wall is left in the equilibrium next to the image, `drift` away: what follows starts there;
/// wall.body().laws().prestress() is what a Dynamics on the same mesh takes. The stresses are one equilibrium
/// of the image; those of a body that was loaded from a shape free of stress (unloaded_shape) are another.
/// Laws with a history have carried these stresses for ever: the wall is as stiff as after infinite time, and
/// remembers that. A Dynamics then takes both:
///   moving.laws().prestress(wall.body().laws().prestress());
///   remember(moving.laws(), remembered(wall.laws()));  moving.start(wall.displacement(), v);
template <class Wall>
[[nodiscard]] PrestressReport prestress(Wall& wall, const PrestressOptions& options = {}) {
  using Body = std::remove_cvref_t<decltype(wall.body())>;
  using Locking = typename Body::Form::Locking;
  static_assert(!std::is_same_v<Locking, FBar> && !std::is_same_v<Locking, CentreVolume>,
                "F-bar takes no prestress: it knows F at the centre of the unstressed cell alone");
  TUNICA_EXPECT(options.steps > 0, "the load is raised in steps");
  for (Index k = 0; k < wall.body().unknowns(); ++k)
    TUNICA_EXPECT(wall.prescribed(k) == 0,
                  "an image has its prescribed displacements already: fix them there");
  if constexpr (has_history<Body>) begin_step(wall.laws(), std::numeric_limits<double>::infinity());
  const PrestressReport report = detail::balanced_image(wall, options);
  if constexpr (has_history<Body>) advance(wall.laws(), wall.body(), wall.unknowns());
  return report;
}

}  // namespace tunica::solid
