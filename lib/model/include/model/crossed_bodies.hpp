// Bodies that have moved into each other where no contact keeps them apart: none was found by `contacts: auto`, or their faces have
// no name in one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/communicator.hpp"
#include "base/types.hpp"
#include "contact/pairing.hpp"
#include "model/model.hpp"

namespace mortise::model {

/// Two bodies by faces that are not the two sides of one contact.
struct CrossedBodies {
  contact::Bodies bodies;
  double depth;  ///< a length: where the way out is shortest
  Point at;      ///< in the middle of what crossed, before it moved
};

/// All of them, the deepest first; what has become deeper by less than a hundredth of the largest displacement is none.
/// `displacement`: of each subdomain, nodes x dimension. Collective.
std::vector<CrossedBodies> crossed_bodies(const Model& model, const std::vector<Eigen::VectorXd>& displacement,
                                          const Communicator& comm);

}  // namespace mortise::model
