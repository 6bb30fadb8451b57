// SPDX-License-Identifier: MIT
// Vectors of cells (fibre directions and the like) from a text file: a line a cell, three numbers a vector.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/io/cursor.hpp"
#include "tunica/io/read_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tunica::io {

/// `families` vectors of each of `cell_count` cells: 3 x cells a family. Lines: 3 * families numbers in the
/// order of the cells; empty ones and those that begin with # are passed. Zeros and nan are read as they are:
/// who uses the vectors checks them. InputError tells the line with a word that is no number, or numbers too
/// many or few.
[[nodiscard]] inline std::vector<Points<3>> read_cell_vectors(const std::filesystem::path& path,
                                                              std::size_t families, Index cell_count) {
  const std::string bytes = read_file(path);
  Cursor cursor(path.string(), bytes);
  std::vector<Points<3>> out(families, Points<3>(3, cell_count));
  Index cell = 0;
  while (!cursor.at_end()) {
    if (cursor.rest().front() == '#') {
      (void)cursor.line();
      continue;
    }
    const std::size_t at = cursor.offset();
    if (cell == cell_count) cursor.fail(at, "a line more than the " + std::to_string(cell_count) + " cells");
    for (std::size_t k = 0; k < 3 * families; ++k) {
      const std::string_view word = cursor.word_of_line();
      if (word.empty())
        cursor.fail(at, std::to_string(k) + " numbers for cell " + std::to_string(cell) + ", expected " +
                            std::to_string(3 * families));
      out[k / 3](static_cast<Eigen::Index>(k % 3), cell) =
          cursor.number_of<double>(word, "a component of a vector");
    }
    cursor.end_of_line();
    ++cell;
  }
  if (cell != cell_count)
    throw InputError(path.string(), "cell " + std::to_string(cell),
                     "the end of the file; the mesh has " + std::to_string(cell_count) + " cells");
  return out;
}

}  // namespace tunica::io
