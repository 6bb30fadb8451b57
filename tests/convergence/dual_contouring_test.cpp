// SPDX-License-Identifier: MIT
// Observed orders of dual contouring on the phantom (vertices, normals, volume), and the Euler numbers of its
// surfaces of noise against a count over cubes.
#include "support/contours.hpp"
#include "tunica/image/phantom_truth.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/dual_cuts.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

struct Errors {
  double vertex, largest, normal, volume;  // rms [mm], max [mm], rms [rad], relative
};

/// Of the phantom between its ports.
Errors errors_of(const mesh::Surface& s, double truth) {
  const image::Phantom phantom;
  double sum = 0, largest = 0, turn = 0, area = 0;
  std::vector<char> done(static_cast<std::size_t>(s.node_count()), 0);
  Index count = 0;
  for (Index t = 0; t < s.cell_count(); ++t) {
    if (s.region_of(t) != 0) continue;
    const mesh::Triangle f = mesh::triangle(s, t);
    const Vec3 a = f.area_vector(), n = phantom.level(f.centroid()).gradient.normalized();
    turn += a.norm() * std::pow(std::atan2(a.cross(n).norm(), a.dot(n)), 2), area += a.norm();
    for (int k = 0; k < 3; ++k) {
      const auto node = static_cast<std::size_t>(s.cells(k, t));
      if (done[node] != 0) continue;
      done[node] = 1;
      const double d = image::nearest_on_surface(phantom, mesh::node(s, s.cells(k, t))).distance;
      sum += d * d, largest = std::max(largest, std::abs(d)), ++count;
    }
  }
  return {std::sqrt(sum / count), largest, std::sqrt(turn / area),
          std::abs(mesh::enclosed_volume(s) / truth - 1)};
}

/// The Euler number of the inside, by inclusion and exclusion of closed cubes, faces, edges and nodes: each
/// holds as many pieces of the inside as its inside corners are when they hang together by edges.
template <class T>
long inside_euler(const image::Image<T>& im, double iso) {
  long euler = 0;
  for (int axes = 0; axes < 8; ++axes)
    for (Index k = 0; k + (axes >> 2 & 1) < im.size(2); ++k)
      for (Index j = 0; j + (axes >> 1 & 1) < im.size(1); ++j)
        for (Index i = 0; i + (axes & 1) < im.size(0); ++i) {
          std::array<int, 8> piece{};  // number of the least corner that a corner hangs together with
          for (int c = 0; c < 8; ++c)
            piece[static_cast<std::size_t>(c)] =
                (c & ~axes) == 0 && im({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)}) >= iso ? c : -1;
          for (int pass = 0; pass < 4; ++pass)
            for (int c = 0; c < 8; ++c)
              for (const int bit : {1, 2, 4}) {
                int &p = piece[static_cast<std::size_t>(c)], &q = piece[static_cast<std::size_t>(c ^ bit)];
                if (p >= 0 && q >= 0) p = q = std::min(p, q);
              }
          int pieces = 0;
          for (int c = 0; c < 8; ++c) pieces += piece[static_cast<std::size_t>(c)] == c;
          euler += std::popcount(static_cast<unsigned>(axes)) % 2 == 1 ? pieces : -pieces;
        }
  return euler;
}

