// SPDX-License-Identifier: MIT
// Tetrahedra of other programs in the same surface, run beside ours: bench/peers/tetrahedra.py.
#pragma once

#include "support/provenance.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cstdio>
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
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return std::nullopt;
  std::fprintf(file, "OFF\n%d %d 0\n", s.node_count(), s.cell_count());
  for (Index n = 0; n < s.node_count(); ++n)
    std::fprintf(file, "%.17g %.17g %.17g\n", s.nodes(0, n), s.nodes(1, n), s.nodes(2, n));
  for (Index t = 0; t < s.cell_count(); ++t)
    std::fprintf(file, "3 %d %d %d\n", s.cells(0, t), s.cells(1, t), s.cells(2, t));
  std::fclose(file);
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
