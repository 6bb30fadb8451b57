// SPDX-License-Identifier: MIT
// The surface of an STL file, mended as far as its program is asked for, each change told.
#pragma once

#include "json.hpp"
#include "mesh_figures.hpp"
#include "surface_options.hpp"
#include "tunica/core/error.hpp"
#include "tunica/io/closed_surface.hpp"
#include "tunica/io/stl.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/repair.hpp"

#include <utility>

namespace tunica::examples {

/// Closed, or an InputError that names what is left.
[[nodiscard]] inline mesh::Surface mended_surface(const SurfaceOptions& o, Json& report) {
  io::StlFile file = io::read_stl(o.surface);
  try {
    auto mended = meshing::repair(std::move(file.surface), repair_options(o));
    file.surface = std::move(mended.surface);
    for (const auto& sentence : mended.report.sentences()) warn(report, o.surface + ": " + sentence);
    report["repair"] = repair_figures(mended.report);
  } catch (const MeshError& e) {
    throw InputError(o.surface + ": " + e.what());
  }
  auto closed = io::closed_surface(o.surface, std::move(file));
  for (const auto& notice : closed.notices) warn(report, notice);
  return std::move(closed.surface);
}

}  // namespace tunica::examples
