// SPDX-License-Identifier: MIT
// An octree over boxes: what overlaps a box, what overlaps each other, what is nearest to a point. It knows
// no mesh.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/search/eight_boxes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tunica::search {

/// The nearest item of a query; item is -1 when nothing lies within the bound.
struct Nearest {
  Index item = -1;
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Items are sorted along Morton's curve through the octants of the centres of their boxes [MORTON66]: each
/// octant is a range of them, halved further while it has more than eight. A node keeps the boxes of its
/// items, or of the nodes below, in single precision and a little too wide, so that queries may visit more
/// than they need, never less. The order of visits depends on the boxes alone. A box that is empty is met by
/// no query.
class Octree {
 public:
  Octree() = default;
  explicit Octree(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
    Box all;
    for (const Box& b : boxes_) all.extend(b);
    double extent = 0;
    for (int a = 0; a < 3; ++a) extent = std::max(extent, all.hi[a] - all.lo[a]);
    from_ = all.lo, scale_ = extent > 0 && std::isfinite(extent) ? 1 / extent : 1;
    std::vector<Key> keys(boxes_.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = {code(boxes_[i]), static_cast<Index>(i)};
    sort(keys);
    if (!keys.empty()) build(keys, 0, keys.size(), 3 * axis_bits);
  }

  [[nodiscard]] bool empty() const { return boxes_.empty(); }

  /// Calls visit(item) for every item whose box overlaps the box (touching counts).
  template <class Visit>
  void overlapping(const Box& box, Visit&& visit) const {
    if (!empty()) overlapping(nodes_.back(), box, small(box), visit);
  }

  /// Calls visit(i, j), i < j, once for each two items whose boxes overlap or touch, and for some whose boxes
  /// miss each other by less than a millionth of the size of all of them.
  template <class Visit>
  void pairs(Visit&& visit) const {
    if (!empty()) within(nodes_.back(), visit);
  }

  /// The item with the least squared_distance(item), which must not be less than the squared
  /// distance to its box; ties go to the lower item. An item within `enough` [length^2] may be given for
  /// the nearest one.
  template <class SquaredDistance>
  [[nodiscard]] Nearest nearest(const Vec3& x, SquaredDistance&& squared_distance,
                                double bound = std::numeric_limits<double>::infinity(),
                                double enough = -1) const {
    Search<SquaredDistance> search{squared_distance, enough, {}, {-1, bound}, 0};
    for (std::size_t a = 0; a < 3; ++a)
      search.x[a] = static_cast<float>(std::clamp(
          (x[static_cast<Eigen::Index>(a)] - from_[static_cast<Eigen::Index>(a)]) * scale_, -far, far));
    search.bound = bound_of(bound);
    if (!empty()) nearest(nodes_.back(), search);
    return search.best;
  }

 private:
  struct Key {
    std::uint64_t code;
    Index item;
  };
  template <class SquaredDistance>
  struct Search {
    SquaredDistance& squared_distance;
    double enough;
    std::array<float, 3> x;
    Nearest best;
    float bound;  // on squares of distances from small boxes
    [[nodiscard]] bool done() const { return best.squared_distance <= enough; }
  };
  /// Up to eight items, or nodes below.
  struct Node {
    detail::EightBoxes boxes;
    std::array<Index, detail::EightBoxes::count> child{};  // item or node
    bool leaf = true;
  };
  static constexpr unsigned axis_bits = 16, digit_bits = 12;  // of the curve; of a digit when sorting
  // What is lost by rounding to single precision: of a coordinate from 0 to 1 and of a point within 4 of it;
  // and, of a point farther off, relative to its squared distance.
  static constexpr float slack = 0x1p-21F;
  static constexpr double relative_slack = 1e-5, far = 1e15;

  [[nodiscard]] detail::SmallBox small(const Box& b) const {
    detail::SmallBox s;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto e = static_cast<Eigen::Index>(a);
      s.lo[a] = static_cast<float>(std::min((b.lo[e] - from_[e]) * scale_, far)) - slack;
      s.hi[a] = static_cast<float>(std::max((b.hi[e] - from_[e]) * scale_, -far)) + slack;
    }
    return s;
  }
  [[nodiscard]] float bound_of(double squared) const {
    return static_cast<float>(std::min(squared * scale_ * scale_ * (1 + relative_slack), 1e38));
  }

  /// The bits of the cell of its centre, of the three axes in turn.
  [[nodiscard]] std::uint64_t code(const Box& b) const {
    std::uint64_t result = 0;
    for (unsigned a = 0; a < 3; ++a) {
      constexpr double last = (1U << axis_bits) - 1;
      const double cell = (0.5 * (b.lo[a] + b.hi[a]) - from_[a]) * scale_ * last;
      std::uint64_t x = cell > 0 ? static_cast<std::uint64_t>(std::min(cell, last)) : 0U;  // NaN: 0
      x = (x | x << 16U) & 0x0000FF0000FFU;
      x = (x | x << 8U) & 0x00F00F00F00FU;
      x = (x | x << 4U) & 0x0C30C30C30C3U;
      x = (x | x << 2U) & 0x249249249249U;
      result |= x << a;
    }
    return result;
  }

