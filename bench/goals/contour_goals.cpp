// SPDX-License-Identifier: MIT
// Marching cubes against Flying Edges on the same volumes: time with vertex error, order, topology of noise.
#include "goals/goal.hpp"
#include "support/stopwatch.hpp"
#include "support/vtk_peer.hpp"
#include "support/work_cases.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/marching_cubes.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#ifndef TUNICA_CONTOUR_NATIVE
#define TUNICA_CONTOUR_NATIVE ""
#endif

namespace tunica::bench {
namespace {

constexpr const char* equal_error = "vtkFlyingEdges3D at an error equal within 1 %";

Index degenerate(const mesh::Surface& s) {
  Index count = 0;
  for (Index t = 0; t < s.cell_count(); ++t) count += !(mesh::triangle(s, t).area() > 0);
  return count;
}

/// Sample of a field that is negative inside, with ours: inside where the value is large.
template <class Field>
image::Image<float> volume(Index n, const Field& field) {
  return test::sampled<float>(n, [&](const Vec3& x) { return -field(x); });
}

/// Least CPU time [s] of the program built for the machine at hand; nothing where it is not there.
std::optional<double> native_seconds(const image::Image<float>& image, const std::string& border) {
  const std::string program = TUNICA_CONTOUR_NATIVE;
  std::string folder = (std::filesystem::temp_directory_path() / "tunica_native_XXXXXX").string();
  if (program.empty() || mkdtemp(folder.data()) == nullptr) return std::nullopt;
  const std::filesystem::path file = std::filesystem::path(folder) / "volume.raw";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.values.data()),
             static_cast<std::streamsize>(image.values.size() * sizeof(float)));
  std::istringstream reply(
      output_of("'" + program + "' '" + file.string() + "' " + std::to_string(image.size(0)) + " " + border));
  std::filesystem::remove_all(folder);
  double seconds = 0;
  if (!(reply >> seconds)) return std::nullopt;
  return seconds;
}

/// How many times faster than the peer, at an error that is equal within 1 %.
Goal speed(const std::string& name, double seconds, double error, double wanted,
           const std::optional<PeerSurface>& peer, double peer_error) {
  Goal goal{.name = name,
            .measured = text("%.2f ms at vertex rms %.2e h", 1e3 * seconds, error),
            .target = text(">= %.1f x %s", wanted, equal_error),
            .ratio = "-",
            .outcome = Outcome::unmatched};
  if (!peer) return goal;
  goal.ratio = text("%.2f x (%s: %.2f ms at %.2e h)", peer->cpu / seconds, peer->version.c_str(),
                    1e3 * peer->cpu, peer_error);
  goal.outcome = reached_if(peer->cpu / seconds >= wanted && error <= 1.01 * peer_error);
  return goal;
}

/// The generic build, and the same source built for the machine at hand.
void add_bifurcation(Index n, std::vector<Goal>& goals) {
  const double h = 1.0 / (n - 1);
  const auto image = volume(n, test::bifurcation);
  meshing::Contour contour;
  const double ours = best_cpu_seconds(7, [&] { contour = meshing::marching_cubes(image, 0); });
  const double error = test::distance_to_zero(contour.surface.nodes, test::bifurcation).first / h;
  const auto peer = vtk_surface(image, "flying_edges");
  const double peer_error =
      peer ? test::distance_to_zero(peer->surface.nodes, test::bifurcation).first / h : 0;
  if (const auto native = native_seconds(image, "capped"))
    goals.push_back(
        speed(text("isosurface: bifurcation %d^3, native", n), *native, error, 2.5, peer, peer_error));
  goals.push_back(speed(text("isosurface: bifurcation %d^3", n), ours, error, 1.5, peer, peer_error));
}

