// SPDX-License-Identifier: MIT
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/marching_cubes_table.hpp"

#include "support/work_cases.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/mesh/topology.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

using namespace tunica;

namespace {

/// Finds: closed, manifold, oriented outward, no degenerate triangle, no duplicate vertex.
void check_surface(const mesh::Surface& s) {
  const auto t = mesh::topology(s);
  CHECK(t.open_edges == 0);
  CHECK(t.nonmanifold_edges == 0);
  CHECK(t.nonmanifold_nodes == 0);
  CHECK(t.misoriented_edges == 0);
  CHECK(t.unused_nodes == 0);
  CHECK(mesh::enclosed_volume(s) > 0);
  CHECK(mesh::quality(s).angle.least > 0);
  std::set<std::array<double, 3>> places;
  for (Index n = 0; n < s.node_count(); ++n) places.insert({s.nodes(0, n), s.nodes(1, n), s.nodes(2, n)});
  CHECK(places.size() == static_cast<std::size_t>(s.node_count()));
}

image::Image<short> block(Index nx, Index ny, Index nz, short value) {
  image::Image<short> im;
  const std::array<Index, 3> n{nx, ny, nz};
  for (std::size_t a = 0; a < 3; ++a)
    for (Index i = 0; i < n[a]; ++i) im.axes[a].push_back(i);
  im.values.assign(static_cast<std::size_t>(nx * ny * nz), value);
  return im;
}

/// Euler number of the solid whose surface is looked for, from the values alone: inside nodes, edges between
/// two of them, faces of four and cells of eight are its cells. Where only two opposite corners of a cell are
/// outside, each is cut off for itself and the hexagon of the others is filled.
template <class T>
Index euler_of_inside(const image::Image<T>& im, double iso) {
  const Index nx = im.size(0), ny = im.size(1), nz = im.size(2);
  Index sum = 0;
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i) {
        const std::array<bool, 3> end{i + 1 == nx, j + 1 == ny, k + 1 == nz};
        std::array<bool, 8> in{};
        for (Index c = 0; c < 8; ++c) {
          const Index x = c & 1, y = c >> 1 & 1, z = c >> 2;
          if ((x == 0 || !end[0]) && (y == 0 || !end[1]) && (z == 0 || !end[2]))
            in[static_cast<std::size_t>(c)] = static_cast<double>(im({i + x, j + y, k + z})) >= iso;
        }
        sum += in[0];
        sum -= (in[0] && in[1]) + (in[0] && in[2]) + (in[0] && in[4]);
        sum += (in[0] && in[1] && in[2] && in[3]) + (in[0] && in[1] && in[4] && in[5]) +
               (in[0] && in[2] && in[4] && in[6]);
        if (end[0] || end[1] || end[2]) continue;
        const auto count = std::count(in.begin(), in.end(), true);
        sum -= count == 8;
        for (std::size_t c = 0; c < 4; ++c) sum += count == 6 && !in[c] && !in[7 - c];
      }
  return sum;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: marching cubes table has closed loops and no chord in a face") {
    const auto& table = meshing::detail::marching_table();
    for (unsigned signs = 0; signs < 256; ++signs) {
      const auto& c = table[signs];
      std::array<std::array<int, 12>, 12> used{};
      for (std::size_t t = 0; t < static_cast<std::size_t>(c.count); ++t)
        for (std::size_t k = 0; k < 3; ++k)
          ++used[static_cast<std::size_t>(c.triangle[t][k])]
                [static_cast<std::size_t>(c.triangle[t][(k + 1) % 3])];
      const auto next = meshing::detail::strands(signs);
      int crossed = 0, strands = 0;
      for (std::size_t e = 0; e < 12; ++e) {
        const auto& ends = meshing::detail::cell_tables.edge_corners[e];
        const bool cut =
            meshing::detail::corner_inside(signs, ends[0]) != meshing::detail::corner_inside(signs, ends[1]);
        crossed += cut;
        strands += next[e] >= 0;
        CHECK((next[e] >= 0) == cut);
        for (std::size_t f = 0; f < 12; ++f) {
          CHECK(used[e][f] <= 1);
          if (used[e][f] == 0) continue;
          // an inner chord is used both ways and lies in no face; a strand is used one way
          if (used[f][e] != 0)
            CHECK_FALSE(meshing::detail::share_face(static_cast<int>(e), static_cast<int>(f)));
          else
            CHECK(next[e] == static_cast<int>(f));
        }
      }
      CHECK(crossed == strands);
    }
  }

  TEST_CASE("meshing: marching cubes closes noise") {
    const auto noise = meshing::marching_cubes(test::noise_volume(64), 0);
    const auto integer = meshing::marching_cubes(test::integer_noise_volume(64), 0);
    MESSAGE("noise 64: ", noise.surface.cell_count(),
            " triangles, noisei 64: ", integer.surface.cell_count());
    check_surface(noise.surface);
    check_surface(integer.surface);
    CHECK(noise.borders.empty());
    CHECK(noise.surface.cell_count() > 700000);
  }

  TEST_CASE("meshing: Euler number of noise by marching cubes is that of an independent count") {
    for (std::uint64_t seed = 0; seed < 4; ++seed)
      for (const bool integer : {false, true}) {
        const auto im = integer ? test::integer_noise_volume(64, seed) : test::noise_volume(64, seed);
        const auto s = meshing::marching_cubes(im, 0).surface;
        // closed: three edges for two triangles
        const Index euler = s.node_count() - s.cell_count() / 2, solid = euler_of_inside(im, 0);
        MESSAGE(std::string(integer ? "noisei" : "noise"), " 64, seed ", seed, ": Euler number ", euler);
        CHECK(s.cell_count() % 2 == 0);
        CHECK(euler == 2 * solid);
        CHECK(std::abs(euler) > 10000);
      }
    const auto sphere =
        meshing::marching_cubes(test::sampled<float>(20, [](const Vec3& x) { return -test::sphere(x); }), 0);
    CHECK(mesh::topology(sphere.surface).euler() == 2);
  }

  TEST_CASE("meshing: marching cubes caps noise at every face of the image") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      image::Image<int> im;
      const std::array<Index, 3> n{(seed % 4 == 0 ? 128 : 2) + static_cast<Index>(seed % 3), 7,
                                   2 + static_cast<Index>(seed % 5)};
      std::uint64_t at = seed << 32;
      for (std::size_t a = 0; a < 3; ++a) {
        double x = 10;
        for (Index i = 0; i < n[a]; ++i) im.axes[a].push_back(x += 1.5 + test::noise(++at));  // uneven
      }
      im.values.resize(static_cast<std::size_t>(n[0] * n[1] * n[2]));
      for (int& v : im.values) v = static_cast<int>(test::splitmix64(++at) % 5) - 2;
      const auto c = meshing::marching_cubes(im, 0);
      check_surface(c.surface);
      CHECK(mesh::topology(c.surface).euler() == 2 * euler_of_inside(im, 0));
      CHECK(c.borders.size() == 6);
      const Box box = mesh::bounding_box(c.surface.nodes);
      for (const auto& b : c.borders) {
        CHECK(b.area == doctest::Approx(mesh::area_of_region(c.surface, b.region)));
        const int axis = b.name[7] - 'x';
        const double plane = b.name[8] == '0' ? box.lo[axis] : box.hi[axis];
        CHECK(c.surface.region_names[static_cast<std::size_t>(b.region)] == b.name);
        for (Index t = 0; t < c.surface.cell_count(); ++t)
          if (c.surface.region_of(t) == b.region)
            for (int k = 0; k < 3; ++k) CHECK(c.surface.nodes(axis, c.surface.cells(k, t)) == plane);
      }
    }
  }

  TEST_CASE("meshing: marching cubes of a tube through the image ends in two border caps") {
    const auto im =
        test::sampled<float>(21, [](const Vec3& x) { return 0.3 - std::hypot(x[0] - 0.5, x[1] - 0.5); });
    const auto c = meshing::marching_cubes(im, 0);
    check_surface(c.surface);
    REQUIRE(c.borders.size() == 2);
    CHECK(c.borders[0].name == "border z0");
    CHECK(c.borders[1].name == "border z1");
    CHECK(c.borders[1].centre[2] == 1);
    CHECK(c.borders[0].area == doctest::Approx(0.09 * std::numbers::pi).epsilon(0.01));
    CHECK(mesh::enclosed_volume(c.surface) == doctest::Approx(c.borders[0].area).epsilon(1e-9));
    CHECK(c.surface.region_names == std::vector<std::string>{"wall", "border z0", "border z1"});
    const auto open = meshing::marching_cubes(im, 0, {.border = meshing::Border::open});
    const auto t = mesh::topology(open.surface);
    CHECK(t.loops.size() == 2);
    CHECK(t.manifold());
    CHECK(t.genus() == 0);
  }

  TEST_CASE("meshing: marching cubes gives the same bits on any number of threads") {
    auto im = test::noise_volume(20);
    for (float& v : im.values) v += 0.5F;  // into the border
    const auto alone = meshing::marching_cubes(im, 0.25);
    for (const int threads : {2, 3, 50}) {
      thread_count() = threads;
      const auto together = meshing::marching_cubes(im, 0.25);
      thread_count() = 1;
      CHECK(together.surface.nodes == alone.surface.nodes);
      CHECK(together.surface.cells == alone.surface.cells);
      CHECK(together.surface.region == alone.surface.region);
    }
  }

  TEST_CASE("meshing: marching cubes keeps to the mask") {
    auto im = block(9, 5, 5, 0);
    for (const Index i : {1, 2, 6, 7}) im.values[im.offset({i, 2, 2})] = 10;
    std::vector<std::uint8_t> kept(im.values.size(), 0);
    for (const Index i : {1, 2}) kept[im.offset({i, 2, 2})] = 1;
    const auto both = meshing::marching_cubes(im, 5);
    const auto one = meshing::marching_cubes(im, kept, 5);
    CHECK(mesh::topology(both.surface).components.size() == 2);
    CHECK(mesh::topology(one.surface).components.size() == 1);
    CHECK(2 * mesh::enclosed_volume(one.surface) == doctest::Approx(mesh::enclosed_volume(both.surface)));
    kept[im.offset({2, 2, 2})] = 0;  // parts two bright voxels: half-way between them
    const auto half = meshing::marching_cubes(im, kept, 5);
    check_surface(half.surface);
    CHECK(mesh::bounding_box(half.surface.nodes).hi[0] == doctest::Approx(1.5));
  }

  TEST_CASE("meshing: marching cubes refuses what nothing crosses") {
    CHECK_THROWS_WITH_AS((void)meshing::marching_cubes(block(4, 4, 4, 7), 5), doctest::Contains("inside"),
                         MeshError);
    CHECK_THROWS_WITH_AS((void)meshing::marching_cubes(block(4, 4, 4, 3), 5), doctest::Contains("outside"),
                         MeshError);
    auto slice = block(4, 4, 1, 0);
    slice.values[5] = 9;
    CHECK_THROWS_WITH_AS((void)meshing::marching_cubes(slice, 5), doctest::Contains("axis z"), MeshError);
  }
}
