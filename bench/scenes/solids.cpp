// SPDX-License-Identifier: MIT
// Error against CPU time: the thick tube of law (17) and Cook's membrane, quasi-incompressible, in every kind
// of cell, and dolfinx's mixed elements where it is installed. scene_solids ROWS.csv [LARGEST TUBE] [LARGEST
// MEMBRANE]
#include "support/provenance.hpp"
#include "support/solid_peer.hpp"
#include "support/solid_scene.hpp"
#include "support/stopwatch.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <string>
#include <type_traits>

namespace {

using namespace tunica;

constexpr int repeats = 2;

struct Measured {
  bench::SolidValue solid;
  double cpu = 0, peak_mb = 0;  // [s]
};

/// Does the work in a process of its own, so that its peak of memory is its own.
template <class Work>
Measured apart(Work&& work) {
  static_assert(std::is_trivially_copyable_v<Measured>);
  Measured result;
  int ends[2];
  if (pipe(ends) != 0) return result;
  const pid_t child = fork();
  if (child == 0) {
    const Measured m = work();
    _exit(write(ends[1], &m, sizeof m) == sizeof m ? 0 : 1);
  }
  close(ends[1]);
  if (child < 0 || read(ends[0], &result, sizeof result) != sizeof result) result = {};
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  return result;
}

struct Rows {
  std::ofstream file;
  bool complete = true;

  void add(const std::string& name, const std::string& method, double h, double dofs, double error,
           double cpu, double peak, const std::string& flags) {
    file << name << ',' << method << ',' << h << ',' << dofs << ',' << error << ',' << cpu << ',' << peak
         << ',' << flags << ',' << bench::commit() << std::endl;
    std::printf("%-16s %-22s h %.3e m  unknowns %7.0f  error %.3e  %.3e s  %5.0f MB", name.c_str(),
                method.c_str(), h, dofs, error, cpu, peak);
  }

  /// One line for each n <= largest: C under the cure of locking that `cured` gives the law.
  template <mesh::Cell C, class Scene, class Cured>
  void ours(const Scene& scene, const std::string& method, std::initializer_list<int> sizes, int largest,
            Cured&& cured) {
    for (const int n : sizes) {
      if (n > largest) continue;
      const Measured m = apart([&] {
        Measured r;
        const auto mesh = scene.template mesh<C>(n);
        const auto material = cured(scene.law());
        r.cpu = bench::best_cpu_seconds(repeats, [&] { r.solid = scene.solve(mesh, material); });
        r.peak_mb = bench::peak_megabytes();
        return r;
      });
      if (!m.solid.converged) {
        std::fprintf(stderr, "error: %s, %s, %d cells: no equilibrium\n", scene.name, method.c_str(), n);
        complete = false;
        continue;
      }
      add(scene.name, method, scene.size(n), m.solid.dofs, scene.error(m.solid.value), m.cpu, m.peak_mb,
          bench::flags());
      std::printf("  %d iterations, %d steps, %d cuts\n", m.solid.iterations, m.solid.steps, m.solid.cuts);
      std::fflush(stdout);
    }
  }

  template <class Scene>
  void peer(const Scene& scene, const std::string& method, const char* element,
            std::initializer_list<int> sizes, int largest) {
    for (const int n : sizes) {
      if (n > largest) continue;
      const auto p = bench::peer_solid(scene.peer, element, n, repeats);
      if (!p) continue;
      add(scene.name, method, scene.size(n), p->dofs, scene.error(p->value), p->cpu, p->peak_mb,
          p->version + " -O3 -march=native");
      std::printf("\n");
      std::fflush(stdout);
    }
  }

  template <class Scene>
  void measure(const Scene& scene, std::initializer_list<int> sizes, std::initializer_list<int> linear,
               int largest) {
    // a pair takes LinearVolume in Hex27 and MeanVolume in the others: Hex20 hold no more
    const auto own = [](const auto& law) { return law; };
    ours<mesh::Hex8>(scene, "Hex8", linear, largest, own);
    ours<mesh::Hex20>(scene, "Hex20", sizes, largest, own);
    ours<mesh::Hex27>(scene, "Hex27", sizes, largest, own);
    ours<mesh::Tet10>(scene, "Tet10", sizes, largest, own);
    ours<mesh::Hex8>(scene, "Hex8 F-bar", linear, largest,
                     [](const auto& law) { return solid::with<solid::FBar>(law); });
    ours<mesh::Tet4>(scene, "Tet4 stabilised", linear, largest,
                     [](const auto& law) { return solid::with<solid::NodalPressure>(law); });
    peer(scene, "dolfinx Q2-Q1", "q2q1", sizes, largest);
    peer(scene, "dolfinx P2-P1", "p2p1", sizes, largest);
  }
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 4) {
    std::fprintf(stderr, "usage: scene_solids ROWS.csv [LARGEST TUBE] [LARGEST MEMBRANE]\n");
    return 2;
  }
  const int tube = count > 2 ? std::atoi(arguments[2]) : 16,
            membrane = count > 3 ? std::atoi(arguments[3]) : 64;
  Rows rows{.file = std::ofstream(arguments[1])};
  rows.file << "case,method,h,dofs,error,cpu_s,peak_MB,flags,commit\n";
  rows.measure(bench::TubeScene{}, {1, 2, 4, 8}, {1, 2, 4, 8, 16}, tube);
  rows.measure(bench::CookScene{}, {4, 8, 16, 32}, {4, 8, 16, 32, 64}, membrane);
  return rows.file.flush() && rows.complete ? 0 : 1;
}
