// SPDX-License-Identifier: MIT
// Hexahedra in a vessel: round the voxels of an image, and the dual mesh of a grid with layers on the
// surface.
#include "support/hexahedra.hpp"
#include "support/contours.hpp"
#include "support/stubs.hpp"
#include "support/surfaces.hpp"
#include "support/vessels.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/dual_hexahedra.hpp"
#include "tunica/meshing/hermite_field.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/voxel_hexahedra.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace tunica;

namespace {

std::vector<std::uint8_t> inside(const image::Image<float>& im) {
  std::vector<std::uint8_t> mask;
  for (const float v : im.values) mask.push_back(v >= 0 ? 1 : 0);
  return mask;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: voxel hexahedra fill an image with uneven spacing up to its border") {
    image::Image<float> im;
    im.axes = {std::vector<double>{0, 1, 3}, std::vector<double>{-1, 0}, std::vector<double>{2, 2.5, 4, 5}};
    im.values.assign(24, 1.0F);
    const auto all = meshing::voxel_hexahedra(im, inside(im));
    CHECK(all.mesh.cell_count() == 24);
    CHECK(all.mesh.node_count() == 4 * 3 * 5);
    CHECK(mesh::volume(all.mesh) == doctest::Approx(3.0 * 1 * 3).epsilon(1e-14));
    REQUIRE(all.mesh.patches.size() == 7);
    CHECK(all.mesh.patch("wall").faces.cols() == 0);
    CHECK(all.mesh.patch("border z1").faces.cols() == 6);
    CHECK(test::hex_faces(all.mesh).missing == 0);
    CHECK(all.contacts.edges + all.contacts.corners + all.contacts.pinches == 0);

    im.values.assign(24, -1.0F);
    im.values[im.offset({1, 1, 1})] = 1;  // from 0.5 to 2, -0.5 to 0, 2.25 to 3.25
    const auto one = meshing::voxel_hexahedra(im, inside(im));
    REQUIRE(one.mesh.cell_count() == 1);
    CHECK(mesh::volume(one.mesh) == doctest::Approx(1.5 * 0.5 * 1.0).epsilon(1e-14));
    CHECK(one.mesh.patch("wall").faces.cols() == 5);
    CHECK(one.mesh.patch("border y1").faces.cols() == 1);
    CHECK(test::hex_faces(one.mesh).missing == 0);
    CHECK_THROWS_AS(static_cast<void>(meshing::voxel_hexahedra(im, std::vector<std::uint8_t>(24, 0))),
                    MeshError);
  }

  TEST_CASE("meshing: voxels that touch by an edge or a corner are named and parted or joined") {
    image::Image<float> im;
    for (auto& axis : im.axes) axis = {0, 1, 2, 3};
    im.values.assign(64, -1.0F);
    im.values[im.offset({1, 1, 1})] = im.values[im.offset({2, 2, 1})] = 1;  // by an edge
    im.values[im.offset({1, 2, 1})] = -0.5F;
    const auto kept = meshing::voxel_hexahedra(im, inside(im), {.contacts = meshing::VoxelContacts::kept});
    CHECK(kept.mesh.node_count() == 14);
    CHECK(kept.contacts.edges == 1);
    CHECK(kept.contacts.left_edges == 1);
    REQUIRE(kept.contacts.places.size() == 1);
    CHECK((kept.contacts.places[0] - Vec3(1.5, 1.5, 1)).norm() < 1e-14);
    const auto parted = meshing::voxel_hexahedra(im, inside(im));
    CHECK(parted.mesh.node_count() == 16);
    CHECK(parted.contacts.split_nodes == 2);
    CHECK(parted.contacts.left_edges == 0);
    const auto joined =
        meshing::voxel_hexahedra(im, inside(im), {.contacts = meshing::VoxelContacts::filled});
    CHECK(joined.contacts.filled_voxels == 1);
    CHECK(joined.mesh.cell_count() == 3);

    im.values[im.offset({2, 2, 1})] = -1, im.values[im.offset({2, 2, 2})] = 1;  // by a corner
    const auto corner = meshing::voxel_hexahedra(im, inside(im));
    CHECK(corner.contacts.corners == 1);
    CHECK(corner.contacts.edges == 0);
    CHECK(corner.mesh.node_count() == 16);
    const auto bridged =
        meshing::voxel_hexahedra(im, inside(im), {.contacts = meshing::VoxelContacts::filled});
    CHECK(bridged.mesh.cell_count() > 3);
    CHECK(bridged.contacts.corners + bridged.contacts.edges + bridged.contacts.pinches == 0);
  }

