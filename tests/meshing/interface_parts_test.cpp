// SPDX-License-Identifier: MIT
// The parts of meshing several materials, each by the property that the others rely on.
#include "support/label_images.hpp"
#include "tunica/image/labels.hpp"
#include "tunica/mesh/sorted_halves.hpp"
#include "tunica/meshing/editable_interfaces.hpp"
#include "tunica/meshing/interface_nudge.hpp"
#include "tunica/meshing/interface_relax.hpp"
#include "tunica/meshing/interface_remesh.hpp"
#include "tunica/meshing/interface_rings.hpp"
#include "tunica/meshing/interface_volumes.hpp"
#include "tunica/meshing/interfaces.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/label_contour.hpp"
#include "tunica/meshing/number_table.hpp"
#include "tunica/meshing/region_materials.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace tunica;
using namespace tunica::meshing;
namespace parts = meshing::detail;

namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// A ball in a shell that is cut open, on a block that ends at the border: sheets, curves and corners.
image::LabelRegions scene() {
  return image::label_regions(test::label_image({14, 14, 14}, {1, 1, 1}, [](const Vec3& x) {
    const double r = (x - Vec3(6.5, 6.5, 7)).norm();
    return r < 3 ? 1 : r < 5 && x[0] < 8 ? 2 : x[2] < 4 ? 3 : 0;
  }));
}

std::vector<double> targets(const image::LabelRegions& regions) {
  std::vector<double> target;
  for (const auto& r : regions.regions) target.push_back(r.label == 0 && r.at_border ? -1 : r.volume);
  return target;
}

/// Volumes of the labelled regions.
std::vector<double> volumes(const Interfaces& s, const image::LabelRegions& regions) {
  auto v = volumes_of(s, regions.regions.size());
  for (std::size_t r = 0; r < v.size(); ++r)
    if (regions.regions[r].label == 0) v[r] = 0;
  return v;
}

double thinnest(const Interfaces& s) {
  double least = 4;
  for (std::size_t t = 0; t < s.faces.size(); ++t) least = std::min(least, s.triangle(t).smallest_angle());
  return least;
}

