// From faces that face each other to patches: as far as the contact can reach, over edges without a kink.
#pragma once

#include <map>
#include <vector>

#include "pairing/facing.hpp"

namespace mortise::contact {

/// What all pairs of bodies share while their patches grow.
struct Ground {
  const Skin& skin;
  const Tree& facets;
  const Lengths& lengths;
  std::vector<std::vector<int>> neighbours;
  struct Body {
    std::vector<int> faces;
    double largest;  ///< size of these
    Tree tree;       ///< of their boxes
  };
  std::map<int, Body> of_body;
};

/// A face of one of the patches in which two bodies meet.
struct Member {
  int pair, patch, face;
};

/// For each face those that it goes on to without a kink.
std::vector<std::vector<int>> smooth_neighbours(const Skin& skin);

/// For Options::search_distance of the contact of two bodies whose faces face each other so.
double reach_of(const std::vector<Facing>& facing, const Ground& ground);

/// Adds the patches of one pair of bodies, numbered by their lowest faces.
void grow_patches(int pair, const Bodies& bodies, const std::vector<Facing>& facing, const Ground& ground,
                  std::vector<Member>& members);

}  // namespace mortise::contact
