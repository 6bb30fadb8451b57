// SPDX-License-Identifier: MIT
// Strict reader of STL surfaces, text and binary, with equal points welded.
#pragma once

#include "tunica/io/cursor.hpp"
#include "tunica/io/read_file.hpp"
#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::io {

enum class StlFormat { ascii, binary };

struct [[nodiscard]] StlFile {
  mesh::Surface surface;  // unit of the file; nodes in the order of their first facet
  StlFormat format = StlFormat::binary;
  Index facets = 0;     // in the file
  Index collapsed = 0;  // of them, those with two equal corners: left out of the surface
};

namespace detail {

inline constexpr std::size_t stl_head = 84, stl_record = 50;  // [bytes]

[[nodiscard]] inline std::uint32_t stl_count(std::string_view bytes) {
  std::uint32_t n = 0;
  std::memcpy(&n, bytes.data() + 80, sizeof n);
  return n;
}

[[nodiscard]] inline bool stl_is_binary(std::string_view bytes) {
  if (bytes.size() >= stl_head && (bytes.size() - stl_head) / stl_record == stl_count(bytes) &&
      (bytes.size() - stl_head) % stl_record == 0)
    return true;  // by size first: a binary head may begin with "solid"
  const auto start = bytes.substr(0, 512);
  return upper(start.substr(0, 5)) != "SOLID" || start.find('\0') != std::string_view::npos;
}

/// Corners of the facets, three columns each.
[[nodiscard]] inline Points<3> stl_binary(const std::string& name, std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
  if (bytes.size() < stl_head)
    throw InputError(name + ": neither text nor binary STL: " + std::to_string(bytes.size()) +
                     " bytes, starting " + in_quotes(bytes.substr(0, 16)));
  const std::size_t n = stl_count(bytes), body = bytes.size() - stl_head;
  if (body / stl_record != n || body % stl_record != 0)
    throw InputError(name, "byte 80",
                     "the header says " + std::to_string(n) + " facets, the file holds " +
                         std::to_string(body / stl_record) + " whole ones and " +
                         std::to_string(body % stl_record) + " stray bytes");
  Points<3> corners(3, static_cast<Eigen::Index>(3 * n));
  for (std::size_t f = 0; f < n; ++f) {
    std::array<float, 12> values;  // normal, three corners
    std::memcpy(values.data(), bytes.data() + stl_head + f * stl_record, sizeof values);
    for (std::size_t i = 3; i < 12; ++i) {
      if (!std::isfinite(values[i]))
        throw InputError(name, "facet " + std::to_string(f), "a corner that is not finite");
      corners(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(3 * f + i / 3 - 1)) =
          static_cast<double>(values[i]);
    }
  }
  return corners;
}

[[nodiscard]] inline Points<3> stl_ascii(const std::string& name, std::string_view bytes) {
  Cursor at(name, bytes);
  const auto expect = [&](std::string_view word) {
    const auto found = at.word();
    if (upper(found) != word)
      at.fail("expected \"" + std::string(word) + "\", found " +
              (found.empty() ? "the end of the file" : in_quotes(found)));
  };
  std::vector<double> corners;
  while (!at.at_end()) {
    expect("SOLID");
    (void)at.line();  // its name
    for (;;) {
      const auto word = at.word();
      const std::string key = upper(word);
      if (key == "ENDSOLID") break;
      if (key != "FACET")
        at.fail("expected facet or endsolid, found " +
                (word.empty() ? "the end of the file" : in_quotes(word)));
      expect("NORMAL");
      for (int i = 0; i < 3; ++i)
        (void)at.number<double>("a number of the normal");  // not used: may be anything
      expect("OUTER"), expect("LOOP");
      for (int v = 0; v < 3; ++v) {
        expect("VERTEX");
        for (int i = 0; i < 3; ++i) {
          corners.push_back(at.number<double>("a coordinate"));
          if (!std::isfinite(corners.back())) at.fail("a coordinate that is not finite");
        }
      }
      expect("ENDLOOP"), expect("ENDFACET");
    }
    (void)at.line();
  }
  return Eigen::Map<const Points<3>>(corners.data(), 3, static_cast<Eigen::Index>(corners.size() / 3));
}

/// Equal columns become one node; nodes are numbered by their first column.
inline void weld(const Points<3>& corners, StlFile& out) {
  const auto n = static_cast<Index>(corners.cols());
  std::vector<Index> order(static_cast<std::size_t>(n)), node(order.size(), -1), first(order.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto less = [&](Index a, Index b) {
    const double *p = corners.data() + 3 * a, *q = corners.data() + 3 * b;
    for (int i = 0; i < 3; ++i)
      if (p[i] != q[i]) return p[i] < q[i];
    return a < b;
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && corners.col(order[i]) == corners.col(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  Index nodes = 0;
  for (std::size_t i = 0; i < node.size(); ++i)
    node[i] = first[i] == static_cast<Index>(i) ? nodes++ : node[static_cast<std::size_t>(first[i])];
  mesh::Surface& s = out.surface;
  s.nodes.resize(3, nodes);
  for (std::size_t i = 0; i < node.size(); ++i) s.nodes.col(node[i]) = corners.col(static_cast<Index>(i));
  s.cells.resize(3, n / 3);
  Index kept = 0;
  for (Index f = 0; f < n / 3; ++f) {
    const Index a = node[static_cast<std::size_t>(3 * f)], b = node[static_cast<std::size_t>(3 * f + 1)],
                c = node[static_cast<std::size_t>(3 * f + 2)];
    if (a == b || b == c || c == a) continue;
    s.cells.col(kept++) << a, b, c;
  }
  s.cells.conservativeResize(3, kept);
  out.facets = n / 3, out.collapsed = out.facets - kept;
  s.region_names = {"wall"};
}

}  // namespace detail

/// The surface in the bytes of an STL file; `name` stands for it in messages. InputError names line or
/// facet and what was found; a file that is cut short or holds no facet is refused.
[[nodiscard]] inline StlFile parse_stl(const std::string& name, std::string_view bytes) {
  if (bytes.empty()) throw InputError(name + ": file is empty");
  StlFile out;
  out.format = detail::stl_is_binary(bytes) ? StlFormat::binary : StlFormat::ascii;
  if (bytes.size() / detail::stl_record > std::numeric_limits<Index>::max() / 3)
    throw InputError(name + ": more facets than an index can number");
  const Points<3> corners =
      out.format == StlFormat::binary ? detail::stl_binary(name, bytes) : detail::stl_ascii(name, bytes);
  if (corners.cols() == 0) throw InputError(name + ": 0 facets");
  detail::weld(corners, out);
  return out;
}

[[nodiscard]] inline StlFile read_stl(const std::filesystem::path& path) {
  return parse_stl(path.string(), read_file(path));
}

}  // namespace tunica::io
