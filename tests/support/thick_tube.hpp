// SPDX-License-Identifier: MIT
// The incompressible thick tube in plane strain under law (17): closed form and its own quadrature.
#pragma once

#include <algorithm>
#include <cmath>

namespace tunica::test {

/// p = int 2 Phi'(I1) (l^2 - l^-2)/(l (l^2 - 1)) dl from l_o to l_i, I1 = l^2 + l^-2 + 1.
struct ThickTube {
  double inner = 5e-3, outer = 6.5e-3;  // [m]
  double c10 = 174e3, c20 = 1880e3;     // [Pa]

  double outer_stretch(double l) const {
    return std::sqrt(l * l * inner * inner + outer * outer - inner * inner) / outer;
  }
  /// p = 2 c10 [ln l - 1/(2 l^2)] + 4 c20 [l^2/2 - ln l + 1/(2 l^2) - 1/(4 l^4)]
  double pressure(double inner_stretch) const {
    const auto primitive = [&](double l) {
      const double s = l * l;
      return 2 * c10 * (std::log(l) - 0.5 / s) + 4 * c20 * (0.5 * s - std::log(l) + 0.5 / s - 0.25 / (s * s));
    };
    return primitive(inner_stretch) - primitive(outer_stretch(inner_stretch));
  }
  /// The same by quadrature in the radius: p = int (s_tt - s_rr)/r dr, with Simpson's rule.
  double pressure_by_quadrature(double inner_stretch) const {
    const int n = 2000;
    const double a = inner_stretch * inner, b = outer_stretch(inner_stretch) * outer;
    const auto integrand = [&](double r) {
      const double R = std::sqrt(r * r - a * a + inner * inner), l = r / R, s = l * l;
      return 2 * (c10 + 2 * c20 * (s + 1 / s - 2)) * (s - 1 / s) / r;
    };
    double sum = 0;
    for (int k = 0; k <= n; ++k)
      sum += (k == 0 || k == n ? 1 : k % 2 ? 4 : 2) * integrand(a + (b - a) * k / n);
    return sum * (b - a) / (3 * n);
  }
  /// Cauchy stresses at the deformed radius r for an inner stretch [Pa]: s_rr = -p of what lies outside r,
  /// s_tt = s_rr + 2 W1 (l^2 - l^-2) and s_zz = s_rr + 2 W1 (1 - l^-2) with W1 = dPhi/dI1.
  struct Stress {
    double rr, tt, zz;
  };
  Stress stress_at(double r, double inner_stretch) const {
    const double a = inner_stretch * inner, R = std::sqrt(r * r - a * a + inner * inner), l = r / R,
                 s = l * l;
    const double rr = -ThickTube{.inner = R, .outer = outer, .c10 = c10, .c20 = c20}.pressure(l);
    const double two_W1 = 2 * (c10 + 2 * c20 * (s + 1 / s - 2));
    return {rr, rr + two_W1 * (s - 1 / s), rr + two_W1 * (1 - 1 / s)};
  }
  /// The inner stretch at a pressure, by bisection.
  double stretch(double p) const {
    double low = 1, high = 3;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (pressure(middle) < p ? low : high) = middle;
    }
    return low;
  }
};

}  // namespace tunica::test
