// Patches of pressed faces on sides that several ranks hold pieces of, against a search that sees all faces.
#include "../src/patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "testing/cut.hpp"

namespace mortise::post {
namespace {

// Two contacts, each with a side of 12 x 12 faces in 9 subdomains, some nodes of which press.
struct ScatteredSides {
  Communicator comm;
  partition::Decomposition decomposition;
  std::vector<contact::Pair> pairs{2};
  std::vector<contact::SurfaceState> states;

  ScatteredSides(double part, unsigned seed)
  {
    mesh::Options mesh;
    mesh.blocks["one"] = {{0, 0, 0}, {12, 12, 1}, {12, 12, 1}, "hex8"};
    mesh.blocks["two"] = {{20, 0, 0}, {12, 12, 1}, {12, 12, 1}, "hex8"};
    partition::Options options;
    options.method = "grid";
    options.counts = {{"one", {3, 3, 1}}, {"two", {3, 3, 1}}};
    decomposition = partition::cut_of(mesh, options, comm);
    pairs[0].secondary = partition::side_of(decomposition, "one.zmin");
    pairs[1].secondary = partition::side_of(decomposition, "two.zmin");
    for (const auto& pair : pairs) {
      contact::SurfaceState state;
      for (const Global id : pair.secondary.node_id) {
        std::minstd_rand random(seed + 977 * static_cast<unsigned>(id));
        random.discard(5);
        state.status.push_back(random() % 1000 < 1000 * part ? 2 : 0);
      }
      states.push_back(state);
    }
  }
};

using Sets = std::set<std::set<SideNode>>;

// What pressed faces of all ranks join, by growing sets.
Sets joined(const ScatteredSides& sides)
{
  std::vector<SideNode> flat;  // four a face
  for (std::size_t c = 0; c < sides.pairs.size(); ++c) {
    const auto& side = sides.pairs[c].secondary;
    for (std::size_t f = 0; f < side.faces.size(); ++f) {
      const auto nodes = side.faces[f];
      if (std::ranges::none_of(nodes, [&](Local n) { return sides.states[c].status[static_cast<std::size_t>(n)] != 0; }))
        continue;
      for (const Local n : nodes) flat.push_back({static_cast<long long>(c), side.node_id[static_cast<std::size_t>(n)]});
    }
  }
  flat = sides.comm.all_gather(flat);
  std::vector<std::set<SideNode>> sets;
  for (std::size_t i = 0; i < flat.size(); i += 4) {
    std::set<SideNode> grown(flat.begin() + static_cast<std::ptrdiff_t>(i), flat.begin() + static_cast<std::ptrdiff_t>(i + 4));
    std::erase_if(sets, [&](const std::set<SideNode>& s) {
      const bool meets = std::any_of(s.begin(), s.end(), [&](const SideNode& n) { return grown.contains(n); });
      if (meets) grown.insert(s.begin(), s.end());
      return meets;
    });
    sets.push_back(std::move(grown));
  }
  return {sets.begin(), sets.end()};
}

TEST(Patches, AreWhatPressedFacesOfAllRanksJoin)
{
  for (const double part : {0.0, 0.02, 0.06, 0.1, 0.3}) {
    const ScatteredSides sides(part, 11);
    const Sets expected = joined(sides);
    std::vector<SideNode> every;  // this rank asks for the nodes of all
    for (const auto& set : expected) every.insert(every.end(), set.begin(), set.end());
    const SideNode nowhere{0, 1000000};
    every.push_back(nowhere);
    const Patches patches(sides.states, sides.pairs, every, sides.comm);
    EXPECT_EQ(patches.contacts().size(), expected.size()) << part;
    EXPECT_TRUE(std::is_sorted(patches.contacts().begin(), patches.contacts().end()));
    EXPECT_FALSE(patches.of(nowhere));
    every.pop_back();
    std::map<std::size_t, std::set<SideNode>> found;
    for (const auto& node : every) {
      const auto patch = patches.of(node);
      ASSERT_TRUE(patch);
      EXPECT_EQ(patches.contacts()[*patch], node.contact);
      found[*patch].insert(node);
    }
    Sets sets;
    for (const auto& [patch, nodes] : found) sets.insert(nodes);
    EXPECT_EQ(sets, expected) << part;
  }
}

TEST(Patches, KnowTheNodesOfTheirOwnFacesUnasked)
{
  const ScatteredSides sides(0.06, 5);
  const Patches patches(sides.states, sides.pairs, {}, sides.comm);
  for (std::size_t c = 0; c < sides.pairs.size(); ++c) {
    const auto& side = sides.pairs[c].secondary;
    for (std::size_t i = 0; i < side.node_id.size(); ++i) {
      if (sides.states[c].status[i] == 0) continue;
      EXPECT_TRUE(patches.of({static_cast<long long>(c), side.node_id[i]}));
    }
  }
}

TEST(Patches, BondedContactsHaveNone)
{
  ScatteredSides sides(0.3, 5);
  sides.pairs[0].options.law = contact::Law::bonded;
  const Patches patches(sides.states, sides.pairs, {}, sides.comm);
  EXPECT_FALSE(patches.contacts().empty());
  for (const int contact : patches.contacts()) EXPECT_EQ(contact, 1);
}

}  // namespace
}  // namespace mortise::post
