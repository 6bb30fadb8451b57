// SPDX-License-Identifier: MIT
// Points of a body-centred cubic lattice inside a surface, graded by an octree: its tetrahedra have
// dihedral angles of 60 and 90 degrees, so only those near the surface ever need repair.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/meshing/size_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace tunica::meshing {

struct LatticeOptions {
  double edge = 1.0;       // mean edge of the lattice over the local size h(x)
  double clearance = 0.5;  // distance to the surface over the larger of its triangles there and edge * h
  Vec3 shift{0, 0, 0};     // of the origin, in lattice cells
};

/// Mean over the 6 + 8 edges at a node: 2 x a and 4 x a sqrt(3)/2 a tetrahedron.
inline constexpr double lattice_mean_edge = 0.911;

/// The points; `size` gives the target edge length, `surface` the distances. MeshError where the size inside
/// is no length, with the place, and where it would take more than 200 million tetrahedra.
template <SizeField Size>
class Lattice {
 public:
  Lattice(const SurfaceSize& surface, const Size& size, const LatticeOptions& options)
      : surface_(surface), size_(size), options_(options) {
    TUNICA_EXPECT(options.edge > 0, "the lattice has an edge length");
  }

  [[nodiscard]] std::vector<Vec3> points() {
    // The leaves halve a root cube; at the reference size they have exactly the wanted edge. The unit
    // has few bits, so that coordinates are exact.
    const Box& box = surface_.box();
    const double leaf = cell_edge(reference_size());
    unit_ = rounded(leaf / (2 * finest));
    double extent = 2 * finest * unit_;
    int level = finest_level + 1;
    const double widest = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
    while (extent < 1.01 * widest + 2 * leaf && level < 40) extent *= 2, ++level;
    const Vec3 centre = box.centre();
    for (int k = 0; k < 3; ++k)
      origin_[k] = std::round((centre[k] + (leaf * options_.shift[k] - 0.5 * extent)) / unit_) * unit_;
    subdivide({0, 0, 0}, std::int64_t{1} << level, false);
    std::sort(found_.begin(), found_.end(), [](const Key& a, const Key& b) {
      return a[0] != b[0] ? a[0] < b[0] : a[1] != b[1] ? a[1] < b[1] : a[2] < b[2];
    });
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Key &k = found_[i], &last = found_[i > 0 ? i - 1 : 0];
      if (i == 0 || k[0] != last[0] || k[1] != last[1] || k[2] != last[2]) result.push_back(place(k));
    }
    return result;
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  static constexpr int finest_level = 7;  // halvings below the median leaf
  static constexpr double finest = 1 << finest_level;

  [[nodiscard]] Vec3 place(const Key& k) const {
    const Vec3 steps(static_cast<double>(k[0]), static_cast<double>(k[1]), static_cast<double>(k[2]));
    return vec::along(origin_, unit_, steps);
  }
  [[nodiscard]] double cell_edge(double h) const { return options_.edge * h / lattice_mean_edge; }

  /// x with so few bits that its multiples are exact.
  [[nodiscard]] static double rounded(double x) {
    int e = 0;
    std::frexp(x, &e);
    const double step = std::ldexp(1.0, e - 16);
    return std::max(std::round(x / step) * step, step);
  }

