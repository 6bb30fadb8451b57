// SPDX-License-Identifier: MIT
// The folder of a run that can be killed at any moment: frames, their series, checkpoints, the report.
#pragma once

#include "json.hpp"
#include "tunica/io/checkpoint.hpp"
#include "tunica/io/pvd.hpp"
#include "tunica/io/vtu.hpp"

#include <cctype>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace tunica::examples {

/// DIR with lumen.pvd, wall.pvd, lumen_000000.vtu ..., wall_000000.vtu ..., checkpoint, report.json.
/// Every file is written aside and renamed, a checkpoint after the frames that it counts: what a kill
/// leaves is a run that goes on from its last checkpoint and writes the same files with the same bytes.
class RunFolder {
 public:
  /// fingerprint: input and options of the run, in words.
  RunFolder(std::filesystem::path folder, std::string fingerprint)
      : folder_(std::move(folder)),
        fingerprint_(std::move(fingerprint)),
        lumen_(folder_ / "lumen.pvd"),
        wall_(folder_ / "wall.pvd") {}

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] std::filesystem::path checkpoint_path() const { return folder_ / "checkpoint"; }
  [[nodiscard]] std::filesystem::path report_path() const { return folder_ / "report.json"; }
  [[nodiscard]] bool has_checkpoint() const { return std::filesystem::exists(checkpoint_path()); }
  [[nodiscard]] bool has_report() const { return std::filesystem::exists(report_path()); }
  [[nodiscard]] std::size_t frames() const { return lumen_.size(); }

  /// The checkpoint, open; InputError when it is damaged or of another run.
  [[nodiscard]] io::CheckpointReader open() const { return {checkpoint_path(), fingerprint_}; }

  /// Makes the folder, and removes from it the files of an earlier run (and no others).
  void clear() const {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) throw InputError(folder_.string() + ": cannot be made: " + failed.message());
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      std::string name = entry.path().filename().string();
      if (name.size() > 5 && name.compare(name.size() - 5, 5, ".part") == 0) name.resize(name.size() - 5);
      if (ours(name)) std::filesystem::remove(entry.path());
    }
  }

  /// The next frame of both meshes at a time [s].
  template <class Tets, class Hexes>
  void frame(double time, const Tets& lumen, const io::VtuData& flow, const Hexes& wall,
             const io::VtuData& solid) {
    char number[16];
    std::snprintf(number, sizeof number, "_%06zu.vtu", frames());
    const std::string lumen_name = "lumen" + std::string(number), wall_name = "wall" + std::string(number);
    io::write_vtu(folder_ / lumen_name, lumen, flow);
    io::write_vtu(folder_ / wall_name, wall, solid);
    lumen_.add(time, lumen_name);
    wall_.add(time, wall_name);
  }

  /// state.archive(a) after the step number, so that reading can look at the number alone.
  template <class State>
  void checkpoint(int step, State&& archive) {
    io::CheckpointWriter a;
    a("step", step);
    archive(a);
    series(a);
    a.save(checkpoint_path(), fingerprint_);
  }
  template <class State>
  void restore(io::CheckpointReader& a, State&& archive) {
    archive(a);
    series(a);
    a.finish();
  }

  void report(const Json& figures) const { io::write_file(report_path(), figures.text() + "\n"); }

 private:
  template <class Archive>
  void series(Archive& a) {
    a("lumen", lumen_);
    a("wall", wall_);
  }

  [[nodiscard]] static bool ours(std::string_view name) {
    if (name == "lumen.pvd" || name == "wall.pvd" || name == "checkpoint" || name == "report.json")
      return true;
    for (const std::string_view series : {"lumen_", "wall_"}) {
      if (name.substr(0, series.size()) != series || name.size() != series.size() + 10) continue;
      bool digits = name.substr(series.size() + 6) == ".vtu";
      for (const char c : name.substr(series.size(), 6)) digits = digits && c >= '0' && c <= '9';
      if (digits) return true;
    }
    return false;
  }

  std::filesystem::path folder_;
  std::string fingerprint_;
  io::Pvd lumen_, wall_;
};

}  // namespace tunica::examples
