// SPDX-License-Identifier: MIT
#include "tunica/solid/output.hpp"
#include "support/tube_cells.hpp"
#include "support/vtk_python.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/io/vtu_cells.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"
#include "tunica/solid/laws.hpp"
#include "tunica/solid/statics.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

using namespace tunica;
using namespace tunica::solid;

namespace {

/// A deformation with shear, twist and a change of volume.
const Eigen::Matrix3d stretched{{1.2, 0.3, -0.1}, {0.1, 0.95, 0.2}, {-0.05, 0.1, 1.08}};
const Hyperelastic rubber{Yeoh{.c10 = 1, .c20 = 0.3}, SimoTaylor{.kappa = 40}};

struct Exact {
  Symmetric<double> cauchy;
  double J, stretch;
  Principal principal;
};
Exact exact(const Vec3& fibre) {
  Tensor<double> F;
  for (int k = 0; k < 9; ++k) F.m[static_cast<std::size_t>(k)] = stretched(k / 3, k % 3);
  const auto P = rubber.stress(F);
  Eigen::Matrix3d sigma;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      sigma(i, j) = (P(i, 0) * F(j, 0) + P(i, 1) * F(j, 1) + P(i, 2) * F(j, 2)) / stretched.determinant();
  return {.cauchy = symmetric_part<double>(sigma),
          .J = stretched.determinant(),
          .stretch = (stretched * fibre).norm() / fibre.norm(),
          .principal = principal(symmetric_part<double>(sigma))};
}

/// The largest error of each field, of the largest stress where it is one.
void check_fields(const WallFields& fields, const Exact& want) {
  const double size = want.cauchy.norm();
  double stress = 0, mises = 0, values = 0, direction = 0, J = 0, stretch = 0;
  for (Eigen::Index k = 0; k < fields.J.size(); ++k) {
    stress = std::max(stress, (fields.cauchy.col(k) - want.cauchy).norm() / size);
    mises = std::max(mises, std::abs(fields.von_mises[k] - von_mises(want.cauchy)) / size);
    values = std::max(values, (fields.principal.col(k) - want.principal.values).norm() / size);
    for (int i = 0; i < 3; ++i)
      direction = std::max(direction,
                           1 - std::abs(fields.directions[i].col(k).dot(want.principal.directions.col(i))));
    J = std::max(J, std::abs(fields.J[k] - want.J));
    stretch = std::max(stretch, std::abs(fields.fibre_stretch[k] - want.stretch));
  }
  CHECK(fields.J.size() > 0);
  CHECK(stress < 1e-12);
  CHECK(mises < 1e-12);
  CHECK(values < 1e-12);
  CHECK(direction < 1e-12);
  CHECK(J < 1e-13);
  CHECK(stretch < 1e-13);
}

template <class Locking, mesh::Cell C>
void check_affine_cell(const std::filesystem::path& folder, const std::string& cure) {
  INFO(C::nodes << " nodes, " << cure);
  auto mesh = test::box_of<C>(meshing::Block{.cells = {3, 2, 2}, .hi = Vec3(1, 0.8, 0.7)});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.02, 0.02);
  for (Index n = 0; n < mesh.node_count(); ++n)
    for (int i = 0; i < 3; ++i) mesh.nodes(i, n) += jitter(random);
  const Vec3 fibre(1, 2, -2);
  Body body{mesh, with<Locking>(rubber), 0.0, Mass::lumped};
  Eigen::VectorXd u = Eigen::VectorXd::Zero(body.unknowns());
  const Points<3> moved = stretched * mesh.nodes - mesh.nodes;
  u.head(moved.size()) = moved.reshaped();
  const auto press = [&](Eigen::VectorXd& x) {
    if constexpr (std::is_same_v<Locking, NodalPressure>)
      x.tail(mesh.node_count())
          .setConstant(rubber.volumetric.slope(stretched.determinant()) /
                       body.inside().pressures(Eigen::VectorXd::Ones(body.unknowns()))[0]);
  };
  press(u);
  const Points<3> fibres = fibre.replicate(1, mesh.cell_count());
  const WallFields at_nodes = nodal_fields(body, u, fibres), of_cells = cell_fields(body, u, fibres);
  check_fields(at_nodes, exact(fibre));
  check_fields(of_cells, exact(fibre));
  CHECK((nodal_stress(body, u).colwise() - exact(fibre).cauchy).norm() < 1e-10 * exact(fibre).cauchy.norm());

