// SPDX-License-Identifier: MIT
#include "tunica/io/stl.hpp"

#include "tunica/image/sampling.hpp"
#include "tunica/io/closed_surface.hpp"
#include "tunica/io/stl_write.hpp"

#include "support/shared.hpp"

#include <doctest/doctest.h>

#include <unistd.h>

#include <filesystem>
#include <string>

using namespace tunica;

namespace {

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("tunica_stl_" + std::to_string(::getpid()) + "_" + name);
}

mesh::Surface octahedron() {
  mesh::Surface s;
  s.nodes.resize(3, 6);
  s.nodes << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
  s.cells.resize(3, 8);
  s.cells << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
  return s;
}

std::string bytes_of(const mesh::Surface& s) {
  const auto path = scratch("bytes.stl");
  io::write_stl(path, s);
  std::string bytes = io::read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

std::string refusal(const std::string& bytes) {
  try {
    (void)io::closed_surface("f.stl", io::parse_stl("f.stl", bytes));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string facet(const std::string& corners) {
  return "facet normal 0 0 nan\nouter loop\n" + corners + "endloop\nendfacet\n";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: a surface written as STL is read back with its nodes welded") {
    const auto s = octahedron();
    const auto file = io::parse_stl("f.stl", bytes_of(s));
    CHECK(file.format == io::StlFormat::binary);
    CHECK(file.facets == 8);
    CHECK(file.collapsed == 0);
    CHECK(file.surface.node_count() == 6);
    const auto closed = io::closed_surface("f.stl", file);
    CHECK(mesh::enclosed_volume(closed.surface) == doctest::Approx(4.0 / 3).epsilon(1e-15));
    CHECK(closed.genus == 0);
    CHECK(closed.components == 1);
    CHECK(!closed.flipped);
    CHECK(closed.notices.empty());
    CHECK(bytes_of(closed.surface) == bytes_of(s));  // the order of the facets is kept
    auto inside_out = s;
    inside_out.cells.row(0).swap(inside_out.cells.row(1));
    const auto turned = io::closed_surface("f.stl", io::parse_stl("f.stl", bytes_of(inside_out)));
    CHECK(turned.flipped);
    CHECK(turned.notices.size() == 1);
    CHECK(mesh::enclosed_volume(turned.surface) > 0);
    auto two = s;  // one beside it that is inside out, one within it that is a cavity
    two.nodes.resize(3, 18);
    two.nodes << s.nodes, (s.nodes.colwise() + Vec3(5, 0, 0)).eval(), 0.1 * s.nodes;
    two.cells.resize(3, 24);
    two.cells << s.cells, s.cells.array() + 6, s.cells.array() + 12;
    for (const int block : {8, 16}) two.cells.block(0, block, 1, 8).swap(two.cells.block(1, block, 1, 8));
    const auto parts = io::closed_surface("f.stl", io::parse_stl("f.stl", bytes_of(two)));
    CHECK(parts.components == 3);
    CHECK(parts.notices == std::vector<std::string>{"f.stl: 1 of its parts were inside out; turned"});
    CHECK(mesh::enclosed_volume(parts.surface) == doctest::Approx((2 - 1e-3) * 4 / 3).epsilon(1e-6));
    auto bad = s;
    bad.nodes(0, 0) = 1e300;
    CHECK_THROWS_AS(bytes_of(bad), InputError);
    CHECK(!std::filesystem::exists(scratch("bytes.stl")));
  }

  TEST_CASE("io: text STL is read strictly and refused by line") {
    const std::string abc = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n", good = "solid a b c\n" + facet(abc);
    const auto file = io::parse_stl("f.stl", good + facet("vertex 1e0 0 -0\nvertex 1 0 0\nvertex 0 1 0\n") +
                                                 "endsolid a b c\nSOLID two\r\nENDSOLID\n");
    CHECK(file.format == io::StlFormat::ascii);
    CHECK(file.facets == 2);
    CHECK(file.collapsed == 1);
    CHECK(file.surface.node_count() == 3);
    CHECK(file.surface.nodes(0, 1) == 1);
    CHECK(has(refusal(good), "line 9 (byte 100): expected facet or endsolid, found the end of the file"));
    CHECK(has(refusal(good + "facet norml 0 0 1\n"),
              "line 9 (byte 106): expected \"NORMAL\", found \"norml\""));
    CHECK(has(refusal(good + facet("vertex 1.0 abc 2.0\n")),
              "line 11 (byte 143): expected a coordinate, found \"abc\""));
    CHECK(has(refusal(good + facet("vertex 1.0 nan 2.0\n")), "a coordinate that is not finite"));
    CHECK(has(refusal(good + facet("vertex 1.0 2.0\nvertex")), "line 12"));
    CHECK(has(refusal(good + "endsolid\njunk"), "expected \"SOLID\", found \"junk\""));
    CHECK(has(refusal("solid a\nendsolid a\n"), "f.stl: 0 facets"));
    CHECK(has(refusal(""), "file is empty"));
    CHECK(has(refusal("hello"), "neither text nor binary STL: 5 bytes"));
  }

  TEST_CASE("io: binary STL is told by its size and refused by its counts") {
    std::string bytes = bytes_of(octahedron());
    CHECK(refusal(bytes).empty());
    bytes.replace(0, 5, "solid");
    CHECK(refusal(bytes).empty());
    CHECK(io::parse_stl("f.stl", bytes).format == io::StlFormat::binary);
    for (std::size_t n = 1; n < bytes.size(); ++n) REQUIRE(!refusal(bytes.substr(0, n)).empty());
    CHECK(has(refusal(bytes.substr(0, 84 + 170)),
              "the header says 8 facets, the file holds 3 whole ones and 20 stray"));
    CHECK(has(refusal(bytes + "x"), "8 whole ones and 1 stray"));
    std::string many = bytes;
    many.replace(80, 4, "\xff\xff\xff\xff");
    CHECK(has(refusal(many), "the header says 4294967295 facets"));
    std::string nan = bytes;
    nan.replace(84 + 50 + 12, 4, std::string("\0\0\xc0\x7f", 4));
    CHECK(has(refusal(nan), "facet 1: a corner that is not finite"));
    for (std::uint64_t k = 0; k < 5000; ++k) {  // spoilt bytes end as a surface or as a sentence
      std::string bad = bytes;
      const auto r = image::splitmix64(k);
      bad[(r >> 8) % bad.size()] = static_cast<char>(r);
      (void)refusal(bad);
    }
  }

  TEST_CASE("io: a surface that bounds no volume is refused by its place") {
    auto s = octahedron();
    auto open = s;
    open.cells.conservativeResize(3, 7);
    CHECK(has(refusal(bytes_of(open)), "the surface is open: 1 boundary loop: 3 edges around ("));
    auto holes = s;  // two that touch at the corner (1, 0, 0)
    Index kept = 0, at_corner = 0;
    for (Index t = 0; t < 8; ++t) {
      const Vec3 middle = mesh::triangle(s, t).centroid();
      if (middle[0] > 0 && middle[1] * middle[2] > 0)
        ++at_corner;
      else
        holes.cells.col(kept++) = s.cells.col(t);
    }
    REQUIRE(at_corner == 2);
    holes.cells.conservativeResize(3, kept);
    CHECK(has(refusal(bytes_of(holes)), "is shared by 1 facet: the surface is open around holes that touch"));
    auto turned = s;
    turned.cells.col(2) << 3, 1, 4;
    CHECK(has(refusal(bytes_of(turned)), "is shared by 2 facets: which turn opposite ways (3 such edges)"));
    auto fin = s;
    fin.nodes.conservativeResize(3, 7);
    fin.nodes.col(6) << 5, 5, 5;
    fin.cells.conservativeResize(3, 9);
    fin.cells.col(8) << 0, 2, 6;
    CHECK(has(refusal(bytes_of(fin)), "from (1, 0, 0) to (0, 1, 0) is shared by 3 facets"));
    auto touch = s;  // two octahedra that share a corner
    touch.nodes.conservativeResize(3, 11);
    touch.cells.conservativeResize(3, 16);
    for (int n = 0; n < 5; ++n) touch.nodes.col(6 + n) = Vec3(s.nodes.col(n + 1)) + Vec3(2, 0, 0);
    for (int t = 0; t < 8; ++t)
      for (int i = 0; i < 3; ++i) {
        const Index n = s.cells(i, t);
        touch.cells(i, 8 + t) = n == 1 ? 0 : n == 0 ? 6 : n + 5;
      }
    touch.nodes.col(6) = Vec3(3, 0, 0);
    CHECK(has(refusal(bytes_of(touch)), "1 points where the surface touches itself"));
    const std::string corners = "vertex 0 0 0\nvertex 0 1e300 0\nvertex 1e300 0 0\n";
    CHECK(has(refusal("solid\n" + facet(corners) + "endsolid\n"), "the diagonal of the surface is "));
    auto flat = s;
    flat.nodes.row(2).setZero();
    CHECK(!refusal(bytes_of(flat)).empty());
  }

  TEST_CASE("io: the real surfaces are closed and one of them is turned") {
    const auto ours = test::shared("data/lumen_iso1299.5_clipped.stl");
    const auto theirs = test::shared("data/vmtk_levelset_surface.stl");
    if (!ours || !theirs) return;
    const auto a = io::read_closed_stl(*ours), b = io::read_closed_stl(*theirs);
    CHECK(a.surface.cell_count() == 11350);
    CHECK(mesh::enclosed_volume(a.surface) == doctest::Approx(10154.17).epsilon(1e-6));
    CHECK(!a.flipped);
    CHECK(b.surface.node_count() == 6468);
    CHECK(b.flipped);
    CHECK(mesh::enclosed_volume(b.surface) == doctest::Approx(13184.27).epsilon(1e-6));
  }
}
