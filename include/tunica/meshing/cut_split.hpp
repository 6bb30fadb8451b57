// SPDX-License-Identifier: MIT
// The mechanics of a cut: nodes near the plane are moved onto it, crossed triangles are split, one side is
// kept and closed. Works on one surface and one plane.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/mesh/solid_angle.hpp"
#include "tunica/meshing/cap.hpp"
#include "tunica/meshing/cut_snap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

class Splitter {
 public:
  Splitter(const mesh::Surface& s, const Plane& plane)
      : s_(s), plane_(plane), twin_(mesh::twins(s.cells, s.node_count())) {
    for (const Index g : twin_)
      if (g < 0) throw MeshError("only a closed manifold surface can be cut");
    for (Index n = 0; n < s.node_count(); ++n) distance_.push_back(plane.distance(mesh::node(s, n)));
  }

  [[nodiscard]] const std::vector<Index>& twin() const { return twin_; }
  [[nodiscard]] const std::vector<double>& distance() const { return distance_; }
  [[nodiscard]] Index rim_edges() const { return rim_edges_; }
  [[nodiscard]] Index snapped() const { return snapped_; }

  /// Splits the active triangles along the plane. Afterwards each triangle has a side. The nodes of
  /// `avoided`, ascending, are kept off the plane by a hundredth of their shortest edge.
  void split(const std::vector<char>& active, const std::vector<Index>& avoided) {
    x_.clear();
    for (Index n = 0; n < s_.node_count(); ++n) x_.push_back(mesh::node(s_, n));
    sign_.assign(x_.size(), 0);
    for (std::size_t n = 0; n < x_.size(); ++n) sign_[n] = distance_[n] < 0 ? -1 : 1;
    snapped_ = PlaneSnap(s_, plane_, avoided, x_, distance_, sign_).run(active);
    std::vector<Index> made(twin_.size(), -1);  // the node in the plane on a half-edge and its twin
    const auto between = [&](Index h) {
      const Index g = std::min(h, twin_[at(h)]);
      if (made[at(g)] < 0) {
        const auto e = mesh::half_edge(s_.cells, g);
        const Vec3 &p = x_[at(e.from)], &q = x_[at(e.to)];
        const double dp = plane_.distance(p), dq = plane_.distance(q);
        const Vec3 x = plane_.projected(vec::along(p, dp / (dp - dq), vec::minus(q, p)));
        made[at(g)] = static_cast<Index>(x_.size());
        x_.push_back(x), sign_.push_back(0);
      }
      return made[at(g)];
    };
    for (Index t = 0; t < s_.cell_count(); ++t) {
      const std::array<Index, 3> v{s_.cells(0, t), s_.cells(1, t), s_.cells(2, t)};
      const int lo = std::min({sign_[at(v[0])], sign_[at(v[1])], sign_[at(v[2])]});
      const int hi = std::max({sign_[at(v[0])], sign_[at(v[1])], sign_[at(v[2])]});
      if (!active[at(t)] || lo == hi || lo * hi == 0) {
        add(v, t, active[at(t)] && lo == 0 && hi == 0 ? 0 : lo < 0 ? -1 : 1);
        continue;
      }
      for (const int side : {-1, 1}) {  // the polygon on that side of the plane
        std::array<Index, 4> p{};
        std::size_t size = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const Index a = v[k], b = v[(k + 1) % 3];
          if (sign_[at(a)] * side >= 0) p[size++] = a;
          if (sign_[at(a)] * sign_[at(b)] < 0) p[size++] = between(3 * t + static_cast<Index>(k));
        }
        if (size == 3) {
          add({p[0], p[1], p[2]}, t, side);
          continue;
        }
        const auto worst = [&](std::size_t d) {  // of the two triangles of the diagonal from corner d
          return std::min(shape({p[d], p[d + 1], p[d + 2]}), shape({p[d], p[d + 2], p[(d + 3) % 4]}));
        };
        const std::size_t d = worst(0) >= worst(1) ? 0 : 1;
        add({p[d], p[d + 1], p[d + 2]}, t, side);
        add({p[d], p[d + 2], p[(d + 3) % 4]}, t, side);
      }
    }
  }

  /// Nodes of the surface that must be kept off the plane: where loops of the section touch, and one end
  /// of each edge that joins two nodes of the rim within what is kept (a cap could use it too). Ascending.
  [[nodiscard]] std::vector<Index> pinched() const {
    TUNICA_EXPECT(kept_.size() == triangles_.size(), "a side is chosen before the rim is asked for");
    std::vector<int> leaves(x_.size(), 0);
    for (const auto& [e, side] : open_edges()) ++leaves[at(e.from)];
    std::vector<Index> nodes;
    for (Index n = 0; n < s_.node_count(); ++n)
      if (leaves[at(n)] > 1) nodes.push_back(n);
    std::vector<std::pair<Index, Index>> within;  // half-edges between nodes of the rim
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; kept_[t] && k < 3; ++k) {
        const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
        if (leaves[at(a)] > 0 && leaves[at(b)] > 0) within.emplace_back(a, b);
      }
    std::sort(within.begin(), within.end());
    for (const auto& [a, b] : within)
      if (a < b && a < s_.node_count() && std::binary_search(within.begin(), within.end(), std::pair(b, a)))
        nodes.push_back(a);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  void keep_behind() {
    kept_.assign(side_.size(), 0);
    for (std::size_t t = 0; t < side_.size(); ++t) kept_[t] = side_[t] < 0;
  }

  /// Keeps one of the parts into which the sections sever the surface.
  void keep_part(const std::optional<Vec3>& seed, const std::string& name) {
    const Connectivity<3> c = cells();
    const auto twin = mesh::twins(c, static_cast<Index>(x_.size()));
    std::vector<Index> part(side_.size(), -1);
    std::vector<Index> stack;
    Index parts = 0;
    // all triangles in the plane count as in front; the plane is crossed where the side changes between nodes
    // in it
    const auto front = [&](Index t) { return side_[at(t)] >= 0; };
    const auto blocked = [&](Index h, Index g) {
      const auto e = mesh::half_edge(c, h);
      return sign_[at(e.from)] == 0 && sign_[at(e.to)] == 0 && front(h / 3) != front(g / 3);
    };
    for (Index t = 0; t < static_cast<Index>(part.size()); ++t) {
      if (part[at(t)] >= 0) continue;
      stack.assign(1, t), part[at(t)] = parts;
      while (!stack.empty()) {
        const Index f = stack.back();
        stack.pop_back();
        for (Index h = 3 * f; h < 3 * f + 3; ++h) {
          const Index g = twin[at(h)];
          if (g >= 0 && part[at(g / 3)] < 0 && !blocked(h, g))
            part[at(g / 3)] = parts, stack.push_back(g / 3);
        }
      }
      ++parts;
    }
    std::vector<char> touched(at(parts), 0);
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h) {
      const Index g = twin[at(h)];
      if (g < 0 || !blocked(h, g)) continue;
      if (part[at(h / 3)] == part[at(g / 3)])
        throw MeshError(name + " opens the vessel but the two sides stay connected round it");
      touched[at(part[at(h / 3)])] = 1;
    }
    Index best = -1;
    double most = 0;
    for (Index p = 0; p < parts; ++p) {
      if (!touched[at(p)]) continue;
      kept_.assign(side_.size(), 0);
      for (std::size_t t = 0; t < side_.size(); ++t) kept_[t] = part[t] == p && side_[t] != 0;
      const double measure = seed ? solid_angle(*seed) : volume();
      if (best < 0 || measure > most) best = p, most = measure;
    }
    if (seed && most < 2 * std::numbers::pi)
      throw MeshError(name + ": the seed lies in neither part of the vessel that it severs");
    for (std::size_t t = 0; t < side_.size(); ++t)
      kept_[t] = (part[t] == best || !touched[at(part[t])]) && side_[t] != 0;
  }

  /// Writes what is kept with its caps; the number of its first cap triangle.
  Index close(mesh::Surface& out) {
    TUNICA_EXPECT(kept_.size() == triangles_.size(), "a side is chosen before it is closed");
    const auto lid = lids();
    mesh::Surface r;
    std::vector<Index> number(x_.size(), -1);
    std::vector<Index> used;
    const auto renumbered = [&](Index n) {
      if (number[at(n)] < 0) number[at(n)] = static_cast<Index>(used.size()), used.push_back(n);
      return number[at(n)];
    };
    const auto kept = static_cast<Index>(std::count(kept_.begin(), kept_.end(), char{1}));
    r.cells.resize(3, kept + static_cast<Index>(lid.size()));
    Index t = 0;
    for (std::size_t f = 0; f < kept_.size(); ++f) {
      if (!kept_[f]) continue;
      for (std::size_t k = 0; k < 3; ++k) r.cells(static_cast<Index>(k), t) = renumbered(triangles_[f][k]);
      r.region.push_back(s_.region_of(parent_[f]));
      ++t;
    }
    for (const auto& f : lid) {
      for (std::size_t k = 0; k < 3; ++k) r.cells(static_cast<Index>(k), t) = renumbered(f[k]);
      r.region.push_back(0);
      ++t;
    }
    r.nodes.resize(3, static_cast<Index>(used.size()));
    for (std::size_t n = 0; n < used.size(); ++n)
      vec::set_column(r.nodes, static_cast<Index>(n), x_[at(used[n])]);
    r.region_names = s_.region_names;
    out = std::move(r);
    return kept;
  }

 private:
  [[nodiscard]] static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] mesh::Triangle corners(const std::array<Index, 3>& v) const {
    return {x_[at(v[0])], x_[at(v[1])], x_[at(v[2])]};
  }
  [[nodiscard]] double shape(const std::array<Index, 3>& v) const { return corners(v).smallest_angle(); }

  void add(const std::array<Index, 3>& v, Index parent, int side) {
    triangles_.push_back(v), parent_.push_back(parent), side_.push_back(side);
  }

  [[nodiscard]] Connectivity<3> cells() const {
    Connectivity<3> c(3, static_cast<Index>(triangles_.size()));
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) c(static_cast<Index>(k), static_cast<Index>(t)) = triangles_[t][k];
    return c;
  }

  /// Open half-edges of what is kept, each with the side of its triangle.
  [[nodiscard]] std::vector<std::pair<mesh::HalfEdge, int>> open_edges() const {
    Connectivity<3> c(3, static_cast<Index>(std::count(kept_.begin(), kept_.end(), char{1})));
    std::vector<int> side;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!kept_[t]) continue;
      for (std::size_t k = 0; k < 3; ++k)
        c(static_cast<Index>(k), static_cast<Index>(side.size())) = triangles_[t][k];
      side.push_back(side_[t]);
    }
    const auto twin = mesh::twins(c, static_cast<Index>(x_.size()));
    std::vector<std::pair<mesh::HalfEdge, int>> open;
    for (Index h = 0; h < static_cast<Index>(twin.size()); ++h)
      if (twin[at(h)] == mesh::open_edge) open.emplace_back(mesh::half_edge(c, h), side[at(h / 3)]);
    return open;
  }

  /// Cap triangles of what is kept: its open edges, by the side of the plane on which the kept part lies.
  [[nodiscard]] std::vector<std::array<Index, 3>> lids() {
    std::vector<mesh::HalfEdge> behind, front;
    for (const auto& [e, side] : open_edges()) (side < 0 ? behind : front).push_back(e);
    rim_edges_ = static_cast<Index>(behind.size() + front.size());
    const Points<3> x = vec::columns(x_);
    auto lid = caps(x, behind, plane_.point, plane_.normal);
    const auto other = caps(x, front, plane_.point, vec::scaled(-1, plane_.normal));
    lid.insert(lid.end(), other.begin(), other.end());
    return lid;
  }

  /// Six times the volume of what is kept: caps add nothing, the origin lies in their plane.
  [[nodiscard]] double volume() const {
    double sum = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!kept_[t]) continue;
      const mesh::Triangle f = corners(triangles_[t]);
      sum += 6 * mesh::cone_volume(f, plane_.point);
    }
    return sum;
  }

  /// Under which what is kept, with its caps, is seen from a point: 4 pi inside, 0 outside.
  [[nodiscard]] double solid_angle(const Vec3& p) {
    double sum = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (kept_[t]) sum += mesh::solid_angle(corners(triangles_[t]), p);
    for (const auto& f : lids()) sum += mesh::solid_angle(corners(f), p);
    return sum;
  }

  const mesh::Surface& s_;
  Plane plane_;
  std::vector<Index> twin_;
  std::vector<double> distance_;
  std::vector<Vec3> x_;
  std::vector<int> sign_;  // of a node: -1 behind, 0 in the plane, 1 in front
  std::vector<std::array<Index, 3>> triangles_;
  std::vector<Index> parent_;
  std::vector<int> side_;  // of a triangle: 0 lies in the plane
  std::vector<char> kept_;
  Index rim_edges_ = 0, snapped_ = 0;
};

}  // namespace tunica::meshing::detail
