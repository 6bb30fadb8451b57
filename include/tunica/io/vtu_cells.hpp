// SPDX-License-Identifier: MIT
// Vectors of cells from a VTU file: an array of its cell data by name, as text, base64 or raw appended bytes.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/io/cursor.hpp"
#include "tunica/io/read_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace tunica::io {

namespace detail {

/// The value of name="..." in the text of an element; empty without it.
[[nodiscard]] inline std::string_view attribute(std::string_view element, std::string_view name) {
  for (std::size_t at = element.find(name); at != std::string_view::npos; at = element.find(name, at + 1)) {
    const std::size_t open = at + name.size();
    if (at == 0 || (element[at - 1] != ' ' && element[at - 1] != '\n' && element[at - 1] != '\t')) continue;
    if (element.substr(open, 2) != "=\"") continue;
    const std::size_t close = element.find('"', open + 2);
    if (close != std::string_view::npos) return element.substr(open + 2, close - open - 2);
  }
  return {};
}

/// Bytes of base64, of one or more parts each with its padding; fails on anything else that is not space.
[[nodiscard]] inline std::string from_base64(const Cursor& cursor, std::string_view text) {
  std::string out;
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint32_t bits = 0;
  int count = 0;  // digits of a group of four
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (c == '=') {
      count = 0;
      continue;
    }
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos)
      cursor.fail(cursor.offset(), "a byte that is not base64: " + in_quotes(std::string_view(&c, 1)));
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (count > 0) out += static_cast<char>(bits >> (6 - 2 * count) & 255);
    count = (count + 1) % 4;
  }
  return out;
}

template <class T>
[[nodiscard]] T little_endian(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace detail

/// The three components of the cell array `name`, a column a cell, as they are in the file (nan as well).
/// Float32 and Float64, little-endian and not compressed. InputError names what is missing or of another
/// kind.
[[nodiscard]] inline Points<3> read_vtu_cell_vectors(const std::filesystem::path& path,
                                                     const std::string& name) {
  using detail::attribute;
  const std::string bytes = read_file(path), file = path.string();
  const std::string_view all(bytes);
  const std::size_t data_at = all.find("<AppendedData"), open = all.find("<CellData"),
                    close = all.find("</CellData>");
  const std::string_view head = all.substr(0, std::min(all.find("<UnstructuredGrid"), all.size()));
  if (head.size() == all.size()) throw InputError(file, "VTKFile", "no UnstructuredGrid");
  const auto refuse = [&](const std::string& place, const std::string& found) {
    throw InputError(file, place, found);
  };
  if (!attribute(head, "compressor").empty())
    refuse("compressor", "compressed arrays; write the file without a compressor");
  if (attribute(head, "byte_order") == "BigEndian") refuse("byte_order", "BigEndian; LittleEndian is read");
  const std::size_t header = attribute(head, "header_type") == "UInt64" ? 8 : 4;
  if (open == std::string_view::npos || close == std::string_view::npos || close < open)
    refuse("CellData", "nothing; it should hold \"" + name + "\"");

  std::string known;
  std::string_view element, content;
  for (std::size_t at = all.find("<DataArray", open); at < close; at = all.find("<DataArray", at + 1)) {
    const std::size_t end = all.find('>', at);
    if (end == std::string_view::npos) break;
    const std::string_view e = all.substr(at, end - at);
    const std::string found(attribute(e, "Name"));
    if (found == name) {
      element = e;
      content = all.substr(end + 1, std::min(all.find('<', end), all.size()) - end - 1);
      break;
    }
    known += (known.empty() ? "" : ", ") + found;
  }
  const std::string place = "CellData \"" + name + "\"";
  if (element.empty()) refuse("CellData", "no \"" + name + "\"; there are: " + known);
  if (attribute(element, "NumberOfComponents") != "3")
    refuse(place,
           "NumberOfComponents " + in_quotes(attribute(element, "NumberOfComponents")) + ", expected 3");

  const std::size_t piece_at = std::min(all.find("<Piece"), all.size());
  const std::string_view piece = all.substr(piece_at, all.find('>', piece_at) - piece_at),
                         format = attribute(element, "format"), type = attribute(element, "type");
  const Cursor cursor(file, all);
  const auto cells = cursor.number_of<std::uint32_t>(attribute(piece, "NumberOfCells"), "NumberOfCells");
  if (cells > static_cast<std::uint32_t>(std::numeric_limits<Index>::max())) refuse(place, "too many cells");
  const std::size_t size = type == "Float64"   ? 8
                           : type == "Float32" ? 4
                                               : 0,
                    numbers = 3 * std::size_t{cells};
  if (size == 0) refuse(place, "type " + in_quotes(type) + ", expected Float64 or Float32");

  Points<3> out(3, static_cast<Eigen::Index>(cells));
  if (format == "ascii") {
    Cursor words(file + " " + place, content);
    for (std::size_t k = 0; k < numbers; ++k) out.data()[k] = words.number<double>("a component of a vector");
    if (!words.at_end()) refuse(place, "more numbers than 3 for each of " + std::to_string(cells) + " cells");
    return out;
  }
  std::string decoded;
  std::string_view block;
  if (format == "binary") {
    // The header is encoded by itself or with the data: both give the same bytes, as its padding is passed.
    decoded = detail::from_base64(cursor, content);
    block = decoded;
  } else if (format == "appended" && data_at != std::string_view::npos) {
    const std::size_t tag = all.find('>', data_at), from = all.find('_', tag);
    if (tag == std::string_view::npos || from == std::string_view::npos ||
        attribute(all.substr(data_at, tag - data_at), "encoding") != "raw")
      refuse("AppendedData", "an encoding other than raw");
    const auto offset =
        cursor.number_of<std::uint64_t>(attribute(element, "offset"), "the offset of the array");
    if (offset > all.size() - from - 1) refuse(place, "an offset behind the end of the file");
    block = all.substr(from + 1 + offset);
  } else {
    refuse(place, "format " + in_quotes(format) + ", expected ascii, binary or appended");
  }
  if (block.size() < header) refuse(place, "the end of the file");
  const std::uint64_t length = header == 8 ? detail::little_endian<std::uint64_t>(block, 0)
                                           : detail::little_endian<std::uint32_t>(block, 0);
  if (length != numbers * size || block.size() - header < length)
    refuse(place, std::to_string(std::min<std::uint64_t>(length, block.size() - header)) +
                      " bytes, expected " + std::to_string(numbers * size));
  for (std::size_t k = 0; k < numbers; ++k)
    out.data()[k] = size == 8 ? detail::little_endian<double>(block, header + 8 * k)
                              : static_cast<double>(detail::little_endian<float>(block, header + 4 * k));
  return out;
}

}  // namespace tunica::io
