// SPDX-License-Identifier: MIT
#include "tunica/io/atomic_file.hpp"
#include "tunica/io/read_file.hpp"

#include <unistd.h>

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

using namespace tunica;
namespace fs = std::filesystem;

namespace {

/// An empty folder that is removed at the end.
struct Place {
  fs::path path = fs::temp_directory_path() / ("tunica_atomic_" + std::to_string(::getpid()));
  Place() { fs::create_directories(path); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  ~Place() { fs::remove_all(path); }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(path), fs::directory_iterator{});
  }
};

std::string refusal(const fs::path& path, const std::string& bytes) {
  try {
    io::write_file(path, bytes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: a file appears whole or not at all") {
    const Place place;
    const auto file = place.path / "a.txt";
    io::write_file(file, "one");
    CHECK(io::read_file(file) == "one");
    {
      io::AtomicFile half(file);
      half.write("two");
    }  // never committed
    CHECK(io::read_file(file) == "one");
    CHECK(place.files() == 1);
    const std::string large(1u << 20, 'x');
    io::write_file(file, large);
    CHECK(io::read_file(file) == large);
    CHECK(place.files() == 1);
  }

  TEST_CASE("io: what cannot be written is refused by name and nothing is left") {
    const Place place;
    CHECK(refusal(place.path, "x") == place.path.string() + ": is a folder");
    const auto lost = place.path / "no" / "a.txt";
    CHECK(refusal(lost, "x") == lost.string() + ": cannot be written: No such file or directory");
    CHECK(place.files() == 0);
    if (fs::is_character_file("/dev/full")) {  // as a full disk
      CHECK(refusal("/dev/full", "x") == "/dev/full: cannot be written: No space left on device");
      CHECK(refusal("/dev/full", std::string(1u << 20, 'x')) != "");
      CHECK(fs::is_character_file("/dev/full"));
      CHECK_FALSE(fs::exists("/dev/full.part"));
    }
  }

  TEST_CASE("io: a device is written to and a link stays a link") {
    const Place place;
    if (fs::is_character_file("/dev/null")) {
      io::write_file("/dev/null", "x");
      CHECK(fs::is_character_file("/dev/null"));
    }
    io::write_file(place.path / "real.txt", "one");
    fs::create_symlink("real.txt", place.path / "link.txt");
    io::write_file(place.path / "link.txt", "two");
    CHECK(fs::is_symlink(place.path / "link.txt"));
    CHECK(io::read_file(place.path / "real.txt") == "two");
    CHECK(place.files() == 2);
  }

  TEST_CASE("io: whether a file can be written is known before it is and nothing is left") {
    const Place place;
    const auto file = place.path / "a.txt";
    io::expect_writable(file);
    CHECK(place.files() == 0);
    io::write_file(file, "one");
    io::expect_writable(file);
    CHECK(io::read_file(file) == "one");
    CHECK(place.files() == 1);
    io::expect_writable("/dev/null");
    const auto refused = [](const fs::path& path) {
      try {
        io::expect_writable(path);
      } catch (const InputError& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    CHECK(refused(place.path) == refusal(place.path, "x"));
    const auto nowhere = place.path / "no" / "a.txt";
    CHECK(refused(nowhere) == refusal(nowhere, "x"));
    CHECK(refused(nowhere).rfind(nowhere.string() + ": cannot be written", 0) == 0);
    CHECK(place.files() == 1);
  }
}
