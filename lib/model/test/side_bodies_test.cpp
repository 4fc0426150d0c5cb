// Which side of a contact carries the multipliers, on a row of blocks of different stiffness.
#include <gtest/gtest.h>

#include "model/resolution.hpp"
#include "testing/quiet.hpp"

namespace mortise::model {
namespace {

const std::string row = R"(
mesh:
  blocks:
    a: {size: [1, 1, 1], cells: [2, 2, 2]}
    b: {origin: [1, 0, 0], size: [1, 1, 1], cells: [3, 3, 3]}
    c: {origin: [2, 0, 0], size: [1, 1, 1], cells: [2, 2, 2]}
    d: {origin: [0, 0, 1], size: [1, 1, 1], cells: [1, 1, 1]}
    e: {origin: [0, 1, 0], size: [1, 1, 1], cells: [1, 2, 1], element: hex20}
materials:
  soft: {young_modulus: 1, poisson_ratio: 0.3}
  twenty: {young_modulus: 20, poisson_ratio: 0.3}
  more: {young_modulus: 20.1, poisson_ratio: 0.3}
bodies: {a: {material: soft}, b: {material: more}, c: {material: twenty}, d: {material: more}, e: {material: more}}
contacts:
)";

contact::Options first_contact(const std::string& contacts)
{
  Quiet quiet;
  deck::Document document(row + contacts, "deck.yaml", {});
  const auto deck = read_deck(document, "");
  document.check();
  return resolve(deck, document, partition::decompose(deck.mesh, deck.decomposition, 3, quiet.context), quiet.context)
      .contacts[0];
}

TEST(SideBodies, TheFarSofterSideCarriesTheMultipliers)
{
  const auto exchanged = first_contact("  - {secondary: b.xmin, primary: a.xmax, friction: {coulomb: 0.2}}\n");
  EXPECT_TRUE(exchanged.exchanged);
  EXPECT_EQ(exchanged.secondary, "a.xmax");
  EXPECT_EQ(exchanged.primary, "b.xmin");
  EXPECT_EQ(exchanged.name, "b.xmin/a.xmax");
  // Of bonds whatever the faces. Of others spacings of nodes count: that of e.ymin, of one face with middle nodes, is a's.
  EXPECT_TRUE(first_contact("  - {secondary: d.zmin, primary: a.zmax, friction: {bonded: true}}\n").exchanged);
  for (const char* stays : {"  - {secondary: d.zmin, primary: a.zmax}\n", "  - {secondary: e.ymin, primary: a.ymax}\n",
                            "  - {secondary: a.xmax, primary: b.xmin}\n", "  - {secondary: c.xmin, primary: b.xmax}\n",
                            "  - {secondary: c.xmax, primary: a.xmin}\n",
                            "  - {secondary: b.xmin, primary: a.xmax, discretization: node_to_segment}\n",
                            "  - {secondary: b.xmin, primary: a.xmax, friction: {bonded: true}, preload: {force: 1}}\n",
                            "  - {secondary: b.xmin, primary: {plane: {point: [1, 0, 0], normal: [1, 0, 0]}}}\n"}) {
    const auto contact = first_contact(stays);
    EXPECT_FALSE(contact.exchanged) << stays;
    EXPECT_NE(std::string(stays).find("secondary: " + contact.secondary), std::string::npos) << stays;
  }
}

}  // namespace
}  // namespace mortise::model