  /// By their codes, equal ones as they stand.
  static void sort(std::vector<Key>& keys) {
    std::vector<Key> other(keys.size());
    for (unsigned shift = 0; shift < 3 * axis_bits; shift += digit_bits) {
      std::array<std::uint32_t, 1U << digit_bits> first{};
      const auto digit = [shift](const Key& k) { return k.code >> shift & ((1U << digit_bits) - 1); };
      for (const Key& k : keys) ++first[digit(k)];
      std::uint32_t sum = 0;
      for (std::uint32_t& f : first) sum += std::exchange(f, sum);
      for (const Key& k : keys) other[first[digit(k)]++] = k;
      keys.swap(other);
    }
  }

  /// The node of a range of keys that agree above the bit; its number. Those below come before it.
  Index build(const std::vector<Key>& keys, std::size_t begin, std::size_t end, unsigned bit) {
    constexpr std::size_t most = detail::EightBoxes::count;
    Node node;
    if (end - begin <= most) {
      for (std::size_t i = begin; i < end; ++i) {
        const Box& box = boxes_[static_cast<std::size_t>(keys[i].item)];
        node.child[i - begin] = keys[i].item;
        if (box.lo[0] <= box.hi[0]) node.boxes.put(i - begin, small(box));
      }
    } else {
      node.leaf = false;
      const std::size_t share = (end - begin + most - 1) / most;  // of equal keys
      std::size_t from = begin;
      for (std::size_t c = 0; from < end; ++c) {
        std::size_t to = std::min(end, from + share);
        if (bit > 0) {
          const auto octant = [&](std::size_t i) { return keys[i].code >> (bit - 3) & 7U; };
          for (to = from + 1; to < end && octant(to) == octant(from);) ++to;
          if (to - from == end - begin) return build(keys, begin, end, bit - 3);
        }
        node.child[c] = build(keys, from, to, bit > 0 ? bit - 3 : 0);
        node.boxes.put(c, nodes_[static_cast<std::size_t>(node.child[c])].boxes.all());
        from = to;
      }
    }
    nodes_.push_back(node);
    return static_cast<Index>(nodes_.size() - 1);
  }

  [[nodiscard]] const Node& below(const Node& n, std::size_t i) const {
    return nodes_[static_cast<std::size_t>(n.child[i])];
  }

  template <class Visit>
  void overlapping(const Node& n, const Box& box, const detail::SmallBox& near, Visit& visit) const {
    for (unsigned found = n.boxes.overlapping(near); found != 0; found &= found - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(found));
      if (!n.leaf)
        overlapping(below(n, i), box, near, visit);
      else if (boxes_[static_cast<std::size_t>(n.child[i])].overlaps(box))
        visit(n.child[i]);
    }
  }

  /// Pairs within a node.
  template <class Visit>
  void within(const Node& n, Visit& visit) const {
    for (std::size_t i = 0; i < detail::EightBoxes::count; ++i) {
      const detail::SmallBox box = n.boxes.at(i);
      if (box.empty()) continue;
      if (!n.leaf) within(below(n, i), visit);
      meet(n, i, n, n.boxes.overlapping(box) & ~0U << (i + 1), visit);
    }
  }

  /// Box i of node n and those of node m, of the same kind, whose bits are set.
  template <class Visit>
  void meet(const Node& n, std::size_t i, const Node& m, unsigned found, Visit& visit) const {
    for (; found != 0; found &= found - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(found));
      if (n.leaf)
        visit(std::min(n.child[i], m.child[j]), std::max(n.child[i], m.child[j]));
      else
        between(below(n, i), below(m, j), m.boxes.at(j), visit);
    }
  }

  /// Pairs of one box of n and one of m; `bounds` are those of m.
  template <class Visit>
  void between(const Node& n, const Node& m, const detail::SmallBox& bounds, Visit& visit) const {
    if (n.leaf && !m.leaf) return between(m, n, n.boxes.all(), visit);
    for (unsigned near = n.boxes.overlapping(bounds); near != 0; near &= near - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(near));
      if (n.leaf == m.leaf)
        meet(n, i, m, m.boxes.overlapping(n.boxes.at(i)), visit);
      else
        between(below(n, i), m, bounds, visit);
    }
  }

  /// Nearest boxes first.
  template <class SquaredDistance>
  void nearest(const Node& n, Search<SquaredDistance>& search) const {
    auto near = n.boxes.near(search.x, search.bound);
    while (near.bits != 0) {
      auto i = static_cast<std::size_t>(std::countr_zero(near.bits));
      for (unsigned others = near.bits & (near.bits - 1); others != 0; others &= others - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(others));
        if (near.square[j] < near.square[i]) i = j;
      }
      if (near.square[i] > search.bound) return;
      near.bits &= ~(1U << i);
      if (!n.leaf) {
        nearest(below(n, i), search);
      } else {
        const Index item = n.child[i];
        const double d = search.squared_distance(item);
        Nearest& best = search.best;
        if (d < best.squared_distance || (d == best.squared_distance && (best.item < 0 || item < best.item)))
          best = {item, d}, search.bound = bound_of(d);
      }
      if (search.done()) return;
    }
  }

  std::vector<Box> boxes_;
  Vec3 from_{0, 0, 0};
  double scale_ = 1;
  std::vector<Node> nodes_;  // the root last
};

}  // namespace tunica::search
