// SPDX-License-Identifier: MIT
#include "tunica/io/checkpoint.hpp"

#include "tunica/image/sampling.hpp"
#include "tunica/io/crc32.hpp"
#include "tunica/io/pvd.hpp"

#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace tunica;

namespace {

std::filesystem::path folder() {
  const auto path =
      std::filesystem::temp_directory_path() / ("tunica_checkpoint_" + std::to_string(::getpid()));
  std::filesystem::create_directories(path);
  return path;
}

enum class Phase : std::uint8_t { start, run };

struct Inner {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  std::deque<Eigen::VectorXd> history;
  template <class Archive>
  void archive(Archive& a) {
    a("deformation", f);
    a("history", history);
  }
  bool operator==(const Inner&) const = default;
};

struct State {
  double time = 0;
  float scale = 0;
  int step = 0;
  std::size_t total = 0;
  bool done = false;
  Phase phase = Phase::start;
  std::string name;
  std::vector<double> p;
  std::vector<std::int32_t> index;
  std::vector<bool> flags;
  std::vector<std::string> files;
  std::vector<std::vector<double>> columns;
  Points<3> u;
  Eigen::VectorXd v;
  Eigen::MatrixXi ids;
  Inner inner;

  template <class Archive>
  void archive(Archive& a) {
    a("time", time), a("scale", scale), a("step", step), a("total", total), a("done", done);
    a("phase", phase), a("name", name), a("p", p), a("index", index), a("flags", flags);
    a("files", files), a("columns", columns), a("u", u), a("v", v), a("ids", ids), a("inner", inner);
  }
  bool operator==(const State&) const = default;
};

State state(int step, int n = 50) {
  State s;
  s.time = 1e-3 * step, s.scale = 0.1f, s.step = step, s.total = std::size_t{1} << 40, s.done = true;
  s.phase = Phase::run, s.name = "a name", s.index = {1, -2, 3}, s.flags = {true, false, true};
  s.files = {"", "b"}, s.columns = {{1, 2}, {}, {3}};
  for (int i = 0; i < n; ++i) s.p.push_back(1.0 / (i + step + 1));
  s.u = Points<3>::Constant(3, n, step);
  s.v = Eigen::VectorXd::LinSpaced(n, 0, step);
  s.ids = Eigen::MatrixXi::Constant(2, 3, step);
  s.inner.f(0, 1) = step;
  s.inner.history = {s.v, 2 * s.v};
  return s;
}

void save(State s, const std::filesystem::path& path, const std::string& print = "aorta; dt 1e-3") {
  io::CheckpointWriter w;
  s.archive(w);
  w.save(path, print);
}

State load(const std::filesystem::path& path, const std::string& print = "aorta; dt 1e-3") {
  State s;
  io::CheckpointReader r(path, print);
  s.archive(r);
  r.finish();
  return s;
}

void plain(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template <class F>
std::string refusal(F&& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("io: the checksum is that of the standard in any number of parts") {
    CHECK(io::crc32("123456789") == 0xcbf43926u);
    CHECK(io::crc32("") == 0);
    const std::string text = "The quick brown fox jumps over the lazy dog";
    CHECK(io::crc32(text) == 0x414fa339u);
    for (std::size_t cut = 0; cut <= text.size(); ++cut)
      CHECK(io::crc32(text.substr(cut), io::crc32(text.substr(0, cut))) == 0x414fa339u);
  }

  TEST_CASE("io: a checkpoint gives back every kind of value to the bit and equal states equal bytes") {
    const auto path = folder() / "a.ckpt";
    save(state(7), path);
    CHECK(load(path) == state(7));
    const std::string bytes = io::read_file(path);
    save(load(path), path);
    CHECK(io::read_file(path) == bytes);
    save(State{}, path);
    CHECK(load(path) == State{});
    std::filesystem::remove_all(folder());
  }

  TEST_CASE("io: a checkpoint that is damaged or of another run is refused with a sentence") {
    const auto path = folder() / "b.ckpt", bad = folder() / "bad.ckpt";
    save(state(3), path);
    const std::string good = io::read_file(path);
    CHECK(has(refusal([&] { (void)load(path, "iliac; dt 1e-3"); }),
              "made from another input or with other options: it is of \"aorta; dt 1e-3\", this run is of "
              "\"iliac"));
    CHECK(has(refusal([&] { (void)load(folder() / "none"); }), "no such file"));
    int found = 0;
    for (std::uint64_t k = 0; k < 400; ++k) {  // one flipped bit each
      std::string spoilt = good;
      const auto r = image::splitmix64(k);
      spoilt[(r >> 8) % spoilt.size()] ^= static_cast<char>(1u << (r % 8));
      plain(bad, spoilt);
      found += !refusal([&] { (void)load(bad); }).empty();
    }
    CHECK(found == 400);
    found = 0;
    int cuts = 0;
    for (std::size_t n = 0; n < good.size(); n += n < 100 ? 1 : 37, ++cuts) {
      plain(bad, good.substr(0, n));
      found += !refusal([&] { (void)load(bad); }).empty();
    }
    CHECK(found == cuts);
    plain(bad, good + "x");
    CHECK(has(refusal([&] { (void)load(bad); }), "damaged"));

    const auto with = [&](auto&& write, auto&& read) {
      io::CheckpointWriter w;
      write(w);
      w.save(bad, "");
      return refusal([&] {
        io::CheckpointReader r(bad, "");
        read(r);
        r.finish();
      });
    };
    double d = 1;
    int i = 1;
    std::vector<double> v{1, 2};
    Points<3> u = Points<3>::Zero(3, 2);
    Points<2> plane;
    CHECK(has(with([&](auto& w) { w("dt", d); }, [&](auto& r) { r("step", d); }),
              "expected \"step\", found \"dt\""));
    CHECK(has(with([&](auto& w) { w("dt", d); }, [&](auto& r) { r("dt", i); }),
              "\"dt\" is a float64 where int32 is expected"));
    CHECK(has(with([&](auto& w) { w("dt", v); }, [&](auto& r) { r("dt", d); }), "sequence of float64"));
    CHECK(has(with([&](auto& w) { w("u", u); }, [&](auto& r) { r("u", plane); }), "\"u\" is 3 x 2"));
    CHECK(has(with([&](auto& w) { w("u", u), w("dt", d); }, [&](auto& r) { r("u", u); }),
              "more values than this program reads, from \"dt\" on"));
    CHECK(has(with([&](auto&) {}, [&](auto& r) { r("u", u); }), "expected \"u\", found \"the end\""));
    std::filesystem::remove_all(folder());
  }

  TEST_CASE("io: killed at any moment a writer leaves its last checkpoint readable") {
    const auto path = folder() / "killed.ckpt";
    const auto start = std::chrono::steady_clock::now();
    save(state(0, 20000), path);
    const auto one =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
    const std::uint64_t longest = std::max<std::uint64_t>(15000, 4 * static_cast<std::uint64_t>(one.count()));
    int last = 0, advanced = 0;
    for (std::uint64_t k = 0; k < 60; ++k) {
      const pid_t child = ::fork();
      REQUIRE(child >= 0);
      if (child == 0) {
        for (int step = last + 1;; ++step) save(state(step, 20000), path);
      }
      ::usleep(static_cast<useconds_t>(500 + image::splitmix64(k) % longest));
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
      const State s = load(path);
      REQUIRE(s.step >= last);  // never back in time
      REQUIRE(s == state(s.step, 20000));
      advanced += s.step > last;
      last = s.step;
    }
    MESSAGE("60 kills, ", advanced, " after a new checkpoint, ", last, " checkpoints in all");
    CHECK(advanced > 10);
    std::filesystem::remove_all(folder());
  }

  TEST_CASE("io: a write that fails leaves the old file and no other") {
    const auto path = folder() / "full.bin";
    io::write_file(path, "the old one");
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {  // a disk that is full after 100 kB
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{100000, 100000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      const std::string why = refusal([&] { io::write_file(path, std::string(1000000, 'x')); });
      ::_exit(has(why, "full.bin: cannot be written: ") ? 0 : 1);
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
    CHECK(io::read_file(path) == "the old one");
    CHECK(std::distance(std::filesystem::directory_iterator(folder()), {}) == 1);
    {
      io::AtomicFile file(path);
      file.write("never committed");
    }
    CHECK(io::read_file(path) == "the old one");
    CHECK(std::distance(std::filesystem::directory_iterator(folder()), {}) == 1);
    CHECK(has(refusal([&] { io::write_file(folder() / "no" / "x", ""); }), "No such file or directory"));
    CHECK(has(refusal([&] { io::write_file(folder(), ""); }), "is a folder"));
    std::filesystem::remove_all(folder());
  }

  TEST_CASE("io: a time series goes on after a restart with the same bytes") {
    const auto whole = folder() / "whole.pvd", broken = folder() / "broken.pvd",
               saved = folder() / "series.ckpt";
    io::Pvd series(whole);
    for (int i = 0; i < 5; ++i) series.add(0.1 * i, "f_" + std::to_string(i) + ".vtu");
    {
      io::Pvd first(broken);
      for (int i = 0; i < 3; ++i) first.add(0.1 * i, "f_" + std::to_string(i) + ".vtu");
      io::CheckpointWriter w;
      first.archive(w);
      w.save(saved, "");
    }
    io::Pvd second(broken);
    io::CheckpointReader r(saved, "");
    second.archive(r);
    r.finish();
    for (int i = 3; i < 5; ++i) second.add(0.1 * i, "f_" + std::to_string(i) + ".vtu");
    CHECK(io::read_file(whole) == io::read_file(broken));
    CHECK(
        has(io::read_file(whole), "<DataSet timestep=\"0.30000000000000004\" part=\"0\" file=\"f_3.vtu\"/>"));
    std::filesystem::remove_all(folder());
  }
}
