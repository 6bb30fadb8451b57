// SPDX-License-Identifier: MIT
// The command line of artery_fsi, and what of it the results depend on.
#pragma once

#include "cli.hpp"
#include "image_options.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/units.hpp"
#include "tunica/io/crc32.hpp"
#include "tunica/io/read_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tunica::artery {

using namespace tunica::literals;

enum class Size { coarse, paper };

struct Options {
  examples::ImageOptions image{};
  Size size = Size::coarse;
  double unit = 1_mm;           // of the image [m]
  double end = 0.1, dt = 1e-3;  // [s]
  std::string folder = TUNICA_RESULTS_DIR, report{};
  int checkpoint = 5;  // steps between two
  int threads = 0;     // 0: all of the machine
  bool restart = false;

  [[nodiscard]] int steps() const { return static_cast<int>(std::lround(end / dt)); }
  [[nodiscard]] int frame_every() const { return std::max(1, steps() / 20); }  // at least 20 frames
  [[nodiscard]] bool paper() const { return size == Size::paper; }
  /// Mean edge of the wall's quadrilaterals, in edges of the lumen: 3,000 hexahedra beside 74,000 tetrahedra.
  [[nodiscard]] double wall_edge() const { return *image.edge * (paper() ? 1.55 : 1.0); }
  [[nodiscard]] int layers() const { return paper() ? 2 : 1; }

  /// Fills in what was left open; UsageError for what cannot be.
  void check() {
    using examples::UsageError;
    if (!(dt > 0 && end > 0 && std::isfinite(end))) throw UsageError("--end and --dt must be positive");
    if (!(end / dt < 1e9)) throw UsageError("--end has too many steps of --dt");
    if (std::abs(steps() * dt - end) > 1e-6 * dt || steps() < 1)
      throw UsageError("--end must be a whole number of steps of --dt");
    if (checkpoint < 1) throw UsageError("--checkpoint must be 1 or more");
    if (threads < 0) throw UsageError("--threads must be 1 or more");
    if (!image.edge) image.edge = (paper() ? 1.03_mm : 2_mm) / unit;
    if (!(*image.edge > 0)) throw UsageError("--edge must be positive here: the wall needs it as well");
    if (!image.image.empty() && image.cuts.size() < 2)
      throw UsageError("an image needs a --cut for the inlet and one for each outlet");
  }

  /// Input and all options that the results depend on, in words.
  [[nodiscard]] std::string fingerprint() const {
    std::string s = "image phantom";
    if (!image.image.empty()) {
      const std::string bytes = io::read_file(image.image);
      s = "image of " + std::to_string(bytes.size()) + " bytes with CRC " + std::to_string(io::crc32(bytes));
    }
    if (image.iso) s += ", iso " + number_text(*image.iso);
    if (const auto& v = image.seed)
      s += ", seed " + std::to_string(v->i) + "," + std::to_string(v->j) + "," + std::to_string(v->k);
    for (const auto& c : image.cuts) {
      s += ", cut";
      for (const double x :
           {c.point[0], c.point[1], c.point[2], c.normal[0], c.normal[1], c.normal[2], c.radius})
        s += " " + number_text(x);
    }
    s += image.surface == examples::Contourer::marching_cubes ? ", marching cubes" : ", dual contouring";
    s += ", edge " + number_text(*image.edge) + ", smooth " + std::to_string(image.smooth) + ", unit " +
         number_text(unit);
    return s + (paper() ? ", size paper" : ", size coarse") + ", end " + number_text(end) + ", dt " +
           number_text(dt);
  }
};

[[nodiscard]] inline examples::Cli command_line(Options& o) {
  examples::Cli cli(
      "artery_fsi",
      "From an image (VTK legacy; none: a phantom) to blood flow in a deforming vessel, in SI.");
  cli.optional_argument("IMAGE", "the image; lengths of options are in its unit", o.image.image);
  add_image_options(cli, o.image, "that of --size");
  cli.choice<double>("--unit", "of the image's lengths (mm)",
                     {{"mm", 1_mm}, {"m", 1_m}, {"cm", 10_mm}, {"um", 1_um}}, o.unit);
  cli.choice<Size>("--size", "coarse: edge 2 mm, one layer of hexahedra; paper: 1.03 mm, two",
                   {{"coarse", Size::coarse}, {"paper", Size::paper}}, o.size);
  cli.option("--end", "S", "end of the run [s] (0.1)", o.end);
  cli.option("--dt", "S", "time step [s] (0.001)", o.dt);
  cli.option("--out", "DIR", "folder of the results (" + o.folder + ")", o.folder);
  cli.option("--checkpoint", "N", "steps between checkpoints (5)", o.checkpoint);
  cli.flag("--restart", "go on from the checkpoint in DIR", o.restart);
  cli.option("--threads", "N", "threads (all of the machine); the results do not depend on it", o.threads);
  cli.option("--report", "FILE.json",
             "figures, and elapsed and CPU seconds of each stage, as in DIR/report.json", o.report);
  return cli;
}

}  // namespace tunica::artery
