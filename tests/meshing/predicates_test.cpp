// SPDX-License-Identifier: MIT
// The signs of the predicates against integers of any length, on points that are nearly degenerate.
#include "tunica/meshing/predicates.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace {

using namespace tunica;

/// A whole number of any length: sign and magnitude, 32 bits a limb.
struct Big {
  int sign = 0;
  std::vector<std::uint32_t> limb;

  Big() = default;
  /// x times 2^120; every x of the tests is a multiple of 2^-120.
  explicit Big(double x) {
    if (x == 0) return;
    int exponent = 0;
    const double m = std::frexp(std::abs(x), &exponent);
    auto mantissa = static_cast<std::uint64_t>(std::ldexp(m, 53));
    int shift = exponent - 53 + 120;
    for (; shift < 0; ++shift) {
      REQUIRE(mantissa % 2 == 0);
      mantissa /= 2;
    }
    sign = x > 0 ? 1 : -1;
    limb.assign(static_cast<std::size_t>(shift / 32), 0);
    const int bits = shift % 32;
    std::uint64_t low = (mantissa & 0xffffffffu) << bits, high = (mantissa >> 32) << bits;
    high += low >> 32;
    limb.push_back(static_cast<std::uint32_t>(low));
    limb.push_back(static_cast<std::uint32_t>(high));
    limb.push_back(static_cast<std::uint32_t>(high >> 32));
    trim();
  }
  void trim() {
    while (!limb.empty() && limb.back() == 0) limb.pop_back();
    if (limb.empty()) sign = 0;
  }
  static int compare(const Big& a, const Big& b) {  // magnitudes
    if (a.limb.size() != b.limb.size()) return a.limb.size() < b.limb.size() ? -1 : 1;
    for (std::size_t i = a.limb.size(); i-- > 0;)
      if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
    return 0;
  }
};

Big operator-(Big a) {
  a.sign = -a.sign;
  return a;
}

Big operator+(const Big& a, const Big& b) {
  if (a.sign == 0) return b;
  if (b.sign == 0) return a;
  const bool add = a.sign == b.sign;
  const bool swap = Big::compare(a, b) < 0;
  const Big &x = swap ? b : a, &y = swap ? a : b;
  Big r;
  r.sign = x.sign;
  std::int64_t carry = 0;
  for (std::size_t i = 0; i < x.limb.size(); ++i) {
    const std::int64_t other = i < y.limb.size() ? y.limb[i] : 0;
    std::int64_t v = static_cast<std::int64_t>(x.limb[i]) + (add ? other : -other) + carry;
    carry = v < 0 ? -1 : v >> 32;
    r.limb.push_back(static_cast<std::uint32_t>(v & 0xffffffff));
  }
  if (carry > 0) r.limb.push_back(static_cast<std::uint32_t>(carry));
  r.trim();
  return r;
}

Big operator-(const Big& a, const Big& b) {
  return a + (-b);
}

Big operator*(const Big& a, const Big& b) {
  Big r;
  r.sign = a.sign * b.sign;
  r.limb.assign(a.limb.size() + b.limb.size(), 0);
  for (std::size_t i = 0; i < a.limb.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limb.size() || carry != 0; ++j) {
      const std::uint64_t product = j < b.limb.size() ? std::uint64_t{a.limb[i]} * b.limb[j] : 0;
      const std::uint64_t v = product + r.limb[i + j] + carry;
      r.limb[i + j] = static_cast<std::uint32_t>(v);
      carry = v >> 32;
    }
  }
  r.trim();
  return r;
}

using Row = std::vector<Big>;

/// Laplace expansion along the first row.
Big determinant(const std::vector<Row>& m) {
  if (m.size() == 1) return m[0][0];
  Big sum;
  for (std::size_t c = 0; c < m.size(); ++c) {
    std::vector<Row> minor;
    for (std::size_t r = 1; r < m.size(); ++r) {
      Row row;
      for (std::size_t k = 0; k < m.size(); ++k)
        if (k != c) row.push_back(m[r][k]);
      minor.push_back(row);
    }
    const Big term = m[0][c] * determinant(minor);
    sum = c % 2 == 0 ? sum + term : sum - term;
  }
  return sum;
}

template <class P>
Row row_between(const P& from, const P& to) {
  Row row;
  for (int k = 0; k < from.size(); ++k) row.push_back(Big(to[k]) - Big(from[k]));
  return row;
}

int exact_orient2d(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
  return determinant({row_between(a, b), row_between(a, c)}).sign;
}

int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return determinant({row_between(a, b), row_between(a, c), row_between(a, d)}).sign;
}

