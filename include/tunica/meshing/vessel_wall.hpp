// SPDX-License-Identifier: MIT
// The wall of a vessel: quadrilaterals of the edge length asked for on the lumen's wall, by dual contouring,
// extruded to hexahedra. [PEREZ08, 3.2.2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/extrude.hpp"
#include "tunica/meshing/interface_distance.hpp"
#include "tunica/meshing/quad_contour.hpp"
#include "tunica/meshing/quad_fit.hpp"
#include "tunica/meshing/quad_grow.hpp"
#include "tunica/meshing/quad_lens.hpp"
#include "tunica/meshing/quad_settle.hpp"
#include "tunica/meshing/quad_smooth.hpp"
#include "tunica/meshing/rim_curve.hpp"
#include "tunica/meshing/surface_foot.hpp"
#include "tunica/meshing/wall_quads.hpp"
#include "tunica/meshing/wall_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

template <Thickness T = double>
struct WallOptions {
  T thickness;  // [unit of the lumen]; a number, or a function of the place on the lumen
  double edge;  // mean edge length of the quadrilaterals [unit of the lumen]
  int layers = 1;
  double tolerance = 0.1;  // distance of the two interfaces that is aimed at [edge]
  int refinements = 3;     // rounds in which the grid is drawn together where they lie farther apart, at most
  double finest = 0.5;     // spacing to which it is drawn together at most [spacing elsewhere]
  QuadSmoothOptions smooth{};
};

namespace detail {

/// Of the tolerance: what levelling aims at, less than settling, which need not move then.
inline constexpr double fit_aim = 0.85;

[[nodiscard]] inline double shortest_side(const mesh::QuadSurface& quads) {
  double least = std::numeric_limits<double>::infinity();
  for (Index q = 0; q < quads.cell_count(); ++q)
    for (int k = 0; k < 4; ++k)
      least = std::min(least, vec::distance(vec::column(quads.nodes, quads.cells(k, q)),
                                            vec::column(quads.nodes, quads.cells((k + 1) % 4, q))));
  return least;
}

/// How hard to try to grow branches: not at all; only from the best sheet so far, until one place does not
/// get better; from the sheet as settled; from the sheet as it was too.
enum class Growth { none, easy, once, thorough };

/// Extrudes sheets of one lumen, measures the walls and keeps the best.
template <Thickness T>
class WallTrials {
 public:
  WallTrials(const mesh::Surface& lumen, const WallOptions<T>& options)
      : options_(options), rims_(rims_of(lumen)), finder_(lumen), targets_(wall_points(lumen)) {}

  [[nodiscard]] double tolerance() const { return options_.tolerance * options_.edge; }
  [[nodiscard]] const Rims& rims() const { return rims_; }
  [[nodiscard]] WallReport& report() { return report_; }                   // of the sheets to come
  [[nodiscard]] const std::vector<FarPlace>& far() const { return far_; }  // of the last sheet
  [[nodiscard]] bool any() const { return best_.has_value(); }
  [[nodiscard]] double least() const { return least_; }  // badness so far
  /// Nothing is bad, and the best is more than just good enough.
  [[nodiscard]] bool ample() const { return !(least_ > 0) && most_ >= ample_worth; }
  /// MeshError where every sheet folds.
  [[nodiscard]] WallResult best() && {
    if (!any()) throw MeshError(folded_);
    return std::move(*best_);
  }

  /// The last of the sheets made of a contour: each is smoothed and judged, the nodes may go farther from
  /// their places from one to the next, until no cell of the wall is inverted.
  [[nodiscard]] WallQuads sheet_of(const WallQuads& contour) {
    constexpr int attempts = 3;
    constexpr double farther = 3;  // nodes may go, from one attempt to the next
    QuadSmoothOptions smooth = options_.smooth;
    WallQuads quads;
    for (int attempt = 1; attempt <= attempts; ++attempt, smooth.reach *= farther) {
      quads = contour;
      report_.attempts = attempt;
      try {
        fit(quads, smooth);
        (void)judge(quads);
      } catch (const MeshError& error) {
        folded_ = error.what();
      }
      if (sound_) break;
    }
    return quads;
  }

