// What is found without a solution, and what needs numbers alone: each threshold from both sides.
#include "post/model_checks.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "post/nonconformity.hpp"
#include "post/strength.hpp"

namespace mortise::post {
namespace {

BodyMaterial steel()
{
  return {"plate", 100, {2.1e5, 0.3, 7.85e-9, 0}, fem::Formulation::standard, true};
}

TEST(Locking, is_for_nearly_incompressible_standard_cells_of_first_order)
{
  auto body = steel();
  EXPECT_TRUE(locking({body}, fem::Kinematics::solid).empty());
  body.material.poisson_ratio = 0.49;
  const auto found = locking({steel(), body}, fem::Kinematics::plane_strain);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, "locking");
  EXPECT_EQ(found[0].body, "plate");
  EXPECT_EQ(found[0].value, 0.49);
  EXPECT_TRUE(locking({body}, fem::Kinematics::plane_stress).empty());
  auto other = body;
  other.formulation = fem::Formulation::bbar;
  EXPECT_TRUE(locking({other}, fem::Kinematics::solid).empty());
  other = body;
  other.first_order = false;
  EXPECT_TRUE(locking({other}, fem::Kinematics::solid).empty());
}

TEST(MixedUnits, densities_that_go_with_other_lengths)
{
  EXPECT_TRUE(mixed_units({steel()}, {}).empty());
  const BodyMaterial si{"plate", 0.1, {2.1e11, 0.3, 7850, 0}, fem::Formulation::standard, true};
  EXPECT_TRUE(mixed_units({si}, {}).empty());
  const BodyMaterial gel{"gel", 0.1, {1e4, 0.4, 1000, 0}, fem::Formulation::standard, true};
  EXPECT_TRUE(mixed_units({gel}, {}).empty());
  auto mixed = steel();
  mixed.material.density = 7850;  // kg/m3 beside mm and MPa
  const auto found = mixed_units({steel(), mixed}, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, "mixed_units");
  EXPECT_NEAR(found[0].value, 19.3, 0.1);
  mixed = si;
  mixed.material.density = 7.85e-9;
  EXPECT_EQ(mixed_units({mixed}, {}).size(), 1U);
}

TEST(MixedUnits, densities_in_other_units_beside_the_modulus)
{
  const auto found = [](double young_modulus, double density, bool weighs = true) {
    BodyMaterial body{"plate", 2, {young_modulus, 0.3, density, 0}, fem::Formulation::standard, true, weighs};
    return mixed_units({body}, {});
  };
  const auto told = found(2.1e5, 7.85e-6);  // kg/mm3 beside MPa
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NEAR(told[0].value, 1000, 1e-9);
  EXPECT_EQ(told[0].cure, "density: 7.85e-09, t/mm3 goes with MPa and mm");
  EXPECT_TRUE(found(2.1e5, 7.85e-6, false).empty());
  EXPECT_EQ(found(2.1e5, 7850).size(), 1U);
  EXPECT_EQ(found(7e4, 2700).size(), 1U);
  EXPECT_EQ(found(7e4, 2.7e-6).size(), 1U);
  EXPECT_EQ(found(2.1e11, 7.85e-6).size(), 1U);
  EXPECT_EQ(found(3e7, 0.283).size(), 1U);
  for (const auto& [e, density] : {std::pair(2.1e5, 7.85e-9),
                                   {7e4, 2.7e-9},
                                   {2.1e11, 7850.0},
                                   {3e10, 2400.0},
                                   {2.1e8, 7.85},
                                   {2.1e8, 7.85e-6},
                                   {2.1e12, 7.85},
                                   {3e7, 7.3e-4},
                                   {1e4, 1000.0},
                                   {5e6, 1100.0},
                                   {1e7, 60.0},
                                   {1.65e5, 2.33e-15},
                                   {3000.0, 1.4e-9},
                                   {2.1e5, 7.85e-3},
                                   {2000.0, 1.0},
                                   {2.1e5, 1.0}})
    EXPECT_TRUE(found(e, density).empty()) << e << " " << density;
}

TEST(MixedUnits, loads_that_go_with_other_moduli)
{
  EXPECT_TRUE(mixed_units({}, {{"top", 250, 2.1e5}, {"top", 0, 2.1e5}, {"top", 1e4, 2.1e11}}).empty());
  EXPECT_EQ(mixed_units({}, {{"top", 250e6, 2.1e5}}).size(), 1U);
  EXPECT_EQ(mixed_units({}, {{"top", 100, 2.1e11}}).size(), 1U);
  const auto found = mixed_units({}, {{"top", 250e6, 2.1e5}, {"side", 500e6, 2.1e5}});
  ASSERT_EQ(found.size(), 1U);  // the worst speaks for both
  EXPECT_EQ(found[0].boundary, "side");
  EXPECT_NE(found[0].text.find("1 other loads"), std::string::npos);
}

TEST(MixedUnits, stresses_that_hardly_strain)
{
  const std::vector<std::string> bodies{"lower", "upper"};
  const Found stress{400, Point(1, 2, 3), 1};  // of 250 MPa beside 2.1e11 Pa
  const auto found = weak_stresses({{"top", 250, 2.1e11}}, stress, 2.1e11, bodies);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, "mixed_units");
  EXPECT_EQ(found[0].body, "upper");
  EXPECT_EQ(found[0].boundary, "top");
  EXPECT_TRUE(weak_stresses({{"top", 250, 2.1e11}}, {4e4, Point::Zero(), 1}, 2.1e11, bodies).empty());  // wind that bends a plate
  EXPECT_TRUE(weak_stresses({{"top", 250, 2.1e11}, {"side", 0, 2.1e11}}, stress, 2.1e11, bodies).empty());  // a formula
  EXPECT_TRUE(weak_stresses({{"top", 250, 2.1e11}, {"side", 1e6, 2.1e11}}, stress, 2.1e11, bodies).empty());
  EXPECT_TRUE(weak_stresses({{"top", 100, 2.1e11}}, stress, 2.1e11, bodies).empty());  // told before the solution
  EXPECT_TRUE(weak_stresses({}, stress, 2.1e11, bodies).empty());                      // a weight, warmth, a fit
  EXPECT_TRUE(weak_stresses({{"top", 250, 2.1e11}}, {0, Point::Zero(), 1}, 2.1e11, bodies).empty());
}

