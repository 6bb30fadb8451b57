// SPDX-License-Identifier: MIT
// How a coupled run begins, is recorded, fails and ends: all that artery_fsi does beside its physics.
#pragma once

#include "artery_figures.hpp"
#include "artery_frames.hpp"
#include "artery_meshes.hpp"
#include "artery_options.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "stopwatch.hpp"
#include "tunica/core/solve_report.hpp"
#include "tunica/core/text.hpp"
#include "tunica/io/atomic_file.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace tunica::artery {

/// Where a run goes on: after a step that is done, from the checkpoint that holds it (none: from rest).
struct Beginning {
  int step = 0;
  std::optional<io::CheckpointReader> checkpoint{};
  bool finished = false;
};

[[nodiscard]] inline Beginning beginning(const Options& o, const examples::RunFolder& folder) {
  Beginning from;
  if (o.restart && folder.has_checkpoint()) {
    from.checkpoint.emplace(folder.open());
    (*from.checkpoint)("step", from.step);
    from.finished = from.step == o.steps() && folder.has_report();
    if (from.finished)
      std::printf("the run in %s is finished: nothing to do\n", o.folder.c_str());
    else
      std::fprintf(stderr, "restart from the checkpoint of step %d of %d\n", from.step, o.steps());
  } else if (o.restart) {
    std::fprintf(stderr, "no checkpoint in %s: starting from the beginning\n", o.folder.c_str());
  }
  return from;
}

/// A report that cannot be written is found before the run, not after it. DIR may be yet to be made.
inline void check_report(const Options& o) {
  if (o.report.empty()) return;
  const std::filesystem::path report(o.report), folder(o.folder);
  const auto whole = [](const std::filesystem::path& p) {
    return std::filesystem::weakly_canonical(p / "").lexically_normal();
  };
  const auto parent = report.has_parent_path() ? report.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::exists(folder) && whole(parent) == whole(folder)) return;
  io::expect_writable(report);
}

/// The error of step n, which failed in the shortest parts as well.
template <class StepReport>
[[nodiscard]] std::runtime_error failure(const StepReport& step, int n, const Options& o) {
  return std::runtime_error("step " + std::to_string(n) + " of " + std::to_string(o.steps()) + " at " +
                            seven_digits((n - 1) * o.dt + step.taken) + " s: the " +
                            std::string(step.failed) + " ended as " + std::string(name(step.status)) +
                            " after " + std::to_string(step.halvings) + " halvings of the step");
}

/// The two solvers and what couples them: together the state of a run.
template <class Fluid, class Structure, class Coupled>
struct State {
  Fluid& blood;
  Structure& wall;
  Coupled& fsi;

  template <class Archive>
  void archive(Archive& a) const {
    blood.archive(a), wall.archive(a), fsi.archive(a);
  }
};

/// Frames, checkpoints and figures of a run, and its progress.
class Record {
 public:
  Record(const Options& o, const Meshes& mesh, examples::RunFolder& folder, examples::Stopwatch& watch)
      : o_(o), mesh_(mesh), folder_(folder), watch_(watch), frames_(mesh, folder, figures_) {}

  /// The state of the checkpoint, or the first frame in a folder that was cleared.
  template <class State>
  void begin(Beginning& from, const State& state) {
    if (from.checkpoint) {
      folder_.restore(*from.checkpoint, [&](auto& a) { archive(a, state); });
    } else {
      folder_.clear();
      watch_.time("write", [&] { frames_.write(0, state.blood, state.wall); });
    }
  }

  template <class State, class StepReport>
  void step(int n, const StepReport& step, const State& state) {
    figures_.count(step);
    figures_.watch(state.blood, state.wall);
    watch_.time("write", [&] {
      const bool last = n == o_.steps();
      if (n % o_.frame_every() == 0 || last) frames_.write(n * o_.dt, state.blood, state.wall);
      if (n % o_.checkpoint == 0 || last) folder_.checkpoint(n, [&](auto& a) { archive(a, state); });
    });
    char note[96];
    std::snprintf(note, sizeof note, "t %.4f s  %2d iterations  displacement %.3f mm", n * o_.dt,
                  step.iterations, state.wall.nodal_displacement().colwise().norm().maxCoeff() * 1e3);
    progress_.tell(n, note);
  }

  /// The report and the closing table; gap [m] between the two sides of the interface.
  void finish(double gap, examples::Json& report) const {
    examples::Json& j = report["run"];
    j["tetrahedra"] = mesh_.lumen.cell_count(), j["hexahedra"] = mesh_.wall.cell_count();
    j["interface_gap_m"] = gap;
    j["frames"] = folder_.frames();
    figures_.report(j);
    watch_.report(report);
    folder_.report(report);
    if (!o_.report.empty()) io::write_file(o_.report, report.text() + "\n");

    std::printf("artery_fsi: %d steps of %g s, %zu frames in %s\n", o_.steps(), o_.dt, folder_.frames(),
                o_.folder.c_str());
    row("cells", "%d tetrahedra, %d hexahedra", mesh_.lumen.cell_count(), mesh_.wall.cell_count());
    figures_.print();
    for (const auto& [name, s] : watch_.stages())
      row(name.c_str(), "%.2f s, %.2f s of CPU time", s.elapsed, s.cpu);
  }

 private:
  template <class Archive, class State>
  void archive(Archive& a, const State& state) {
    state.archive(a);
    figures_.archive(a);
  }

  const Options& o_;
  const Meshes& mesh_;
  examples::RunFolder& folder_;
  examples::Stopwatch& watch_;
  Figures figures_{};
  Frames frames_;
  examples::Progress progress_{o_.steps()};
};

}  // namespace tunica::artery
