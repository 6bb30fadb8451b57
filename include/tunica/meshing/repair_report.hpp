// SPDX-License-Identifier: MIT
// What repair may do to a surface from elsewhere, and what it did: a count and the first place for each.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tunica::meshing {

/// How far repair goes. `safe` changes no point set: equal nodes, facets without area, duplicates, the turn
/// of facets. `full` also removes flaps and stray sheets, sews seams, fills holes, parts sheets that touch.
enum class RepairExtent { safe, full };

struct RepairOptions {
  RepairExtent extent = RepairExtent::full;
  double seam = 1e-6;        // open edges are sewn over gaps of this, over the diagonal of the surface [-]
  double stray = 1e-3;       // open sheets of less than this of the whole area are left out [-]
  Index hole_edges = 100;    // holes of at most so many edges are filled; 0: none
  int untangle_rounds = 60;  // of drawing crossing places smooth; 0: none
};

/// How many of one kind there were, and where the first of them was.
struct Repaired {
  Index count = 0;
  Vec3 first{0, 0, 0};

  void add(const Vec3& at) {
    if (count++ == 0) first = at;
  }
};

struct FilledHole {
  Index edges = 0, triangles = 0;
  Vec3 centre{0, 0, 0};
};

struct [[nodiscard]] RepairReport {
  Repaired welded;         // nodes that lay on another, or across a seam from it
  Repaired degenerate;     // facets without area
  Repaired duplicates;     // facets over the same three nodes as another
  Repaired folded_sheets;  // pairs of such facets back to back, of which none was needed
  Repaired flaps;          // facets of sheets that hang on an edge of two others
  Repaired strays;         // facets of small open sheets
  Repaired sewn;           // nodes that lay on an open edge
  Repaired turned;         // facets that disagreed with their neighbours
  Repaired parts_turned;   // parts that were inside out, or cavities that were not
  Repaired split_edges;    // edges of more than two facets, parted
  Repaired split_nodes;    // nodes where sheets touched, parted and drawn into their sheets
  std::vector<FilledHole> filled;
  std::vector<FilledHole> left;  // holes that are too long or could not be filled: no triangles
  std::size_t crossings_before = 0, crossings_after = 0;  // pairs of triangles
  Repaired crossing;                                      // triangles that still cross another

  /// What was changed, one sentence a kind.
  [[nodiscard]] std::vector<std::string> sentences() const {
    std::vector<std::string> text;
    const auto say = [&](const Repaired& r, const std::string& one, const std::string& many) {
      if (r.count == 1) text.push_back("1 " + one + " at " + place(r.first));
      if (r.count > 1)
        text.push_back(std::to_string(r.count) + " " + many + ", the first at " + place(r.first));
    };
    say(welded, "node that lay on another welded", "nodes that lay on others welded");
    say(degenerate, "facet without area left out", "facets without area left out");
    say(duplicates, "facet that was there twice left out", "facets that were there twice left out");
    say(folded_sheets, "pair of facets back to back left out", "pairs of facets back to back left out");
    say(flaps, "facet of a flap left out", "facets of flaps left out");
    say(strays, "facet of a stray sheet left out", "facets of stray sheets left out");
    say(sewn, "node sewn into an open edge", "nodes sewn into open edges");
    say(turned, "facet turned to agree with its neighbours", "facets turned to agree with their neighbours");
    say(parts_turned, "part that was inside out turned", "parts that were inside out turned");
    say(split_edges, "edge of more than two facets parted", "edges of more than two facets parted");
    say(split_nodes, "node where sheets touched parted", "nodes where sheets touched parted");
    for (const FilledHole& h : filled)
      text.push_back("a hole of " + std::to_string(h.edges) + " edges filled by " +
                     std::to_string(h.triangles) + " triangles at " + place(h.centre));
    if (crossings_before > crossings_after)
      text.push_back(std::to_string(crossings_before - crossings_after) +
                     " pairs of crossing triangles drawn apart");
    return text;
  }
};

}  // namespace tunica::meshing
