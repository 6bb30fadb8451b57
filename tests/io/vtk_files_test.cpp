// SPDX-License-Identifier: MIT
#include "tunica/image/sampling.hpp"
#include "tunica/io/pvd.hpp"
#include "tunica/io/read_file.hpp"
#include "tunica/io/stl_write.hpp"
#include "tunica/io/vtk_image_write.hpp"
#include "tunica/io/vtk_xml.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtp_lines.hpp"
#include "tunica/io/vtu.hpp"
#ifdef TUNICA_WITH_ZLIB
#include "tunica/io/zlib.hpp"
#endif

#include <doctest/doctest.h>

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#ifndef TUNICA_VTK_PYTHON
#define TUNICA_VTK_PYTHON ""
#endif

using namespace tunica;

namespace {

std::filesystem::path folder() {
  const auto path = std::filesystem::temp_directory_path() / ("tunica_files_" + std::to_string(::getpid()));
  std::filesystem::create_directories(path);
  return path;
}

/// 2 x 2 x 2 cells over [0, 1/2]^3.
mesh::HexMesh hexes() {
  mesh::HexMesh m;
  m.nodes.resize(3, 27);
  for (int n = 0; n < 27; ++n) m.nodes.col(n) = Vec3(n % 3, n / 3 % 3, n / 9) / 4;
  m.cells.resize(8, 8);
  for (int c = 0; c < 8; ++c) {
    const Index o = c % 2 + 3 * (c / 2 % 2) + 9 * (c / 4);
    m.cells.col(c) << o, o + 1, o + 4, o + 3, o + 9, o + 10, o + 13, o + 12;
  }
  return m;
}

/// Each hexahedron in six, all around its diagonal from corner 0 to corner 6.
mesh::TetMesh tets() {
  constexpr std::array<std::array<int, 2>, 6> rim{{{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
  const auto h = hexes();
  mesh::TetMesh m;
  m.nodes = h.nodes;
  m.cells.resize(4, 48);
  for (int c = 0; c < 8; ++c)
    for (int i = 0; i < 6; ++i) {
      const auto [a, b] = rim[static_cast<std::size_t>(i)];
      m.cells.col(6 * c + i) << h.cells(0, c), h.cells(a, c), h.cells(b, c), h.cells(6, c);
    }
  return m;
}

mesh::Surface octahedron() {
  mesh::Surface s;
  s.nodes.resize(3, 6);
  s.nodes << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
  s.cells.resize(3, 8);
  s.cells << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
  return s;
}

mesh::QuadSurface cube() {
  mesh::QuadSurface s;
  s.nodes.resize(3, 8);
  for (int n = 0; n < 8; ++n)
    s.nodes.col(n) = Vec3(n == 1 || n == 2 || n == 5 || n == 6, n / 2 % 2, n / 4) * 2;
  s.cells.resize(4, 6);
  for (int f = 0; f < 6; ++f)
    for (int i = 0; i < 4; ++i)
      s.cells(i, f) = mesh::Hex8::faces[static_cast<std::size_t>(f)][static_cast<std::size_t>(i)];
  return s;
}

template <class Mesh, class... Compressor>
void write_volume(const std::string& name, Mesh m, const Compressor&... compressor) {
  std::vector<double> pressure;
  Points<3> velocity = m.nodes;
  Eigen::VectorXf single(m.node_count());
  for (Index n = 0; n < m.node_count(); ++n) {
    pressure.push_back(n / 3.0);
    velocity.col(n) = velocity.col(n).cwiseProduct(Vec3(1, 2, 3));
    single[n] = static_cast<float>(n / 7.0);
  }
  std::vector<Index> number;
  std::vector<std::uint8_t> byte;
  Eigen::Matrix<double, 9, Eigen::Dynamic> tensor(9, m.cell_count());
  for (Index c = 0; c < m.cell_count(); ++c) {
    number.push_back(c), byte.push_back(static_cast<std::uint8_t>(c)), m.region.push_back(c % 3);
    for (int i = 0; i < 9; ++i) tensor(i, c) = (9 * c + i) / 2.0;
  }
  io::write_vtu(folder() / name, m,
                {.points = {{"pressure", pressure}, {"velocity", velocity}, {"single", single}},
                 .cells = {{"number", number}, {"tensor", tensor}, {"byte \"<&>\"", byte}}},
                compressor...);
}

template <class Surface>
void write_surface(const std::string& name, Surface s) {
  for (Index f = 0; f < s.cell_count(); ++f) s.region.push_back(f % 3);
  const Eigen::VectorXd height = s.nodes.row(2).transpose();
  io::write_vtp(folder() / name, s, {.points = {{"height", height}}});
}

template <class T>
void write_image(const std::string& name) {
  image::Image<T> m;
  for (int i = 0; i < 5; ++i) m.axes[0].push_back(195.116864 + i * 0.878906);
  for (int i = 0; i < 4; ++i) m.axes[1].push_back(-1 + i * 0.5);
  for (int i = 0; i < 3; ++i) m.axes[2].push_back(i * 1.50009);
  for (int i = 0; i < 60; ++i) m.values.push_back(static_cast<T>(i));
  io::write_vtk_image(folder() / ("image_" + name + ".vtk"), m, {.array = "mr"});
  m.axes[2] = {0, 1, 5};
  io::write_vtk_image(folder() / "uneven.vtk", m);
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: VTK reads back every kind of file that is written") {
    if (std::string(TUNICA_VTK_PYTHON).empty()) {
      std::printf("SKIPPED: no Python with VTK's module\n");
      return;
    }
    write_volume("tets.vtu", tets());
    write_volume("hexes.vtu", hexes());
#ifdef TUNICA_WITH_ZLIB
    write_volume("tets_zlib.vtu", tets(), io::Zlib{});
#endif
    write_surface("triangles.vtp", octahedron());
    write_surface("quads.vtp", cube());
    const mesh::Rows two_lines{{0, 2, 6}, {0, 1, 5, 4, 3, 2}};
    const std::vector<double> radius{0.5, 1, 1.5, 2, 2.5, 3};
    const std::vector<Index> parent{-1, 0};
    io::write_vtp_lines(folder() / "lines.vtp", octahedron().nodes, two_lines,
                        {.points = {{"radius", radius}}, .cells = {{"parent", parent}}});
    io::write_stl(folder() / "octahedron.stl", octahedron());
    io::Pvd series(folder() / "series.pvd");
    for (int i = 0; i < 3; ++i) series.add(0.1 * i, "tets.vtu");
    write_image<std::int8_t>("char"), write_image<std::uint8_t>("unsigned_char");
    write_image<std::int16_t>("short"), write_image<std::uint16_t>("unsigned_short");
    write_image<std::int32_t>("int"), write_image<std::uint32_t>("unsigned_int");
    write_image<std::int64_t>("vtktypeint64"), write_image<std::uint64_t>("vtktypeuint64");
    write_image<float>("float"), write_image<double>("double");
    const auto script = std::filesystem::path(__FILE__).parent_path() / "readback.py";
    const std::string command =
        std::string(TUNICA_VTK_PYTHON) + " \"" + script.string() + "\" \"" + folder().string() + "\"";
    CHECK(std::system(command.c_str()) == 0);
    std::filesystem::remove_all(folder());
  }

  TEST_CASE("io: equal meshes give equal bytes and wrong lengths give no file") {
    const auto path = folder() / "a.vtu";
    io::write_vtu(path, tets());
    const std::string first = io::read_file(path);
    io::write_vtu(path, tets());
    CHECK(io::read_file(path) == first);
    CHECK(first.find("encoding=\"raw\"") != std::string::npos);
    std::filesystem::remove(path);
    const std::vector<double> three(3);
    CHECK_THROWS_WITH_AS(io::write_vtu(path, tets(), {.points = {{"p", three}}}),
                         (path.string() + ": PointData \"p\": 3 tuples, 27 expected").c_str(), InputError);
    CHECK_THROWS_AS(io::write_vtp(path, octahedron(), {.cells = {{"p", three}}}), InputError);
    CHECK(!std::filesystem::exists(path));
    io::write_vtu(path, mesh::TetMesh{});  // an empty mesh is a file too
    CHECK(std::filesystem::exists(path));
    std::filesystem::remove_all(folder());
  }
}
