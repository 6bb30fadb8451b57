// SPDX-License-Identifier: MIT
// The divergence of a nodal velocity, tested with the shape functions.
#pragma once

#include "tunica/fluid/domain.hpp"

namespace tunica::fluid {

/// out = int N div u: nodes [m3/s]; u: 3 x nodes [m/s].
inline void divergence(const Domain& domain, const Points<3>& u, Eigen::VectorXd& out) {
  out.setZero(u.cols());
  domain.pattern.for_each_cell([&](Index e) {
    const fem::P1Tet& tet = domain.tets[e];
    const Nodal3 ue = nodal(u, domain.cells, e);
    double q = 0;
    for (int k = 0; k < 12; ++k) q += ue.data()[k] * tet.grad.data()[k];
    for (int i = 0; i < 4; ++i) out[domain.cells(i, e)] += tet.volume / 4 * q;
  });
}

}  // namespace tunica::fluid
