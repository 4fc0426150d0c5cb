// What a solve leaves open: the record of states, the budget of products, how wide a band of open points is.
#include "../src/open_points.hpp"

#include <gtest/gtest.h>

#include "qp/budget.hpp"
#include "../src/state_record.hpp"

namespace mortise::friction {
namespace {

using enum PointState;

TEST(StateRecord, CountsTurnsOfContactAndFrictionApart)
{
  StateRecord record;
  EXPECT_EQ(record.steps(), -1);
  EXPECT_EQ(record.note({open, closed, sticks, slips}), 0);
  EXPECT_EQ(record.note({closed, closed, slips, open}), 3);
  EXPECT_EQ(record.note({open, closed, sticks, sticks}), 3);
  EXPECT_EQ(record.note({open, closed, slips, slips}), 2);
  const auto turns = record.turns();
  ASSERT_EQ(turns.size(), 4U);
  EXPECT_EQ(record.steps(), 3);
  EXPECT_EQ(turns[0].contact, 2);
  EXPECT_EQ(turns[1].contact + turns[1].friction, 0);
  EXPECT_EQ(turns[2].friction, 3);
  EXPECT_EQ(turns[2].contact, 0);
  EXPECT_EQ(turns[3].contact, 2);  // slips, open, sticks
  EXPECT_EQ(turns[3].friction, 1);
}

TEST(StateRecord, ForgetsWhatIsLongAgo)
{
  StateRecord record;
  for (const auto state : {open, closed, open, closed}) record.note({state});
  EXPECT_EQ(record.turns()[0].contact, 3);
  for (int i = 0; i < StateRecord::kept; ++i) EXPECT_EQ(record.note({closed}), 0);
  EXPECT_EQ(record.turns()[0].contact, 0);
  EXPECT_EQ(record.steps(), StateRecord::kept);
  record.note({closed, open});  // other points
  EXPECT_EQ(record.steps(), 0);
}

// A row of points with spacings that grow, some of them open.
std::vector<Place> row(const std::string& states, double growth = 1)
{
  std::vector<Place> places;
  double x = 0, step = 1;
  for (const char c : states) {
    places.push_back({Point(x, 0, 0), c == '?'});
    x += step;
    step *= growth;
  }
  return places;
}

TEST(WidestBand, OfARowIsTheCellsBetweenDecidedPoints)
{
  EXPECT_EQ(widest_band(row("xxxxx")), 0);
  EXPECT_EQ(widest_band(row("xx?xx")), 2);
  EXPECT_EQ(widest_band(row("xx??xx")), 3);
  EXPECT_EQ(widest_band(row("x?xx???xx")), 4);
  EXPECT_EQ(widest_band(row("xxxx??")), 2);  // up to the end of the surface
  EXPECT_EQ(widest_band(row("????")), 4);    // nothing is decided
  EXPECT_EQ(widest_band(row("xx?xx", 1.2)), 2);
}

TEST(WidestBand, OfARingIsItsThicknessWhereverOneLooks)
{
  constexpr int n = 41, middle = 20;
  for (const int rows : {1, 2, 4}) {
    std::vector<Place> places;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double radius = std::hypot(i - middle, j - middle);
        places.push_back({Point(0.1 * i, 0.3 * j, 0), radius >= 10 && radius < 10 + rows});  // cells three times as long as wide
      }
    const int width = widest_band(places);
    EXPECT_GE(width, rows + 1);
    EXPECT_LE(width, rows + 2);  // steps of the ring
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.4, Point(1, 2, 3).normalized()).matrix();
    for (auto& p : places) p.at = turned * p.at;
    EXPECT_EQ(widest_band(places), width);
  }
}

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
  qp::Hessian hessian{nothing_, 0};
};

qp::Progress at(double residual)
{
  qp::Progress progress{"outer"};
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
  products.take(Budget::stretch - 1);
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
  products.take(Budget::stretch * 3 / 4);
  budget.note(at(1), 19, 1);
  products.take(Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  auto progress = at(1);
  progress.error = 0.1;
  budget.note(progress, 19, 1);
  products.take(Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  budget.note(at(1), 19, 0.4);
  products.take(Budget::stretch * 3 / 4);
  EXPECT_FALSE(products.hessian.exhausted());
  budget.note(at(1), 19, 0.4);
  products.take(Budget::stretch / 4);
  EXPECT_TRUE(products.hessian.exhausted());
}

TEST(Budget, NeverGoesBeyondItsEndWhateverBecomesBetter)
{
  Products products;
  Budget budget(products.hessian, {}, false);
  double residual = 1;
  for (int i = 0; i < Budget::most / 1000; ++i) {
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
  products.take(Budget::most - 1);
  EXPECT_FALSE(products.hessian.exhausted());
  products.take(1);
  EXPECT_TRUE(products.hessian.exhausted());
  Budget patient(products.hessian, {}, false);
  patient.start(30);
  products.take(30);
  EXPECT_TRUE(products.hessian.exhausted());
  EXPECT_TRUE(patient.left());
}

}  // namespace
}  // namespace mortise::friction
