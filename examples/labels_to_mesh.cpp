// SPDX-License-Identifier: MIT
// labels_to_mesh: a label image (a segmentation) to tetrahedra of several materials that conform.
#include "cli.hpp"
#include "json.hpp"
#include "label_options.hpp"
#include "material_figures.hpp"
#include "mesh_figures.hpp"
#include "output_files.hpp"
#include "patch_surface.hpp"
#include "stages.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/meshing/multi_region.hpp"

#include <cstdint>
#include <string>
#include <vector>

using namespace tunica;
using namespace tunica::examples;

int main(int argc, char** argv) {
  LabelOptions o;
  Cli cli("labels_to_mesh",
          "Fills the labels of an image with tetrahedra, in the unit of the image; 0 is outside.");
  add_label_options(cli, o);

  return run_program(cli, argc, argv, [&] {
    const auto volume = mesh_file(o.out, o.image);
    expect_outputs(volume, o.report_file);
    Stages stage(3);
    Json report;
    report["warnings"] = Json(std::vector<std::string>{});
    const auto labels = stage("read", [&] { return read_labels(o); });
    require_few_labels(labels);
    const auto meshed = stage("mesh", [&] { return meshing::multi_region(labels, o.mesh); });
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
    finish(files, stage, report, o.report_file);
  });
}