/// Pairs of quadrilaterals' sides that would coincide if every ambiguous face kept its inside apart: found by
/// walking from crossing to crossing over the faces of each cell, one at a time and in their order, without
/// the tables of the library. A pair of strands on a face is joined when they lie on one walk in both cells.
template <class T>
long joined_faces(const image::Image<T>& im, double iso) {
  using Node = std::array<Index, 3>;
  using Edge = std::array<Index, 4>;  // lower node and axis
  using Face = std::array<Index, 4>;  // lower node and normal axis
  std::set<Face> joined;
  const auto inside = [&](const Node& n) { return im({n[0], n[1], n[2]}) >= iso; };
  const auto next = [](Node n, int axis) {
    ++n[static_cast<std::size_t>(axis)];
    return n;
  };
  const auto crossed = [&](const Node& n, int axis) { return inside(n) != inside(next(n, axis)); };
  const auto edge = [](const Node& n, int axis) { return Edge{n[0], n[1], n[2], axis}; };
  // pairs of crossed edges that a strand joins on a face
  const auto strands = [&](const Node& n, int a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    std::vector<std::pair<Edge, Edge>> pairs;
    std::vector<Edge> all;
    const std::array<std::pair<Node, int>, 4> sides{{{n, b}, {next(n, b), c}, {next(n, c), b}, {n, c}}};
    for (const auto& [m, axis] : sides)
      if (crossed(m, axis)) all.push_back(edge(m, axis));
    if (all.size() == 2) pairs.emplace_back(all[0], all[1]);
    if (all.size() == 4) {  // sides 0 and 1 meet at corner b; 2 and 3 at corner c
      const bool odd = inside(next(n, b)) != joined.contains(Face{n[0], n[1], n[2], a});
      if (odd)
        pairs = {{all[0], all[1]}, {all[2], all[3]}};
      else
        pairs = {{all[3], all[0]}, {all[1], all[2]}};
    }
    return pairs;
  };
  const auto one_walk = [&](const Node& cell, const std::vector<Edge>& through) {
    std::vector<std::pair<Edge, Edge>> pairs;
    for (int a = 0; a < 3; ++a)
      for (const Node& n : {cell, next(cell, a)})
        for (const auto& p : strands(n, a)) pairs.push_back(p);
    std::set<Edge> seen{through[0]};
    for (bool grown = true; grown;) {
      grown = false;
      for (const auto& [p, q] : pairs)
        if (seen.contains(p) != seen.contains(q)) seen.insert(p), seen.insert(q), grown = true;
    }
    for (const Edge& e : through)
      if (!seen.contains(e)) return false;
    return true;
  };
  for (Index k = 0; k + 1 < im.size(2); ++k)
    for (Index j = 0; j + 1 < im.size(1); ++j)
      for (Index i = 0; i + 1 < im.size(0); ++i)
        for (int a = 0; a < 3; ++a) {
          const Node low{i, j, k}, high = next(low, a);
          if (high[static_cast<std::size_t>(a)] + 1 >= im.size(a)) continue;
          const auto pairs = strands(high, a);
          if (pairs.size() != 2) continue;
          const std::vector<Edge> four{pairs[0].first, pairs[0].second, pairs[1].first, pairs[1].second};
          if (one_walk(low, four) && one_walk(high, four)) joined.insert(Face{high[0], high[1], high[2], a});
        }
  return static_cast<long>(joined.size());
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("meshing: dual contouring of the phantom converges in vertices and normals and volume") {
    const image::Phantom phantom;
    const double truth = image::lumen_volume(phantom);
    std::vector<meshing::Cut> ends;
    for (const auto& port : image::Phantom::ports())
      ends.push_back(
          {.point = port.point, .normal = port.normal, .radius = 1.6 * port.radius, .name = port.name});
    std::array<Errors, 3> half{}, full{};
    for (std::size_t level = 0; level < 3; ++level) {
      const auto scan = image::sample(phantom, image::Sampling{}.refined(1 << level));
      const auto made = meshing::dual_contour_image(scan, {}, image::Phantom::surface, ends,
                                                    {.seed = Vec3(221.5, 150, 22)});
      const auto tangent = meshing::dual_contour_image(scan, {}, image::Phantom::surface, ends,
                                                       {.seed = Vec3(221.5, 150, 22)}, {.smooth_share = 1});
      CHECK(test::contours::topology(made.contour.surface).euler == 2);
      half[level] = errors_of(made.contour.surface, truth),
      full[level] = errors_of(tangent.contour.surface, truth);
      for (const auto& [how, e] : {std::pair{std::string("half"), half[level]},
                                   std::pair{std::string("tangent planes"), full[level]}})
        MESSAGE("spacing / ", 1 << level, " ", how, ": vertices rms ", e.vertex, " mm, max ", e.largest,
                " mm, normals rms ", e.normal, " rad, volume off by ", e.volume);
    }
    for (std::size_t l = 1; l < 3; ++l)
      for (const auto& [how, e] :
           {std::pair{std::string("half"), half}, std::pair{std::string("tangent planes"), full}})
        MESSAGE("orders, ", how, ": vertices ", order(e[l - 1].vertex, e[l].vertex), ", largest ",
                order(e[l - 1].largest, e[l].largest), ", normals ", order(e[l - 1].normal, e[l].normal),
                ", volume ", order(e[l - 1].volume, e[l].volume));
    for (const auto& e : {half, full}) {
      CHECK(order(e[1].vertex, e[2].vertex) > 1.9);
      CHECK(order(e[1].normal, e[2].normal) > 0.9);
      CHECK(order(e[1].volume, e[2].volume) > 1.9);
    }
  }

  TEST_CASE("meshing: Euler numbers of dual contours of noise are those of a count over cubes") {
    // the surface bounds the inside, 6-connected: twice its Euler number; each ambiguous face whose strands
    // are paired the other way cuts a loop of both of its cells in two: two vertices more
    long joined_most = 0;
    for (const bool integers : {false, true})
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const auto im = test::contours::noise(13, integers, 1000 * seed);
        const auto t = test::contours::topology(meshing::dual_contour_quads(im, {}, 0));
        const long joined = joined_faces(im, 0);
        CHECK(t.euler == 2 * inside_euler(im, 0) + 2 * joined);
        joined_most = std::max(joined_most, joined);
      }
    CHECK(joined_most > 5);
    // where no such face is, nothing is added: waves of some samples
    const auto waves = test::contours::sampled(40, [](const Vec3& x) {
      const double v = std::sin(23 * x[0] + 1) * std::sin(19 * x[1] + 2) +
                       std::sin(21 * x[2] + 9 * x[0]) * std::cos(17 * x[1]);
      return std::min(v - 0.1, 9 * (0.46 - (x - Vec3::Constant(0.5)).cwiseAbs().maxCoeff()));
    });
    const auto t = test::contours::topology(meshing::dual_contour_quads(waves, {}, 0));
    MESSAGE("noise: up to ", joined_most, " joined faces; waves: Euler number ", t.euler);
    CHECK(joined_faces(waves, 0) == 0);
    CHECK(t.euler == 2 * inside_euler(waves, 0));
    CHECK(t.euler != 2);
  }
}
