// SPDX-License-Identifier: MIT
// Insets a block of quadrilaterals: it comes off the sheet along its border and is joined to it again by a
// ring of new quadrilaterals. Drawn in, the block makes the sheet finer there; drawn out, it is the end of a
// square tube. All quadrilaterals, conforming: nothing else of the sheet changes. [MITCHELL95]
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/wall_quads.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// The border of the block as it was, run with the block on its left, and the new nodes that took its place
/// in the block, one for each.
struct QuadInset {
  std::vector<Index> border, inner;
};

namespace detail {

/// The loop around a block of quadrilaterals without holes.
[[nodiscard]] inline std::vector<Index> border_of(const Connectivity<4>& cells,
                                                  const std::vector<Index>& block) {
  struct Side {
    Index from, to;
  };
  std::vector<Side> sides;
  for (const Index q : block)
    for (int k = 0; k < 4; ++k) {
      const Side side{cells(k, q), cells((k + 1) % 4, q)};
      const auto back = std::find_if(sides.begin(), sides.end(),
                                     [&](const Side& s) { return s.from == side.to && s.to == side.from; });
      if (back == sides.end())
        sides.push_back(side);
      else
        sides.erase(back);
    }
  std::vector<Index> loop;
  for (Index n = sides.empty() ? -1 : sides[0].from; loop.size() < sides.size();) {
    const auto side = std::find_if(sides.begin(), sides.end(), [&](const Side& s) { return s.from == n; });
    if (side == sides.end()) break;
    loop.push_back(n);
    n = side->to;
  }
  std::vector<Index> once = loop;
  std::sort(once.begin(), once.end());
  [[maybe_unused]] const bool simple = std::adjacent_find(once.begin(), once.end()) == once.end();
  TUNICA_EXPECT(simple && loop.size() == sides.size() && !loop.empty(), "a block has one border");
  return loop;
}

}  // namespace detail

/// block: numbers of quadrilaterals that make one disc; they keep their numbers, those of the ring come last.
/// The new nodes lie at that share of the way from the border to the middle of the block.
inline QuadInset inset_quads(WallQuads& wall, const std::vector<Index>& block, double share = 0.5) {
  QuadInset inset{detail::border_of(wall.cells, block), {}};
  const auto count = static_cast<Index>(wall.nodes.cols()), quads = static_cast<Index>(wall.cells.cols()),
             m = static_cast<Index>(inset.border.size());
  Vec3 middle = Vec3::Zero();
  for (const Index n : inset.border) middle = vec::along(middle, 1.0 / m, vec::column(wall.nodes, n));

  Points<3> nodes(3, count + m);
  for (Index n = 0; n < count; ++n) vec::set_column(nodes, n, vec::column(wall.nodes, n));
  Connectivity<4> cells(4, quads + m);
  for (Index i = 0; i < 4 * quads; ++i) cells.data()[i] = wall.cells.data()[i];
  for (Index i = 0; i < m; ++i) {
    const Index a = inset.border[static_cast<std::size_t>(i)],
                b = inset.border[static_cast<std::size_t>((i + 1) % m)];
    inset.inner.push_back(count + i);
    vec::set_column(nodes, count + i, vec::between(vec::column(wall.nodes, a), middle, share));
    for (const Index q : block)
      for (int k = 0; k < 4; ++k)
        if (wall.cells(k, q) == a) cells(k, q) = count + i;
    cells(0, quads + i) = a, cells(1, quads + i) = b;
    cells(2, quads + i) = count + (i + 1) % m, cells(3, quads + i) = count + i;
  }
  wall.nodes = std::move(nodes);
  wall.cells = std::move(cells);
  return inset;
}

}  // namespace tunica::meshing
