// SPDX-License-Identifier: MIT
// FibreField: unit vectors of fibre families, one of each a cell; how to make, join and check them.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/solid/fibres.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tunica::solid {

/// Directions in the undeformed mesh, a column a cell. A column of zeros: that cell has no fibres. As they
/// are, the families may be written to a file: io::Array{"fibre", field.family[0]}.
template <std::size_t N>
struct FibreField {
  std::array<Points<3>, N> family;  // 3 x cells each

  [[nodiscard]] Index cell_count() const { return static_cast<Index>(family[0].cols()); }
  /// What the law reads in a cell.
  [[nodiscard]] Fibres<double, N> operator[](Index cell) const {
    Fibres<double, N> f;
    for (std::size_t k = 0; k < N; ++k)
      f.set(k, {family[k](0, cell), family[k](1, cell), family[k](2, cell)});
    return f;
  }
};

struct FibreCheck {
  double tolerance = 1e-3;  // lengths (and angles of a frame) of a file with few digits: off by less [-]
  bool frame = false;       // whether the families are to be orthogonal, as Guccione's law wants them
  bool gaps = false;        // whether cells may have no fibres (zeros), as the layers without any
};

/// The field with lengths of exactly 1. MeshError names the first cell where a direction is not a number, is
/// missing, is not of length 1 or (of a frame) not orthogonal, and tells what was found; no cell gets a
/// direction that nobody gave.
template <std::size_t N>
[[nodiscard]] FibreField<N> checked(FibreField<N> field, Index cell_count, const FibreCheck& options = {}) {
  for (std::size_t k = 0; k < N; ++k)
    if (field.family[k].cols() != cell_count)
      throw MeshError("fibres: family " + std::to_string(k + 1) + " has " +
                      std::to_string(field.family[k].cols()) + " directions, the mesh has " +
                      std::to_string(cell_count) + " cells");
  for (Index c = 0; c < cell_count; ++c) {
    std::array<Vec3, N> a;
    const auto refuse = [&](std::size_t k, const std::string& found) {
      throw MeshError("fibres: cell " + std::to_string(c) + ", family " + std::to_string(k + 1) + ": " +
                      found + " " + place(a[k]));
    };
    std::size_t missing = 0;
    for (std::size_t k = 0; k < N; ++k) {
      a[k] = vec::column(field.family[k], c);
      const double length = vec::length(a[k]);
      if (!std::isfinite(length)) refuse(k, "a direction that is not a number");
      if (length == 0) {
        ++missing;
        if (!options.gaps) refuse(k, "no fibres are given");
        continue;
      }
      if (!(std::abs(length - 1) <= options.tolerance))
        refuse(k, "a direction of length " + seven_digits(length) + ", not 1");
      a[k] = vec::divided(a[k], length);
      vec::set_column(field.family[k], c, a[k]);
    }
    if (options.frame && missing > 0 && missing < N)
      for (std::size_t k = 0; k < N; ++k)
        if (vec::squared(a[k]) == 0) refuse(k, "an axis is missing beside others");
    for (std::size_t k = 0; options.frame && missing == 0 && k < N; ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (!(std::abs(vec::dot(a[k], a[l])) <= options.tolerance))
          refuse(k, "a direction not orthogonal to that of family " + std::to_string(l + 1));
  }
  return field;
}

/// The same directions in every cell; of any length but 0. MeshError if one has none or is not a number.
template <std::size_t N>
[[nodiscard]] FibreField<N> uniform_fibres(Index cell_count, const std::array<Vec3, N>& directions) {
  FibreField<N> field;
  for (std::size_t k = 0; k < N; ++k) {
    const Vec3 a = vec::unit(directions[k]);
    if (!(vec::squared(a) > 0.5))
      throw MeshError("fibres: family " + std::to_string(k + 1) + " has no direction");
    field.family[k] = a.replicate(1, cell_count);
  }
  return field;
}

/// Fields of layers in one: cell c takes its directions from fields[layer[c]], each of which covers the whole
/// mesh. `layer`: one a cell, such as the regions of a mesh. MeshError names the cell whose layer has no
/// field.
template <std::size_t N>
[[nodiscard]] FibreField<N> layered_fibres(const std::vector<Index>& layer,
                                           const std::vector<FibreField<N>>& fields) {
  FibreField<N> field;
  for (auto& f : field.family) f.resize(3, static_cast<Eigen::Index>(layer.size()));
  for (std::size_t c = 0; c < layer.size(); ++c) {
    const auto cell = static_cast<Index>(c);
    if (layer[c] < 0 || static_cast<std::size_t>(layer[c]) >= fields.size() ||
        fields[static_cast<std::size_t>(layer[c])].cell_count() <= cell)
      throw MeshError("fibres: cell " + std::to_string(c) + ": no fibres for layer " +
                      std::to_string(layer[c]));
    for (std::size_t k = 0; k < N; ++k)
      vec::set_column(field.family[k], cell,
                      vec::column(fields[static_cast<std::size_t>(layer[c])].family[k], cell));
  }
  return field;
}

}  // namespace tunica::solid
