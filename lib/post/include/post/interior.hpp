// Displacements and stresses inside bodies, where they are asked for.
//
// In bodies of boundary elements by Somigliana's identity, from displacements and tractions of the surface
// (bem/representation.hpp) and the particular solution of weight and temperature.
#pragma once

#include <span>

#include "post/stress_recovery.hpp"

namespace mortise::post {

/// At some points.
struct Values {
  Eigen::MatrixXd displacement;  ///< points x 3
  Eigen::MatrixXd stress;        ///< points x 6, XX YY ZZ XY YZ XZ
};

/// What is asked for.
struct Probes {
  bool cells = false;  ///< the nodes inside bodies of boundary elements
};

struct Interior {
  /// Of each subdomain: at the nodes that Subdomain::inside has after those of the skin, and of each of its cells the von Mises
  /// stress in the middle. Empty if they are not asked for.
  std::vector<Values> nodes;
  std::vector<Eigen::VectorXd> cell_von_mises;
};

/// `stress`: of the displacements that were recovered last; its largest von Mises stress becomes that inside, if that is larger.
/// Collective.
Interior evaluate_interior(const ElasticBodies& bodies, const Probes& probes, StressField& stress, const Communicator& comm);

}  // namespace mortise::post
