// SPDX-License-Identifier: MIT
// Fills the surface of an OFF file and leaves the tetrahedra as TetGen does, in BASE.1.node and BASE.1.ele,
// for tetrahedra.py to judge them like those of a peer. Prints the CPU seconds and the peak memory [MB] of
// the filling. fill_off SURFACE.off BASE
#include "support/off.hpp"
#include "support/stopwatch.hpp"
#include "tunica/core/error.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <cstdio>
#include <string>

namespace {

using namespace tunica;

[[nodiscard]] bool write(const std::string& base, const mesh::TetMesh& m) {
  std::FILE* nodes = std::fopen((base + ".1.node").c_str(), "w");
  std::FILE* cells = std::fopen((base + ".1.ele").c_str(), "w");
  if (nodes == nullptr || cells == nullptr) return false;
  std::fprintf(nodes, "%d 3 0 0\n", m.node_count());
  for (Index n = 0; n < m.node_count(); ++n)
    std::fprintf(nodes, "%d %.17g %.17g %.17g\n", n, m.nodes(0, n), m.nodes(1, n), m.nodes(2, n));
  std::fprintf(cells, "%d 4 0\n", m.cell_count());
  for (Index t = 0; t < m.cell_count(); ++t)
    std::fprintf(cells, "%d %d %d %d %d\n", t, m.cells(0, t), m.cells(1, t), m.cells(2, t), m.cells(3, t));
  const bool whole = std::fclose(nodes) == 0;
  return std::fclose(cells) == 0 && whole;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: fill_off SURFACE.off BASE\n");
    return 2;
  }
  const auto surface = bench::read_off(arguments[1]);
  const double start = bench::cpu_seconds(), idle = bench::peak_megabytes();
  try {
    const auto filled = meshing::tetrahedra(surface).mesh;
    std::printf("seconds %.6g\npeak %.1f\n", bench::cpu_seconds() - start, bench::peak_megabytes() - idle);
    return write(arguments[2], filled) ? 0 : 1;
  } catch (const MeshError& e) {
    std::fprintf(stderr, "refused: %s\n", e.what());
    return 1;
  }
}
