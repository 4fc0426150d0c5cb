// Bodies that stand in each other, or in themselves, where no contact keeps their faces apart: none was found by `contacts:
// auto`, or their faces have no name in one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"
#include "contact/pairing.hpp"
#include "model/model.hpp"

namespace mortise::model {

/// Two bodies of which one has nodes, or middles of facets, in the other, by faces that are not the two sides of one contact; or
/// a body, twice, that has them in itself: its faces have passed through each other.
struct CrossedBodies {
  contact::Bodies bodies;
  double depth;  ///< a length: how far the deepest place is from the other body's surface
  Point at;      ///< the deepest place, before it moved; of several as deep to a hundredth the one in their middle
};

/// All of them, the deepest first. What has become deeper by less than a hundredth of the largest displacement is none, and what
/// stood in each other from the start by less than a quarter of a face, but for bodies that lie wholly inside another one; in one
/// body, what is as deep as a hundredth of the largest displacement within it.
/// `displacement`: of each subdomain, nodes x dimension. Collective.
std::vector<CrossedBodies> crossed_bodies(const Model& model, const std::vector<Eigen::VectorXd>& displacement,
                                          const Communicator& comm);

}  // namespace mortise::model