bool same(const Interfaces& a, const Interfaces& b) {
  bool equal = a.faces == b.faces && a.sides == b.sides && a.frozen == b.frozen;
  for (std::size_t n = 0; equal && n < a.nodes.size(); ++n)
    equal = a.nodes[n] == b.nodes[n] && a.anchor[n] == b.anchor[n] && a.reach[n] == b.reach[n];
  return equal && a.nodes.size() == b.nodes.size();
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("meshing: keys get numbers in the order in which they are met") {
    NumberTable table;
    std::map<std::uint64_t, Index> known;
    std::mt19937_64 random(3);
    for (int i = 0; i < 60000; ++i) {
      // many small ones, many that differ in their upper bits alone
      const std::uint64_t key = i % 2 == 0 ? random() % 20000 : (random() % 500) << 52U;
      const auto [it, fresh] = known.try_emplace(key, table.count());
      REQUIRE(table.of(key) == it->second);
      REQUIRE(table.count() == static_cast<Index>(known.size()));
    }
  }

  TEST_CASE("mesh: half-edges are sorted by their ends and then by their triangles") {
    std::mt19937 random(4);
    for (const Index nodes : {3, 10, 400}) {
      std::vector<std::array<Index, 3>> triangles(300);
      for (auto& t : triangles) do
          for (Index& n : t) n = static_cast<Index>(random() % static_cast<unsigned>(nodes));
        while (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
      const auto halves =
          mesh::sorted_halves(300, nodes, [&](Index t, Index i) { return triangles[at(t)][at(i)]; });
      REQUIRE(halves.size() == 900);
      std::vector<int> met(900, 0);
      for (std::size_t i = 0; i < halves.size(); ++i) {
        const auto& h = halves[i];
        const Index from = triangles[at(h.triangle)][at(h.corner)];
        const Index to = triangles[at(h.triangle)][at((h.corner + 1) % 3)];
        CHECK(h.a == std::min(from, to));
        CHECK(h.b == std::max(from, to));
        CHECK(h.forward == (from < to));
        ++met[at(3 * h.triangle + h.corner)];
        const auto key = [](const mesh::SortedHalf& g) { return std::tuple(g.a, g.b, g.triangle, g.corner); };
        if (i > 0) CHECK(key(halves[i - 1]) < key(h));
      }
      CHECK(std::count(met.begin(), met.end(), 1) == 900);
    }
    CHECK(mesh::sorted_halves(0, 0, [](Index, Index) { return 0; }).empty());
  }

  TEST_CASE("meshing: edges of interfaces hold each triangle side once and know junctions") {
    for (const std::uint64_t seed : {1U, 2U}) {
      const auto s = label_contour(image::label_regions(test::label_noise({6, 7, 5}, 3, seed)));
      const auto edges = edges_of(s);
      CHECK(edges.triangle.size() == 3 * s.faces.size());
      Index next = 0;
      for (const InterfaceEdge& e : edges.edges) {
        CHECK(e.first == next);
        next = e.last;
        CHECK(e.a < e.b);
        bool one_pair = e.last - e.first == 2;
        for (Index k = e.first; k < e.last; ++k) {
          const auto& f = s.faces[at(edges.triangle[at(k)])];
          CHECK(std::count(f.begin(), f.end(), e.a) + std::count(f.begin(), f.end(), e.b) == 2);
          one_pair =
              one_pair && s.sides[at(edges.triangle[at(k)])] == s.sides[at(edges.triangle[at(e.first)])];
        }
        CHECK(e.junction != one_pair);
      }
      CHECK(next == static_cast<Index>(edges.triangle.size()));
    }
  }

  TEST_CASE("meshing: labels that fill the image have volumes that fill its box") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      auto image = test::label_noise({5, 6, 7}, 4, seed);
      for (int& label : image.values) ++label;
      const auto regions = image::label_regions(image);
      const auto s = label_contour(regions);
      double sum = 0, voxels = 0;
      for (const double v : volumes_of(s, regions.regions.size())) sum += v;
      for (const auto& r : regions.regions) voxels += r.volume;
      CHECK(sum == doctest::Approx(5.0 * 6 * 7).epsilon(1e-12));
      CHECK(voxels == doctest::Approx(5.0 * 6 * 7).epsilon(1e-12));
    }
  }

  TEST_CASE("image: samples become labels or are refused with their place") {
    auto image =
        test::label_image({2, 3, 2}, {1, 2, 3}, [](const Vec3& x) { return static_cast<int>(x[1]); });
    image::Image<float> samples{image.axes, {image.values.begin(), image.values.end()}};
    CHECK(image::as_labels(samples).values ==
          std::vector<std::int32_t>(image.values.begin(), image.values.end()));
    for (const float bad : {-1.0F, 0.5F, 3e9F, std::nanf("")}) {
      samples.values[9] = bad;  // (1, 1, 1)
      CHECK_THROWS_WITH_AS((void)image::as_labels(samples), doctest::Contains("(1, 2, 3)"), InputError);
    }
  }

  TEST_CASE("meshing: edits of interfaces keep regions closed and what is refused leaves no trace") {
    const auto regions = scene();
    const auto start = label_contour(regions);
    EditableInterfaces s(start, 0.7);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    int done = 0, refused = 0;
    for (int i = 0; i < 1500; ++i) {
      const auto t = static_cast<Index>(random() % static_cast<unsigned>(s.triangle_count()));
      if (!s.alive(t)) continue;
      const auto k = static_cast<std::size_t>(random() % 3);
      const Index a = s.nodes(t)[k], b = s.nodes(t)[(k + 1) % 3];
      const int kind = i % 4;
      const bool look = i % 50 < 4;  // at all of it
      const auto before = look ? s.interfaces() : Interfaces{};
      bool ok = false;
      if (kind == 0) ok = s.split(a, b);
      if (kind == 1) ok = s.collapse(a, b, 0.1);
      if (kind == 2) ok = s.flip(a, b);
      if (kind == 3) ok = s.move(a, s.x(a) + Vec3(jitter(random), jitter(random), jitter(random)));
      (ok ? done : refused) += 1;
      if (!look) continue;
      const auto after = s.interfaces();
      if (!ok) {
        CHECK(same(before, after));
      } else if (kind == 0) {  // a node on an edge changes no volume
        const auto v = volumes(before, regions), w = volumes(after, regions);
        for (std::size_t r = 0; r < v.size(); ++r) CHECK(std::abs(v[r] - w[r]) < 1e-11);
        CHECK(after.faces.size() > before.faces.size());
      }
    }
    CHECK(done > 200);
    CHECK(refused > 50);
    MESSAGE(done, " edits done, ", refused, " refused");
    const auto end = s.interfaces();
    test::check_manifold(end, regions);
    CHECK(self_intersections(end.surface()).empty());
    const auto v = volumes(start, regions), w = volumes(end, regions);
    for (std::size_t r = 0; r < v.size(); ++r)
      if (v[r] > 0) CHECK(w[r] > 0);
    // spokes and sides agree with the triangles
    for (Index n = 0; n < s.node_count(); n += 7) {
      if (!s.used(n)) continue;
      Index last = -1;
      for (const auto& spoke : s.spokes(n)) {
        CHECK(spoke.to > last);
        last = spoke.to;
        CHECK(s.sides(n, spoke.to).size() == at(spoke.triangles));
        CHECK(s.sides(spoke.to, n).size() == at(spoke.triangles));
      }
    }
  }

  TEST_CASE("meshing: remeshed interfaces have the edges asked for and no thin triangles") {
    const auto regions = scene();
    const auto start = label_contour(regions);
    for (const double edge : {0.8, 1.4}) {
      const auto s = remeshed(start, edge);
      test::check_manifold(s, regions);
      CHECK(self_intersections(s.surface()).empty());
      double mean = 0, longest = 0, far = 0;  // far: share of the edges longer than two of those asked for
      const auto edges = edges_of(s);
      for (const InterfaceEdge& e : edges.edges) {
        const double l = vec::distance(s.at(e.a), s.at(e.b));
        mean += l / static_cast<double>(edges.edges.size()), longest = std::max(longest, l);
        far += (l > 2 * edge) / static_cast<double>(edges.edges.size());
      }
      MESSAGE("edge ", edge, ": mean ", mean, ", longest ", longest, ", thinnest ", thinnest(s), " rad");
      CHECK(std::abs(mean / edge - 1) < 0.25);
      CHECK(far < 0.01);
      CHECK(thinnest(s) >= thinnest(start));
      for (std::size_t n = 0; n < s.nodes.size(); ++n)  // caps stay in the faces of the box
        for (int a = 0; a < 3; ++a)
          if ((s.frozen[n] >> a & 1) != 0) CHECK((s.nodes[n][a] == -0.5 || s.nodes[n][a] == 13.5));
    }
  }

  TEST_CASE("meshing: volumes of all regions are brought to their targets by one system") {
    const auto regions = scene();
    auto s = label_contour(regions);
    const auto target = targets(regions);
    InterfaceVolumes volume(s, target);
    const std::vector<double> free(s.nodes.size(), 1);
    std::vector<double> error{volume.deviation(s)};
    for (int step = 0; step < 4; ++step) {
      const auto moves = volume.moves(s, free, 0.3);
      for (std::size_t n = 0; n < moves.size(); ++n) {
        CHECK(moves[n].norm() <= 0.3 * (1 + 1e-12));
        for (int a = 0; a < 3; ++a)
          if ((s.frozen[n] >> a & 1) != 0) CHECK(moves[n][a] == 0);
        s.nodes[n] += moves[n];
      }
      error.push_back(volume.deviation(s));
    }
    MESSAGE("deviation ", error[0], ", ", error[1], ", ", error[2], ", ", error[3]);
    CHECK(error[0] > 1e-3);
    CHECK(error[2] < 1e-3 * error[0]);  // Newton's method
    CHECK(error[4] < 1e-12);
    std::vector<double> none(s.nodes.size(), 0);
    for (const Vec3& d : volume.moves(s, none, 0.3)) CHECK(d.norm() == 0);
  }

  TEST_CASE("meshing: relaxed interfaces keep volumes and reach and cross nothing") {
    const auto regions = scene();
    auto s = label_contour(regions);
    const auto start = s;
    const auto report = InterfaceRelax(s).run(12, targets(regions));
    CHECK(report.deviation < 1e-9);
    CHECK(self_intersections(s.surface()).empty());
    test::check_manifold(s, regions);
    double area = 0, before = 0, farthest = 0;
    for (std::size_t t = 0; t < s.faces.size(); ++t)
      area += s.triangle(t).area(), before += start.triangle(t).area();
    for (std::size_t n = 0; n < s.nodes.size(); ++n)
      for (int a = 0; a < 3; ++a) {
        const double off = std::abs(s.nodes[n][a] - s.anchor[n][a]);
        CHECK(off <= s.reach[n][a] + 1e-12);
        if ((s.frozen[n] >> a & 1) != 0) CHECK(off == 0);
        farthest = std::max(farthest, off);
      }
    MESSAGE("area ", before, " -> ", area, ", farthest ", farthest, " voxels");
    CHECK(area < before);
  }

  TEST_CASE("meshing: patches of materials hold each face once and outward of the first") {
    const auto regions = scene();
    const auto s = label_contour(regions);
    const auto materials = parts::materials_of(regions, {{2, "wall"}, {1, "lumen"}});
    REQUIRE(materials.list.size() == 3);
    CHECK(materials.list[0].name == "lumen");
    CHECK(materials.list[1].name == "wall");
    CHECK(materials.list[2].name == "material 3");
    double voxels = 0, wanted = 0;
    for (const auto& m : materials.list) voxels += m.voxel_volume;
    for (const auto& r : regions.regions) wanted += r.label != 0 ? r.volume : 0;
    CHECK(voxels == doctest::Approx(wanted).epsilon(1e-14));
    const auto patches = parts::interface_patches(s, materials.list, materials.of);
    std::size_t faces = 0;
    const Vec3 o(6.5, 6.5, 6.5);
    std::map<std::string, double> flux;  // of x - o, outward of each material: three times its volume
    for (const auto& p : patches) {
      faces += static_cast<std::size_t>(p.faces.cols());
      const auto bar = p.name.find('|');
      for (Eigen::Index f = 0; f < p.faces.cols(); ++f) {
        const mesh::Triangle t{s.at(p.faces(0, f)), s.at(p.faces(1, f)), s.at(p.faces(2, f))};
        const double v = 3 * mesh::cone_volume(t, o);
        flux[p.name.substr(0, bar)] += v, flux[p.name.substr(bar + 1)] -= v;
      }
    }
    CHECK(faces == s.faces.size());
    const auto v = volumes_of(s, regions.regions.size());
    for (std::size_t m = 0; m < 3; ++m) {
      double volume = 0;
      for (std::size_t r = 0; r < v.size(); ++r)
        if (materials.of[r] == static_cast<Index>(m)) volume += v[r];
      CHECK(flux[materials.list[m].name] / 3 == doctest::Approx(volume).epsilon(1e-12));
    }
    const auto surfaces = parts::region_surfaces(s, regions.regions.size());
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
      if (regions.regions[r].label == 0) continue;
      CHECK(mesh::enclosed_volume(surfaces[r].surface) == doctest::Approx(v[r]).epsilon(1e-12));
      for (Index n = 0; n < surfaces[r].surface.node_count(); ++n)
        CHECK(mesh::node(surfaces[r].surface, n) == s.at(surfaces[r].node[at(n)]));
    }
  }

  TEST_CASE("meshing: nudged nodes mend flat tetrahedra and stay in reach of their voxels") {
    const auto regions = scene();
    auto s = label_contour(regions);
    // one tetrahedron on each triangle, ever flatter
    std::vector<Vec3> points = s.nodes;
    Connectivity<4> cells(4, static_cast<Eigen::Index>(s.faces.size()));
    for (std::size_t t = 0; t < s.faces.size(); ++t) {
      const auto f = s.triangle(t);
      const double height = t % 10 == 0 ? 0.02 : 0.7;
      points.push_back(f.centroid() + height * f.area_vector().normalized());
      for (std::size_t k = 0; k < 3; ++k)
        cells(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(t)) = s.faces[t][k];
      cells(3, static_cast<Eigen::Index>(t)) = static_cast<Index>(points.size() - 1);
    }
    const auto flat = [&] {
      int count = 0;
      double worst = 2;
      for (Eigen::Index t = 0; t < cells.cols(); ++t) {
        const auto x = [&](int i) { return points[at(cells(i, t))]; };
        const double q = sine_quality(x(0), x(1), x(2), x(3));
        count += q < std::sin(0.1), worst = std::min(worst, q);
      }
      return std::pair(count, worst);
    };
    const auto before = flat();
    const auto was = points;
    const Index moved = InterfaceNudge(s, 1.0, points, cells).run(0.1 * 180 / 3.141592653589793);
    const auto after = flat();
    MESSAGE(before.first, " flat ones, then ", after.first, "; ", moved, " nodes of interfaces moved");
    CHECK(after.first < before.first / 2);
    CHECK(after.second >= before.second);
    Index changed = 0;
    for (std::size_t n = 0; n < s.nodes.size(); ++n) {
      changed += points[n] != was[n];
      for (int a = 0; a < 3; ++a) {
        CHECK(std::abs(points[n][a] - s.anchor[n][a]) <= s.reach[n][a] + 1e-12);
        CHECK(std::abs(points[n][a] - was[n][a]) <= 0.25 + 1e-12);
        if ((s.frozen[n] >> a & 1) != 0) CHECK(points[n][a] == was[n][a]);
      }
      s.nodes[n] = points[n];
    }
    CHECK(changed == moved);
    CHECK(self_intersections(s.surface()).empty());
  }
}
