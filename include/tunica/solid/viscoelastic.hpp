// SPDX-License-Identifier: MIT
// Viscoelastic: a Prony series on the isochoric stress of any law, with the update of [SIMO87] in one step.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/unroll.hpp"
#include "tunica/solid/fibres.hpp"
#include "tunica/solid/isochoric_part.hpp"
#include "tunica/solid/parameters.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace tunica::solid {

/// A branch: at first it adds `ratio` times the stress of the law, and forgets it in the time `time`.
struct Prony {
  double ratio;  // [-], not negative
  double time;   // [s], positive; infinite: nothing is forgotten
};

/// S = S_law + J^-2/3 DEV[sum_i h_i],  dh_i/dt + h_i/time_i = ratio_i d/dt(J^2/3 S_law),  h_i = 0 at first,
/// with the second Piola-Kirchhoff stress S, deviatoric against C at each time. The law inside gives the
/// stress after infinite time; at once it is 1 + sum ratio_i times as stiff. The update is exact where S_law
/// is linear in time over a step, of second order else, and stable for every dt:
///   h <- e^-x h + ratio (1 - e^-x)/x (increment of J^2/3 S_law),  x = dt/time.
/// The ratios are of the stress after infinite time: their sum has no bound. InputError names a branch with
/// another ratio or time.
/// A point holds what the law's holds, then that stress and the h_i at the start of the step. Isochoric: it
/// stands where an isochoric law does,
///   Hyperelastic{Viscoelastic{yeoh, std::array{Prony{.ratio = 0.3, .time = 0.1}}}, Quadratic{...}}.
/// Of each time step: begin_step(law, dt), then any number of responses, then point = advance(law, F, point).
template <class Law, std::size_t Terms>
class Viscoelastic {
 public:
  static constexpr std::size_t own = point_size<Law>;
  template <class S>
  struct Point {
    std::array<S, own + 6 * (Terms + 1)> m{};
    /// Those of the law stand first, as in Fibres.
    static constexpr std::size_t families = fibre_families<PointOf<Law, S>>;
    [[nodiscard]] Vector3<S> operator[](std::size_t family) const {
      return {m[3 * family], m[3 * family + 1], m[3 * family + 2]};
    }
    void set(std::size_t family, const Vector3<S>& direction) {
      for (std::size_t k = 0; k < 3; ++k) m[3 * family + k] = direction[k];
    }
  };

  Viscoelastic(const Law& law, const std::array<Prony, Terms>& terms) : law_(law), terms_(terms) {
    check();
    begin_step(0);
  }
  void check() const {
    check_parameters(law_);
    for (std::size_t i = 0; i < Terms; ++i) {
      const std::string branch = "branch " + std::to_string(i + 1);
      require_not_negative("Viscoelastic", (branch + ", ratio").c_str(), terms_[i].ratio);
      require_parameter(terms_[i].time > 0, "Viscoelastic", (branch + ", time").c_str(), terms_[i].time,
                        "expected a time above 0");
    }
  }

  /// The law that is left when all is forgotten.
  [[nodiscard]] const Law& law() const { return law_; }

  /// The length of the step that follows [s]; 0 is a jump, which finds the stiffness of the first moment.
  void begin_step(double dt) {
    TUNICA_EXPECT(dt >= 0, "time does not run backwards");
    gain_ = 1;
    for (std::size_t i = 0; i < Terms; ++i) {
      const double x = std::isinf(terms_[i].time) ? 0 : dt / terms_[i].time;  // also after for ever
      decay_[i] = std::exp(-x);
      share_[i] = terms_[i].ratio * (x > 0 ? -std::expm1(-x) / x : 1);
      gain_ += share_[i];
    }
  }

  /// A point at rest, with the fibres (or what else the law asks for) of `data`.
  [[nodiscard]] static Point<double> at_rest(const PointOf<Law, double>& data = {}) {
    Point<double> p;
    for (std::size_t k = 0; k < own; ++k) p.m[k] = data.m[k];
    return p;
  }

