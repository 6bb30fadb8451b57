// SPDX-License-Identifier: MIT
// Kernel tier: the octree over the triangles of a contour, built and asked for nearest points. The queries
// are exact; `error` holds the largest difference to brute force over a sample of them.
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/search/octree.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace tunica;

struct Scene {
  mesh::Surface surface =
      meshing::marching_cubes(test::sampled<float>(128, [](const Vec3& x) { return -test::bifurcation(x); }),
                              0)
          .surface;
  std::vector<Box> boxes;

  Scene() {
    for (Index t = 0; t < surface.cell_count(); ++t) boxes.push_back(mesh::triangle(surface, t).box());
  }
  [[nodiscard]] double squared_distance(const Vec3& x, Index t) const {
    const mesh::Triangle triangle = mesh::triangle(surface, t);
    return (triangle.at(triangle.nearest(x)) - x).squaredNorm();
  }
};

Vec3 query(std::uint64_t i) {
  return Vec3(test::noise(3 * i + 1), test::noise(3 * i + 2), test::noise(3 * i + 3)) * 0.5 +
         Vec3::Constant(0.5);
}

void octree_build(benchmark::State& state) {
  const Scene scene;
  for (auto _ : state) benchmark::DoNotOptimize(search::Octree(scene.boxes));
  state.SetItemsProcessed(state.iterations() * scene.surface.cell_count());
}
BENCHMARK(octree_build)->Unit(benchmark::kMillisecond);

void octree_nearest(benchmark::State& state) {
  const Scene scene;
  const search::Octree tree(scene.boxes);
  const auto nearest = [&](const Vec3& x) {
    return tree.nearest(x, [&](Index t) { return scene.squared_distance(x, t); });
  };
  std::uint64_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(nearest(query(i++)));
  state.SetItemsProcessed(state.iterations());
  double error = 0;
  for (std::uint64_t k = 0; k < 20; ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < scene.surface.cell_count(); ++t)
      least = std::min(least, scene.squared_distance(query(k), t));
    error = std::max(error, std::abs(nearest(query(k)).squared_distance - least));
  }
  state.counters["error"] = error;
}
BENCHMARK(octree_nearest);

}  // namespace