/// Open at the faces of the cube.
Goal gyroid() {
  constexpr Index n = 256;
  constexpr double h = 1.0 / (n - 1), w = 8 * std::numbers::pi;
  const auto field = [](const Vec3& x) {
    return std::sin(w * x[0]) * std::cos(w * x[1]) + std::sin(w * x[1]) * std::cos(w * x[2]) +
           std::sin(w * x[2]) * std::cos(w * x[0]);
  };
  const auto image = volume(n, field);
  meshing::Contour contour;
  const double ours = best_cpu_seconds(
      5, [&] { contour = meshing::marching_cubes(image, 0, {.border = meshing::Border::open}); });
  const auto error = [&](const mesh::Surface& s) {  // of some: they are many
    Points<3> some(3, s.node_count() / 16);
    for (Eigen::Index i = 0; i < some.cols(); ++i) some.col(i) = s.nodes.col(16 * i);
    return test::distance_to_zero(some, field).first / h;
  };
  const auto peer = vtk_surface(image, "flying_edges");
  return speed("isosurface: gyroid 256^3", ours, error(contour.surface), 2.0, peer,
               peer ? error(peer->surface) : 0);
}

Goal noise_speed() {
  constexpr double wanted = 1.3;
  const auto image = test::noise_volume(64);
  meshing::Contour contour;
  const double ours = best_cpu_seconds(15, [&] { contour = meshing::marching_cubes(image, 0); });
  Goal goal{.name = "isosurface: noise 64^3",
            .measured = text("%.2f ms for %d triangles", 1e3 * ours, contour.surface.cell_count()),
            .target = text(">= %.1f x vtkFlyingEdges3D", wanted),
            .ratio = "-",
            .outcome = Outcome::unmatched};
  if (const auto peer = vtk_surface(image, "flying_edges")) {
    goal.ratio = text("%.2f x (%s: %.2f ms for %d)", peer->cpu / ours, peer->version.c_str(), 1e3 * peer->cpu,
                      peer->surface.cell_count());
    goal.outcome = reached_if(peer->cpu / ours >= wanted);
  }
  return goal;
}

Goal order() {
  const auto off_grid = [](const Vec3& x) { return (x - Vec3(0.513, 0.487, 0.506)).norm() - 0.4; };
  const auto error = [&](Index n) {
    return test::distance_to_zero(meshing::marching_cubes(volume(n, off_grid), 0).surface.nodes, off_grid)
        .first;
  };
  const double coarse = error(33), fine = error(129);
  const double observed = std::log2(coarse / fine) / 2;
  Goal goal{.name = "isosurface: vertices on a sphere",
            .measured = text("order %.2f and rms %.2e at 129^3", observed, fine),
            .target = "order >= 1.9",
            .ratio = "-",
            .outcome = reached_if(observed >= 1.9)};
  if (const auto peer = vtk_surface(volume(129, off_grid), "flying_edges")) {
    const double theirs = test::distance_to_zero(peer->surface.nodes, off_grid).first;
    goal.ratio = text("error %.3f x (%s: %.2e)", fine / theirs, peer->version.c_str(), theirs);
  }
  return goal;
}

/// Noise with a fifth of its nodes on the iso-value.
Goal noise_topology() {
  const auto image = test::integer_noise_volume(64);
  const auto ours = meshing::marching_cubes(image, 0).surface;
  const auto t = mesh::topology(ours);
  const Index flat = degenerate(ours);
  Goal goal{.name = "isosurface: integer noise 64^3",
            .measured = text("%d open, %d non-manifold edges, %d vertices, %d degenerate of %d", t.open_edges,
                             t.nonmanifold_edges, t.nonmanifold_nodes, flat, ours.cell_count()),
            .target = "0 open, 0 non-manifold, 0 degenerate",
            .ratio = "-",
            .outcome = reached_if(t.closed() && flat == 0)};
  if (const auto peer = vtk_surface(image, "flying_edges"))
    goal.ratio = text("%s: %d degenerate of %d", peer->version.c_str(), degenerate(peer->surface),
                      peer->surface.cell_count());
  return goal;
}

}  // namespace

std::vector<Goal> contour_goals() {
  std::vector<Goal> goals;
  for (const Index n : {128, 256, 512}) add_bifurcation(n, goals);
  for (const auto& goal : {gyroid, noise_speed, order, noise_topology}) goals.push_back(goal());
  return goals;
}

}  // namespace tunica::bench
