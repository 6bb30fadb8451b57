// SPDX-License-Identifier: MIT
// Writer of polylines as VTP files: centre lines with what is known at their points and of each line.
#pragma once

#include "tunica/io/vtp.hpp"
#include "tunica/mesh/adjacency.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tunica::io {

/// Writes polylines atomically: row l of `lines` holds the points (columns) of line l. InputError if an array
/// has the wrong length or the file cannot be written.
template <class Compressor = Raw>
void write_vtp_lines(const std::filesystem::path& path, const Points<3>& points, const mesh::Rows& lines,
                     const VtpData& data = {}, const Compressor& compressor = {}) {
  const auto n = static_cast<std::size_t>(points.cols()), m = static_cast<std::size_t>(lines.size());
  const std::vector<std::int64_t> offsets(lines.offset.begin() + 1, lines.offset.end());
  detail::XmlWriter xml("PolyData", compressor);
  xml.line("<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
           std::to_string(m) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">");
  xml.section(path, "PointData", data.points, n);
  xml.section(path, "CellData", data.cells, m);
  xml.line("<Points>");
  xml.array({"Points", points});
  xml.line("</Points>\n<Lines>");
  xml.array({"connectivity", lines.item});
  xml.array({"offsets", offsets});
  xml.line("</Lines>\n</Piece>");
  xml.write(path);
}

}  // namespace tunica::io
