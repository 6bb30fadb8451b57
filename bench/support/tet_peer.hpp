// SPDX-License-Identifier: MIT
// Tetrahedra of other programs in the same surface, run beside ours: bench/peers/tetrahedra.py.
#pragma once

#include "support/off.hpp"
#include "support/provenance.hpp"
#include "tunica/mesh/mesh.hpp"

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

namespace tunica::bench {

struct PeerTetrahedra {
  std::string version;
  double cpu = 0, tetrahedra = 0, min_dihedral = 0, below_18 = 0, mean_ratio = 0,
         peak_mb = 0;  // [s], [degrees]
};

/// peer: "tetgen", "gmsh", "hxt", "netgen". Nothing where it is not there or did not fill the surface.
[[nodiscard]] inline std::optional<PeerTetrahedra> peer_tetrahedra(const mesh::Surface& s,
                                                                   const std::string& peer,
                                                                   int limit_seconds) {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty()) return std::nullopt;
  std::string folder = (std::filesystem::temp_directory_path() / "tunica_peer_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return std::nullopt;
  const std::string path = folder + "/surface.off";
  if (!write_off(path, s)) return std::nullopt;
  std::istringstream reply(output_of(python + " '" TUNICA_SOURCE_DIR "/bench/peers/tetrahedra.py' '" + path +
                                     "' " + peer + " " + std::to_string(limit_seconds)));
  std::filesystem::remove_all(folder);
  PeerTetrahedra r;
  std::string outcome;
  if (!(reply >> r.version >> outcome) || outcome != "ok") return std::nullopt;
  reply >> r.cpu >> r.tetrahedra >> r.min_dihedral >> r.below_18 >> r.mean_ratio >> r.peak_mb;
  return r;
}

}  // namespace tunica::bench
