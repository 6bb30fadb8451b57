// SPDX-License-Identifier: MIT
// Shapes on which fillers fail: thin sheets, needles, notches, fans, shells, and surfaces that are broken.
#pragma once

#include "support/surfaces.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace tunica::test::soak {

using mesh::Surface;

/// Numbers that depend on the seed alone.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(splitmix64(seed) << 20) {}
  double between(double a, double b) { return a + (b - a) * 0.5 * (noise(++state_) + 1); }
  /// A whole number, both ends included.
  std::int64_t whole(std::int64_t a, std::int64_t b) {
    return std::min(b, a + static_cast<std::int64_t>(between(0, static_cast<double>(b - a + 1))));
  }
  Vec3 direction() {
    for (;;) {
      Vec3 d;
      for (double& x : d) x = between(-1, 1);
      if (d.norm() <= 1 && d.norm() > 0.1) return d.normalized();
    }
  }

 private:
  std::uint64_t state_;
};

inline Surface stretched(Surface s, const Vec3& factor) {
  for (Index n = 0; n < s.node_count(); ++n) s.nodes.col(n) = s.nodes.col(n).cwiseProduct(factor);
  return s;
}
inline Surface moved(Surface s, const Vec3& by) {
  s.nodes.colwise() += by;
  return s;
}
inline Surface rotated(Surface s, Random& r) {
  const Vec3 axis = r.direction();
  s.nodes = Eigen::AngleAxisd(r.between(0.1, 3), axis).toRotationMatrix() * s.nodes;
  return s;
}

/// What lies between two heights over the unit square; lower < upper.
template <class Lower, class Upper>
Surface sheet(int nx, int ny, const Lower& lower, const Upper& upper) {
  SurfaceBuilder b;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const double x = static_cast<double>(i) / nx, y = static_cast<double>(j) / ny;
        b.node({x, y, k == 0 ? lower(x, y) : upper(x, y)});
      }
  const auto at = [&](int i, int j, int k) { return static_cast<Index>((k * (ny + 1) + j) * (nx + 1) + i); };
  const auto quad = [&](Index p, Index q, Index r, Index s) {
    b.triangles.push_back({p, q, r}), b.triangles.push_back({p, r, s});
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {  // the same diagonal on both sides
      quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
      b.triangles.push_back({at(i, j, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)});
      b.triangles.push_back({at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0)});
    }
  for (int i = 0; i < nx; ++i) {
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    quad(at(i + 1, ny, 0), at(i, ny, 0), at(i, ny, 1), at(i + 1, ny, 1));
  }
  for (int j = 0; j < ny; ++j) {
    quad(at(0, j + 1, 0), at(0, j, 0), at(0, j, 1), at(0, j + 1, 1));
    quad(at(nx, j, 0), at(nx, j + 1, 0), at(nx, j + 1, 1), at(nx, j, 1));
  }
  return b.surface();
}

/// Some edges get a node at `share` of their length: two needles and two nearly whole triangles each.
inline Surface needled(Surface s, Random& r, double share) {
  for (int k = 0; k < 12; ++k) {
    const auto t = static_cast<Index>(r.whole(0, s.cell_count() - 1));
    const Index a = s.cells(0, t), b = s.cells(1, t), c = s.cells(2, t);
    Index other = 0;
    const auto place = [&](Index u, Index v) {  // of v after u in the triangle `other`
      for (int i = 0; i < 3; ++i)
        if (s.cells(i, other) == u && s.cells((i + 1) % 3, other) == v) return i;
      return -1;
    };
    while (place(b, a) < 0) ++other;
    const Index d = s.cells((place(b, a) + 2) % 3, other);
    const Index p = s.node_count(), first = s.cell_count();
    s.nodes.conservativeResize(3, p + 1);
    s.nodes.col(p) = s.nodes.col(a) + share * (s.nodes.col(b) - s.nodes.col(a));
    s.cells.conservativeResize(3, first + 2);
    s.cells.col(t) << a, p, c;
    s.cells.col(other) << p, a, d;
    s.cells.col(first) << p, b, c;
    s.cells.col(first + 1) << b, p, d;
    if (!s.region.empty()) {
      s.region.push_back(s.region[static_cast<std::size_t>(t)]);
      s.region.push_back(s.region[static_cast<std::size_t>(other)]);
    }
  }
  return s;
}

/// Twisted prisms beside one another, each as hard as one.
inline Surface prisms(int count, double twist) {
  Surface s = schoenhardt_prism(twist);
  for (int i = 1; i < count; ++i) s = joined(s, moved(schoenhardt_prism(twist), Vec3(1.9 * i, 0, 0)));
  return s;
}

/// A prism over a polygon; both ends are coplanar fans from one corner.
inline Surface fans(int corners, double height) {
  SurfaceBuilder b;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < corners; ++i) {
      const double a = 2 * std::numbers::pi * i / corners;
      b.node({std::cos(a), std::sin(a), k * height});
    }
  const auto n = static_cast<Index>(corners);
  for (Index i = 1; i + 1 < n; ++i) {
    b.triangles.push_back({0, i + 1, i});
    b.triangles.push_back({n, n + i, n + i + 1});
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    b.triangles.push_back({i, j, n + j}), b.triangles.push_back({i, n + j, n + i});
  }
  return b.surface();
}

