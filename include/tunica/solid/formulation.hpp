// SPDX-License-Identifier: MIT
// Which element a law is solved with: with<FBar>(law), with<Pointwise>(law), or what the law asks for itself.
#pragma once

#include "tunica/solid/energy.hpp"
#include "tunica/solid/locking.hpp"
#include "tunica/solid/material.hpp"

#include <concepts>
#include <type_traits>
#include <utility>

namespace tunica::solid {

/// Pressures at the nodes beside the displacements, for Tet4: see MixedTet.
struct NodalPressure {
  static constexpr Blocks blocks = Blocks::upper;
};

/// A law and the cure of locking that it is solved with.
template <class Locking_, class Law_>
struct With {
  using Locking = Locking_;
  using Law = Law_;
  Law law;
};

///   Statics wall{mesh, with<NodalPressure>(Hyperelastic{...})};
template <class Locking, class Law>
[[nodiscard]] With<Locking, Law> with(const Law& law) {
  return {law};
}

/// A law whose isochoric and volumetric parts can be had apart.
template <class Law>
concept Pair = requires(const Law& law) {
  law.isochoric;
  law.volumetric;
};

/// Law, its cure of locking and the law itself: pairs take MeanVolume where nothing is said, others
/// Pointwise.
template <class Given>
struct Formulation {
  using Law = Given;
  using Locking = std::conditional_t<Pair<Given>, MeanVolume, Pointwise>;
  [[nodiscard]] static const Law& law(const Given& given) { return given; }
};
template <class Cure, class Inner>
struct Formulation<With<Cure, Inner>> {
  using Law = Inner;
  using Locking = Cure;
  [[nodiscard]] static const Law& law(const With<Cure, Inner>& given) { return given.law; }
};

namespace detail {
template <class Law>
struct PointLawOf {
  using type = Law;
};
template <Pair Law>
struct PointLawOf<Law> {
  using type = std::remove_cvref_t<decltype(std::declval<Law>().isochoric)>;
};
}  // namespace detail

/// The part of a law that reads data at the points: the isochoric one of a pair.
template <class Law>
using PointLaw = typename detail::PointLawOf<Law>::type;

}  // namespace tunica::solid
