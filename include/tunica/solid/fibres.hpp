// SPDX-License-Identifier: MIT
// Fibres<S, N>: the unit vectors of N fibre families (or of a fibre frame) at a point of the reference body.
#pragma once

#include "tunica/core/tensor.hpp"

#include <array>
#include <cstddef>

namespace tunica::solid {

/// Directions one after the other, in the undeformed body. Zero: no fibres, then I4 = 0 and nothing pulls.
template <class S, std::size_t N>
struct Fibres {
  std::array<S, 3 * N> m{};
  static constexpr std::size_t families = N;

  [[nodiscard]] Vector3<S> operator[](std::size_t family) const {
    return {m[3 * family], m[3 * family + 1], m[3 * family + 2]};
  }
  void set(std::size_t family, const Vector3<S>& direction) {
    for (std::size_t k = 0; k < 3; ++k) m[3 * family + k] = direction[k];
  }
};

/// How many directions stand first in what a law reads at a point: of Fibres, or of a point that says so.
template <class Point>
inline constexpr std::size_t fibre_families = [] {
  if constexpr (requires { Point::families; })
    return Point::families;
  else
    return std::size_t{0};
}();

/// Whether these directions are the axes of an orthogonal frame and not three families of fibres: a law, or
/// the one that it wraps, says `static constexpr bool orthogonal_frame = true`.
template <class Law>
inline constexpr bool reads_frame = [] {
  if constexpr (requires { Law::orthogonal_frame; })
    return Law::orthogonal_frame;
  else
    return false;
}();
template <template <class> class Wrapper, class Law>
inline constexpr bool reads_frame<Wrapper<Law>> = reads_frame<Law>;
template <template <class, std::size_t> class Wrapper, class Law, std::size_t Terms>
inline constexpr bool reads_frame<Wrapper<Law, Terms>> = reads_frame<Law>;

}  // namespace tunica::solid
