// SPDX-License-Identifier: MIT
// Hexahedra in a vessel: round the voxels of an image, and the dual mesh of a grid with layers on the
// surface.
#include "support/contours.hpp"
#include "support/stubs.hpp"
#include "support/vessels.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/dual_hexahedra.hpp"
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

/// The faces of one cell only, as the patches have them; each inner face must have two cells that run it in
/// opposite directions.
struct Faces {
  int border = 0, unmatched = 0, in_patches = 0, missing = 0;
};
Faces faces(const mesh::HexMesh& m) {
  std::map<std::array<Index, 4>, std::vector<std::array<Index, 4>>> all;
  const auto key = [](std::array<Index, 4> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  const auto turned = [](std::array<Index, 4> f) {  // to begin with the least node
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    return f;
  };
  for (Index c = 0; c < m.cell_count(); ++c)
    for (const auto& face : mesh::Hex8::faces) {
      const std::array<Index, 4> f{m.cells(face[0], c), m.cells(face[1], c), m.cells(face[2], c),
                                   m.cells(face[3], c)};
      all[key(f)].push_back(turned(f));
    }
  Faces result;
  std::set<std::array<Index, 4>> border;
  for (auto& [nodes, uses] : all) {
    if (uses.size() == 1) {
      ++result.border, border.insert(uses.front());
    } else {
      auto back = uses[1];
      std::reverse(back.begin() + 1, back.end());
      if (uses.size() != 2 || back != uses[0]) ++result.unmatched;
    }
  }
  for (const auto& p : m.patches)
    for (Eigen::Index q = 0; q < p.faces.cols(); ++q) {
      ++result.in_patches;
      if (border.erase(turned({p.faces(0, q), p.faces(1, q), p.faces(2, q), p.faces(3, q)})) == 0)
        ++result.missing;
    }
  result.missing += static_cast<int>(border.size());
  return result;
}

mesh::QuadSurface border_of(const mesh::HexMesh& m) {
  mesh::QuadSurface s;
  s.nodes = m.nodes;
  for (const auto& p : m.patches) {
    const Eigen::Index before = s.cells.cols();
    s.cells.conservativeResize(4, before + p.faces.cols());
    s.cells.rightCols(p.faces.cols()) = p.faces;
  }
  return s;
}

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
    CHECK(faces(all.mesh).missing == 0);
    CHECK(all.contacts.edges + all.contacts.corners + all.contacts.pinches == 0);

    im.values.assign(24, -1.0F);
    im.values[im.offset({1, 1, 1})] = 1;  // from 0.5 to 2, -0.5 to 0, 2.25 to 3.25
    const auto one = meshing::voxel_hexahedra(im, inside(im));
    REQUIRE(one.mesh.cell_count() == 1);
    CHECK(mesh::volume(one.mesh) == doctest::Approx(1.5 * 0.5 * 1.0).epsilon(1e-14));
    CHECK(one.mesh.patch("wall").faces.cols() == 5);
    CHECK(one.mesh.patch("border y1").faces.cols() == 1);
    CHECK(faces(one.mesh).missing == 0);
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
      CHECK(faces(parted.mesh).unmatched == 0);
      CHECK(faces(parted.mesh).missing == 0);
      CHECK(parted.contacts.edges > 100);
      std::map<std::pair<Index, Index>, int> uses;
      const auto border = border_of(parted.mesh);
      for (Index q = 0; q < border.cell_count(); ++q)
        for (int k = 0; k < 4; ++k) {
          const Index a = border.cells(k, q), b = border.cells((k + 1) % 4, q);
          ++uses[{std::min(a, b), std::max(a, b)}];
        }
      const auto shared = std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second > 2; });
      CHECK(static_cast<std::size_t>(shared) == parted.contacts.left_edges);
      const auto joined = meshing::voxel_hexahedra(im, mask, {.contacts = meshing::VoxelContacts::filled});
      const auto t = test::contours::topology(border_of(joined.mesh));
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
    const Faces f = faces(fill.mesh);
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
    const auto t = test::contours::topology(border_of(fill.mesh));
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
  }
}