  TEST_CASE(
      "meshing: the border of filled voxels of noise is a manifold and separated ones count what is left") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const auto im = test::noise_volume(12, seed);
      const auto mask = inside(im);
      const auto parted = meshing::voxel_hexahedra(im, mask);
      CHECK(test::hex_faces(parted.mesh).unmatched == 0);
      CHECK(test::hex_faces(parted.mesh).missing == 0);
      CHECK(parted.contacts.edges > 100);
      std::map<std::pair<Index, Index>, int> uses;
      const auto border = test::border_of(parted.mesh);
      for (Index q = 0; q < border.cell_count(); ++q)
        for (int k = 0; k < 4; ++k) {
          const Index a = border.cells(k, q), b = border.cells((k + 1) % 4, q);
          ++uses[{std::min(a, b), std::max(a, b)}];
        }
      const auto shared = std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second > 2; });
      CHECK(static_cast<std::size_t>(shared) == parted.contacts.left_edges);
      const auto joined = meshing::voxel_hexahedra(im, mask, {.contacts = meshing::VoxelContacts::filled});
      const auto t = test::contours::topology(test::border_of(joined.mesh));
      CHECK(t.open_edges == 0);
      CHECK(t.wrong_edges == 0);
      CHECK(t.wrong_vertices == 0);
      CHECK(joined.contacts.filled_voxels ==
            static_cast<std::size_t>(joined.mesh.cell_count() - parted.mesh.cell_count()));
    }
  }

  TEST_CASE("meshing: dual hexahedra have matching faces and patches of the names of the regions") {
    const auto lumen = test::vessels::cylinder(5, 20, 48);
    const auto fill = meshing::dual_hexahedra(lumen, {.edge = 1.25});
    const auto f = test::hex_faces(fill.mesh);
    CHECK(f.unmatched == 0);
    CHECK(f.missing == 0);
    CHECK(f.border == f.in_patches);
    REQUIRE(fill.mesh.patches.size() == 3);
    const auto planes = meshing::flat_regions(lumen);
    for (std::size_t r = 0; r < 3; ++r) {
      const auto& patch = fill.mesh.patches[r];
      CHECK(patch.name == lumen.region_names[r]);
      CHECK(patch.faces.cols() > 0);
      for (Eigen::Index i = 0; r > 0 && i < patch.faces.size(); ++i)
        CHECK(std::abs(planes[r]->distance(fill.mesh.nodes.col(patch.faces.data()[i]))) < 1e-12 * 20);
    }
    const auto t = test::contours::topology(test::border_of(fill.mesh));
    CHECK(t.open_edges + t.wrong_edges + t.wrong_vertices == 0);
    CHECK(t.euler == 2);
    CHECK(fill.report.inverted == 0);
    CHECK(fill.report.least_jacobian >= 0.3);
    CHECK(fill.report.volume == doctest::Approx(fill.report.surface_volume).epsilon(0.01));
    const auto again = meshing::dual_hexahedra(lumen, {.edge = 1.25});
    CHECK(again.mesh.nodes == fill.mesh.nodes);
    CHECK(again.mesh.cells == fill.mesh.cells);
  }

  TEST_CASE("meshing: dual hexahedra in a bifurcation are sound") {
    const auto s = meshing::marching_cubes(
                       test::sampled<float>(32, [](const Vec3& x) { return -test::bifurcation(x); }), 0)
                       .surface;
    const auto fill = meshing::dual_hexahedra(s, {.edge = 1.0 / 31});
    MESSAGE("bifurcation 32: " << fill.report.cells << " hexahedra, least " << fill.report.least_jacobian
                               << ", mean " << fill.report.mean_jacobian);
    CHECK(fill.report.inverted == 0);
    CHECK(fill.report.least_jacobian >= 0.3);
    CHECK(fill.report.below_sound == 0);
    CHECK(test::least_determinant(fill.mesh, 50) > 0);
    CHECK(fill.report.volume == doctest::Approx(fill.report.surface_volume).epsilon(0.005));
  }

  TEST_CASE("meshing: each hexahedron has one face on a smooth wall and two along a rim") {
    const auto lumen = test::vessels::cylinder(5, 20, 48);
    const auto m = meshing::dual_hexahedra(lumen, {.edge = 1.5}).mesh;
    std::map<std::array<Index, 4>, std::string> patch_of;
    const auto key = [](std::array<Index, 4> f) {
      std::sort(f.begin(), f.end());
      return f;
    };
    for (const auto& p : m.patches)
      for (Eigen::Index q = 0; q < p.faces.cols(); ++q)
        patch_of[key({p.faces(0, q), p.faces(1, q), p.faces(2, q), p.faces(3, q)})] = p.name;
    int one = 0, rim = 0, other = 0;
    for (Index c = 0; c < m.cell_count(); ++c) {
      std::vector<std::string> names;
      for (const auto& f : mesh::Hex8::faces)
        if (const auto found =
                patch_of.find(key({m.cells(f[0], c), m.cells(f[1], c), m.cells(f[2], c), m.cells(f[3], c)}));
            found != patch_of.end())
          names.push_back(found->second);
      if (names.size() == 1) ++one;
      if (names.size() == 2) (names[0] != names[1] ? rim : other) += 1;
      if (names.size() > 2) ++other;
    }
    CHECK(one > 300);
    CHECK(rim >= 2 * 15);
    CHECK(other == 0);
  }

  TEST_CASE("meshing: sharp edges of a surface without regions are kept when asked for") {
    const auto block =
        meshing::box_tets(meshing::Block{.cells = {4, 4, 4}, .lo = {0, 0, 0}, .hi = {1, .7, .4}});
    mesh::Surface s;
    s.nodes = block.nodes;
    for (const auto& p : block.patches) {
      const Eigen::Index before = s.cells.cols();
      s.cells.conservativeResize(3, before + p.faces.cols());
      s.cells.rightCols(p.faces.cols()) = p.faces;
    }
    const auto sharp = meshing::dual_hexahedra(s, {.edge = 0.07, .sharp_angle = 60}).report;
    const auto round = meshing::dual_hexahedra(s, {.edge = 0.07}).report;
    MESSAGE("box: volume " << sharp.volume << " of " << sharp.surface_volume << ", without its edges "
                           << round.volume << "; least " << sharp.least_jacobian);
    CHECK(std::abs(sharp.volume - 0.28) < 0.01 * 0.28);
    CHECK(std::abs(round.volume - 0.28) > std::abs(sharp.volume - 0.28));
    CHECK(sharp.below_sound == 0);
    CHECK(round.below_sound == 0);
  }

  TEST_CASE("meshing: what no hexahedron fits in is refused or told of") {
    const auto ball =
        meshing::marching_cubes(test::sampled<float>(16, [](const Vec3& x) { return -test::sphere(x); }), 0)
            .surface;
    CHECK_THROWS_AS(static_cast<void>(meshing::dual_hexahedra(ball, {.edge = 2.0})), MeshError);
    mesh::Surface inward = ball;
    inward.cells.row(0).swap(inward.cells.row(1));
    CHECK_THROWS_AS(static_cast<void>(meshing::dual_hexahedra(inward, {.edge = 0.1})), MeshError);
    mesh::Surface open = ball;
    open.cells.conservativeResize(3, open.cells.cols() - 1);
    CHECK_THROWS_AS(static_cast<void>(meshing::dual_hexahedra(open, {.edge = 0.1})), MeshError);
  }

  TEST_CASE("meshing: the scaled Jacobian of a corner has the derivatives of differences") {
    const std::array<Vec3, 3> e{Vec3(1, 0.2, -0.1), Vec3(0.3, 1.5, 0.2), Vec3(-0.2, 0.4, 0.8)};
    const auto c = meshing::detail::corner_shape(e[0], e[1], e[2]);
    CHECK(c.s == doctest::Approx(meshing::detail::corner_jacobian(e[0], e[1], e[2])).epsilon(1e-14));
    for (std::size_t k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) {
        auto lo = e, hi = e;
        lo[k][a] -= 1e-6, hi[k][a] += 1e-6;
        const double d = (meshing::detail::corner_jacobian(hi[0], hi[1], hi[2]) -
                          meshing::detail::corner_jacobian(lo[0], lo[1], lo[2])) /
                         2e-6;
        CHECK(c.by[k][a] == doctest::Approx(d).epsilon(1e-8));
      }
  }

  TEST_CASE("meshing: points beside a convex surface slide to the place that a search over all finds") {
    mesh::Surface s = test::icosphere(3);
    s.nodes = (0.4 * s.nodes).colwise() + Vec3::Constant(0.5);
    const std::vector<Index> facet(static_cast<std::size_t>(s.cell_count()), 0);
    const meshing::SurfaceWalk walk(s, facet);
    meshing::SurfacePoint p = walk.nearest(Vec3(0.9, 0.5, 0.5), 0);
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.03 * i, z = 0.3 * std::sin(0.7 * t);
      const Vec3 x = Vec3(0.5, 0.5, 0.5) +
                     (0.43 + 0.02 * std::sin(5 * t)) * Vec3(std::cos(t), std::sin(t), z).normalized();
      p = walk.slide(p.triangle, x);
      worst = std::max(worst, (p.point - x).norm() - (walk.nearest(x, 0).point - x).norm());
    }
    CHECK(worst < 1e-12);
  }

  TEST_CASE("meshing: determinants are known to be positive everywhere or found not to be") {
    // one node of a cube is drawn along the diagonal, or one side is twisted against the other
    const std::array<Index, 8> cell{0, 1, 2, 3, 4, 5, 6, 7};
    const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    int both = 0;
    for (int i = 0; i <= 200; i += 2)
      for (const bool twist : {false, true}) {
        auto x = cube;
        const double c = std::cos(0.01 * i), s = std::sin(0.01 * i);
        for (std::size_t k = 4; twist && k < 8; ++k) {
          const double u = x[k][0] - 0.5, v = x[k][1] - 0.5;
          x[k][0] = 0.5 + c * u - s * v, x[k][1] = 0.5 + s * u + c * v;
        }
        if (!twist) x[6] = Vec3::Constant(1 - 0.005 * i);
        mesh::HexMesh m;
        m.nodes = vec::columns(x);
        m.cells = Connectivity<8>(8, 1);
        for (int k = 0; k < 8; ++k) m.cells(k, 0) = k;
        double least = test::least_determinant(m, 1000);
        for (std::size_t p = 0; p < 27; ++p)
          least = std::min(least, meshing::detail::determinant(meshing::detail::point_edges(x, cell, p)));
        const bool positive = meshing::detail::positive_everywhere(x, cell);
        if (positive) CHECK(least > 0);
        if (least > 0.03) CHECK(positive);
        both |= positive ? 1 : 2;
      }
    CHECK(both == 3);
  }

  TEST_CASE("meshing: specks of a grid are taken out and the grid stays consistent") {
    const auto im = test::noise_volume(14, 5);
    auto grid = meshing::hermite_of_image(im, std::vector<std::uint8_t>{}, 0);
    const auto specks = meshing::remove_specks(grid, 8);
    CHECK(specks.dropped > 0);
    CHECK(specks.filled > 0);
    CHECK(specks.places.size() == specks.dropped + specks.filled);
    std::size_t crossed = 0;
    meshing::detail::for_crossed_edges(grid, [&](std::size_t edge, std::size_t, std::size_t, std::size_t) {
      CHECK(grid.edges[crossed] == edge);
      ++crossed;
    });
    CHECK(crossed == grid.edges.size());
    const auto again = meshing::remove_specks(grid, 2);
    CHECK(again.places.empty());
  }

  TEST_CASE("meshing: the dual complex of noise has matching faces whatever the signs") {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
      const auto im = seed % 2 == 0 ? test::noise_volume(12, seed) : test::integer_noise_volume(12, seed);
      const auto grid = meshing::hermite_of_image(im, std::vector<std::uint8_t>{}, 0);
      const auto complex = meshing::dual_complex(grid, meshing::dual_contour(grid));
      mesh::HexMesh m;
      m.nodes = vec::columns(complex.nodes);
      m.cells.resize(8, static_cast<Eigen::Index>(complex.cells.size()));
      for (std::size_t c = 0; c < complex.cells.size(); ++c)
        for (std::size_t k = 0; k < 8; ++k)
          m.cells(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = complex.cells[c][k];
      std::vector<Index> list;
      for (const auto& q : complex.border) list.insert(list.end(), q.begin(), q.end());
      m.patches.push_back({"wall", vec::quads(list)});
      const auto f = test::hex_faces(m);
      CHECK(f.unmatched == 0);
      CHECK(f.missing == 0);
      const auto t = test::contours::topology(test::border_of(m));
      CHECK(t.open_edges + t.wrong_edges + t.wrong_vertices == 0);
    }
  }
}
