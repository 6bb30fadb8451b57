// SPDX-License-Identifier: MIT
// Writer of images as VTK legacy files, binary: STRUCTURED_POINTS, or RECTILINEAR_GRID if uneven.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/io/atomic_file.hpp"
#include "tunica/io/vtk_types.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::io {

struct VtkImageWriteOptions {
  std::string title = "tunica image";  // one line, at most 255 characters
  std::string array = "scalars";       // a name without spaces
};

namespace detail {

/// The shortest spacing that gives the coordinates back, to the bit if there is one and else to
/// 1e-12 of the extent; none if the axis is uneven.
[[nodiscard]] inline std::optional<double> even_spacing(const std::vector<double>& axis) {
  if (axis.size() < 2) return 1.0;
  const double extent = axis.back() - axis.front(), h = extent / static_cast<double>(axis.size() - 1);
  const auto misfit = [&](double spacing) {
    double worst = 0;
    for (std::size_t i = 0; i < axis.size(); ++i)
      worst = std::max(worst, std::abs(axis.front() + static_cast<double>(i) * spacing - axis[i]));
    return worst;
  };
  if (!(misfit(h) <= 1e-12 * extent)) return std::nullopt;
  for (int digits = 1; digits <= 17; ++digits) {
    std::array<char, 40> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), h, std::chars_format::general, digits);
    double rounded = 0;
    std::from_chars(text.data(), end.ptr, rounded);
    if (misfit(rounded) == 0) return rounded;
  }
  return h;
}

template <class T>
void append_big_endian(std::string& out, const std::vector<T>& values) {
  const std::size_t at = out.size();
  out.resize(at + values.size() * sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T v = swapped_if_little(values[i]);
    std::memcpy(out.data() + at + i * sizeof(T), &v, sizeof(T));
  }
}

}  // namespace detail

/// Writes the image atomically, samples in their own type. InputError if it cannot be written.
template <class T>
void write_vtk_image(const std::filesystem::path& path, const image::Image<T>& image,
                     const VtkImageWriteOptions& options = {}) {
  const auto triple = [](const char* key, const auto& v) {
    return std::string(key) + " " + number_text(v[0]) + " " + number_text(v[1]) + " " + number_text(v[2]) +
           "\n";
  };
  std::array<double, 3> size{}, origin{}, spacing{};
  bool even = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (image.axes[a].empty()) throw InputError(path.string() + ": the image has no voxels");
    const auto h = detail::even_spacing(image.axes[a]);
    size[a] = static_cast<double>(image.axes[a].size()), origin[a] = image.axes[a].front();
    even = even && h;
    spacing[a] = h.value_or(0);
  }
  std::string out = "# vtk DataFile Version 3.0\n" + options.title + "\nBINARY\nDATASET ";
  out += even ? "STRUCTURED_POINTS\n" : "RECTILINEAR_GRID\n";
  out += triple("DIMENSIONS", size);
  if (even) {
    out += triple("SPACING", spacing) + triple("ORIGIN", origin);
  } else {
    for (std::size_t a = 0; a < 3; ++a) {
      out += std::string(1, "XYZ"[a]) + "_COORDINATES " + std::to_string(image.axes[a].size()) + " double\n";
      detail::append_big_endian(out, image.axes[a]);
      out += "\n";
    }
  }
  out += "POINT_DATA " + std::to_string(image.values.size()) + "\nSCALARS " + options.array + " " +
         std::string(legacy_name(scalar_type_of<T>())) + " 1\nLOOKUP_TABLE default\n";
  detail::append_big_endian(out, image.values);
  out += "\n";
  write_file(path, out);
}

}  // namespace tunica::io