TEST(StrainedSupports, force_over_area)
{
  const SupportLoad seat{"seat", {0, 0, 1e5}, 100, Point(1, 2, 3), 2.1e5};
  EXPECT_TRUE(strained_supports({seat}, 1e5).empty());
  auto sliver = seat;
  sliver.area = 1;
  const auto found = strained_supports({seat, sliver}, 1e5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 1e5);
  EXPECT_EQ(found[0].limit, 2.1e3);
  EXPECT_EQ(*found[0].at, Point(1, 2, 3));
  sliver.area = 0;
  EXPECT_EQ(strained_supports({sliver}, 1e5).size(), 1U);
  sliver.force = {1e-3, 0, 0};  // rounding
  EXPECT_TRUE(strained_supports({sliver}, 1e5).empty());
}

TEST(PointForces, are_told_where_they_matter)
{
  EXPECT_TRUE(point_forces({{"support legs", 0.9}}, 1e3).empty());
  const auto found = point_forces({{"support legs", 2}, {"load tip", 30}}, 1e3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].text.find("load tip acts with 30 on nodes alone"), std::string::npos) << found[0].text;
  EXPECT_EQ(found[0].value, 30);
}

TEST(CoarseMesh, says_where_and_how_much_of_it)
{
  MeshError error;
  error.relative = 0.3;
  error.cells = {{1, Point(0, 0, 0)}, {4, Point(1, 2, 3)}};
  error.part = {0.2, 0.8};
  const auto found = coarse_mesh(error, {"left", "right"});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].body, "right");
  EXPECT_EQ(*found[0].at, Point(1, 2, 3));
  EXPECT_NE(found[0].text.find("80 % of its square"), std::string::npos);
  error.relative = 0.25;
  EXPECT_TRUE(coarse_mesh(error, {"left", "right"}).empty());
}