  io::VtuData data;
  at_nodes.for_each([&](const char* name, const auto& field) { data.points.emplace_back(name, field); });
  of_cells.for_each([&](const char* name, const auto& field) { data.cells.emplace_back(name, field); });
  const auto path = folder / (std::to_string(C::nodes) + "_nodes_" + cure + ".vtu");
  io::write_vtu(path, mesh, data);
  CHECK(io::read_vtu_cell_vectors(path, "principal_stress") == of_cells.principal);
  CHECK(io::read_vtu_cell_vectors(path, "principal_direction_3") == of_cells.directions[2]);

  if constexpr (!std::is_same_v<Locking, FBar>) {  // carried by the mesh it is the same
    mesh.nodes += moved;
    Body carried{mesh, with<Locking>(rubber), 0.0, Mass::lumped};
    carried.laws().prestress(std::vector<Eigen::Matrix3d>(
        static_cast<std::size_t>(mesh.cell_count()) * decltype(carried)::Element::points, stretched));
    Eigen::VectorXd none = Eigen::VectorXd::Zero(carried.unknowns());
    if constexpr (std::is_same_v<Locking, NodalPressure>)
      none.tail(mesh.node_count())
          .setConstant(rubber.volumetric.slope(stretched.determinant()) /
                       carried.inside().pressures(Eigen::VectorXd::Ones(carried.unknowns()))[0]);
    const Points<3> turned = (stretched * fibre).replicate(1, mesh.cell_count());
    check_fields(nodal_fields(carried, none, turned), exact(fibre));
    check_fields(cell_fields(carried, none, turned), exact(fibre));
  }
}
template <class Locking, mesh::Cell... C>
void check_affine(const std::filesystem::path& folder, const std::string& cure) {
  (check_affine_cell<Locking, C>(folder, cure), ...);
}

void check_all(const std::filesystem::path& folder) {
  using namespace mesh;
  check_affine<Pointwise, Tet4, Tet10, Hex8, Hex20, Hex27, Wedge6>(folder, "Pointwise");
  check_affine<MeanVolume, Tet4, Tet10, Hex8, Hex20, Hex27, Wedge6>(folder, "MeanVolume");
  check_affine<FBar, Hex8, Hex20, Hex27, Wedge6>(folder, "FBar");
  check_affine<NodalPressure, Tet4>(folder, "NodalPressure");
}

