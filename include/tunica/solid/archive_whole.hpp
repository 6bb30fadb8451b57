// SPDX-License-Identifier: MIT
// Vectors of a body in a checkpoint: one that comes back must have the size of the body it comes back to.
#pragma once

#include "tunica/core/error.hpp"

#include <Eigen/Core>

#include <string>

namespace tunica::solid {

/// a(name, v), for writing or reading. InputError with both sizes if what was read belongs to another body.
template <class Archive>
void archive_whole(Archive& a, const char* name, Eigen::VectorXd& v) {
  const Eigen::Index size = v.size();
  a(name, v);
  if (v.size() != size)
    throw InputError("checkpoint", name,
                     std::to_string(v.size()) + " numbers where this body has " + std::to_string(size));
}

}  // namespace tunica::solid
