// SPDX-License-Identifier: MIT
#include "tunica/io/vtk_image.hpp"
#include "tunica/core/text.hpp"

#include "tunica/image/sampling.hpp"
#include "tunica/io/vtk_image_write.hpp"

#include "support/shared.hpp"

#include <doctest/doctest.h>

#include <unistd.h>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

using namespace tunica;

namespace {

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("tunica_vtk_" + std::to_string(::getpid()) + "_" + name);
}

template <class T = float>
std::string refusal(const std::string& bytes, const io::VtkImageOptions& options = {}) {
  try {
    (void)io::parse_vtk_image<T>("f.vtk", bytes, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string head = "# vtk DataFile Version 3.0\ntitle\n";
const std::string grid = "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 1\nSPACING 1 2 3\nORIGIN 10 20 30\n";

template <class T>
std::string big(const std::vector<T>& values) {
  std::string out;
  io::detail::append_big_endian(out, values);
  return out;
}

template <class S>
void check_type(const std::string& name, const std::vector<S>& values) {
  std::string ascii =
      head + "ASCII\n" + grid + "POINT_DATA 6\nSCALARS s " + name + "\nLOOKUP_TABLE default\n";
  for (const S v : values) ascii += number_text(static_cast<double>(v)) + " ";
  const std::string binary = head + "BINARY\n" + grid + "POINT_DATA 6\nSCALARS s " + name +
                             " 1\nLOOKUP_TABLE default\n" + big(values) + "\n";
  for (const std::string& bytes : {ascii, binary}) {
    const auto r = io::parse_vtk_image<double>("f.vtk", bytes);
    REQUIRE(r.image.values.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) CHECK(r.image.values[i] == static_cast<double>(values[i]));
    CHECK(r.stored == io::scalar_type_of<S>());
    CHECK(r.image.axes[1] == std::vector<double>{20, 22});
  }
  CHECK(has(refusal<double>(binary.substr(0, binary.size() - 2)),
            "expected " + std::to_string(6 * sizeof(S)) + " bytes of scalar data, got " +
                std::to_string(6 * sizeof(S) - 1)));
  CHECK(has(refusal<double>(ascii.substr(0, ascii.find_last_of(' ', ascii.size() - 2) + 1)),
            "expected 6 values"));
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: every scalar type of VTK images is read from text and from bytes") {
    check_type<std::int8_t>("char", {-128, -1, 0, 1, 2, 127});
    check_type<std::uint8_t>("unsigned_char", {0, 1, 2, 3, 4, 255});
    check_type<std::int16_t>("short", {-32768, -1, 0, 1, 2, 32767});
    check_type<std::uint16_t>("unsigned_short", {0, 1, 2, 3, 4, 65535});
    check_type<std::int32_t>("int", {-2147483647, -1, 0, 1, 2, 2147483647});
    check_type<std::int32_t>("vtkIdType", {-2147483647, -1, 0, 1, 2, 2147483647});
    check_type<std::uint32_t>("unsigned_int", {0, 1, 2, 3, 4, 4294967295u});
    check_type<std::int64_t>("long", {-(std::int64_t{1} << 50), -1, 0, 1, 2, 3});
    check_type<std::int64_t>("vtktypeint64", {-(std::int64_t{1} << 50), -1, 0, 1, 2, 3});
    check_type<std::uint64_t>("unsigned_long", {0, 1, 2, 3, 4, std::uint64_t{1} << 50});
    check_type<std::uint64_t>("vtktypeuint64", {0, 1, 2, 3, 4, std::uint64_t{1} << 50});
    check_type<float>("float", {-1.5f, 1e-30f, 0, 1, 2, 3e38f});
    check_type<double>("double", {-1.5, 1e-300, 0, 1, 2, 3e300});
  }

  TEST_CASE("io: a VTK image is read in any order of its attributes") {
    const std::vector<short> s{1, 2, 3, 4, 5, -6};
    const auto expect = [&](const std::string& bytes, const std::string& name,
                            const io::VtkImageOptions& how = {}) {
      const auto r = io::parse_vtk_image<short>("f.vtk", bytes, how);
      CHECK(r.image.values == s);
      CHECK(r.array == name);
      CHECK(r.image.position({2, 1, 0}) == Vec3(12, 22, 30));
    };
    const std::string vectors = "VECTORS v float\n" + std::string(6 * 12, 'x') + "\n";
    const std::string scalars = "SCALARS s short\nLOOKUP_TABLE t\n" + big(s) + "\n";
    const std::string metadata = "METADATA\nINFORMATION 1\nNAME a LOCATION b\nDATA 1 2\n\n";
    const std::string field = "FIELD FieldData 2\na 1 6 short\n" + big(s) + "\n" + metadata +
                              "b 2 3 string\n" + std::string("\xc1x\xc0\xc2yz\x80\x41", 8) +
                              std::string(65, 'q') + "\xc0\xc0" + "\n";
    expect(head + "BINARY\n" + grid +
               "CELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\nabcd\nPOINT_DATA 6\n" + vectors +
               scalars + metadata + "LOOKUP_TABLE t 2\nabcdefgh\n",
           "s");
    expect(head +
               "BINARY\nDATASET STRUCTURED_POINTS\nORIGIN 10 20 30\nASPECT_RATIO 1 2 3\nDIMENSIONS 3 2 1\n"
               "FIELD f 1\nt 1 1 double\n12345678\nPOINT_DATA 6\nCOLOR_SCALARS c 3\n" +
               std::string(18, 'c') + "\n" + field + scalars + "NORMALS n double\n" + std::string(144, 'n') +
               "\nTEXTURE_COORDINATES t 2 float\n" + std::string(48, 't') + "\nTENSORS t float\n" +
               std::string(216, 't') + "\nCELL_DATA 2\nSCALARS bits bit\nLOOKUP_TABLE default\nb\n",
           "a");
    expect(head + "BINARY\n" + grid + "POINT_DATA 6\n" + field + scalars, "s", {.array = "s"});
    expect(head + "ASCII\n" + grid + metadata + "POINT_DATA 6\nSCALARS s short 1\n1 2 3\n4 5 -6\n" +
               metadata + "CELL_DATA 2\nFIELD f 2\na 1 2 string\nhello world\nb\nc 1 2 int\n1 2\n",
           "s");
    expect(
        "# vtk DataFile Version 5.1\r\nt\r\nBINARY\r\nDATASET RECTILINEAR_GRID\r\nDIMENSIONS 3 2 1\r\n"
        "X_COORDINATES 3 double\r\n" +
            big(std::vector<double>{10, 10.5, 12}) + "\r\nY_COORDINATES 2 float\r\n" +
            big(std::vector<float>{20, 22}) + "\r\nZ_COORDINATES 1 int\r\n" + big(std::vector<int>{30}) +
            "\r\nPOINT_DATA 6\r\nSCALARS s short\r\nLOOKUP_TABLE default\r\n" + big(s) + "\r\n",
        "s");
  }

  TEST_CASE("io: a VTK image that is not whole or not exact is refused by place") {
    const std::string ascii = head + "ASCII\n" + grid;
    const std::string data = "POINT_DATA 6\nSCALARS s short\nLOOKUP_TABLE default\n1 2 3 4 5 6\n";
    CHECK(refusal(ascii + data).empty());
    CHECK(has(refusal(""), "f.vtk: file is empty"));
    CHECK(
        has(refusal("solid x"), "line 1 (byte 0): expected \"# vtk DataFile Version \", found \"solid x\""));
    CHECK(has(refusal(head + "TEXT\n"), "line 3"));
    CHECK(has(refusal(ascii), "no scalars"));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nVECTORS v int\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18"),
              "no scalars"));
    CHECK(has(refusal(ascii + data, {.array = "t"}), "no point array named \"t\""));
    CHECK(has(refusal(ascii + data + "junk"), "line 12"));
    CHECK(has(refusal(ascii + "POINT_DATA 7\n"), "DIMENSIONS product 6 != POINT_DATA 7"));
    CHECK(has(refusal(ascii + "CELL_DATA 3\n"), "number of cells 2 != CELL_DATA 3"));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nSCALARS s short\nLOOKUP_TABLE default\n1 2 x 4 5 6\n"),
              "line 11 (byte 166): expected value 2 of scalar data, found \"x\""));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nSCALARS s short\nLOOKUP_TABLE default\n1 2 3 4 5 70000\n"),
              "70000"));
    CHECK(
        has(refusal(ascii + "POINT_DATA 6\nSCALARS s short\nLOOKUP_TABLE default\n1 2 3 4 5 6.5\n"), "6.5"));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nSCALARS s float\nLOOKUP_TABLE default\n1 nan 3 -inf 5 6\n"),
              "2 values are not finite (1 NaN, 0 +Inf, 1 -Inf), the first at index 1"));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nSCALARS s int\nLOOKUP_TABLE default\n1 16777217 3 4 5 6\n"),
              "value 16777217 of scalar data 1 cannot be held exactly"));
    CHECK(has(refusal(ascii + "POINT_DATA 6\nSCALARS s int 9\n"), "1 to 4 components, found 9"));
    CHECK(
        has(refusal<short>(ascii + "POINT_DATA 6\nSCALARS s double\nLOOKUP_TABLE default\n1e300 2 3 4 5 6\n"),
            "cannot be held"));
    const auto dims = [&](const std::string& d) {
      return refusal(head + "ASCII\nDATASET STRUCTURED_POINTS\n" + d);
    };
    CHECK(has(dims("DIMENSIONS 65536 65536 1\n"), "overflows the limit of 2147483648 voxels"));
    CHECK(has(dims("DIMENSIONS 0 1 1\n"), "a dimension is 0 (0 x 1 x 1): no voxels"));
    CHECK(has(dims("DIMENSIONS -3 1 1\n"), "not negative"));
    CHECK(has(dims("DIMENSIONS 3 1\n"), "expected a dimension"));
    CHECK(has(dims("DIMENSIONS 99999999999999999999999 1 1\n"), "99999999999999999999999"));
    CHECK(has(dims("DIMENSIONS 2 2 2\nSPACING 1 0 1\n"), "spacing y is 0: cells have no volume"));
    CHECK(has(dims("DIMENSIONS 2 2 2\nSPACING 1 1 -1\n"), "spacing z is -1"));
    CHECK(has(dims("DIMENSIONS 2 2 2\nSPACING 1 1 nan\n"), "SPACING is not finite"));
    CHECK(has(dims("DIMENSIONS 2 2 2\nORIGIN 1e300 0 0\nPOINT_DATA 8\nSCALARS s char\n1 2 3 4 5 6 7 8\n"),
              "spacing x is lost"));
    const std::string eight = "POINT_DATA 8\nSCALARS s char\n1 2 3 4 5 6 7 8\n";
    CHECK(refusal(head + "ASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nSPACING 1e-30 1e29 1\n" +
                  eight) == "");
    CHECK(has(dims("DIMENSIONS 2 2 2\nSPACING 1 1 1e-100\n" + eight),
              "f.vtk: spacing z is 1e-100: lengths lie between 1e-30 and 1e+30"));
    CHECK(has(dims("DIMENSIONS 2 2 2\nSPACING 1 1e100 1\n" + eight),
              "f.vtk: coordinate y is 1e+100: lengths lie"));
    CHECK(has(refusal(head + "ASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nPOINT_DATA 1\nSCALARS s "
                             "double\n1e300\n"),
              "value 1e+300 of scalar data 0 cannot be held exactly"));
    CHECK(has(dims("POINT_DATA 8\n"), "before DIMENSIONS"));
    CHECK(has(dims("DIMENSIONS 2147483647 1 1\nPOINT_DATA 2147483647\nSCALARS s char\n1"),
              "room for at most 1"));
    CHECK(has(
        refusal(head + "BINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1024 1024 1024\nPOINT_DATA 1073741824\n"
                       "SCALARS s double\nLOOKUP_TABLE default\nxxxx"),
        "expected 8589934592 bytes of scalar data, got 4"));  // refused before 8 GB are asked for
    CHECK(has(
        refusal(head + "ASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1024 1024 1024\nPOINT_DATA 1073741824\n"
                       "SCALARS s double\nLOOKUP_TABLE default\n1 2"),
        "room for at most 2"));
    CHECK(
        has(refusal(head + "ASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 1\nX_COORDINATES 3 int\n1 1 2\n"),
            "do not increase at index 1"));
    CHECK(has(refusal(ascii + "FIELD f 1\na 4611686018427387904 4611686018427387904 int\n"), "overflows"));
    CHECK(has(refusal(ascii + "FIELD f 18446744073709551615\n"), "end of the file"));
  }

  TEST_CASE("io: a spoilt VTK image is read whole or refused and nothing else") {
    image::Image<short> image = image::sample<short>(
        image::Image<double>{{{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}}, std::vector<double>(27, 5.0)},
        {.size = {4, 3, 2}, .origin = Vec3::Zero(), .spacing = Vec3::Ones()});
    const auto path = scratch("spoilt.vtk");
    io::write_vtk_image(path, image);
    const std::string good = io::read_file(path);
    std::filesystem::remove(path);
    std::size_t refused = 0, read = 0;
    for (std::uint64_t k = 0; k < 20000; ++k) {
      std::string bad = good;
      const auto r = image::splitmix64(k);
      for (std::uint64_t n = 0; n <= r % 3; ++n) {
        const auto q = image::splitmix64(r + n);
        bad[(q >> 8) % bad.size()] = static_cast<char>(q);
      }
      if (r % 5 == 0) bad.resize((r >> 20) % bad.size());
      try {
        const auto v = io::parse_vtk_image<double>("f.vtk", bad);
        const auto& a = v.image.axes;
        REQUIRE(v.image.values.size() == a[0].size() * a[1].size() * a[2].size());
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
    MESSAGE(refused, " of 20000 spoilt files refused, ", read, " read (their samples or names were hit)");
    CHECK(refused > 5000);
  }

  TEST_CASE("io: images are written and read back to the bit") {
    const auto path = scratch("round.vtk");
    const auto round = [&]<class T>(const image::Image<T>& image) {
      io::write_vtk_image(path, image, {.title = "a title", .array = "mr"});
      const auto r = io::read_vtk_image<T>(path);
      CHECK(r.image.values == image.values);
      CHECK(r.image.axes == image.axes);
      CHECK(r.array == "mr");
      CHECK(r.stored == io::scalar_type_of<T>());
      std::filesystem::remove(path);
    };
    const auto fill = [](auto image) {
      for (std::size_t a = 0; a < 3; ++a)
        for (int i = 0; i < 5; ++i) image.axes[a].push_back(0.1 + 0.878906 * i);
      for (std::uint64_t i = 0; i < 125; ++i) {
        auto& v = image.values.emplace_back();
        v = static_cast<std::remove_reference_t<decltype(v)>>(image::splitmix64(i) % 120);
      }
      return image;
    };
    round(fill(image::Image<float>{}));
    round(fill(image::Image<double>{}));
    round(fill(image::Image<std::int8_t>{}));
    round(fill(image::Image<std::uint8_t>{}));
    round(fill(image::Image<short>{}));
    round(fill(image::Image<std::uint16_t>{}));
    round(fill(image::Image<std::int32_t>{}));
    round(fill(image::Image<std::int64_t>{}));
    auto uneven = fill(image::Image<float>{});
    uneven.axes[2] = {0, 1, 3, 3.5, 10};
    round(uneven);
    CHECK_THROWS_AS(io::write_vtk_image("/nonexistent/x.vtk", uneven), InputError);
    CHECK_THROWS_AS(io::write_vtk_image(path, image::Image<float>{}), InputError);
    CHECK(!std::filesystem::exists(path));
  }

  TEST_CASE("io: the real volume is read as it is described") {
    const auto path = test::shared("data/aorta_bifurcation.vtk");
    if (!path) return;
    const auto r = io::read_vtk_image<short>(*path);
    CHECK(r.image.size(0) == 68);
    CHECK(r.image.size(1) == 118);
    CHECK(r.image.size(2) == 34);
    CHECK(r.image({30, 73, 15}) == 1885);
    CHECK((r.image.position({30, 73, 15}) - Vec3(221.484, 150.293, 22.501)).norm() < 1e-3);
    CHECK(r.stored == io::ScalarType::int16);
    const auto copy = scratch("copy.vtk");
    io::write_vtk_image(
        copy, r.image,
        {.title = "aorto-iliac bifurcation, contrast MRA, crop of vmtk-test-data input/aorta.mha; mm; BSD"});
    CHECK(io::read_file(copy) == io::read_file(*path));  // we write it as it was written
    std::filesystem::remove(copy);
  }
}
