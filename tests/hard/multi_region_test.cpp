// SPDX-License-Identifier: MIT
// Several materials on hard label images: junction curves and points, a vessel with thrombus and wall, noise.
#include "tunica/meshing/multi_region.hpp"

#include "support/label_images.hpp"

#include "tunica/image/phantom.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;
using test::check_conforming;
using test::label_image;

/// Meshes, checks everything that is promised, and prints the figures.
meshing::MultiRegionResult meshed(const std::string& what, const image::Image<int>& g,
                                  const meshing::MultiRegionOptions& options = {}) {
  const std::clock_t start = std::clock();
  auto m = meshing::multi_region(g, options);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  check_conforming(m);
  test::check_manifold(m.interfaces, image::label_regions(g));
  CHECK(meshing::self_intersections(m.interfaces.surface(), 1).empty());
  const auto& r = m.report;
  double material = 0;  // deviation of a whole material
  for (const auto& one : r.materials)
    material = std::max(material, std::abs(one.volume / one.voxel_volume - 1));
  MESSAGE(what, ": ", r.triangles, " triangles (smallest angle ", r.smallest_angle, ", between two ",
          r.smallest_fold, "), ", m.mesh.cell_count(), " tetrahedra, dihedral ", r.min_dihedral, " degrees, ",
          "mean ratio ", r.mean_ratio, "; volumes against voxels: materials ", material, ", regions ",
          r.deviation, "; nudged ", r.nudged, "; ", static_cast<double>(m.mesh.cell_count()) / seconds / 1000,
          " thousand a second");
  return m;
}

/// Noise has no shape to keep, but no tetrahedron of it is flat.
void fills(const std::string& what, const image::Image<int>& g) {
  CHECK(meshed(what, g).report.min_dihedral >= 5);
}

/// The phantom's lumen with a crescent of thrombus in the aorta and a wall of the given thickness [mm].
image::Image<int> vessel(double spacing, double thickness) {
  const image::Phantom phantom;
  const Vec3 lo(200, 95, 5), hi(245, 165, 40);
  std::array<Index, 3> size{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    size[a] = static_cast<Index>((hi[e] - lo[e]) / spacing) + 1;
  }
  auto g = label_image(size, {spacing, spacing, spacing}, [&](const Vec3& from_lo) {
    const Vec3 x = lo + from_lo;
    const double level = phantom.level(x).value;
    if (level > 0) return level > thickness ? 0 : 3;
    const Vec3 centre = phantom.axis(0, x[1]).centre + Vec3(1.5, 0, 1.5);
    return x[1] > 136 && (x - centre).norm() > 5.5 ? 2 : 1;
  });
  for (std::size_t a = 0; a < 3; ++a)
    for (double& c : g.axes[a]) c += lo[static_cast<Eigen::Index>(a)];
  return g;
}

}  // namespace

