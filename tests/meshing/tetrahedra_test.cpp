// SPDX-License-Identifier: MIT
// Filling closed surfaces: validity by exact signs, the surface kept, volumes, patches, refusals.
#include "tunica/meshing/tetrahedra.hpp"

#include "support/shared.hpp"
#include "support/surfaces.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace tunica;
using meshing::FillReport;
using meshing::tetrahedra;

std::array<Index, 3> sorted(std::array<Index, 3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Everything that the filler promises, counted anew from the mesh alone.
void check_filling(const mesh::Surface& s, const mesh::TetMesh& m) {
  REQUIRE(m.node_count() >= s.node_count());
  CHECK(m.nodes.leftCols(s.node_count()) == s.nodes);
  std::map<std::array<Index, 3>, std::array<Index, 3>> open;  // faces seen once, as they turn
  std::set<Index> used;
  long double volume = 0;  // equal terms in double would all round to one side
  int inverted = 0, thrice = 0;
  std::set<std::array<Index, 3>> closed;
  for (Index t = 0; t < m.cell_count(); ++t) {
    const auto n = m.cells.col(t);
    const Vec3 a = m.nodes.col(n[0]), b = m.nodes.col(n[1]), c = m.nodes.col(n[2]), d = m.nodes.col(n[3]);
    inverted += !(meshing::orient3d(a, b, c, d) > 0);
    volume += (b - a).cross(c - a).dot(d - a) / 6;
    for (const Index node : n) used.insert(node);
    for (const auto& f : mesh::Tet4::faces) {
      const std::array<Index, 3> face{n[f[0]], n[f[1]], n[f[2]]}, key = sorted(face);
      thrice += closed.count(key) > 0;
      const auto it = open.find(key);
      if (it == open.end()) {
        open.emplace(key, face);
      } else {
        open.erase(it);
        closed.insert(key);
      }
    }
  }
  CHECK(inverted == 0);
  CHECK(thrice == 0);
  CHECK(static_cast<Index>(used.size()) == m.node_count());
  CHECK(static_cast<Index>(open.size()) == s.cell_count());
  int lost = 0;
  long double bounded = 0;
  for (Index t = 0; t < s.cell_count(); ++t) {
    const std::array<Index, 3> tri{s.cells(0, t), s.cells(1, t), s.cells(2, t)};
    const auto it = open.find(sorted(tri));
    if (it == open.end()) {
      ++lost;
      continue;
    }
    std::array<Index, 3> turned = it->second;  // the same sense: outward
    while (turned[0] != tri[0]) std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    lost += turned != tri;
    const Vec3 a = s.nodes.col(tri[0]), b = s.nodes.col(tri[1]), c = s.nodes.col(tri[2]);
    bounded += (a - s.nodes.col(0)).cross(b - s.nodes.col(0)).dot(c - s.nodes.col(0)) / 6;
  }
  CHECK(lost == 0);
  CHECK(static_cast<double>(std::abs(volume / bounded - 1)) < 1e-12);
  Eigen::Index patched = 0;
  for (const auto& p : m.patches) patched += p.faces.cols();
  CHECK(patched == s.cells.cols());
}

FillReport fill(const std::string& name, const mesh::Surface& s) {
  const auto result = tetrahedra(s);
  const FillReport& r = result.report;
  MESSAGE(name << ": " << s.cell_count() << " triangles, " << r.tetrahedra << " tetrahedra, dihedral "
               << r.min_dihedral << " .. " << r.max_dihedral << ", mean ratio " << r.mean_ratio
               << ", volume error " << r.volume_error << "; surface: angle " << r.surface_min_angle
               << ", dihedral " << r.surface_min_dihedral << "; missing faces " << r.missing_faces
               << ", points through the surface " << r.steiner);
  CHECK(r.volume_error < 1e-12);
  CHECK(r.tetrahedra == result.mesh.cell_count());
  check_filling(s, result.mesh);
  return r;
}

std::string refusal(const mesh::Surface& s) {
  try {
    static_cast<void>(tetrahedra(s));
  } catch (const MeshError& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

/// Binary STL with equal corners welded; flip turns every facet.
mesh::Surface stl(const std::filesystem::path& path, bool flip) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  std::map<std::array<float, 3>, Index> known;
  test::SurfaceBuilder b;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<Index, 3> t{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), bytes.data() + 84 + 50 * i + 12 + 12 * k, 12);
      const auto it = known.find(p);
      t[k] = it != known.end() ? it->second : known[p] = b.node(Vec3(p[0], p[1], p[2]));
    }
    if (flip) std::swap(t[0], t[1]);
    b.triangles.push_back(t);
  }
  return b.surface();
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: tetrahedra fill smooth surfaces") {
    fill("sphere 320", test::icosphere(2));
    fill("sphere 5120", test::icosphere(4));
    fill("torus", test::torus(24, 80));
    fill("tube", test::tube_surface(24, 48, 4));
    fill("cube of 12", test::box_surface(0));
    fill("cube of 768", test::box_surface(3));
  }

  TEST_CASE("meshing: tetrahedra fill several parts and cavities") {
    fill("two spheres", test::joined(test::icosphere(3), test::icosphere(3, 1, Vec3(2.01, 0, 0))));
    const auto shell = test::joined(test::icosphere(3), test::reversed(test::icosphere(3, 0.6)));
    const FillReport r = fill("sphere with a cavity", shell);
    CHECK(r.volume == doctest::Approx(4.0 / 3 * std::numbers::pi * (1 - 0.216)).epsilon(0.03));
    const auto island = test::joined(shell, test::icosphere(2, 0.3));
    fill("sphere in a cavity", island);
  }

  TEST_CASE("meshing: tetrahedra keep the patches of the surface") {
    const auto s = test::tube_surface(20, 30, 3);
    const auto m = tetrahedra(s).mesh;
    REQUIRE(m.patches.size() == 3);
    CHECK(m.patches[0].name == "wall");
    CHECK(m.patches[2].name == "outlet");
    CHECK(m.patch("inlet").faces.cols() == 20 * 5);
    for (Eigen::Index f = 0; f < m.patches[2].faces.cols(); ++f)
      for (int i = 0; i < 3; ++i) CHECK(m.nodes(2, m.patches[2].faces(i, f)) == 4.0);
  }

  TEST_CASE("meshing: tetrahedra honour a size field") {
    const auto s = test::icosphere(4);  // edges of about 0.075
    const auto fine = tetrahedra(s, {}, [](const Vec3&) { return 0.075; });
    const auto coarse = tetrahedra(s, {}, [](const Vec3& x) { return 0.075 + 0.3 * (1 - x.norm()); });
    check_filling(s, coarse.mesh);
    CHECK(coarse.report.tetrahedra < 0.6 * fine.report.tetrahedra);
    const auto edge_near_centre = [](const mesh::TetMesh& m) {
      double sum = 0;
      int count = 0;
      for (Index t = 0; t < m.cell_count(); ++t)
        for (const auto& [i, j] : mesh::Tet4::edges) {
          const Vec3 a = m.nodes.col(m.cells(i, t)), b = m.nodes.col(m.cells(j, t));
          if (a.norm() < 0.4 && b.norm() < 0.4) sum += (a - b).norm(), ++count;
        }
      return sum / count;
    };
    MESSAGE("edge near the centre: asked 0.075, got " << edge_near_centre(fine.mesh) << "; asked 0.3, got "
                                                      << edge_near_centre(coarse.mesh));
    CHECK(edge_near_centre(coarse.mesh) > 2 * edge_near_centre(fine.mesh));
  }

  TEST_CASE("meshing: tetrahedra inside are as large as the triangles of the surface") {
    // A regular tetrahedron has the volume edge^3 / (6 sqrt(2)).
    for (const auto& s : {test::icosphere(4), test::torus(24, 80), test::tube_surface(24, 48, 6)}) {
      double edge = 0;
      for (Index t = 0; t < s.cell_count(); ++t)
        for (int i = 0; i < 3; ++i)
          edge += (s.nodes.col(s.cells(i, t)) - s.nodes.col(s.cells((i + 1) % 3, t))).norm();
      edge /= 3.0 * s.cell_count();
      const FillReport r = tetrahedra(s).report;
      const double ratio = std::cbrt(6 * std::numbers::sqrt2 * r.volume / r.tetrahedra) / edge;
      MESSAGE("edge of the regular tetrahedron of the mean volume over the edge of the surface: " << ratio);
      CHECK(ratio > 0.9);
      CHECK(ratio < 1.1);
    }
  }

  TEST_CASE("meshing: tetrahedra have the same bits every time") {
    const auto s = test::torus(16, 48);
    const auto a = tetrahedra(s).mesh, b = tetrahedra(s).mesh;
    CHECK(a.nodes == b.nodes);
    CHECK(a.cells == b.cells);
  }

  TEST_CASE("meshing: tetrahedra refuse bad surfaces by name") {
    const auto good = test::icosphere(2);
    CHECK(contains(refusal(test::reversed(good)), "inward"));
    auto open = good;
    open.cells.conservativeResize(3, good.cells.cols() - 1);
    CHECK(contains(refusal(open), "open"));
    auto turned = good;
    std::swap(turned.cells(0, 5), turned.cells(1, 5));
    CHECK(contains(refusal(turned), "sense"));
    CHECK(contains(refusal(test::joined(good, good)), "coincide"));
    CHECK(
        contains(refusal(test::joined(good, test::icosphere(2, 1, Vec3(0.7, 0.1, 0.2)))), "crosses itself"));
    CHECK(contains(refusal(test::joined(good, test::icosphere(2, 0.4))), "disagree"));
    auto loose = good;
    loose.nodes.conservativeResize(3, good.nodes.cols() + 1);
    loose.nodes.rightCols<1>().setZero();
    CHECK(contains(refusal(loose), "belongs to no triangle"));
    auto flat = test::box_surface(1);
    flat.nodes.col(flat.cells(2, 7)) =
        0.5 * (flat.nodes.col(flat.cells(0, 7)) + flat.nodes.col(flat.cells(1, 7)));
    CHECK(contains(refusal(flat), "no area"));
    auto pressed = test::box_surface(1);  // closed, all in one plane
    pressed.nodes.row(2) = 0.25 * pressed.nodes.row(0);
    CHECK_FALSE(refusal(pressed).empty());
    auto level = good;
    level.nodes.row(2).setZero();
    CHECK_FALSE(refusal(level).empty());
    const meshing::FrontSurface round(good.nodes, good.cells);
    for (int k = 0; k < 3; ++k) {
      std::vector<Vec3> turned_over;
      for (Index n = 0; n < level.node_count(); ++n)
        turned_over.push_back({level.nodes((k + 1) % 3, n), level.nodes((k + 2) % 3, n), level.nodes(k, n)});
      const auto stretch = meshing::detail::along_axes(round, turned_over);
      const auto i = static_cast<std::size_t>((4 - k) % 3);
      CHECK(stretch.to[i] == Vec3(Vec3::Unit((4 - k) % 3)));  // across the plane
      CHECK(meshing::detail::in_all_directions(round, turned_over).even);
    }
    std::vector<Vec3> thin;
    for (Index n = 0; n < good.node_count(); ++n)
      thin.push_back({good.nodes(0, n), good.nodes(1, n) / 8, good.nodes(2, n) / 1024});
    const auto stretch = meshing::detail::along_axes(round, thin);
    for (int k = 0; k < 3; ++k)
      CHECK(stretch.to[static_cast<std::size_t>(k)][k] ==
            std::array{1.0, 8.0, 1024.0}[static_cast<std::size_t>(k)]);
    // However it lies: there and back again, and a turned thin sphere has edges of one length after it.
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& x : thin) x = turn * x;
    const auto all = meshing::detail::in_all_directions(round, thin);
    CHECK_FALSE(all.even);
    const auto there = meshing::detail::mapped(thin, all.to), back = meshing::detail::mapped(there, all.back);
    for (std::size_t n = 0; n < thin.size(); ++n) CHECK((back[n] - thin[n]).norm() < 1e-12);
    const auto again = meshing::detail::in_all_directions(round, there);
    CHECK(again.even);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(again.to[k][static_cast<int>(k)] == doctest::Approx(1).epsilon(1e-6));
    auto nan = good;
    nan.nodes(1, 3) = std::nan("");
    CHECK(contains(refusal(nan), "not finite"));
    mesh::Surface none;
    CHECK(contains(refusal(none), "no triangles"));
    auto fold = good;  // one node pushed through the other side
    fold.nodes.col(0) *= -1.5;
    CHECK(contains(refusal(fold), "crosses itself"));
  }
}

TEST_SUITE("hard") {
  TEST_CASE("meshing: tetrahedra fill the real lumen as its facets are") {
    const auto path = test::shared("data/lumen_iso1299.5_clipped.stl");
    if (!path) return;
    const FillReport r = fill("lumen", stl(*path, false));
    CHECK(r.volume == doctest::Approx(10154.17).epsilon(1e-6));
    CHECK(r.surface_min_angle < 0.02);
  }

  TEST_CASE("meshing: tetrahedra fill the level set surface once it is turned") {
    const auto path = test::shared("data/vmtk_levelset_surface.stl");
    if (!path) return;
    CHECK(contains(refusal(stl(*path, false)), "inward"));
    const FillReport r = fill("level set", stl(*path, true));
    CHECK(r.volume == doctest::Approx(13184.27).epsilon(1e-6));
  }
}
