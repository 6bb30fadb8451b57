// SPDX-License-Identifier: MIT
// The interfaces of a label image: Kuhn's split of the grid into tetrahedra [KUHN60], in each of them the
// faces dual to the edges whose ends differ [NIELSON97]. Every region's boundary is a closed manifold, for
// any labels.
#pragma once

#include "tunica/image/labels.hpp"
#include "tunica/meshing/interfaces.hpp"
#include "tunica/meshing/number_table.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tunica::meshing {

namespace detail {

class LabelContour {
 public:
  explicit LabelContour(const image::LabelRegions& regions) : r_(regions) {}

  [[nodiscard]] Interfaces run() {
    for (Index k = 0; k + 1 < r_.size(2); ++k)
      for (Index j = 0; j + 1 < r_.size(1); ++j)
        for (Index i = 0; i + 1 < r_.size(0); ++i) cell({i, j, k});
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true}) cap(axis, upper);
    return std::move(out_);
  }

 private:
  using Voxel3 = std::array<Index, 3>;
  /// A node of the contour, and where it lies in the unit cell (times 12: exact).
  struct Corner {
    Index node;
    Vec3 unit;
  };
  // The tetrahedra of a cell step from corner 0 along three axes, in each order, to corner 7.
  static constexpr std::array<std::array<int, 4>, 6> paths{
      {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

  [[nodiscard]] static Voxel3 stepped(const Voxel3& v, int bits) {
    return {v[0] + (bits & 1), v[1] + (bits >> 1 & 1), v[2] + (bits >> 2)};
  }
  [[nodiscard]] Index region(const Voxel3& v) const { return r_.of[r_.offset(v[0], v[1], v[2])]; }

  void cell(const Voxel3& lo) {
    std::array<Index, 8> region_of{};
    bool mixed = false;
    for (int b = 0; b < 8; ++b) {
      region_of[static_cast<std::size_t>(b)] = region(stepped(lo, b));
      mixed = mixed || region_of[static_cast<std::size_t>(b)] != region_of[0];
    }
    if (!mixed) return;
    for (std::size_t p = 0; p < paths.size(); ++p) {
      std::array<Index, 4> r{};
      for (std::size_t i = 0; i < 4; ++i) r[i] = region_of[static_cast<std::size_t>(paths[p][i])];
      tetrahedron(lo, p, r);
    }
  }

  /// The corners of one tetrahedron and the points on its edges, in its faces and in it.
  struct Tet {
    LabelContour& c;
    const Voxel3& lo;
    std::span<const int> path;
    std::array<Index, 4> r;
    Index number;  // of the path

    [[nodiscard]] Corner on(std::initializer_list<int> corners) const {
      std::array<int, 4> bits{};
      std::size_t n = 0;
      for (int i = 0; i < 4; ++i)  // in the order of the path
        for (const int wanted : corners)
          if (wanted == i) bits[n++] = path[static_cast<std::size_t>(i)];
      return c.corner(lo, std::span(bits.data(), n), number);
    }
    [[nodiscard]] Vec3 direction(int i, int j) const {
      const Vec3 a = unit(path[static_cast<std::size_t>(i)]), b = unit(path[static_cast<std::size_t>(j)]);
      return vec::minus(b, a);
    }
    void face(int i, int j, std::span<const Corner> polygon) const {
      c.polygon(polygon, direction(i, j), {r[static_cast<std::size_t>(i)], r[static_cast<std::size_t>(j)]});
    }
  };

  void tetrahedron(const Voxel3& lo, std::size_t p, const std::array<Index, 4>& r) {
    const Tet t{*this, lo, paths[p], r, static_cast<Index>(p)};
    const auto same = [&](int i, int j) {
      return r[static_cast<std::size_t>(i)] == r[static_cast<std::size_t>(j)];
    };
    int equal = 0;  // pairs of corners in one region: 6, 3 (3 + 1), 2 (2 + 2), 1 (2 + 1 + 1), 0
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) equal += same(i, j);
    if (equal == 3) {
      int lone = 0;
      while (same(lone, (lone + 1) % 4) || same(lone, (lone + 2) % 4)) ++lone;
      const int i = (lone + 1) % 4, j = (lone + 2) % 4, k = (lone + 3) % 4;
      t.face(lone, i, std::array{t.on({lone, i}), t.on({lone, j}), t.on({lone, k})});
    } else if (equal == 2) {
      const int q = same(0, 1) ? 1 : same(0, 2) ? 2 : 3;
      const int u = q == 1 ? 2 : 1, v = q == 3 ? 2 : 3;
      t.face(0, u, std::array{t.on({0, u}), t.on({u, q}), t.on({q, v}), t.on({0, v})});
    } else if (equal == 1) {
      int p0 = 0, q0 = 1;
      while (!same(p0, q0))
        if (++q0 == 4) ++p0, q0 = p0 + 1;
      int u = 0, v = 0;
      while (u == p0 || u == q0) ++u;
      v = 6 - p0 - q0 - u;
      const Corner f = t.on({p0, u, v}), g = t.on({q0, u, v});
      t.face(u, v, std::array{t.on({u, v}), f, g});
      t.face(p0, u, std::array{t.on({p0, u}), t.on({q0, u}), g, f});
      t.face(p0, v, std::array{t.on({p0, v}), t.on({q0, v}), g, f});
    } else if (equal == 0) {
      const Corner centre = t.on({0, 1, 2, 3});
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) {
          int k = 0;
          while (k == i || k == j) ++k;
          const int l = 6 - i - j - k;
          t.face(i, j, std::array{t.on({i, j}), t.on({i, j, k}), centre, t.on({i, j, l})});
        }
    }
  }

  /// The border of the image: marching triangles in its plane, between the regions and what is beyond.
  void cap(std::size_t axis, bool upper) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int du = 1 << u, dv = 1 << v;
    Vec3 outward(0, 0, 0);
    outward[static_cast<Eigen::Index>(axis)] = upper ? 1 : -1;
    const Index beyond = border_side(static_cast<int>(2 * axis) + (upper ? 1 : 0));
    Voxel3 lo{};
    lo[axis] = upper ? r_.size(axis) - 1 : 0;
    for (lo[v] = 0; lo[v] + 1 < r_.size(v); ++lo[v])
      for (lo[u] = 0; lo[u] + 1 < r_.size(u); ++lo[u])
        for (const int middle : {du, dv}) cap_triangle(lo, {0, middle, du | dv}, outward, beyond);
  }

  void cap_triangle(const Voxel3& lo, const std::array<int, 3>& bits, const Vec3& outward, Index beyond) {
    constexpr std::size_t zero = 0, one = 1, two = 2;
    std::array<Index, 3> r{};
    for (std::size_t i = 0; i < 3; ++i) r[i] = region(stepped(lo, bits[i]));
    const auto on = [&](std::initializer_list<std::size_t> corners) {
      std::array<int, 4> b{};
      std::size_t n = 0;
      for (std::size_t i = 0; i < 3; ++i)
        for (const std::size_t wanted : corners)
          if (wanted == i) b[n++] = bits[i];
      return corner(lo, std::span(b.data(), n), 0);
    };
    // Nodes are made only where a labelled region has a face.
    const auto face = [&](std::size_t i, auto&&... points) {
      if (r_.label(r[i]) != 0) polygon(std::array{points()...}, outward, {r[i], beyond});
    };
    const auto at = [&](auto... i) { return [&, i...] { return on({i...}); }; };
    if (r[0] == r[1] && r[1] == r[2]) return face(0, at(zero), at(one), at(two));
    if (r[0] != r[1] && r[1] != r[2] && r[2] != r[0]) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        face(i, at(i), at(i, j), at(zero, one, two), at(i, k));
      }
      return;
    }
    const std::size_t lone = r[1] == r[2] ? 0 : r[0] == r[2] ? 1 : 2, j = (lone + 1) % 3, k = (lone + 2) % 3;
    face(lone, at(lone), at(lone, j), at(lone, k));
    face(j, at(j), at(k), at(lone, k), at(lone, j));
  }

  /// Puts the polygon into the interfaces, turned so that its normal goes along `from_first`.
  void polygon(std::span<const Corner> p, const Vec3& from_first, Sides sides) {
    const Vec3 d = vec::minus(p[2].unit, p[0].unit), e = vec::minus(p[p.size() - 1].unit, p[1].unit);
    const Vec3 normal = p.size() == 3 ? vec::cross(vec::minus(p[1].unit, p[0].unit), d) : vec::cross(d, e);
    const bool turn = vec::dot(normal, from_first) < 0;
    // A triangle between two regions has the lower one first.
    const bool swap = sides[1] >= 0 && sides[1] < sides[0];
    if (swap) std::swap(sides[0], sides[1]);
    const auto put = [&](std::size_t i, std::size_t j, std::size_t k) {
      if (turn != swap) std::swap(j, k);
      out_.faces.push_back({p[i].node, p[j].node, p[k].node});
      out_.sides.push_back(sides);
    };
    if (p.size() == 3) return put(0, 1, 2);
    put(0, 1, 3), put(1, 2, 3);
  }

  [[nodiscard]] static Vec3 unit(int bits) { return Vec3(bits & 1, bits >> 1 & 1, bits >> 2); }

  /// Along an axis: at a voxel (that of the border: at the border of the box), between two of them.
  [[nodiscard]] double coordinate(std::size_t axis, Index twice) const {
    const auto i = static_cast<std::size_t>(twice / 2);
    if (twice % 2 != 0) return r_.faces[axis][i + 1];
    if (twice == 0) return r_.faces[axis].front();
    return i + 1 == r_.axes[axis].size() ? r_.faces[axis].back() : r_.axes[axis][i];
  }

  /// The node for a set of corners of a tetrahedron, which ascend along its path: a voxel itself, the middle
  /// of an edge, a point of a face or of the tetrahedron (the means of the middles of their edges).
  [[nodiscard]] Corner corner(const Voxel3& lo, std::span<const int> bits, Index path) {
    Vec3 middle(0, 0, 0);
    for (const int b : bits) middle = vec::plus(middle, unit(b));
    const double scale = 12.0 / static_cast<double>(bits.size());
    const Voxel3 base = stepped(lo, bits[0]);
    const int d1 = bits.size() > 1 ? bits[1] ^ bits[0] : 0, d2 = bits.size() > 2 ? bits[2] ^ bits[0] : 0;
    // 0: the voxel; 1-7: edges; 10-55: faces, by their two steps; 56-61: tetrahedra
    const int code = bits.size() == 4 ? 56 + path : bits.size() == 3 ? d1 << 3 | d2 : d1;
    const std::uint64_t key = 64 * r_.offset(base[0], base[1], base[2]) + static_cast<std::uint64_t>(code);
    const Index node = number_.of(key);
    if (node == out_.node_count()) add(lo, bits);
    return {node, vec::scaled(scale, middle)};
  }

  void add(const Voxel3& lo, std::span<const int> bits) {
    Vec3 x(0, 0, 0), reach(0, 0, 0);
    std::uint8_t frozen = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      double sum = 0, first = 0;
      int terms = 0;
      bool flat = true;
      for (std::size_t i = 0; i < bits.size(); ++i)
        for (std::size_t j = bits.size() == 1 ? i : i + 1; j < bits.size(); ++j) {
          const double c = coordinate(a, 2 * lo[a] + (bits[i] >> a & 1) + (bits[j] >> a & 1));
          if (terms == 0) first = c;
          flat = flat && c == first;
          sum += c, ++terms;
        }
      const auto e = static_cast<Eigen::Index>(a);
      x[e] = flat ? first : sum / terms;
      if (x[e] == r_.faces[a].front() || x[e] == r_.faces[a].back())
        frozen = static_cast<std::uint8_t>(frozen | 1 << a);
      const auto i = static_cast<std::size_t>(lo[a]);
      reach[e] = half * (r_.axes[a][i + (i + 1 < r_.axes[a].size() ? 1 : 0)] -
                         r_.axes[a][i - (i + 1 < r_.axes[a].size() ? 0 : 1)]);
    }
    out_.nodes.push_back(x), out_.anchor.push_back(x), out_.reach.push_back(reach);
    out_.frozen.push_back(frozen);
  }

  static constexpr double half = 0.5;  // of the distance of voxels: as far as the true interface may be
  const image::LabelRegions& r_;
  Interfaces out_;
  NumberTable number_;
};

}  // namespace detail

/// The interfaces half-way between the voxels of different regions, and those of the labelled regions with
/// the border of the image, which are plane. Triangles between two regions have the lower region first.
[[nodiscard]] inline Interfaces label_contour(const image::LabelRegions& regions) {
  return detail::LabelContour(regions).run();
}

}  // namespace tunica::meshing
