// SPDX-License-Identifier: MIT
// Recovery of nodal values from one sample a cell: a linear field through the cells around each node, as
// [ZIENKIEWICZ92], of second order also at the boundary.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/mesh/adjacency.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/solid/principal.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tunica::solid {

namespace detail {

/// The value at `at` of the linear field that fits samples (columns of `values`) at the middles of `cells`
/// best. In a direction in which the middles do not spread, as through a single layer of cells, the field
/// is constant.
template <mesh::Cell C, class Values>
[[nodiscard]] Eigen::VectorXd fit_at(const Vec3& at, const std::vector<Index>& cells,
                                     const mesh::Mesh<C, 3>& mesh, const Points<3>& middle,
                                     const Values& values) {
  constexpr double least_spread = 0.35;  // of a cell's size; two layers of cells spread by 0.5
  const double share = 1 / static_cast<double>(cells.size());
  Vec3 centre = Vec3::Zero();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(values.rows());
  for (const Index e : cells) {
    centre += share * middle.col(e);
    mean += share * values.col(e);
  }
  Symmetric<double> spread = Symmetric<double>::Zero();
  for (const Index e : cells) {
    const Vec3 d = middle.col(e) - centre;
    for (std::size_t k = 0; k < 6; ++k)
      spread[static_cast<int>(k)] += share * d[symmetric_pairs[k][0]] * d[symmetric_pairs[k][1]];
  }
  const Principal axes = principal(spread);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 n = axes.directions.col(axis);
    double size = 0;  // of the cells along the axis: twice the mean distance of their nodes
    for (const Index e : cells)
      for (const Index k : mesh.cells.col(e))
        size += 2 * share / C::nodes * std::abs(n.dot(mesh.nodes.col(k) - middle.col(e)));
    const double variance = axes.values[axis];
    if (!(variance > least_spread * least_spread * size * size)) continue;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(values.rows());
    for (const Index e : cells) slope += share * n.dot(middle.col(e) - centre) * values.col(e);
    mean += n.dot(at - centre) / variance * slope;
  }
  return mean;
}

}  // namespace detail

/// values: m x cells, each the mean of a smooth field over its cell; returns m x nodes. A node takes the
/// cells around it if they lie around it on all sides, else also their neighbours across nodes.
template <mesh::Cell C, class Values>
[[nodiscard]] Eigen::MatrixXd recover_at_nodes(const mesh::Mesh<C, 3>& mesh, const Values& values) {
  TUNICA_EXPECT(values.cols() == mesh.cell_count(), "one sample a cell");
  constexpr double off_centre = 0.1;  // of the size of the patch: a node farther off is at its edge
  const mesh::Rows around = mesh::cells_of_nodes(mesh.cells, mesh.node_count());
  Points<3> middle = Points<3>::Zero(3, mesh.cell_count()), half = middle;
  for (Index e = 0; e < mesh.cell_count(); ++e) {
    for (const Index n : mesh.cells.col(e)) middle.col(e) += mesh.nodes.col(n) / C::nodes;
    // mean distance of its nodes along each axis: half the edges of a box
    for (const Index n : mesh.cells.col(e))
      half.col(e) += (mesh.nodes.col(n) - middle.col(e)).cwiseAbs() / C::nodes;
  }
  Eigen::MatrixXd nodal(values.rows(), mesh.node_count());
  parallel_chunks(mesh.node_count(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Index> cells;
    for (auto node = static_cast<Index>(begin); node < static_cast<Index>(end); ++node) {
      const Vec3 at = mesh.nodes.col(node);
      cells.assign(around[node].begin(), around[node].end());
      Vec3 centre = Vec3::Zero(), size = Vec3::Zero();
      for (const Index e : cells) {
        centre += middle.col(e) / static_cast<double>(cells.size());
        size += half.col(e) / static_cast<double>(cells.size());
      }
      bool inside = true;
      for (int i = 0; i < 3; ++i) inside = inside && std::abs(centre[i] - at[i]) <= off_centre * 2 * size[i];
      if (!inside) {
        const std::vector<Index> ring = cells;
        for (const Index e : ring)
          for (const Index n : mesh.cells.col(e))
            cells.insert(cells.end(), around[n].begin(), around[n].end());
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
      }
      nodal.col(node) = cells.empty() ? Eigen::VectorXd::Zero(values.rows())
                                      : detail::fit_at(at, cells, mesh, middle, values);
    }
  });
  return nodal;
}

}  // namespace tunica::solid