/// A folder that is gone at the end of its scope.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tunica_fields_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directory(path); }
  Folder(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("solid: principal values and directions of tensors turned anyhow and with equal values") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int n = 0; n < 400; ++n) {
      Vec3 values(number(random), number(random), number(random));
      if (n % 4 == 1) values[1] = values[0];
      if (n % 4 == 2) values.setConstant(values[0]);
      if (n % 4 == 3) values[2] = 1e-9 * values[2];
      values *= std::pow(10.0, n % 13 - 6);
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(3 * number(random), Vec3(number(random), number(random), 1).normalized())
              .toRotationMatrix();
      const Eigen::Matrix3d A = R * values.asDiagonal() * R.transpose();
      const Principal p = principal(symmetric_part<double>(A));
      std::sort(values.data(), values.data() + 3, [](double a, double b) { return a > b; });
      const double size = values.cwiseAbs().maxCoeff();
      CHECK((p.values - values).norm() < 1e-14 * size);
      CHECK((p.directions.transpose() * p.directions - Eigen::Matrix3d::Identity()).norm() < 1e-14);
      CHECK(p.directions.determinant() > 0);
      CHECK((A * p.directions - p.directions * p.values.asDiagonal().toDenseMatrix()).norm() < 1e-14 * size);
    }
    CHECK(principal(Symmetric<double>::Zero()).values.norm() == 0);
  }

  TEST_CASE(
      "solid: recovery gives linear fields back at all nodes and stays calm where cells lie in one layer") {
    auto mesh = meshing::box_hexes(meshing::Block{.cells = {4, 3, 5}, .hi = Vec3(1, 1, 0.1)});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.04, 0.04);
    for (Index n = 0; n < mesh.node_count(); ++n)
      mesh.nodes.col(n) += Vec3(jitter(random), jitter(random), 0.1 * jitter(random));
    const auto linear = [](const Vec3& x) {
      return Eigen::Vector2d(3 + x[0] - 2 * x[1] + 5 * x[2], 1 - 40 * x[2]);
    };
    Eigen::MatrixXd values(2, mesh.cell_count());
    for (Index e = 0; e < mesh.cell_count(); ++e) {
      Vec3 middle = Vec3::Zero();
      for (const Index n : mesh.cells.col(e)) middle += mesh.nodes.col(n) / 8;
      values.col(e) = linear(middle);
    }
    const Eigen::MatrixXd nodal = recover_at_nodes(mesh, values);
    for (Index n = 0; n < mesh.node_count(); ++n)
      CHECK((nodal.col(n) - linear(mesh.nodes.col(n))).norm() < 1e-12);

    // A tube of one layer: nothing is known of the way through the wall, and nothing is made up.
    const auto shell =
        meshing::tube({.inner_radius = 5e-3, .thickness = 0.5e-3, .length = 10e-3, .cells = {1, 24, 6}});
    Eigen::MatrixXd wave(1, shell.cell_count());
    for (Index e = 0; e < shell.cell_count(); ++e) wave(0, e) = 1 + 1e3 * shell.nodes(2, shell.cells(0, e));
    const Eigen::MatrixXd through = recover_at_nodes(shell, wave);
    for (Index n = 0; n + 1 < shell.node_count(); n += 2)
      CHECK(through(0, n) == doctest::Approx(through(0, n + 1)));
  }

  TEST_CASE("solid: fields of a sheared block are those of its law and have names in a VTU") {
    const auto mesh = meshing::box_hexes(meshing::Block{.cells = {3, 2, 2}});
    Statics wall{mesh, Hyperelastic{NeoHooke{.c10 = 1}, SimoTaylor{.kappa = 50}}};
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 1) = 0.5, F(2, 2) = 1.1;
    wall.start(F * mesh.nodes - mesh.nodes);
    Points<3> fibres(3, mesh.cell_count());
    fibres.colwise() = Vec3(0, 3, 0);
    const WallFields at_nodes = nodal_fields(wall.body(), wall.unknowns(), fibres),
                     of_cells = cell_fields(wall.body(), wall.unknowns(), fibres);
    const Eigen::Matrix3d b = std::pow(1.1, -2. / 3) * F * F.transpose();
    const Eigen::Matrix3d sigma = 2 / 1.1 * (b - b.trace() / 3 * Eigen::Matrix3d::Identity()) +
                                  25 * (1.1 - 1 / 1.1) * Eigen::Matrix3d::Identity();
    const Principal p = principal(symmetric_part<double>(sigma));
    for (const auto* fields : {&at_nodes, &of_cells})
      for (Eigen::Index k = 0; k < fields->J.size(); ++k) {
        CHECK((fields->cauchy.col(k) - symmetric_part<double>(sigma)).norm() < 1e-12);
        CHECK(fields->J[k] == doctest::Approx(1.1).epsilon(1e-12));
        CHECK(fields->fibre_stretch[k] == doctest::Approx(std::sqrt(1.25)).epsilon(1e-12));
        CHECK((fields->principal.col(k) - p.values).norm() < 1e-12);
        CHECK(std::abs(fields->directions[0].col(k).dot(p.directions.col(0))) > 1 - 1e-12);
        CHECK(fields->von_mises[k] == doctest::Approx(von_mises(symmetric_part<double>(sigma))));
      }
    // Stored away, the same deformation is still that of the body free of stress.
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(wall.unknowns().size());
    wall.absorb();
    Points<3> turned(3, mesh.cell_count());
    turned.colwise() = F * Vec3(0, 3, 0);
    const WallFields stored = cell_fields(wall.body(), none, turned);
    CHECK((stored.J - of_cells.J).norm() < 1e-12);
    CHECK((stored.fibre_stretch - of_cells.fibre_stretch).norm() < 1e-12);
    CHECK((stored.cauchy - of_cells.cauchy).norm() < 1e-11);

    io::VtuData data;
    at_nodes.for_each([&](const char* name, const auto& field) { data.points.emplace_back(name, field); });
    of_cells.for_each([&](const char* name, const auto& field) { data.cells.emplace_back(name, field); });
    const auto path = std::filesystem::temp_directory_path() / "tunica_solid_output_test.vtu";
    io::write_vtu(path, mesh, data);
    std::stringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    std::filesystem::remove(path);
    for (const char* name :
         {"cauchy_stress", "von_mises", "principal_stress", "principal_direction_1", "J", "fibre_stretch"})
      CHECK(text.str().find("Name=\"" + std::string(name) + "\"") != std::string::npos);
    CHECK(text.str().find("Name=\"cauchy_stress\" NumberOfComponents=\"6\"") != std::string::npos);
  }

  TEST_CASE("solid: fields of an affine deformation are exact in all cells and formulations") {
    const Folder folder;
    check_all(folder.path);
  }

  TEST_CASE("solid: VTK reads the fields of all cells and formulations as they are") {
    const auto python = test::vtk_python();
    if (!python) return;
    const Folder folder;
    check_all(folder.path);
    const auto script = std::filesystem::path(__FILE__).parent_path() / "fields_in_vtk.py";
    CHECK(std::system((*python + " '" + script.string() + "' '" + folder.path.string() + "'").c_str()) == 0);
  }
}
