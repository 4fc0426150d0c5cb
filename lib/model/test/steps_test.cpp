// Load steps: from the deck's section to the states that are solved one after the other.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "model/deck.hpp"

namespace mortise::model {
namespace {

std::string text(const std::string& steps)
{
  return R"(
mesh: {blocks: {lower: {size: [1, 1, 1], cells: [1, 1, 1]}, upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [1, 1, 1]}}}
materials: {steel: {young_modulus: 1, poisson_ratio: 0.3}}
bodies: {lower: {material: steel}, upper: {material: steel}}
supports:
  - {boundary: lower.zmin, displacement: {x: 0, y: 0, z: 0}}
  - {name: ram, boundary: upper.zmax, displacement: {z: -0.1}}
loads:
  - {name: push, boundary: upper.xmin, pressure: 1}
  - {boundary: upper.ymin, pressure: 2}
contacts:
  - {name: joint, secondary: upper.zmin, primary: lower.zmax, interference: 0.2}
)" + steps;
}

Deck deck_of(const std::string& steps, const std::vector<std::string>& settings = {})
{
  deck::Document document(text(steps), "deck.yaml", settings);
  Deck deck = read_deck(document, "");
  document.check();
  return deck;
}

std::vector<LoadState> states_of(const Deck& deck)
{
  return load_states(deck, as_written(deck));
}

TEST(Steps, ADeckWithoutThemHasOneStateInWhichAllActs)
{
  const auto states = states_of(deck_of(""));
  ASSERT_EQ(states.size(), 1U);
  EXPECT_EQ(states[0].step, "");
  EXPECT_EQ(states[0].load, (std::vector<double>{1, 1}));
  EXPECT_EQ(states[0].support, (std::vector<double>{1, 1}));
  EXPECT_EQ(states[0].contact, std::vector<double>{1});
  EXPECT_EQ(states[0].acting, (std::vector<bool>{true, true}));
}

TEST(Steps, FactorsStayUntilAStepNamesThemAndGoLinearlyBetween)
{
  const auto states =
      states_of(deck_of("steps: [{name: press, scale: {push: 0, joint: 0.5}}, {scale: {push: 2}, increments: 4}, {}]"));
  ASSERT_EQ(states.size(), 6U);
  EXPECT_EQ(states[0].step, "press");
  EXPECT_EQ(states[0].load, (std::vector<double>{0, 1}));
  EXPECT_EQ(states[0].contact, std::vector<double>{0.5});
  EXPECT_EQ(states[2].step, "2");
  EXPECT_DOUBLE_EQ(states[2].time, 1.5);
  EXPECT_EQ(states[2].load, (std::vector<double>{1, 1}));
  EXPECT_EQ(states[4].load, (std::vector<double>{2, 1}));
  EXPECT_EQ(states[5].load, (std::vector<double>{2, 1}));
  EXPECT_EQ(states[5].contact, std::vector<double>{0.5});
}

TEST(Steps, TheFirstStepComesFromNothing)
{
  const auto states = states_of(deck_of("steps: [{increments: 2}]"));
  ASSERT_EQ(states.size(), 2U);
  EXPECT_EQ(states[0].load, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(states[0].support, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(states[0].contact, std::vector<double>{0.5});
}

// They would rise twice.
TEST(Steps, FormulasOfTimeAreNotScaledUpInTheFirstStep)
{
  const auto states =
      states_of(deck_of("steps: [{increments: 4, scale: {upper.ymin: 3}}, {increments: 2, scale: {upper.ymin: 1}}]",
                        {"loads[1].pressure=2*t", "supports[1].displacement.z=-0.1*t*x"}));
  ASSERT_EQ(states.size(), 6U);
  EXPECT_EQ(states[0].load, (std::vector<double>{0.25, 3}));
  EXPECT_EQ(states[0].support, (std::vector<double>{0.25, 1}));
  EXPECT_EQ(states[3].load, (std::vector<double>{1, 3}));
  EXPECT_EQ(states[4].load, (std::vector<double>{1, 2}));
}

TEST(Steps, WhatIsSwitchedOffKeepsItsFactorForLater)
{
  const auto states = states_of(deck_of("steps: [{scale: {upper.ymin: 3}}, {off: [upper.ymin, ram]}, {on: [upper.ymin, ram]}]"));
  ASSERT_EQ(states.size(), 3U);
  EXPECT_EQ(states[1].load, (std::vector<double>{1, 0}));
  EXPECT_EQ(states[1].acting, (std::vector<bool>{true, false}));
  EXPECT_EQ(states[2].load, (std::vector<double>{1, 3}));
  EXPECT_EQ(states[2].acting, (std::vector<bool>{true, true}));
}

std::string complaint(const std::string& steps, const std::vector<std::string>& settings = {})
{
  try {
    deck_of(steps, settings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Steps, ABoltKeepsItsLengthButWhereAStepTightensIt)
{
  const auto states = states_of(deck_of("steps: [{}, {}, {scale: {joint: 1.5}}, {}]"));
  ASSERT_EQ(states.size(), 4U);
  EXPECT_FALSE(states[0].locked[0]);
  EXPECT_TRUE(states[1].locked[0]);
  EXPECT_FALSE(states[2].locked[0]);
  EXPECT_TRUE(states[3].locked[0]);
}

TEST(Steps, NamesMeanOneThingAndHaveSomethingToScale)
{
  EXPECT_EQ(complaint("steps: [{scale: {ram: 2, joint: 0.5}}]"), "");
  EXPECT_NE(complaint("steps: [{scale: {ram: 2}}]", {"loads[0].name=ram"}).find("\"ram\" is the name of"), std::string::npos);
  EXPECT_NE(complaint("steps: [{off: [ram]}]", {"loads[0].name=ram"}).find("steps[0].off: \"ram\" is the name of"),
            std::string::npos);
  EXPECT_EQ(complaint("steps: [{scale: {push: 2}}]", {"loads[1].name=push"}), "");
  EXPECT_NE(complaint("steps: [{scale: {joint: 2}}]", {"contacts[0].interference=0"}).find("neither interference nor preload"),
            std::string::npos);
  const std::vector<std::string> springs{"supports[1]={name: ram, boundary: upper.zmax, stiffness: {normal: 10}}"};
  EXPECT_NE(complaint("steps: [{scale: {ram: 2}}]", springs).find("no displacement"), std::string::npos);
  EXPECT_EQ(complaint("steps: [{off: [ram]}]", springs), "");
}

TEST(Steps, WrongNamesAreToldWithTheNearest)
{
  const auto said = complaint("steps: [{scale: {pusch: 0}}, {off: [joint]}, {on: [ram], off: [ram]}, {increments: 0}]");
  EXPECT_NE(said.find("steps[0].scale.pusch: there is no load, support or contact of that name, did you mean \"push\"?"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("steps[1].off: there is no load or support \"joint\""), std::string::npos) << said;
  EXPECT_NE(said.find("\"ram\" is switched on and off in one step"), std::string::npos) << said;
  EXPECT_NE(said.find("steps[3].increments"), std::string::npos) << said;
}

}  // namespace
}  // namespace mortise::model
