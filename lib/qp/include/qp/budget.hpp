// How many products a solve may take.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "qp/limits.hpp"
#include "qp/problem.hpp"

namespace mortise::qp {

/// How many products a solve may take that another approach is ready to take over from: `products`, and up to `near` more while
/// no more than that are left at the pace of its residuals.
struct Patience {
  int products, near = 0;
  /// A number alone is a patience too.
  Patience(int count, int count_near = 0) : products(count), near(count_near) {}
};

/// Watches a Hessian and sets its limit. That is a number that is given, for all solves together; else each solve goes on as long
/// as something becomes better by 30 % within Limits::stretch products: the residual, the bound of the error in the energy norm,
/// the change of the slip bounds; or fewer points than ever change their state in a step.
///
/// A solve with a patience gives up sooner: from Limits::look products on, if at the pace of its residuals it would take more
/// than its patience, and where nothing has become better for so many.
class Budget {
 public:
  using Limits = limits::Budget;

  /// `hessian` outlives it. `given`: the number, if there is one. `steady`: for an algorithm whose residual may rise for long:
  /// then nothing but Limits::most ends it.
  Budget(Hessian& hessian, std::optional<int> given, bool steady);

  /// Before a solve to the relative residual `goal`, which gives up when its `patience` ends, if it has one.
  void start(std::optional<Patience> patience, double goal = 1e-4);
  /// Another algorithm takes over: its residuals begin anew.
  void change_algorithm();
  /// After a step. `changes`: points whose state changed, if that was an outer step; `change_of_bounds`: relative, of slip
  /// bounds. The arguments are the same on all ranks.
  void note(const Progress& progress, std::optional<long long> changes, double change_of_bounds);

  /// Whether products are left, patience apart.
  bool left() const { return hessian_.count() < end_; }
  /// Whether another algorithm of the same approach may go on where one has ended: products are left, and there is no patience.
  bool may_change() const { return !patience_ && left(); }
  /// For messages, what ended a solve whose products are spent: the key of the deck and a remark.
  std::string reason() const;

 private:
  void set_limit();
  double foreseen() const;

  Hessian& hessian_;
  std::optional<int> given_;
  std::optional<Patience> patience_;
  bool steady_;
  int begin_ = 0, end_ = 0, better_ = 0;  // counts of products: at the start, the last one allowed, where something became better
  struct Best {
    double residual = std::numeric_limits<double>::infinity(), error = residual, bounds = residual;
    long long changes = std::numeric_limits<long long>::max();
  } best_;
  double goal_ = 0, least_ = std::numeric_limits<double>::infinity();  // residuals
  std::optional<std::pair<int, double>> first_;                        // products and residual of the first step
};

}  // namespace mortise::qp