TEST_SUITE("hard") {
  TEST_CASE("meshing: a sphere cut into wedges keeps its junction curves and the point where they meet") {
    const auto cut = [](auto&& label) {
      return label_image({24, 24, 24}, {1, 1, 1}, [&](const Vec3& x) {
        const Vec3 d = x - Vec3(11.5, 11.5, 11.5);
        return d.norm() > 9.6 ? 0 : label(d);
      });
    };
    for (const auto& [what, g] : std::vector<std::pair<std::string, image::Image<int>>>{
             std::pair{"two halves", cut([](const Vec3& d) { return d[0] + 0.3 * d[1] > 0 ? 1 : 2; })},
             {"four quarters",
              cut([](const Vec3& d) { return 1 + (d[0] + 0.31 * d[1] > 0) + 2 * (d[1] + 0.17 * d[2] > 0); })},
             {"four about a point", cut([](const Vec3& d) {
                const Vec3 c(0.1, 0.2, 0.3);
                const std::array<Vec3, 4> axis{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1),
                                               Vec3(-1, -1, 1)};
                int best = 0;
                for (int i = 1; i < 4; ++i)
                  if ((d - c).dot(axis[static_cast<std::size_t>(i)]) >
                      (d - c).dot(axis[static_cast<std::size_t>(best)]))
                    best = i;
                return 1 + best;
              })}}) {
      const auto m = meshed(what, g);
      CHECK(m.report.min_dihedral >= 12);
      CHECK(m.report.deviation < 1e-9);
    }
  }

  TEST_CASE("meshing: spheres in spheres and their radii") {
    for (const Index n : {16, 32}) {
      const double h = 1.0 / n, middle = 0.5 * (n - 1) * h;
      const auto g = label_image({n, n, n}, {h, h, h}, [&](const Vec3& x) {
        const double r = (x - Vec3(middle, middle, middle)).norm();
        return r < 0.2 ? 1 : r < 0.32 ? 2 : r < 0.42 ? 3 : 0;
      });
      const auto m = meshed("spheres " + std::to_string(n), g, {.names = {{1, "a"}, {2, "b"}, {3, "c"}}});
      CHECK(m.report.min_dihedral >= 12);
      CHECK(m.report.deviation < 1e-9);
      for (const auto& [name, radius] :
           {std::pair<std::string, double>{"a|b", 0.2}, {"b|c", 0.32}, {"c|outside", 0.42}}) {
        double worst = 0, squares = 0;
        const auto& faces = m.mesh.patch(name).faces;
        for (Eigen::Index i = 0; i < faces.size(); ++i) {
          const Vec3 x = m.mesh.nodes.col(faces.data()[i]);
          const double miss = ((x - Vec3(middle, middle, middle)).norm() - radius) / h;
          worst = std::max(worst, std::abs(miss)), squares += miss * miss;
        }
        MESSAGE(name, ": off the sphere by ", std::sqrt(squares / static_cast<double>(faces.size())),
                " voxels (rms), at most ", worst);
        CHECK(worst < 0.5);
      }
    }
  }

  TEST_CASE("meshing: a vessel with thrombus and wall conforms and keeps the voxels' volumes") {
    const auto m =
        meshed("vessel 0.8 mm", vessel(0.8, 2.2), {.names = {{1, "lumen"}, {2, "thrombus"}, {3, "wall"}}});
    CHECK(m.report.min_dihedral >= 12);
    for (const auto& one : m.report.materials)
      CHECK(std::abs(one.volume / one.voxel_volume - 1) < 1e-6);  // islands of a voxel among them
    for (const char* name :
         {"lumen|thrombus", "lumen|wall", "thrombus|wall", "wall|outside", "lumen|border y0"})
      CHECK(m.mesh.patch(name).faces.cols() > 0);
  }

  TEST_CASE("meshing: uneven voxels and other edge lengths are filled as well") {
    const auto tube = [](const Vec3& h) {
      return label_image({14, 14, 9}, h, [&](const Vec3& x) {
        const double r = std::hypot(x[0] / h[0] - 6.5, x[1] / h[1] - 6.5);
        return r < 3 ? 1 : r < 5 ? 2 : 0;
      });
    };
    (void)meshed("slices", tube({1, 1, 3}));
    (void)meshed("thick", tube({1, 1, 0.4}));
    auto g = tube({1, 1, 1});
    for (Index i = 0; i < 14; ++i) g.axes[0][static_cast<std::size_t>(i)] = std::pow(1.1, i) * 5;
    (void)meshed("graded", g);
    (void)meshed("twice the voxel", tube({1, 1, 1}), {.edge = 2});
    (void)meshed("half of it", tube({1, 1, 1}), {.edge = 0.5});
    (void)meshed("as contoured", tube({1, 1, 1}), {.sweeps = 0});
  }

  TEST_CASE("meshing: small images of any labels and voxels are filled") {
    double least = 180;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(seed);
      std::uint64_t drawn = 0;
      const auto draw = [&](std::uint64_t n) {
        return image::splitmix64(7919 * seed + 104729 * drawn++) % n;
      };
      std::array<Index, 3> size{};
      Vec3 h;
      for (std::size_t a = 0; a < 3; ++a) {
        size[a] = 2 + static_cast<Index>(draw(6));
        h[static_cast<Eigen::Index>(a)] = seed % 3 == 0 ? 1 : 0.3 + 0.0025 * static_cast<double>(draw(1000));
      }
      auto g = test::label_noise(size, 2 + static_cast<int>(draw(5)), seed);
      for (std::size_t a = 0; a < 3; ++a)
        for (double& x : g.axes[a]) x = x * h[static_cast<Eigen::Index>(a)] + (seed % 5 == 0 ? 1000.123 : 0);
      const auto m = meshing::multi_region(g, {.edge = seed % 7 == 1 ? 2.0 : seed % 7 == 2 ? 0.5 : 0.0});
      check_conforming(m);
      least = std::min(least, m.report.min_dihedral);
    }
    MESSAGE("least dihedral angle of 20 images: ", least, " degrees");
  }

  TEST_CASE("meshing: noise of labels is filled") {
    fills("noise 12, 3 labels and outside", test::label_noise({12, 12, 12}, 4, 1));
    fills("noise 12, 2 labels and outside", test::label_noise({12, 12, 12}, 3, 2));
  }
}

TEST_SUITE("slow") {
  TEST_CASE("meshing: more noise of labels is filled") {
    for (std::uint64_t seed = 1; seed <= 10; seed += 3)
      for (const int labels : {3, 4}) {
        const auto n = static_cast<Index>(11 + seed);
        fills("noise " + std::to_string(n) + ", labels " + std::to_string(labels) + ", seed " +
                  std::to_string(seed),
              test::label_noise({n, n, n}, labels, seed));
      }
  }
}
