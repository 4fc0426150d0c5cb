// Displacements given to blocks: what counts as large, as a slide, as a cell inside out, as a rigid motion. The same on any
// ranks.
#include "post/deformation.hpp"

#include <gtest/gtest.h>

#include "partition/skins.hpp"
#include "post/contact_motion.hpp"
#include "post/drift.hpp"
#include "post/model_checks.hpp"
#include "post/strength.hpp"
#include "testing/cut.hpp"

namespace mortise::post {
namespace {

// A block 2 x 1 x 1 of 8 cells 0.5 x 0.5 x 1 and one 1 x 1 x 1 of 8 cells on it.
struct Blocks {
  Communicator comm;
  partition::Decomposition decomposition;

  Blocks()
  {
    mesh::Options mesh;
    mesh.blocks["lower"].size = {2, 1, 1};
    mesh.blocks["lower"].cells = {4, 2, 1};
    mesh.blocks["upper"].origin = {0.5, 0, 1};
    mesh.blocks["upper"].cells = {2, 2, 2};
    partition::Options options;
    options.method = "grid";
    options.counts = {{"lower", {2, 2, 1}}, {"upper", {1, 2, 1}}};
    decomposition = partition::cut_of(mesh, options, comm);
  }

  // u(x) of one body; the others stay.
  template <class Field>
  std::vector<Eigen::VectorXd> displacement(int body, const Field& u) const
  {
    std::vector<Eigen::VectorXd> result;
    for (const auto& s : decomposition.subdomains) {
      result.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(s.mesh.node_count()) * 3));
      if (s.body != body) continue;
      for (std::size_t n = 0; n < s.mesh.node_count(); ++n)
        result.back().segment<3>(3 * static_cast<Eigen::Index>(n)) = Point(u(s.mesh.points[n]));
    }
    return result;
  }

  contact::Pair pair(const std::string& secondary, const std::string& primary) const
  {
    contact::Pair result;
    result.options.name = secondary + "/" + primary;
    result.options.secondary = secondary;
    result.options.primary = primary;
    result.secondary = partition::side_of(decomposition, secondary);
    result.primary = std::make_shared<const mesh::Surface>(partition::side_of(decomposition, primary));
    return result;
  }
};

TEST(Bodies, sizes_are_diagonals)
{
  const Blocks blocks;
  const auto sizes = body_sizes(blocks.decomposition, fem::Kinematics::solid, blocks.comm);
  EXPECT_NEAR(sizes[0], std::sqrt(6), 1e-12);
  EXPECT_NEAR(sizes[1], std::sqrt(3), 1e-12);
  // The whole turn of x from 0 to 2, from 0.5 to 1.5.
  const auto rotated = body_sizes(blocks.decomposition, fem::Kinematics::axisymmetric, blocks.comm);
  EXPECT_NEAR(rotated[0], std::sqrt(18), 1e-12);
  EXPECT_NEAR(rotated[1], std::sqrt(11), 1e-12);
}

TEST(LargeDisplacements, from_a_twentieth_of_the_body)
{
  const Blocks blocks;
  const auto sizes = body_sizes(blocks.decomposition, fem::Kinematics::solid, blocks.comm);
  const auto found = [&](int body, double length) {
    const auto u = blocks.displacement(body, [&](const Point& x) { return Point(length * x[0], 0, 0); });
    return large_displacements(blocks.decomposition, sizes, u, blocks.comm);
  };
  EXPECT_TRUE(found(1, 0.05).empty());
  const auto upper = found(1, 0.1);
  ASSERT_EQ(upper.size(), 1U);
  EXPECT_EQ(upper[0].body, "upper");
  EXPECT_NEAR(upper[0].value, 0.15 / std::sqrt(3), 1e-12);
  EXPECT_EQ((*upper[0].at)[0], 1.5);
  EXPECT_EQ(found(0, 0.1)[0].body, "lower");
}

TEST(InvertedCells, panels_are_none)
{
  Blocks blocks;
  blocks.decomposition = partition::skins(std::move(blocks.decomposition), {true, false}, false, blocks.comm);
  const auto turned = [&](int body) {
    return inverted_cells(blocks.decomposition, blocks.displacement(body, [](const Point& x) { return Point(-2 * x[0], 0, 0); }),
                          blocks.comm);
  };
  EXPECT_TRUE(turned(0).empty());
  EXPECT_EQ(turned(1).size(), 1U);
}