/// Spheres in one another, each a shell inside the one before.
inline Surface shells(int count, double gap) {
  Surface s = icosphere(2);
  for (int i = 1; i < count; ++i) {
    const Surface next = icosphere(2, 1 - i * gap);
    s = joined(s, i % 2 == 1 ? reversed(next) : next);
  }
  return s;
}

/// A random walk along the axes of a grid, one voxel wide.
inline Surface voxel_tube(std::uint64_t seed) {
  Random r(seed);
  constexpr Index n = 12;
  std::vector<char> filled(static_cast<std::size_t>(n * n * n), 0);
  std::array<Index, 3> x{n / 2, n / 2, n / 2};
  for (int step = 0; step < 80; ++step) {
    filled[static_cast<std::size_t>((x[2] * n + x[1]) * n + x[0])] = 1;
    Index& c = x[static_cast<std::size_t>(r.whole(0, 2))];
    c = std::clamp<Index>(c + (r.whole(0, 1) == 0 ? -1 : 1), 1, n - 2);
  }
  std::size_t i = 0;
  return meshing::marching_cubes(sampled<float>(n, [&](const Vec3&) { return filled[i++] ? 1.0 : 0.0; }), 0.5)
      .surface;
}

/// A wedge whose edge has that dihedral angle [rad].
inline Surface wedge(double angle) {
  return sheet(
      6, 6, [](double, double) { return 0.0; }, [angle](double x, double) { return angle * (x + 1e-3); });
}

/// A pyramid of steps, one voxel high each.
inline Surface steps(int count) {
  const auto n = static_cast<Index>(2 * count + 5);
  const auto inside = [&](const Vec3& x) {
    const Vec3 v = (n - 1) * x;  // in voxels
    const double middle = 0.5 * (n - 1);
    const double out = std::max(std::abs(v[0] - middle), std::abs(v[1] - middle));
    return v[2] > 0.5 && v[2] < count + 0.5 && out < count + 1.5 - v[2] ? 1.0 : 0.0;
  };
  return meshing::marching_cubes(sampled<float>(n, inside), 0.5).surface;
}

/// A box whose triangles at one corner are halved again and again.
inline Surface graded_box(int rounds) {
  Surface s = box_surface(1);
  SurfaceBuilder b;
  for (Index n = 0; n < s.node_count(); ++n) b.node(s.nodes.col(n));
  for (Index t = 0; t < s.cell_count(); ++t)
    b.triangles.push_back({s.cells(0, t), s.cells(1, t), s.cells(2, t)});
  for (int round = 0; round < rounds; ++round) {
    std::map<Index, Index> half;
    const auto middle = [&](Index n) {
      const auto [it, made] = half.try_emplace(n, -1);
      if (made) it->second = b.node(0.5 * (b.nodes[0] + b.nodes[static_cast<std::size_t>(n)]));
      return it->second;
    };
    for (std::size_t t = 0, count = b.triangles.size(); t < count; ++t) {
      auto f = b.triangles[t];
      std::rotate(f.begin(),
                  std::find(f.begin(), f.end(), 0) == f.end() ? f.begin() : std::find(f.begin(), f.end(), 0),
                  f.end());
      if (f[0] != 0) continue;
      const Index p = middle(f[1]), q = middle(f[2]);
      b.triangles[t] = {0, p, q};
      b.triangles.push_back({p, f[1], f[2]}), b.triangles.push_back({p, f[2], q});
    }
  }
  return b.surface();
}

inline Surface without_triangle(Surface s, Index t) {
  s.cells.col(t) = s.cells.col(s.cell_count() - 1).eval();
  s.cells.conservativeResize(3, s.cell_count() - 1);
  return s;
}
inline Surface with_turned_triangle(Surface s, Index t) {
  std::swap(s.cells(0, t), s.cells(1, t));
  return s;
}
/// The triangle's first node lies on the middle of the opposite edge.
inline Surface with_flat_triangle(Surface s, Index t) {
  s.nodes.col(s.cells(0, t)) = 0.5 * (s.nodes.col(s.cells(1, t)) + s.nodes.col(s.cells(2, t)));
  return s;
}
/// Two double tetrahedra that share a node.
inline Surface touching_at_node(double size) {
  SurfaceBuilder b;
  b.node(Vec3::Zero());
  for (const double side : {-size, size}) {
    const Index u = b.node({1, 0, side}), v = b.node({-1, 1, side}), w = b.node({-1, -1, side});
    for (const auto& [p, q] : {std::pair{u, v}, {v, w}, {w, u}})
      b.triangles.push_back(side > 0 ? std::array<Index, 3>{0, q, p} : std::array<Index, 3>{0, p, q});
    b.triangles.push_back(side > 0 ? std::array<Index, 3>{u, v, w} : std::array<Index, 3>{u, w, v});
  }
  return b.surface();
}

}  // namespace tunica::test::soak