TEST(CoarseSecondary, beside_what_stresses_show_and_of_the_solution)
{
  std::vector<contact::Pair> pairs(2);
  pairs[0].options.name = "left";
  pairs[1].options.name = "right";
  const auto found = [&](double own, double beside, double norm, double whole) {
    const ContactError error{own * own, beside * beside, norm * norm, 0.25, Point(1, 2, 0)};
    return coarse_secondaries(std::vector<ContactError>{{}, error}, whole * whole, pairs);
  };
  const auto one = found(0.066, 0.1, 1, 1);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].kind, "coarse_secondary");
  EXPECT_EQ(one[0].contact, "right");
  EXPECT_NEAR(one[0].value, 0.066, 1e-12);
  EXPECT_NEAR(one[0].limit, 0.065, 1e-12);
  EXPECT_NE(one[0].text.find("0.25"), std::string::npos);
  EXPECT_EQ(*one[0].at, Point(1, 2, 0));
  EXPECT_TRUE(found(0.064, 0.1, 1, 1).empty());
  EXPECT_TRUE(found(0.049, 0.01, 1, 1).empty());
  EXPECT_EQ(found(0.051, 0.01, 1, 1).size(), 1U);
  EXPECT_EQ(found(0.051, 0.01, 1, 50).size(), 1U);
  EXPECT_TRUE(found(0.051, 0.01, 1, 52).empty());
}

TEST(FacetPush, from_a_thousandth_of_the_largest_force)
{
  EXPECT_TRUE(facet_push(1e-3, Point(0, 0, 1)).empty());
  const auto found = facet_push(1e-2, Point(0, 0, 10));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 1e-2);
}

TEST(UnresistedLoads, are_told_with_body_and_motion)
{
  EXPECT_TRUE(unresisted_loads({}, {"pin", "plate"}).empty());
  std::vector<feti::UnresistedLoad> loads(2);
  loads[0] = {1, "moves along (0, 0, 1)", false, 0.05, 5e-5, 1e-9, true};
  loads[1] = {0, "rotates about the axis", true, 2, 8e-3, 6e-3, true};
  const auto found = unresisted_loads(loads, {"pin", "plate"});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].body, "pin");
  EXPECT_NE(found[0].text.find("body \"pin\" rotates about the axis, driven by a moment of 2"), std::string::npos);
  EXPECT_NE(found[0].text.find("1 other motions"), std::string::npos);
}

TEST(Tensions, are_of_what_pulls)
{
  contact::ContactNodeState pulls, presses, open;
  pulls.force = -6;
  pulls.area = 2;
  pulls.status = contact::Status::stick;
  presses = pulls;
  presses.force = 8;
  presses.contact = 1;
  open = pulls;
  open.status = contact::Status::open;
  open.contact = 2;
  const std::vector<contact::ContactNodeState> points{pulls, presses, open};
  EXPECT_EQ(largest_tensions(points, 3, Communicator()), (std::vector<double>{3, 0, 0}));
}

// A tenth of an interference may be the meshes' error; the bonded may overlap, and so may what does not meet.
TEST(UnaskedOverlaps, are_those_that_no_interference_asks_for)
{
  contact::InitialGap gap;
  gap.smallest = -0.05;
  gap.touching = 0.001;
  gap.area = 1;
  contact::Options plain;
  plain.name = "plain";
  const auto count = [](contact::InitialGap g, const contact::Options& options) {
    return unasked_overlaps(std::vector{g}, std::vector{options}).size();
  };
  EXPECT_EQ(count(gap, plain), 1U);
  auto fit = plain;
  fit.interference = 0.49;
  EXPECT_EQ(count(gap, fit), 1U);
  fit.interference = 0.51;
  EXPECT_EQ(count(gap, fit), 0U);
  fit.interference = -0.06;  // a gap opened by more than the overlap
  EXPECT_EQ(count(gap, fit), 0U);
  fit.interference = -0.04;
  EXPECT_EQ(count(gap, fit), 1U);
  auto bonded = plain;
  bonded.law = contact::Law::bonded;
  EXPECT_EQ(count(gap, bonded), 0U);
  auto none = gap;
  none.area = 0;
  EXPECT_EQ(count(none, plain), 0U);
  auto rounding = gap;
  rounding.smallest = -0.9 * contact::overlapping * gap.touching;
  EXPECT_EQ(count(rounding, plain), 0U);
  auto worse = gap;
  worse.smallest = -0.2;
  const auto found = unasked_overlaps(std::vector{gap, worse}, std::vector{plain, fit});
  ASSERT_EQ(found.size(), 2U);  // the largest first
  EXPECT_EQ(found[0].value, 0.2);
  EXPECT_EQ(found[1].value, 0.05);
  EXPECT_EQ(found[1].contact, "plain");
}

