// SPDX-License-Identifier: MIT
// Principal curvatures at the nodes of a triangulated surface: a cubic is fitted to the nodes around each in
// the frame of its normal (an osculating jet). [CAZALS05]
#pragma once

#include "tunica/core/parallel.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/facets.hpp"
#include "tunica/meshing/vertex_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// Of one node [1/unit], positive where the surface is convex; least <= most.
struct Curvature {
  double least = 0, most = 0;

  /// The larger of their sizes.
  [[nodiscard]] double sharpest() const { return std::max(std::abs(least), std::abs(most)); }

  /// What an equilateral triangle deviates by: its distance from the paraboloid has a standard deviation of
  /// 0.0279 times this times the edge squared, when both curvatures count. That of a cylinder is its
  /// curvature; a saddle has 1.63 times as much.
  [[nodiscard]] double deviating() const {
    return std::sqrt((3 * least * least + 3 * most * most - 2 * least * most) / 3);
  }
};

struct CurvatureOptions {
  int rings = 3;  // of neighbours to which the jet is fitted
  double sharp_angle =
      180;  // [degrees] edges that turn by more are taken for rims; 180: only rims of regions
};

namespace detail {

/// Least squares of z = sum of coefficients times monomials up to the third order, by normal equations in
/// coordinates of length about 1.
class JetFit {
 public:
  static constexpr std::size_t quadratic = 6, cubic = 10;

  explicit JetFit(std::size_t terms) : terms_(terms) {}

  void add(double x, double y, double z, double weight) {
    const std::array<double, cubic> m{1,         x,         y,         x * x / 2, x * y,
                                      y * y / 2, x * x * x, x * x * y, x * y * y, y * y * y};
    for (std::size_t i = 0; i < terms_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) a_[i][j] += weight * m[i] * m[j];
      b_[i] += weight * m[i] * z;
    }
    ++samples_;
  }
  [[nodiscard]] std::size_t samples() const { return samples_; }

  /// Cholesky's factors; false where the samples do not determine the jet.
  [[nodiscard]] bool solve() {
    constexpr double singular = 1e-10;
    for (std::size_t i = 0; i < terms_; ++i) {
      const double diagonal = a_[i][i];
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = a_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= a_[i][k] * a_[j][k];
        if (j < i) {
          a_[i][j] = sum / a_[j][j];
        } else {
          if (!(sum > singular * diagonal)) return false;
          a_[i][i] = std::sqrt(sum);
        }
      }
    }
    for (std::size_t i = 0; i < terms_; ++i) {
      for (std::size_t k = 0; k < i; ++k) b_[i] -= a_[i][k] * b_[k];
      b_[i] /= a_[i][i];
    }
    for (std::size_t i = terms_; i-- > 0;) {
      for (std::size_t k = i + 1; k < terms_; ++k) b_[i] -= a_[k][i] * b_[k];
      b_[i] /= a_[i][i];
    }
    return true;
  }

  /// Of the graph z(x, y) at the origin: eigenvalues of the second form by the first, negative where z falls
  /// away on both sides.
  [[nodiscard]] Curvature curvature() const {
    const double p = b_[1], q = b_[2];
    const double w = std::sqrt(1 + p * p + q * q);
    const double e = 1 + p * p, f = p * q, g = 1 + q * q;
    const double l = b_[3] / w, m = b_[4] / w, n = b_[5] / w;
    const double mean = (e * n - 2 * f * m + g * l) / (2 * (e * g - f * f));
    const double gauss = (l * n - m * m) / (e * g - f * f);
    const double root = std::sqrt(std::max(mean * mean - gauss, 0.0));
    return {mean - root, mean + root};
  }

 private:
  std::size_t terms_, samples_ = 0;
  std::array<std::array<double, cubic>, cubic> a_{};
  std::array<double, cubic> b_{};
};

/// Nodes of a facet around one of them, ring by ring, as long as they face the same way.
class JetRings {
 public:
  JetRings(const mesh::Surface& s, const Facets& facets)
      : s_(s), facets_(facets), around_(mesh::cells_of_nodes(s.cells, s.node_count())) {}

