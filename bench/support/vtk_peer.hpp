// SPDX-License-Identifier: MIT
// VTK's filters, run beside ours on the same volume in a Python that has them.
#pragma once

#include "support/provenance.hpp"
#include "tunica/image/image.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace tunica::bench {

/// What a filter of VTK made, its least CPU time of several runs, and VTK's version.
struct PeerSurface {
  mesh::Surface surface;
  double cpu = 0;  // [s]
  std::string version;
};

/// Runs bench/peers/surface.py on the values of an image of the unit cube. `steps` are filters in order,
/// the last of which is timed: "flying_edges", "windowed_sinc:20". Nothing where VTK is not there.
[[nodiscard]] inline std::optional<PeerSurface> vtk_surface(const image::Image<float>& image,
                                                            const std::string& steps) {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty()) return std::nullopt;
  std::string folder = (std::filesystem::temp_directory_path() / "tunica_peer_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return std::nullopt;
  const std::filesystem::path scratch = folder;
  std::ofstream(scratch / "volume.raw", std::ios::binary)
      .write(reinterpret_cast<const char*>(image.values.data()),
             static_cast<std::streamsize>(image.values.size() * sizeof(float)));
  std::istringstream reply(output_of(python + " '" TUNICA_SOURCE_DIR "/bench/peers/surface.py' '" + folder +
                                     "' " + std::to_string(image.size(0)) + " " + steps));
  std::optional<PeerSurface> result(std::in_place);
  std::int64_t points = 0, triangles = 0;
  if (reply >> result->version >> result->cpu >> points >> triangles) {
    std::vector<float> x(static_cast<std::size_t>(3 * points));
    std::vector<std::int64_t> cells(static_cast<std::size_t>(3 * triangles));
    std::ifstream(scratch / "points.raw", std::ios::binary)
        .read(reinterpret_cast<char*>(x.data()), static_cast<std::streamsize>(x.size() * sizeof(float)));
    std::ifstream(scratch / "triangles.raw", std::ios::binary)
        .read(reinterpret_cast<char*>(cells.data()),
              static_cast<std::streamsize>(cells.size() * sizeof(std::int64_t)));
    result->surface.nodes = Eigen::Map<Eigen::Matrix3Xf>(x.data(), 3, points).cast<double>();
    result->surface.cells =
        Eigen::Map<Eigen::Matrix<std::int64_t, 3, Eigen::Dynamic>>(cells.data(), 3, triangles).cast<Index>();
  } else {
    result.reset();
  }
  std::filesystem::remove_all(scratch);
  return result;
}

}  // namespace tunica::bench
