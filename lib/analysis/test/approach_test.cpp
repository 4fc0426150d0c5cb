// One way to solve after the other, with attempts that are made up. The same on any ranks.
#include "analysis/approach.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "model/deck.hpp"
#include "partition/decompose.hpp"
#include "testing/quiet.hpp"

namespace mortise::analysis {
namespace {

using Kind = Approach::Kind;

class Approaches : public testing::Test {
 protected:
  Approaches()
      : document_(R"(
mesh: {blocks: {cube: {size: [1, 1, 1], cells: [2, 2, 2]}}}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {cube: {material: steel}}
decomposition: {method: grid, counts: {cube: [2, 1, 1]}}
)",
                  "deck.yaml", {}),
        deck_(model::read_deck(document_, "")),
        bodies_(partition::decompose(deck_.mesh, deck_.decomposition, 3, quiet_.context))
  {
  }
  ExitStatus run(const Attempt& attempt, const std::optional<Approach>& resumed = {})
  {
    return try_approaches(deck_, bodies_, attempt, quiet_.context, resumed);
  }
  // The outcome of an attempt that throws `error` after so many products.
  Outcome thrown(const Approach& approach, int spent, const Error& error)
  {
    try {
      throw error;
    } catch (...) {
      return failed(approach, spent, quiet_.comm);
    }
  }

 private:
  Quiet quiet_;
  deck::Document document_;
  model::Deck deck_;
  partition::Decomposition bodies_;
};

TEST_F(Approaches, CountWhatThoseBeforeThemSpent)
{
  std::vector<Kind> tried;
  std::vector<int> spent;
  const auto status = run([&](const partition::Decomposition&, const Approach& approach) -> Outcome {
    tried.push_back(approach.kind);
    spent.push_back(approach.spent);
    if (approach.kind == Kind::as_asked) return {.status = {}, .next = Kind::direct_instead, .spent = 50};
    if (approach.kind == Kind::direct_instead) return thrown(approach, 70, Error(ExitStatus::not_converged, "rounding"));
    return {ExitStatus::solved};
  });
  EXPECT_EQ(status, ExitStatus::solved);
  EXPECT_EQ(tried, (std::vector<Kind>{Kind::as_asked, Kind::direct_instead, Kind::products_to_the_end}));
  EXPECT_EQ(spent, (std::vector<int>{0, 50, 70}));
}

TEST_F(Approaches, CutLargeSubdomainsFirstWhereThatIsNext)
{
  std::vector<Kind> tried;
  std::vector<bool> smaller;
  const auto status = run([&](const partition::Decomposition&, const Approach& approach) -> Outcome {
    tried.push_back(approach.kind);
    smaller.push_back(approach.smaller);
    if (approach.kind == Kind::as_asked) return {.status = {}, .next = Kind::smaller_subdomains, .spent = 80};
    if (approach.kind == Kind::smaller_subdomains) return {.status = {}, .spent = 140};
    EXPECT_EQ(approach.spent, 140);
    return {ExitStatus::solved};
  });
  EXPECT_EQ(status, ExitStatus::solved);
  EXPECT_EQ(tried, (std::vector<Kind>{Kind::as_asked, Kind::smaller_subdomains, Kind::direct_instead}));
  EXPECT_EQ(smaller, (std::vector<bool>{false, true, true}));
}

// A direct solution begins with what products on the first subdomains came to.
TEST_F(Approaches, TakeBodiesWholeBeforeADirectSolutionWhereThatIsNext)
{
  std::vector<Kind> tried;
  const auto run_whole = [&](const auto& outcome_of_whole) {
    tried.clear();
    return run([&](const partition::Decomposition&, const Approach& approach) -> Outcome {
      tried.push_back(approach.kind);
      if (approach.kind == Kind::as_asked) return {.status = {}, .next = Kind::whole_bodies, .spent = 100};
      if (approach.kind == Kind::whole_bodies) return outcome_of_whole(approach);
      EXPECT_EQ(approach.spent, 250);
      return {ExitStatus::solved};
    });
  };
  EXPECT_EQ(run_whole([](const Approach&) -> Outcome { return {ExitStatus::solved}; }), ExitStatus::solved);
  EXPECT_EQ(tried, (std::vector<Kind>{Kind::as_asked, Kind::whole_bodies}));
  EXPECT_EQ(run_whole([](const Approach&) -> Outcome { return {.status = {}, .spent = 250}; }), ExitStatus::solved);
  EXPECT_EQ(tried, (std::vector<Kind>{Kind::as_asked, Kind::whole_bodies, Kind::direct_instead}));
  EXPECT_EQ(run_whole([&](const Approach& approach) {
              return thrown(approach, 250, Error(ExitStatus::machine, "no room", Error::Cause::memory));
            }),
            ExitStatus::solved);
}

// Errors that another way does not mend end the run, wherever they come from.
TEST_F(Approaches, EndWithErrorsThatAreNoFaultOfTheirs)
{
  const auto fail_with = [&](ExitStatus status, Kind at) {
    int attempts = 0;
    try {
      run([&](const partition::Decomposition&, const Approach& approach) -> Outcome {
        ++attempts;
        if (approach.kind == at) return thrown(approach, 10, Error(status, "no"));
        return approach.kind == Kind::products_to_the_end ? Outcome{ExitStatus::solved} : Outcome{.status = {}, .spent = 10};
      });
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), status);
      return attempts;
    }
    return -attempts;
  };
  EXPECT_EQ(fail_with(ExitStatus::no_equilibrium, Kind::as_asked), 1);
  EXPECT_EQ(fail_with(ExitStatus::not_converged, Kind::as_asked), 1);
  EXPECT_EQ(fail_with(ExitStatus::no_equilibrium, Kind::direct_instead), 2);
  EXPECT_EQ(fail_with(ExitStatus::bad_input, Kind::direct_instead), -3);
}

// A record of another model, on which a run that goes on finds a direct solution at work.
TEST_F(Approaches, EndWhereARecordIsOfAnotherModel)
{
  Approach resumed;
  resumed.kind = Kind::direct_instead;
  int attempts = 0;
  EXPECT_THROW(run(
                   [&](const partition::Decomposition&, const Approach& approach) -> Outcome {
                     ++attempts;
                     return thrown(approach, 0, Error(ExitStatus::bad_input, "stale"));
                   },
                   resumed),
               Error);
  EXPECT_EQ(attempts, 1);
}

}  // namespace
}  // namespace mortise::analysis
