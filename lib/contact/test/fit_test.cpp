// What a contact starts with: gaps of the meshes, of the deck, of the geometry.
#include "contact/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "surfaces.hpp"

namespace mortise::contact {
namespace {

auto arc(double radius)
{
  return [radius](double x, double y) { return Point(radius * std::sin(x), y, radius * std::cos(x)); };
}

// A part of a pin in a hole, axis y; facets so large that the surfaces behind them do not come out the same.
Pair pin_in_hole(double pin, double hole, const Communicator& comm)
{
  return make_pair(surface({5, 2, -0.6, 0.6, 0, 1, true}, arc(pin), comm),
                   surface({8, 3, -0.7, 0.5, 0.3, 1.3, false, false, primary_ids}, arc(hole), comm), Law::frictionless);
}

// All faces of both sides on cylinders.
std::vector<CurvedFace> on_cylinders(const Pair& pair, double pin, double hole)
{
  std::vector<CurvedFace> faces;
  const auto add = [&](const mesh::Surface& side, double radius) {
    for (const Global face : side.face_id)
      faces.emplace_back(face, mesh::CurvedSurface{{0, 0.1 * radius, 0}, {0, 1, 0}, radius, 0});
  };
  add(pair.secondary, pin);
  add(*pair.primary, hole);
  return faces;
}

struct Found {
  std::vector<double> gaps;  // of all points, ascending
  InitialGap initial;
};

Found find(const Pair& pair, const std::vector<CurvedFace>& curved, const Communicator& comm)
{
  std::vector<InitialGap> initial;
  const auto contacts = discretize(std::vector{pair}, {}, fem::Kinematics::solid, comm, {}, curved, &initial);
  std::vector<double> gaps;
  for (const auto& point : contacts.nodes) {
    gaps.push_back(point.gap / point.weight);
    EXPECT_NEAR(contacts.rows.bound[point.row], point.gap, 1e-15);
  }
  gaps = comm.all_gather(gaps);
  std::sort(gaps.begin(), gaps.end());
  return {gaps, initial.at(0)};
}

TEST(Fit, DeckGoesBeforeGeometryBeforeMesh)
{
  Options options;
  EXPECT_EQ(starting_gap(options, -0.02, false), -0.02);
  EXPECT_EQ(starting_gap(options, -0.02, true), 0);
  options.adjust = 0.02;
  EXPECT_EQ(starting_gap(options, -0.02, false), 0);
  EXPECT_EQ(starting_gap(options, 0.02, false), 0);
  EXPECT_EQ(starting_gap(options, 0.03, true), 0.03);
  options.adjust = 0;
  EXPECT_EQ(starting_gap(options, -0.02, true), -0.02);
  options.adjust.reset();
  options.clearance = 0.5;
  EXPECT_EQ(starting_gap(options, -0.02, true), 0.5);
  EXPECT_FALSE(asks_geometry(options));
}

// A gap that is small for the size of the sides is a gap all the same.
TEST(Fit, WhatIsNearDoesNotTouch)
{
  const Communicator comm;
  const auto near = find(pin_in_hole(10, 10.0005, comm), {}, comm).initial;
  EXPECT_GT(near.smallest, 0);
  EXPECT_LT(near.largest, near.touching);
  EXPECT_EQ(near.touching_area, 0);
  EXPECT_NEAR(near.near_area, near.area, 1e-9 * near.area);
}

// By both discretizations, also at points that look past the border of the primary side.
TEST(Fit, ClearanceIsTheGapOfEveryPoint)
{
  const Communicator comm;
  for (const char* discretization : {"mortar", "node_to_segment"}) {
    auto pair = pin_in_hole(10, 10.02, comm);
    pair.options.discretization = discretization;
    const auto raw = find(pair, {}, comm);
    for (const double gap : raw.gaps) EXPECT_NEAR(gap, 0.02, 1e-4);
    EXPECT_EQ(raw.initial.smallest, raw.gaps.front());
    EXPECT_EQ(raw.initial.largest, raw.gaps.back());
    EXPECT_EQ(raw.initial.touching_area, 0);
    for (const double clearance : {0.0, 0.05}) {
      pair.options.clearance = clearance;
      const auto found = find(pair, {}, comm);
      EXPECT_EQ(found.gaps, std::vector<double>(raw.gaps.size(), clearance));
      EXPECT_EQ(found.initial.smallest, clearance);
      EXPECT_EQ(found.initial.largest_overlap(), 0);
      EXPECT_EQ(found.initial.least_in_mesh, raw.gaps.front());
      EXPECT_EQ(found.initial.largest_in_mesh, raw.gaps.back());
      EXPECT_NEAR(found.initial.touching_area, clearance > 0 ? 0 : found.initial.area, 1e-12);
    }
    pair.options.clearance = 0;
    pair.options.interference = 0.02;
    for (const double gap : find(pair, {}, comm).gaps) EXPECT_NEAR(gap, -0.02, 1e-15);
  }
}

TEST(Fit, AdjustIsForSmallGapsAlone)
{
  const Communicator comm;
  auto pair = pin_in_hole(10, 10, comm);
  const auto raw = find(pair, {}, comm);
  const double largest = std::max(std::abs(raw.gaps.front()), std::abs(raw.gaps.back()));
  pair.options.adjust = 1.01 * largest;
  EXPECT_EQ(find(pair, {}, comm).gaps, std::vector<double>(raw.gaps.size(), 0.0));
  pair.options.adjust = 0.5 * largest;
  for (const double gap : find(pair, {}, comm).gaps) EXPECT_TRUE(gap == 0 || std::abs(gap) > 0.5 * largest);
  EXPECT_EQ(find(pair, {}, comm).gaps.size(), raw.gaps.size());
}

TEST(Fit, FacesOfOneSurfaceTouch)
{
  const Communicator comm;
  for (const char* discretization : {"mortar", "node_to_segment"}) {
    auto pair = pin_in_hole(10, 10, comm);
    pair.options.discretization = discretization;
    const auto raw = find(pair, {}, comm);
    const auto found = find(pair, on_cylinders(pair, 10, 10), comm);
    EXPECT_EQ(found.gaps, std::vector<double>(raw.gaps.size(), 0.0));
    EXPECT_NEAR(found.initial.on_one_surface, found.initial.area, 1e-12);
    // Smooth surfaces are exact on cylinders: the meshes say the same.
    for (const double gap : raw.gaps) EXPECT_NEAR(gap, 0, 1e-8);
    // A clearance that the geometry has is kept, and so is what the deck says.
    auto loose = pin_in_hole(10, 10.001, comm);
    loose.options.discretization = discretization;
    EXPECT_EQ(find(loose, on_cylinders(loose, 10, 10.001), comm).gaps, find(loose, {}, comm).gaps);
    EXPECT_EQ(find(loose, on_cylinders(loose, 10, 10.001), comm).initial.on_one_surface, 0);
    pair.options.adjust = 0;
    EXPECT_EQ(find(pair, on_cylinders(pair, 10, 10), comm).gaps, raw.gaps);
    // Where only one of the sides is known nothing is.
    pair.options.adjust.reset();
    auto half = on_cylinders(pair, 10, 10);
    std::erase_if(half, [](const CurvedFace& face) { return face.node >= primary_ids; });
    EXPECT_EQ(find(pair, half, comm).gaps, raw.gaps);
  }
}

// An obstacle that a curved body drawn 0.1 above it fits, by the deck.
TEST(Fit, ClearanceGoesForObstaclesToo)
{
  const Communicator comm;
  const auto wavy = [](double x, double y) { return Point(x, y, 0.1 + 0.01 * std::sin(3 * x)); };
  const auto above = surface({4, 4, 0, 1, 0, 1, false}, wavy, comm);
  Pair pair{{}, above, nullptr};
  pair.options.obstacle = Obstacle{Obstacle::Shape::plane, Point::Zero(), Point::UnitZ(), 0, false};
  pair.options.search_distance = 0.2;
  const auto raw = find(pair, {}, comm);
  EXPECT_NEAR(raw.initial.smallest, 0.1, 1e-12);
  EXPECT_EQ(raw.gaps.size(), 25U);
  pair.options.clearance = 0;
  EXPECT_EQ(find(pair, {}, comm).gaps, std::vector<double>(25, 0.0));
  pair.options.clearance.reset();
  pair.options.adjust = 0.101;
  const auto adjusted = find(pair, {}, comm).gaps;
  EXPECT_EQ(std::count(adjusted.begin(), adjusted.end(), 0.0), 5);
}

TEST(Fit, OverlapHasAPlace)
{
  const Communicator comm, alone(MPI_COMM_SELF);
  const auto bump = [](double x, double y) { return Point(x, y, 0.01 * std::exp(-40 * ((x - 1) * (x - 1) + y * y))); };
  const auto flat = [](double x, double y) { return Point(x, y, 0.004); };
  const auto of = [&](const Communicator& ranks) {
    return find(make_pair(surface({8, 8, 0, 2, -1, 1, true}, bump, ranks),
                          surface({5, 5, 0, 2, -1, 1, false, false, primary_ids}, flat, ranks), Law::frictionless),
                {}, ranks)
        .initial;
  };
  const auto found = of(comm), expected = of(alone);
  EXPECT_NEAR(found.largest_overlap(), 0.006, 1e-9);
  EXPECT_NEAR(found.at[0], 1, 1e-12);
  EXPECT_NEAR(found.at[1], 0, 1e-12);
  EXPECT_NEAR(found.area, 4, 0.01);
  EXPECT_GT(found.touching_area, 0.06);
  EXPECT_LT(found.touching_area, 0.5);
  EXPECT_EQ(found.smallest, expected.smallest);
  EXPECT_EQ(found.at, expected.at);
  EXPECT_NEAR(found.touching_area, expected.touching_area, 1e-12);
}

}  // namespace
}  // namespace mortise::contact
