// SPDX-License-Identifier: MIT
// Quadratic cells and meshes of them: closed outward faces, each middle node once, bent edges, files for VTK.
#include "tunica/mesh/quadratic.hpp"

#include "support/vtk_python.hpp"
#include "tunica/fem/geometry.hpp"
#include "tunica/fem/shape_wedge.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/mesh/cells_behind.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/tube.hpp"

#include <doctest/doctest.h>

#include <unistd.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

using namespace tunica;

namespace {

/// int n dA over a face with these nodes, by its own functions; in the plane over an edge.
template <class Face>
Vec3 face_vector(const Eigen::Matrix<double, 3, Face::nodes>& x) {
  using Rule = fem::Gauss<Face, 5>;
  using Tables = fem::Tables<fem::Lagrange<Face>, Rule>;
  Vec3 sum = Vec3::Zero();
  for (std::size_t q = 0; q < Rule::size; ++q) {
    Vec3 t1 = Vec3::Zero(), t2 = Vec3::UnitZ();
    if constexpr (Face::dim == 2) t2.setZero();
    for (int a = 0; a < Face::nodes; ++a) {
      t1 += x.col(a) * Tables::gradients[q][static_cast<std::size_t>(a)][0];
      if constexpr (Face::dim == 2) t2 += x.col(a) * Tables::gradients[q][static_cast<std::size_t>(a)][1];
    }
    sum += Rule::weights[q] * t1.cross(t2);
  }
  return sum;
}

template <class C, int Dim>
double volume(const mesh::Mesh<C, Dim>& m) {
  using Rule = fem::Gauss<C, 5>;
  using Tables = fem::Tables<fem::Lagrange<C>, Rule>;
  double sum = 0;
  for (Index c = 0; c < m.cell_count(); ++c) {
    Eigen::Matrix<double, Dim, C::nodes> X;
    for (int a = 0; a < C::nodes; ++a) X.col(a) = m.nodes.col(m.cells(a, c));
    for (std::size_t q = 0; q < Rule::size; ++q)
      sum += Rule::weights[q] * fem::map_point<double, Dim>(X, Tables::gradients[q]).det;
  }
  return sum;
}

/// Nodes are all in use and no two are at the same place; faces of patches are faces of their cells.
template <class C>
void check_whole(const mesh::Mesh<C>& m) {
  std::vector<int> used(static_cast<std::size_t>(m.node_count()), 0);
  for (Eigen::Index k = 0; k < m.cells.size(); ++k) ++used[static_cast<std::size_t>(m.cells.data()[k])];
  CHECK(std::ranges::count(used, 0) == 0);
  std::set<std::array<long, 3>> places;
  for (Index n = 0; n < m.node_count(); ++n)
    places.insert({std::lround(1e7 * m.nodes(0, n)), std::lround(1e7 * m.nodes(1, n)),
                   std::lround(1e7 * m.nodes(2, n))});
  CHECK(places.size() == static_cast<std::size_t>(m.node_count()));
  const auto around = mesh::cells_of_nodes(m.cells, m.node_count());
  Index wrong = 0;
  for (const auto& patch : m.patches) {
    const auto behind = mesh::cells_behind(m.cells, around, patch.faces);
    for (Eigen::Index f = 0; f < patch.faces.cols(); ++f) {
      REQUIRE(behind[static_cast<std::size_t>(f)] >= 0);
      std::set<Index> face(patch.faces.col(f).begin(), patch.faces.col(f).end());
      bool found = false;
      for (const auto& local : C::faces) {
        std::set<Index> other;
        for (const int a : local) other.insert(m.cells(a, behind[static_cast<std::size_t>(f)]));
        found = found || other == face;
      }
      wrong += !found;
    }
  }
  CHECK(wrong == 0);
}

/// Onto the circle of the wall of a tube or lumen around the z axis.
struct Round {
  double inner, outer;
  Vec3 operator()(const Vec3& x, const std::string& patch) const {
    if (patch != "inner" && patch != "outer" && patch != "wall") return x;
    const double s = (patch == "inner" ? inner : outer) / std::hypot(x[0], x[1]);
    return {s * x[0], s * x[1], x[2]};
  }
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE_TEMPLATE("mesh: faces of quadratic cells point outward and close them when bent", C, mesh::Tri6,
                     mesh::Quad8, mesh::Quad9, mesh::Tet10, mesh::Hex20, mesh::Hex27, mesh::Wedge6) {
    Eigen::Matrix<double, 3, C::nodes> x;
    x.setZero();
    for (int a = 0; a < C::nodes; ++a)
      for (int i = 0; i < C::dim; ++i) {
        const auto& at = fem::reference_nodes<C>[static_cast<std::size_t>(a)];
        x(i, a) = at[static_cast<std::size_t>(i)] + 0.05 * std::sin(1.7 * a + i);
      }
    const Vec3 centre = x.rowwise().mean();
    Vec3 sum = Vec3::Zero();
    for (const auto& face : C::faces) {
      Eigen::Matrix<double, 3, C::Face::nodes> y;
      for (std::size_t k = 0; k < face.size(); ++k) y.col(static_cast<int>(k)) = x.col(face[k]);
      const Vec3 vector = face_vector<typename C::Face>(y);
      CHECK(vector.dot(y.rowwise().mean() - centre) > 0);
      sum += vector;
    }
    CHECK(sum.norm() < 1e-14);
  }

