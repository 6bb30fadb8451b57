// SPDX-License-Identifier: MIT
// Lengths in files that no geometry can be made of: areas and volumes of them would vanish or overflow.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::io {

/// InputError "<name>: <what> is <value>: ..." unless the length is between least_length and most_length.
inline void require_length(const std::string& name, const std::string& what, double length) {
  if (length >= least_length && length <= most_length) return;
  throw InputError(name + ": " + what + " is " + seven_digits(length) + ": lengths lie between " +
                   seven_digits(least_length) + " and " + seven_digits(most_length));
}

/// The same of the coordinates of an axis, x, y or z, and of the spacings between them.
inline void require_lengths(const std::string& name, char axis, const std::vector<double>& coordinates) {
  for (const double x : coordinates)
    if (!(std::abs(x) <= most_length)) require_length(name, std::string("coordinate ") + axis, x);
  for (std::size_t i = 1; i < coordinates.size(); ++i)
    require_length(name, std::string("spacing ") + axis, coordinates[i] - coordinates[i - 1]);
}

}  // namespace tunica::io
