// The way into a solution of a condensed programme from inside of its set: an interior point method. Every bound and every disc
// lets go a little earlier and pushes back a little before it is met, so that all points depend smoothly on all others:
//
//     W x + H'nu - b = s at bounds, s+ - s- at intervals, -lambda t / r at discs (t from the centre), H x - C nu = e,
//     (x - lower) s = tau,   (r + t) s+ = (r - t) s- = tau,   lambda (r^2 - t't) / (2 r) = tau,   r given, or coefficient x_n,
//
// tau from large to nothing, by Newton's method with a predictor and a corrector [Mehrotra, SIAM J. Optim. 2 (1992)]. With radii
// that are given the programme is convex, and the path leads to its solution; with Coulomb's law it is not, and mostly does
// [Acary, Armand, Nguyen and Shpakovych, Optim. Methods Softw. 39 (2024)]. Some 15 to 30 linear problems, from anywhere.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact_system.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

class CentralPath {
 public:
  /// `set` over the unknowns of `system`, which outlives it; `bound_of` of each disc: the bound of the unknown that its radius
  /// follows, -1 if the radius is given. From an x and nu near, which need not be inside.
  CentralPath(const ContactSystem& system, const FeasibleSet& set, const std::vector<int>& bound_of, Eigen::VectorXd b,
              Eigen::VectorXd e, Eigen::VectorXd x, Eigen::VectorXd nu);

  /// One linear problem further. False if that leads nowhere, as to infinity. Throws as stop_if_requested and factorize().
  bool advance();
  const Eigen::VectorXd& x() const { return at_.x; }
  const Eigen::VectorXd& nu() const { return at_.nu; }
  struct Distance {
    double product;          // tau, on average
    double forces, motions;  // norms of what the equations lack
  };
  Distance distance() const;

 private:
  struct Side {  // a bound, or an end of an interval: room = offset + sign x[along] + coefficient x[normal]
    Local along;
    double sign, offset, coefficient = 0;
    Local normal = -1;
    double room(const Eigen::VectorXd& x) const { return offset + change(x); }
    double change(const Eigen::VectorXd& step) const
    {
      return sign * step[along] + (normal < 0 ? 0 : coefficient * step[normal]);
    }
  };
  struct Round {  // a disc of two unknowns, of a finite radius that is not zero
    Disc disc;
    double coefficient;  // 0 if the radius is given
  };
  struct Iterate {
    Eigen::VectorXd x, nu, s, lambda;  // s of sides_, lambda of rounds_
  };
  struct Residual {
    Eigen::VectorXd forces, motions, sides, rounds;
    Residual& add(double part, const Residual& other);
    double mean() const;   // what products are on average
    double least() const;  // and the least of them
  };
  class Linear;

  bool symmetric() const;
  void add_disc(const Disc& disc, bool follows);
  void move_inside(const FeasibleSet& set);
  double radius(const Round& round, const Eigen::VectorXd& x) const;
  Residual residual(const Iterate& at) const;
  double longest_step(const Iterate& step) const;
  Iterate moved(const Iterate& step, double length) const;

  const ContactSystem& system_;
  std::vector<Side> sides_;
  std::vector<Round> rounds_;
  std::vector<Local> pinned_;
  Eigen::VectorXd b_, e_;
  Iterate at_;
};

}  // namespace mortise::qp
