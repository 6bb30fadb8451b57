// SPDX-License-Identifier: MIT
// SAYS: staggered: the fourth argument must transfer
#include "tunica/coupling/staggered.hpp"

using namespace tunica;

struct Flow {
  void move(const Points<3>&, double) {}
  SolveReport step(double) { return {}; }
  Points<3> interface_force() const { return {}; }
  void save() {}
  void restore() {}
};
struct Wall {
  void load(const Points<3>&) {}
  SolveReport step(double) { return {}; }
  Points<3> displacement() const { return {}; }
  void save() {}
  void restore() {}
};
struct Motion {
  Points<3> extend(const Points<3>& d) const { return d; }
};
/// A transfer that goes one way only.
struct Pair {
  Points<3> to_fluid(const Points<3>& d) const { return d; }
#ifdef RIGHT
  Points<3> to_structure(const Points<3>& f) const {
    return f;
  }
#endif
};
struct Guess {
  void begin(double) {}
  Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd&) { return x; }
  void accept() {}
};

auto couple(Flow& flow, Wall& wall) {
  return coupling::staggered(flow, wall, Motion{}, Pair{}, Guess{});
}