int exact_insphere(const std::array<Vec3, 4>& tet, const Vec3& e) {
  std::vector<Row> m;
  for (const Vec3& p : tet) {
    Row row = row_between(e, p);
    row.push_back(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
    m.push_back(row);
  }
  return -determinant(m).sign;  // negative inside, for tetrahedra in VTK's order
}

int sign(double x) {
  return (x > 0) - (x < 0);
}

struct Random {
  std::mt19937_64 engine{20080115};
  double unit() { return std::ldexp(static_cast<double>(engine() >> 11), -53); }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  Vec3 point() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  /// A few units in the last place, or none.
  double nudge(double x) { return x + static_cast<double>(static_cast<int>(engine() % 5) - 2) * 0x1p-53; }
  Vec3 nudge(const Vec3& x) { return {nudge(x[0]), nudge(x[1]), nudge(x[2])}; }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: predicates have the sign of VTK's order") {
    const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    CHECK(meshing::orient3d(o, x, y, z) == 1);
    CHECK(meshing::orient3d(o, y, x, z) == -1);
    CHECK(meshing::orient3d(o, x, y, Vec3(3, 4, 0)) == 0);
    CHECK(meshing::insphere(o, x, y, z, Vec3(0.5, 0.5, 0.5)) > 0);
    CHECK(meshing::insphere(o, x, y, z, Vec3(2, 0, 0)) < 0);
    CHECK(meshing::insphere(o, x, y, z, Vec3(1, 1, 1)) == 0);
    CHECK(meshing::orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
    CHECK(meshing::orient2d({0, 0}, {1, 0}, {2, 0}) == 0);
  }

  TEST_CASE("meshing: predicates agree with exact integers on nearly degenerate points") {
    Random random;
    int wrong = 0, zero = 0, filtered_wrong = 0;
    for (int i = 0; i < 3000; ++i) {
      const double scale = std::ldexp(1.0, -static_cast<int>(random.engine() % 12));
      const Vec3 a = random.point(), b = a + scale * random.point(), c = a + random.point();
      const double s = random.between(-1, 2), t = random.between(-1, 2);
      const Vec3 d = random.nudge(Vec3(a + s * (b - a) + t * (c - a)));
      const int truth = exact_orient3d(a, b, c, d);
      wrong += sign(meshing::orient3d(a, b, c, d)) != truth;
      filtered_wrong += sign((b - a).cross(c - a).dot(d - a)) != truth;
      const Point<2> p = a.head<2>(), q = b.head<2>();
      const Point<2> r(random.nudge(p[0] + s * (q[0] - p[0])), random.nudge(p[1] + s * (q[1] - p[1])));
      wrong += sign(meshing::orient2d(p, q, r)) != exact_orient2d(p, q, r);
    }
    for (int i = 0; i < 3000; ++i) {  // lattice points: many true zeros
      const auto grid = [&] { return static_cast<double>(random.engine() % 3) * 0.1; };
      const Vec3 a(grid(), grid(), grid()), b(grid(), grid(), grid()), c(grid(), grid(), grid());
      const Vec3 d(grid(), grid(), grid());
      const int truth = exact_orient3d(a, b, c, d);
      zero += truth == 0;
      wrong += sign(meshing::orient3d(a, b, c, d)) != truth;
    }
    MESSAGE("plain doubles: " << filtered_wrong << " of 3000 signs wrong; ours: " << wrong
                              << "; true zeros: " << zero);
    CHECK(wrong == 0);
    CHECK(zero > 500);
    CHECK(filtered_wrong > 100);
  }

  TEST_CASE("meshing: insphere agrees with exact integers on nearly cospherical points") {
    Random random;
    int wrong = 0, tried = 0, zero = 0, undecided = 0;
    while (tried < 400) {
      std::array<Vec3, 5> p;
      const Vec3 centre = random.point();
      const bool grid = tried % 4 == 0;  // corners of a cube off the grid of doubles
      for (Vec3& x : p) {
        if (grid) {
          const std::uint64_t corner = random.engine() % 8;
          for (int k = 0; k < 3; ++k) x[k] = centre[k] + static_cast<double>(corner >> k & 1) * 0.25;
        } else {
          x = random.nudge(Vec3(centre + random.point().normalized()));
        }
      }
      const int orientation = exact_orient3d(p[0], p[1], p[2], p[3]);
      if (orientation == 0) continue;
      if (orientation < 0) std::swap(p[0], p[1]);
      ++tried;
      const int truth = exact_insphere({p[0], p[1], p[2], p[3]}, p[4]);
      const double value = meshing::insphere(p[0], p[1], p[2], p[3], p[4]);
      wrong += sign(value) != truth;
      zero += truth == 0;
      undecided += std::abs(value) < 1e-14;
    }
    MESSAGE("insphere: " << wrong << " wrong of " << tried << "; " << undecided
                         << " near the filter; true zeros: " << zero);
    CHECK(wrong == 0);
    CHECK(zero > 20);
    CHECK(undecided > 200);
  }
}
