// SPDX-License-Identifier: MIT
// Element kernels of solids: against the peak of the core, a plain kernel with Eigen, and dolfinx's assembly.
#include "goals/goal.hpp"
#include "support/kernel_time.hpp"
#include "support/provenance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#ifndef TUNICA_KERNEL_NATIVE
#define TUNICA_KERNEL_NATIVE ""
#endif

namespace tunica::bench {
namespace {

/// Of the program built for the machine at hand; nothing where it is not there.
std::optional<KernelTime> native() {
  const std::string program = TUNICA_KERNEL_NATIVE;
  if (program.empty()) return std::nullopt;
  std::istringstream reply(output_of("'" + program + "'"));
  KernelTime t;
  if (!(reply >> t.peak >> t.hex >> t.hex_flops >> t.closed >> t.closed_flops >> t.plain >> t.tet >>
        t.tet_flops >> t.fibres >> t.fibre_flops >> t.single >> t.action >> t.off >> t.off_duals >>
        t.off_single >> t.assembled >> t.work >> t.stiffness))
    return std::nullopt;
  return t;
}

struct Peer {
  std::string version;
  double rate = 0, work = 0, stiffness = 0;  // [M elements/s], u . f, u . K u
};

/// dolfinx on the same cube; nothing where it is not there.
std::optional<Peer> dolfinx() {
  const std::string python = TUNICA_VTK_PYTHON;
  if (python.empty()) return std::nullopt;
  std::istringstream reply(output_of(python + " '" TUNICA_SOURCE_DIR "/bench/peers/hyperelastic.py' " +
                                     std::to_string(kernel_side) + " 2>/dev/null"));
  std::string name;
  Peer p;
  double seconds = 0;
  if (!(reply >> name >> p.version >> seconds >> p.work >> p.stiffness)) return std::nullopt;
  p.rate = 1e-6 * kernel_side * kernel_side * kernel_side / seconds;
  return p;
}

// Speeds of the targets in elements are those of a core of 88 GFLOP/s; faster cores owe more.
constexpr double reference_peak = 88, wanted_share = 0.45, wanted_assembled = 0.8, wanted_tet = 1.7,
                 wanted_fibres = 0.8, wanted_peer = 10, wanted_error = 1e-12, wanted_single = 1e-5;

void add_lines(std::vector<Goal>& goals, const KernelTime& t, const std::string& build, bool whole,
               const std::optional<Peer>& peer) {
  const double share = 1e-3 * t.hex * t.hex_flops / t.peak, wanted_plain = whole ? 10 : 4;
  const double scale = t.peak / reference_peak;
  const bool exact = t.off <= wanted_error && t.off_duals <= wanted_error;
  goals.push_back(
      {.name = "solid: Hex8 tangent, any law" + build,
       .measured = text("%.2f M/s, %.0f %% of the %.0f GFLOP/s peak; off by %.0e, %.0e of duals", t.hex,
                        100 * share, t.peak, t.off, t.off_duals),
       .target = whole ? text(">= %.0f %% of the peak, %.0f x plain Eigen", 100 * wanted_share, wanted_plain)
                       : text(">= %.0f x plain Eigen (aim 5)", wanted_plain),
       .ratio = text("%.1f x (plain Eigen: %.3f M/s)", t.hex / t.plain, t.plain),
       .outcome = reached_if(exact && t.hex >= wanted_plain * t.plain && (!whole || share >= wanted_share))});
  goals.push_back({.name = "solid: Hex8 tangent, closed form" + build,
                   .measured = text("%.2f M/s, %.0f flop; floats, any law %.2f M/s off by %.0e", t.closed,
                                    t.closed_flops, t.single, t.off_single),
                   .target = text("floats within %.0e", wanted_single),
                   .ratio = text("%.1f x (plain Eigen: %.3f M/s)", t.closed / t.plain, t.plain),
                   .outcome = reached_if(t.off <= wanted_error && t.off_single <= wanted_single)});
  if (!whole) return;
  goals.push_back({.name = "solid: Tet10 tangent, any law" + build,
                   .measured = text("%.2f M/s (%.0f flop)", t.tet, t.tet_flops),
                   .target = text(">= %.1f M/s at 88 GFLOP/s: %.2f here", wanted_tet, wanted_tet * scale),
                   .ratio = "-",
                   .outcome = reached_if(exact && t.tet >= wanted_tet * scale)});
  goals.push_back(
      {.name = "solid: Hex8, two fibre families" + build,
       .measured = text("%.2f M/s with a mean volume (%.0f flop)", t.fibres, t.fibre_flops),
       .target = text(">= %.1f M/s at 88 GFLOP/s: %.2f here", wanted_fibres, wanted_fibres * scale),
       .ratio = "-",
       .outcome = reached_if(exact && t.fibres >= wanted_fibres * scale)});
  Goal assembled{.name = "solid: Hex8 forces and tangent assembled" + build,
                 .measured = text("%.2f M/s, closed form, upper triangle of 3x3 blocks", t.assembled),
                 .target = text(">= %.1f M/s at 88 GFLOP/s: %.2f here; %.0f x dolfinx", wanted_assembled,
                                wanted_assembled * scale, wanted_peer),
                 .ratio = "-",
                 .outcome = Outcome::unmatched};
  if (peer) {
    const double off =
        std::max(std::abs(t.work / peer->work - 1), std::abs(t.stiffness / peer->stiffness - 1));
    assembled.ratio = text("%.1f x (dolfinx %s: %.3f M/s; u.f and u.Ku agree to %.0e)",
                           t.assembled / peer->rate, peer->version.c_str(), peer->rate, off);
    assembled.outcome = reached_if(t.assembled >= wanted_assembled * scale &&
                                   t.assembled >= wanted_peer * peer->rate && off <= 1e-10);
  }
  goals.push_back(assembled);
}

}  // namespace

std::vector<Goal> kernel_goals() {
  std::vector<Goal> goals;
  add_lines(goals, kernel_time(), "", false, std::nullopt);
  if (const auto t = native()) add_lines(goals, *t, ", -O3 -march=native", true, dolfinx());
  return goals;
}

}  // namespace tunica::bench
