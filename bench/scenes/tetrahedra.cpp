// SPDX-License-Identifier: MIT
// Quality against CPU time: tetrahedra in a smoothed bifurcation on finer and finer grids, ours with inner
// edges of 1 and 1.5 of the surface's, and those of the programs that are installed. scene_tetrahedra
// ROWS.csv
#include "tunica/meshing/tetrahedra.hpp"
#include "support/provenance.hpp"
#include "support/stopwatch.hpp"
#include "support/tet_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/smooth.hpp"

#include <cstdio>
#include <fstream>
#include <string>

int main(int count, char** arguments) {
  using namespace tunica;
  if (count != 2) {
    std::fprintf(stderr, "usage: scene_tetrahedra ROWS.csv\n");
    return 2;
  }
  std::ofstream rows(arguments[1]);
  rows << "case,method,triangles,tetrahedra,min_dihedral_deg,below_18,mean_ratio,cpu_s,flags,commit\n";
  const auto row = [&](const std::string& method, Index triangles, double tetrahedra, double dihedral,
                       double below, double ratio, double cpu, const std::string& flags) {
    rows << "bifurcation," << method << ',' << triangles << ',' << tetrahedra << ',' << dihedral << ','
         << below << ',' << ratio << ',' << cpu << ',' << flags << ',' << bench::commit() << '\n';
    std::printf("%-18s %7d triangles %8.0f tetrahedra  dihedral %6.2f  below 18: %.2e  ratio %.3f  %.3f s\n",
                method.c_str(), triangles, tetrahedra, dihedral, below, ratio, cpu);
    std::fflush(stdout);
  };
  for (const Index n : {36, 72, 136, 264}) {
    const auto image = test::sampled<float>(n, [](const Vec3& x) { return -test::bifurcation(x); });
    auto surface = meshing::marching_cubes(image, 0).surface;
    static_cast<void>(meshing::smooth(surface, {.sweeps = 30}));
    for (const double edge : {1.0, 1.5}) {
      meshing::FillReport r;
      const double cpu = bench::best_cpu_seconds(
          n < 200 ? 3 : 1, [&] { r = meshing::tetrahedra(surface, {.lattice_edge = edge}).report; });
      row(edge == 1 ? "ours" : "ours 1.5", surface.cell_count(), r.tetrahedra, r.min_dihedral,
          static_cast<double>(r.below_target) / r.tetrahedra, r.mean_ratio, cpu, bench::flags());
    }
    for (const char* peer : {"tetgen", "gmsh", "hxt", "netgen"})
      if (const auto p = bench::peer_tetrahedra(surface, peer, n < 200 ? 60 : 300))
        row(peer, surface.cell_count(), p->tetrahedra, p->min_dihedral, p->below_18, p->mean_ratio, p->cpu,
            p->version);
  }
  return rows.flush() ? 0 : 1;
}
