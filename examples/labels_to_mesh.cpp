// SPDX-License-Identifier: MIT
// labels_to_mesh: a label image (a segmentation) to tetrahedra of several materials that conform.
#include "cli.hpp"
#include "json.hpp"
#include "material_figures.hpp"
#include "mesh_figures.hpp"
#include "output_files.hpp"
#include "patch_surface.hpp"
#include "stages.hpp"
#include "tunica/core/error.hpp"
#include "tunica/image/phantom_labels.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/meshing/multi_region.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::examples;

namespace {

/// InputError for an image of intensities: each of its values would be a material.
void require_few_labels(const image::Image<std::int32_t>& labels) {
  constexpr std::size_t most = 1000;
  const std::set<std::int32_t> different(labels.values.begin(), labels.values.end());
  if (different.size() > most)
    throw InputError("the image has " + std::to_string(different.size()) +
                     " different values: a segmentation has at most " + std::to_string(most) +
                     ", and image_to_mesh takes intensities");
}

}  // namespace

int main(int argc, char** argv) {
  std::string in, out, report_file;
  meshing::MultiRegionOptions options;
  Cli cli("labels_to_mesh",
          "Fills the labels of an image with tetrahedra, in the unit of the image; 0 is outside.");
  cli.argument(
      "LABELS.vtk",
      "VTK legacy image whose values are whole numbers, or the word phantom: a vessel that needs no file,\n"
      "1 its lumen, 2 a thrombus, 3 its wall",
      in);
  cli.repeated(
      "--name", "N=TEXT", "what label N is called, as in 1=lumen (without it: material N)",
      [&](const std::string& text) {
        const auto equal = text.find('=');
        if (equal == std::string::npos || equal + 1 == text.size()) throw UsageError("expected N=TEXT");
        options.names.push_back({number_of<std::int32_t>(text.substr(0, equal)), text.substr(equal + 1)});
      });
  cli.option("--edge", "L", "length of the interfaces' edges (that of a voxel)",
             [&](const std::string& text) {
               options.edge = number_of<double>(text);
               if (!(options.edge > 0 && std::isfinite(options.edge)))
                 throw UsageError("must be more than 0");
             });
  cli.option("--sweeps", "N",
             "sweeps of the smoothing (20); 0: interfaces as contoured, half-way between voxels",
             [&](const std::string& text) {
               options.sweeps = number_of<int>(text);
               if (options.sweeps < 0 || options.sweeps > 1000) throw UsageError("must be from 0 to 1000");
             });
  cli.option("-o", "OUT.vtu",
             "the tetrahedra, with their labels as \"material\"; the interfaces go to OUT.surface.vtp\n"
             "(the image's name)",
             out);
  cli.option("--report", "FILE.json", "figures, and elapsed and CPU seconds of each stage", report_file);

  return run_program(cli, argc, argv, [&] {
    const auto volume = mesh_file(out, in);
    expect_outputs(volume, report_file);
    Stages stage(3);
    Json report;
    report["warnings"] = Json(std::vector<std::string>{});
    const auto labels = stage("read", [&] {
      return in == "phantom" ? image::PhantomLabels{}()
                             : image::as_labels(io::read_vtk_image<double>(in).image);
    });
    require_few_labels(labels);
    const auto meshed = stage("mesh", [&] { return meshing::multi_region(labels, options); });
    report["fill"] = material_figures(meshed);
    tell_cells(meshed.mesh.cell_count(), meshed.report.min_dihedral, meshed.report.mean_ratio);
    OutputFiles files;
    stage("write", [&] {
      const std::vector<std::int32_t> material(meshed.material.begin(), meshed.material.end());
      files.write(volume, [&](const auto& path) {
        io::write_vtu(path, meshed.mesh, {.cells = {{"material", material}}});
      });
      files.write(surface_file(volume),
                  [&](const auto& path) { io::write_vtp(path, surface_of_patches(meshed.mesh)); });
    });
    finish(files, stage, report, report_file);
  });
}
