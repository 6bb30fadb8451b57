// SPDX-License-Identifier: MIT
// What a contour is drawn of: a value at a point, refined by a gradient where the field has one.
#pragma once

#include "tunica/core/types.hpp"

#include <concepts>

namespace tunica::meshing {

template <class F>
concept HasValue = requires(const F& f, const Vec3& x) {
  { f.value(x) } -> std::convertible_to<double>;
};

/// An object with value(x), or a callable of x; inside is where the value is at least the iso-value.
///   auto ball = [](const Vec3& x) { return 1 - x.norm(); };
template <class F>
concept ScalarField = HasValue<F> || requires(const F& f, const Vec3& x) {
  { f(x) } -> std::convertible_to<double>;  // a field has a value at a point: f.value(x) or f(x)
};

/// A field that knows its own gradient; others are differenced.
template <class F>
concept DifferentiableField = ScalarField<F> && requires(const F& f, const Vec3& x) {
  { f.gradient(x) } -> std::convertible_to<Vec3>;
};

template <ScalarField F>
[[nodiscard]] double field_value(const F& f, const Vec3& x) {
  if constexpr (HasValue<F>) {
    return static_cast<double>(f.value(x));
  } else {
    return static_cast<double>(f(x));
  }
}

/// The field's gradient, or central differences over `step` [length] along each axis.
template <ScalarField F>
[[nodiscard]] Vec3 field_gradient(const F& f, const Vec3& x, double step) {
  if constexpr (DifferentiableField<F>) {
    return f.gradient(x);
  } else {
    Vec3 g;
    for (int a = 0; a < 3; ++a) {
      const Vec3 e = Vec3::Unit(a) * step;
      g[a] = (field_value(f, x + e) - field_value(f, x - e)) / (2 * step);
    }
    return g;
  }
}

}  // namespace tunica::meshing
