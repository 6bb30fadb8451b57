// SPDX-License-Identifier: MIT
// How thick a wall is: a number, or a function of the place on its inner side.
#pragma once

#include "tunica/core/types.hpp"

#include <concepts>

namespace tunica::meshing {

template <class F>
concept ThicknessField = requires(const F& f, const Vec3& x) {
  { f(x) } -> std::convertible_to<double>;
};

/// [unit of the nodes], positive everywhere.
///   const auto thinning = [](const Vec3& x) { return 1.5 - 0.01 * x[2]; };
template <class T>
concept Thickness = std::convertible_to<T, double> || ThicknessField<T>;

template <Thickness T>
[[nodiscard]] double thickness_at(const T& thickness, const Vec3& x) {
  if constexpr (ThicknessField<T>) {
    return static_cast<double>(thickness(x));
  } else {
    static_cast<void>(x);
    return static_cast<double>(thickness);
  }
}

}  // namespace tunica::meshing
