// SPDX-License-Identifier: MIT
// Kernel tier: element kernels of the wall and of the blood, assembled over a mesh. The counter `error` is
// what the kernel is off by: a tangent against central differences of its forces, momentum against its row
// sums.
#include "support/kernel_time.hpp"
#include "tunica/core/units.hpp"
#include "tunica/fluid/projection.hpp"
#include "tunica/la/newton.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/body.hpp"
#include "tunica/solid/laws.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

namespace {

using namespace tunica;
using namespace tunica::literals;

struct Wall {
  mesh::HexMesh mesh = meshing::tube(
      meshing::Tube{.inner_radius = 5_mm, .thickness = 1.5_mm, .length = 50_mm, .cells = {2, 24, 64}});
  solid::Hyperelastic<solid::Yeoh, solid::Quadratic> law{solid::Yeoh{.c10 = 174_kPa, .c20 = 1880_kPa},
                                                         solid::Quadratic{.kappa = 348_MPa}};
  solid::Body<mesh::Hex8, decltype(law)> body{mesh, law, 1100_kg_m3, solid::Mass::consistent};
  Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns()), none = Eigen::VectorXd::Zero(0);

  Wall() {  // swollen by 5 %, twisted a little
    for (Index n = 0; n < mesh.node_count(); ++n) {
      const Vec3 x = mesh.nodes.col(n);
      u.segment<3>(3 * n) = 0.05 * Vec3(x[0] - 10 * x[1] * x[2], x[1] + 10 * x[0] * x[2], 0);
    }
  }
  Eigen::VectorXd forces(const Eigen::VectorXd& at) {
    Eigen::VectorXd f, predicted;
    if (!body.internal_forces(at, la::no_step, f, predicted)) f.setConstant(std::nan(""));
    return f;
  }
};

void hex8_forces(benchmark::State& state) {
  Wall wall;
  for (auto _ : state) benchmark::DoNotOptimize(wall.forces(wall.u));
  state.SetItemsProcessed(state.iterations() * wall.mesh.cell_count());
  // forces are in balance: their sum over the largest of them
  const Eigen::VectorXd f = wall.forces(wall.u);
  state.counters["error"] =
      f.reshaped(3, wall.mesh.node_count()).rowwise().sum().norm() / f.cwiseAbs().maxCoeff();
}
BENCHMARK(hex8_forces)->Unit(benchmark::kMillisecond);

void hex8_tangent(benchmark::State& state) {
  Wall wall;
  auto K = wall.body.pattern();
  (void)wall.forces(wall.u);
  for (auto _ : state) wall.body.tangent(wall.u, wall.none, {}, K);
  state.SetItemsProcessed(state.iterations() * wall.mesh.cell_count());
  Eigen::VectorXd direction(wall.u.size());
  for (Eigen::Index k = 0; k < direction.size(); ++k) direction[k] = std::sin(1.7 * static_cast<double>(k));
  constexpr double step = 1e-9;  // [m]
  const Eigen::VectorXd difference =
      (wall.forces(wall.u + step * direction) - wall.forces(wall.u - step * direction)) / (2 * step);
  const Eigen::VectorXd product = K.selfadjointView<Eigen::Lower>() * direction;
  state.counters["error"] = (product - difference).norm() / difference.norm();
}
BENCHMARK(hex8_tangent)->Unit(benchmark::kMillisecond);

// Linear tetrahedra assembled, pointwise (3 unknowns a node) and with nodal pressures (4: blocks of 16
// numbers in place of 9): `error` is K v to central differences of the forces.
template <class Given>
void tet4_tangent(benchmark::State& state, const Given& law) {
  const auto mesh = meshing::box_tets(28);
  solid::Body<mesh::Tet4, Given> body{mesh, law, 0, solid::Mass::lumped};
  auto& inside = body.inside();
  Eigen::VectorXd u(body.unknowns()), v = u, Kv;
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    u[k] = 0.002 * std::sin(1.7 * static_cast<double>(k));
    v[k] = std::cos(0.9 * static_cast<double>(k));
  }
  auto blocks = inside.assembly().matrix();
  for (auto _ : state) {
    blocks.set_zero();
    inside.add_tangent(u, 1, blocks);
  }
  state.SetItemsProcessed(state.iterations() * mesh.cell_count());
  auto K = body.pattern();
  body.tangent(u, Eigen::VectorXd::Zero(0), {}, K);
  constexpr double step = 1e-7;
  Eigen::VectorXd ahead, behind, predicted;
  if (!body.internal_forces(u + step * v, la::no_step, ahead, predicted) ||
      !body.internal_forces(u - step * v, la::no_step, behind, predicted))
    ahead.setConstant(std::nan(""));
  const Eigen::VectorXd difference = (ahead - behind) / (2 * step);
  state.counters["error"] =
      (K.template selfadjointView<Eigen::Lower>() * v - difference).norm() / difference.norm();
}
const solid::Hyperelastic<solid::Yeoh, solid::Quadratic> tet_law{solid::Yeoh{.c10 = 174_kPa, .c20 = 1880_kPa},
                                                                 solid::Quadratic{.kappa = 348_MPa}};
