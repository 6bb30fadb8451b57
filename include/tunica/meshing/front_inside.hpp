// SPDX-License-Identifier: MIT
// Which tetrahedra lie inside: regions that the surface separates, each judged by the sense of the
// triangles around it. Inward and wrongly nested surfaces are refused here.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/meshing/front_surface.hpp"

#include <cstddef>
#include <vector>

namespace tunica::meshing {

/// One flag a tetrahedron: 1 inside. Needs every triangle of the surface marked.
[[nodiscard]] inline std::vector<char> inside_of(TetComplex& c, const FrontSurface& surface) {
  enum : char { unknown = -1, outside = 0, inside = 1 };
  std::vector<char> label(static_cast<std::size_t>(c.size()), unknown);
  const auto at = [](auto i) { return static_cast<std::size_t>(i); };
  std::vector<Index> region;
  for (Index seed = 0; seed < c.size(); ++seed) {
    if (!c.alive(seed) || label[at(seed)] != unknown) continue;
    region.assign(1, seed);
    label[at(seed)] = outside;
    bool touches_far = false;
    Index votes_in = -1, votes_out = -1;  // a triangle that says so
    for (std::size_t i = 0; i < region.size(); ++i)
      for (int f = 0; f < 4; ++f) {
        const Index t = region[i];
        const Side s = c.across(t, f);
        const Index m = c.mark(t, f);
        if (s < 0) touches_far = true;
        if (m < 0) {
          if (s < 0 || label[at(s / 4)] != unknown) continue;
          label[at(s / 4)] = outside;
          region.push_back(s / 4);
          continue;
        }
        (m % 2 == 0 ? votes_in : votes_out) = m / 2;
      }
    const auto place = [&](Index m) { return tunica::place(c.point(surface.triangles[at(m)][0])); };
    if (touches_far && votes_in >= 0)
      throw MeshError("the surface is inward: its normals point into what it encloses, at " +
                      place(votes_in));
    if (votes_in >= 0 && votes_out >= 0)
      throw MeshError("two parts of the surface disagree about what is inside, at " + place(votes_in) +
                      " and " + place(votes_out));
    if (votes_in >= 0)
      for (const Index t : region) label[at(t)] = inside;
  }
  return label;
}

}  // namespace tunica::meshing
