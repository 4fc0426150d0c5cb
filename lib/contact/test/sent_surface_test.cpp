// Surfaces come out of messages as they were, in few bytes.
#include "surface/sent_surface.hpp"

#include <gtest/gtest.h>

namespace mortise::contact {
namespace {

// A triangle and a square of second order beside each other, with numbers that need more than 32 bits; `first` of the nodes.
SentSurface two_faces(Global first)
{
  SentSurface surface;
  for (Global n = 0; n < 10; ++n) surface.nodes.push_back({first + 7 * n, {0.1 * static_cast<double>(n), 1e300, -1}});
  const auto node = [&](std::size_t n) { return surface.nodes[n].id; };
  surface.faces.push_back({Global{1} << 40, {node(9), node(0), node(4), -1, -1, -1, -1, -1, -1}, mesh::CellType::tri3, 3});
  surface.faces.push_back(
      {6, {node(0), node(1), node(2), node(3), node(4), node(5), node(6), node(7), -1}, mesh::CellType::quad8, -1});
  return surface;
}

void expect_same(const SentSurface& a, const SentSurface& b)
{
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t n = 0; n < a.nodes.size(); ++n) {
    EXPECT_EQ(a.nodes[n].id, b.nodes[n].id);
    EXPECT_EQ(a.nodes[n].x, b.nodes[n].x);
  }
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t f = 0; f < a.faces.size(); ++f) {
    EXPECT_EQ(a.faces[f].id, b.faces[f].id);
    EXPECT_EQ(a.faces[f].nodes, b.faces[f].nodes);
    EXPECT_EQ(a.faces[f].type, b.faces[f].type);
    EXPECT_EQ(a.faces[f].mark, b.faces[f].mark);
  }
}

TEST(SentSurface, ComesOutAsItWas)
{
  auto first = two_faces(0);
  const auto second = two_faces(Global{1} << 33);
  SentSurface found;
  unpack({}, found);
  EXPECT_TRUE(found.nodes.empty());
  auto message = pack(first);
  const auto behind = pack(second);
  message.insert(message.end(), behind.begin(), behind.end());
  unpack(message, found);
  first.nodes.insert(first.nodes.end(), second.nodes.begin(), second.nodes.end());
  first.faces.insert(first.faces.end(), second.faces.begin(), second.faces.end());
  expect_same(found, first);
}

TEST(SentSurface, ANodeOfAFaceIsAByteWhereAFewAreSent)
{
  auto surface = two_faces(0);
  const auto before = pack(surface).size();
  surface.faces.push_back(surface.faces.back());
  EXPECT_EQ(pack(surface).size(), before + 8 + 8 + 1 + 1);  // its nodes, number, type and mark
}

}  // namespace
}  // namespace mortise::contact
