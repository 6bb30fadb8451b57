// SPDX-License-Identifier: MIT
// The truth of the phantom: nearest point of its surface and volume of its lumen between the ports.
#pragma once

#include "tunica/image/phantom.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>

namespace tunica::image {

struct [[nodiscard]] SurfacePoint {
  Vec3 point;       // on the surface [mm]
  double distance;  // signed, negative inside [mm]
};

/// The point of the level's zero nearest to x, for x closer to it than its radii of curvature:
/// Newton steps to the surface, each followed by a slide along it toward the foot of x.
template <class Level>
[[nodiscard]] SurfacePoint nearest_on_surface(const Level& f, const Vec3& x) {
  Vec3 p = x;
  for (int n = 0; n < 60; ++n) {
    const LevelJet l = f.level(p);
    const Vec3 to = l.value / l.gradient.squaredNorm() * l.gradient;
    const Vec3 normal = l.gradient.normalized(), off = x - p + to;
    const Vec3 slide = off - off.dot(normal) * normal;
    const Vec3 move = -to + (n > 0 ? 0.7 : 0.0) * slide;
    p += move;
    if (move.squaredNorm() < 1e-26) break;
  }
  const LevelJet at = f.level(p);
  return {p, (x - p).dot(at.gradient.normalized())};
}

namespace detail {

/// Abscissae and weights of Gauss-Legendre with 8 points on [0, 1] [ABRAMOWITZ64, 25.4.30].
struct Gauss8 {
  static constexpr std::array<double, 4> x{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
  static constexpr std::array<double, 4> w{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                           0.1012285362903763};
  template <class F>
  [[nodiscard]] static double integrate(F f, double a, double b, int panels) {
    double sum = 0;
    const double h = (b - a) / panels;
    for (int p = 0; p < panels; ++p)
      for (std::size_t i = 0; i < 4; ++i) {
        const double middle = a + (p + 0.5) * h, d = 0.5 * h * x[i];
        sum += 0.5 * h * w[i] * (f(middle - d) + f(middle + d));
      }
    return sum;
  }
};

/// Length of the ray c + rho e (e a unit vector) inside the level, at most `most`.
template <class Level>
[[nodiscard]] double ray_inside(const Level& f, const Vec3& c, const Vec3& e, double most) {
  if (f.level(c + most * e).value <= 0) return most;
  double lo = 0, hi = most, rho = 0.5 * most;
  for (int n = 0; n < 80 && hi - lo > 1e-13 * most; ++n) {
    const LevelJet l = f.level(c + rho * e);
    (l.value <= 0 ? lo : hi) = rho;
    const double newton = rho - l.value / l.gradient.dot(e);
    if (std::abs(newton - rho) < 1e-13 * most) break;
    rho = newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
  }
  return rho;
}

}  // namespace detail

/// Volume [mm3] of the lumen behind its three ports, by quadrature: `panels` of 8 Gauss points along
/// each stretch and 60 times as many rays around. Sections turn from the plane of constant y, used
/// through the bifurcation, to the plane of the port.
[[nodiscard]] inline double lumen_volume(const Phantom& phantom, int panels = 4) {
  constexpr double above = 147, below = 122;           // [mm]: one lumen above, two below
  constexpr double aorta_reach = 12, iliac_reach = 7;  // [mm]: beyond the wall, short of the other iliac
  const double pi = std::acos(-1.0);
  const int rays = 60 * panels;
  // Sections through the axis of a vessel with normal n(t); dV = (n.c' - u.n') dA dt.
  const auto stretch = [&](int vessel, double from, double to, const Vec3& n0, const Vec3& n1, double reach) {
    return detail::Gauss8::integrate(
        [&](double t) {
          const auto at = phantom.axis(vessel, from + t * (to - from));
          const Vec3 speed = at.direction * (std::abs(to - from) / std::abs(at.direction[1]));
          const Vec3 n = n0 + t * (n1 - n0), dn = n1 - n0;  // not of unit length: dA / |n| below
          const Vec3 e1 = n.cross(Vec3::UnitZ()).normalized(), e2 = n.cross(e1).normalized();
          double sum = 0;
          for (int r = 0; r < rays; ++r) {
            const double angle = 2 * pi * r / rays;
            const Vec3 e = std::cos(angle) * e1 + std::sin(angle) * e2;
            const double rho = detail::ray_inside(phantom, at.centre, e, reach);
            sum += n.dot(speed) * rho * rho / 2 - e.dot(dn) * rho * rho * rho / 3;
          }
          return sum * 2 * pi / rays / n.norm();
        },
        0, 1, panels);
  };
  // Sections of constant y, each vessel up to the middle between the two axes.
  const auto half = [&](int vessel) {
    return detail::Gauss8::integrate(
        [&](double y) {
          const Vec3 c = phantom.axis(vessel, y).centre, other = phantom.axis(1 - vessel, y).centre;
          double sum = 0;
          for (int r = 0; r < 8 * rays; ++r) {
            const double angle = 2 * pi * (r + 0.5) / (8 * rays);
            const Vec3 e(std::cos(angle), 0, std::sin(angle));
            const double gap = (other - c)[0] / 2, toward = e[0] * (vessel == 0 ? 1 : -1);
            const double most = toward * aorta_reach > std::abs(gap) ? std::abs(gap) / toward : aorta_reach;
            const double rho = detail::ray_inside(phantom, c, e, most);
            sum += rho * rho / 2;
          }
          return sum * 2 * pi / (8 * rays);
        },
        below, above, 6 * panels);
  };
  const auto ports = Phantom::ports();
  const Vec3 down = -Vec3::UnitY();
  return stretch(0, Phantom::inlet_y, above, -ports[0].normal, down, aorta_reach) + half(0) + half(1) +
         stretch(0, below, Phantom::outlet_y, down, ports[1].normal, iliac_reach) +
         stretch(1, below, Phantom::outlet_y, down, ports[2].normal, iliac_reach);
}

}  // namespace tunica::image