TEST(InvertedCells, are_counted_and_placed)
{
  const Blocks blocks;
  const auto squeeze = [&](double part) {
    // The left half of the lower block shrinks along x, the rest follows.
    return blocks.displacement(0, [&](const Point& x) { return Point(-part * std::min(x[0], 1.0), 0, 0); });
  };
  EXPECT_TRUE(inverted_cells(blocks.decomposition, squeeze(0.99), blocks.comm).empty());
  const auto found = inverted_cells(blocks.decomposition, squeeze(1.01), blocks.comm);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 4);
  EXPECT_EQ(found[0].body, "lower");
  EXPECT_LT((*found[0].at)[0], 1);
  const auto zero = blocks.displacement(0, [](const Point& x) { return Point(-x[0], 0, 0); });  // flat
  EXPECT_EQ(inverted_cells(blocks.decomposition, zero, blocks.comm)[0].value, 8);
}

// A node between two corners of a straight hex20, a way along its edge from the middle: folded beyond the quarter point.
TEST(FoldedCells, have_nodes_beyond_quarter_points)
{
  const Communicator comm;
  mesh::Options mesh;
  mesh.blocks["block"] = {{0, 0, 0}, {2, 1, 1}, {2, 1, 1}, "hex20"};
  partition::Options options;
  options.method = "grid";
  options.counts = {{"block", {1, 1, 1}}};
  const auto whole = partition::cut_of(mesh, options, comm);
  const auto moved = [&](double way) {
    auto decomposition = whole;
    for (auto& subdomain : decomposition.subdomains)
      for (auto& x : subdomain.mesh.points)
        if ((x - Point(0.5, 0, 0)).norm() < 1e-9) x[0] += way;
    return folded_cells(decomposition, comm);
  };
  EXPECT_TRUE(moved(0).empty());
  EXPECT_TRUE(moved(0.24).empty());
  const auto found = moved(0.26);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 1);
  EXPECT_EQ(found[0].body, "block");
}

// Of a slide of the upper block by `length` along (1, 0, 0), with the lower one moving by `lower`; faces are 0.5 x 0.5.
// `closed`: nodes of the first ranks that have `status`; the others are open.
std::vector<Warning> slide(double length, double lower, contact::Law law, contact::Status status, long long closed = 1000)
{
  const Blocks blocks;
  std::vector<contact::Pair> pairs{blocks.pair("upper.zmin", "lower.zmax")};
  pairs[0].options.law = law;
  // The lower block is held across the slide, so that its entries lack that component.
  std::vector<constraint::PrescribedDof> prescribed;
  if (blocks.comm.root())
    for (Global node = 0; node < 45; ++node) prescribed.push_back({node, 1, 0.0, 0});
  const auto contacts = contact::discretize(pairs, prescribed, fem::Kinematics::solid, blocks.comm);
  EXPECT_GT(blocks.comm.sum(static_cast<long long>(contacts.nodes.size())), 0);
  std::vector<contact::ContactNodeState> points(contacts.nodes.size());
  const auto first = blocks.comm.offset(static_cast<long long>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].status = first + static_cast<long long>(i) < closed ? status : contact::Status::open;
  auto u = blocks.displacement(1, [&](const Point&) { return Point(length, 0, 0.3); });
  const auto below = blocks.displacement(0, [&](const Point&) { return Point(lower, 0, 0.3); });
  for (std::size_t s = 0; s < u.size(); ++s) u[s] += below[s];
  auto found = slides_and_rolls(pairs, contacts, points, blocks.decomposition, fem::Kinematics::solid, u, blocks.comm);
  std::erase_if(found, [](const Warning& w) { return w.kind != "long_slide"; });
  return found;
}

TEST(LongSlides, are_longer_than_a_face)
{
  const double face = std::sqrt(0.5);
  for (const auto law : {contact::Law::frictionless, contact::Law::coulomb}) {
    EXPECT_TRUE(slide(0.99 * face, 0, law, contact::Status::slip).empty());
    const auto found = slide(2 * face, 0, law, contact::Status::slip);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].value, 2, 1e-12);
    EXPECT_EQ(found[0].contact, "upper.zmin/lower.zmax");
    EXPECT_NEAR((*found[0].at)[2], 1, 1e-12);
    EXPECT_TRUE(slide(2 * face, 1.5 * face, law, contact::Status::slip).empty());  // the two go together
    EXPECT_TRUE(slide(2 * face, 0, law, contact::Status::open).empty());
  }
  EXPECT_TRUE(slide(2 * face, 0, contact::Law::bonded, contact::Status::stick).empty());
}