  TEST_CASE_TEMPLATE("mesh: edges of quadratic cells have their middle and each is in a face", C, mesh::Tri6,
                     mesh::Quad8, mesh::Quad9, mesh::Tet10, mesh::Hex20, mesh::Hex27) {
    static_assert(mesh::Quadratic<C> && C::edges.size() == C::Linear::edges.size());
    std::set<int> middles;
    for (const auto& [a, b, m] : C::edges) {
      CHECK(a < b);
      CHECK((b < C::Linear::nodes && m >= C::Linear::nodes));
      CHECK(middles.insert(m).second);
      for (std::size_t i = 0; i < C::dim; ++i) {
        const auto at = [&](int n) { return fem::reference_nodes<C>[static_cast<std::size_t>(n)][i]; };
        CHECK(2 * at(m) == at(a) + at(b));
      }
    }
    CHECK(C::faces.size() == C::Linear::faces.size());
  }

  TEST_CASE("mesh: quadratic meshes have each edge once and keep patches and regions") {
    auto tets = meshing::box_tets(3);
    tets.region.assign(static_cast<std::size_t>(tets.cell_count()), 0);
    tets.region[5] = 1, tets.region_names = {"a", "b"};
    const auto t10 = mesh::quadratic<mesh::Tet10>(tets);
    check_whole(t10);
    std::set<std::pair<Index, Index>> edges;
    for (Index c = 0; c < tets.cell_count(); ++c)
      for (const auto& [a, b] : mesh::Tet4::edges)
        edges.insert(std::minmax({tets.cells(a, c), tets.cells(b, c)}));
    REQUIRE(t10.node_count() == tets.node_count() + static_cast<Index>(edges.size()));
    Index next = tets.node_count();  // numbered in the order of their sorted ends
    double off = 0;
    for (const auto& [a, b] : edges)
      off += (t10.nodes.col(next++) - 0.5 * (tets.nodes.col(a) + tets.nodes.col(b))).norm();
    CHECK(off < 1e-14);
    CHECK(t10.region == tets.region);
    CHECK(t10.region_names == tets.region_names);
    CHECK(t10.patches.size() == tets.patches.size());
    CHECK(volume(t10) == doctest::Approx(volume(tets)).epsilon(1e-14));
  }

  TEST_CASE("mesh: the numbers of middle nodes do not depend on the order of the cells") {
    const auto mesh = meshing::tube({.inner_radius = 1, .thickness = 0.3, .length = 2, .cells = {2, 9, 3}});
    auto turned = mesh;
    turned.cells = mesh.cells.rowwise().reverse().eval();
    const auto a = mesh::quadratic<mesh::Hex27>(mesh), b = mesh::quadratic<mesh::Hex27>(turned);
    const Index n = a.node_count() - a.cell_count();  // those in the middle of cells go with the cells
    CHECK((a.nodes.leftCols(n) - b.nodes.leftCols(n)).cwiseAbs().maxCoeff() < 1e-15);
    const bool same = a.cells.topRows(26) == b.cells.rowwise().reverse().topRows(26);
    CHECK(same);
  }

  TEST_CASE_TEMPLATE("mesh: bent hexahedra fill a round tube with an error of order four", C, mesh::Hex20,
                     mesh::Hex27) {
    double error[2];
    for (const int k : {0, 1}) {
      const Index n = 8 << k;
      const auto m = meshing::tube({.inner_radius = 1, .thickness = 0.5, .length = 2, .cells = {2, n, 2}});
      const auto q = mesh::quadratic<C>(m, Round{.inner = 1, .outer = 1.5});
      check_whole(q);
      error[k] = std::abs(volume(q) / (std::numbers::pi * (1.5 * 1.5 - 1) * 2) - 1);
    }
    const double order = std::log2(error[0] / error[1]);
    MESSAGE("volume off by ", error[0], " and ", error[1], ", order ", order);
    CHECK(order > 3.8);
    CHECK(error[1] < 1e-4);
  }

  TEST_CASE("mesh: bent tetrahedra fill a round lumen with an error of order four") {
    double error[2];
    for (const int k : {0, 1}) {
      const Index n = 8 << k;
      const auto m = meshing::lumen({.radius = 1.5, .length = 2, .cells = {2 << k, n, 2}});
      const auto q = mesh::quadratic<mesh::Tet10>(m, Round{.inner = 1, .outer = 1.5});
      check_whole(q);
      error[k] = std::abs(volume(q) / (std::numbers::pi * 1.5 * 1.5 * 2) - 1);
    }
    CHECK(std::log2(error[0] / error[1]) > 3.8);
  }

