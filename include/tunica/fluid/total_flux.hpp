// SPDX-License-Identifier: MIT
// The flux that an increment of the pressure brings through all pressure patches together: as the weak form
// has it and as the velocity gets it, and the update by which the form has it as the velocity gets it.
#pragma once

#include "tunica/fluid/boundary_terms.hpp"
#include "tunica/fluid/element.hpp"
#include "tunica/fluid/weak_pressure.hpp"
#include "tunica/la/vector_ops.hpp"

#include <cstddef>
#include <vector>

namespace tunica::fluid {

/// Both are linear in the increment p and the prescribed c (nodes), per gamma: g.p - b.c of the weak form A,
/// g = A 1; and f.p - h.c of the velocity -M^-1 (int N grad p - <N (p - c) n>), which with y = M^-1 <N n> is
///   -y . int N grad p + <(p - c) y.n>.
/// A' p = A p - g (g.p - b.c) / (g.1) + f (f.p - h.c) / (f.1) has A' 1 = f: the continuity equations then add
/// up to the flux of the velocity itself. A' is symmetric, and positive with A since f.1 = n.M^-1 n > 0: the
/// update of Broyden, Fletcher, Goldfarb and Shanno for the direction 1. [NOCEDAL06, 6.1]
struct TotalFlux {
  Eigen::VectorXd g, b, f, h;  // nodes; none without pressure patches
  double g_sum = 0, f_sum = 0;
  std::vector<double> share;  // of each patch in f.1: what is added goes through it [-]

  [[nodiscard]] bool none() const { return f.size() == 0; }
  [[nodiscard]] double of_form(const Eigen::VectorXd& p, const Eigen::VectorXd& c) const {
    return la::dot(g, p) - la::dot(b, c);
  }
  [[nodiscard]] double of_velocity(const Eigen::VectorXd& p, const Eigen::VectorXd& c) const {
    return la::dot(f, p) - la::dot(h, c);
  }
  /// y += scale (A' - A) p for the fluxes of p.
  void update(double scale, double form, double velocity, Eigen::VectorXd& y) const {
    const double of_g = -scale * form / g_sum, of_f = scale * velocity / f_sum;
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] += of_g * g[i] + of_f * f[i];
  }
};

[[nodiscard]] inline TotalFlux total_flux(const Domain& domain, const UnitResponse& response) {
  TotalFlux t;
  if (!domain.conditions.any_pressure()) return t;
  const Eigen::Index n = domain.position.cols();
  for (Eigen::VectorXd* v : {&t.g, &t.b, &t.f, &t.h}) v->setZero(n);
  for (Eigen::Index e = 0; e < domain.cells.cols(); ++e) {
    const fem::P1Tet& tet = domain.tets[static_cast<Index>(e)];
    Vec3 y(0, 0, 0);  // int y
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) y[k] += tet.volume / 4 * response.load(k, domain.cells(i, e));
    for (int i = 0; i < 4; ++i) t.f[domain.cells(i, e)] -= along(y, tet.grad, i);
  }
  for (const Condition& c : domain.conditions.list()) {
    t.share.push_back(0);
    if (c.kind != Kind::pressure) continue;
    for (Eigen::Index k = 0; k < c.faces.cols(); ++k) {
      const Vec3 area = Conditions::area_vector(domain.position, c.faces, k);
      Vec3 y;  // y.n |F|
      for (int i = 0; i < 3; ++i) y[i] = dot(column(response.load, c.faces(i, k)), area);
      const Vec3 load = face_load(1, y);
      for (int i = 0; i < 3; ++i) {
        t.f[c.faces(i, k)] += load[i], t.h[c.faces(i, k)] += load[i];
        t.share.back() += load[i];
      }
      const WeakFace face(domain, response, c, k);
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          t.g[face.node(j)] += face.entry(i, j), t.b[face.node(j)] += face.penalty(i, j);
    }
  }
  t.g_sum = t.g.sum(), t.f_sum = t.f.sum();
  double shares = 0;
  for (const double s : t.share) shares += s;
  for (double& s : t.share) s /= shares;
  return t;
}

}  // namespace tunica::fluid
