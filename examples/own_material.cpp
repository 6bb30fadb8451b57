// SPDX-License-Identifier: MIT
// A law of one's own in ten lines of energy: a tube of it inflated, with quadratic Newton and the exact
// pressure.
#include "tunica/core/units.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/statics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

using namespace tunica;
using namespace tunica::literals;

/// Gent's law, of chains that end: Phi = -mu/2 m ln(1 - (I1 - 3)/m).
struct Gent {
  double mu;  // shear modulus [Pa]
  double m;   // the I1 - 3 that is never reached [-]
  static constexpr std::array reads{solid::Invariant::I1};
  template <class S>
  S energy(const std::array<S, 1>& I) const {
    using std::log;
    return S(-0.5 * mu * m) * log(S(1) - (I[0] - S(3)) / S(m));
  }
};

/// The exact pressure of an incompressible tube with inner stretch l: int 2 Phi' (k^2 - k^-2)/(k (k^2 - 1))
/// dk between the stretches outside and inside, by Simpson's rule.
double exact_pressure(const Gent& law, const meshing::Tube& shape, double l) {
  const double Ri = shape.inner_radius, Ro = Ri + shape.thickness;
  const double from = std::sqrt(l * l * Ri * Ri + Ro * Ro - Ri * Ri) / Ro;
  constexpr int panels = 200;
  double sum = 0;
  for (int n = 0; n <= panels; ++n) {
    const double k = from + (l - from) * n / panels, weight = n == 0 || n == panels ? 1 : n % 2 == 0 ? 2 : 4;
    const double slope = 0.5 * law.mu * law.m / (law.m - (k * k + 1 / (k * k) - 2));  // dPhi/dI1
    sum += weight * 2 * slope * (k * k + 1) / (k * k * k);
  }
  return sum * (l - from) / (3 * panels);
}

int main() {
  const meshing::Tube shape{.inner_radius = 5_mm, .thickness = 1.5_mm, .length = 1_mm, .cells = {4, 16, 1}};
  const auto ring = meshing::quarter_tube(shape);  // a quarter of a slice, in plane strain
  const Gent law{.mu = 60_kPa, .m = 2.5};

  solid::Statics wall{ring, solid::Hyperelastic{law, solid::Quadratic{.kappa = 60_MPa}}};
  wall.fix(ring.patch("ends"), solid::Axis::z);
  wall.fix(ring.patch("sym_x"), solid::Axis::x);
  wall.fix(ring.patch("sym_y"), solid::Axis::y);
  const auto lumen = wall.pressure(ring.patch("inner"), 0);

  const Index node = mesh::patch_nodes(ring.patch("inner")).front();
  double worst = 0, flattest = 9;
  for (const double exact : {1.1, 1.15, 1.2, 1.25, 1.3, 1.35, 1.4, 1.45, 1.5, 1.55, 1.6, 1.65}) {
    const double p = exact_pressure(law, shape, exact);
    wall.pressure(lumen, p);
    const auto report = wall.solve();
    if (!report) return std::printf("no equilibrium: %s\n", name(report.solve.status).data()), 1;
    const Points<3> u = wall.displacement();
    const double stretch = (ring.nodes.col(node) + u.col(node)).head<2>().norm() / shape.inner_radius;
    worst = std::max(worst, std::abs(stretch / exact - 1));
    std::printf("%8.3f kPa: inner stretch %.5f, exact %.5f; residuals", 1e-3 * p, stretch, exact);
    for (const double r : report.history) std::printf(" %.1e", r);

    // Near the solution r1 = C r0^2: started off by 1/128, 1/256, ... of the displacement, what one iteration
    // leaves falls twice as steeply as what it began with, down to rounding.
    double r0 = 0, r1 = 0, slope = 9;
    for (double off = 1.0 / 128; off > 1e-6; off /= 2) {
      wall.start((1 + off) * u);
      const auto shaken = wall.solve();
      if (!shaken || shaken.history.size() < 2 || shaken.history[1] < 10 * shaken.rounding) break;
      if (r0 > 0)
        slope = std::min(slope, std::log(shaken.history[1] / r1) / std::log(shaken.history[0] / r0));
      r0 = shaken.history[0] < 0.1 ? shaken.history[0] : 0;
      r1 = shaken.history[1];
    }
    flattest = std::min(flattest, slope);
    std::printf("; slope %.2f\n", slope);
  }
  return worst < 2e-3 && flattest >= 1.9 && flattest < 9 ? 0 : 1;
}