  /// Each call with marks of its own: as many as nodes, none of them `mark`.
  void gather(Index n, Index facet, const Vec3& normal, int rings, std::vector<Index>& marks, Index mark,
              std::vector<Index>& found) const {
    constexpr double facing = 0.8;  // cosine to the normal: farther round the graph is no function
    found.assign(1, n);
    marks[static_cast<std::size_t>(n)] = mark;
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t end = found.size();
      for (; begin < end; ++begin)
        for (const Index t : around_[found[begin]]) {
          if (facets_.of[static_cast<std::size_t>(t)] != facet) continue;
          const Vec3 area = mesh::triangle(s_, t).area_vector();
          if (!(vec::dot(area, normal) > facing * vec::length(area))) continue;
          for (int k = 0; k < 3; ++k) {
            const Index m = s_.cells(k, t);
            if (marks[static_cast<std::size_t>(m)] == mark) continue;
            marks[static_cast<std::size_t>(m)] = mark;
            found.push_back(m);
          }
        }
    }
  }

  /// Mean normal of the triangles of a facet at a node, by their angles.
  [[nodiscard]] Vec3 normal(Index n, Index facet) const {
    Vec3 sum(0, 0, 0);
    for (const Index t : around_[n]) {
      if (facets_.of[static_cast<std::size_t>(t)] != facet) continue;
      const mesh::Triangle f = mesh::triangle(s_, t);
      const double angle = s_.cells(0, t) == n   ? corner_angle(f.a, f.b, f.c)
                           : s_.cells(1, t) == n ? corner_angle(f.b, f.c, f.a)
                                                 : corner_angle(f.c, f.a, f.b);
      sum = vec::along(sum, angle, vec::unit(f.area_vector()));
    }
    return vec::unit(sum);
  }

  [[nodiscard]] const mesh::Rows& around() const { return around_; }

 private:
  const mesh::Surface& s_;
  const Facets& facets_;
  mesh::Rows around_;
};

/// The curvature of one facet at one of its nodes.
[[nodiscard]] inline Curvature jet_curvature(const mesh::Surface& s, const std::vector<Index>& nodes,
                                             const Vec3& normal) {
  const Vec3 u = vec::orthogonal(normal), v = vec::cross(normal, u);
  const Vec3 origin = mesh::node(s, nodes.front());
  double reach = 0;
  for (const Index m : nodes) reach = std::max(reach, vec::distance(mesh::node(s, m), origin));
  if (!(reach > 0)) return {};
  // Twice as many samples as a cubic has coefficients, or a quadratic.
  for (const std::size_t terms : {JetFit::cubic, JetFit::quadratic}) {
    if (nodes.size() < (terms == JetFit::cubic ? 2 * terms : terms)) continue;
    JetFit fit(terms);
    for (const Index m : nodes) {
      const Vec3 d = vec::scaled(1 / reach, vec::minus(mesh::node(s, m), origin));
      const double far = vec::dot(d, d);
      fit.add(vec::dot(d, u), vec::dot(d, v), vec::dot(d, normal), 1 / (0.1 + far));
    }
    if (!fit.solve()) continue;
    const Curvature k = fit.curvature();
    return {-k.most / reach, -k.least / reach};  // heights run outward
  }
  return {};
}

}  // namespace detail

/// Curvatures at the nodes of a closed surface. Flat regions have none, and a rim is no curvature: a node on
/// it has that of its curved region, from the side of it that there is. Where several curved regions meet the
/// sharpest counts. Second order in the edge length for nodes on a smooth surface.
[[nodiscard]] inline std::vector<Curvature> curvatures(const mesh::Surface& s,
                                                       const CurvatureOptions& options = {}) {
  const Facets f = facets(s, options.sharp_angle);
  const detail::JetRings rings(s, f);
  std::vector<Curvature> curvature(static_cast<std::size_t>(s.node_count()));
  constexpr std::ptrdiff_t chunk = 512;
  parallel_chunks(s.node_count(), chunk, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Index> marks(static_cast<std::size_t>(s.node_count()), -1), nodes, labels;
    Index mark = 0;
    for (auto n = static_cast<Index>(begin); n < static_cast<Index>(end); ++n) {
      labels.clear();
      for (const Index t : rings.around()[n]) {
        const Index label = f.of[static_cast<std::size_t>(t)];
        if (!f.planes[static_cast<std::size_t>(label)] &&
            std::find(labels.begin(), labels.end(), label) == labels.end())
          labels.push_back(label);
      }
      for (const Index label : labels) {
        const Vec3 normal = rings.normal(n, label);
        rings.gather(n, label, normal, options.rings, marks, mark++, nodes);
        const Curvature k = detail::jet_curvature(s, nodes, normal);
        Curvature& sharpest = curvature[static_cast<std::size_t>(n)];
        if (k.sharpest() > sharpest.sharpest()) sharpest = k;
      }
    }
  });
  return curvature;
}

}  // namespace tunica::meshing
