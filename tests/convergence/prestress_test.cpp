// SPDX-License-Identifier: MIT
#include "tunica/solid/prestress.hpp"
#include "support/tube_cells.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/fibre_laws.hpp"
#include "tunica/solid/inverse.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/stress.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

// 120 mmHg on the tube of 5/6.5 mm: what an image of it shows.
constexpr double image_inner = 5.2688758130e-3, image_outer = 6.7090276741e-3, image_pressure = 15998.687;

mesh::HexMesh image_of_tube(int radial) {
  return meshing::quarter_tube({.inner_radius = image_inner,
                                .thickness = image_outer - image_inner,
                                .length = 1e-3,
                                .cells = {radial, 4 * radial, 1}});
}

auto wall_of(const mesh::HexMesh& mesh, double kappa) {
  const test::ThickTube tube;
  Statics<mesh::Hex8, Hyperelastic<Yeoh, Quadratic>> wall{
      mesh, Hyperelastic{Yeoh{.c10 = tube.c10, .c20 = tube.c20}, Quadratic{.kappa = kappa}}};
  wall.fix(mesh.patch("ends"), Axis::z);
  wall.fix(mesh.patch("sym_x"), Axis::x);
  wall.fix(mesh.patch("sym_y"), Axis::y);
  wall.pressure(mesh.patch("inner"), image_pressure);
  return wall;
}

double mean_radius(const mesh::HexMesh& mesh, const Points<3>& nodes, const char* patch) {
  double sum = 0;
  const auto on = mesh::patch_nodes(mesh.patch(patch));
  for (const Index n : on) sum += nodes.col(n).head<2>().norm();
  return sum / static_cast<double>(on.size());
}

}  // namespace

