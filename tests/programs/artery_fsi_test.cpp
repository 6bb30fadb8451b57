// SPDX-License-Identifier: MIT
// The coupled program: what it leaves, that a kill costs nothing, what it refuses, the real volume.
#include "programs/run_program.hpp"
#include "support/shared.hpp"
#include "support/vtk_python.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace tunica::test;
namespace fs = std::filesystem;

namespace {

const std::string real_cuts =
    " --seed 30,73,15 --cut 221.567,165.000,22.215,0.0011,0.9996,-0.0283"
    " --cut 207.554,94.976,33.243,-0.2769,-0.9166,0.2883 --cut 237.629,95.025,31.872,0.2506,-0.8866,0.3888";

/// The bytes of a file of a run; of a report without the seconds, which stand last in it.
std::string bytes(const fs::path& file) {
  std::string text = text_of(file);
  if (file.filename() == "report.json") text.resize(std::min(text.size(), text.find("\"seconds\"")));
  return text;
}

/// Names of the files that are not the same in both folders.
std::vector<std::string> differing(const fs::path& a, const fs::path& b) {
  std::set<std::string> names;
  for (const auto& folder : {a, b})
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  std::vector<std::string> found;
  for (const auto& name : names)
    if (!fs::exists(a / name) || !fs::exists(b / name) || bytes(a / name) != bytes(b / name))
      found.push_back(name);
  return found;
}

}  // namespace

