// SPDX-License-Identifier: MIT
// Error against CPU time: the isosurface of a bifurcation on finer and finer grids by both contourers and by
// VTK. Three errors a surface: rms and largest distance of its vertices from the true surface, and its
// volume. scene_isosurface ROWS.csv
#include "support/provenance.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/measures.hpp"
#include "tunica/meshing/contour_triangles.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

namespace {

using namespace tunica;

image::Image<float> bifurcation(Index n) {
  return test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
}

/// Volume of the surface of n^3 samples with its vertices moved onto the true surface, by Newton's method.
double projected_volume(Index n) {
  auto surface = meshing::marching_cubes(bifurcation(n), 0).surface;
  constexpr double d = 1e-6;
  for (Index node = 0; node < surface.node_count(); ++node)
    for (int it = 0; it < 3; ++it) {
      const Vec3 x = surface.nodes.col(node);
      Vec3 g;
      for (int a = 0; a < 3; ++a)
        g[a] =
            (test::bifurcation(x + d * Vec3::Unit(a)) - test::bifurcation(x - d * Vec3::Unit(a))) / (2 * d);
      surface.nodes.col(node) -= test::bifurcation(x) / g.squaredNorm() * g;
    }
  return mesh::enclosed_volume(surface);
}

/// What the projected volumes tend to, their error falling with the square of the edge of the grid.
double true_volume() {
  constexpr Index coarse = 192, fine = 384;
  const double ratio = std::pow((fine - 1.0) / (coarse - 1.0), 2);
  return (ratio * projected_volume(fine) - projected_volume(coarse)) / (ratio - 1);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: scene_isosurface ROWS.csv\n");
    return 2;
  }
  std::ofstream rows(arguments[1]);
  rows << "case,method,h,dofs,error,cpu_s,peak_MB,flags,commit\n";
  const double volume = true_volume();
  std::printf("volume %.9f\n", volume);
  const auto add = [&](const char* method, double h, const mesh::Surface& surface, double cpu, double peak,
                       const std::string& flags) {
    const auto [rms, most] = test::distance_to_zero(surface.nodes, test::bifurcation);
    const double lost = std::abs(std::abs(mesh::enclosed_volume(surface)) / volume - 1);
    const auto row = [&](const char* what, double error) {
      rows << "bifurcation " << what << ',' << method << ',' << h << ',' << surface.node_count() << ','
           << error << ',' << cpu << ',' << peak << ',' << flags << ',' << bench::commit() << '\n';
    };
    row("rms", rms), row("max", most), row("volume", lost);
    std::printf("%-18s h %.5f  vertices %7d  rms %.3e  max %.3e  volume %.3e  %.3e s\n", method, h,
                surface.node_count(), rms, most, lost, cpu);
  };
  for (const Index n : {32, 64, 128, 256, 512}) {
    const double h = 1.0 / (n - 1);
    const auto image = bifurcation(n);
    meshing::Contour contour;
    const double marching = bench::best_cpu_seconds(7, [&] { contour = meshing::marching_cubes(image, 0); });
    add("marching cubes", h, contour.surface, marching, bench::peak_megabytes(), bench::flags());
    const double dual =
        bench::best_cpu_seconds(5, [&] { contour = meshing::dual_contour_image(image, {}, 0); });
    add("dual contouring", h, contour.surface, dual, bench::peak_megabytes(), bench::flags());
    // The memory of the peer's process is not ours to measure: 0.
    if (const auto peer = bench::vtk_surface(image, "flying_edges"))
      add("vtkFlyingEdges3D", h, peer->surface, peer->cpu, 0, peer->version);
  }
  return rows.flush() ? 0 : 1;
}
