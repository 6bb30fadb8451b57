// SPDX-License-Identifier: MIT
// The laws of the regions of a body, what they read at the points of its cells, and a stored deformation.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/types.hpp"
#include "tunica/solid/cell_data.hpp"
#include "tunica/solid/formulation.hpp"
#include "tunica/solid/parameters.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace tunica::solid {

/// Points: of the quadrature of a cell. InputError names a parameter of a law that cannot be: see
/// check_parameters.
template <class Material, int Points>
class CellLaws {
 public:
  using Law = PointLaw<Material>;
  using PointData = PointOf<Law, double>;

  CellLaws(const Material& material, std::vector<Index> region, Index cell_count)
      : region_(std::move(region)),
        cell_count_(static_cast<std::size_t>(cell_count)),
        materials_(1, material) {
    check_parameters(material);
  }

  /// The law of a cell: that of its region, or the one given at first.
  [[nodiscard]] const Material& material(Index cell) const { return materials_[number(cell)]; }
  /// All of them, and the number of that of a cell.
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
  [[nodiscard]] std::size_t number(Index cell) const {
    const std::size_t r =
        region_.empty() ? 0 : static_cast<std::size_t>(region_[static_cast<std::size_t>(cell)]);
    return r < materials_.size() ? r : 0;
  }
  /// Another law of the same kind for a region.
  void material(Index region, const Material& law) {
    TUNICA_EXPECT(region >= 0, "regions are numbered from 0");
    check_parameters(law);
    const auto r = static_cast<std::size_t>(region);
    if (r >= materials_.size()) materials_.resize(r + 1, materials_.front());
    materials_[r] = law;
  }

  /// What the law reads at a point of a cell (fibres), or at all of them, in the frame of the mesh.
  void point_data(Index cell, std::size_t point, const PointData& given) {
    static_assert(needs_point<Law>, "this law reads nothing at its points");
    TUNICA_EXPECT(point < Points, "a point of the quadrature");
    if (given_.empty()) {
      given_.resize(cell_count_ * Points);
      points_.resize(cell_count_ * Points);
    }
    const std::size_t at = static_cast<std::size_t>(cell) * Points + point;
    given_[at] = given;
    told_ = true;
    carry_back(at);
  }
  void point_data(Index cell, const PointData& given) {
    for (std::size_t q = 0; q < Points; ++q) point_data(cell, q, given);
  }

  /// InputError if the law reads fibres and nobody gave any; those of a family that is not there are zeros.
  void require_fibres() const {
    if constexpr (fibre_families < PointData >> 0) {
      if (told_) return;
      for (const PointData& point : points_)  // remembered ones count
        for (std::size_t k = 0; k < 3 * fibre_families<PointData>; ++k)
          if (point.m[k] != 0) return;
      throw InputError("solid: the law reads fibres, and the body was given none: see point_field");
    }
  }

  /// F_p of a prestress: Points a cell, one cell after the other; empty without one. What laws remember
  /// begins anew with another.
  [[nodiscard]] const std::vector<Eigen::Matrix3d>& prestress() const { return prestress_; }
  void prestress(std::vector<Eigen::Matrix3d> stored) {
    TUNICA_EXPECT(stored.empty() || stored.size() == cell_count_ * Points,
                  "one stored deformation for each point of each cell");
    prestress_ = std::move(stored);
    for (std::size_t at = 0; at < given_.size(); ++at) carry_back(at);
  }

  // What follows is for laws with a history: see history.hpp.

  template <class Change>
  void for_each_material(Change&& change) {
    for (Material& law : materials_) {
      if constexpr (Pair<Material>)
        change(law.isochoric);
      else
        change(law);
    }
  }
  /// The part of the law of a cell that reads its points.
  [[nodiscard]] const Law& point_law(Index cell) const {
    if constexpr (Pair<Material>)
      return material(cell).isochoric;
    else
      return material(cell);
  }
  /// Points are there, at rest where nothing was given.
  void keep_points() {
    if (!points_.empty()) return;
    given_.resize(cell_count_ * Points);
    points_.resize(cell_count_ * Points);
  }
  [[nodiscard]] Eigen::Index point_count() const { return static_cast<Eigen::Index>(points_.size()); }
  [[nodiscard]] PointData& point(Index cell, std::size_t q) {
    return points_[static_cast<std::size_t>(cell) * Points + q];
  }
  template <class Visit>
  void for_each_point(Visit&& visit) {
    for (PointData& point : points_) visit(point);
  }

  [[nodiscard]] CellData<Law> data(Index cell) const {
    const std::size_t first = static_cast<std::size_t>(cell) * Points;
    return {.points = points_.empty() ? nullptr : &points_[first],
            .prestress = prestress_.empty() ? nullptr : &prestress_[first]};
  }

 private:
  // Fibres are given on the mesh; the law wants them free of stress: F_p^-1 a, of unit length.
  void carry_back(std::size_t at) {
    points_[at] = given_[at];
    if constexpr (fibre_families < PointData >> 0)
      if (!prestress_.empty()) pull_back<reads_frame<Law>>(prestress_[at], points_[at]);
  }

  std::vector<Index> region_;
  std::size_t cell_count_;
  std::vector<Material> materials_;        // by region; the first is also that of all others
  std::vector<PointData> given_, points_;  // on the mesh, free of stress; Points a cell. Empty: none
  std::vector<Eigen::Matrix3d> prestress_;
  bool told_ = false;  // point_data was called
};

}  // namespace tunica::solid