  /// The median at the nodes of the surface, and where sizes vary inside that times the part of a halving
  /// which brings leaves nearest to what is wanted there: the mean of log2 h on a circle.
  [[nodiscard]] double reference_size() const {
    std::vector<double> h = surface_.node_sizes();
    for (std::size_t i = 0; i < h.size(); ++i) h[i] = size_at(surface_.node(static_cast<Index>(i)));
    std::nth_element(h.begin(), h.begin() + static_cast<std::ptrdiff_t>(h.size() / 2), h.end());
    const double median = h[h.size() / 2];
    if constexpr (std::same_as<Size, SurfaceSize> || std::same_as<Size, SizeWithin<SurfaceSize>>)
      return median;
    constexpr int samples = 12;  // an axis
    const Box& box = surface_.box();
    double cosine = 0, sine = 0, number = 0;
    for (int i = 0; i < samples * samples * samples; ++i) {
      const std::array<int, 3> at{i % samples, i / samples % samples, i / samples / samples};
      Vec3 x = box.lo;
      for (int k = 0; k < 3; ++k)
        x[k] += (at[static_cast<std::size_t>(k)] + 0.5) / samples * (box.hi[k] - box.lo[k]);
      if (!surface_.nearest(x).inside) continue;
      const double wanted = size_at(x), turn = 2 * std::numbers::pi * std::log2(wanted / median);
      const double count = 1 / (wanted * wanted * wanted);  // as many nodes stand there
      cosine += count * std::cos(turn), sine += count * std::sin(turn), number += count;
    }
    const Vec3 side = vec::minus(box.hi, box.lo);
    const double sampled = side[0] * side[1] * side[2] / (samples * samples * samples);
    require_countable(number * sampled / std::pow(options_.edge / lattice_mean_edge, 3));
    return median * std::exp2(std::atan2(sine, cosine) / (2 * std::numbers::pi));
  }

  /// Visits the cube [corner, corner + edge]; deep: wholly inside, far from the surface.
  void subdivide(const Key& corner, std::int64_t edge, bool deep) {
    const std::int64_t half = edge / 2;
    const Key centre{corner[0] + half, corner[1] + half, corner[2] + half};
    const Vec3 x = place(centre);
    const double length = static_cast<double>(edge) * unit_, radius = 0.5 * std::sqrt(3.0) * length;
    double instead = 0;  // outside, where the field need not give a length
    if (!deep) {
      const auto near = surface_.nearest(x);
      const double distance = near.distance;
      if (!near.inside && distance > radius) return;
      if (!near.inside) instead = near.size;
      deep = near.inside && distance - radius > clearance(near.size, x);
    }
    const double wanted = cell_edge(size_at(x, instead));
    if (length > std::sqrt(2.0) * wanted && half > 1) {
      for (int i = 0; i < 8; ++i)
        subdivide(
            {corner[0] + (i & 1 ? half : 0), corner[1] + (i & 2 ? half : 0), corner[2] + (i & 4 ? half : 0)},
            half, deep);
      return;
    }
    require_countable(++leaves_);
    offer(centre, deep);
    for (int i = 0; i < 8; ++i)
      offer({corner[0] + (i & 1 ? edge : 0), corner[1] + (i & 2 ? edge : 0), corner[2] + (i & 4 ? edge : 0)},
            deep);
  }

  void offer(const Key& k, bool deep) {
    if (!deep) {
      const Vec3 x = place(k);
      const auto near = surface_.nearest(x);
      if (!near.inside || near.distance < clearance(near.size, x)) return;
    }
    found_.push_back(k);
  }

  [[nodiscard]] double clearance(double surface_size, const Vec3& x) const {
    return options_.clearance * std::max(surface_size, size_at(x) * options_.edge);
  }

  [[nodiscard]] double size_at(const Vec3& x, double instead = 0) const {
    const double h = size_(x);
    if (h > 0 && std::isfinite(h)) return h;
    if (!(instead > 0))
      throw MeshError("the size field gives an edge length of " + seven_digits(h) + " at " +
                      tunica::place(x));
    return instead;
  }

  static void require_countable(double leaves) {
    constexpr double tetrahedra = 12, most = 2e8;  // in a leaf; in all
    if (!(leaves * tetrahedra <= most))
      throw MeshError("the size field would take more than " + seven_digits(most) + " tetrahedra");
  }

  const SurfaceSize& surface_;
  const Size& size_;
  LatticeOptions options_;
  Vec3 origin_{0, 0, 0};
  double unit_ = 1, leaves_ = 0;
  std::vector<Key> found_;
};

}  // namespace tunica::meshing