  /// Smooths the quadrilaterals of a contour and lays them level with the lumen.
  void fit(WallQuads& quads, const QuadSmoothOptions& smooth) {
    report_.dropped = quads.dropped;
    report_.smoothing = smooth_quads(quads, finder_, rims_, smooth, targets_);
    fit_quads(quads, finder_, targets_, {.tolerance = fit_aim * tolerance()});
  }

  /// The badness of the wall on a sheet; MeshError where the sheet folds.
  double judge(const WallQuads& quads) {
    WallResult result;
    result.inner.nodes = quads.nodes;
    result.inner.cells = quads.cells;
    result.inner.region_names = {"wall"};
    result.report = report_;
    far_.clear();
    sound_ = false;
    const auto& d = result.report.distance =
        interface_distance(result.inner, targets_, finder_, guard_ * tolerance(), &far_, finer_);
    result.report.within = std::max(d.quads_max, d.wall_max) <= tolerance();
    result.report.shortest_side = shortest_side(result.inner) / options_.edge;
    std::vector<SheetRim> ends;
    for (std::size_t r = 0; r < rims_.curves.size(); ++r)
      ends.push_back({rims_.curves[r].name(), rims_.curves[r].plane().normal, quads.loops[r]});
    Extruded extruded =
        extrude(result.inner, std::span<const SheetRim>(ends),
                ExtrudeOptions<T>{.thickness = options_.thickness, .layers = options_.layers});
    result.wall = std::move(extruded.mesh);
    result.report.extrusion = std::move(extruded.report);
    sound_ = result.report.extrusion.quality.inverted == 0;
    const double badness = wall_badness(result.report, far_, guard_ * tolerance());
    const double worth = wall_worth(result.report);
    if (badness < least_ || (badness == least_ && worth > most_))
      least_ = badness, most_ = worth, best_ = std::move(result), best_quads_ = quads;
    return badness;
  }

  /// Settles the nodes where a sheet lies too far from the lumen; then grows the branches that it misses,
  /// from the sheet as settled, and, thoroughly, if that is not enough from the sheet as it was.
  void settle(const WallQuads& fitted, Growth growth) {
    const QuadSettleOptions all = settling(settle_aim);
    WallQuads settled = fitted;
    settle_quads(settled, finder_, rims_, targets_, all);
    const double now = value(settled, fitted);
    if (!(now > 0) || (growth == Growth::easy && now > least_)) return;
    std::vector<WallQuads> starts;
    if (growth != Growth::none) starts.push_back(std::move(settled));
    if (growth == Growth::thorough) starts.push_back(fitted);
    QuadGrowOptions grow{.edge = options_.edge, .tolerance = tolerance()};
    if (growth == Growth::easy) grow.failures = 1;
    for (WallQuads& quads : starts) {
      const int rings = grow_quads(quads, finder_, rims_, targets_, grow,
                                   [&](const WallQuads& sheet) { return value(sheet, fitted); });
      if (rings == 0) continue;
      settle_quads(quads, finder_, rims_, targets_, all);
      if (!(value(quads, fitted) > 0)) return;
    }
  }

  /// Looks at the best sheet more and more finely, between the places that were looked at so far. Where it
  /// lies too far there, its nodes are settled again, with less and less left to what settling just misses;
  /// if that is not enough it is grown.
  void polish() {
    if (!best_) return;
    guard_ = 0.97;
    for (finer_ = 2; finer_ <= 8; finer_ *= 2) {
      const WallQuads found = best_quads_;
      report_ = best_->report, grown_ = best_->report.grown;
      least_ = std::numeric_limits<double>::infinity(), most_ = 0;
      if (judge(found) > 0) improve();
    }
  }

 private:
  void improve() {
    for (const double aim : {settle_aim, settle_aim - 0.1, settle_aim - 0.2}) {
      WallQuads settled = best_quads_;
      settle_quads(settled, finder_, rims_, targets_, settling(aim));
      if (!(value(settled, settled) > 0)) return;
    }
    const WallQuads settled = best_quads_;
    settle(settled, Growth::thorough);
  }

  [[nodiscard]] QuadSettleOptions settling(double aim) const {
    return {.tolerance = aim * tolerance(), .shortest = short_side * options_.edge, .finer = finer_};
  }

