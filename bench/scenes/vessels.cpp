// SPDX-License-Identifier: MIT
// What is made of a vessel, each step with its time: the phantom and, where the shared data is there, the
// real bifurcation, contoured and smoothed and cut as image_to_mesh does it, then remeshed, filled, filled
// with layers at the wall; two spheres; three materials. scene_vessels ROWS.csv
#include "support/provenance.hpp"
#include "support/shared.hpp"
#include "support/stopwatch.hpp"
#include "support/surfaces.hpp"
#include "tunica/image/components.hpp"
#include "tunica/image/phantom.hpp"
#include "tunica/image/phantom_labels.hpp"
#include "tunica/image/sampling.hpp"
#include "tunica/io/vtk_image.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/boundary_layers.hpp"
#include "tunica/meshing/cut.hpp"
#include "tunica/meshing/marching_cubes.hpp"
#include "tunica/meshing/multi_region.hpp"
#include "tunica/meshing/remesh.hpp"
#include "tunica/meshing/smooth.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tunica;

/// Writes the rows and tells them.
class Rows {
 public:
  explicit Rows(const char* path) : out_(path) {
    out_ << "work,case,triangles,cells,least_angle_deg,first_percentile_deg,mean_ratio,cpu_s,thousand_a_"
            "second,"
            "remark,flags,commit\n";
  }
  struct Row {
    std::string work{}, of{};
    Index triangles = 0, cells = 0;
    double least = 0, first_percentile = 0, ratio = 0, cpu = 0;  // [degrees], [-], [s]
    std::string remark{};
  };
  void operator()(const Row& r) {
    const double rate = 1e-3 * r.cells / r.cpu;
    out_ << r.work << ',' << r.of << ',' << r.triangles << ',' << r.cells << ',' << r.least << ','
         << r.first_percentile << ',' << r.ratio << ',' << r.cpu << ',' << rate << ',' << r.remark << ','
         << bench::flags() << ',' << bench::commit() << '\n';
    std::printf(
        "%-10s %-22s %6d triangles %7d cells  least %5.2f  1st percentile %5.2f degrees  "
        "ratio %.3f  %.3f s %4.0f k/s  %s\n",
        r.work.c_str(), r.of.c_str(), r.triangles, r.cells, r.least, r.first_percentile, r.ratio, r.cpu, rate,
        r.remark.c_str());
    std::fflush(stdout);
  }
  [[nodiscard]] bool whole() { return static_cast<bool>(out_.flush()); }

 private:
  std::ofstream out_;
};

std::string text(const char* format, double a, double b, double c = 0, double d = 0) {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), format, a, b, c, d);
  return line.data();
}

/// The smoothed contour between its cuts.
mesh::Surface between(const image::Image<float>& image, double iso, const std::vector<meshing::Cut>& cuts,
                      const std::optional<image::Voxel>& seed) {
  const auto vessel = image::segment(image, {.iso = iso, .seed = seed});
  auto surface = meshing::marching_cubes(image, vessel.mask.inside, iso).surface;
  static_cast<void>(meshing::smooth(surface, {.sweeps = 20}));
  meshing::CutOptions how;
  if (seed) how.seed = image.position(*seed);
  return meshing::cut(std::move(surface), cuts, how).surface;
}

mesh::Surface phantom() {
  std::vector<meshing::Cut> cuts;
  for (const auto& port : image::Phantom::ports())
    cuts.push_back({.point = port.point, .normal = port.normal, .name = port.name});
  return between(image::sample<float>(image::Phantom{}, {}), image::Phantom::surface, cuts, std::nullopt);
}

std::optional<mesh::Surface> real_bifurcation() {
  const auto path = test::shared("data/aorta_bifurcation.vtk");
  if (!path) return std::nullopt;
  return between(io::read_vtk_image(*path).image, 1299.5,
                 {{.point = {221.567, 165, 22.215}, .normal = {0.0011, 0.9996, -0.0283}, .name = "inlet"},
                  {.point = {207.554, 94.976, 33.243}, .normal = {-0.2769, -0.9166, 0.2883}, .name = "left"},
                  {.point = {237.629, 95.025, 31.872}, .normal = {0.2506, -0.8866, 0.3888}, .name = "right"}},
                 image::Voxel{30, 73, 15});
}

void fill(const std::string& name, const mesh::Surface& s, Rows& row) {
  meshing::FillResult filled;
  const double cpu = bench::best_cpu_seconds(3, [&] { filled = meshing::tetrahedra(s); });
  const auto q = mesh::quality(filled.mesh);
  row({"tetrahedra", name, s.cell_count(), filled.mesh.cell_count(), q.dihedral.least,
       q.dihedral.quantile(0.01), q.mean_ratio.mean, cpu,
       text("surface: angle %.2f; dihedral %.2f", filled.report.surface_min_angle,
            filled.report.surface_min_dihedral)});
}

void fill_layers(const std::string& name, const mesh::Surface& s, Rows& row) {
  meshing::LayerReport r;
  Index cells = 0;
  const double cpu = bench::best_cpu_seconds(3, [&] {
    const auto filled = meshing::layered_tetrahedra(s, {.layers = 5});
    r = filled.report, cells = filled.mesh.cell_count();
  });
  const auto share = static_cast<double>(r.layer.tetrahedra) / cells;
  row({"layers", name, s.cell_count(), cells, std::min(r.layer.min_dihedral, r.core.min_dihedral), 0,
       share * r.layer.mean_ratio + (1 - share) * r.core.mean_ratio, cpu,
       text("in layers %.0f; whole %.4f; least share %.3f; vanished %.0f; ", r.layer.tetrahedra, r.full_share,
            r.least_share, r.vanished) +
           text("dihedral %.2f and %.2f; ratio %.3f and %.3f", r.layer.min_dihedral, r.core.min_dihedral,
                r.layer.mean_ratio, r.core.mean_ratio)});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: scene_vessels ROWS.csv\n");
    return 2;
  }
  Rows row(arguments[1]);
  std::vector<std::pair<std::string, mesh::Surface>> vessels{{"phantom", phantom()}};
  if (auto real = real_bifurcation()) vessels.emplace_back("real bifurcation", std::move(*real));
  for (const auto& [name, vessel] : vessels)
    for (const double edge : {2.25, 2.0, 1.5, 1.03, 1.0}) {  // [mm]
      const std::string of = name + text(" %.4g mm", edge, 0);
      meshing::Remeshed even;
      const double cpu = bench::best_cpu_seconds(3, [&] { even = meshing::remesh(vessel, {.edge = edge}); });
      const auto q = mesh::quality(even.surface);
      row({"remeshing", of, vessel.cell_count(), even.surface.cell_count(), q.angle.least,
           q.angle.quantile(0.01), q.mean_ratio.mean, cpu,
           text("volume %.2f before and %.2f after", even.report.volume_before, even.report.volume_after)});
      fill(of, even.surface, row);
      if (edge == 2 || edge == 1) fill_layers(of, even.surface, row);
    }
  for (const int times : {4, 5}) fill("sphere", test::icosphere(times), row);
  fill_layers("sphere", test::icosphere(4), row);
  meshing::MultiRegionResult materials;
  const auto labels = image::PhantomLabels{}();
  const double cpu = bench::best_cpu_seconds(1, [&] { materials = meshing::multi_region(labels, {}); });
  row({"materials", "vessel with thrombus and wall", materials.report.triangles, materials.mesh.cell_count(),
       materials.report.min_dihedral, 0, materials.report.mean_ratio, cpu, ""});
  return row.whole() ? 0 : 1;
}
