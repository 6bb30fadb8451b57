// SPDX-License-Identifier: MIT
// What a surface from a file must be to bound a volume: closed, manifold, turned outward.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/io/lengths.hpp"
#include "tunica/io/stl.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::io {

struct [[nodiscard]] ClosedSurface {
  mesh::Surface surface;  // its normals point outward
  Index components = 0, genus = 0;
  bool flipped = false;              // it was inside out
  std::vector<std::string> notices;  // what was repaired, as sentences
};

namespace detail {

/// The first edge of that kind, with its ends and the number of facets that share it.
[[nodiscard]] inline std::string edge_text(const mesh::Surface& s, Index kind) {
  const auto twin = mesh::twins(s.cells, s.node_count());
  for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
    if (twin[static_cast<std::size_t>(h)] != kind) continue;
    const auto [from, to] = mesh::half_edge(s.cells, h);
    Index facets = 0;
    for (Index g = 0; g < static_cast<Index>(twin.size()); ++g) {
      const auto [p, q] = mesh::half_edge(s.cells, g);
      facets += (p == from && q == to) || (p == to && q == from);
    }
    return "the edge from " + place(s.nodes.col(from)) + " to " + place(s.nodes.col(to)) + " is shared by " +
           std::to_string(facets) + (facets == 1 ? " facet" : " facets");
  }
  return "no edge";
}

/// Turns the parts that are inside out; one in the box of another may be a cavity and stays as it is.
/// Returns how many were turned.
[[nodiscard]] inline Index turn_outward(mesh::Surface& s, const mesh::Topology& t) {
  std::vector<Box> box(t.components.size());
  for (Index f = 0; f < s.cell_count(); ++f)
    box[static_cast<std::size_t>(t.component_of[static_cast<std::size_t>(f)])].extend(
        mesh::triangle(s, f).box());
  Index turned = 0;
  std::vector<char> turn(box.size(), 0);
  for (std::size_t c = 0; c < box.size(); ++c) {
    bool within = false;
    for (std::size_t d = 0; d < box.size(); ++d)
      within = within || (d != c && (box[d].lo.array() <= box[c].lo.array()).all() &&
                          (box[c].hi.array() <= box[d].hi.array()).all());
    turn[c] = !within && t.components[c].volume < 0;
    turned += turn[c];
  }
  for (Index f = 0; f < s.cell_count(); ++f)
    if (turn[static_cast<std::size_t>(t.component_of[static_cast<std::size_t>(f)])] != 0)
      std::swap(s.cells(1, f), s.cells(2, f));
  return turned;
}

}  // namespace detail

/// Checks and, where it is certain, repairs: a surface that is inside out is turned, which a notice tells.
/// InputError names a bad edge, or each hole by its number of edges and its centre.
[[nodiscard]] inline ClosedSurface closed_surface(const std::string& name, StlFile file) {
  ClosedSurface out;
  mesh::Surface& s = file.surface;
  const mesh::Topology t = mesh::topology(s);
  if (t.triangles == 0)
    throw InputError(name + (file.collapsed == file.facets
                                 ? ": every facet has two equal corners"
                                 : ": no facet is left of " + std::to_string(file.facets) +
                                       " but those without area, back to back or on stray sheets"));
  require_length(name, "the diagonal of the surface", mesh::bounding_box(s.nodes).diagonal());
  const std::string open =
      t.open_edges > 0 ? "; " + std::to_string(t.open_edges) + " edges have one facet only" : "";
  if (t.nonmanifold_edges > 0)
    throw InputError(name, detail::edge_text(s, mesh::nonmanifold_edge),
                     "a closed surface has two at every edge (" + std::to_string(t.nonmanifold_edges) +
                         " such edges" + open + ")");
  if (t.misoriented_edges > 0)
    throw InputError(
        name, detail::edge_text(s, mesh::misoriented_edge),
        "which turn opposite ways (" + std::to_string(t.misoriented_edges) + " such edges" + open + ")");
  if (t.open_edges > 0) {
    if (t.loops.empty())
      throw InputError(name, detail::edge_text(s, mesh::open_edge),
                       "the surface is open around holes that touch each other (" +
                           std::to_string(t.open_edges) + " such edges); cap it to make a volume");
    std::string holes;
    for (const auto& loop : t.loops)
      holes += (holes.empty() ? "" : ", ") + std::to_string(loop.nodes.size()) + " edges around " +
               place(loop.centre);
    throw InputError(name, "the surface is open",
                     std::to_string(t.loops.size()) + " boundary loop" + (t.loops.size() == 1 ? "" : "s") +
                         ": " + holes + "; cap it to make a volume");
  }
  if (t.nonmanifold_nodes > 0)
    throw InputError(name + ": " + std::to_string(t.nonmanifold_nodes) +
                     " points where the surface touches itself");
  if (const Index n = detail::turn_outward(s, t); n > 0) {
    out.flipped = true;
    out.notices.push_back(
        name + ": " +
        (t.components.size() == 1 ? "the surface was" : std::to_string(n) + " of its parts were") +
        " inside out; turned");
  }
  if (!(std::abs(mesh::enclosed_volume(s)) > 0)) throw InputError(name + ": the surface encloses no volume");
  if (file.collapsed > 0)
    out.notices.push_back(name + ": " + std::to_string(file.collapsed) +
                          " facets with equal corners left out");
  out.components = static_cast<Index>(t.components.size()), out.genus = t.genus();
  out.surface = std::move(s);
  return out;
}

[[nodiscard]] inline ClosedSurface read_closed_stl(const std::filesystem::path& path) {
  return closed_surface(path.string(), read_stl(path));
}

}  // namespace tunica::io
