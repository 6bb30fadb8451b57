// SPDX-License-Identifier: MIT
// An octree over boxes: what overlaps a box, what is nearest to a point. It knows no mesh.
#pragma once

#include "tunica/core/types.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace tunica::search {

/// The nearest item of a query; item is -1 when nothing lies within the bound.
struct Nearest {
  Index item = -1;
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Items are sorted into octants by the centres of their boxes; every node keeps the tight box of
/// what it holds. Queries visit items in an order that depends on the boxes alone.
class Octree {
 public:
  Octree() = default;
  explicit Octree(std::span<const Box> boxes) : boxes_(boxes.begin(), boxes.end()) {
    items_.resize(boxes.size());
    std::iota(items_.begin(), items_.end(), Index{0});
    if (!items_.empty()) build(0, static_cast<Index>(items_.size()), 0);
  }

  [[nodiscard]] bool empty() const { return nodes_.empty(); }

  /// Calls visit(item) for every item whose box overlaps the box (touching counts).
  template <class Visit>
  void overlapping(const Box& box, Visit&& visit) const {
    if (!empty()) overlapping(0, box, visit);
  }

  /// The item with the least squared_distance(item), which must not be less than the squared
  /// distance to its box; ties go to the lower item.
  template <class SquaredDistance>
  [[nodiscard]] Nearest nearest(const Vec3& x, SquaredDistance&& squared_distance,
                                double bound = std::numeric_limits<double>::infinity()) const {
    Nearest best{-1, bound};
    if (!empty()) nearest(0, x, squared_distance, best);
    return best;
  }

 private:
  struct Node {
    Box box;
    Index begin = 0, end = 0;        // range of items_
    Index child = -1, children = 0;  // range of nodes_; a leaf has none
  };
  static constexpr Index leaf_size = 8;
  static constexpr int max_depth = 32;

  void build(Index begin, Index end, int depth) {
    nodes_.push_back(tight(begin, end));
    split(0, depth);
  }

  [[nodiscard]] Node tight(Index begin, Index end) const {
    Node n;
    n.begin = begin, n.end = end;
    for (Index i = begin; i < end; ++i) n.box.extend(box_of(i));
    return n;
  }

  [[nodiscard]] const Box& box_of(Index slot) const {
    return boxes_[static_cast<std::size_t>(items_[static_cast<std::size_t>(slot)])];
  }

  void split(std::size_t node, int depth) {
    const Index begin = nodes_[node].begin, end = nodes_[node].end;
    if (end - begin <= leaf_size || depth == max_depth) return;
    Box centres;
    for (Index i = begin; i < end; ++i) centres.extend(box_of(i).centre());
    if (centres.diagonal() == 0) return;
    const Vec3 middle = centres.centre();
    const auto octant = [&](Index item) {
      const Vec3 c = boxes_[static_cast<std::size_t>(item)].centre();
      return static_cast<std::size_t>((c[0] > middle[0]) + 2 * (c[1] > middle[1]) + 4 * (c[2] > middle[2]));
    };
    std::array<std::vector<Index>, 8> bins;  // stable: items stay in ascending order
    for (Index i = begin; i < end; ++i) {
      const Index item = items_[static_cast<std::size_t>(i)];
      bins[octant(item)].push_back(item);
    }
    Index at = begin;
    const Index first = static_cast<Index>(nodes_.size());
    Index children = 0;
    for (const auto& bin : bins) {
      if (bin.empty()) continue;
      const Index from = at;
      for (const Index item : bin) items_[static_cast<std::size_t>(at++)] = item;
      nodes_.push_back(tight(from, at));
      ++children;
    }
    nodes_[node].child = first, nodes_[node].children = children;
    for (Index c = 0; c < children; ++c) split(static_cast<std::size_t>(first + c), depth + 1);
  }

  template <class Visit>
  void overlapping(Index node, const Box& box, Visit& visit) const {
    const Node& n = nodes_[static_cast<std::size_t>(node)];
    if (!n.box.overlaps(box)) return;
    for (Index c = 0; c < n.children; ++c) overlapping(n.child + c, box, visit);
    if (n.children > 0) return;
    for (Index i = n.begin; i < n.end; ++i)
      if (box_of(i).overlaps(box)) visit(items_[static_cast<std::size_t>(i)]);
  }

  template <class SquaredDistance>
  void nearest(Index node, const Vec3& x, SquaredDistance& squared_distance, Nearest& best) const {
    const Node& n = nodes_[static_cast<std::size_t>(node)];
    if (n.children == 0) {
      for (Index i = n.begin; i < n.end; ++i) {
        if (box_of(i).squared_distance(x) > best.squared_distance) continue;
        const Index item = items_[static_cast<std::size_t>(i)];
        const double d = squared_distance(item);
        if (d < best.squared_distance || (d == best.squared_distance && (best.item < 0 || item < best.item)))
          best = {item, d};
      }
      return;
    }
    std::array<std::pair<double, Index>, 8> order;  // nearest child first
    for (Index c = 0; c < n.children; ++c) {
      std::pair<double, Index> entry{nodes_[static_cast<std::size_t>(n.child + c)].box.squared_distance(x),
                                     n.child + c};
      Index at = c;
      for (; at > 0 && entry < order[static_cast<std::size_t>(at - 1)]; --at)
        order[static_cast<std::size_t>(at)] = order[static_cast<std::size_t>(at - 1)];
      order[static_cast<std::size_t>(at)] = entry;
    }
    for (Index c = 0; c < n.children; ++c) {
      const auto& [distance, child] = order[static_cast<std::size_t>(c)];
      if (distance <= best.squared_distance) nearest(child, x, squared_distance, best);
    }
  }

  std::vector<Box> boxes_;
  std::vector<Index> items_;
  std::vector<Node> nodes_;
};

}  // namespace tunica::search