  /// The potential of this step, of which stress is the derivative; not an energy that is stored.
  template <class S>
  [[nodiscard]] S energy(const Tensor<S>& F, const Point<S>& point) const {
    const Tensor<S> H = history(point);
    const S root = detail::cube_root(determinant(F));
    return S(gain_) * solid::energy(law_, F, inner(point)) +
           S(0.5) * (double_dot(F, product(F, H)) / (root * root) - trace(H));
  }
  template <class S>
  [[nodiscard]] Tensor<S> stress(const Tensor<S>& F, const Point<S>& point) const {
    const Carried<S> c(F, history(point));
    return S(gain_) * solid::stress(law_, F, inner(point)) + c.B - (S(1. / 3) * c.q) * c.g;
  }
  template <class S>
  [[nodiscard]] Response<S> response(const Tensor<S>& F, const Point<S>& point) const {
    const Carried<S> c(F, history(point));
    Response<S> r = solid::response(law_, F, inner(point));
    const S third = S(1. / 3) * c.q;
    Tensor<S> Y;
    for (std::size_t p = 0; p < 9; ++p) {
      r.P.m[p] = S(gain_) * r.P.m[p] + c.B.m[p] - third * c.g.m[p];
      Y.m[p] = S(1. / 3) * third * c.g.m[p] - S(2. / 3) * c.B.m[p];
    }
    TUNICA_UNROLL
    for (std::size_t p = 0; p < 9; ++p) {
      TUNICA_UNROLL
      for (std::size_t q = 0; q < 9; ++q) {
        const std::size_t i = p / 3, J = p % 3, k = q / 3, L = q % 3;
        S A = c.g.m[p] * Y.m[q] + Y.m[p] * c.g.m[q] + third * c.g.m[3 * i + L] * c.g.m[3 * k + J];
        if (i == k) A += c.sH.m[3 * J + L];
        r.A[9 * p + q] = S(gain_) * r.A[9 * p + q] + A;
      }
    }
    return r;
  }

  /// The point at the end of a step that went to F.
  template <class S>
  [[nodiscard]] Point<S> advance(const Tensor<S>& F, const Point<S>& point) const {
    const S root = detail::cube_root(determinant(F));
    const Tensor<S> T = (root * root) * product(inverse(F), solid::stress(law_, F, inner(point)));
    Point<S> next = point;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = pairs[k];
      const S now = S(0.5) * (T(i, j) + T(j, i)), rise = now - point.m[own + k];
      next.m[own + k] = now;
      for (std::size_t n = 0; n < Terms; ++n) {
        S& h = next.m[own + 6 * (n + 1) + k];
        h = S(decay_[n]) * h + S(share_[n]) * rise;
      }
    }
    return next;
  }

 private:
  static constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

  template <class S>
  [[nodiscard]] static PointOf<Law, S> inner(const Point<S>& point) {
    PointOf<Law, S> p{};
    for (std::size_t k = 0; k < own; ++k) p.m[k] = point.m[k];
    return p;
  }

  /// What of sum h_i at the end of the step is known at its start.
  template <class S>
  [[nodiscard]] Tensor<S> history(const Point<S>& point) const {
    Tensor<S> H;
    for (std::size_t k = 0; k < 6; ++k) {
      S sum = S(1 - gain_) * point.m[own + k];
      for (std::size_t n = 0; n < Terms; ++n) sum += S(decay_[n]) * point.m[own + 6 * (n + 1) + k];
      const auto [i, j] = pairs[k];
      H(i, j) = H(j, i) = sum;
    }
    return H;
  }

  /// Of the potential 1/2 J^-2/3 H : C, with s = J^-2/3.
  template <class S>
  struct Carried {
    Tensor<S> g, sH, B;  // F^-T, s H, s F H
    S q;                 // s H : C

    Carried(const Tensor<S>& F, const Tensor<S>& H) : g(cofactor(F)) {
      const S J = F.m[0] * g.m[0] + F.m[1] * g.m[1] + F.m[2] * g.m[2], root = detail::cube_root(J);
      g *= S(1) / J;
      sH = (S(1) / (root * root)) * H;
      B = product(F, sH);
      q = double_dot(F, B);
    }
  };

  Law law_;
  std::array<Prony, Terms> terms_;
  double gain_ = 1;
  std::array<double, Terms> decay_{}, share_{};
};

}  // namespace tunica::solid
