// SPDX-License-Identifier: MIT
// What the laws of a body remember, such as Viscoelastic: steps in time, kept, put back, or held in statics.
#pragma once

#include "tunica/core/expect.hpp"
#include "tunica/core/parallel.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/core/types.hpp"
#include "tunica/solid/material.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace tunica::solid {

/// Whether the laws of a body have a history; those without pay nothing for what follows.
template <class Body>
inline constexpr bool has_history = HasHistory<typename Body::Laws::Law>;

/// A step of dt [s] begins; 0 sees the present as it is. `laws` are those of the body.
template <class Laws>
void begin_step(Laws& laws, double dt) requires(HasHistory<typename Laws::Law>) {
  laws.for_each_material([&](auto& law) { solid::begin_step(law, dt); });
}

/// The step ended at u (as vectors of the body): the points keep what happened.
template <class Laws, class Body>
void advance(Laws& laws, const Body& body,
             const Eigen::VectorXd& u) requires(HasHistory<typename Laws::Law>) {
  using Element = typename Body::Element;
  laws.keep_points();
  parallel_chunks(body.mesh().cell_count(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto e = static_cast<Index>(begin); e < static_cast<Index>(end); ++e) {
      const auto deformation = Element::deformation(body.reference(e), body.gather(e, u));
      for (std::size_t q = 0; q < Element::points; ++q) {
        Eigen::Matrix3d F = deformation[q];
        if (!laws.prestress().empty()) F *= laws.data(e).prestress[q];
        Tensor<double> t;
        for (int k = 0; k < 9; ++k) t.m[static_cast<std::size_t>(k)] = F(k / 3, k % 3);
        auto& point = laws.point(e, q);
        point = solid::advance(laws.point_law(e), t, point);
      }
    }
  });
  begin_step(laws, 0);
}

/// All numbers of all points, to be kept and put back.
template <class Laws>
[[nodiscard]] Eigen::VectorXd remembered(Laws& laws) requires(HasHistory<typename Laws::Law>) {
  laws.keep_points();
  Eigen::VectorXd numbers(laws.point_count() * static_cast<Eigen::Index>(point_size<typename Laws::Law>));
  Eigen::Index n = 0;
  laws.for_each_point([&](auto& point) {
    for (const double value : point.m) numbers[n++] = value;
  });
  return numbers;
}
template <class Laws>
void remember(Laws& laws, const Eigen::VectorXd& numbers) requires(HasHistory<typename Laws::Law>) {
  laws.keep_points();
  TUNICA_EXPECT(
      numbers.size() == laws.point_count() * static_cast<Eigen::Index>(point_size<typename Laws::Law>),
      "as many numbers as the points hold");
  Eigen::Index n = 0;
  laws.for_each_point([&](auto& point) {
    for (double& value : point.m) value = numbers[n++];
  });
}

/// The loads of a Statics act for a time dt [s]: equilibrium at its end, which the laws then remember. A step
/// of 0 is a jump. What did not converge is not remembered.
template <class Wall>
auto hold(Wall& wall,
          double dt) requires(HasHistory<typename std::remove_cvref_t<decltype(wall.laws())>::Law>) {
  begin_step(wall.laws(), dt);
  auto report = wall.solve();
  if (report) advance(wall.laws(), wall.body(), wall.unknowns());
  return report;
}

}  // namespace tunica::solid