  /// The badness of a sheet grown from that one; infinite where it folds.
  double value(const WallQuads& sheet, const WallQuads& from) {
    report_.grown = grown_ + static_cast<Index>(sheet.cells.cols() - from.cells.cols());
    double badness = std::numeric_limits<double>::infinity();
    try {
      badness = judge(sheet);
    } catch (const MeshError&) {  // it folds
    }
    report_.grown = grown_;
    return badness;
  }

  const WallOptions<T> options_;
  const Rims rims_;
  const FootFinder finder_;
  const std::vector<Vec3> targets_;
  WallReport report_;
  std::vector<FarPlace> far_;
  double guard_ = 1;  // of the tolerance: what is left goes to what lies between the places
  int finer_ = 1;     // how finely sheets are settled and judged
  Index grown_ = 0;   // quadrilaterals of the sheet that settling starts from
  WallQuads best_quads_;
  bool sound_ = false;                                                 // the last sheet: no cell is inverted
  std::string folded_;                                                 // why there is no wall yet
  double least_ = std::numeric_limits<double>::infinity(), most_ = 0;  // badness and worth of the best
  std::optional<WallResult> best_;
};

}  // namespace detail

/// lumen: closed, region 0 the wall, the others flat caps. Inner faces follow the wall on the average, and
/// within the tolerance where they can; those of the ends lie exactly on the rims, in the planes of the caps.
/// Where the sheet is farther from the lumen its nodes are settled one by one, the grid is drawn together,
/// and then blind branches that are missed are grown from the sheet. A grid that is drawn together is made
/// wider elsewhere, so that the edge asked for stays the mean edge; only where the sheet on it is not good
/// enough is it left as wide as it was. The best of the sheets is kept: one without inverted cells before
/// all. Where the sheet folds it is smoothed again with nodes that may go farther from their places.
/// MeshError where the edge length is too coarse for the vessel, or where the sheet folds however it is
/// smoothed.
template <Thickness T = double>
[[nodiscard]] WallResult vessel_wall(const mesh::Surface& lumen, WallOptions<T> options) {
  TUNICA_EXPECT(options.edge > 0, "a wall has an edge length");
  // A uniform grid of spacing s crosses a surface of area A about 3 A / (2 s^2) times.
  const double spacing = options.edge * std::sqrt(1.5);
  detail::WallTrials<T> trials(lumen, options);
  Lenses lenses;
  const auto enough = [&] { return !(trials.least() > 0); };
  const auto sheet = [&](detail::Elsewhere elsewhere) -> std::optional<WallQuads> {
    try {
      return trials.sheet_of(detail::quads_through(lenses, lumen, spacing, trials.rims(), elsewhere));
    } catch (const MeshError&) {  // torn where the lenses draw it apart
      if (!trials.any() && elsewhere == detail::Elsewhere::kept) throw;
      return std::nullopt;
    }
  };
  int spare = 0;  // rounds since nothing was bad
  for (int round = 0; round <= options.refinements; ++round) {
    trials.report().refinements = round, trials.report().lenses = lenses.count();
    Lenses next;
    bool more = false;  // lenses than in this round
    for (const auto elsewhere : {detail::Elsewhere::widened, detail::Elsewhere::kept}) {
      const bool wide = elsewhere == detail::Elsewhere::widened;
      if (wide && lenses.empty()) continue;
      more = false;
      const auto quads = sheet(elsewhere);
      if (!quads) continue;
      if (enough() && trials.far().empty()) {
        trials.polish();
        return std::move(trials).best();
      }
      next = lenses;
      more = detail::add_lenses(next, trials.far(), options.edge, trials.tolerance(), 1 / options.finest);
      const bool last = !more || round == options.refinements;
      trials.settle(*quads, wide        ? detail::Growth::easy
                            : last      ? detail::Growth::thorough
                            : round > 0 ? detail::Growth::once
                                        : detail::Growth::none);
      if (enough()) break;
    }
    if (!more || trials.ample()) break;
    if (enough() && ++spare > 1) break;
    lenses = std::move(next);
  }
  trials.polish();
  return std::move(trials).best();
}

}  // namespace tunica::meshing
