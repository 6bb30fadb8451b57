// SPDX-License-Identifier: MIT
// What is promised of a mesh with layers, checked: exact signs, the border, the volume; and its quality.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/layer_report.hpp"
#include "tunica/meshing/predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace tunica::meshing::detail {

/// A number of an oriented triangle that changes its sign with the orientation: the sum over the faces of all
/// cells is that over the border exactly if (but for one chance in 2^64) all inner faces cancel.
[[nodiscard]] inline std::uint64_t face_number(Index a, Index b, Index c) {
  bool odd = false;
  if (a > b) std::swap(a, b), odd = !odd;
  if (b > c) std::swap(b, c), odd = !odd;
  if (a > b) std::swap(a, b), odd = !odd;
  std::uint64_t x = 0x9e3779b97f4a7c15ULL;
  for (const Index n : {a, b, c}) {  // the finaliser of splitmix64, node by node
    x += static_cast<std::uint64_t>(n) * 0xd1342543de82ef95ULL + 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    x ^= x >> 31;
  }
  return odd ? std::uint64_t{0} - x : x;
}

/// Adds the quality of one tetrahedron to that of its part; cosines of the extreme angles go to lo and hi.
inline void add_quality(const std::array<Vec3, 4>& x, double six_volumes, LayerPart& part, double& lo,
                        double& hi) {
  std::array<Vec3, 4> normal;
  double largest = 0, longest = 0, edges = 0;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& v = mesh::Tet4::faces[f];
    const Vec3& a = x[static_cast<std::size_t>(v[0])];
    const Vec3 n = vec::cross(vec::minus(x[static_cast<std::size_t>(v[1])], a),
                              vec::minus(x[static_cast<std::size_t>(v[2])], a));
    const double size = vec::length(n);
    largest = std::max(largest, size);
    normal[f] = vec::divided(n, size);
  }
  for (const auto& e : mesh::Tet4::edges) {
    const auto i = static_cast<std::size_t>(e[0]), j = static_cast<std::size_t>(e[1]);
    const double cosine = -vec::dot(normal[i], normal[j]);
    lo = std::max(lo, cosine), hi = std::min(hi, cosine);
    const double l2 = vec::squared(vec::minus(x[j], x[i]));
    longest = std::max(longest, l2), edges += l2;
  }
  const double aspect = std::sqrt(longest) * largest / six_volumes;
  ++part.tetrahedra;
  part.mean_aspect += aspect;
  part.most_aspect = std::max(part.most_aspect, aspect);
  const double root = std::cbrt(six_volumes / 2);
  part.mean_ratio += 12 * root * root / edges;
}

/// Exact signs, the border, the volume to 1e-12 and the quality of both parts. MeshError where a promise is
/// broken.
inline void check_layers(const LayeredFill& fill, Index in_layers, LayerReport& report) {
  const mesh::TetMesh& m = fill.mesh;
  constexpr Index block = 1024;  // sums of blocks: equal terms would round to the same side
  long double volume = 0, part = 0, bounded = 0;
  std::uint64_t border = 0;
  const Vec3 origin = vec::column(fill.outer.nodes, fill.outer.cells(0, 0));
  std::array<double, 2> lo{-1, -1}, hi{1, 1};
  for (Index t = 0; t < m.cell_count(); ++t) {
    if (t % block == 0) volume += part, part = 0;
    std::array<Vec3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = vec::column(m.nodes, m.cells(static_cast<Eigen::Index>(k), t));
    const double six = orient3d(x[0], x[1], x[2], x[3]);
    if (!(six > 0)) throw MeshError("a tetrahedron beside the layers is inverted, at " + place(x[0]));
    part += six_volumes(x[0], x[1], x[2], x[3]);
    for (const auto& f : mesh::Tet4::faces)
      border += face_number(m.cells(f[0], t), m.cells(f[1], t), m.cells(f[2], t));
    const std::size_t which = t < in_layers ? 0 : 1;
    add_quality(x, six, which == 0 ? report.layer : report.core, lo[which], hi[which]);
  }
  volume += part;
  const mesh::Surface& s = fill.outer;
  for (Index t = 0; t < s.cell_count(); ++t) {
    border -= face_number(s.cells(0, t), s.cells(1, t), s.cells(2, t));
    bounded += six_volumes(origin, vec::column(s.nodes, s.cells(0, t)), vec::column(s.nodes, s.cells(1, t)),
                           vec::column(s.nodes, s.cells(2, t)));
  }
  if (border != 0) throw MeshError("the layers and the core do not make up the border of the surface");
  report.volume = static_cast<double>(volume / 6);
  report.volume_error = static_cast<double>(std::abs(volume - bounded) / std::abs(bounded));
  if (!(report.volume_error < 1e-12))
    throw MeshError("the volume with layers differs from that of the surface by " +
                    seven_digits(report.volume_error));
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    LayerPart& p = which == 0 ? report.layer : report.core;
    if (p.tetrahedra == 0) continue;
    p.min_dihedral = std::acos(std::min(lo[which], 1.0)) * 180 / std::numbers::pi;
    p.max_dihedral = std::acos(std::max(hi[which], -1.0)) * 180 / std::numbers::pi;
    p.mean_ratio /= p.tetrahedra, p.mean_aspect /= p.tetrahedra;
  }
}

}  // namespace tunica::meshing::detail
