// SPDX-License-Identifier: MIT
// The sweeps of a volume-preserving smoothing [PEREZ08, 3.2.1]. No two nodes that move at once are
// neighbours, so the volume is linear in their moves and known exactly; one offset along normals of such
// nodes brings it back, and moves that would turn a triangle over are taken back.
#pragma once

#include "tunica/meshing/flat_regions.hpp"
#include "tunica/meshing/node_visit.hpp"
#include "tunica/meshing/ring_sweep.hpp"
#include "tunica/meshing/smooth_graph.hpp"
#include "tunica/meshing/turn_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tunica::meshing::detail {

/// The sweeps over a surface some of whose nodes are held.
class Sweeps {
 public:
  Sweeps(const mesh::Surface& s, const std::vector<std::optional<Plane>>& planes, const Bonds& bonds,
         const std::vector<char>& held)
      : s_(s),
        visits_(s, planes, bonds, origin_of(s)),
        graph_(smooth_graph(s.cells, visit_of(s, bonds, held))),
        watch_(s.cells, graph_.slot),
        places_(graph_.node.size()),
        normal_(graph_.node.size()),
        volume_(graph_.components.size()) {
    for (std::size_t slot = 0; slot < places_.size(); ++slot) {
      const Index n = graph_.node[slot];
      places_[slot] = {s.nodes(0, n), s.nodes(1, n), s.nodes(2, n), 0};
    }
    before_ = places_;
    measure();
    for (const auto& groups : graph_.components) {
      Tally ignored;
      visit<Pass::rise>(groups.begin, groups.end, Step{}, ignored);
    }
  }

  /// One sweep; the number of moves that were left out.
  Index sweep(double factor) {
    double travel = 0;
    Index left_out = 0;
    for (std::size_t c = 0; c < volume_.size(); ++c) {
      const ComponentGroups& groups = graph_.components[c];
      if (groups.begin == groups.end) continue;
      Volume& v = volume_[c];
      v.before = v.excess;
      const Step step{factor, v.offset};
      Tally first, closing;
      visit<Pass::move>(groups.begin, groups.closing, step, first);
      visit<Pass::note>(groups.closing, groups.end, step, closing);
      const double taken = first.volume + closing.volume;
      v.excess += taken;
      // the same drift is to be expected of the next sweep: all nodes will share what makes up for it
      if (first.slope + closing.slope > 0) v.offset -= taken / (first.slope + closing.slope);
      const double d = close(c, closing.slope, true);
      if (std::abs(d) <= v.reach)
        travel = std::max(travel, std::sqrt(std::max(first.longest, closing.longest)) + std::abs(d));
      else
        left_out += stay(c);
    }
    std::vector<Index> turned;
    watch_.look(places_.data(), before_.data(), travel, [&](Index t) { turned.push_back(t); });
    return left_out + (turned.empty() ? 0 : take_back(std::move(turned)));
  }

  void write(Points<3>& nodes) const {
    for (std::size_t slot = 0; slot < places_.size(); ++slot)
      vec::set_column(nodes, graph_.node[slot], NodeVisits::place(places_[slot]));
  }

  [[nodiscard]] const mesh::Rows& around() const { return graph_.around; }

 private:
  /// Of a component, all times six: what it holds more than at the start.
  struct Volume {
    double excess = 0, before = 0;
    double offset = 0;  // that a sweep gives all its nodes
    double reach = 0;   // no offset is longer
  };

  [[nodiscard]] static Vec3 origin_of(const mesh::Surface& s) {
    return s.node_count() > 0 ? mesh::bounding_box(s.nodes).centre() : Vec3(0, 0, 0);
  }

  [[nodiscard]] static std::vector<Visit> visit_of(const mesh::Surface& s, const Bonds& bonds,
                                                   const std::vector<char>& held) {
    std::vector<Visit> visit(static_cast<std::size_t>(s.node_count()), Visit::ring);
    for (std::size_t n = 0; n < visit.size(); ++n) {
      const Bond bond = bonds.bond.empty() ? Bond::none : bonds.bond[n];
      if (bond != Bond::none) visit[n] = Visit::special;
      if (held[n] || bond == Bond::corner) visit[n] = Visit::none;
    }
    return visit;
  }

  void measure() {
    const Vec3 o = origin_of(s_);
    std::vector<double> six(volume_.size(), 0.0);
    for (Index t = 0; t < s_.cell_count(); ++t)
      six[component(s_.cells(0, t))] += 6 * mesh::cone_volume(mesh::triangle(s_, t), o);
    for (std::size_t c = 0; c < six.size(); ++c) volume_[c].reach = std::cbrt(std::abs(six[c]));
  }

  [[nodiscard]] std::size_t component(Index n) const {
    return static_cast<std::size_t>(graph_.component[static_cast<std::size_t>(n)]);
  }

