// SPDX-License-Identifier: MIT
// Compression of VTK XML files by zlib: the only header that needs that library (target tunica::zlib).
#pragma once

#include "tunica/core/error.hpp"

#include <zlib.h>

#include <string>
#include <string_view>

namespace tunica::io {

/// Pass it as the compressor of write_vtu or write_vtp.
struct Zlib {
  static constexpr std::string_view vtk_name = "vtkZLibDataCompressor";
  int level = 4;  // 1 fast .. 9 small

  [[nodiscard]] std::string compress(std::string_view bytes) const {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  static_cast<uLong>(bytes.size()), level) != Z_OK)
      throw InputError("zlib: level " + std::to_string(level) + " is not 0 to 9, or there is no memory");
    out.resize(size);
    return out;
  }
};

}  // namespace tunica::io
