// Displacements and stresses inside bodies, where they are asked for.
//
// In bodies of boundary elements by Somigliana's identity, from displacements and tractions of the surface
// (bem/representation.hpp) and the particular solution of weight and temperature: in each subdomain from its own surface. In
// bodies of finite elements displacements, and stresses recovered at the nodes, are interpolated by the shape functions of the
// cell.
#pragma once

#include <array>

#include "post/extremes.hpp"
#include "post/places.hpp"
#include "post/stress_recovery.hpp"

namespace mortise::post {

/// Displacements and stresses at some points.
struct Values {
  Eigen::MatrixXd displacement;  ///< points x 3
  Eigen::MatrixXd stress;        ///< points x 6, XX YY ZZ XY YZ XZ
};

/// The part of a plane that lies in this rank's subdomains, as triangles.
struct PlaneSection {
  std::vector<PointInCell> places;
  std::vector<std::array<Local, 3>> triangles;  ///< each of places of one subdomain
};

/// What is asked for.
struct Probes {
  bool cells = false;               ///< the nodes inside bodies of boundary elements
  std::vector<PointInBody> points;  ///< of this rank
  Global rows = 0;                  ///< of points, on all ranks
  std::vector<PlaneSection> planes;
  std::vector<PointInBody> sampled;  ///< of this rank: the points and paths of named probes, counted through all of these
  Global samples = 0;                ///< rows of these, on all ranks
  std::vector<ExtremeProbe> extremes;

  /// Whether anything inside bodies is to be evaluated; the same on every rank.
  bool any_inside() const { return cells || rows > 0 || samples > 0 || !planes.empty(); }
};

struct Interior {
  /// Of each subdomain: at the nodes that Subdomain::inside has after those of the skin, and of each of its cells the von Mises
  /// stress in the middle. Empty if they are not asked for.
  std::vector<Values> nodes;
  std::vector<Eigen::VectorXd> cell_von_mises;
  Values points;               ///< of Probes::points
  std::vector<Values> planes;  ///< of Probes::planes
  Values sampled;              ///< of Probes::sampled
};

/// What `probes` ask for inside bodies. `stress`: recovered from `displacement`; its largest von Mises stress becomes that inside
/// boundary elements if that is larger. Collective.
Interior evaluate_interior(const ElasticBodies& bodies, const Probes& probes, const std::vector<Eigen::VectorXd>& displacement,
                           StressField& stress, const Communicator& comm);

}  // namespace mortise::post
