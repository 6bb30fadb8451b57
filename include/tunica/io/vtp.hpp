// SPDX-License-Identifier: MIT
// Writer of surfaces of triangles or quadrilaterals as VTP files with the cell array `patch`.
#pragma once

#include "tunica/io/vtk_xml.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tunica::io {

struct VtpData {
  Arrays points{};  // one tuple a node
  Arrays cells{};   // one tuple a face; "patch" (0 wall, then the others in their order) is added
};

/// Writes the surface atomically; the cell array `patch` holds its regions, 0 when it has none.
/// InputError if an array has the wrong length or the file cannot be written.
template <class Face, class Compressor = Raw>
void write_vtp(const std::filesystem::path& path, const mesh::Mesh<Face, 3>& surface,
               const VtpData& data = {}, const Compressor& compressor = {}) {
  static_assert(Face::dim == 2, "a VTP file holds a surface: Mesh<Tri3, 3> or Mesh<Quad4, 3>");
  const auto n = static_cast<std::size_t>(surface.node_count()),
             m = static_cast<std::size_t>(surface.cell_count());
  std::vector<std::int64_t> offsets(m);
  for (std::size_t i = 0; i < m; ++i) offsets[i] = static_cast<std::int64_t>(i + 1) * Face::nodes;
  std::vector<Index> patch = surface.region;
  if (patch.empty()) patch.assign(m, 0);

  detail::XmlWriter xml("PolyData", compressor);
  xml.line("<Piece NumberOfPoints=\"" + std::to_string(n) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
           std::to_string(m) + "\">");
  xml.section(path, "PointData", data.points, n);
  Arrays cells = data.cells;
  cells.emplace_back("patch", patch);
  xml.section(path, "CellData", cells, m);
  xml.line("<Points>");
  xml.array({"Points", surface.nodes});
  xml.line("</Points>\n<Polys>");
  xml.array({"connectivity", surface.cells.data(), 1, static_cast<std::size_t>(surface.cells.size())});
  xml.array({"offsets", offsets});
  xml.line("</Polys>\n</Piece>");
  xml.write(path);
}

}  // namespace tunica::io