  template <Pass pass>
  void visit(std::size_t begin, std::size_t end, const Step& step, Tally& tally) {
    for (std::size_t i = begin; i < end; ++i) {
      const RingGroup& group = graph_.groups[i];
      if (group.valence > 0) {
        visit_group<pass>(places_.data(), before_.data(), normal_.data(), graph_, group, step, tally);
        continue;
      }
      for (std::uint32_t slot = group.first; slot < group.first + group.count; ++slot) {
        const Index n = graph_.node[slot];
        visits_.visit(graph_, places_.data(), before_.data(), n, step, pass == Pass::rise, tally);
      }
    }
  }

  /// Offsets the nodes of the closing colour so that component c has its volume again; `slope` is what a unit
  /// takes in. The offset; where it is longer than the component's reach, nothing is done.
  double close(std::size_t c, double slope, bool noted) {
    Volume& v = volume_[c];
    const double d = slope > 0 ? -v.excess / slope : 0;
    if (d == 0 || !(std::abs(d) <= v.reach)) return d;
    const ComponentGroups& groups = graph_.components[c];
    for (std::size_t i = groups.closing; i < groups.end; ++i) {
      const RingGroup& group = graph_.groups[i];
      if (noted && group.valence > 0) {
        v.excess += offset_group(places_.data(), normal_.data(), group, d);
        continue;
      }
      for (std::uint32_t slot = group.first; slot < group.first + group.count; ++slot)
        v.excess += visits_.offset(graph_, places_.data(), graph_.node[slot], d);
    }
    return d;
  }

  /// All of a component back to where it was before the sweep: no small offset would bring its volume back,
  /// as of two sheets with nearly nothing between them. The number of its moves.
  Index stay(std::size_t c) {
    Index count = 0;
    for (std::size_t i = graph_.components[c].begin; i < graph_.components[c].end; ++i)
      for (std::uint32_t m = 0; m < graph_.groups[i].count; ++m, ++count)
        places_[graph_.groups[i].first + m] = before_[graph_.groups[i].first + m];
    volume_[c].excess = volume_[c].before, volume_[c].offset = 0;
    return count;
  }

  /// Takes back the moves of triangles that have turned over; the number of these moves.
  Index take_back(std::vector<Index> todo) {
    Index count = 0;
    std::vector<Index> components;
    while (!todo.empty()) {
      std::vector<Index> again;
      for (const Index t : todo) {
        if (!turned_over(t)) continue;
        for (int k = 0; k < 3; ++k) {
          const Index n = s_.cells(k, t);
          Place& now = places_[graph_.slot[static_cast<std::size_t>(n)]];
          const Vec3 was = NodeVisits::place(before_[graph_.slot[static_cast<std::size_t>(n)]]);
          const Vec3 back = vec::minus(was, NodeVisits::place(now));
          if (vec::squared(back) == 0) continue;
          volume_[component(n)].excess += vec::dot(back, visits_.area(graph_, places_.data(), n, false));
          now = {was[0], was[1], was[2], now.w};
          ++count;
          components.push_back(graph_.component[static_cast<std::size_t>(n)]);
          again.insert(again.end(), graph_.around[n].begin(), graph_.around[n].end());
        }
      }
      std::sort(again.begin(), again.end());
      again.erase(std::unique(again.begin(), again.end()), again.end());
      todo = std::move(again);
    }
    std::sort(components.begin(), components.end());
    components.erase(std::unique(components.begin(), components.end()), components.end());
    for (const Index c : components) {
      const ComponentGroups& groups = graph_.components[static_cast<std::size_t>(c)];
      double slope = 0;
      for (std::size_t i = groups.closing; i < groups.end; ++i)
        for (std::uint32_t m = 0; m < graph_.groups[i].count; ++m)
          slope += visits_.slope(graph_, places_.data(), graph_.node[graph_.groups[i].first + m]);
      const double d = close(static_cast<std::size_t>(c), slope, false);
      if (!(std::abs(d) <= volume_[static_cast<std::size_t>(c)].reach))
        count += stay(static_cast<std::size_t>(c));
    }
    if (count > 0) watch_.forget();
    return count;
  }

  /// Its normal made no acute angle in the sweep, and it does not look outward where it did not before.
  [[nodiscard]] bool turned_over(Index t) const {
    const Vec3 a = triangle(before_, t).area_vector(), b = triangle(places_, t).area_vector();
    if (vec::dot(a, b) > 0) return false;
    Vec3 n(0, 0, 0);
    for (int k = 0; k < 3; ++k) n = vec::plus(n, visits_.normal(graph_, before_.data(), s_.cells(k, t)));
    return vec::squared(n) == 0 || vec::dot(n, b) <= 0.1 * vec::length(n) * vec::length(b);
  }

  [[nodiscard]] mesh::Triangle triangle(const std::vector<Place>& places, Index t) const {
    const auto corner = [&](int k) {
      return NodeVisits::place(places[graph_.slot[static_cast<std::size_t>(s_.cells(k, t))]]);
    };
    return {corner(0), corner(1), corner(2)};
  }

  const mesh::Surface& s_;
  NodeVisits visits_;
  SmoothGraph graph_;
  TurnWatch watch_;
  std::vector<Place> places_, before_, normal_;
  std::vector<Volume> volume_;
};

}  // namespace tunica::meshing::detail