TEST_SUITE("convergence") {
  TEST_CASE("solid: inverse design of the imaged thick tube returns its unloaded radii") {
    const test::ThickTube tube;
    std::vector<double> errors, stress_errors;
    for (const int n : {2, 4, 8}) {
      auto mesh = image_of_tube(n);
      const Points<3> image = mesh.nodes;
      const auto loaded = wall_of(mesh, 1e5 * 2 * tube.c10);
      const auto free = unloaded_shape(loaded);
      REQUIRE(free);
      const double inner = mean_radius(mesh, free.nodes, "inner"),
                   outer = mean_radius(mesh, free.nodes, "outer");
      errors.push_back(std::abs(inner - tube.inner) / (image_inner - tube.inner));
      MESSAGE(n << " cells: unloaded radii " << inner * 1e3 << " / " << outer * 1e3 << " mm, residual "
                << free.solve.residual << " in " << free.steps << " steps, " << free.solve.iterations
                << " iterations, Newton's order " << la::observed_order(free.history, 1e-8));
      CHECK(std::abs(inner - tube.inner) < 2e-4 * tube.inner);
      CHECK(std::abs(outer - tube.outer) < 2e-4 * tube.outer);
      CHECK(la::observed_order(free.history, 1e-8) >= 1.9);
      // Loaded again it is the image, to the residual.
      mesh.nodes = free.nodes;
      auto again = wall_of(mesh, 1e5 * 2 * tube.c10);
      REQUIRE(again.solve());
      const double back = (mesh.nodes + again.displacement() - image).cwiseAbs().maxCoeff();
      MESSAGE("loaded again it is off the image by " << back / image_outer << " of its radius");
      CHECK(back < 1e-8 * image_outer);
      // Stresses of the closed form: s_tt - s_rr = 4 (c10 + 2 c20 (I1-3))... at the middle of the cells.
      double worst = 0, largest = 0;
      const auto sigma = cell_stress(again.body(), again.unknowns());
      for (Index e = 0; e < mesh.cell_count(); ++e) {
        Vec3 middle = Vec3::Zero();
        for (const Index k : mesh.cells.col(e)) middle += image.col(k) / 8;
        const double r = middle.head<2>().norm();
        const auto exact = tube.stress_at(r, image_inner / tube.inner);
        const double c = middle[0] / r, s = middle[1] / r;
        const Symmetric<double> at = sigma.col(e);
        const double rr = c * c * at[0] + s * s * at[1] + 2 * c * s * at[3];
        const double tt = s * s * at[0] + c * c * at[1] - 2 * c * s * at[3];
        for (const double d : {rr - exact.rr, tt - exact.tt, at[2] - exact.zz})
          worst = std::max(worst, std::abs(d));
        largest = std::max(largest, std::abs(exact.tt));
      }
      MESSAGE("stresses of the cells are off by " << 100 * worst / largest
                                                  << " % of the largest hoop stress");
      stress_errors.push_back(worst / largest);
    }
    for (std::size_t k = 1; k < errors.size(); ++k) {
      const double order = std::log2(errors[k - 1] / errors[k]);
      MESSAGE("error of the inner radius " << errors[k] << " of its displacement, order " << order);
      CHECK(order == doctest::Approx(2).epsilon(0.1));
      const double profile = std::log2(stress_errors[k - 1] / stress_errors[k]);
      MESSAGE("order of the stress profile " << profile);
      CHECK(profile == doctest::Approx(2).epsilon(0.1));
    }
    CHECK(stress_errors.back() < 1e-3);
  }

  TEST_CASE("solid: the prestressed image of the thick tube is in equilibrium and drifts with the step") {
    const auto mesh = image_of_tube(4);
    const double kappa = 1e4 * 2 * 174e3;
    std::vector<double> drifts, residuals;
    for (const int steps : {10, 20, 40}) {
      auto wall = wall_of(mesh, kappa);
      const auto report = prestress(wall, {.steps = steps, .residual = 1});
      REQUIRE(report);
      CHECK(report.load == 1);
      drifts.push_back(report.drift / (2 * image_outer));
      residuals.push_back(report.residual);
      // Mean hoop stress p r_i/t: any equilibrium has it. Its profile is another than that of a wall which
      // was loaded from a shape free of stress.
      double hoop = 0, area = 0, low = 1e300, high = 0;
      const auto sigma = cell_stress(wall.body(), wall.unknowns());
      for (Index e = 0; e < mesh.cell_count(); ++e) {
        Vec3 middle = Vec3::Zero();
        for (const Index k : mesh.cells.col(e)) middle += mesh.nodes.col(k) / 8;
        const double r = middle.head<2>().norm(), c = middle[0] / r, s = middle[1] / r;
        const double tt = s * s * sigma(0, e) + c * c * sigma(1, e) - 2 * c * s * sigma(3, e);
        hoop += tt;  // cells of one thickness: int s_tt dr
        area += 1;
        low = std::min(low, tt), high = std::max(high, tt);
      }
      const double mean = image_pressure * image_inner / (image_outer - image_inner);
      const test::ThickTube tube;
      const double inside = tube.stress_at(image_inner, image_inner / tube.inner).tt,
                   outside = tube.stress_at(image_outer, image_inner / tube.inner).tt;
      MESSAGE(steps << " steps, " << report.solve.iterations << " iterations: drift " << drifts.back()
                    << " of the diameter, residual " << report.residual << "; mean hoop stress "
                    << hoop / area / mean << " of p r/t, cells from " << low << " to " << high
                    << " Pa, loaded from the unloaded shape " << outside << " to " << inside << " Pa");
      CHECK(hoop / area == doctest::Approx(mean).epsilon(5e-3));
      CHECK(drifts.back() < 1e-3);
    }
    for (std::size_t k = 1; k < drifts.size(); ++k) {
      MESSAGE("order in the step: drift " << std::log2(drifts[k - 1] / drifts[k]) << ", residual "
                                          << std::log2(residuals[k - 1] / residuals[k]));
      CHECK(std::log2(drifts[k - 1] / drifts[k]) == doctest::Approx(1).epsilon(0.15));
    }
    // What is left of the drift is stored as well, until the image itself is in equilibrium.
    auto settled = wall_of(mesh, kappa);
    const auto report = prestress(settled, {.steps = 10});
    REQUIRE(report);
    MESSAGE("settled " << report.settlings << " times, " << report.solve.iterations
                       << " iterations: residual " << report.residual << ", drift "
                       << report.drift / (2 * image_outer));
    CHECK(report.residual <= 1e-6);
    CHECK(report.settlings <= 8);
    CHECK(report.drift < 1e-8 * image_outer);
  }

  TEST_CASE("solid: a tube of two fibre families comes back from its image and is prestressed in it") {
    const test::ThickTube tube;
    const Hyperelastic artery{HolzapfelGasserOgden{.c = 30e3, .k1 = 20e3, .k2 = 2}, Quadratic{.kappa = 3e7}};
    const double p = 12e3, angle = 35 * std::numbers::pi / 180;
    auto mesh = test::quarter_of_tube<mesh::Hex8>(4, tube.inner, tube.outer);
    const Points<3> unloaded = mesh.nodes;
    auto free = test::wall_of_tube(mesh, artery, p);
    free.point_field([&](Index, const Vec3& x) {
      const double r = x.head<2>().norm(), c = std::cos(angle), s = std::sin(angle);
      Fibres<double, 2> a;
      a.set(0, {-c * x[1] / r, c * x[0] / r, s});
      a.set(1, {-c * x[1] / r, c * x[0] / r, -s});
      return a;
    });
    REQUIRE(free.solve());
    // What an image shows: the shape under load, and fibres as they lie in it.
    mesh.nodes = unloaded + free.displacement();
    auto imaged = test::wall_of_tube(mesh, artery, p);
    using Body = std::remove_cvref_t<decltype(free.body())>;
    double turned = 0;
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const auto F =
          Body::Element::deformation(free.body().reference(e), free.body().gather(e, free.unknowns()));
      for (std::size_t q = 0; q < F.size(); ++q) {
        Fibres<double, 2> a = free.body().data(e).points[q];
        for (std::size_t k = 0; k < 2; ++k) {
          const Vec3 before(a[k][0], a[k][1], a[k][2]), after = (F[q] * before).normalized();
          a.set(k, {after[0], after[1], after[2]});
          turned = std::max(turned, std::acos(std::min(1.0, before.dot(after))));
        }
        imaged.laws().point_data(e, q, a);
      }
    }
    const double swollen = (mesh.nodes - unloaded).cwiseAbs().maxCoeff();
    const auto shape = unloaded_shape(imaged);
    REQUIRE(shape);
    const double off = (shape.nodes - unloaded).cwiseAbs().maxCoeff();
    MESSAGE("loaded it swells by " << swollen * 1e3 << " mm and its fibres turn by "
                                   << turned * 180 / std::numbers::pi
                                   << " degrees; the unloaded shape is off by " << off / swollen
                                   << " of that, residual " << shape.solve.residual << " in "
                                   << shape.solve.iterations << " iterations, order "
                                   << la::observed_order(shape.history, 1e-9));
    CHECK(swollen > 0.1 * tube.inner);
    CHECK(turned > 0.02);
    CHECK(off < 1e-8 * swollen);

    const auto report = prestress(imaged, {.steps = 20});
    REQUIRE(report);
    const auto& body = imaged.body();
    const StressField sigma = cell_stress(body, imaged.unknowns());
    double hoop = 0, drift_of_fibres = 0;
    const Points<3> middle = test::middles(mesh, mesh.nodes);
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      const double r = middle.col(e).head<2>().norm(), c = middle(0, e) / r, s = middle(1, e) / r;
      hoop += (s * s * sigma(0, e) + c * c * sigma(1, e) - 2 * c * s * sigma(3, e)) *
              (mesh.nodes.col(mesh.cells(1, e)) - mesh.nodes.col(mesh.cells(0, e))).head<2>().norm();
      for (std::size_t q = 0; q < 8; ++q) {  // back on the image the fibres are those that were given
        const auto a = body.data(e).points[q];
        const Vec3 on = (body.data(e).prestress[q] * Vec3(a[0][0], a[0][1], a[0][2])).normalized();
        const auto free_a = free.body().data(e).points[q];
        const auto F =
            Body::Element::deformation(free.body().reference(e), free.body().gather(e, free.unknowns()))[q];
        const Vec3 given = (F * Vec3(free_a[0][0], free_a[0][1], free_a[0][2])).normalized();
        drift_of_fibres = std::max(drift_of_fibres, (on - given).norm());
      }
    }
    double inner = 0;
    const auto nodes = mesh::patch_nodes(mesh.patch("x0"));
    for (const Index n : nodes)
      inner += mesh.nodes.col(n).head<2>().norm() / static_cast<double>(nodes.size());
    MESSAGE("prestress: settled " << report.settlings << " times, residual " << report.residual << ", drift "
                                  << report.drift / (2 * tube.outer) << " of the diameter, hoop force "
                                  << hoop / 16 / (p * inner) << " of p r, fibres off by " << drift_of_fibres);
    CHECK(report.residual <= 1e-6);
    CHECK(report.drift < 1e-3 * 2 * tube.outer);
    CHECK(drift_of_fibres < 1e-13);
    CHECK(hoop / 16 == doctest::Approx(p * inner).epsilon(0.01));
  }
}
