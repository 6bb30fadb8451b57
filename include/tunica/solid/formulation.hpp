// SPDX-License-Identifier: MIT
// Which element a law is solved with: with<FBar>(law), with<Pointwise>(law), or what the law asks for itself.
#pragma once

#include "tunica/mesh/cell_quadratic.hpp"
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

namespace detail {
/// One pressure is too few for a Hex27, and four are too many for all others: they alternate.
template <mesh::Cell C>
inline constexpr bool holds_linear_pressure = C::vtk_type == mesh::Hex27::vtk_type;
}  // namespace detail

/// Law, its cure of locking in cells C and the law itself: pairs take LinearVolume in Hex27 and MeanVolume in
/// other cells where nothing is said, others Pointwise; the pressure of FBar of a pair is kept apart.
template <class Given, mesh::Cell C>
struct Formulation {
  using Law = Given;
  using Locking = std::conditional_t<
      Pair<Given>, std::conditional_t<detail::holds_linear_pressure<C>, LinearVolume, MeanVolume>, Pointwise>;
  [[nodiscard]] static const Law& law(const Given& given) { return given; }
};
template <class Cure, class Inner, mesh::Cell C>
struct Formulation<With<Cure, Inner>, C> {
  using Law = Inner;
  using Locking = std::conditional_t<Pair<Inner> && std::is_same_v<Cure, FBar>, CentreVolume, Cure>;
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