void tet4_tangent_pointwise(benchmark::State& state) {
  tet4_tangent(state, solid::with<solid::Pointwise>(tet_law));
}
void tet4_tangent_pressures(benchmark::State& state) {
  tet4_tangent(state, solid::with<solid::NodalPressure>(tet_law));
}
BENCHMARK(tet4_tangent_pointwise)->Unit(benchmark::kMillisecond);
BENCHMARK(tet4_tangent_pressures)->Unit(benchmark::kMillisecond);

// Forces and tangents of elements alone, a lane an element: `error` is K v to the derivative of the forces by
// duals.
template <class K, class S, class Law>
void kernel_tangent(benchmark::State& state, const Law& law) {
  namespace detail = bench::kernel_detail;
  const auto elements = std::make_unique<detail::Elements<K, S>>();
  const auto data = detail::fibre_data<Law, S, K::points>();
  const auto out = std::make_unique<typename K::template Tangent<S>>();
  for (auto _ : state)
    for (int e = 0; e < elements->count; ++e) {
      K::tangent(law, elements->X[e], elements->u[e], data.data(), *out);
      benchmark::DoNotOptimize(out.get());
      benchmark::ClobberMemory();
    }
  state.SetItemsProcessed(state.iterations() * elements->count * Lanes<S>::count);
  state.counters["error"] = detail::off_duals<K>(law);
}
void hex8_kernel_double(benchmark::State& state) {
  kernel_tangent<bench::kernel_detail::Hex, double>(state, bench::kernel_detail::any_law);
}
void hex8_kernel_packs(benchmark::State& state) {
  kernel_tangent<bench::kernel_detail::Hex, Pack<double>>(state, bench::kernel_detail::any_law);
}
void hex8_kernel_fibres(benchmark::State& state) {
  kernel_tangent<bench::kernel_detail::Fibre, Pack<double>>(state, bench::kernel_detail::wall);
}
void tet10_kernel_packs(benchmark::State& state) {
  kernel_tangent<bench::kernel_detail::Tet, Pack<double>>(state, bench::kernel_detail::any_law);
}
BENCHMARK(hex8_kernel_double)->Unit(benchmark::kMicrosecond);
BENCHMARK(hex8_kernel_packs)->Unit(benchmark::kMicrosecond);
BENCHMARK(hex8_kernel_fibres)->Unit(benchmark::kMicrosecond);
BENCHMARK(tet10_kernel_packs)->Unit(benchmark::kMicrosecond);

struct Lumen {
  mesh::TetMesh mesh = meshing::lumen(meshing::Lumen{.radius = 5_mm, .length = 50_mm, .cells = {5, 30, 66}});
  fluid::Pattern pattern{mesh};
  fem::P1Tets tets;
  fluid::Conditions conditions{mesh};
  Eigen::VectorXd inverse_mass = Eigen::VectorXd::Ones(mesh.node_count());
  fluid::Newtonian blood{.density = 1050_kg_m3, .viscosity = 3.5_mPas};
  Points<3> u = Points<3>::Zero(3, mesh.node_count());

  Lumen() {
    (void)tets.update(mesh.nodes, mesh.cells);
    for (Index n = 0; n < mesh.node_count(); ++n)
      u(2, n) = 0.4 * (1 - mesh.nodes.col(n).head<2>().squaredNorm() / 25e-6);
  }
};

void p1_geometry(benchmark::State& state) {
  Lumen lumen;
  for (auto _ : state) benchmark::DoNotOptimize(lumen.tets.update(lumen.mesh.nodes, lumen.mesh.cells));
  state.SetItemsProcessed(state.iterations() * lumen.mesh.cell_count());
  double error = 0;  // the gradients of the shape functions sum to zero
  for (Index e = 0; e < lumen.mesh.cell_count(); ++e)
    error = std::max(error, lumen.tets[e].grad.rowwise().sum().norm() / lumen.tets[e].grad.norm());
  state.counters["error"] = error;
}
BENCHMARK(p1_geometry)->Unit(benchmark::kMillisecond);

void p1_momentum(benchmark::State& state) {
  const Lumen lumen;
  const Index nodes = lumen.mesh.node_count();
  const Points<3> zero = Points<3>::Zero(3, nodes), no_force(3, 0);
  const Eigen::VectorXd p = Eigen::VectorXd::Zero(nodes);
  constexpr double rate = 1.5 / 1e-3;  // BDF2 at a step of 1 ms [1/s]
  const fluid::MomentumFields fields{
      .a = lumen.u, .u = lumen.u, .history = zero, .p = p, .force = no_force, .smoothed = zero, .rate = rate};
  const fluid::Domain domain{lumen.pattern,    lumen.mesh.cells,   lumen.tets,
                             lumen.mesh.nodes, lumen.inverse_mass, lumen.conditions};
  auto matrix = lumen.pattern.matrix<Eigen::RowMajor>();
  Points<3> right;
  for (auto _ : state) fluid::assemble_momentum(domain, lumen.blood, fluid::Fic{}, fields, matrix, right);
  state.SetItemsProcessed(state.iterations() * lumen.mesh.cell_count());
  // a uniform velocity is neither convected nor sheared: the entries sum to rho rate V
  double volume = 0;
  for (Index e = 0; e < lumen.mesh.cell_count(); ++e) volume += lumen.tets[e].volume;
  const double exact = lumen.blood.density * rate * volume;
  state.counters["error"] = std::abs((matrix * Eigen::VectorXd::Ones(nodes)).sum() / exact - 1);
}
BENCHMARK(p1_momentum)->Unit(benchmark::kMillisecond);

}  // namespace
