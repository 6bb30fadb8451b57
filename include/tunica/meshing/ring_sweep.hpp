// SPDX-License-Identifier: MIT
// One visit of a sweep to nodes inside of the surface, several side by side: to the mean of the ring, less
// what the neighbourhood rises as a whole, and the volume that this sweeps over, exactly.
#pragma once

#include "tunica/meshing/lanes.hpp"
#include "tunica/meshing/smooth_graph.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tunica::meshing::detail {

/// What a sweep needs to know beside the places.
struct Step {
  double factor = 0.5;
  double offset = 0;  // along the normals, that keeps the volume in the mean
};

/// What moves did: six times the volume that they took in, how much of it one unit of offset would take in
/// (the areas at the nodes), the square of the largest move.
struct Tally {
  double volume = 0, slope = 0, longest = 0;
};

/// Sum of the neighbours of a node, and the derivative of six times the volume by its place: twice the area
/// vector of its triangles.
template <int W>
struct RingSums {
  Places<W> sum;
  typename Lanes<W>::V nx, ny, nz;
};

/// Sums over the rings of W nodes. The area vector is that of the polygon of the ring, two of its triangles
/// at a time: (x1 - x0) x (x2 - x0) + (x2 - x0) x (x3 - x0) = (x2 - x0) x (x3 - x1).
template <int W>
[[nodiscard, gnu::always_inline]] inline RingSums<W> ring_sums(const Place* places, const std::uint32_t* ring,
                                                               std::uint32_t k) {
  using L = Lanes<W>;
  using V = typename L::V;
  const Places<W> o = L::at(places, ring);
  Places<W> p = L::at(places, ring + W);
  Places<W> s{o.x + p.x, o.y + p.y, o.z + p.z, o.w + p.w};
  V nx = L::all(0), ny = L::all(0), nz = L::all(0);
  std::uint32_t i = 2;
  for (; i + 1 < k; i += 2) {
    const Places<W> a = L::at(places, ring + i * W), b = L::at(places, ring + (i + 1) * W);
    s.x += a.x + b.x, s.y += a.y + b.y, s.z += a.z + b.z, s.w += a.w + b.w;
    const V ux = a.x - o.x, uy = a.y - o.y, uz = a.z - o.z;
    const V vx = b.x - p.x, vy = b.y - p.y, vz = b.z - p.z;
    nx += uy * vz - uz * vy, ny += uz * vx - ux * vz, nz += ux * vy - uy * vx;
    p = b;
  }
  if (i < k) {
    const Places<W> a = L::at(places, ring + i * W);
    s.x += a.x, s.y += a.y, s.z += a.z, s.w += a.w;
    const V ux = p.x - o.x, uy = p.y - o.y, uz = p.z - o.z;
    const V vx = a.x - o.x, vy = a.y - o.y, vz = a.z - o.z;
    nx += uy * vz - uz * vy, ny += uz * vx - ux * vz, nz += ux * vy - uy * vx;
  }
  return {s, nx, ny, nz};
}

/// What is done with a pack: only its rise is found, it is moved, it is moved and its area vector noted.
enum class Pass { rise, move, note };

template <int W>
struct PackTally {
  typename Lanes<W>::V volume = Lanes<W>::all(0), slope = Lanes<W>::all(0), longest = Lanes<W>::all(0);

  void into(Tally& t) const {
    for (int lane = 0; lane < W; ++lane) {
      t.volume += Lanes<W>::at(volume, lane), t.slope += Lanes<W>::at(slope, lane);
      const double l = Lanes<W>::at(longest, lane);
      t.longest = l > t.longest ? l : t.longest;
    }
  }
};

/// Moves the nodes of W slots from `slot`, whose ring is summed up in r: by factor (mean - x) less, along the
/// normal, half of what the node rises by it and half of what its neighbours rose when they were last
/// visited.
template <int W, Pass pass>
[[gnu::always_inline]] inline void move_pack(Place* places, Place* before, Place* normal, std::uint32_t slot,
                                             const RingSums<W>& r, typename Lanes<W>::V share,
                                             const Step& step, PackTally<W>& tally) {
  using L = Lanes<W>;
  using V = typename L::V;
  constexpr double least = 1e-300;
  const Places<W> x = L::next(places + slot);
  const V factor = L::all(step.factor);
  const V mx = factor * (r.sum.x * share - x.x), my = factor * (r.sum.y * share - x.y),
          mz = factor * (r.sum.z * share - x.z);
  // n / |n| is 0 where n is
  const V square = L::larger(r.nx * r.nx + r.ny * r.ny + r.nz * r.nz, L::all(least));
  const V length = L::root(square), inverse = L::all(1) / length;
  const V rise = (mx * r.nx + my * r.ny + mz * r.nz) * inverse;
  if constexpr (pass == Pass::rise) {
    L::put(places + slot, {x.x, x.y, x.z, rise});
  } else {
    const V back = (L::all(step.offset) - L::all(0.5) * (rise + r.sum.w * share)) * inverse;
    const V dx = mx + back * r.nx, dy = my + back * r.ny, dz = mz + back * r.nz;
    tally.volume += dx * r.nx + dy * r.ny + dz * r.nz;
    tally.longest = L::larger(tally.longest, dx * dx + dy * dy + dz * dz);
    for (std::uint32_t lane = 0; lane < W; ++lane) before[slot + lane] = places[slot + lane];
    L::put(places + slot, {x.x + dx, x.y + dy, x.z + dz, rise});
    if constexpr (pass == Pass::note) L::put(normal + slot, {r.nx, r.ny, r.nz, inverse});
  }
  tally.slope += length;
}

