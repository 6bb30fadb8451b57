// SPDX-License-Identifier: MIT
// Least CPU time of marching cubes built for the machine at hand: contour_native VOLUME N capped|open
// VOLUME: N^3 values of float32 on the unit cube; iso-value 0. Prints seconds, vertices, triangles. A program
// of its own: the same templates with other instructions have no place beside those of the goals.
#include "support/stopwatch.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string_view>

namespace {

int run(char** arguments) {
  using namespace tunica;
  const long n = std::strtol(arguments[2], nullptr, 10);
  image::Image<float> image;
  for (auto& axis : image.axes)
    for (long i = 0; i < n; ++i) axis.push_back(static_cast<double>(i) / static_cast<double>(n - 1));
  image.values.resize(static_cast<std::size_t>(n * n * n));
  std::ifstream volume(arguments[1], std::ios::binary);
  volume.read(reinterpret_cast<char*>(image.values.data()),
              static_cast<std::streamsize>(image.values.size() * sizeof(float)));
  if (!volume) {
    std::fprintf(stderr, "error: %s does not hold %ld^3 values\n", arguments[1], n);
    return 1;
  }
  const bool capped = std::string_view(arguments[3]) == "capped";
  const meshing::MarchingCubesOptions options{.border =
                                                  capped ? meshing::Border::capped : meshing::Border::open};
  meshing::Contour contour;
  const double seconds =
      bench::best_cpu_seconds(7, [&] { contour = meshing::marching_cubes(image, 0, options); });
  std::printf("%.9f %d %d\n", seconds, contour.surface.node_count(), contour.surface.cell_count());
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "usage: contour_native VOLUME N capped|open\n");
    return 2;
  }
  try {
    return run(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
