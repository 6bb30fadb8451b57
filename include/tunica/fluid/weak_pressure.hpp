// SPDX-License-Identifier: MIT
// A pressure increment prescribed weakly, so that continuity holds at the nodes of its patch too. [NITSCHE71]
#pragma once

#include "tunica/fluid/domain.hpp"
#include "tunica/fluid/unit_response.hpp"

#include <algorithm>
#include <cstddef>

namespace tunica::fluid {

/// The terms of one face |F| of a pressure patch in
///   (w grad q, grad p) - <w q, dp/dn> - <w dq/dn, p - c> + <sigma q, p - c>,
/// c the prescribed increment. The form stands for D M^-1 D^T, the divergence of what an increment does to
/// the velocity under a prescribed load; unlike an increment held at the nodes it leaves no row of continuity
/// out. w is the part of a gradient that arrives at the velocity, and sigma the flux through the face that a
/// unit load brings (UnitResponse): the flux of linear increments and of uniform loads is met as it is.
/// With m such faces at the tetrahedron V and its weight w_V the form is positive for
///   sigma >= m w^2 |F| / (w_V V), as
///   2 sum <w p, dp/dn> <= w_V V |grad p|^2 + m / (w_V V) sum w^2 |F|^2 mean(p)^2.
/// That takes each tetrahedron by itself; together they need less, tests hold response.least of it to be
/// enough on flat and on ruined elements. More would move the pressure at the patch too little.
class WeakFace {
 public:
  WeakFace(const Domain& domain, const UnitResponse& response, const Condition& c, Eigen::Index f) {
    const Index cell = c.cells[static_cast<std::size_t>(f)];
    const fem::P1Tet& tet = domain.tets[cell];
    const Vec3 n = Conditions::area_vector(domain.position, c.faces, f);
    node_ = domain.cells.data() + 4 * std::ptrdiff_t{cell};
    for (int a = 0; a < 4; ++a) {
      slope_[a] = along(n, tet.grad, a);
      on_[a] = node_[a] == c.faces(0, f) || node_[a] == c.faces(1, f) || node_[a] == c.faces(2, f);
    }
    area_ = length(n);
    double flux = 0;  // that a unit load brings [m]
    for (int i = 0; i < 3; ++i) {
      third_ += response.gradient[c.faces(i, f)] / 9;
      flux += dot(column(response.load, c.faces(i, f)), n) / 3;
    }
    const double w = 3 * third_, m = c.loaded[static_cast<std::size_t>(f)];
    const double enough = m * w * w * area_ / (response.arriving(node_) * tet.volume);
    sigma_ = std::max(flux / area_, response.least * enough);
  }

  [[nodiscard]] Index node(int i) const { return node_[i]; }

  /// Of the matrix: row i, column j.
  [[nodiscard]] double entry(int i, int j) const { return penalty(i, j) - third(i) * slope_[j]; }

  /// Of the form for the increment p and the prescribed c (nodes), tested with N_i.
  [[nodiscard]] double form(int i, const Eigen::VectorXd& p, const Eigen::VectorXd& c) const {
    double sum = 0;
    for (int j = 0; j < 4; ++j)
      sum += penalty(i, j) * (p[node_[j]] - c[node_[j]]) - third(i) * slope_[j] * p[node_[j]];
    return sum;
  }

  /// <sigma N_i - dN_i/dn, N_j>
  [[nodiscard]] double penalty(int i, int j) const {
    const double mass = on_[i] && on_[j] ? area_ / 12 * (i == j ? 2 : 1) : 0;
    return sigma_ * mass - slope_[i] * third(j);
  }

 private:
  [[nodiscard]] double third(int i) const { return on_[i] ? third_ : 0; }

  const Index* node_;  // 4, of the tetrahedron
  bool on_[4];         // the face
  double slope_[4];    // |F| dN/dn [m]
  double area_;        // [m2]
  double third_ = 0;   // of w [-]
  double sigma_;       // [1/m]
};

/// visit(WeakFace) for the faces of all pressure patches.
template <class Visit>
void for_each_weak_face(const Domain& domain, const UnitResponse& response, Visit&& visit) {
  for (const Condition& c : domain.conditions.list())
    if (c.kind == Kind::pressure)
      for (Eigen::Index f = 0; f < c.faces.cols(); ++f) visit(WeakFace(domain, response, c, f));
}

}  // namespace tunica::fluid
