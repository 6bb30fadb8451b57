// SPDX-License-Identifier: MIT
// Histograms of the quality of a mesh over fixed, named bins, and its worst cells by place.
#pragma once

#include "tunica/mesh/quality.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunica::mesh {

/// Bins of a figure: from each edge to the next. Values below the first or above the last are counted apart.
struct Bins {
  std::string_view figure, unit;
  std::span<const double> edges;
};

namespace detail {
inline constexpr double angle_edges[] = {0, 1, 5, 10, 15, 20, 25, 30, 40, 50, 60, 75};
inline constexpr double share_edges[] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
}  // namespace detail

inline constexpr Bins dihedral_bins{"smallest dihedral angle", "degrees", detail::angle_edges};
inline constexpr Bins angle_bins{"smallest angle", "degrees", detail::angle_edges};
inline constexpr Bins mean_ratio_bins{"mean ratio", "-", detail::share_edges};
inline constexpr Bins scaled_jacobian_bins{"scaled Jacobian", "-", detail::share_edges};

struct Histogram {
  std::string figure, unit;
  std::vector<double> edges;
  std::vector<Index> count;    // of edges[i] <= value < edges[i + 1]; the last bin holds its upper edge, too
  Index below = 0, above = 0;  // inverted cells lie below the bins of a share
};

struct WorstCell {
  Index cell = -1;
  double value = 0;
  Vec3 place{0, 0, 0};  // mean of its nodes, in the unit of the nodes
};

/// One figure over all cells.
struct [[nodiscard]] FigureReport {
  double least = 0, mean = 0;
  Histogram histogram;
  std::vector<WorstCell> worst;  // the worst first
};

[[nodiscard]] inline Histogram histogram(const Spread& s, const Bins& bins) {
  Histogram h{std::string(bins.figure), std::string(bins.unit), {bins.edges.begin(), bins.edges.end()}, {}};
  const auto below = [&](double edge) {
    return static_cast<Index>(std::lower_bound(s.sorted.begin(), s.sorted.end(), edge) - s.sorted.begin());
  };
  // a unit share that rounding carries over 1 belongs to the last bin
  const double top = h.edges.back() * (1 + 4 * std::numeric_limits<double>::epsilon());
  const auto up_to =
      static_cast<Index>(std::upper_bound(s.sorted.begin(), s.sorted.end(), top) - s.sorted.begin());
  h.below = below(h.edges.front());
  for (std::size_t i = 0; i + 1 < h.edges.size(); ++i)
    h.count.push_back((i + 2 < h.edges.size() ? below(h.edges[i + 1]) : up_to) - below(h.edges[i]));
  h.above = static_cast<Index>(s.sorted.size()) - up_to;
  return h;
}

/// Mean of the nodes of a cell.
template <class C>
[[nodiscard]] Vec3 cell_place(const Mesh<C, 3>& m, Index cell) {
  Vec3 x(0, 0, 0);
  for (Eigen::Index k = 0; k < C::nodes; ++k)
    x = vec::along(x, 1.0 / C::nodes, vec::column(m.nodes, m.cells(k, cell)));
  return x;
}

/// The report of figure(cell) over the cells of a mesh.
template <class C, class Figure>
[[nodiscard]] FigureReport figure_report(const Mesh<C, 3>& m, const Bins& bins, const Figure& figure) {
  const Spread s = spread(m.cell_count(), figure);
  FigureReport r{m.cell_count() > 0 ? s.least : 0, s.mean, histogram(s, bins), {}};
  for (std::size_t i = 0; i < s.worst.size(); ++i)
    r.worst.push_back({s.worst[i], s.sorted[i], cell_place(m, s.worst[i])});
  return r;
}

/// Smallest dihedral angle, mean ratio, scaled Jacobian.
[[nodiscard]] inline std::vector<FigureReport> quality_report(const TetMesh& m) {
  const auto dihedral = [&](Index c) {
    const auto angle = dihedral_angles(corners(m, c));
    return degrees(*std::min_element(angle.begin(), angle.end()));
  };
  return {figure_report(m, dihedral_bins, dihedral),
          figure_report(m, mean_ratio_bins, [&](Index c) { return mean_ratio(corners(m, c)); }),
          figure_report(m, scaled_jacobian_bins, [&](Index c) { return scaled_jacobian(corners(m, c)); })};
}

/// Scaled Jacobian, mean ratio.
[[nodiscard]] inline std::vector<FigureReport> quality_report(const HexMesh& m) {
  return {figure_report(m, scaled_jacobian_bins, [&](Index c) { return scaled_jacobian(corners(m, c)); }),
          figure_report(m, mean_ratio_bins, [&](Index c) { return mean_ratio(corners(m, c)); })};
}

/// Smallest angle, mean ratio, scaled Jacobian.
[[nodiscard]] inline std::vector<FigureReport> quality_report(const Surface& m) {
  return {figure_report(m, angle_bins, [&](Index t) { return degrees(triangle(m, t).smallest_angle()); }),
          figure_report(m, mean_ratio_bins, [&](Index t) { return mean_ratio(triangle(m, t)); }),
          figure_report(m, scaled_jacobian_bins, [&](Index t) { return scaled_jacobian(triangle(m, t)); })};
}

}  // namespace tunica::mesh
