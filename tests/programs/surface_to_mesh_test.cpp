// SPDX-License-Identifier: MIT
// The program on surfaces from elsewhere: kept as given or remeshed, and every bad input.
#include "programs/run_program.hpp"
#include "support/shared.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace tunica::test;

namespace {

Outcome fill(const Folder& folder, const std::filesystem::path& surface, const std::string& options) {
  return run(folder, program("surface_to_mesh") + " \"" + surface.string() + "\"" + options +
                         " -o a.vtu --report r.json");
}

}  // namespace

TEST_SUITE("job") {
  TEST_CASE("surface_to_mesh: foreign surfaces are filled as they are given") {
    const auto checker = shared("tools/check_mesh.py"), level_set = shared("data/vmtk_levelset_surface.stl"),
               control = shared("data/bad/s00_control_closed.stl"),
               turned = shared("data/bad/s10_inside_out.stl"),
               solid = shared("data/bad/s08_binary_header_says_solid.stl");
    if (!checker || !level_set || !control || !turned || !solid || program("surface_to_mesh").empty()) return;
    const auto kept = [&](const std::filesystem::path& surface, double volume, bool was_turned) {
      CAPTURE(surface.string());
      const Folder folder;
      const auto o = fill(folder, surface, "");
      INFO(o.err);
      REQUIRE(o.status == 0);
      const std::string report = text_of(folder.path() / "r.json");
      MESSAGE(surface.filename().string(), ": ", figure(report, {"fill", "tetrahedra"}),
              " tetrahedra, smallest dihedral angle ", figure(report, {"fill", "smallest_dihedral_degrees"}),
              " degrees, smallest angle of the surface ",
              figure(report, {"fill", "surface_smallest_angle_degrees"}));
      CHECK(std::abs(figure(report, {"fill", "volume"}) - volume) < 1e-4 * volume);
      CHECK(figure(report, {"fill", "inverted"}) == 0);
      CHECK(has(o.err, "warning: ") == was_turned);
      CHECK(has(o.err, "inside out") == was_turned);
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
      if (!was_turned) CHECK(faults(*checker, folder, "a.vtu --surface \"" + surface.string() + "\"") == "");
    };
    kept(*level_set, 13184.27, true);
    kept(*control, 10089.94, false);
    kept(*solid, 10089.94, false);
    kept(*turned, 10089.94, true);
  }

  TEST_CASE("surface_to_mesh: a remeshed surface keeps its volume and its rims") {
    const auto checker = shared("tools/check_mesh.py"), lumen = shared("data/lumen_iso1299.5_clipped.stl");
    if (!checker || !lumen || program("surface_to_mesh").empty()) return;
    const Folder folder;
    const auto o = fill(folder, *lumen, " --edge 2");
    INFO(o.err);
    REQUIRE(o.status == 0);
    const std::string report = text_of(folder.path() / "r.json");
    MESSAGE("volume ", figure(report, {"fill", "volume"}), " mm3, smallest angle ",
            figure(report, {"surface", "smallest_angle_degrees"}), ", smallest dihedral angle ",
            figure(report, {"fill", "smallest_dihedral_degrees"}), " degrees");
    CHECK(std::abs(figure(report, {"fill", "volume"}) - 10154.17) < 0.005 * 10154.17);
    CHECK(figure(report, {"fill", "inverted"}) == 0);
    CHECK(figure(report, {"surface", "smallest_angle_degrees"}) >= 15);
    CHECK(figure(report, {"fill", "smallest_dihedral_degrees"}) >= 5);
    for (const auto& [name, area] :
         std::map<std::string, double>{{"flat 1", 171.70}, {"flat 2", 53.79}, {"flat 3", 48.04}})
      CHECK(std::abs(figure(report.substr(report.find(name)), {"area"}) - area) <
            1);  // the ends of the vessel
    CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
    // histograms and worst cells: in the report and as a table
    const auto three_digits = [](double value) {
      std::array<char, 32> digits{};
      std::snprintf(digits.data(), digits.size(), "%.3g", value);
      return std::string(digits.data());
    };
    const std::string angle = three_digits(figure(report, {"surface", "smallest_angle_degrees"})),
                      dihedral = three_digits(figure(report, {"fill", "smallest_dihedral_degrees"}));
    for (const std::string& part : std::vector<std::string>{
             "surface: smallest angle [degrees], least " + angle + ",", "\n  worst " + angle + " at (",
             "surface: mean ratio, least 0", "tetrahedra: scaled Jacobian, least 0", "\n  20 to 25 ",
             "tetrahedra: smallest dihedral angle [degrees], least " + dihedral + ",",
             "\n  worst " + dihedral + " at ("})
      CHECK_MESSAGE(has(o.out, part), part, " in\n", o.out);
    const std::string tets = report.substr(report.find("\"tetrahedra\": [", report.find("\"quality\"")));
    CHECK(has(tets, "\"figure\": \"smallest dihedral angle\""));
    CHECK(has(tets, "\"histogram\": ["));
    for (const auto& keys : {std::vector<std::string>{"least"}, {"worst", "value"}})
      CHECK(figure(tets, keys) ==
            doctest::Approx(figure(report, {"fill", "smallest_dihedral_degrees"})).epsilon(1e-9));
  }

  TEST_CASE("surface_to_mesh: the two real surfaces are filled as given and remeshed") {
    const auto checker = shared("tools/check_mesh.py"), lumen = shared("data/lumen_iso1299.5_clipped.stl"),
               level_set = shared("data/vmtk_levelset_surface.stl");
    if (!checker || !lumen || !level_set || program("surface_to_mesh").empty()) return;
    for (const auto& [surface, volume] :
         std::vector<std::pair<std::filesystem::path, double>>{{*lumen, 10154.17}, {*level_set, 13184.27}})
      for (const std::string options : {"", " --repair", " --edge 2"}) {
        CAPTURE(surface.string() + options);
        const Folder folder;
        const auto o = fill(folder, surface, options);
        INFO(o.err);
        REQUIRE(o.status == 0);
        const std::string report = text_of(folder.path() / "r.json");
        const double surface_angle = figure(report, {"fill", "surface_smallest_angle_degrees"}),
                     dihedral = figure(report, {"fill", "smallest_dihedral_degrees"});
        MESSAGE(surface.filename().string(), options, ": ", figure(report, {"fill", "tetrahedra"}),
                " tetrahedra, smallest angle of the surface ", surface_angle, ", smallest dihedral angle ",
                dihedral, ", 1st percentile ", figure(report, {"fill", "one_percent_dihedral_degrees"}));
        CHECK(std::abs(figure(report, {"fill", "volume"}) - volume) < 5e-4 * volume);
        CHECK(figure(report, {"fill", "inverted"}) == 0);
        CHECK(dihedral > (options == " --edge 2" ? 18 : surface_angle));
        CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
      }
  }

  TEST_CASE("surface_to_mesh: what can be repaired is repaired on request and told") {
    const auto checker = shared("tools/check_mesh.py"), fin = shared("data/bad/s01_nonmanifold_edge.stl"),
               hole = shared("data/bad/s02_open_hole.stl"), turned = shared("data/bad/s10_inside_out.stl");
    if (!checker || !fin || !hole || !turned || program("surface_to_mesh").empty()) return;
    const auto repaired = [&](const std::filesystem::path& surface, double share,
                              const std::string& sentence) {
      CAPTURE(surface.string());
      const Folder folder;
      const auto o = fill(folder, surface, " --repair");
      INFO(o.err);
      REQUIRE(o.status == 0);
      CHECK(has(o.err, sentence));
      const std::string report = text_of(folder.path() / "r.json");
      CHECK(has(report, sentence));
      CHECK(std::abs(figure(report, {"fill", "volume"}) - 10089.94) < share * 10089.94);
      CHECK(faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
    };
    repaired(*fin, 1e-5, "2 facets of flaps left out, the first at (219.55");
    // a corner of the inlet is missing: what stood out there is lost
    repaired(*hole, 5e-3, "a hole of 11 edges filled by ");
    repaired(*turned, 1e-5, "1 part that was inside out turned at (");
    const Folder folder;
    const auto o = fill(folder, *hole, " --repair --fill-holes 10");
    CHECK(o.status == 1);
    CHECK(has(o.err, "1 boundary loop: 11 edges around ("));
    CHECK(folder.files().empty());
  }

  TEST_CASE("surface_to_mesh: centre lines lead to the ends of the vessel") {
    const auto lumen = shared("data/lumen_iso1299.5_clipped.stl"),
               level_set = shared("data/vmtk_levelset_surface.stl");
    if (!lumen || !level_set || program("surface_to_mesh").empty()) return;
    const Folder folder;
    const auto o = fill(folder, *lumen, " --edge 2 --centre-line c.vtp");
    INFO(o.err);
    REQUIRE(o.status == 0);
    CHECK(folder.files() == std::set<std::string>{"a.vtu", "a.surface.vtp", "c.vtp", "r.json"});
    const std::string report = text_of(folder.path() / "r.json");
    CHECK(has(report, "\"root\": \"flat 1\""));
    for (const std::string end : {"flat 2", "flat 3"}) {
      const std::string branch = report.substr(report.find("\"end\": \"" + end + "\""));
      MESSAGE(end, ": ", figure(branch, {"length"}), " mm, radius from ", figure(branch, {"least_radius"}),
              " to ", figure(branch, {"largest_radius"}));
      CHECK(figure(branch, {"length"}) > 45);  // the fork is some 25 mm below the inlet, the ends at 70
      CHECK(figure(branch, {"length"}) < 56);
      CHECK(figure(branch, {"least_radius"}) > 3.2);  // of equal area: 4.14 and 3.91
      CHECK(figure(branch, {"least_radius"}) < 4.14);
    }
    const Folder blind;  // this one has no flat ends
    const auto none = fill(blind, *level_set, " --edge 2 --centre-line c.vtp");
    CHECK(none.status == 1);
    CHECK(has(none.err, "error: a centre line needs two ends or more"));
    CHECK(blind.files().empty());
    const auto two = fill(blind, *level_set,
                          " --edge 2 --centre-line c.vtp --end 222.1,175.87,21.67 --end 234.35,101.3,29");
    CHECK(two.status == 0);
    const double length = figure(text_of(blind.path() / "r.json"), {"centre_line", "length"});
    MESSAGE("between two blind ends: ", length, " mm");
    CHECK(length > 76);  // of the straight line
    CHECK(length < 1.1 * 76);
  }

  TEST_CASE("surface_to_mesh: every bad surface ends with its sentence and leaves no file") {
    const auto bad = shared("data/bad");
    if (!bad || program("surface_to_mesh").empty()) return;
    const auto refused = [&](const std::string& name, const std::string& options, int status,
                             const std::string& part) {
      CAPTURE(name);
      const Folder folder;
      const auto o = fill(folder, *bad / name, options);
      CAPTURE(o.err);
      CHECK(o.status == status);
      CHECK(has("\n" + o.err, "\nerror: "));
      CHECK(has(o.err, part));
      CHECK(folder.files().empty());
    };
    refused("s01_nonmanifold_edge.stl", "", 1, "is shared by 4 facets");
    refused("s02_open_hole.stl", "", 1, "1 boundary loop: 11 edges around (");
    refused("s04_ascii_junk.stl", "", 1, "line 31 ");
    refused("s06_truncated_binary.stl", "", 1,
            "says 1702 facets, the file holds 700 whole ones and 17 stray bytes");
    refused("s12_zero_facets.stl", "", 1, "0 facets");
    refused("none.stl", "", 1, "no such file");
    refused("v00_control_ok.vtk", "", 1, "the header says ");
    refused("s00_control_closed.stl", " --edge 0", 2, "--edge: must be more than 0");
    refused("s02_open_hole.stl", "", 1, "1 boundary loop: 11 edges around (");
    refused("s02_open_hole.stl", " --fill-holes 100", 2, "--fill-holes needs --repair");
    refused("s00_control_closed.stl", " --end 1,2,3", 2, "--end needs --centre-line");
    refused("s00_control_closed.stl", " --repair --fill-holes -1", 2, "--fill-holes: must not be negative");
    refused("s00_control_closed.stl", " --centre-line c.vtp --end 1,2", 2, "\"1,2\" is not X,Y,Z");
    refused("s00_control_closed.stl", " --egde 2", 2, "did you mean --edge?");
    refused("s00_control_closed.stl", " another.stl", 2, "unexpected argument \"another.stl\"");
  }

  TEST_CASE("surface_to_mesh: a limit on the size of files is an error and leaves no file") {
    const auto control = shared("data/bad/s00_control_closed.stl");
    if (!control || program("surface_to_mesh").empty()) return;
    const Folder folder;
    const auto o = run(folder, "(ulimit -f 20; exec " + program("surface_to_mesh") + " \"" +
                                   control->string() + "\" -o a.vtu)");
    CHECK(o.status == 1);
    CHECK(has(o.err, "error: a.vtu: cannot be written: "));
    CHECK(folder.files().empty());
  }
}
