// Faces of a body that lie on each other with nodes of their own.
#include "contact/doubled_faces.hpp"

#include <gtest/gtest.h>

#include "outer_faces.hpp"

namespace mortise::contact {
namespace {

// A plate of two boxes whose nodes are not merged: 4 faces, 9 nodes. Not of two bodies, nor of faces with other corners.
TEST(DoubledFaces, BetweenBoxes)
{
  const Communicator comm;
  const auto found = [&](int body, const Point& origin, std::array<int, 3> cells) {
    OuterFaces skin;
    skin.add_box(0, Point(0, 0, 0), Point(2, 2, 2), {2, 2, 2});
    skin.add_box(body, origin, Point(2, 2, 2), cells);
    return find_doubled_faces(skin.on_rank(comm), fem::Kinematics::solid, comm);
  };
  const auto doubled = found(0, Point(2, 0, 0), {2, 2, 2});
  ASSERT_EQ(doubled.size(), 4u);
  for (const auto& two : doubled) {
    EXPECT_LT(two.faces[0], two.faces[1]);
    ASSERT_EQ(two.nodes.size(), 4u);
    for (const auto& node : two.nodes) {
      EXPECT_LT(node.numbers[0], node.numbers[1]);
      EXPECT_EQ(node.at[0], 2);
    }
  }
  EXPECT_EQ(found(0, Point(2.00005, 0, 0), {2, 2, 2}).size(), 4u);  // 1.4e-4 are within a face's 1e-4
  EXPECT_TRUE(found(0, Point(2.0003, 0, 0), {2, 2, 2}).empty());
  EXPECT_TRUE(found(1, Point(2, 0, 0), {2, 2, 2}).empty());
  EXPECT_TRUE(found(0, Point(2, 0, 0), {2, 3, 2}).empty());
  EXPECT_TRUE(found(0, Point(0, 0, 0), {2, 2, 2}).empty());  // all of it twice, with the same normals
}

// A block with a cut from its right side to the middle; at the end of the cut the node is shared.
TEST(DoubledFaces, CutInABlock)
{
  const Communicator comm;
  const auto found = [&](double gap) {
    OuterFaces skin;
    skin.add_line(
        0, {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}, {2, 1, 0}, {3, 1 + gap, 0}, {4, 1 + gap, 0}, {4, 2, 0}, {0, 2, 0}});
    return find_doubled_faces(skin.on_rank(comm), fem::Kinematics::plane_strain, comm);
  };
  EXPECT_TRUE(found(0.01).empty());
  const auto doubled = found(0);
  ASSERT_EQ(doubled.size(), 2u);
  EXPECT_EQ(doubled[0].nodes.size(), 2u);
  ASSERT_EQ(doubled[1].nodes.size(), 1u);
  EXPECT_EQ(doubled[1].nodes[0].at, Point(3, 1, 0));
}

}  // namespace
}  // namespace mortise::contact
