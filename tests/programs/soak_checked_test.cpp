// SPDX-License-Identifier: MIT
// The independent checker looks at a sample of the soak: fillings as files, against the surfaces that they
// fill.
#include "programs/run_program.hpp"
#include "support/filled.hpp"
#include "support/shared.hpp"
#include "support/soak.hpp"
#include "tunica/io/vtp.hpp"
#include "tunica/io/vtu.hpp"
#include "tunica/mesh/topology.hpp"
#include "tunica/meshing/intersections.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>

using namespace tunica;

TEST_SUITE("job") {
  TEST_CASE("meshing: the independent checker finds no fault in a sample of the soak") {
    const auto checker = test::shared("tools/check_mesh.py");
    if (!checker) return;
    int checked = 0;
    for (const auto& family : test::soak::families()) {
      if (family.broken) continue;
      const std::uint64_t seed = 3;
      const auto surface = family.make(seed);
      if (!mesh::topology(surface).closed() || !meshing::self_intersections(surface, 1).empty() ||
          !test::nested_outward(surface))
        continue;
      CAPTURE(std::string(family.name));
      const auto filled = meshing::tetrahedra(surface);
      const test::Folder folder;
      io::write_vtu(folder.path() / "a.vtu", filled.mesh);
      io::write_vtp(folder.path() / "a.surface.vtp", surface);
      CHECK(test::faults(*checker, folder, "a.vtu --surface a.surface.vtp --tol 0") == "");
      CHECK(test::faults(*checker, folder, "a.surface.vtp --closed") == "");
      ++checked;
    }
    MESSAGE(checked, " surfaces of as many families");
    CHECK(checked >= 12);
  }
}
