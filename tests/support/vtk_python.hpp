// SPDX-License-Identifier: MIT
// The Python that has VTK's module, an independent reader; without it a test is skipped with a sentence.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#ifndef TUNICA_VTK_PYTHON
#define TUNICA_VTK_PYTHON "/usr/bin/python3"
#endif

namespace tunica::test {

/// The interpreter; prints the line by which CTest knows a skipped test when there is none.
inline std::optional<std::string> vtk_python() {
  const std::string python = TUNICA_VTK_PYTHON;
  if (!python.empty()) return python;
  std::printf("SKIPPED: no Python that imports vtk (package python3-vtk9)\n");
  return std::nullopt;
}

}  // namespace tunica::test
