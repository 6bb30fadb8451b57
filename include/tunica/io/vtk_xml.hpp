// SPDX-License-Identifier: MIT
// VTK XML files with raw appended data, little-endian, 64-bit headers; the same bytes for the same data.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/io/atomic_file.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::io {

static_assert(std::endian::native == std::endian::little,
              "VTK XML files are written on little-endian machines only");

/// Name of a number type in VTK's XML.
template <class T>
[[nodiscard]] constexpr std::string_view xml_type() {
  static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>, "an array of a VTK file holds numbers");
  if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? "Float32" : "Float64";
  constexpr bool is_signed = std::is_signed_v<T>;
  switch (sizeof(T)) {
    case 1: return is_signed ? "Int8" : "UInt8";
    case 2: return is_signed ? "Int16" : "UInt16";
    case 4: return is_signed ? "Int32" : "UInt32";
    default: return is_signed ? "Int64" : "UInt64";
  }
}

/// A named array of a file, one tuple a point or cell. It refers to the data, which must outlive it:
///   Array{"pressure", p} (a vector), Array{"velocity", u} (3 x n: one column a tuple).
struct Array {
  std::string name;
  std::string_view type;  // in VTK's XML
  std::size_t components = 1, tuples = 0;
  std::string_view bytes;

  template <class T>
  Array(std::string n, const std::vector<T>& values) : Array(std::move(n), values.data(), 1, values.size()) {}
  template <class Derived>
  Array(std::string n, const Eigen::PlainObjectBase<Derived>& m)
      : Array(std::move(n), m.data(), vector<Derived> ? 1 : static_cast<std::size_t>(m.rows()),
              static_cast<std::size_t>(vector<Derived> ? m.size() : m.cols())) {
    static_assert(vector<Derived> || !(Derived::Flags & Eigen::RowMajorBit),
                  "one column a tuple: column-major");
  }
  template <class T>
  Array(std::string n, const T* values, std::size_t components_, std::size_t tuples_)
      : name(std::move(n)),
        type(xml_type<T>()),
        components(components_),
        tuples(tuples_),
        bytes(reinterpret_cast<const char*>(values), components_ * tuples_ * sizeof(T)) {}
  Array(std::string, std::vector<bool>&&) = delete;

 private:
  template <class Derived>
  static constexpr bool vector = Derived::RowsAtCompileTime == 1 ||
                                 (Derived::ColsAtCompileTime == 1 &&
                                  Derived::RowsAtCompileTime == Eigen::Dynamic);
};

using Arrays = std::vector<Array>;

/// No compression: the size of the data, then the data. io::Zlib is the other model.
struct Raw {
  static constexpr std::string_view vtk_name = "";
};

namespace detail {

[[nodiscard]] inline std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

inline void append_u64(std::string& out, std::uint64_t v) {
  const std::size_t at = out.size();
  out.resize(at + sizeof v);
  std::memcpy(out.data() + at, &v, sizeof v);
}

/// The head of a block of appended data and, when it is compressed, the blocks themselves.
template <class Compressor>
[[nodiscard]] std::string packed(const Compressor& compressor, std::string_view bytes) {
  std::string head;
  if constexpr (std::is_same_v<Compressor, Raw>) {
    (void)compressor;
    append_u64(head, bytes.size());
    return head;
  } else {
    constexpr std::size_t block = 1u << 15;
    const std::size_t blocks = (bytes.size() + block - 1) / block;
    append_u64(head, blocks);
    append_u64(head, block);
    append_u64(head, bytes.size() % block);  // size of the last block when it is not full
    std::string body;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::string small = compressor.compress(bytes.substr(b * block, block));
      append_u64(head, small.size());
      body += small;
    }
    return head + body;
  }
}

/// Collects the elements of a file, whose arrays follow at its end.
template <class Compressor>
class XmlWriter {
 public:
  XmlWriter(std::string_view kind, const Compressor& compressor) : kind_(kind), compressor_(compressor) {
    head_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind_ +
            "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"";
    if (!Compressor::vtk_name.empty()) head_ += " compressor=\"" + std::string(Compressor::vtk_name) + "\"";
    head_ += ">\n<" + kind_ + ">\n";
  }

  void line(const std::string& text) { head_ += text + "\n"; }

  void array(const Array& a) {
    head_ += "<DataArray type=\"" + std::string(a.type) + "\" Name=\"" + xml_text(a.name) +
             "\" NumberOfComponents=\"" + std::to_string(a.components) + "\" format=\"appended\" offset=\"" +
             std::to_string(offset_) + "\"/>\n";
    packs_.push_back(packed(compressor_, a.bytes));
    const bool raw = std::is_same_v<Compressor, Raw>;
    bytes_.push_back(raw ? a.bytes : std::string_view{});
    offset_ += packs_.back().size() + bytes_.back().size();
  }

  /// <PointData> or <CellData>; InputError unless every array has `tuples` tuples.
  void section(const std::filesystem::path& path, const std::string& name, const Arrays& arrays,
               std::size_t tuples) {
    line("<" + name + ">");
    for (const Array& a : arrays) {
      if (a.tuples != tuples)
        throw InputError(path.string(), name + " \"" + a.name + "\"",
                         std::to_string(a.tuples) + " tuples, " + std::to_string(tuples) + " expected");
      array(a);
    }
    line("</" + name + ">");
  }

  void write(const std::filesystem::path& path) const {
    AtomicFile file(path);
    file.write(head_ + "</" + kind_ + ">\n<AppendedData encoding=\"raw\">\n_");
    for (std::size_t i = 0; i < packs_.size(); ++i) {
      file.write(packs_[i]);
      file.write(bytes_[i]);
    }
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
  }

 private:
  std::string kind_, head_;
  const Compressor& compressor_;
  std::vector<std::string> packs_;
  std::vector<std::string_view> bytes_;
  std::size_t offset_ = 0;
};

}  // namespace detail
}  // namespace tunica::io
