// SPDX-License-Identifier: MIT
// A free node moves to where the worst tetrahedron around it is best: a search over 14 directions
// with a shrinking step, which gives up a place at its first tetrahedron that is too bad.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/improve_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Faces that see the node: its tetrahedra are (face, node). Also used for nodes yet to be made.
class ImprovePlace {
 public:
  std::vector<Triple> faces;  // the node lies on the side that orient3d(face, node) > 0 names

  /// Worst quality at x; stops below the floor. The worst face of the last place comes first.
  [[nodiscard]] double worst(const TetComplex& c, const Vec3& x, double floor) {
    double least = 2;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Triple& f = faces[i];
      const double q = sine_quality(c.point(f[0]), c.point(f[1]), c.point(f[2]), x);
      least = std::min(least, q);
      if (least <= floor) {
        if (i > 0) std::swap(faces[i], faces[i / 2]);  // it moves to the front as it fails again
        return least;
      }
    }
    return least;
  }

  /// The best place found from x on, whose worst quality is `value`. scale: the first step.
  [[nodiscard]] Vec3 climb(const TetComplex& c, Vec3 x, double& value, double scale, int rounds) {
    double step = scale;
    for (int round = 0; round < rounds; ++round) {
      Vec3 best = x;
      for (const Vec3& d : directions()) {
        const Vec3 y = vec::along(x, step, d);
        const double q = worst(c, y, value);
        if (q > value) value = q, best = y;
      }
      if (vec::equal(best, x)) step *= 0.5;
      x = best;
    }
    return x;
  }

 private:
  [[nodiscard]] static const std::array<Vec3, 14>& directions() {
    static const std::array<Vec3, 14> all = [] {
      std::array<Vec3, 14> d;
      std::size_t n = 0;
      for (int k = 0; k < 3; ++k)
        for (const double s : {-1.0, 1.0}) d[n] = Vec3(0, 0, 0), d[n++][k] = s;
      constexpr double r = 0.57735026918962576;
      for (int i = 0; i < 8; ++i) d[n++] = Vec3(i & 1 ? r : -r, i & 2 ? r : -r, i & 4 ? r : -r);
      return d;
    }();
    return all;
  }
};

class ImproveSmooth {
 public:
  explicit ImproveSmooth(ImproveMesh& mesh) : m_(mesh) {}

  /// True when the node moved and the worst tetrahedron around it got better.
  bool smooth(Index node) {
    if (!m_.free(node)) return false;
    TetComplex& c = m_.c;
    const auto i_node = static_cast<std::size_t>(node);
    if (i_node >= in_vain_.size()) in_vain_.resize(c.points.size());
    if (in_vain_[i_node] > 0 && !m_.changed(node, in_vain_[i_node])) return false;
    c.star(node, star_);
    const double before = m_.worst(star_);
    place_.faces.clear();
    Vec3 middle(0, 0, 0);
    double length = 0;
    for (const Index t : star_) {
      const int i = c.local(t, node);
      const Triple f = c.face(t, i);
      place_.faces.push_back({f[0], f[2], f[1]});
      for (const Index n : f) {
        middle = vec::plus(middle, c.point(n));
        length += vec::distance(c.point(n), c.point(node));
      }
    }
    const double count = 3 * static_cast<double>(star_.size());
    middle = vec::divided(middle, count), length /= count;
    double value = before;
    Vec3 x = c.point(node);
    if (const double q = place_.worst(c, middle, value); q > value) value = q, x = middle;
    x = place_.climb(c, x, value, 0.2 * length, value < poor ? many_rounds : rounds);
    if (!(value > before * (1 + 1e-3) + 1e-9)) {
      in_vain_[i_node] = m_.moment();
      return false;
    }
    c.points[static_cast<std::size_t>(node)] = x;
    for (const Index t : star_) m_.update(t);
    return true;
  }

 private:
  // Nearly flat tetrahedra leave room for steps at their own height alone.
  static constexpr int rounds = 12, many_rounds = 60;
  static constexpr double poor = 1e-3;
  ImproveMesh& m_;
  std::vector<ImproveMesh::Moment> in_vain_;  // of each node: when its last search failed
  std::vector<Index> star_;
  ImprovePlace place_;
};

}  // namespace tunica::meshing
