// SPDX-License-Identifier: MIT
// The sections in which planes and discs cross the inside of an image, edge by edge of its grid, and the
// parts of the inside on either side of them.
#pragma once

#include "tunica/core/vec.hpp"
#include "tunica/meshing/flat_vertex.hpp"
#include "tunica/meshing/grid_crossing.hpp"
#include "tunica/meshing/hermite.hpp"
#include "tunica/meshing/padded_bits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tunica::meshing::detail {

/// A plane with a region of its own, or a disc.
struct GridCut {
  HermiteRegion plane;
  double radius;
  double slack = 0;  // edges at the rim of a section reach so far beyond it

  [[nodiscard]] bool holds(const Vec3& x) const { return vec::distance(x, plane.point) <= radius + slack; }
};

/// An edge between two inside nodes on either side of a plane.
struct GridEdge {
  std::size_t behind, front;  // node numbers
  friend bool operator==(const GridEdge&, const GridEdge&) = default;
  friend bool operator<(const GridEdge& a, const GridEdge& b) {
    return a.behind != b.behind ? a.behind < b.behind : a.front < b.front;
  }
};

/// Edges that hang together where a plane crosses the inside.
struct GridSection {
  std::vector<GridEdge> edges;
  Vec3 centre{0, 0, 0};
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;  // from the point of the cut
};

/// Nodes by number, x fastest, and what planes make of them.
class GridSections {
 public:
  GridSections(const std::array<std::vector<double>, 3>& axes, PaddedBits& bits) : axes_(axes), bits_(bits) {
    double least = std::numeric_limits<double>::infinity();
    Vec3 most(0, 0, 0);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 0; i + 1 < axes[a].size(); ++i) {
        const double step = axes[a][i + 1] - axes[a][i];
        least = std::min(least, step), most[static_cast<int>(a)] = std::max(most[static_cast<int>(a)], step);
      }
    nearest_ = on_plane * least, widest_ = vec::length(most);
  }

  [[nodiscard]] double nearest() const { return nearest_; }  // less is no distance from a plane
  [[nodiscard]] double widest() const { return widest_; }    // diagonal of a cell
  [[nodiscard]] Vec3 point(const GridNode& n) const {
    return {axes_[0][n[0]], axes_[1][n[1]], axes_[2][n[2]]};
  }
  [[nodiscard]] double distance(const GridCut& cut, const GridNode& n) const {
    return plane_distance(cut.plane, point(n), nearest_);
  }
  [[nodiscard]] std::size_t count() const { return axes_[0].size() * axes_[1].size() * axes_[2].size(); }
  [[nodiscard]] std::size_t number(const GridNode& n) const {
    return n[0] + axes_[0].size() * (n[1] + axes_[1].size() * n[2]);
  }
  [[nodiscard]] GridNode node(std::size_t number) const {
    return {number % axes_[0].size(), number / axes_[0].size() % axes_[1].size(),
            number / axes_[0].size() / axes_[1].size()};
  }
  [[nodiscard]] bool inside(const GridNode& n) const { return bits_.inside(n[0] + 1, n[1] + 1, n[2] + 1); }
  void drop(const GridNode& n) { bits_.drop(n[0] + 1, n[1] + 1, n[2] + 1); }

  /// In ascending order.
  template <class Visit>
  void for_inside(Visit&& visit) const {
    for (std::size_t k = 0; k < axes_[2].size(); ++k)
      for (std::size_t j = 0; j < axes_[1].size(); ++j) {
        if (!bits_.any(j + 1, k + 1)) continue;
        for (std::size_t w = 0; w < bits_.words(); ++w)
          for (std::uint64_t some = bits_.row(j + 1, k + 1)[w]; some != 0; some &= some - 1)
            visit(GridNode{word_bits * w + static_cast<unsigned>(std::countr_zero(some)) - 1, j, k});
      }
  }

  /// visit(neighbour) for the inside nodes next to a node.
  template <class Visit>
  void for_next(const GridNode& n, Visit&& visit) const {
    for (std::size_t a = 0; a < 3; ++a)
      for (const bool up : {false, true}) {
        GridNode m = n;
        if (up ? ++m[a] == axes_[a].size() : m[a]-- == 0) continue;
        if (inside(m)) visit(m);
      }
  }

  /// All edges that the plane of a cut crosses, however far from its point, by sections.
  [[nodiscard]] std::vector<GridSection> sections(const GridCut& cut) const {
    std::vector<GridEdge> edges;
    for_inside([&](const GridNode& n) {
      if (!(distance(cut, n) < 0)) return;
      for_next(n, [&](const GridNode& m) {
        if (distance(cut, m) >= 0) edges.push_back({number(n), number(m)});
      });
    });
    std::sort(edges.begin(), edges.end());  // by the node behind
    std::vector<char> taken(edges.size(), 0);
    std::vector<GridSection> result;
    for (std::size_t first = 0; first < edges.size(); ++first) {
      if (taken[first] != 0) continue;
      GridSection s;
      std::vector<std::size_t> stack{first};
      taken[first] = 1;
      while (!stack.empty()) {
        const GridEdge e = edges[stack.back()];
        stack.pop_back();
        s.edges.push_back(e);
        const Vec3 p = point(node(e.behind)), q = point(node(e.front));
        const double d = distance(cut, node(e.behind)), f = distance(cut, node(e.front));
        const Vec3 x = vec::between(p, q, d / (d - f));
        s.centre = vec::plus(s.centre, x);
        const double off = vec::distance(x, cut.plane.point);
        s.nearest = std::min(s.nearest, off), s.farthest = std::max(s.farthest, off);
        for_around(node(e.behind), [&](std::size_t other) {
          for (auto at = std::lower_bound(edges.begin(), edges.end(), GridEdge{other, 0});
               at != edges.end() && at->behind == other; ++at) {
            const auto i = static_cast<std::size_t>(at - edges.begin());
            if (taken[i] == 0) taken[i] = 1, stack.push_back(i);
          }
        });
      }
      s.centre = vec::divided(s.centre, static_cast<double>(s.edges.size()));
      result.push_back(std::move(s));
    }
    return result;
  }

 private:
  /// The numbers of the node and of those around it, also diagonally.
  template <class Visit>
  void for_around(const GridNode& n, Visit&& visit) const {
    for (std::size_t k = n[2] - (n[2] > 0); k <= n[2] + 1 && k < axes_[2].size(); ++k)
      for (std::size_t j = n[1] - (n[1] > 0); j <= n[1] + 1 && j < axes_[1].size(); ++j)
        for (std::size_t i = n[0] - (n[0] > 0); i <= n[0] + 1 && i < axes_[0].size(); ++i)
          visit(number({i, j, k}));
  }

  const std::array<std::vector<double>, 3>& axes_;
  PaddedBits& bits_;
  double nearest_, widest_;
};

