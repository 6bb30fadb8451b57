// SPDX-License-Identifier: MIT
// Kernel tier: contouring, smoothing, remeshing and filling of generated volumes. What counts for a user is
// the scene tier; these tell where its time goes. The counter `rms_h` is the vertex error in edges of the
// grid.
#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace tunica;

image::Image<float> bifurcation(benchmark::State& state) {
  return test::sampled<float>(static_cast<Index>(state.range(0)),
                              [](const Vec3& x) { return -test::bifurcation(x); });
}

void error_of(benchmark::State& state, const mesh::Surface& surface) {
  state.counters["rms_h"] = test::distance_to_zero(surface.nodes, test::bifurcation).first *
                            static_cast<double>(state.range(0) - 1);
  state.counters["triangles"] = surface.cell_count();
}

void marching_cubes(benchmark::State& state) {
  const auto image = bifurcation(state);
  meshing::Contour contour;
  for (auto _ : state) benchmark::DoNotOptimize(contour = meshing::marching_cubes(image, 0));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(image.values.size()));
  error_of(state, contour.surface);
}
BENCHMARK(marching_cubes)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

void marching_cubes_noise(benchmark::State& state) {
  const auto image = test::noise_volume(64);
  for (auto _ : state) benchmark::DoNotOptimize(meshing::marching_cubes(image, 0));
}
BENCHMARK(marching_cubes_noise)->Unit(benchmark::kMillisecond);

void smooth_20_sweeps(benchmark::State& state) {
  const auto raw = meshing::marching_cubes(bifurcation(state), 0).surface;
  mesh::Surface surface;
  for (auto _ : state) {
    surface = raw;
    benchmark::DoNotOptimize(meshing::smooth(surface, {.sweeps = 20}));
  }
  state.SetItemsProcessed(state.iterations() * 20 * raw.node_count());
  error_of(state, surface);
}
BENCHMARK(smooth_20_sweeps)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);

/// The smoothed bifurcation with triangles of one and a half edges of the grid.
meshing::Remeshed remeshed(const mesh::Surface& smooth, benchmark::State& state) {
  return meshing::remesh(smooth, {.edge = 1.5 / static_cast<double>(state.range(0) - 1)});
}

mesh::Surface smoothed(benchmark::State& state) {
  auto surface = meshing::marching_cubes(bifurcation(state), 0).surface;
  (void)meshing::smooth(surface, {.sweeps = 20});
  return surface;
}

void remesh(benchmark::State& state) {
  const auto surface = smoothed(state);
  mesh::Surface result;
  for (auto _ : state) benchmark::DoNotOptimize(result = remeshed(surface, state).surface);
  state.SetItemsProcessed(state.iterations() * result.cell_count());
  error_of(state, result);
}
BENCHMARK(remesh)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

void fill(benchmark::State& state) {
  const auto surface = remeshed(smoothed(state), state).surface;
  meshing::FillReport report;
  for (auto _ : state) benchmark::DoNotOptimize(report = meshing::tetrahedra(surface).report);
  state.SetItemsProcessed(state.iterations() * report.tetrahedra);
  state.counters["tetrahedra"] = report.tetrahedra;
  state.counters["min_dihedral"] = report.min_dihedral;
  state.counters["volume_error"] = report.volume_error;
}
BENCHMARK(fill)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
