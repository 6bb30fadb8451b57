// SPDX-License-Identifier: MIT
// Error against CPU time: the isosurface of a bifurcation on finer and finer grids, ours and VTK's.
// scene_isosurface ROWS.csv
#include "support/provenance.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <cstdio>
#include <fstream>

int main(int count, char** arguments) {
  using namespace tunica;
  if (count != 2) {
    std::fprintf(stderr, "usage: scene_isosurface ROWS.csv\n");
    return 2;
  }
  std::ofstream rows(arguments[1]);
  rows << "case,method,h,dofs,error,cpu_s,peak_MB,flags,commit\n";
  const auto row = [&](const char* method, double h, const mesh::Surface& surface, double cpu, double peak,
                       const std::string& flags) {
    const double error = test::distance_to_zero(surface.nodes, test::bifurcation).first;
    rows << "bifurcation," << method << ',' << h << ',' << surface.node_count() << ',' << error << ',' << cpu
         << ',' << peak << ',' << flags << ',' << bench::commit() << '\n';
    std::printf("%-22s h %.5f  vertices %7d  rms error %.3e  %.3e s\n", method, h, surface.node_count(),
                error, cpu);
  };
  for (const Index n : {32, 64, 128, 256}) {
    const double h = 1.0 / (n - 1);
    const auto image = test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
    meshing::Contour contour;
    const double cpu = bench::best_cpu_seconds(5, [&] { contour = meshing::marching_cubes(image, 0); });
    row("marching cubes", h, contour.surface, cpu, bench::peak_megabytes(), bench::flags());
    // The memory of the peer's process is not ours to measure: 0.
    if (const auto peer = bench::vtk_surface(image, "flying_edges"))
      row("vtkFlyingEdges3D", h, peer->surface, peer->cpu, 0, peer->version);
  }
  return rows.flush() ? 0 : 1;
}