// A chamfer in a fit, beside a fit whose gap the meshes have to an error of theirs.
TEST(ModelChecks, ClearancesThatCloseMoreThanErrorsOfMeshes)
{
  contact::Options fit;
  fit.name = "fit";
  fit.clearance = 0;
  contact::InitialGap even;
  even.face = 2;
  for (const double gap : {0.6, 0.8, 1.09}) contact::note_gap(even, 0, gap, false, 1, Point(gap, 2, 3));
  auto uneven = even;
  contact::note_gap(uneven, 0, 1.11, false, 1, Point(4, 5, 6));
  EXPECT_TRUE(uneven_clearances(std::vector{even}, std::vector{fit}).empty());
  const auto found = uneven_clearances(std::vector{even, uneven}, std::vector{fit, fit});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_DOUBLE_EQ(found[0].value, 1.11 - 0.6);
  EXPECT_EQ(found[0].limit, 0.5);
  EXPECT_EQ(found[0].at, Point(4, 5, 6));
  auto plain = fit;
  plain.clearance.reset();
  EXPECT_TRUE(uneven_clearances(std::vector{uneven}, std::vector{plain}).empty());
}

// Twelve faces a turn and thirteen, and twelve of which only a part touches.
TEST(ModelChecks, ArcsOfTwelveFacesATurn)
{
  contact::Options fit;
  fit.name = "fit";
  const auto with_faces = [](double a_turn, int apart) {
    contact::InitialGap gap;
    gap.touching = 0.01;
    contact::note_gap(gap, 0, 0, false, 1, Point(0, 0, 0));
    for (int i = 0; i < apart; ++i) contact::note_gap(gap, 1, 1, false, 1, Point(0, 0, 0));
    contact::note_turn(gap, 0.1, 0, Point(1, 0, 0));
    contact::note_turn(gap, 2 * std::numbers::pi / a_turn, 0.3, Point(4, 5, 6));
    return std::vector{gap};
  };
  const auto found = coarse_arcs(with_faces(12, 0), std::vector{fit});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].value, 30, 1e-9);
  EXPECT_EQ(found[0].at, Point(4, 5, 6));
  EXPECT_NE(found[0].text.find("by 0.3 between"), std::string::npos) << found[0].text;
  EXPECT_TRUE(coarse_arcs(with_faces(13, 0), std::vector{fit}).empty());
  EXPECT_TRUE(coarse_arcs(with_faces(12, 1), std::vector{fit}).empty());
  contact::InitialGap apart;
  apart.touching = 0.01;
  contact::note_gap(apart, 0.3, 0.3, false, 1, Point(0, 0, 0));
  contact::note_turn(apart, 0.6, 0.3, Point(1, 0, 0));
  EXPECT_EQ(coarse_arcs(std::vector{apart}, std::vector{fit}).size(), 1U);
}

// A bond across a gap of a tenth of a face; where it touches somewhere the mesh may be to blame, though not for half a face.
TEST(ModelChecks, BondsBetweenSidesThatTouchNowhere)
{
  contact::Options bond;
  bond.name = "glue";
  bond.law = contact::Law::bonded;
  contact::InitialGap apart;
  apart.face = 2;
  for (const double gap : {0.2, 0.3}) contact::note_gap(apart, 0, gap, false, 1, Point(gap, 2, 3));
  auto touching = apart;
  contact::note_gap(touching, 0, 0.03, false, 1, Point(4, 5, 6));
  EXPECT_TRUE(bonded_gaps(std::vector{touching}, std::vector{bond}).empty());
  const auto found = bonded_gaps(std::vector{touching, apart}, std::vector{bond, bond});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 0.2);
  EXPECT_EQ(found[0].limit, 0.04);
  EXPECT_EQ(found[0].contact, "glue");
  contact::note_gap(touching, 0, 1, false, 1, Point(7, 8, 9));
  const auto beyond = bonded_gaps(std::vector{touching}, std::vector{bond});
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_EQ(beyond[0].value, 1);
  EXPECT_EQ(beyond[0].limit, 0.5);
  EXPECT_EQ(beyond[0].at, Point(7, 8, 9));
  auto bolt = bond;
  bolt.preload.emplace();
  auto open = bond;
  open.law = contact::Law::frictionless;
  EXPECT_TRUE(bonded_gaps(std::vector{apart, apart}, std::vector{bolt, open}).empty());
}

}  // namespace
}  // namespace mortise::post
