// SPDX-License-Identifier: MIT
// A box with notches from both sides that almost meet on a saddle [CHAZELLE84]: a filling needs many
// tetrahedra.
#pragma once

#include "support/surfaces.hpp"
#include "tunica/meshing/orient.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace tunica::test::soak {

using mesh::Surface;

/// Ear clipping of a simple polygon as seen along an axis; the sense of its triangles is not settled.
inline void clip_ears(SurfaceBuilder& b, std::vector<Index> polygon, int axis) {
  const auto flat = [&](Index n) {
    const Vec3& y = b.nodes[static_cast<std::size_t>(n)];
    return Point<2>(y[(axis + 1) % 3], y[(axis + 2) % 3]);
  };
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point<2> p = flat(polygon[i]), q = flat(polygon[(i + 1) % polygon.size()]);
    area += p[0] * q[1] - p[1] * q[0];
  }
  if (area < 0) std::reverse(polygon.begin(), polygon.end());
  const auto turn = [&](Index p, Index q, Index r) { return meshing::orient2d(flat(p), flat(q), flat(r)); };
  while (polygon.size() > 2) {
    const std::size_t m = polygon.size();
    std::size_t i = 0;
    for (; i < m; ++i) {
      const Index p = polygon[i], q = polygon[(i + 1) % m], r = polygon[(i + 2) % m];
      const bool free = std::none_of(polygon.begin(), polygon.end(), [&](Index x) {
        return x != p && x != q && x != r && turn(p, q, x) >= 0 && turn(q, r, x) >= 0 && turn(r, p, x) >= 0;
      });
      if (!(turn(p, q, r) > 0) || !free) continue;
      b.triangles.push_back({p, q, r});
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((i + 1) % m));
      break;
    }
    if (i == m) return;  // not simple: the surface stays open, as the checks will tell
  }
}

/// Turns triangles until all agree with the first; of two at an edge one runs along it, one against it.
inline void agree(SurfaceBuilder& b) {
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> at;  // undirected
  for (std::size_t t = 0; t < b.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      at[std::minmax({b.triangles[t][i], b.triangles[t][(i + 1) % 3]})].push_back(t);
  const auto runs = [&](std::size_t t, Index p, Index q) {
    for (std::size_t i = 0; i < 3; ++i)
      if (b.triangles[t][i] == p && b.triangles[t][(i + 1) % 3] == q) return true;
    return false;
  };
  std::vector<char> seen(b.triangles.size(), 0);
  std::vector<std::size_t> front{0};
  seen[0] = 1;
  while (!front.empty()) {
    const std::size_t t = front.back();
    front.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Index p = b.triangles[t][i], q = b.triangles[t][(i + 1) % 3];
      for (const std::size_t u : at[std::minmax({p, q})]) {
        if (seen[u] != 0) continue;
        if (runs(u, p, q)) std::swap(b.triangles[u][0], b.triangles[u][1]);
        seen[u] = 1;
        front.push_back(u);
      }
    }
  }
}

/// A box notched from above along y and from below along x, down to lines that almost meet on z = x y
/// [CHAZELLE84].
inline Surface notched(int count, double gap) {
  SurfaceBuilder b;
  const double length = count + 1, height = length * length + 2, half = 0.2;
  std::array<std::array<std::vector<Index>, 2>, 2> rim;  // [top][far end], corner to corner
  for (const std::size_t top : {0U, 1U})
    for (const std::size_t far : {0U, 1U}) {
      const double t = far == 1 ? length : 0, z = top == 1 ? height : -height;
      const auto node = [&](double across, double up) {
        rim[top][far].push_back(top == 1 ? b.node({across, t, up}) : b.node({t, across, up}));
      };
      node(0, z);
      for (int i = 1; i <= count; ++i)
        node(i - half, z), node(i, i * t + (top == 1 ? gap : -gap)), node(i + half, z);
      node(length, z);
    }
  for (const auto& [near, far] : rim)
    for (std::size_t k = 0; k + 1 < near.size(); ++k) {
      b.triangles.push_back({near[k], near[k + 1], far[k + 1]});
      b.triangles.push_back({near[k], far[k + 1], far[k]});
    }
  for (const std::size_t top : {0U, 1U})  // the sides: a notched edge and the straight one opposite to it
    for (const std::size_t far : {0U, 1U}) {
      const auto& other = rim[1 - top];
      std::vector<Index> polygon = rim[top][far];
      polygon.push_back(far == 1 ? other[1].back() : other[1].front());
      polygon.push_back(far == 1 ? other[0].back() : other[0].front());
      clip_ears(b, polygon, top == 1 ? 1 : 0);
    }
  agree(b);
  Surface s = b.surface();
  static_cast<void>(meshing::orient_outward(s));
  return s;
}

}  // namespace tunica::test::soak
