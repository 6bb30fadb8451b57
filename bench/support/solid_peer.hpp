// SPDX-License-Identifier: MIT
// The same solids solved with dolfinx, run beside ours: bench/peers/solid.py.
#pragma once

#include "support/provenance.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace tunica::bench {

struct PeerSolid {
  std::string version;
  double dofs = 0, value = 0;  // the value measured: see the script
  double cpu = std::numeric_limits<double>::infinity(), peak_mb = 0;
};

/// name: "tube" or "cook-i"; method: "q2q1", "p2p1". The least time of `repeats` runs. Nothing where dolfinx
/// is not there or found no equilibrium.
[[nodiscard]] inline std::optional<PeerSolid> peer_solid(const std::string& name, const std::string& method,
                                                         int n, int repeats) {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty()) return std::nullopt;
  PeerSolid least;
  for (int k = 0; k < repeats; ++k) {
    std::istringstream reply(output_of("OMP_NUM_THREADS=1 " + python +
                                       " '" TUNICA_SOURCE_DIR "/bench/peers/solid.py' " + name + " " +
                                       method + " " + std::to_string(n) + " 2>/dev/null"));
    PeerSolid r;
    int steps = 0;
    if (!(reply >> r.dofs >> r.value >> r.cpu >> r.peak_mb >> steps >> r.version)) return std::nullopt;
    r.cpu = std::min(r.cpu, least.cpu);
    least = r;
  }
  return least;
}

}  // namespace tunica::bench
