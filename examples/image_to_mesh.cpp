// SPDX-License-Identifier: MIT
// image_to_mesh: a medical image to a closed, capped, remeshed surface and its tetrahedra.
#include "image_pipeline.hpp"
#include "output_files.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"

#include <filesystem>
#include <string>

using namespace tunica;
using namespace tunica::examples;

int main(int argc, char** argv) {
  ImageOptions options;
  std::string out, report_file;
  Cli cli("image_to_mesh",
          "From an image (VTK legacy) to a surface and tetrahedra, in the unit of the image.");
  cli.argument("IMAGE", "the image", options.image);
  add_image_options(cli, options);
  cli.option("-o", "OUT.vtu", "the tetrahedra; the surface goes to OUT.surface.vtp (the image's name)", out);
  cli.option("--report", "FILE.json", "figures, and elapsed and CPU seconds of each stage", report_file);

  return run_program(cli, argc, argv, [&] {
    if (options.image.empty()) throw UsageError("IMAGE is empty");
    const auto volume = mesh_file(out, options.image);
    expect_outputs(volume, report_file);
    Stages stage(image_stages + 1);
    Json report;
    const auto [surface, tets] = mesh_image(options, stage, report);
    OutputFiles files;
    stage("write", [&] {
      if (options.fill == Fill::tets)
        files.write(volume, [&](const auto& path) { io::write_vtu(path, tets); });
      files.write(surface_file(volume), [&](const auto& path) { io::write_vtp(path, surface); });
    });
    finish(files, stage, report, report_file);
  });
}
