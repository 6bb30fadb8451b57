// SPDX-License-Identifier: MIT
// The surfaces on which tetrahedra.py --table compares fillers, as OFF files: four of each family of the
// soak, and phantoms, tubes with blind branches and squeezed tori. soak_surfaces FOLDER
#include "support/off.hpp"
#include "support/soak.hpp"
#include "support/stubs.hpp"
#include "support/vessels.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

int main(int count, char** arguments) {
  using namespace tunica;
  if (count != 2) {
    std::fprintf(stderr, "usage: soak_surfaces FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  int written = 0;
  const auto write = [&](const std::string& family, int number, const mesh::Surface& s) {
    std::string name = family + "-" + std::to_string(number) + ".off";
    for (char& c : name)
      if (c == ' ') c = '_';
    if (bench::write_off(folder / name, s)) return void(++written);
    std::fprintf(stderr, "error: %s cannot be written\n", (folder / name).c_str());
  };
  int wanted = 0;
  constexpr std::array<std::uint64_t, 4> seeds{7, 13, 20, 34};
  for (const auto& family : test::soak::families())
    for (const auto seed : seeds) ++wanted, write(family.name, static_cast<int>(seed), family.make(seed));
  for (const int tenths : {10, 15, 20, 30})  // edges [0.1 mm]
    ++wanted, write("phantoms", tenths, test::vessels::bifurcation(0.1 * tenths));
  constexpr std::array<test::stubs::Branch, 4> branches{{{0.4, 3}, {1.5, 3}, {0.4, 1.5}, {1.5, 3, 0.6}}};
  for (int k = 0; k < 4; ++k)
    ++wanted, write("blind branches", k, test::stubs::tube(branches[static_cast<std::size_t>(k)], 1));
  for (const int thin : {10, 100, 1000, 10000})  // times as wide as high
    ++wanted,
        write("squeezed tori", thin, test::soak::stretched(test::torus(12, 40), Vec3(1, 1, 1.0 / thin)));
  std::printf("%d surfaces in %s\n", written, folder.c_str());
  return written == wanted ? 0 : 1;
}
