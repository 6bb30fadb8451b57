// SPDX-License-Identifier: MIT
// What the readers of VTK files are made of: words and their places, arrays, types, lengths.
#include "tunica/io/cursor.hpp"
#include "tunica/io/lengths.hpp"
#include "tunica/io/vtk_legacy.hpp"
#include "tunica/io/vtk_types.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("io: a cursor takes words whole and knows the line and the byte") {
    io::Cursor at("f", "12 -3\r\n1.5e3x\nend");
    CHECK(at.number<int>("a count") == 12);
    CHECK_THROWS_WITH_AS((void)at.number<unsigned>("a count"),
                         "f: line 1 (byte 3): expected a count (a whole number, not negative), found \"-3\"",
                         InputError);
    at.end_of_line();
    CHECK_THROWS_WITH_AS((void)at.number<double>("a length"),
                         "f: line 2 (byte 7): expected a length, found \"1.5e3x\"", InputError);
    CHECK(at.word_of_line().empty());
    CHECK(at.word() == "end");
    CHECK(at.at_end());
    CHECK_THROWS_AS((void)at.number<int>("more"), InputError);
    double value = 0;
    CHECK(io::parse_number("+2.5", value));
    CHECK(value == 2.5);
    for (const char* wrong : {"", "+", "+-1", "1e400", "0x10"}) CHECK_FALSE(io::parse_number(wrong, value));
  }

  TEST_CASE("io: the parts of a legacy file are passed over with their sizes held") {
    io::LegacyFile file("f", "# vtk DataFile Version 3.0\nt\nASCII\n1 2 3 4");
    CHECK_FALSE(file.binary);
    file.skip("Float", 2);
    CHECK(file.values<short>(file.type("INT"), 2, "values") == std::vector<short>{3, 4});
    CHECK_THROWS_AS(file.skip_words(1), InputError);
    CHECK_THROWS_AS((void)file.product(std::size_t(1) << 40, std::size_t(1) << 40), InputError);
    CHECK_THROWS_AS((void)file.type("complex"), InputError);
    io::LegacyFile bits("f", "# vtk DataFile Version 3.0\nt\nBINARY\nab\x40\x09");
    bits.skip("bit", 9);  // two bytes
    CHECK(bits.at.left() == 2);
    CHECK_THROWS_AS(bits.skip("double", std::size_t(1) << 62), InputError);  // 8 times as many overflow
  }

  TEST_CASE("io: names of scalar types read back and bytes turn round") {
    for (const auto& s : io::scalar_names) CHECK(io::scalar_type(io::legacy_name(s.type)) == s.type);
    CHECK(io::with_scalar(io::ScalarType::uint16, [](auto s) { return sizeof s; }) == 2);
    CHECK(io::scalar_type_of<unsigned char>() == io::ScalarType::uint8);
    CHECK(io::big_endian<std::uint16_t>("\x01\x02") == 0x0102);
    CHECK(io::big_endian<float>("\x3f\x80\x00\x00") == 1);
    CHECK(io::swapped_if_little(io::swapped_if_little(-2.5)) == -2.5);
  }

  TEST_CASE("io: lengths of which no volume can be made are refused by their name") {
    CHECK_NOTHROW(io::require_lengths("f", 'x', {-1e30, 0, 1e-30, 1e30}));
    CHECK_THROWS_WITH_AS(io::require_length("f", "spacing x", 0),
                         "f: spacing x is 0: lengths lie between 1e-30 and 1e+30", InputError);
    CHECK_THROWS_AS(io::require_lengths("f", 'y', {0, 1e31}), InputError);
    CHECK_THROWS_AS(io::require_lengths("f", 'y', {1, 1}), InputError);
    CHECK_THROWS_AS(io::require_length("f", "spacing x", std::nan("")), InputError);
  }
}
