// All that is known of a column under pressure, and what evaluate() makes of states that are none. The same on any ranks.
#include "pieces.hpp"
#include "post/results.hpp"

namespace mortise::post {
namespace {

constexpr double on_top = 3, load_on_top = on_top * Pieces::area, height = 2;
constexpr double stored_energy = 0.5 * on_top * on_top / Pieces::young * Pieces::area * height;

class PressedColumn {
 public:
  PressedColumn()
  {
    column_.guide();
    pairs_ = column_.touch();
    column_.add_traction("upper.zmax", Point(0, 0, -on_top));
    for (std::size_t s = 0; s < column_.decomposition.subdomains.size(); ++s)
      constitution_.push_back({fem::Material{Pieces::young, Pieces::poisson, 0, 0}});
    problem_ = column_.problem();
    found = solved(*problem_);
    u = problem_->displacement(found->solution.x, found->solution.nu);
  }
  // Adds a displacement.
  template <class Field>
  void move(const Field& field, Global only = -1)
  {
    const auto more = column_.displacement(field, only);
    for (std::size_t s = 0; s < u.size(); ++s) u[s] += more[s];
  }
  Results results() const
  {
    const ElasticBodies bodies{column_.decomposition, column_.interface, fem::Kinematics::solid, constitution_, 1};
    return evaluate({*problem_, column_.system, pairs_, *found, u, 5, 1e-8, 0, {}, 0}, bodies, column_.comm);
  }

  std::optional<feti::DualSolution> found;
  std::vector<Eigen::VectorXd> u;

 private:
  Pieces column_;
  std::vector<contact::Pair> pairs_;
  std::vector<fem::Constitution> constitution_;
  std::optional<feti::DualProblem> problem_;
};

TEST(Evaluate, TellsOfAColumnWhatFormulasTell)
{
  const PressedColumn column;
  const auto r = column.results();
  const double strain = on_top / Pieces::young;
  const double longest = strain * std::hypot(Pieces::poisson * 1, Pieces::poisson * 2, height);  // the corner opposite the guides
  EXPECT_NEAR(r.fields.max_displacement, longest, 1e-11);
  EXPECT_NEAR(r.fields.stress.largest_von_mises.value, on_top, 1e-8);
  EXPECT_NEAR(r.fields.stress.strain_energy, stored_energy, 1e-10);
  EXPECT_LT(r.accuracy.mesh_error.relative, 1e-6);
  EXPECT_LT(r.accuracy.algebraic_error, 1e-8);
  ASSERT_EQ(r.forces.reactions.size(), 5U);
  expect_near(r.forces.reactions[0].force, {0, 0, load_on_top});
  EXPECT_LT((r.forces.balance.applied - Point(0, 0, -load_on_top)).norm(), 1e-12);
  EXPECT_LT(r.forces.balance.difference, 1e-9);
  EXPECT_NEAR(r.contact.resultants.at(0).force[2], load_on_top, 1e-8);
  ASSERT_EQ(r.neglected.moments.size(), 1U);
  EXPECT_LT(r.neglected.moments[0].lost, 1e-8);
  EXPECT_TRUE(r.forces.couplings.empty() && r.forces.springs.empty() && r.forces.shortenings.empty() &&
              r.fields.extremes.empty());
  EXPECT_LT(r.accuracy.residuals.equilibrium, 1e-9);
  for (const double residual : {r.accuracy.residuals.penetration, r.accuracy.residuals.complementarity,
                                r.accuracy.residuals.supports, r.accuracy.residuals.interfaces})
    EXPECT_LT(residual, 1e-8);
  EXPECT_EQ(r.verdict.status, ExitStatus::solved) << r.verdict.reason;
}

// A rigid motion of parts strains nothing: residuals are its length over the largest displacement, gap times force over the
// energy.
TEST(Evaluate, MeasuresWhatIsMoved)
{
  const double t = 1e-3;
  const auto body = [](int which, const Point& by) {
    return [=](const Point&, int b) { return b == which || which < 0 ? by : Point(Point::Zero()); };
  };
  for (const bool up : {true, false}) {
    PressedColumn column;
    column.move(body(1, {0, 0, up ? t : -t}));
    const auto r = column.results();
    EXPECT_NEAR(r.accuracy.residuals.penetration, up ? 0 : t / r.fields.max_displacement, 1e-7);
    EXPECT_NEAR(r.accuracy.residuals.complementarity, load_on_top * t / (2 * stored_energy), 1e-7);
    EXPECT_LT(r.accuracy.residuals.equilibrium, 1e-8);
    EXPECT_LT(r.accuracy.residuals.supports, 1e-8);
    EXPECT_EQ(r.verdict.status, ExitStatus::not_converged);
  }
  PressedColumn lifted;
  lifted.move(body(-1, {0, 0, t}));
  auto r = lifted.results();
  EXPECT_NEAR(r.accuracy.residuals.supports, t / r.fields.max_displacement, 1e-7);
  EXPECT_LT(r.accuracy.residuals.penetration, 1e-8);
  EXPECT_EQ(r.verdict.status, ExitStatus::not_converged);

  PressedColumn torn;
  torn.move(body(-1, {0, 0, t}), 3);
  r = torn.results();
  EXPECT_NEAR(r.accuracy.residuals.interfaces, t / 2 / r.fields.max_displacement, 1e-7);
  EXPECT_LT(r.accuracy.residuals.supports, 1e-8);
  EXPECT_EQ(r.verdict.status, ExitStatus::not_converged);
}

TEST(Evaluate, MissesForces)
{
  PressedColumn column;
  column.found->solution.x.scale(0.9);
  auto r = column.results();
  EXPECT_NEAR(r.forces.balance.difference, 0.1, 1e-8);
  EXPECT_GT(r.accuracy.residuals.equilibrium, 1e-3);
  EXPECT_EQ(r.verdict.status, ExitStatus::not_converged);

  PressedColumn unfinished;
  unfinished.found->converged = false;
  EXPECT_EQ(unfinished.results().verdict.status, ExitStatus::not_converged);

  // The solver's error over what is stored, in the energy norm.
  PressedColumn doubtful;
  const double norm = std::sqrt(2 * stored_energy);
  doubtful.found->solution.error = 0.24 * norm;
  r = doubtful.results();
  EXPECT_NEAR(r.accuracy.algebraic_error, 0.24, 1e-6);
  EXPECT_EQ(r.verdict.status, ExitStatus::solved) << r.verdict.reason;
  doubtful.found->solution.error = 0.26 * norm;
  EXPECT_EQ(doubtful.results().verdict.status, ExitStatus::not_converged);
}

TEST(LargestDisplacement, IsThatOfTheNodesOfAllRanks)
{
  const Communicator comm;
  const std::vector<Eigen::VectorXd> u{(Eigen::VectorXd(6) << 1, 0, -3, 4.0 * (1 + comm.rank()), 0, 0).finished()};
  EXPECT_NEAR(largest_displacement(u, 3, comm), 4 * comm.size(), 1e-12);
  EXPECT_NEAR(largest_displacement(u, 2, comm), std::hypot(3, 4 * comm.size()), 1e-12);
}

}  // namespace
}  // namespace mortise::post