  TEST_CASE("mesh: the inner nodes of a bent triquadratic cell follow its edges") {
    // a quarter of a ring by one cell: the middle of its faces and of itself are those of the blended map
    auto m = meshing::quarter_tube({.inner_radius = 1, .thickness = 1, .length = 1, .cells = {1, 1, 1}});
    const auto q = mesh::quadratic<mesh::Hex27>(m, Round{.inner = 1, .outer = 2});
    REQUIRE(q.cell_count() == 1);
    for (Index n = 0; n < 8; ++n) CHECK((q.nodes.col(n) - m.nodes.col(n)).norm() == 0);
    const double middle = std::hypot(q.nodes(0, q.cells(26, 0)), q.nodes(1, q.cells(26, 0)));
    CHECK(middle == doctest::Approx(1.5));
  }

  TEST_CASE("mesh: plane meshes of triangles and quadrilaterals become quadratic") {
    mesh::Mesh<mesh::Quad4, 2> m;
    m.nodes.resize(2, 6), m.cells.resize(4, 2);
    m.nodes << 0, 1, 2, 0, 1, 2, 0, 0, 0, 1, 1, 1;
    m.cells << 0, 1, 1, 2, 4, 5, 3, 4;
    m.patches.push_back({"lower", {}});
    m.patches[0].faces.resize(2, 2);
    m.patches[0].faces << 0, 1, 1, 2;
    const auto q8 = mesh::quadratic<mesh::Quad8>(m);
    const auto q9 = mesh::quadratic<mesh::Quad9>(
        m, [](const Point<2>& x, const std::string&) { return Point<2>(x[0], x[1] - 0.1); });
    CHECK(q8.node_count() == 6 + 7);
    CHECK(q9.node_count() == 6 + 7 + 2);
    CHECK(volume(q8) == doctest::Approx(2));
    CHECK(volume(q9) == doctest::Approx(2 + 2 * 0.1 * 2 / 3));  // two parabolas of height 0.1
    CHECK(q9.nodes(1, q9.patches[0].faces(2, 1)) == doctest::Approx(-0.1));
    mesh::Mesh<mesh::Tri3, 2> t;
    t.nodes = m.nodes, t.cells.resize(3, 4);
    t.cells << 0, 0, 1, 1, 1, 4, 2, 5, 4, 3, 5, 4;
    const auto t6 = mesh::quadratic<mesh::Tri6>(t);
    CHECK(t6.node_count() == 6 + 9);
    CHECK(volume(t6) == doctest::Approx(2));
  }

  TEST_CASE("mesh: an edge of a patch that no cell has is named") {
    auto m = meshing::box_tets(1);
    m.patches.push_back({"wrong", {}});
    m.patches.back().faces.resize(3, 1);
    Index far = -1;  // a node that shares no edge with node 0
    const auto around = mesh::cells_of_nodes(m.cells, m.node_count());
    for (Index n = 1; n < m.node_count() && far < 0; ++n)
      if (std::ranges::none_of(around[0], [&](Index c) { return (m.cells.col(c).array() == n).any(); }))
        far = n;
    if (far < 0) m.nodes.conservativeResize(3, m.node_count() + 1), far = m.node_count() - 1;
    m.nodes.col(far).setConstant(3);
    m.patches.back().faces << 0, 1, far;
    CHECK_THROWS_AS(static_cast<void>(mesh::quadratic<mesh::Tet10>(m)), MeshError);
  }

  TEST_CASE_TEMPLATE("mesh: VTK reads files of quadratic cells", C, mesh::Tet10, mesh::Hex20, mesh::Hex27) {
    const auto python = test::vtk_python();
    if (!python) return;
    const auto m = [] {
      if constexpr (std::is_same_v<C, mesh::Tet10>)
        return mesh::quadratic<C>(meshing::box_tets(2));
      else
        return mesh::quadratic<C>(
            meshing::tube({.inner_radius = 1, .thickness = 0.5, .length = 2, .cells = {1, 6, 2}}));
    }();
    const auto path =
        std::filesystem::temp_directory_path() / ("tunica_q" + std::to_string(::getpid()) + ".vtu");
    io::write_vtu(path, m);
    const std::string script =
        "import sys, vtk\n"
        "r = vtk.vtkXMLUnstructuredGridReader(); r.SetFileName(sys.argv[1]); r.Update(); g = r.GetOutput()\n"
        "assert g.GetNumberOfPoints() == int(sys.argv[2]) and g.GetNumberOfCells() == int(sys.argv[3])\n"
        "for i in range(g.GetNumberOfCells()):\n"
        "    c = g.GetCell(i); assert c.GetCellType() == int(sys.argv[4])\n"
        "    p = c.GetPoints()\n"
        "    for k in range(c.GetNumberOfEdges()):\n"
        "        e = c.GetEdge(k).GetPoints(); a, b, m = (e.GetPoint(j) for j in range(3))\n"
        "        assert all(abs(x + y - 2 * z) < 1e-12 for x, y, z in zip(a, b, m))\n";
    const std::string command = *python + " -c \"" + script + "\" " + path.string() + " " +
                                std::to_string(m.node_count()) + " " + std::to_string(m.cell_count()) + " " +
                                std::to_string(C::vtk_type);
    CHECK(std::system(command.c_str()) == 0);
    std::filesystem::remove(path);
  }
}
