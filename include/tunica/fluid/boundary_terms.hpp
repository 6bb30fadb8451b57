// SPDX-License-Identifier: MIT
// Boundary integrals of the momentum equation: prescribed pressures and the stress against backflow.
#pragma once

#include "tunica/fem/assembly.hpp"
#include "tunica/fluid/conditions.hpp"
#include "tunica/la/vector_ops.hpp"

namespace tunica::fluid {

/// int N_i q over a face of that area for a nodal q: area/12 (sum q + q_i).
[[nodiscard]] inline Vec3 face_load(double area, const Vec3& q) {
  const double sum = q[0] + q[1] + q[2], s = area / 12;
  return {s * (sum + q[0]), s * (sum + q[1]), s * (sum + q[2])};
}

/// Adds -int N_i p n of the prescribed pressures (nodes) to right (3 x nodes), and the matrix of
/// -beta rho int (a.n)_- N_i N_j of the outlets with backflow stabilisation. [MOGHADAM11]
inline void add_boundary_terms(const fem::Assembly<mesh::Tet4, 1>& pattern, const Conditions& conditions,
                               const Points<3>& x, const Points<3>& a, const Eigen::VectorXd& prescribed,
                               double density, la::RowMatrix& matrix, Points<3>& right) {
  for (const Condition& c : conditions.list()) {
    if (c.kind != Kind::pressure) continue;
    for (Eigen::Index f = 0; f < c.faces.cols(); ++f) {
      const Vec3 n = Conditions::area_vector(x, c.faces, f);
      const Vec3 p(prescribed[c.faces(0, f)], prescribed[c.faces(1, f)], prescribed[c.faces(2, f)]);
      const Vec3 load = face_load(1, p);
      for (int i = 0; i < 3; ++i) add(right, c.faces(i, f), -load[i], n);
      if (c.backflow == 0) continue;
      const double flux = Conditions::flux(x, c.faces, a, f);
      if (flux >= 0) continue;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          matrix.valuePtr()[pattern.find(c.faces(j, f), c.faces(i, f))] +=
              -c.backflow * density * flux / 12 * (i == j ? 2 : 1);
    }
  }
}

}  // namespace tunica::fluid
