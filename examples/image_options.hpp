// SPDX-License-Identifier: MIT
// What the programs that begin with an image are told of it and of its surface.
#pragma once

#include "cli.hpp"
#include "tunica/image/image.hpp"
#include "tunica/meshing/cut.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace tunica::examples {

enum class Contourer { marching_cubes, dual_contouring };

struct ImageOptions {
  std::string image{};                 // a VTK file; empty: the phantom, with its iso-value and ports
  std::optional<double> iso{};         // inside is value >= iso
  std::optional<image::Voxel> seed{};  // none: the largest component
  std::vector<meshing::Cut> cuts{};    // in order; unnamed ones become "cut 1", "cut 2" ...
  Contourer surface = Contourer::marching_cubes;
  std::optional<double> edge{};  // 0 keeps the contourer's triangles; none: 1.5 largest spacing
  int smooth = 20;               // sweeps
};

[[nodiscard]] inline meshing::Cut cut_of(const std::string& text) {
  const auto v = numbers_of<double>(text);
  if (v.size() != 6 && v.size() != 7)
    throw UsageError("a cut is px,py,pz,nx,ny,nz or with a radius at the end");
  meshing::Cut cut{.point = {v[0], v[1], v[2]}, .normal = {v[3], v[4], v[5]}, .name = ""};
  if (!(cut.normal.norm() > 0) || !cut.point.allFinite() || !cut.normal.allFinite())
    throw UsageError("the normal of a cut must have a length");
  if (v.size() == 7) cut.radius = v[6];
  if (!(cut.radius > 0)) throw UsageError("the radius of a cut must be positive");
  return cut;
}

/// edge_default: what holds without --edge, for --help.
inline void add_image_options(Cli& cli, ImageOptions& o,
                              const std::string& edge_default = "1.5 times the largest spacing") {
  cli.option("--iso", "V", "iso-value: inside is value >= V (needed with an image; the phantom's: 1300)",
             o.iso);
  cli.option("--seed", "i,j,k", "a voxel of the vessel (none: the largest component)",
             [&o](const std::string& text) {
               const auto v = numbers_of<Index>(text);
               if (v.size() != 3) throw UsageError("a seed is i,j,k");
               o.seed = image::Voxel{v[0], v[1], v[2]};
             });
  cli.repeated(
      "--cut", "px,py,pz,nx,ny,nz[,r]",
      "an end: a plane through p, normal n outward, or with r a disc that severs only the vessel it\n"
      "crosses (the phantom without cuts: its three ports)",
      [&o](const std::string& text) { o.cuts.push_back(cut_of(text)); });
  cli.choice<Contourer>(
      "--surface", "how the surface is contoured (marching-cubes)",
      {{"marching-cubes", Contourer::marching_cubes}, {"dual-contouring", Contourer::dual_contouring}},
      o.surface);
  cli.option("--edge", "L", "edge length (none: " + edge_default + "; 0: the contourer's triangles)",
             [&o](const std::string& text) {
               o.edge = number_of<double>(text);
               if (!(*o.edge >= 0 && std::isfinite(*o.edge))) throw UsageError("must be 0 or more");
             });
  cli.option("--smooth", "N", "sweeps of smoothing that keeps the volume (20)",
             [&o](const std::string& text) {
               o.smooth = number_of<int>(text);
               constexpr int most = 1000;  // it takes about a hundred for all that it can do
               if (o.smooth < 0 || o.smooth > most)
                 throw UsageError("must be from 0 to " + std::to_string(most));
             });
}

}  // namespace tunica::examples
