// Wild cards, instances and bodies of several volumes in a deck.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "model/deck.hpp"
#include "model/patterns.hpp"
#include "testing/cut.hpp"

namespace mortise::model {
namespace {

TEST(Patterns, Matches)
{
  EXPECT_TRUE(matches("roller.*.surface", "roller.12.surface"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("a*b*c", "abbbc"));
  EXPECT_TRUE(matches("*ab", "aaab"));
  EXPECT_FALSE(matches("roller.*.surface", "roller.1.face"));
  EXPECT_FALSE(matches("aba*aba", "aba"));
  EXPECT_EQ(wildcard_text("roller.*.surface", "roller.12.surface"), "12");
  EXPECT_EQ(wildcard_text("*:top", "pad.1:top"), "pad.1");
  EXPECT_FALSE(wildcard_text("ab*ab", "ab"));
}

TEST(Patterns, BodiesByNameInstanceAndGroup)
{
  const mesh::Body part{"pin.2.1", "pin", "pin.2"};
  for (const char* name : {"pin", "pin.2", "pin.2.1", "pin.*", "*"}) EXPECT_TRUE(matches_name(part, name)) << name;
  for (const char* name : {"pin.1", "pi", "", "pan*"}) EXPECT_FALSE(matches_name(part, name)) << name;
}

const char* pads = R"(
dimension: 3
mesh:
  blocks:
    seat: {size: [1, 1, 1], cells: [2, 2, 2]}
    pad: {origin: [0, 0, 1], size: [1, 1, 1], cells: [3, 3, 3]}
materials: {steel: {young_modulus: 1, poisson_ratio: 0.3}}
bodies:
  seat: {material: steel, instances: [{count: 2, translate: [3, 0, 0], of: [{count: 2, rotate: {angle: 360/7}}]}]}
  pad: {material: steel, instances: [{count: 2, translate: [3, 0, 0], of: [{count: 2, rotate: {angle: 360/7}}]}]}
supports:
  - {boundary: 'seat.*.zmin', displacement: {x: 0, y: 0, z: 0}}
loads:
  - {boundary: '*.zmax', pressure: 1}
contacts:
  - {name: first, secondary: pad.1.zmin, primary: seat.1.zmax}
  - {name: rest, secondary: 'pad.*:pad.zmin', primary: 'seat.*:seat.zmax', friction: {coulomb: 0.2}}
)";

struct Resolved {
  deck::Document document{pads, "deck.yaml", {}};
  Deck deck;
  partition::Decomposition decomposition;
  Contacts contacts;
};

Resolved resolve()
{
  Resolved r;
  const Communicator comm;
  r.deck = read_deck(r.document, "");
  r.document.check();
  r.decomposition = partition::cut_of(r.deck.mesh, r.deck.decomposition, comm);
  r.contacts = resolve_patterns(r.deck, r.document, r.decomposition, comm);
  return r;
}

TEST(Patterns, AContactForEachMatch)
{
  auto r = resolve();
  check_names(r.deck, r.contacts, r.document, r.decomposition.catalogue);
  EXPECT_NO_THROW(r.document.check());
  ASSERT_EQ(r.contacts.size(), 5U);
  EXPECT_EQ(r.contacts[0].name, "first");
  for (int i = 1; i <= 4; ++i) {
    const auto& contact = r.contacts[static_cast<std::size_t>(i)];
    EXPECT_EQ(contact.name, "rest." + std::to_string(i));
    EXPECT_EQ(contact.secondary, "pad." + std::to_string(i) + ":pad.zmin");
    EXPECT_EQ(contact.primary, "seat." + std::to_string(i) + ":seat.zmax");
    EXPECT_EQ(contact.friction, 0.2);
    EXPECT_EQ(r.contacts.path(static_cast<std::size_t>(i)), "contacts[1]");
  }
}

TEST(Patterns, TheDeckThatIsWrittenReadsBack)
{
  const auto r = resolve();
  const auto written = write_deck(r.deck);
  deck::Document again(written, "deck.yaml", {});
  auto copy = read_deck(again, "");
  EXPECT_NO_THROW(again.check());
  EXPECT_EQ(write_deck(copy), written);
  EXPECT_EQ(copy.mesh.instances.at("pad").size(), 4U);
  EXPECT_EQ(copy.mesh.instances.at("pad")[3].rotation, r.deck.mesh.instances.at("pad")[3].rotation);
}

TEST(Patterns, ABoundaryHoldsEveryFaceOnce)
{
  const auto r = resolve();
  // It matches pad.zmax and pad.1.zmax alike, which are the same faces.
  EXPECT_EQ(partition::side_of(r.decomposition, "*.zmax").faces.size(), 4U * (4 + 9));
}

}  // namespace
}  // namespace mortise::model
