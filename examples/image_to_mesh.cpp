// SPDX-License-Identifier: MIT
// image_to_mesh: a medical image to a closed, capped surface and the volume mesh that it bounds.
#include "image_fill.hpp"
#include "output_files.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

using namespace tunica;
using namespace tunica::examples;

namespace {

/// What `patch` counts in the file of the surface: with triangles the figures of the surface say it.
void tell_patches(const mesh::HexMesh& hexes, Json& report) {
  for (std::size_t p = 0; p < hexes.patches.size(); ++p) {
    Json patch;
    patch["patch"] = p, patch["name"] = hexes.patches[p].name;
    patch["quadrilaterals"] = hexes.patches[p].faces.cols();
    report["surface"]["patches"].push(std::move(patch));
  }
}

}  // namespace

int main(int argc, char** argv) {
  ImageOptions options;
  FillChoice fill;
  std::string out, report_file;
  Cli cli("image_to_mesh",
          "From an image (VTK legacy) to a surface and a volume mesh, in the unit of the image.");
  cli.argument("IMAGE", "the image, or the word phantom: a bifurcation that needs no file", options.image);
  add_image_options(cli, options);
  add_fill_options(cli, fill);
  cli.option("-o", "OUT.vtu", "the volume mesh; its surface goes to OUT.surface.vtp (the image's name)", out);
  cli.option("--report", "FILE.json", "figures, and elapsed and CPU seconds of each stage", report_file);

  return run_program(cli, argc, argv, [&] {
    if (options.image.empty()) throw UsageError("IMAGE is empty");
    require_sense(fill, options);
    const auto volume = mesh_file(out, options.image);
    if (options.image == "phantom") options.image.clear();
    expect_outputs(volume, report_file);
    Stages stage(fill_stages(fill.fill) + 1);
    Json report;
    const auto vessel = fill_image(options, fill, stage, report);
    tell_patches(vessel.hexes, report);
    if (!report_file.empty()) tell_quality(vessel, report);
    OutputFiles files;
    stage("write", [&] {
      io::VtuData data;
      if (!vessel.in_layers.empty()) data.cells.push_back({"layers", vessel.in_layers});
      if (vessel.tets.cell_count() > 0)
        files.write(volume, [&](const auto& path) { io::write_vtu(path, vessel.tets, data); });
      if (vessel.hexes.cell_count() > 0)
        files.write(volume, [&](const auto& path) { io::write_vtu(path, vessel.hexes); });
      files.write(surface_file(volume), [&](const auto& path) {
        if (vessel.hexes.cell_count() > 0)
          io::write_vtp(path, vessel.quads);
        else
          io::write_vtp(path, vessel.triangles);
      });
    });
    finish(files, stage, report, report_file);
  });
}
