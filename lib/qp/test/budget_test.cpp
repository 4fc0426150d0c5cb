// How many products a solve may take.
#include "qp/budget.hpp"

#include <gtest/gtest.h>

namespace mortise::qp {
namespace {

// An operator of no unknowns, to count.
class Nothing : public Operator {
 public:
  Teuchos::RCP<const Map> getDomainMap() const override { return map_; }
  Teuchos::RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector&, MultiVector&, Teuchos::ETransp, Scalar, Scalar) const override {}

 private:
  Teuchos::RCP<const Map> map_ = Teuchos::rcp(new Map(0, 0, teuchos(Communicator())));
};

class Products {
 public:
  void take(int count)
  {
    Vector x(nothing_.getDomainMap()), y(nothing_.getDomainMap());
    for (int i = 0; i < count; ++i) hessian.apply(x, y);
  }

 private:
  Nothing nothing_;

 public:
  Hessian hessian{nothing_, 0};
};

Progress at(double residual)
{
  Progress progress{"outer"};
  progress.projected_gradient = residual;
  return progress;
}

TEST(Budget, EndsWhereNothingBecomesBetter)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  budget.start({});
  products.take(1000);
  budget.note(at(1e-2), {}, 1);
  products.take(limits::Budget::stretch - 1);
  budget.note(at(0.8e-2), {}, 1);  // next to nothing
  EXPECT_FALSE(products.hessian.exhausted());
  products.take(1);
  EXPECT_TRUE(products.hessian.exhausted());
  EXPECT_TRUE(budget.left());
  EXPECT_NE(budget.reason().find("nothing became better"), std::string::npos);
  budget.change_algorithm();
  EXPECT_FALSE(products.hessian.exhausted());
}

TEST(Budget, FewerChangesOrASmallerErrorAreBetter)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  budget.note(at(1e-2), 20, 1);
  products.take(limits::Budget::stretch * 3 / 4);
  budget.note(at(1), 19, 1);
  products.take(limits::Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  auto progress = at(1);
  progress.error = 0.1;
  budget.note(progress, 19, 1);
  products.take(limits::Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  budget.note(at(1), 19, 0.4);
  products.take(limits::Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  budget.note(at(1), 19, 0.4);
  products.take(limits::Budget::stretch / 4);
  EXPECT_TRUE(products.hessian.exhausted());
}

TEST(Budget, NeverGoesBeyondItsEndWhateverBecomesBetter)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  double residual = 1;
  for (int i = 0; i < limits::Budget::most / 1000; ++i) {
    EXPECT_FALSE(products.hessian.exhausted());
    products.take(1000);
    budget.note(at(residual *= 0.4), {}, 1);
  }
  EXPECT_TRUE(products.hessian.exhausted());
  EXPECT_FALSE(budget.left());
  budget.start({});  // the next load step
  EXPECT_FALSE(products.hessian.exhausted());
}

TEST(Budget, ANumberIsTakenAtItsWord)
{
  Products products;
  Budget budget(products.hessian, 5000, false);
  products.take(4999);
  EXPECT_FALSE(products.hessian.exhausted());
  budget.start({});
  products.take(1);
  EXPECT_TRUE(products.hessian.exhausted());
  EXPECT_EQ(budget.reason(), "solver.max_multiplications");
}

TEST(Budget, ASteadyAlgorithmGoesToItsEndAndPatienceEndsSooner)
{
  Products products;
  Budget steady(products.hessian, {}, true);
  products.take(limits::Budget::most - 1);
  EXPECT_FALSE(products.hessian.exhausted());
  products.take(1);
  EXPECT_TRUE(products.hessian.exhausted());
  Budget patient(products.hessian, {}, false);
  patient.start(30);
  products.take(30);
  EXPECT_TRUE(products.hessian.exhausted());
  EXPECT_TRUE(patient.left());
}

TEST(Budget, WaitsForAnEndInSight)
{
  for (const double pace : {0.9, 0.1}) {  // of the residual in ten products: from 1 to 1e-4 in 870, and in 40
    Products products;
    Budget budget(products.hessian, {}, false);
    budget.start(Patience(30, 35), 1e-4);
    double residual = 1;
    for (int i = 0; i < 3; ++i) {
      budget.note(at(residual), {}, 1);
      products.take(10);
      residual *= pace;
    }
    EXPECT_EQ(products.hessian.exhausted(), pace > 0.5);
    products.take(34);
    EXPECT_EQ(products.hessian.exhausted(), pace > 0.5);
    products.take(1);
    EXPECT_TRUE(products.hessian.exhausted());
  }
}

// Something else is ready that is worth 2,000 products.
TEST(Budget, GivesUpWhereTheEndIsFurtherThanItsPatienceReaches)
{
  for (const double pace : {0.97, 0.8}) {  // of the residual in ten products: from 1 to 1e-6 in 4,500, and in 620
    Products products;
    Budget budget(products.hessian, {}, false);
    budget.start(2000, 1e-6);
    double residual = 1;
    for (int spent = 0; spent < limits::Budget::look; spent += 10) {
      EXPECT_FALSE(products.hessian.exhausted());
      budget.note(at(residual), {}, 1);
      products.take(10);
      residual *= pace;
    }
    budget.note(at(residual), {}, 1);
    EXPECT_EQ(products.hessian.exhausted(), pace > 0.9);
    EXPECT_TRUE(budget.left());
  }
}

// A residual that fell by six figures in 100 products falls no more by much.
TEST(Budget, ThePaceIsThatOfLate)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  budget.start(800, 1e-9);
  budget.note(at(1), {}, 1);
  double residual = 1e-6;
  for (int spent = 100; spent < 200; spent += 20) {
    products.take(spent == 100 ? 100 : 20);
    budget.note(at(residual), {}, 1);
    EXPECT_EQ(products.hessian.exhausted(), spent >= 160) << spent;
    residual *= 0.85;  // some 850 products more for three figures
  }
}

TEST(Budget, GivesUpWhereNothingBecomesBetterAndSomethingElseIsReady)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  budget.start(2000, 1e-6);
  budget.note(at(1), {}, 1);
  products.take(80);
  budget.note(at(1e-3), {}, 1);
  products.take(limits::Budget::look - 1);
  budget.note(at(0.9e-3), {}, 1);
  EXPECT_FALSE(products.hessian.exhausted());
  products.take(1);
  EXPECT_TRUE(products.hessian.exhausted());
}

TEST(Budget, StepsWithoutAResidualTellNothing)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  budget.note(Progress{"norm"}, {}, 1);
  products.take(limits::Budget::stretch - 1);
  budget.note(at(1e-2), {}, 1);
  products.take(limits::Budget::stretch - 1);
  EXPECT_FALSE(products.hessian.exhausted());
}

// Whoever waits for a solve to give up wants no other algorithm.
TEST(Budget, AnotherAlgorithmMayTakeOverWhileProductsAreLeftAndNobodyWaits)
{
  Products products;
  Budget budget(products.hessian, 10, false);
  budget.start({});
  EXPECT_TRUE(budget.may_change());
  products.take(9);
  EXPECT_TRUE(budget.may_change());
  products.take(1);
  EXPECT_FALSE(budget.may_change());
  Budget waiting(products.hessian, {}, false);
  waiting.start(100);
  EXPECT_TRUE(waiting.left());
  EXPECT_FALSE(waiting.may_change());
}

}  // namespace
}  // namespace mortise::qp
