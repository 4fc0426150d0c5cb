// How many products a solve may take.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "qp/problem.hpp"

namespace mortise::qp {

/// How many products a solve that something else is ready to take over may take: `products`, and up to `near` more while, at the
/// pace of its residuals, no more than that are left.
struct Patience {
  int products, near = 0;
  Patience(int count, int count_near = 0) : products(count), near(count_near) {}
};

/// A number that is given, for all solves together; else each solve goes on as long as something becomes better by 30 %: the
/// residual, the bound of the error in the energy norm, by how much slip bounds change; or fewer points change their state in a
/// step than ever. It sets the limit of the Hessian that it watches. Of random decks that ended well by products alone the worst
/// went 1,200 products without.
///
/// A solve that something else is ready to take over (`patience`) gives up sooner: after `look` products, if at the pace of its
/// residuals it would take more than its patience, and where nothing has become better for as many.
class Budget {
 public:
  static constexpr int stretch = 2500;  ///< products without anything better that end a solve
  static constexpr int most = 10000;    ///< of one solve, whatever becomes better
  static constexpr int look = 100;      ///< products that tell whether to go on where something else is ready

  /// `given`: the number. `steady`: for an algorithm whose residual may rise for long, where nothing but `most` ends it.
  Budget(Hessian& hessian, std::optional<int> given, bool steady);

  /// Before a solve to the residual `goal`, that gives up when its `patience` ends if there is one.
  void start(std::optional<Patience> patience, double goal = 1e-4);
  /// Another algorithm takes over: its residuals begin anew.
  void change_algorithm();
  /// After a step; `changes`: points whose state changed, if that was an outer step. The arguments are the same on all ranks.
  void note(const Progress& progress, std::optional<long long> changes, double change_of_bounds);

  /// Whether products are left, patience apart.
  bool left() const { return hessian_.count() < end_; }
  /// Whether another algorithm may go on where one has ended: with products left, and nobody who waits for the solve to give up.
  bool may_change() const { return !patience_ && left(); }
  /// What ended a solve whose products are spent, as the key of the deck and a remark.
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
