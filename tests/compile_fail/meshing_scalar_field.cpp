// SPDX-License-Identifier: MIT
// SAYS: a field has a value at a point: f.value(x) or f(x)
#include "tunica/meshing/scalar_field.hpp"

using namespace tunica;

/// A field of the radius, where one of a point is needed.
#ifdef RIGHT
const auto field = [](const Vec3& x) { return 1 - x.norm(); };
#else
const auto field = [](double r) { return 1 - r; };
#endif

double value() {
  return meshing::field_value(field, Vec3(1, 0, 0));
}
