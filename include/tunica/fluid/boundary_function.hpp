// SPDX-License-Identifier: MIT
// A value on a patch: constant, a function of time, or a function of place and time.
#pragma once

#include "tunica/core/types.hpp"

#include <memory>
#include <type_traits>
#include <utility>

namespace tunica::fluid {

/// Value is double or Vec3. Built from a Value, from f(t) or from f(x, t), plain functions among them;
/// x [m], t [s].
template <class Value>
class BoundaryFunction {
 public:
  BoundaryFunction() : BoundaryFunction(zero()) {}

  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, BoundaryFunction>)
      BoundaryFunction(F&& f)  // NOLINT: the conversion is the point
      : object_(std::make_shared<const Stored<F>>(std::forward<F>(f))), call_(&call<Stored<F>>) {}

  [[nodiscard]] Value operator()(const Vec3& x, double t) const { return call_(object_.get(), x, t); }

 private:
  /// A constant is kept as a Value: an expression of Eigen would refer to what is gone. A function is kept
  /// by its address.
  template <class F>
  using Stored = std::conditional_t<std::is_convertible_v<F, Value>, Value, std::decay_t<F>>;

  static Value zero() {
    if constexpr (std::is_arithmetic_v<Value>)
      return 0;
    else
      return Value::Zero();
  }

  template <class F>
  static Value call(const void* object, const Vec3& x, double t) {
    const F& f = *static_cast<const F*>(object);
    if constexpr (std::is_same_v<F, Value>)  // first: a vector can be called with two numbers
      return f;
    else if constexpr (std::is_invocable_v<const F&, const Vec3&, double>)
      return f(x, t);
    else {
      static_assert(std::is_invocable_v<const F&, double>,
                    "a boundary value is a constant, a function of time or a function of (place, time)");
      return f(t);
    }
  }

  std::shared_ptr<const void> object_;
  Value (*call_)(const void*, const Vec3&, double);
};

}  // namespace tunica::fluid
