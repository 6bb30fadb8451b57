// SPDX-License-Identifier: MIT
// The incompressible tube of two fibre-reinforced layers at a given axial stretch: its pressure by
// quadrature.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tunica::test {

/// W = c/2 (I1 - 3) + sum over two families of k1/(2 k2) (exp(k2 (I4 - 1)^2) - 1), fibres in tension only, at
/// +-angle from the circumference   [HGO00, sec. 5]. Lengths in m, moduli in Pa.
struct FibreLayer {
  double inner, outer, c, k1, k2, degrees;

  /// l dW/dl at circumferential stretch l and axial stretch z, the radial one being 1/(l z).
  [[nodiscard]] double hoop(double l, double z) const {
    const double angle = degrees * std::numbers::pi / 180, cc = std::cos(angle) * std::cos(angle);
    const double E = l * l * cc + z * z * (1 - cc) - 1;
    const double fibres = E > 0 ? 4 * k1 * E * std::exp(k2 * E * E) * l * l * cc : 0;
    return c * (l * l - 1 / (l * l * z * z)) + fibres;
  }
};

struct LayeredTube {
  std::array<FibreLayer, 2> layers{
      {{.inner = 0.71e-3, .outer = 0.97e-3, .c = 3.0e3, .k1 = 2363.2, .k2 = 0.8393, .degrees = 29},
       {.inner = 0.97e-3, .outer = 1.10e-3, .c = 0.3e3, .k1 = 562.0, .k2 = 0.7112, .degrees = 62}}};

  /// p = int (s_tt - s_rr)/r dr by Simpson's rule, r^2 = r_i^2 + (R^2 - R_i^2)/z.
  [[nodiscard]] double pressure(double inner_radius, double z) const {
    double p = 0;
    for (const auto& layer : layers) {
      constexpr int n = 400;
      const double h = (layer.outer - layer.inner) / n;
      for (int k = 0; k <= n; ++k) {
        const double R = layer.inner + h * k, Ri = layers[0].inner;
        const double r = std::sqrt(inner_radius * inner_radius + (R * R - Ri * Ri) / z);
        // dr = R/(z r) dR
        p += (k == 0 || k == n ? 1 : k % 2 ? 4 : 2) * h / 3 * layer.hoop(r / R, z) / r * R / (z * r);
      }
    }
    return p;
  }
};

}  // namespace tunica::test
