// What the direct method needs of a compliance and of motions, whether these are dense matrices that an elimination has left or
// sparse ones that nothing has been eliminated from:
//
//     W x + H'nu - b = s,   H x - C nu = e,   s in the normal cone of a set at x.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// One unknown of a linear problem: x moves along `trial`, what is felt is asked along `test`; test . trial = 1, and different
/// unknowns are orthogonal to each other so. `curvature` is felt besides.
struct Move {
  std::array<Local, 3> index{-1, -1, -1};
  std::array<double, 3> trial{}, test{};
  double curvature = 0;
};

/// The linear problem of one guess: x = base + T a with E'(W x + softening x + H'nu - b) + curvatures a = 0, H x - C nu = e; T
/// and E hold trial and test directions of the moves as columns.
struct Guess {
  std::vector<Move> moves;
  bool symmetric;  ///< trial and test are alike
  Eigen::VectorXd base, softening;
};

/// An entry that a step along the central path adds to W.
struct Stiffening {
  Local row, column;
  double value;
};

/// Factors of W + T and what is to come behind them.
class PathFactor {
 public:
  virtual ~PathFactor() = default;
  struct Step {
    Eigen::VectorXd x, nu;
  };
  /// (W + T) x + H'nu = forces, H x - C nu = -lack; x is zero where it is pinned. `roughly`: some figures will do.
  virtual Step solve(const Eigen::VectorXd& forces, const Eigen::VectorXd& lack, bool roughly) const = 0;
};

/// Compliances of unknowns, with one for both of a disc: the larger.
Eigen::VectorXd shared_by_discs(Eigen::VectorXd own, const FeasibleSet& set);

/// The moves of closed contact that sticks: each unknown of the bounds and of the discs alone, in this order.
std::vector<Move> moves_of_closed(const FeasibleSet& set);

class ContactSystem {
 public:
  virtual ~ContactSystem() = default;

  virtual Eigen::Index unknowns() const = 0;  ///< of x
  virtual Eigen::Index motions() const = 0;   ///< of nu
  /// What each unknown gives way if all others are fixed, or about so much.
  virtual const Eigen::VectorXd& own() const = 0;
  /// The largest W_ii over own, or about so much.
  virtual double largest_ratio() const = 0;
  /// Whether a linear problem costs about as much as its factor in any case, so that few are wanted.
  virtual bool costly() const = 0;

  virtual Eigen::VectorXd give(const Eigen::VectorXd& x) const = 0;   ///< W x
  virtual Eigen::VectorXd push(const Eigen::VectorXd& nu) const = 0;  ///< H'nu
  /// H x - C nu - e, and the same with the other sign.
  virtual Eigen::VectorXd excess(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& e) const = 0;
  virtual Eigen::VectorXd lack(const Eigen::VectorXd& x, const Eigen::VectorXd& nu, const Eigen::VectorXd& e) const = 0;
  /// |W| |x|, and the square of what rounding of one part in one makes of `lack`, in the norm of square().
  virtual Eigen::VectorXd size_of_give(const Eigen::VectorXd& x) const = 0;
  virtual double square_of_rounding(const Eigen::VectorXd& x, const Eigen::VectorXd& nu) const = 0;

  /// l'(C + H D^-1 H')^-1 l, D the compliances of shared_by_discs(), or about so much.
  virtual double square(const Eigen::VectorXd& l) const = 0;
  /// The solution of a guess; x and nu come in as a start, near which motions that nothing holds stay.
  virtual void solve(const Guess& guess, const Eigen::VectorXd& b, const Eigen::VectorXd& e, Eigen::VectorXd& x,
                     Eigen::VectorXd& nu) = 0;
  /// Of W with these entries added, in this order, and `pinned` unknowns. Throws as factorize().
  virtual std::unique_ptr<PathFactor> factor(std::span<const Stiffening> entries, std::span<const Local> pinned,
                                             bool symmetric) const = 0;
};

}  // namespace mortise::qp
