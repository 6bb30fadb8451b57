// SPDX-License-Identifier: MIT
// The tangent of a body as an operator: K v by packs of cells through the kernel, without a matrix.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/pack_math.hpp"
#include "tunica/solid/body.hpp"
#include "tunica/solid/law_packs.hpp"

#include <Eigen/Core>

#include <type_traits>

namespace tunica::solid {

/// A linear operator for Krylov solvers, y = K(u) v [N] with the tangent K of the inner forces at u
/// (pressures of cells are U'(theta); supports and loads are not in it). Fixed unknowns stand apart: y = v
/// there.
///   TangentAction K{wall.body(), u};  la::cg(K, la::Identity{}, b, x);
/// `body` and `u` outlive it. Not for NodalPressure, nor after augment().
template <class Body>
class TangentAction {
  using Inside = typename Body::Inside;
  static_assert(Body::per_node == 3, "the action without a matrix is that of displacements alone");

 public:
  TangentAction(const Body& body, const Eigen::VectorXd& u) : body_(body), u_(u) {
    TUNICA_EXPECT(u.size() == body.unknowns(), "as many numbers as the body has unknowns");
    for (Index e = 0; e < body.mesh().cell_count(); ++e)
      TUNICA_EXPECT((body.inside().multiplier(e) == 0).all(),
                    "an augmented Lagrangian has its tangent as a matrix");
  }

  void apply(const Eigen::VectorXd& v, Eigen::VectorXd& y) const {
    Eigen::VectorXd moved = v;
    body_.clear_fixed(moved);
    y.setZero(v.size());
    const auto& assembly = body_.inside().assembly();
    const auto& laws = body_.laws();
    const bool prestressed = !laws.prestress().empty();
    const la::BlockMatrix<3>* const no_matrix = nullptr;
    for_each_law_pack<width>(assembly, laws, no_matrix, [&](const auto& pack, const auto& law) {
      typename Element::template Nodal<S> X, at, w, Kw;
      assembly.gather(pack, body_.mesh().nodes, X);
      assembly.gather(pack, u_, at);
      assembly.gather(pack, moved, w);
      typename Element::template Data<typename Body::Laws::Law, S> data[Element::points];
      Tensor<S> stored[Element::points];
      gather_points<S>(laws, pack, data, stored);
      Element::action(law, X, at, needs_point<typename Body::Laws::Law> ? data : nullptr,
                      prestressed ? stored : nullptr, w, Kw);
      assembly.add(pack, Kw, y);
    });
    for (Index k = 0; k < body_.unknowns(); ++k)
      if (body_.fixed(k)) y[k] = v[k];
  }

 private:
  using Element = typename Inside::Element;
  using S = Pack<double>;
  static constexpr int width = Lanes<S>::count;

  const Body& body_;
  const Eigen::VectorXd& u_;
};
template <class Body>
TangentAction(const Body&, const Eigen::VectorXd&) -> TangentAction<Body>;

}  // namespace tunica::solid
