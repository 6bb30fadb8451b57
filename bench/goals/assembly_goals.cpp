// SPDX-License-Identifier: MIT
// Assembly: linear tetrahedra against dolfinx in the same run, hexahedra into block rows, block rows times
// vectors.
#include "goals/goal.hpp"
#include "support/assembly_time.hpp"
#include "support/provenance.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>

#ifndef TUNICA_ASSEMBLY_NATIVE
#define TUNICA_ASSEMBLY_NATIVE ""
#endif

namespace tunica::bench {
namespace {

/// Of the program built for the machine at hand; nothing where it is not there.
std::optional<AssemblyTime> native() {
  const std::string program = TUNICA_ASSEMBLY_NATIVE;
  if (program.empty()) return std::nullopt;
  std::istringstream reply(output_of("'" + program + "'"));
  AssemblyTime t;
  if (!(reply >> t.laplacian >> t.convection >> t.off >> t.scatter >> t.scatter_upper >> t.product >>
        t.product_upper >> t.scalar))
    return std::nullopt;
  return t;
}

struct Peer {
  std::string version;
  double laplacian = 0, convection = 0;  // [M tetrahedra/s]
};

/// dolfinx on as many tetrahedra, its kernels at -O3 -march=native -ffast-math; nothing where it is not
/// there.
std::optional<Peer> dolfinx() {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty()) return std::nullopt;
  std::istringstream reply(output_of(python + " '" TUNICA_SOURCE_DIR "/bench/peers/assembly.py' " +
                                     std::to_string(assembly_side) + " 2>/dev/null"));
  std::string name;
  Peer p;
  double laplacian = 0, convection = 0;
  if (!(reply >> name >> p.version >> laplacian >> convection)) return std::nullopt;
  const double cells = 6e-6 * assembly_side * assembly_side * assembly_side;
  p.laplacian = cells / laplacian, p.convection = cells / convection;
  return p;
}

constexpr double wanted_ratio = 10, wanted_error = 1e-14, wanted_scatter = 1.0;

/// rate: built for the machine at hand where that is there, plain: built as this program is.
Goal tetrahedra(const std::string& name, double rate, double plain, double off,
                const std::optional<Peer>& peer, double peer_rate) {
  Goal goal{.name = "assembly: " + name,
            .measured = text("%.1f M tetrahedra/s, entries off by %.0e (%.1f M/s at -O2)", rate, off, plain),
            .target = text(">= %.0f x dolfinx, entries within %.0e", wanted_ratio, wanted_error),
            .ratio = "-",
            .outcome = Outcome::unmatched};
  if (peer) {
    goal.ratio = text("%.1f x, at -O2 %.1f x (dolfinx %s: %.2f M/s)", rate / peer_rate, plain / peer_rate,
                      peer->version.c_str(), peer_rate);
    goal.outcome = reached_if(rate >= wanted_ratio * peer_rate && off <= wanted_error);
  }
  return goal;
}

}  // namespace

std::vector<Goal> assembly_goals() {
  const auto peer = dolfinx();
  const AssemblyTime plain = assembly_time();
  const auto built = native();
  const AssemblyTime t = built ? *built : plain;
  const double off = std::max(t.off, plain.off);
  return {tetrahedra("P1 Laplacian", t.laplacian, plain.laplacian, off, peer, peer ? peer->laplacian : 0),
          tetrahedra("P1 convection-diffusion", t.convection, plain.convection, off, peer,
                     peer ? peer->convection : 0),
          {.name = "assembly: Hex8 into 3x3 blocks",
           .measured = text("%.2f M hexahedra/s, %.2f of the upper triangle (%.2f, %.2f at -O2)", t.scatter,
                            t.scatter_upper, plain.scatter, plain.scatter_upper),
           .target = text(">= %.1f M/s without the kernel", wanted_scatter),
           .ratio = "-",
           .outcome = reached_if(t.scatter >= wanted_scatter)},
          {.name = "assembly: 3x3 blocks times a vector",
           .measured = text("%.1f M unknowns/s, %.1f by the upper triangle (%.1f, %.1f at -O2)", t.product,
                            t.product_upper, plain.product, plain.product_upper),
           .target = "faster than scalar rows",
           .ratio = text("%.2f x, at -O2 %.2f x (Eigen's rows: %.1f M/s)", t.product / t.scalar,
                         plain.product / plain.scalar, t.scalar),
           .outcome = reached_if(t.product >= t.scalar && plain.product >= plain.scalar)}};
}

}  // namespace tunica::bench
