// SPDX-License-Identifier: MIT
// The parts of contouring and of centre lines, each by the property that the others rely on.
#include "support/work_cases.hpp"
#include "tunica/image/image.hpp"
#include "tunica/meshing/cell_loops.hpp"
#include "tunica/meshing/centre_curve.hpp"
#include "tunica/meshing/centre_tree.hpp"
#include "tunica/meshing/dual_parts.hpp"
#include "tunica/meshing/dual_topology.hpp"
#include "tunica/meshing/padded_bits.hpp"
#include "tunica/meshing/sign_bits.hpp"
#include "tunica/search/eight_boxes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;
namespace parts = meshing::detail;

namespace {

/// Inside nodes by chance, none of them at the border.
std::vector<std::uint8_t> random_inside(const std::array<std::size_t, 3>& size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> inside(size[0] * size[1] * size[2], 0);
  for (std::size_t k = 1; k + 1 < size[2]; ++k)
    for (std::size_t j = 1; j + 1 < size[1]; ++j)
      for (std::size_t i = 1; i + 1 < size[0]; ++i)
        inside[i + size[0] * (j + size[1] * k)] = random() % 2 == 0;
  return inside;
}

double length(const std::vector<Vec3>& x) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += (x[i] - x[i - 1]).norm();
  return sum;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: the loops of a cell cut its border into one part more than there are loops") {
    int seen = 0;
    for (unsigned signs = 0; signs < 256; ++signs)
      for (unsigned joined = 0; joined < 64; ++joined) {
        const auto loops = parts::cell_loops(signs, joined);
        const auto in = parts::cell_parts(signs, loops), out = parts::cell_parts(~signs & 255U, loops);
        for (int c = 0; c < 8; ++c) {
          const auto at = static_cast<std::size_t>(c);
          CHECK((in.part[at] >= 0) == parts::corner_inside(signs, c));
          CHECK((out.part[at] >= 0) != parts::corner_inside(signs, c));
          CHECK(in.part[at] < in.count);
        }
        for (const auto& e : parts::cell_tables.edge_corners)
          if (parts::corner_inside(signs, e[0]) && parts::corner_inside(signs, e[1]))
            CHECK(in.part[static_cast<std::size_t>(e[0])] == in.part[static_cast<std::size_t>(e[1])]);
        bool clear = true;  // the loops tell how each ambiguous face is crossed
        for (std::size_t f = 0; f < 6; ++f)
          clear = clear && !(parts::ambiguous(signs, f) && parts::strands_meet(loops, f));
        if (!clear || signs == 0 || signs == 255) continue;
        CHECK(in.count + out.count == loops.count + 1);  // Jordan's theorem on the border of the cell
        ++seen;
      }
    CHECK(seen > 10000);
  }

  TEST_CASE("meshing: padded bits are the signs with an outside layer around them") {
    for (const Index n : {3, 62, 63, 64, 65, 130}) {
      image::Image<float> im;
      std::mt19937 random(9);
      const std::array<std::size_t, 3> size{static_cast<std::size_t>(n), 4, 3};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < size[a]; ++i) im.axes[a].push_back(static_cast<double>(i));
      for (std::size_t v = 0; v < size[0] * 12; ++v) im.values.push_back(random() % 3 == 0 ? 1.0F : 0.0F);
      const SignBits signs(im, {}, 0.5);
      const parts::PaddedBits bits(signs, size);
      std::vector<std::uint8_t> inside;
      for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t j = 0; j < 6; ++j)
          for (std::size_t i = 0; i < size[0] + 2; ++i) {
            const bool within = i > 0 && j > 0 && k > 0 && i <= size[0] && j <= 4 && k <= 3;
            const bool wanted = within && im.values[i - 1 + size[0] * (j - 1 + 4 * (k - 1))] >= 0.5F;
            CHECK(bits.inside(i, j, k) == wanted);
            if (wanted) CHECK(bits.any(j, k));
            inside.push_back(wanted);
          }
      const parts::PaddedBits same(inside, {size[0] + 2, 6, 5});
      for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t j = 0; j < 6; ++j)
          for (std::size_t w = 0; w < bits.words(); ++w) {
            CHECK(bits.row(j, k)[w] == same.row(j, k)[w]);
            for (std::size_t b = 0; b < 64 && 64 * w + b < size[0] + 2; ++b) {
              const std::size_t i = 64 * w + b;
              const bool has_next = i + 1 < size[0] + 2;
              CHECK((bits.with_next(w) >> b & 1U) == (has_next ? 1U : 0U));
              if (has_next)
                CHECK((bits.next(bits.row(j, k), w) >> b & 1U) == (bits.inside(i + 1, j, k) ? 1U : 0U));
            }
          }
      CHECK(!bits.alike());
    }
    // all inside, and all but one node
    parts::PaddedBits full(std::vector<std::uint8_t>(27, 0), {3, 3, 3});
    CHECK(full.alike());
    std::vector<std::uint8_t> one(27, 0);
    one[13] = 1;
    parts::PaddedBits middle(one, {3, 3, 3});
    CHECK(middle.alike());
    middle.drop(1, 1, 1);
    CHECK(!middle.inside(1, 1, 1));
  }

  TEST_CASE("meshing: the dual mesh has a quadrilateral for each crossed edge and a vertex for each loop") {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const std::array<std::size_t, 3> size{70, 9, 8};
      const auto inside = random_inside(size, seed);
      const parts::PaddedBits bits(inside, size);
      const parts::DualTopology topology(bits);
      const std::array<std::size_t, 3> stride{1, size[0], size[0] * size[1]};
      Index quads = 0, edges = 0, faces = 0;
      std::set<std::size_t> mixed;  // cells by their lowest nodes
      for (std::size_t v = 0; v < inside.size(); ++v) {
        const std::array<std::size_t, 3> p{v % size[0], v / stride[1] % size[1], v / stride[2]};
        for (std::size_t a = 0; a < 3; ++a) {
          if (p[a] + 1 == size[a] || inside[v] == inside[v + stride[a]]) continue;
          ++quads;
          for (const std::size_t u : {std::size_t{0}, stride[(a + 1) % 3]})
            for (const std::size_t w : {std::size_t{0}, stride[(a + 2) % 3]}) mixed.insert(v - u - w);
        }
      }
      CHECK(topology.quad_count() == quads);
      Index vertices = 0;
      std::vector<int> met(static_cast<std::size_t>(topology.vertex_count()), 0);
      for (std::size_t k = 0; k + 1 < size[2]; ++k)
        for (std::size_t j = 0; j + 1 < size[1]; ++j) {
          const auto range = topology.cells(j, k);
          for (std::size_t c = range.first; c < range.end; ++c) {
            const std::size_t node = topology.i(c) + stride[1] * j + stride[2] * k;
            CHECK(mixed.erase(node) == 1);
            CHECK(topology.find(topology.i(c), j, k) == c);
            CHECK(topology.first_vertex(c) == vertices);
            vertices += topology.loops(c).count;
            unsigned signs = 0;
            for (unsigned q = 0; q < 8; ++q)
              signs |=
                  unsigned{inside[node + (q & 1U) + (q >> 1 & 1U) * stride[1] + (q >> 2) * stride[2]] != 0}
                  << q;
            for (std::size_t e = 0; e < 12; ++e) {
              const auto& ends = parts::cell_tables.edge_corners[e];
              const bool crossed =
                  parts::corner_inside(signs, ends[0]) != parts::corner_inside(signs, ends[1]);
              CHECK((topology.loops(c).loop[e] >= 0) == crossed);
              if (!crossed) continue;
              ++edges;
              ++met[static_cast<std::size_t>(topology.vertex(~static_cast<Index>(c), e))];
            }
            for (std::size_t f = 0; f < 6; ++f) {
              int changes = 0;
              for (std::size_t n = 0; n < 4; ++n) {
                const auto& ring = parts::cell_tables.face_corners[f];
                changes +=
                    parts::corner_inside(signs, ring[n]) != parts::corner_inside(signs, ring[(n + 1) % 4]);
              }
              faces += changes / 2;
            }
          }
        }
      CHECK(mixed.empty());
      CHECK(vertices == topology.vertex_count());
      CHECK(edges == 4 * quads);  // each crossed edge is in four cells
      CHECK(faces == 4 * quads);  // each strand on a face is an edge of the dual mesh, in two cells
      for (const int m : met) CHECK(m >= 3);
    }
  }

  TEST_CASE("meshing: resampled curves keep their ends and have even steps") {
    std::vector<Vec3> arc;
    for (int i = 0; i <= 400; ++i) {
      const double a = std::numbers::pi * std::pow(i / 400.0, 2);  // uneven
      arc.emplace_back(std::cos(a), std::sin(a), 0);
    }
    CHECK(parts::curve_length(arc) == doctest::Approx(length(arc)).epsilon(1e-14));
    for (const double step : {0.5, 0.1, 0.02}) {
      const auto x = parts::resampled(arc, step);
      CHECK(x.front() == arc.front());
      CHECK(x.back() == arc.back());
      const double wanted = length(arc) / static_cast<double>(x.size() - 1);
      CHECK(std::abs(wanted / step - 1) < 0.2);
      for (std::size_t i = 1; i < x.size(); ++i)
        CHECK(std::abs((x[i] - x[i - 1]).norm() / wanted - 1) <
              wanted * wanted / 20 + 1e-3);  // chords of arcs
      const auto t = parts::tangents(x);
      for (std::size_t i = 1; i + 1 < x.size(); ++i) CHECK(std::abs(t[i].dot(x[i])) < 1e-3);
    }
    // what is straight stays, what is not grows shorter
    std::vector<Vec3> line, wave;
    for (int i = 0; i <= 20; ++i) {
      line.emplace_back(0.5 * i, 0.25 * i, 1);
      wave.emplace_back(0.5 * i, i % 2, 1);
    }
    auto same = line;
    parts::smooth_curve(same, 50);
    for (std::size_t i = 0; i < line.size(); ++i) CHECK((same[i] - line[i]).norm() < 1e-14);
    double last = length(wave);
    for (int sweep = 0; sweep < 5; ++sweep) {
      parts::smooth_curve(wave, 1);
      CHECK(length(wave) < last);
      last = length(wave);
    }
    CHECK(wave.front() == Vec3(0, 0, 1));
    CHECK(wave.back() == Vec3(10, 0, 1));
  }

  TEST_CASE("meshing: lines from one root are a tree in which common pieces are kept once") {
    // a trunk along z that leaves two limbs at different heights
    const auto limb = [](double height, double slope) {
      std::vector<Vec3> x;
      for (int i = 0; i <= 60; ++i) {
        const double z = 0.1 * i;
        x.emplace_back(z > height ? slope * (z - height) : 0, 0, z);
      }
      return x;
    };
    const std::vector<std::vector<Vec3>> lines{limb(9, 0), limb(2, 0.8), limb(4, -0.9), limb(2, -0.7)};
    const std::vector<std::vector<double>> radius(4, std::vector<double>(61, 0.5));
    const parts::LineTree tree(lines, radius);
    std::vector<std::vector<int>> met(4, std::vector<int>(61, 0));
    for (std::size_t p = 0; p < tree.pieces.size(); ++p) {
      const auto& piece = tree.pieces[p];
      CHECK(piece.first <= piece.last);
      for (std::size_t i = piece.first; i <= piece.last; ++i) ++met[piece.line][i];
      CHECK(piece.parent < static_cast<Index>(p));
      CHECK((piece.parent < 0) == (p == 0));
      if (piece.parent < 0) continue;
      const auto& parent = tree.pieces[static_cast<std::size_t>(piece.parent)];
      const Vec3 gap = lines[piece.line][piece.first] - lines[parent.line][parent.last];
      CHECK(gap.norm() < 0.3);  // a step, and the tenth of a radius in which lines count as one
    }
    CHECK(tree.pieces.size() == 6);  // two forks on the trunk, one of them with two limbs
    for (int i = 0; i <= 60; ++i) CHECK(met[0][static_cast<std::size_t>(i)] == 1);
    for (std::size_t l = 1; l < 4; ++l) {
      const double height = l == 2 ? 4 : 2;
      for (std::size_t i = 0; i <= 60; ++i) {
        CHECK(met[l][i] <= 1);
        if (lines[l][i][2] < height) CHECK(met[l][i] == 0);
        if (lines[l][i][2] > height + 0.3) CHECK(met[l][i] == 1);
      }
    }
  }

  TEST_CASE("search: eight boxes are met as each of them alone") {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int round = 0; round < 200; ++round) {
      search::detail::EightBoxes eight;
      std::array<search::detail::SmallBox, 8> boxes;
      const std::size_t count = random() % 9;
      const auto any = [&] {
        search::detail::SmallBox b;
        for (std::size_t a = 0; a < 3; ++a) {
          const float p = uniform(random), q = p + 0.5F * std::abs(uniform(random));
          b.lo[a] = p, b.hi[a] = q;
        }
        return b;
      };
      for (std::size_t i = 0; i < count; ++i) eight.put(i, boxes[i] = any());
      for (std::size_t i = 0; i < 8; ++i) CHECK(eight.at(i).empty() == (i >= count));
      const auto wanted = any();
      unsigned bits = 0;
      for (std::size_t i = 0; i < count; ++i) {
        bool meet = true;
        for (std::size_t a = 0; a < 3; ++a)
          meet = meet && boxes[i].lo[a] <= wanted.hi[a] && wanted.lo[a] <= boxes[i].hi[a];
        bits |= unsigned{meet} << i;
      }
      CHECK(eight.overlapping(wanted) == bits);
      if (count > 0) {
        const auto all = eight.all();
        for (std::size_t a = 0; a < 3; ++a) {
          float lo = boxes[0].lo[a], hi = boxes[0].hi[a];
          for (std::size_t i = 1; i < count; ++i)
            lo = std::min(lo, boxes[i].lo[a]), hi = std::max(hi, boxes[i].hi[a]);
          CHECK(all.lo[a] == lo);
          CHECK(all.hi[a] == hi);
        }
      }
      const std::array<float, 3> x{uniform(random), uniform(random), uniform(random)};
      const float bound = 0.3F;
      const auto near = eight.near(x, bound);
      for (std::size_t i = 0; i < count; ++i) {
        double d2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double lo = boxes[i].lo[a], hi = boxes[i].hi[a], p = x[a];
          const double off = p < lo ? lo - p : p > hi ? p - hi : 0;
          d2 += off * off;
        }
        if (std::abs(d2 - bound) < 1e-5) continue;
        CHECK((near.bits >> i & 1U) == (d2 < bound ? 1U : 0U));
        if (d2 < bound) CHECK(std::abs(near.square[i] - d2) < 1e-5);
      }
      CHECK((near.bits >> count) == 0U);
    }
  }
}
