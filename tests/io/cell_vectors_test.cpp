// SPDX-License-Identifier: MIT
#include "tunica/io/cell_vectors.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/io/vtu_cells.hpp"

#include <doctest/doctest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

using namespace tunica;

namespace {

/// A file that is gone at the end of its scope.
struct Written {
  std::filesystem::path path;
  Written(const std::string& name, const std::string& text)
      : path(std::filesystem::temp_directory_path() / ("tunica_" + std::to_string(::getpid()) + "_" + name)) {
    if (text.empty()) return;
    std::FILE* file = std::fopen(path.c_str(), "wb");
    REQUIRE(file != nullptr);
    REQUIRE(std::fwrite(text.data(), 1, text.size(), file) == text.size());
    std::fclose(file);
  }
  Written(const Written&) = delete;
  ~Written() { std::filesystem::remove(path); }
};

template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

mesh::TetMesh two_tets() {
  mesh::TetMesh m;
  m.nodes.resize(3, 5);
  m.nodes << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1;
  m.cells.resize(4, 2);
  m.cells << 0, 1, 1, 2, 2, 3, 3, 4;
  return m;
}

std::string vtu(const std::string& format, const std::string& content, const std::string& components = "3",
                const std::string& head = "") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt32\"" +
         head +
         ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<PointData></PointData>\n"
         "<CellData>\n<DataArray type=\"Float32\" Name=\"other\" NumberOfComponents=\"1\" format=\"ascii\">7 "
         "8</DataArray>\n<DataArray type=\"Float64\" Name=\"fibre\" NumberOfComponents=\"" +
         components + "\" format=\"" + format + "\">" + content +
         "</DataArray>\n</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: vectors of cells are read from lines of text and refused by line") {
    const auto read = [](const std::string& text, Index cells) {
      const Written file("cells.txt", text);
      return io::read_cell_vectors(file.path, 2, cells);
    };
    const auto v = read("# two families\n1 0 0  0 1 0\n\n0.6 0.8 0 nan 0 -1e0\n", 2);
    REQUIRE(v.size() == 2);
    CHECK(v[0].col(1) == Vec3(0.6, 0.8, 0));
    CHECK(v[1].col(0) == Vec3(0, 1, 0));
    CHECK(std::isnan(v[1](0, 1)));
    CHECK(says(refusal([&] { (void)read("1 0 0 0 1 0\n1 0 0 0 1\n", 2); }), "line 2"));
    CHECK(says(refusal([&] { (void)read("1 0 0 0 1 0\n1 0 0 0 1\n", 2); }), "5 numbers for cell 1"));
    CHECK(says(refusal([&] { (void)read("1 0 0 0 1 0 4\n", 1); }), "end of the line"));
    CHECK(says(refusal([&] { (void)read("1 0 x 0 1 0\n", 1); }), "\"x\""));
    CHECK(says(refusal([&] { (void)read("1 0 0 0 1 0\n", 2); }), "the mesh has 2 cells"));
    CHECK(says(refusal([&] { (void)read("1 0 0 0 1 0\n1 0 0 0 1 0\n", 1); }), "a line more"));
    CHECK(says(refusal([] { (void)io::read_cell_vectors("/no/such/file", 1, 1); }), "no such file"));
  }

  TEST_CASE("io: cell arrays of VTU files come back with their bits") {
    Points<3> fibre(3, 2);
    fibre << 0.1, -0.7, 1 / 3.0, 0.2, std::nan(""), 1e-300;
    const Eigen::Matrix3Xf single = fibre.cast<float>();
    const Written file("fibres.vtu", "");
    io::write_vtu(file.path, two_tets(), {.cells = {{"fibre", fibre}, {"single", single}}});
    const auto back = io::read_vtu_cell_vectors(file.path, "fibre");
    REQUIRE(back.cols() == 2);
    for (int k = 0; k < 6; ++k) CHECK((back.data()[k] == fibre.data()[k] || std::isnan(fibre.data()[k])));
    CHECK(std::isnan(back(2, 0)));
    CHECK(io::read_vtu_cell_vectors(file.path, "single")(1, 1) == static_cast<double>(single(1, 1)));
    const auto text = refusal([&] { (void)io::read_vtu_cell_vectors(file.path, "fibres"); });
    CHECK(says(text, "no \"fibres\"; there are: fibre, single"));
  }

  TEST_CASE("io: cell arrays as text and base64 are read and bad ones refused") {
    const auto read = [](const std::string& text) {
      const Written file("cells.vtu", text);
      return io::read_vtu_cell_vectors(file.path, "fibre");
    };
    Points<3> want(3, 2);
    want << 1, 0, 0, 0.5, 0, -2;
    CHECK(read(vtu("ascii", "1 0 0\n 0 0.5 -2")) == want);
    // 48 bytes behind a header of 4: encoded apart (with padding between) and as one.
    const std::string body = "AAAAAAAA8D8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAADgPwAAAAAAAADA";
    CHECK(read(vtu("binary", "MAAAAA==" + body)) == want);
    CHECK(read(vtu("binary", "MAAAAAAAAAAAAPA/AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA4D8AAAAAAAAAwA==")) ==
          want);

    const auto why = [&](const std::string& text) { return refusal([&] { (void)read(text); }); };
    CHECK(says(why(vtu("ascii", "1 0 0 0 0.5")), "end of the file"));
    CHECK(says(why(vtu("ascii", "1 0 0 0 0.5 -2 3")), "more numbers"));
    CHECK(says(why(vtu("ascii", "1 0", "1")), "NumberOfComponents"));
    CHECK(says(why(vtu("binary", "MAAAAA==" + body.substr(0, 32))), "24 bytes, expected 48"));
    CHECK(says(why(vtu("binary", "MA*AAA==")), "not base64"));
    CHECK(says(why(vtu("appended", "")), "format"));
    CHECK(says(why(vtu("ascii", "1 0 0 0 .5 -2", "3", " compressor=\"vtkZLibDataCompressor\"")), "compress"));
    CHECK(says(why("nothing of the kind"), "no UnstructuredGrid"));
  }
}
