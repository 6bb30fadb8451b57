// SPDX-License-Identifier: MIT
// Surfaces as OFF files, which other programs read: every digit of the nodes is kept.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace tunica::bench {

/// False where the file cannot be written.
[[nodiscard]] inline bool write_off(const std::filesystem::path& path, const mesh::Surface& s) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  std::fprintf(file, "OFF\n%d %d 0\n", s.node_count(), s.cell_count());
  for (Index n = 0; n < s.node_count(); ++n)
    std::fprintf(file, "%.17g %.17g %.17g\n", s.nodes(0, n), s.nodes(1, n), s.nodes(2, n));
  for (Index t = 0; t < s.cell_count(); ++t)
    std::fprintf(file, "3 %d %d %d\n", s.cells(0, t), s.cells(1, t), s.cells(2, t));
  return std::fclose(file) == 0;
}

/// What write_off has written, without its regions; no triangle where the file is not whole.
[[nodiscard]] inline mesh::Surface read_off(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string word;
  Index nodes = 0, triangles = 0, corners = 0;
  mesh::Surface s;
  if (!(file >> word >> nodes >> triangles >> corners) || word != "OFF" || nodes < 0 || triangles < 0)
    return s;
  s.nodes.resize(3, nodes), s.cells.resize(3, triangles);
  for (Index n = 0; n < nodes; ++n) file >> s.nodes(0, n) >> s.nodes(1, n) >> s.nodes(2, n);
  for (Index t = 0; t < triangles; ++t) file >> corners >> s.cells(0, t) >> s.cells(1, t) >> s.cells(2, t);
  s.region.assign(static_cast<std::size_t>(triangles), 0), s.region_names = {"wall"};
  return file ? s : mesh::Surface{};
}

}  // namespace tunica::bench
