// SPDX-License-Identifier: MIT
// Multigrid on Poisson's equation up to a million unknowns: time beside amgcl's, iterations, memory.
#include "goals/goal.hpp"
#include "support/poisson_solve.hpp"
#include "support/provenance.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#ifndef TUNICA_LA_NATIVE
#define TUNICA_LA_NATIVE ""
#endif

namespace tunica::bench {
namespace {

constexpr int small = 28, middle = 47, large = 100;  // cells along an edge: 2e4, 1e5, 1e6 unknowns
constexpr double first_wanted = 1.2, next_wanted = 1.0, memory_wanted = 800;

struct Pair {
  PoissonRun ours;
  std::optional<PoissonRun> peer;
};

/// What la_native prints; nothing where it is not there.
std::optional<Pair> native(int cells) {
  const std::string program = TUNICA_LA_NATIVE;
  if (program.empty()) return std::nullopt;
  std::istringstream reply(output_of("'" + program + "' " + std::to_string(cells)));
  const auto read = [&](PoissonRun& run) {
    return static_cast<bool>(reply >> run.setup >> run.solve >> run.refresh >> run.iterations >>
                             run.residual >> run.megabytes);
  };
  int unknowns = 0;
  Pair pair;
  if (!(reply >> unknowns) || !read(pair.ours)) return std::nullopt;
  if (PoissonRun peer; read(peer)) pair.peer = peer;
  return pair;
}

std::string peer_text(const std::optional<PoissonRun>& peer, double ours, double theirs) {
  if (!peer) return "-";
  return text("%.2f (amgcl: %.2f s, %d iterations, %.0f MB)", ours / theirs, theirs, peer->iterations,
              peer->megabytes);
}

void add_times(const std::string& flags, const Pair& pair, std::vector<Goal>& goals) {
  const auto& [ours, peer] = pair;
  const bool solved = ours.residual <= 1e-8;
  const double first = ours.setup + ours.solve, peer_first = peer ? peer->setup + peer->solve : 0;
  goals.push_back(
      {.name = "la: Poisson, 1e6 unknowns, first solve" + flags,
       .measured = text("%.2f s (set-up %.2f) to %.1e, %d iterations", first, ours.setup, ours.residual,
                        ours.iterations),
       .target = text("<= %.1f of amgcl's time", first_wanted),
       .ratio = peer_text(peer, first, peer_first),
       .outcome = peer ? reached_if(solved && first <= first_wanted * peer_first) : Outcome::unmatched});
  goals.push_back(
      {.name = "la: Poisson, 1e6 unknowns, next solve" + flags,
       .measured = text("%.2f s to %.1e; %.2f s more with new values of the matrix", ours.solve,
                        ours.residual, ours.refresh),
       .target = text("<= %.1f of amgcl's time", next_wanted),
       .ratio = peer_text(peer, ours.solve, peer ? peer->solve : 0),
       .outcome = peer ? reached_if(solved && ours.solve <= next_wanted * peer->solve) : Outcome::unmatched});
}

}  // namespace

std::vector<Goal> la_goals() {
  std::vector<Goal> goals;
  std::vector<int> iterations;
  Pair million;
  for (const int cells : {small, middle, large}) {
    const auto A = poisson(cells);
    const Eigen::VectorXd b = test::Noise{}.vector(A.rows());
    auto run = solve_by_multigrid(A, b, 1);
    iterations.push_back(run.residual <= 1e-8 ? run.iterations : 1000);
    if (cells == large) million = {run, solve_by_peer(A, b, 1)};
  }
  add_times("", million, goals);
  if (const auto pair = native(large)) add_times(", -march=native", *pair, goals);
  const auto [least, most] = std::minmax_element(iterations.begin(), iterations.end());
  goals.push_back(
      {.name = "la: iterations from 2e4 to 1e6 unknowns",
       .measured = text("%d, %d, %d to a residual of 1e-8", iterations[0], iterations[1], iterations[2]),
       .target = "<= 20, within a factor of 1.3",
       .ratio = "-",
       .outcome = reached_if(*most <= 20 && *most <= 1.3 * *least)});
  goals.push_back(
      {.name = "la: memory of the multigrid, 1e6 unknowns",
       .measured = text("%.0f MB at the peak", million.ours.megabytes),
       .target = text("<= %.0f MB", memory_wanted),
       .ratio = "-",
       .outcome = reached_if(million.ours.megabytes > 0 && million.ours.megabytes <= memory_wanted)});
  return goals;
}

}  // namespace tunica::bench
