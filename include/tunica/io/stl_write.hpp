// SPDX-License-Identifier: MIT
// Writer of binary STL surfaces.
#pragma once

#include "tunica/io/atomic_file.hpp"
#include "tunica/mesh/measures.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

namespace tunica::io {

/// Writes the triangles atomically, in single precision as the format has it. InputError if a
/// coordinate is not finite in it or the file cannot be written.
inline void write_stl(const std::filesystem::path& path, const mesh::Surface& surface) {
  std::string out = "binary STL by tunica";  // must not begin with "solid"
  out.resize(80, ' ');
  const auto append = [&](auto v) {
    const std::size_t at = out.size();
    out.resize(at + sizeof v);
    std::memcpy(out.data() + at, &v, sizeof v);
  };
  append(static_cast<std::uint32_t>(surface.cell_count()));
  for (Index t = 0; t < surface.cell_count(); ++t) {
    const mesh::Triangle f = mesh::triangle(surface, t);
    const Vec3 normal = f.area_vector().stableNormalized();
    for (const Vec3& v : {normal, f.a, f.b, f.c})
      for (int i = 0; i < 3; ++i) {
        const auto x = static_cast<float>(v[i]);
        if (!std::isfinite(x))
          throw InputError(path.string(), "facet " + std::to_string(t),
                           "a number that is not finite in single precision");
        append(x);
      }
    append(std::uint16_t{0});
  }
  write_file(path, out);
}

}  // namespace tunica::io