/// The parts of the inside that hang together, edge by edge, once some edges are severed: those next to a
/// severed edge have numbers.
class GridParts {
 public:
  static constexpr std::size_t none = 0;

  GridParts(const GridSections& grid, const std::vector<GridEdge>& severed)
      : grid_(grid), part_(grid.count(), 0) {
    sizes_.push_back(0), behind_.push_back(0), front_.push_back(0);
    for (const GridEdge& e : severed) {
      behind_[fill(e.behind, severed)] = 1;
      front_[fill(e.front, severed)] = 1;
    }
  }

  [[nodiscard]] std::size_t of(const GridNode& n) const { return part_[grid_.number(n)]; }
  /// A part lies on both sides.
  [[nodiscard]] bool leaks() const {
    for (std::size_t p = 1; p < sizes_.size(); ++p)
      if (behind_[p] != 0 && front_[p] != 0) return true;
    return false;
  }
  [[nodiscard]] bool behind(std::size_t part) const { return behind_[part] != 0; }
  [[nodiscard]] std::size_t largest() const {
    return static_cast<std::size_t>(std::max_element(sizes_.begin() + 1, sizes_.end()) - sizes_.begin());
  }
  [[nodiscard]] std::size_t nearest_to(const Vec3& x) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = none;
    grid_.for_inside([&](const GridNode& n) {
      if (of(n) == none) return;
      if (const double d = vec::distance(grid_.point(n), x); d < least) least = d, best = of(n);
    });
    return best;
  }

 private:
  /// The part of a node, which is flooded unless it is known.
  std::size_t fill(std::size_t start, const std::vector<GridEdge>& severed) {
    if (part_[start] != none) return part_[start];
    const auto number = static_cast<std::uint32_t>(sizes_.size());
    sizes_.push_back(0), behind_.push_back(0), front_.push_back(0);
    std::vector<std::size_t> stack{start};
    part_[start] = number;
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      ++sizes_[number];
      grid_.for_next(grid_.node(at), [&](const GridNode& m) {
        const std::size_t next = grid_.number(m);
        const auto cut = [&](std::size_t p, std::size_t q) {
          return std::binary_search(severed.begin(), severed.end(), GridEdge{p, q});
        };
        if (part_[next] != none || cut(at, next) || cut(next, at)) return;
        part_[next] = number, stack.push_back(next);
      });
    }
    return number;
  }

  const GridSections& grid_;
  std::vector<std::uint32_t> part_;  // of a node
  std::vector<std::size_t> sizes_;   // nodes
  std::vector<char> behind_, front_;
};

}  // namespace tunica::meshing::detail