TEST(LongSlides, are_shorter_on_the_corners_of_a_facet)
{
  const double face = std::sqrt(0.5);
  const auto law = contact::Law::frictionless;
  const auto status = contact::Status::slip;
  EXPECT_TRUE(slide(0.09 * face, 0, law, status, 3).empty());
  const auto found = slide(0.11 * face, 0, law, status, 3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].text.find("it turns until it stands"), std::string::npos);
  EXPECT_EQ(found[0].limit, 0.1);
  EXPECT_TRUE(slide(0.11 * face, 0, law, status, 4).empty());
}

TEST(DoubledContacts, share_faces_on_both_sides)
{
  const Blocks blocks;
  const auto count = [&](std::vector<contact::Pair> pairs) { return doubled_contacts(pairs, blocks.comm).size(); };
  const auto one = blocks.pair("upper.zmin", "lower.zmax");
  EXPECT_EQ(count({one}), 0U);
  EXPECT_EQ(count({one, one}), 1U);
  EXPECT_EQ(count({one, blocks.pair("lower.zmax", "upper.zmin")}), 1U);
  EXPECT_EQ(count({one, blocks.pair("upper.zmin", "lower.xmin")}), 0U);  // a pin on two plates
  EXPECT_EQ(count({one, blocks.pair("upper.xmin", "lower.zmax")}), 0U);  // two pins on a plate
}

TEST(LargePressures, from_a_hundredth_of_the_softer_modulus)
{
  const Blocks blocks;
  const std::vector<contact::Pair> pairs{blocks.pair("upper.zmin", "lower.zmax")};
  const auto found = [&](double pressure) {
    contact::SurfaceState state;
    for (const auto& x : pairs[0].secondary.points) state.recovered_pressure.push_back(x[0] == 1.5 ? pressure : 0);
    const std::vector<contact::SurfaceState> states{state};
    return large_pressures(states, pairs, {2e5, 1e3}, {"lower", "upper"}, blocks.comm);
  };
  EXPECT_TRUE(found(10).empty());
  const auto large = found(11);
  ASSERT_EQ(large.size(), 1U);
  EXPECT_EQ(large[0].body, "upper");
  EXPECT_EQ(large[0].limit, 10);
  EXPECT_EQ((*large[0].at)[0], 1.5);
}

// Of a body that turns by 0.01 and is stretched by 1e-3, which has nothing of a rigid motion.
TEST(RigidMotions, leave_what_deforms)
{
  const Blocks blocks;
  const Point turn(0, 0.006, 0.008), centre(1, 0.5, 1.5);
  const auto u = blocks.displacement(
      1, [&](const Point& x) { return Point(turn.cross(x - centre) + Point(0, 0, 1e-3 * (x[2] - centre[2]))); });
  const auto found = rigid_motions(blocks.decomposition, fem::Kinematics::solid, u, blocks.comm);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].turning, 0);
  EXPECT_EQ(found[0].rest, 0);
  EXPECT_LT((found[1].rigid.rotation - turn).norm(), 1e-12);
  const auto frames = feti::body_frames(blocks.decomposition, blocks.comm);
  EXPECT_NEAR(found[1].turning, 0.01 * frames[1].radius, 1e-12);
  EXPECT_GT(found[1].rest, 2e-4);
  EXPECT_LT(found[1].rest, 5e-4);
}

TEST(Drifts, are_rigid_motions_beyond_what_is_given)
{
  const Blocks blocks;
  const auto sizes = body_sizes(blocks.decomposition, fem::Kinematics::solid, blocks.comm);
  const auto of = [&](const auto& u, double allowance) {
    return drift(blocks.decomposition, fem::Kinematics::solid, sizes, blocks.displacement(1, u), allowance, blocks.comm);
  };
  const auto away = [](const Point&) { return Point(0, 0, 10); };
  EXPECT_NEAR(of(away, 0).sizes, 10 / std::sqrt(3), 1e-9);
  EXPECT_NEAR(of(away, 4).sizes, 6 / std::sqrt(3), 1e-9);
  EXPECT_EQ(of(away, 20).sizes, 0);
  EXPECT_EQ(of(away, 0).text, "body \"upper\" moves along (0, 0, 1)");
  const auto turning = [](const Point& x) { return Point(Point(0, 0, 5).cross(x - Point(1, 0.5, 1.5))); };
  EXPECT_EQ(of(turning, 0).text, "body \"upper\" rotates about the axis through (1, 0.5, 1.5) along (0, 0, 1)");
  const auto stretched = [](const Point& x) { return Point(0, 0, 5 * (x[2] - 1.5)); };  // soft, but where it was
  EXPECT_NEAR(of(stretched, 0).sizes, 0, 1e-9);
}

}  // namespace
}  // namespace mortise::post