TEST_SUITE("job") {
  TEST_CASE("artery_fsi: a short run leaves its two series and its figures") {
    const auto artery = program("artery_fsi");
    if (artery.empty()) return;
    const Folder folder;
    const auto done = run(folder, artery + " --edge 3 --end 0.02 --out r --report figures.json");
    INFO(done.err);
    REQUIRE(done.status == 0);
    for (const std::string mesh : {"lumen", "wall"}) {
      CHECK(fs::exists(folder.path() / "r" / (mesh + ".pvd")));
      for (int k = 0; k <= 20; ++k) {
        char name[32];
        std::snprintf(name, sizeof name, "%s_%06d.vtu", mesh.c_str(), k);
        CHECK(fs::exists(folder.path() / "r" / name));
        CHECK(has(text_of(folder.path() / "r" / (mesh + ".pvd")), name));
      }
    }
    const auto report = text_of(folder.path() / "r" / "report.json");
    CHECK(report == text_of(folder.path() / "figures.json"));
    CHECK(figure(report, {"run", "frames"}) == 21);
    CHECK(figure(report, {"run", "steps"}) == 20);
    CHECK(figure(report, {"run", "step_halvings"}) == 0);
    CHECK(figure(report, {"run", "iterations_mean"}) >= 1);
    CHECK(figure(report, {"run", "peak_displacement_m"}) > 1e-5);
    CHECK(figure(report, {"run", "peak_von_mises_Pa"}) > 1e3);
    CHECK(figure(report, {"run", "worst_dihedral_degrees"}) > 5);
    CHECK(figure(report, {"run", "mass_residual"}) < 1e-8);
    CHECK(figure(report, {"seconds", "flow"}) > 0);
    CHECK(figure(report, {"cpu_seconds", "flow"}) > 0);
    for (const std::string line : {"cells", "worst quality", "iterations per step", "peak displacement",
                                   "peak wall stress", "peak velocity", "mass defect", "wall dynamics"})
      CHECK(has(done.out, line));
  }

  TEST_CASE("artery_fsi: VTK reads the frames of a run") {
    const auto artery = program("artery_fsi");
    const auto python = vtk_python();
    if (artery.empty() || !python) return;
    const Folder folder;
    REQUIRE(run(folder, artery + " --edge 3 --end 0.003 --out r").status == 0);
    std::ofstream(folder.path() / "read.py") << R"(import vtk, glob
for name in sorted(glob.glob("r/*.vtu")):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    lumen = "lumen" in name
    assert grid.GetNumberOfCells() > 100, name
    assert grid.GetCellType(0) == (10 if lumen else 12), name
    for array in (["velocity", "pressure", "displacement"] if lumen else ["displacement", "von_mises"]):
        data = grid.GetPointData().GetArray(array)
        assert data and data.GetNumberOfTuples() == grid.GetNumberOfPoints(), (name, array)
    assert lumen or grid.GetCellData().GetArray("von_mises"), name
    size = grid.GetBounds()
    assert 0.05 < size[3] - size[2] < 0.1, size
print("read", len(glob.glob("r/*.vtu")))
)";
    const auto read = run(folder, *python + " read.py");
    INFO(read.err);
    CHECK(read.status == 0);
    CHECK(has(read.out, "read 8"));
  }

  TEST_CASE("artery_fsi: killed at any moment and restarted it ends as the unbroken run") {
    const auto artery = program("artery_fsi");
    if (artery.empty()) return;
    const Folder folder;
    const std::string options = " --edge 3 --end 0.012 --checkpoint 3";
    REQUIRE(run(folder, artery + options + " --threads 1 --out unbroken").status == 0);
    for (const std::string threads : {"1", "2"}) {
      CAPTURE(threads);
      const std::string again = artery + options + " --threads " + threads + " --out broken --restart";
      fs::remove_all(folder.path() / "broken");
      // before there is a mesh, then soon after some frames were there
      const auto early = run(folder, "timeout -s KILL 0.3 " + again);
      CHECK(early.status != 0);
      CHECK(has(early.err, "no checkpoint in broken: starting from the beginning"));
      int kills = 0;
      for (const int frame : {1, 4, 5, 8, 10}) {
        char command[512];
        std::snprintf(
            command, sizeof command,
            "sh -c '%s & p=$!; until [ -e broken/wall_%06d.vtu ] || ! kill -0 $p; do sleep 0.01; done; "
            "sleep 0.0%d; kill -9 $p; wait $p'",
            again.c_str(), frame, (7 * frame) % 4);
        if (run(folder, command).status == 137) ++kills;
      }
      MESSAGE("killed " << kills << " times while it stepped on " << threads << " threads");
      CHECK(kills >= 3);
      const auto last = run(folder, again);
      INFO(last.err);
      REQUIRE(last.status == 0);
      CHECK(differing(folder.path() / "unbroken", folder.path() / "broken").empty());
    }
  }

  TEST_CASE("artery_fsi: a finished run is left alone and another run is refused") {
    const auto artery = program("artery_fsi");
    if (artery.empty()) return;
    const Folder folder;
    const std::string options = " --edge 3 --end 0.002 --out r";
    REQUIRE(run(folder, artery + options).status == 0);
    const auto report = text_of(folder.path() / "r" / "report.json");
    const auto finished = run(folder, artery + options + " --restart");
    CHECK(finished.status == 0);
    CHECK(has(finished.out, "is finished"));
    CHECK(text_of(folder.path() / "r" / "report.json") == report);
    for (const std::string other : {" --smooth 3", " --dt 0.0005", " --iso 1290"}) {
      const auto refused = run(folder, artery + options + other + " --restart");
      CHECK(refused.status == 1);
      CHECK(has(refused.err, "made from another input or with other options"));
    }
    std::ofstream(folder.path() / "r" / "checkpoint", std::ios::binary | std::ios::in)
        .seekp(5000)
        .write("damage", 6);
    const auto damaged = run(folder, artery + options + " --restart");
    CHECK(damaged.status == 1);
    CHECK(has(damaged.err, "damaged"));
    // without --restart a folder is used again, and files that are not of a run stay
    std::ofstream(folder.path() / "r" / "lumen_notes.vtu") << "mine";
    std::ofstream(folder.path() / "r" / "wall_000009.vtu") << "of an earlier run";
    REQUIRE(run(folder, artery + options).status == 0);
    CHECK(text_of(folder.path() / "r" / "lumen_notes.vtu") == "mine");
    CHECK_FALSE(fs::exists(folder.path() / "r" / "wall_000009.vtu"));
  }

  TEST_CASE("artery_fsi: wrong use exits 2 and bad input 1 and neither leaves a file") {
    const auto artery = program("artery_fsi");
    if (artery.empty()) return;
    const Folder folder;
    CHECK(run(folder, artery + " --help").status == 0);
    for (const std::string wrong :
         {" --dt 0", " --dt -1", " --end 0.0105", " --end nan", " --size huge", " --checkpoint 0",
          " --edge 0", " --fill none", " --restart=yes", " --thread 2", " --edge", " a b", " nothing.vtk",
          " nothing.vtk --iso 3"}) {
      CAPTURE(wrong);
      const auto o = run(folder, artery + wrong + " --out r");
      CHECK(o.status == 2);
      CHECK(o.err.rfind("error: ", 0) == 0);
    }
    const std::string two = " --iso 3 --cut 0,0,0,1,0,0 --cut 1,0,0,1,0,0 --out r";
    const auto missing = run(folder, artery + " nothing.vtk" + two);
    CHECK(missing.status == 1);
    CHECK(has(missing.err, "nothing.vtk"));
    const auto nowhere = run(folder, artery + " --edge 3 --end 0.001 --cut 0,0,0,0,1,0 --out r");
    CHECK(nowhere.status == 1);
    // a report that cannot be written is told of before anything else, with its name
    for (const std::string report : {"no/such/folder/f.json", ".", "r/deeper/f.json"}) {
      CAPTURE(report);
      const auto o = run(folder, artery + " --out r --report " + report);
      CHECK(o.status == 1);
      CHECK(o.err.rfind("error: " + report, 0) == 0);
    }
    CHECK(folder.files().empty());
  }

  TEST_CASE("artery_fsi: the real bifurcation to 0.1 s without a failed step") {
    const auto image = shared("data/aorta_bifurcation.vtk");
    const auto artery = program("artery_fsi");
    if (!image || artery.empty()) return;
    const Folder folder;
    const auto done =
        run(folder, artery + " \"" + image->string() + "\" --iso 1299.5" + real_cuts + " --out r");
    INFO(done.err);
    REQUIRE(done.status == 0);
    const auto report = text_of(folder.path() / "r" / "report.json");
    MESSAGE(done.out);
    CHECK(figure(report, {"run", "frames"}) == 21);
    CHECK(figure(report, {"run", "step_halvings"}) == 0);
    CHECK(figure(report, {"run", "mass_residual"}) < 1e-8);
    CHECK(figure(report, {"run", "mass_defect"}) < 1e-8);
    CHECK(figure(report, {"run", "worst_dihedral_degrees"}) > 5);
  }
}

