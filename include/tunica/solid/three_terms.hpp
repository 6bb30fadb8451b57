// SPDX-License-Identifier: MIT
// P and A of compressible neo-Hooke laws in three terms, which the kernel takes without ever forming A.
#pragma once

#include "tunica/core/tensor.hpp"

#include <concepts>

namespace tunica::solid {

/// A_iJkL = straight d_ik d_JL + product g_iJ g_kL + swap g_iL g_kJ with g = F^-T: compressible neo-Hooke
/// laws.
template <class S>
struct ThreeTerms {
  Tensor<S> P, g;
  S straight, product, swap;  // [Pa]
};

/// A law may give `three_terms(F)` beside its response; the pointwise kernel then takes it.
template <class Law, class S>
concept GivesThreeTerms = requires(const Law& law, const Tensor<S>& F) {
  { law.three_terms(F) } -> std::same_as<ThreeTerms<S>>;
};

}  // namespace tunica::solid
