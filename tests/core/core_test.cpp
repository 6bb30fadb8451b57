// SPDX-License-Identifier: MIT
// Units, contracts, errors, texts of numbers, the solve report and boxes: the small headers of core.
#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"
#include "tunica/core/units.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>
#include <string>

using namespace tunica;

TEST_SUITE("unit") {
  TEST_CASE("core: literals give SI to the last bit") {
    using namespace tunica::literals;
    static_assert(1.5_mm == 1.5e-3);
    static_assert(2_m == 2.0);
    static_assert(158_um == 158e-6);
    static_assert(3_ms == 3e-3);
    static_assert(1_s == 1.0);
    static_assert(174_kPa == 174e3);
    static_assert(57.69_kPa == 57690.0);
    static_assert(348_MPa == 348e6);
    static_assert(10_Pa == 10.0);
    static_assert(1050_kg_m3 == 1050.0);
    static_assert(3.5_mPas == 0.0035);
    static_assert(1_Pas == 1000_mPas);
    static_assert(0.4_m_s == 0.4);
    // 1 mmHg = 13595.1 kg/m3 * 9.80665 m/s2 * 1 mm
    CHECK(80_mmHg == doctest::Approx(80 * 13595.1 * 9.80665 * 1e-3).epsilon(1e-12));
  }

  TEST_CASE("core: a broken precondition says its sentence and its condition") {
    const double det = -1;
    const auto check = [&] { TUNICA_EXPECT(det > 0, "inverted cell"); };
    CHECK_THROWS_WITH_AS(check(), "inverted cell (det > 0)", ContractError);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto check_nan = [&] { TUNICA_EXPECT(nan > 0, "not a number"); };
    CHECK_THROWS_AS(check_nan(), ContractError);
    CHECK_NOTHROW([] { TUNICA_EXPECT(true, "never"); }());
  }

  TEST_CASE("core: an input error names what and where and what was found") {
    const InputError e("a.vtk", "line 5", "SPACING 0");
    CHECK(std::string(e.what()) == "a.vtk: line 5: SPACING 0");
  }

  TEST_CASE("core: numbers in messages have seven digits in any unit") {
    CHECK(seven_digits(0.08) == "0.08");
    CHECK(seven_digits(1.0 / 3) == "0.3333333");
    CHECK(seven_digits(1e-9) == "1e-09");
    CHECK(seven_digits(1e300) == "1e+300");
    CHECK(place({221.484, 0, -1e-6}) == "(221.484, 0, -1e-06)");
  }

  TEST_CASE("core: the shortest text of a number reads back to it") {
    CHECK(number_text(1299.5) == "1299.5");
    CHECK(number_text(1e6) == "1e6");
    CHECK(number_text(0.1 + 0.2) == "0.30000000000000004");
    for (const double x : {1e-300, -1.0 / 3, 2e22, 5e-324})
      CHECK(std::strtod(number_text(x).c_str(), nullptr) == x);
  }

  TEST_CASE("core: a solve report is true only when converged") {
    CHECK(SolveReport{.status = Status::converged});
    for (const Status s : {Status::stalled, Status::diverged, Status::max_iterations})
      CHECK(!SolveReport{.status = s});
    CHECK(!SolveReport{});  // nobody has converged by forgetting to say so
    CHECK(name(Status::converged) == "converged");
    CHECK(name(Status::stalled) == "stalled");
    CHECK(name(Status::diverged) == "diverged");
    CHECK(name(Status::max_iterations) == "max_iterations");
  }

  TEST_CASE("core: a box is empty until it is extended") {
    Box box;
    Box other;
    other.extend(Vec3(1, 2, 3));
    CHECK(!box.overlaps(other));
    box.extend(other);
    CHECK(box.diagonal() == 0);
    CHECK(box.overlaps(other));  // touching counts
    box.extend(Vec3(-1, 0, 3));
    CHECK(box.centre() == Vec3(0, 1, 3));
    CHECK(box.squared_distance(Vec3(0, 1, 3)) == 0);
    CHECK(box.squared_distance(Vec3(3, 1, 5)) == 8);
    Box beside;
    beside.extend(Vec3(1.1, 2, 3));
    CHECK_FALSE(box.overlaps(beside));
  }
}