TEST_SUITE("slow") {
  TEST_CASE("artery_fsi: no mass is lost on a coarse or on a fine mesh") {
    const auto artery = program("artery_fsi");
    if (artery.empty()) return;
    std::vector<std::string> inputs{""};  // the phantom
    if (const auto image = shared("data/aorta_bifurcation.vtk"))
      inputs.push_back(" \"" + image->string() + "\" --iso 1299.5" + real_cuts);
    for (const auto& input : inputs) {
      CAPTURE(input);
      const Folder folder;
      for (const int k : {0, 1}) {
        const auto done = run(folder, artery + input + (k == 0 ? " --edge 2" : " --edge 1") + " --out r");
        INFO(done.err);
        REQUIRE(done.status == 0);
        MESSAGE(done.out);
        const auto report = text_of(folder.path() / "r" / "report.json");
        CHECK(figure(report, {"run", "step_halvings"}) == 0);
        CHECK(figure(report, {"run", "mass_residual"}) < 1e-8);
        const double largest = figure(report, {"run", "mass_defect"});
        MESSAGE("mass defect: largest of the steps " << largest << " mean "
                                                     << figure(report, {"run", "mass_defect_mean"}));
        CHECK(largest < 1e-8);  // of the linear solvers: no order in the mesh is left
      }
    }
  }

  TEST_CASE("artery_fsi: the size of the paper on the real bifurcation") {
    const auto image = shared("data/aorta_bifurcation.vtk");
    const auto artery = program("artery_fsi");
    if (!image || artery.empty()) return;
    const Folder folder;
    const auto done = run(
        folder, artery + " \"" + image->string() + "\" --iso 1299.5" + real_cuts + " --size paper --out r");
    INFO(done.err);
    REQUIRE(done.status == 0);
    MESSAGE(done.out);
    const auto report = text_of(folder.path() / "r" / "report.json");
    CHECK(figure(report, {"run", "tetrahedra"}) == doctest::Approx(74000).epsilon(0.1));
    CHECK(figure(report, {"run", "hexahedra"}) == doctest::Approx(3000).epsilon(0.1));
    CHECK(figure(report, {"run", "step_halvings"}) == 0);
    CHECK(figure(report, {"run", "mass_residual"}) < 1e-8);
    CHECK(figure(report, {"run", "mass_defect"}) < 1e-8);
    CHECK(figure(report, {"run", "worst_dihedral_degrees"}) > 5);
  }
}
