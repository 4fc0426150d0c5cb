#include "post/verdict.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace mortise::post {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Evidence good()
{
  Evidence e;
  e.converged = true;
  e.projected_gradient = 1e-3;
  e.equality = e.equilibrium = 1e-12;
  e.penetration = e.complementarity = 1e-4;
  return e;
}

TEST(Verdict, is_solved_where_all_fits)
{
  const auto v = verdict(good());
  EXPECT_EQ(v.status, ExitStatus::solved);
  EXPECT_EQ(v.headline, "Solved.");
  EXPECT_EQ(v.reason, "");
}

TEST(Verdict, does_not_believe_the_solver_alone)
{
  auto e = good();
  e.projected_gradient = 2.2;
  const auto v = verdict(e);
  EXPECT_EQ(v.status, ExitStatus::not_converged);
  EXPECT_NE(v.reason.find("gradient 2.2 (limit 0.5)"), std::string::npos);
}

TEST(Verdict, a_small_error_excuses_the_gradient_of_incompressible_bodies)
{
  auto e = good();
  e.projected_gradient = 270;
  e.algebraic_error = 5e-3;
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);
  e.algebraic_error = 4e-2;
  EXPECT_EQ(verdict(e).status, ExitStatus::not_converged);
}

TEST(Verdict, every_number_can_spoil_it)
{
  using Member = double Evidence::*;
  for (const Member m : std::initializer_list<Member>{&Evidence::projected_gradient, &Evidence::equality, &Evidence::equilibrium,
                                                      &Evidence::penetration, &Evidence::complementarity, &Evidence::supports,
                                                      &Evidence::interfaces, &Evidence::imbalance}) {
    for (const double bad : {1.0, std::numeric_limits<double>::infinity(), nan}) {
      auto e = good();
      e.*m = bad;
      EXPECT_EQ(verdict(e).status, ExitStatus::not_converged);
    }
  }
}

TEST(Verdict, a_loose_tolerance_of_the_deck_counts)
{
  auto e = good();
  e.tolerance = 0.8;
  e.projected_gradient = 0.7;
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);
  e.equilibrium = 0.7;  // not the solver's
  EXPECT_EQ(verdict(e).status, ExitStatus::not_converged);
}

TEST(Verdict, a_large_error_is_not_solved)
{
  auto e = good();
  e.algebraic_error = 0.24;
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);
  e.algebraic_error = 0.26;
  EXPECT_EQ(verdict(e).status, ExitStatus::not_converged);
  e.algebraic_error = 250;
  EXPECT_EQ(verdict(e).status, ExitStatus::not_converged);
  e.algebraic_error = nan;  // none was made
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);
}

TEST(Verdict, a_limit_is_named)
{
  auto e = good();
  e.converged = false;
  e.limit = "solver.max_multiplications";
  e.drift = {3, "body \"block\" moves along (1, 0, 0)"};  // on its way
  const auto v = verdict(e);
  EXPECT_EQ(v.status, ExitStatus::not_converged);
  EXPECT_NE(v.reason.find("ended by solver.max_multiplications"), std::string::npos);
}

TEST(Verdict, a_body_that_drifts_has_no_equilibrium)
{
  auto e = good();
  e.drift = {1.3, "body \"plate\" moves along (0, 0, 1)"};
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);  // soft bodies under large loads
  e.projected_gradient = 2.2;
  EXPECT_EQ(verdict(e).status, ExitStatus::no_equilibrium);
  EXPECT_NE(verdict(e).reason.find("body \"plate\" moves along (0, 0, 1)"), std::string::npos);
  e = good();
  e.drift.sizes = 1e4;
  EXPECT_EQ(verdict(e).status, ExitStatus::solved);  // a stiff body on a soft one
  e.drift.sizes = nan;
  EXPECT_EQ(verdict(e).status, ExitStatus::no_equilibrium);
}

TEST(UnreachedTolerance, is_told_beyond_twice_what_was_asked_for)
{
  Residuals residuals;
  residuals.projected_gradient = 2.1e-10;
  const auto told = unreached_tolerance(residuals, 1e-10, 3e-9);
  ASSERT_EQ(told.size(), 1);
  EXPECT_EQ(told[0].kind, "unreached_tolerance");
  EXPECT_EQ(told[0].value, 2.1e-10);
  EXPECT_EQ(told[0].limit, 1e-10);
  EXPECT_TRUE(unreached_tolerance(residuals, 1.1e-10, 3e-9).empty());
  EXPECT_TRUE(unreached_tolerance(residuals, 0, 3e-9).empty());  // auto
}

}  // namespace
}  // namespace mortise::post
