// SPDX-License-Identifier: MIT
// Signs of determinants without error: orient2d, orient3d, insphere. A filter [SHEWCHUK97, table 3]
// decides nearly all, exact expansions the rest.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/expansion.hpp"

#include <array>
#include <cmath>

namespace tunica::meshing {

namespace detail {

// Error bounds relative to the permanent, eps = 2^-53 [SHEWCHUK97].
inline constexpr double eps = 0x1p-53;
inline constexpr double orient2d_bound = (3 + 16 * eps) * eps;
inline constexpr double orient3d_bound = (7 + 56 * eps) * eps;
inline constexpr double insphere_bound = (16 + 224 * eps) * eps;

template <class P>
[[nodiscard]] inline double orient2d_exact(const P& a, const P& b, const P& c) {
  const auto bx = difference(b[0], a[0]), by = difference(b[1], a[1]);
  const auto cx = difference(c[0], a[0]), cy = difference(c[1], a[1]);
  return (bx * cy - by * cx).estimate();
}

[[nodiscard]] inline double orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto bx = difference(b[0], a[0]), by = difference(b[1], a[1]), bz = difference(b[2], a[2]);
  const auto cx = difference(c[0], a[0]), cy = difference(c[1], a[1]), cz = difference(c[2], a[2]);
  const auto dx = difference(d[0], a[0]), dy = difference(d[1], a[1]), dz = difference(d[2], a[2]);
  const auto x = (by * cz - bz * cy) * dx, y = (bz * cx - bx * cz) * dy, z = (bx * cy - by * cx) * dz;
  return ((x + y) + z).estimate();
}

[[nodiscard]] inline double insphere_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                                           const Vec3& e) {
  const auto ax = difference(a[0], e[0]), ay = difference(a[1], e[1]), az = difference(a[2], e[2]);
  const auto bx = difference(b[0], e[0]), by = difference(b[1], e[1]), bz = difference(b[2], e[2]);
  const auto cx = difference(c[0], e[0]), cy = difference(c[1], e[1]), cz = difference(c[2], e[2]);
  const auto dx = difference(d[0], e[0]), dy = difference(d[1], e[1]), dz = difference(d[2], e[2]);
  const auto ab = ax * by - bx * ay, bc = bx * cy - cx * by, cd = cx * dy - dx * cy;
  const auto da = dx * ay - ax * dy, ac = ax * cy - cx * ay, bd = bx * dy - dx * by;
  const auto square = [](const auto& x, const auto& y, const auto& z) { return (x * x + y * y) + z * z; };
  // Cofactors of the lifted column, expanded along the last row of coordinates.
  const auto a_term = ((cd * bz - bd * cz) + bc * dz) * square(ax, ay, az);
  const auto b_term = ((da * cz + ac * dz) + cd * az) * square(bx, by, bz);
  const auto ab_terms = a_term - b_term;
  const auto c_term = ((ab * dz + bd * az) + da * bz) * square(cx, cy, cz);
  const auto d_term = ((bc * az - ac * bz) + ab * cz) * square(dx, dy, dz);
  return (ab_terms + (c_term - d_term)).estimate();
}

}  // namespace detail

/// Twice the signed area of (a, b, c): > 0 counter-clockwise; the sign is exact, 0 only if collinear. Points
/// are whatever has coordinates [0] and [1].
template <class P = std::array<double, 2>>
[[nodiscard]] inline double orient2d(const P& a, const P& b, const P& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double det = left - right;
  if (std::abs(det) > detail::orient2d_bound * (std::abs(left) + std::abs(right))) return det;
  return detail::orient2d_exact(a, b, c);
}

/// Six times the signed volume of the tetrahedron (a, b, c, d): (b-a) x (c-a) . (d-a). It is > 0
/// when the nodes are in VTK's order, that is when d lies on the side to which the normal
/// (b-a) x (c-a) points. The sign is exact: 0 only if the four points are coplanar. Coordinates
/// must be 0 or lie in 1e-70 .. 1e70 in magnitude.
[[nodiscard]] inline double orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
  const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
  const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
  const double bycz = by * cz, bzcy = bz * cy, bzcx = bz * cx;
  const double bxcz = bx * cz, bxcy = bx * cy, bycx = by * cx;
  const double det = dx * (bycz - bzcy) + dy * (bzcx - bxcz) + dz * (bxcy - bycx);
  const double permanent = std::abs(dx) * (std::abs(bycz) + std::abs(bzcy)) +
                           std::abs(dy) * (std::abs(bzcx) + std::abs(bxcz)) +
                           std::abs(dz) * (std::abs(bxcy) + std::abs(bycx));
  if (std::abs(det) > detail::orient3d_bound * permanent) return det;
  return detail::orient3d_exact(a, b, c, d);
}

/// > 0 when e lies inside the sphere through a, b, c, d with orient3d(a, b, c, d) > 0, < 0 outside;
/// the sign is exact: 0 only if the five points lie on one sphere.
[[nodiscard]] inline double insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                                     const Vec3& e) {
  const double ax = a[0] - e[0], ay = a[1] - e[1], az = a[2] - e[2];
  const double bx = b[0] - e[0], by = b[1] - e[1], bz = b[2] - e[2];
  const double cx = c[0] - e[0], cy = c[1] - e[1], cz = c[2] - e[2];
  const double dx = d[0] - e[0], dy = d[1] - e[1], dz = d[2] - e[2];
  const double axby = ax * by, bxay = bx * ay, bxcy = bx * cy, cxby = cx * by, cxdy = cx * dy, dxcy = dx * cy;
  const double dxay = dx * ay, axdy = ax * dy, axcy = ax * cy, cxay = cx * ay, bxdy = bx * dy, dxby = dx * by;
  const double ab = axby - bxay, bc = bxcy - cxby, cd = cxdy - dxcy;
  const double da = dxay - axdy, ac = axcy - cxay, bd = bxdy - dxby;
  const double aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz;
  const double cc = cx * cx + cy * cy + cz * cz, dd = dx * dx + dy * dy + dz * dz;
  const double det = (aa * (bz * cd - cz * bd + dz * bc) - bb * (cz * da + dz * ac + az * cd)) +
                     (cc * (dz * ab + az * bd + bz * da) - dd * (az * bc - bz * ac + cz * ab));
  const auto mag = [](double x, double y) { return std::abs(x) + std::abs(y); };
  const double ma = std::abs(az), mb = std::abs(bz), mc = std::abs(cz), md = std::abs(dz);
  const double mab = mag(axby, bxay), mbc = mag(bxcy, cxby), mcd = mag(cxdy, dxcy);
  const double mda = mag(dxay, axdy), mac = mag(axcy, cxay), mbd = mag(bxdy, dxby);
  const double permanent = aa * (mcd * mb + mbd * mc + mbc * md) + bb * (mda * mc + mac * md + mcd * ma) +
                           cc * (mab * md + mbd * ma + mda * mb) + dd * (mbc * ma + mac * mb + mab * mc);
  if (std::abs(det) > detail::insphere_bound * permanent) return det;
  return detail::insphere_exact(a, b, c, d, e);
}

}  // namespace tunica::meshing
