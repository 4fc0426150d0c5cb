// The deck's section `supports`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "deck/description.hpp"
#include "deck/formula.hpp"
#include "deck/place.hpp"

namespace mortise::constraint {

/// Prescribed displacement of a boundary or of nodes, or motion of a coupling's point; a component without a value is free.
struct SupportOptions {
  std::string boundary;
  std::array<std::optional<deck::Formula>, 3> displacement;  ///< along x, y, z, or the local `axes`
  std::optional<deck::Formula> normal = {};                  ///< along the boundary's own outward normal
  std::string name = {};                                     ///< default: the boundary or coupling
  std::string coupling = {};                                 ///< instead of a boundary
  std::array<std::optional<double>, 3> rotation = {};        ///< of a coupling: angles about the axes through its point
  std::string axes = {};                                     ///< name of local axes; empty: those of the model
  bool cylindrical = false;                                  ///< components are called radial, tangential, axial
  std::vector<deck::Place> points = {};                      ///< instead of a boundary: the nodes at these places
  std::string body = {};                                     ///< of `points`, where several bodies have nodes there
  /// Instead of displacements: springs to the ground, force per length at points, force per length and area on a boundary.
  struct Stiffness {
    std::array<std::optional<double>, 3> along = {};  ///< x, y, z
    std::optional<double> normal = {}, tangential = {};
    bool any() const { return along[0] || along[1] || along[2] || normal || tangential; }
  } stiffness = {};
};

/// The keywords.
void describe(deck::Description<SupportOptions>& d);

}  // namespace mortise::constraint
