// SPDX-License-Identifier: MIT
// Flat ends beside layers: what is inside of the rim follows its columns, by displacements that are harmonic
// on the end's own triangles. Linear displacements are kept: a disc shrinks evenly. [PINKALL93]
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/meshing/layer_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::meshing {

class LayerCaps {
 public:
  explicit LayerCaps(const LayerSheet& sheet)
      : sheet_(sheet),
        planes_(flat_regions(sheet.surface)),
        cells_(mesh::cells_of_nodes(sheet.surface.cells, sheet.surface.node_count())),
        unknown_(at(sheet.surface.node_count()), -1) {
    const mesh::Surface& s = sheet.surface;
    std::vector<char> touched(planes_.size(), 0);  // ends that a column moves
    for (Index t = 0; t < s.cell_count(); ++t)
      for (const Index n : sheet.corners(t))
        if (sheet.carries[at(t)] == 0 && sheet.grows(n)) touched[at(s.region_of(t))] = 1;
    for (Index t = 0; t < s.cell_count(); ++t)
      if (sheet.carries[at(t)] == 0 && touched[at(s.region_of(t))] != 0) triangles_.push_back(t);
    for (Index n = 0; n < s.node_count(); ++n) {
      if (cells_[n].empty()) continue;
      const Index r = s.region_of(cells_[n][0]);
      const auto inside = [&](Index t) { return sheet.carries[at(t)] == 0 && s.region_of(t) == r; };
      if (touched[at(r)] == 0 || !std::all_of(cells_[n].begin(), cells_[n].end(), inside)) continue;
      unknown_[at(n)] = static_cast<Index>(nodes_.size());
      nodes_.push_back(n);
    }
    for (const Index n : nodes_) weigh(n);
  }

  /// Displacements of the nodes inside of the ends from those of all others, in place.
  void follow(std::vector<Vec3>& move) const {
    if (nodes_.empty()) return;
    // Conjugate gradients on all three coordinates at once, preconditioned by the diagonal.
    const std::size_t count = nodes_.size();
    std::vector<Vec3> residual(count), search(count), image(count);
    double size = 0, first = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Vec3 sum(0, 0, 0);
      for (Index e = offset_[i]; e < offset_[i + 1]; ++e) {
        const Link& l = links_[at(e)];
        sum = vec::along(sum, l.weight, vec::minus(move[at(l.to)], move[at(nodes_[i])]));
      }
      residual[i] = sum;
      search[i] = vec::divided(sum, diagonal_[i]);
      size += vec::dot(residual[i], search[i]);
      for (Index e = offset_[i]; e < offset_[i + 1]; ++e)
        first += links_[at(e)].weight * vec::squared(move[at(links_[at(e)].to)]);
    }
    constexpr double accuracy = 1e-20;  // of the squared residual
    for (std::size_t it = 0; it < 10 * count && size > accuracy * first; ++it) {
      double curvature = 0;
      for (std::size_t i = 0; i < count; ++i) {
        Vec3 sum = vec::scaled(diagonal_[i], search[i]);
        for (Index e = offset_[i]; e < offset_[i + 1]; ++e)
          if (const Index j = unknown_[at(links_[at(e)].to)]; j >= 0)
            sum = vec::along(sum, -links_[at(e)].weight, search[at(j)]);
        image[i] = sum;
        curvature += vec::dot(search[i], sum);
      }
      if (!(curvature > 0)) break;
      const double step = size / curvature;
      double next = 0;
      for (std::size_t i = 0; i < count; ++i) {
        move[at(nodes_[i])] = vec::along(move[at(nodes_[i])], step, search[i]);
        residual[i] = vec::along(residual[i], -step, image[i]);
        next += vec::squared(residual[i]) / diagonal_[i];
      }
      for (std::size_t i = 0; i < count; ++i)
        search[i] = vec::along(vec::divided(residual[i], diagonal_[i]), next / size, search[i]);
      size = next;
    }
  }

  /// Nodes with columns nearest to triangles of the ends that the displacements fold or flatten, ascending.
  [[nodiscard]] std::vector<Index> folded(const std::vector<Vec3>& move) const {
    constexpr double flat = 0.02;  // of the area that there was
    std::vector<Index> list;
    for (const Index t : triangles_) {
      const auto c = sheet_.corners(t);
      const mesh::Triangle old = mesh::triangle(sheet_.surface, t);
      const mesh::Triangle now{moved(c[0], move), moved(c[1], move), moved(c[2], move)};
      const Vec3& up = planes_[at(sheet_.surface.region_of(t))]->normal;
      if (!(vec::dot(now.area_vector(), up) > flat * old.area())) columns_near(c, list);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  [[nodiscard]] const Vec3& normal(Index region) const { return planes_[at(region)]->normal; }

  /// Walks over the triangles from these nodes outward, to the first ring that has columns.
  void columns_near(const std::array<Index, 3>& from, std::vector<Index>& list) const {
    std::vector<Index> ring(from.begin(), from.end()), seen = ring;
    for (bool found = false; !found && !ring.empty();) {
      std::vector<Index> next;
      for (const Index n : ring) {
        if (sheet_.grows(n)) found = true, list.push_back(n);
        if (unknown_[at(n)] < 0) continue;
        for (Index e = offset_[at(unknown_[at(n)])]; e < offset_[at(unknown_[at(n)]) + 1]; ++e) {
          const Index m = links_[at(e)].to;
          if (std::find(seen.begin(), seen.end(), m) != seen.end()) continue;
          seen.push_back(m), next.push_back(m);
        }
      }
      ring = std::move(next);
    }
  }

 private:
  struct Link {
    Index to;
    double weight;
  };

  template <class I>
  [[nodiscard]] static std::size_t at(I i) {
    return static_cast<std::size_t>(i);
  }
  [[nodiscard]] Vec3 moved(Index n, const std::vector<Vec3>& move) const {
    return vec::plus(sheet_.node(n), move[at(n)]);
  }

  /// Half the sum of the cotangents across each edge, symmetric, held above zero.
  void weigh(Index n) {
    constexpr double least = 0.01;
    const std::size_t begin = links_.size();
    for (const Index t : cells_[n]) {
      const auto c = sheet_.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const Index m = c[k], other = c[(k + 1) % 3] == n ? c[(k + 2) % 3] : c[(k + 1) % 3];
        if (m == n) continue;
        const Vec3 u = vec::minus(sheet_.node(n), sheet_.node(other)),
                   v = vec::minus(sheet_.node(m), sheet_.node(other));
        const double half = 0.5 * vec::dot(u, v) / std::max(vec::length(vec::cross(u, v)), 1e-300);
        std::size_t i = begin;
        while (i < links_.size() && links_[i].to != m) ++i;
        if (i == links_.size()) links_.push_back({m, 0});
        links_[i].weight += half;
      }
    }
    double sum = 0;
    for (std::size_t i = begin; i < links_.size(); ++i)
      sum += links_[i].weight = std::clamp(links_[i].weight, least, 1 / least);
    offset_.push_back(static_cast<Index>(links_.size()));
    diagonal_.push_back(sum);
  }

  const LayerSheet& sheet_;
  std::vector<std::optional<Plane>> planes_;
  mesh::Rows cells_;
  std::vector<Index> triangles_, nodes_,
      unknown_;  // of ends that move; nodes inside of them and their number
  std::vector<Index> offset_{0};
  std::vector<Link> links_;  // of node i of nodes_: offset_[i] ... offset_[i + 1]
  std::vector<double> diagonal_;
};

}  // namespace tunica::meshing
