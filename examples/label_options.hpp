// SPDX-License-Identifier: MIT
// What labels_to_mesh is told of a label image and of its mesh, and the labels that it reads.
#pragma once

#include "cli.hpp"
#include "tunica/core/error.hpp"
#include "tunica/image/phantom_labels.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/meshing/multi_region.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

namespace tunica::examples {

struct LabelOptions {
  std::string image{};  // a VTK file, or "phantom"
  meshing::MultiRegionOptions mesh{};
  std::string out{}, report_file{};
};

inline void add_label_options(Cli& cli, LabelOptions& o) {
  cli.argument(
      "LABELS.vtk",
      "VTK legacy image whose values are whole numbers, or the word phantom: a vessel that needs no file,\n"
      "1 its lumen, 2 a thrombus, 3 its wall",
      o.image);
  cli.repeated(
      "--name", "N=TEXT", "what label N is called, as in 1=lumen (without it: material N)",
      [&o](const std::string& text) {
        const auto equal = text.find('=');
        if (equal == std::string::npos || equal + 1 == text.size()) throw UsageError("expected N=TEXT");
        o.mesh.names.push_back({number_of<std::int32_t>(text.substr(0, equal)), text.substr(equal + 1)});
      });
  cli.option("--edge", "L", "length of the interfaces' edges (that of a voxel)",
             [&o](const std::string& text) {
               o.mesh.edge = number_of<double>(text);
               if (!(o.mesh.edge > 0 && std::isfinite(o.mesh.edge))) throw UsageError("must be more than 0");
             });
  cli.option("--sweeps", "N",
             "sweeps of the smoothing (20); 0: interfaces as contoured, half-way between voxels",
             [&o](const std::string& text) {
               o.mesh.sweeps = number_of<int>(text);
               if (o.mesh.sweeps < 0 || o.mesh.sweeps > 1000) throw UsageError("must be from 0 to 1000");
             });
  cli.option("-o", "OUT.vtu",
             "the tetrahedra, with their labels as \"material\"; the interfaces go to OUT.surface.vtp\n"
             "(the image's name)",
             o.out);
  cli.option("--report", "FILE.json", "figures, and elapsed and CPU seconds of each stage", o.report_file);
}

/// The labels of the file, or of the phantom.
[[nodiscard]] inline image::Image<std::int32_t> read_labels(const LabelOptions& o) {
  return o.image == "phantom" ? image::PhantomLabels{}()
                              : image::as_labels(io::read_vtk_image<double>(o.image).image);
}

/// InputError for an image of intensities: each of its values would be a material.
inline void require_few_labels(const image::Image<std::int32_t>& labels) {
  constexpr std::size_t most = 1000;
  const std::set<std::int32_t> different(labels.values.begin(), labels.values.end());
  if (different.size() > most)
    throw InputError("the image has " + std::to_string(different.size()) +
                     " different values: a segmentation has at most " + std::to_string(most) +
                     ", and image_to_mesh takes intensities");
}

}  // namespace tunica::examples
