// SPDX-License-Identifier: MIT
// Writer of volume meshes as VTU files with point and cell arrays.
#pragma once

#include "tunica/io/vtk_xml.hpp"
#include "tunica/mesh/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tunica::io {

struct VtuData {
  Arrays points{};  // one tuple a node
  Arrays cells{};   // one tuple a cell; "region" is added when the mesh has regions
};

/// Writes the mesh atomically, coordinates as they are (the solvers' are in [m]). InputError if an
/// array has the wrong length or the file cannot be written.
template <class Cell, int Dim, class Compressor = Raw>
void write_vtu(const std::filesystem::path& path, const mesh::Mesh<Cell, Dim>& mesh, const VtuData& data = {},
               const Compressor& compressor = {}) {
  const auto n = static_cast<std::size_t>(mesh.node_count()), m = static_cast<std::size_t>(mesh.cell_count());
  Points<3> nodes = Points<3>::Zero(3, mesh.nodes.cols());  // VTK knows no plane points
  nodes.template topRows<Dim>() = mesh.nodes;
  std::vector<std::int64_t> offsets(m);
  for (std::size_t i = 0; i < m; ++i) offsets[i] = static_cast<std::int64_t>(i + 1) * Cell::nodes;
  const std::vector<std::uint8_t> types(m, static_cast<std::uint8_t>(Cell::vtk_type));

  detail::XmlWriter xml("UnstructuredGrid", compressor);
  xml.line("<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfCells=\"" + std::to_string(m) +
           "\">");
  xml.section(path, "PointData", data.points, n);
  Arrays cells = data.cells;
  if (!mesh.region.empty()) cells.emplace_back("region", mesh.region);
  xml.section(path, "CellData", cells, m);
  xml.line("<Points>");
  xml.array({"Points", nodes});
  xml.line("</Points>\n<Cells>");
  xml.array({"connectivity", mesh.cells.data(), 1, static_cast<std::size_t>(mesh.cells.size())});
  xml.array({"offsets", offsets});
  xml.array({"types", types});
  xml.line("</Cells>\n</Piece>");
  xml.write(path);
}

}  // namespace tunica::io
