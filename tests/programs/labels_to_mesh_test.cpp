// SPDX-License-Identifier: MIT
// The program on label images: materials with names and volumes, and every wrong use.
#include "programs/run_program.hpp"
#include "support/label_images.hpp"
#include "support/shared.hpp"
#include "tunica/io/vtk_image_write.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

using namespace tunica::test;

TEST_SUITE("job") {
  TEST_CASE("labels_to_mesh: a tube with a wall gets its materials and caps") {
    const auto checker = shared("tools/check_mesh.py");
    if (!checker || program("labels_to_mesh").empty()) return;
    const Folder folder;
    const auto labels = label_image({12, 12, 10}, {1, 1, 1}, [](const tunica::Vec3& x) {
      const double r = std::hypot(x[0] - 5.5, x[1] - 5.5);
      return r < 3 ? 1 : r < 5 ? 2 : 0;
    });
    tunica::io::write_vtk_image(folder.path() / "labels.vtk", labels);
    const auto o = run(folder, program("labels_to_mesh") +
                                   " labels.vtk --name 1=lumen --name 2=wall -o a.vtu --report r.json");
    INFO(o.err);
    REQUIRE(o.status == 0);
    const std::string report = text_of(folder.path() / "r.json");
    CHECK(figure(report, {"fill", "inverted"}) == 0);
    CHECK(figure(report, {"fill", "smallest_dihedral_degrees"}) >= 12);
    CHECK(figure(report, {"fill", "volume_against_voxels"}) < 1e-9);
    for (const char* name : {"lumen|wall", "lumen|border z0", "wall|outside", "wall|border z1"})
      CHECK(has(report, std::string("\"") + name + "\""));
    CHECK(has(text_of(folder.path() / "a.vtu"), "Name=\"material\""));
    CHECK(has(text_of(folder.path() / "a.surface.vtp"), "Name=\"patch\""));
    CHECK(has(o.out, "wrote a.vtu, a.surface.vtp, r.json"));
    CHECK(faults(*checker, folder, "a.vtu") == "");
  }

  TEST_CASE("labels_to_mesh: the phantom needs no file") {
    const auto checker = shared("tools/check_mesh.py");
    if (!checker || program("labels_to_mesh").empty()) return;
    const Folder folder;
    const auto o =
        run(folder, program("labels_to_mesh") +
                        " phantom --name 1=lumen --name 2=thrombus --name 3=wall --edge 2 -o a.vtu");
    INFO(o.err);
    REQUIRE(o.status == 0);
    CHECK(faults(*checker, folder, "a.vtu") == "");
  }

  TEST_CASE("labels_to_mesh: wrong uses and images without labels end with their sentence") {
    if (program("labels_to_mesh").empty()) return;
    const Folder folder;
    auto labels = label_image({4, 4, 4}, {1, 1, 1}, [](const tunica::Vec3&) { return 0; });
    tunica::io::write_vtk_image(folder.path() / "empty.vtk", labels);
    labels.values[21] = -3;
    tunica::io::write_vtk_image(folder.path() / "negative.vtk", labels);
    const auto fails = [&](const std::string& words, int status, const std::string& part) {
      CAPTURE(words);
      const auto o = run(folder, program("labels_to_mesh") + " " + words);
      CHECK(o.status == status);
      CHECK(has(o.err, part));
    };
    int value = 0;
    tunica::io::write_vtk_image(
        folder.path() / "grey.vtk",
        label_image({12, 12, 12}, {1, 1, 1}, [&](const tunica::Vec3&) { return ++value; }));
    fails("empty.vtk", 1, "no voxel of the image has a label");
    fails("negative.vtk", 1, "no label");
    fails("grey.vtk", 1, "the image has 1728 different values");
    fails("empty.vtk --name 1", 2, "N=TEXT");
    fails("empty.vtk --edge 0", 2, "more than 0");
    fails("empty.vtk --sweeps -1", 2, "from 0 to 1000");
    CHECK(folder.files().size() == 3);
  }
}