/// Nodes in packs of W from `slot` on. K: number of neighbours, 0 where it is only known to the group.
template <int W, Pass pass, std::uint32_t K>
[[gnu::always_inline]] inline void visit_packs(Place* places, Place* before, Place* normal,
                                               const std::uint32_t*& ring, std::uint32_t& slot,
                                               std::uint32_t end, std::uint32_t valence, const Step& step,
                                               Tally& tally) {
  constexpr std::uint32_t batch = 64 / W;  // sums first: those of a pack do not wait for the roots of another
  const std::uint32_t k = K > 0 ? K : valence;
  const auto share = Lanes<W>::all(1.0 / k);
  RingSums<W> sums[batch];
  PackTally<W> packs;
  while (slot + W <= end) {
    const std::uint32_t count = std::min(batch, (end - slot) / W);
    for (std::uint32_t i = 0; i < count; ++i, ring += W * k) sums[i] = ring_sums<W>(places, ring, k);
    for (std::uint32_t i = 0; i < count; ++i, slot += W)
      move_pack<W, pass>(places, before, normal, slot, sums[i], share, step, packs);
  }
  packs.into(tally);
}

/// All nodes of a group. K: number of neighbours, 0 where it is only known to the group.
template <Pass pass, std::uint32_t K>
void visit_group(Place* places, Place* before, Place* normal, const std::uint32_t* ring,
                 const RingGroup& group, Step step, Tally& tally) {
  std::uint32_t slot = group.first;
  const std::uint32_t end = group.first + group.count;
  visit_packs<widest, pass, K>(places, before, normal, ring, slot, end, group.valence, step, tally);
  visit_packs<1, pass, K>(places, before, normal, ring, slot, end, group.valence, step, tally);
}

template <Pass pass>
inline void visit_group(Place* places, Place* before, Place* normal, const SmoothGraph& g,
                        const RingGroup& group, const Step& step, Tally& tally) {
  const std::uint32_t* ring = g.ring_slots.data() + group.ring;
  switch (group.valence) {
    case 4: return visit_group<pass, 4>(places, before, normal, ring, group, step, tally);
    case 5: return visit_group<pass, 5>(places, before, normal, ring, group, step, tally);
    case 6: return visit_group<pass, 6>(places, before, normal, ring, group, step, tally);
    case 7: return visit_group<pass, 7>(places, before, normal, ring, group, step, tally);
    case 8: return visit_group<pass, 8>(places, before, normal, ring, group, step, tally);
    default: return visit_group<pass, 0>(places, before, normal, ring, group, step, tally);
  }
}

/// Moves nodes that pass Pass::note has visited by an offset along their normals; six times the volume that
/// this takes in, exactly, for no two of them are neighbours.
template <int W>
[[nodiscard]] inline double offset_packs(Place* places, const Place* normal, std::uint32_t& slot,
                                         std::uint32_t end, double offset) {
  using L = Lanes<W>;
  using V = typename L::V;
  V taken = L::all(0);
  for (; slot + W <= end; slot += W) {
    const Places<W> x = L::next(places + slot), n = L::next(normal + slot);
    const V d = L::all(offset) * n.w;
    const Places<W> to{x.x + d * n.x, x.y + d * n.y, x.z + d * n.z, x.w};
    taken += (to.x - x.x) * n.x + (to.y - x.y) * n.y + (to.z - x.z) * n.z;
    L::put(places + slot, to);
  }
  double sum = 0;
  for (int lane = 0; lane < W; ++lane) sum += L::at(taken, lane);
  return sum;
}

[[nodiscard]] inline double offset_group(Place* places, const Place* normal, const RingGroup& group,
                                         double offset) {
  std::uint32_t slot = group.first;
  const double packs = offset_packs<widest>(places, normal, slot, group.first + group.count, offset);
  return packs + offset_packs<1>(places, normal, slot, group.first + group.count, offset);
}

}  // namespace tunica::meshing::detail
