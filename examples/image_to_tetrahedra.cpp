// SPDX-License-Identifier: MIT
// From an image to tetrahedra, module by module: the phantom's lumen, held against its true volume.
#include "tunica/image/components.hpp"
#include "tunica/image/phantom_truth.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

using namespace tunica;

int main() {
  const image::Phantom phantom;              // in mm
  auto grid = image::Sampling{}.refined(2);  // 0.44 x 0.44 x 0.75 mm
  grid.noise = 20;
  const auto scan = image::sample<short>(phantom, grid);  // as an MR scanner would
  const auto vessel = image::segment(scan, {.iso = image::Phantom::surface});

  auto surface = meshing::marching_cubes(scan, vessel.mask.inside, image::Phantom::surface).surface;
  const auto smoothing = meshing::smooth(surface, {.sweeps = 20});  // keeps the volume
  std::vector<meshing::Cut> ends;
  for (const auto& port : image::Phantom::ports())
    ends.push_back({.point = port.point, .normal = port.normal, .name = port.name});
  surface = meshing::cut(surface, ends).surface;            // flat, named caps
  surface = meshing::remesh(surface, {.edge = 2}).surface;  // [mm]
  const auto [lumen, fill] = meshing::tetrahedra(surface);
  io::write_vtu("image_to_tetrahedra.vtu", lumen);

  const double truth = image::lumen_volume(phantom), error = mesh::volume(lumen) / truth - 1;
  std::printf("%d tetrahedra, smallest dihedral angle %.1f degrees\n", lumen.cell_count(), fill.min_dihedral);
  std::printf("smoothing moved the volume by %.1e of it\n",
              smoothing.volume_after / smoothing.volume_before - 1);
  std::printf("volume %.1f mm3, true %.1f mm3: %+.2f %%\n", mesh::volume(lumen), truth, 100 * error);
  return std::abs(error) < 0.01 && fill.min_dihedral > 5 ? 0 : 1;
}
