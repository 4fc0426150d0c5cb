// A quadratic programme is three things: a Hessian with a linear term, equality constraints, and a set that can be projected on.
//
//     minimise  1/2 x'A x - b'x   subject to  G x = e  and  x in Omega
//
// A, G and Omega, but for the radii of its discs, stay from load step to load step: the programme. b and e are new in each.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/tpetra.hpp"
#include "qp/equality.hpp"
#include "qp/feasible_set.hpp"

namespace mortise::qp {

/// What is new in a load step. A value: one that is shared is replaced, never written to.
struct RightHandSide {
  Vector b;                           ///< the linear term
  Eigen::VectorXd e;                  ///< of G x = e, whole on every rank
  std::optional<Vector> driven = {};  ///< A x of an x that e asks for apart from b: its size counts like that of b
  /// Of A = B K^+ B' + S, see sparse_newton.hpp: the f, of each of this rank's blocks of K, and the c that b = B K^+ f - c and
  /// e = R'f come from. Of others empty.
  std::vector<Eigen::VectorXd> f = {};
  Eigen::VectorXd c = {};
};

/// A with its products counted: the figure by which solvers are compared.
class Hessian {
 public:
  /// Makes A x - b at once.
  using Gradient = std::function<void(const Vector& x, const RightHandSide& right, Vector& gradient)>;
  /// `a` outlives it; `limit`: applications after which it is exhausted. `gradient`: where A x and b are large and lose what
  /// their difference has, who makes that; else empty.
  explicit Hessian(const Operator& a, int limit, Gradient gradient = {}) : a_(&a), gradient_(std::move(gradient)), limit_(limit)
  {
  }
  /// y = A x. Collective.
  void apply(const Vector& x, Vector& y)
  {
    ++count_;
    a_->apply(x, y);
  }
  /// A x - b, which counts as a product. Collective.
  void gradient(const Vector& x, const RightHandSide& right, Vector& gradient)
  {
    ++count_;
    if (gradient_) return gradient_(x, right, gradient);
    a_->apply(x, gradient);
    gradient.update(-1, right.b, 1);
  }
  int count() const { return count_; }                 ///< applications so far, the same on all ranks
  bool exhausted() const { return count_ >= limit_; }  ///< whether the limit is reached; apply() works beyond it
  /// Another number of applications after which it is exhausted; the same on all ranks.
  void set_limit(int limit) { limit_ = limit; }
  Teuchos::RCP<const Map> map() const { return a_->getDomainMap(); }

 private:
  const Operator* a_;
  Gradient gradient_;
  int limit_;
  int count_ = 0;
};

/// Two unknowns that are free along a tangent of their disc alone, where the disc bends it: A has `curvature` more there.
struct SlipDirection {
  std::array<Local, 2> index;
  Eigen::Vector2d tangent;
  double curvature;
};

/// An approximation of A^-1, symmetric positive semidefinite, that may adapt to the active set it serves.
class ActiveSetPreconditioner : public Operator {
 public:
  /// Until the next call, of what it is applied to and of what is used of the result the unknowns `fixed` of this rank are 0, and
  /// those of `slips` are along their tangents. Collective.
  virtual void fix(std::span<const Local> fixed, std::span<const SlipDirection> slips) = 0;
  /// Whether it is one of (A + curvatures of `slips`)^-1 then; if not, its arguments and results want to be scaled.
  virtual bool knows_curvature() const { return false; }
  /// No less than sup (r'x)^2 / x'A x over all x with G x = 0 and x = 0 where fixed: the square of the error that a residual r
  /// stands for. r'M r is, if M comes from an approximation of the displacements that close the gaps r; a sharper one may cost
  /// as much as a product with A. Collective.
  virtual double energy(const Vector& r)
  {
    Vector z(r.getMap());
    apply(r, z);
    return r.dot(z);
  }
};

/// What all problems of a sequence have in common. Refers to its parts; they outlive it and do not change.
struct Programme {
  Hessian& hessian;                    ///< A
  const EqualityConstraint& equality;  ///< G
  const FeasibleSet& set;              ///< Omega, whatever the radii of its discs
};

/// One of them. Refers to its parts for the time of a solve.
struct Problem {
  Problem(const Programme& programme, const RightHandSide& right_side, const FeasibleSet& omega)
      : hessian(programme.hessian), equality(programme.equality), right(right_side), set(omega)
  {
  }

  Hessian& hessian;                    ///< A
  const EqualityConstraint& equality;  ///< G
  const RightHandSide& right;          ///< b, e
  const FeasibleSet& set;              ///< Omega, with the radii that its discs have
};

/// What tolerances are relative to: ||P b||, or the size beside which rounding of b stays below `tolerance`, if that is larger
/// (where supports move bodies rigidly P b should be zero and b is not). The same of RightHandSide::driven, if that is larger.
/// Collective.
double relative_size(const Problem& problem, double tolerance);

/// Where a solver stands, for the history and the progress line.
struct Progress {
  std::string what;  ///< norm, inner or outer: what has just been done; of face Newton, outer steps change the active set
  int outer = 0;
  int applications = 0;
  double projected_gradient = 0;  ///< relative
  double equality = 0;            ///< relative; of face Newton, what the slip bounds would change
  double precision = 0;           ///< M of SMALSE-M
  FeasibleSet::Active active{};   ///< on this rank
  int preconditionings = 0;
  double energy = std::numeric_limits<double>::quiet_NaN();  ///< 1/2 x'A x - b'x of face Newton's point
  double error = std::numeric_limits<double>::quiet_NaN();   ///< the estimate of ||x - x*||_A there
  const Vector* point = nullptr;                             ///< of outer steps: x in Omega,
  const FeasibleSet* set = nullptr;                          ///< and Omega
  /// What the error may be at the end; not a number while nobody has asked for it, or where a residual is the goal.
  double allowed_error = std::numeric_limits<double>::quiet_NaN();
};
using Observer = std::function<void(const Progress&)>;

}  // namespace mortise::qp
