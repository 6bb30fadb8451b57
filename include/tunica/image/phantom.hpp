// SPDX-License-Identifier: MIT
// A bifurcation with aorto-iliac dimensions as an analytic MR-like field: its true surface is known.
// Two tubes of smooth axis and radius that share the aorta, joined by a smooth minimum.
#pragma once

#include "tunica/core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace tunica::image {

/// Where and by how much the slope of an axis changes: a softplus ramp, smooth to all orders.
struct Bend {
  double y, slope, width;  // [mm], [-], [mm]
};

/// x or z of an axis as a function of y: at y0 with a slope, then bent on the way to lower y.
struct AxisCurve {
  double at, y0, slope;  // [mm], [mm], change per mm of descent [-]
  std::array<Bend, 3> bends;

  struct Jet {
    double value, first, second;  // derivatives by y
  };
  [[nodiscard]] Jet operator()(double y) const {
    Jet f{at + slope * (y0 - y), -slope, 0};
    for (const Bend& b : bends) {
      const double t = (b.y - y) / b.width;  // b.slope * width * log(1 + e^t)
      const double ramp = t > 0 ? t + std::log1p(std::exp(-t)) : std::log1p(std::exp(t));
      const double s = 1 / (1 + std::exp(-t));
      f.value += b.slope * b.width * ramp;
      f.first -= b.slope * s;
      f.second += b.slope * s * (1 - s) / b.width;
    }
    return f;
  }
};

/// One end of the vessel: cut there, keeping what lies behind the plane.
struct Port {
  std::string name;
  Vec3 point, normal;  // [mm]; unit, outward
  double radius = 0;   // of the lumen at the cut [mm]
};

/// Signed level (negative inside, about the distance in mm near the surface) and its gradient.
struct LevelJet {
  double value;
  Vec3 gradient;
};

/// Aorta and common iliacs, in mm. The figures of axes and radii are those measured on a contrast MR
/// angiography: inlet radius 7.393 at y = 165, iliacs 4.138 and 3.910 at y = 95, flow divider at y = 131.
class Phantom {
 public:
  /// Intensities: `surface` on the wall, surface -+ amplitude far outside and inside, and
  /// amplitude/width per mm at the wall (the slope measured there is 100 per 0.19 mm).
  static constexpr double surface = 1300, amplitude = 1100, width = 2.09;  // [-], [-], [mm]

  /// MR-like intensity; inside is value >= surface.
  [[nodiscard]] double value(const Vec3& x) const {
    return surface - amplitude * std::tanh(level(x).value / width);
  }

  [[nodiscard]] Vec3 gradient(const Vec3& x) const {
    const LevelJet f = level(x);
    const double t = std::tanh(f.value / width);
    return -amplitude / width * (1 - t * t) * f.gradient;
  }

  /// The level whose zero is the true surface.
  [[nodiscard]] LevelJet level(const Vec3& x) const {
    const LevelJet a = tube(left_, x), b = tube(right_, x);
    // smin(a, b) = min(a, b) - max(k - |a - b|, 0)^3 / (6 k^2): twice differentiable
    const double overlap = std::max(blend - std::abs(a.value - b.value), 0.0) / blend;
    const double share = 0.5 * overlap * overlap;  // of the farther tube in the gradient
    const LevelJet &near = a.value < b.value ? a : b, &far = a.value < b.value ? b : a;
    return {near.value - blend / 6 * overlap * overlap * overlap,
            (1 - share) * near.gradient + share * far.gradient};
  }

  /// Centre and unit direction (toward lower y) of an axis; 0 leads to outlet1 (low x), 1 to outlet2.
  struct AxisPoint {
    Vec3 centre, direction;
  };
  [[nodiscard]] AxisPoint axis(int vessel, double y) const {
    const Tube& t = vessel == 0 ? left_ : right_;
    const auto x = t.x(y), z = t.z(y);
    return {{x.value, y, z.value}, -Vec3(x.first, 1, z.first).normalized()};
  }

  /// inlet, outlet1 (low x), outlet2 (high x); each plane is square to its axis.
  [[nodiscard]] static std::array<Port, 3> ports() {
    const Phantom p;
    const AxisPoint inlet = p.axis(0, inlet_y), one = p.axis(0, outlet_y), two = p.axis(1, outlet_y);
    return {Port{"inlet", inlet.centre, -inlet.direction, inlet_radius},
            Port{"outlet1", one.centre, one.direction, left_radius},
            Port{"outlet2", two.centre, two.direction, right_radius}};
  }

  static constexpr double inlet_y = 165, outlet_y = 95;                                     // [mm]
  static constexpr double inlet_radius = 7.393, left_radius = 4.138, right_radius = 3.910;  // [mm]
  static constexpr double blend = 2;  // k of the smooth minimum [mm]

 private:
  struct Tube {
    AxisCurve x, z;
    double radius;  // at the outlet [mm]
  };

  /// (d^2 - R^2) / (2 R), d the distance to the tangent of the axis at the same y.
  [[nodiscard]] static LevelJet tube(const Tube& t, const Vec3& p) {
    const auto x = t.x(p[1]), z = t.z(p[1]);
    const double u = p[0] - x.value, w = p[2] - z.value;
    const double q = u * x.first + w * z.first, n = 1 + x.first * x.first + z.first * z.first;
    const double dq = u * x.second + w * z.second - (n - 1);  // dq/dy
    const double dn = 2 * (x.first * x.second + z.first * z.second);
    const double d2 = u * u + w * w - q * q / n;
    const double s = 1 / (1 + std::exp((narrowing_y - p[1]) / narrowing_width));
    const double aorta = std::sqrt(blend * blend / 36 + inlet_radius * inlet_radius) - blend / 6;
    const double r = t.radius + (aorta - t.radius) * s;  // the two aortas joined have inlet_radius
    const double dr = (aorta - t.radius) * s * (1 - s) / narrowing_width;
    const Vec3 dd2(2 * (u - q * x.first / n), -2 * q - 2 * q * dq / n + q * q * dn / (n * n),
                   2 * (w - q * z.first / n));
    Vec3 g = dd2 / (2 * r);
    g[1] -= (d2 / (r * r) + 1) * dr / 2;
    return {(d2 - r * r) / (2 * r), g};
  }

  static constexpr double narrowing_y = 136.5, narrowing_width = 3.5;  // [mm]
  Tube left_{{221.567, inlet_y, 0, {{{142, -0.45, 1.5}, {129, 0.27, 1.5}, {110, -0.13, 1.5}}}},
             {22.215, inlet_y, 0.05, {{{142, 0.124, 1.5}, {112, 0.1, 1.5}, {112, 0, 1.5}}}},
             left_radius};
  Tube right_{{221.567, inlet_y, 0, {{{142, 0.4925, 1.5}, {129.5, -0.245, 1.5}, {111, 0.09, 1.5}}}},
              {22.215, inlet_y, 0.05, {{{142, -0.02, 1.5}, {126, 0.12, 1.5}, {112, 0.2, 1.5}}}},
              right_radius};
};

}  // namespace tunica::image
