// Points inside bodies, and which cells they lie in.
#pragma once

#include <span>
#include <vector>

#include "base/communicator.hpp"
#include "fem/options.hpp"
#include "partition/decomposition.hpp"

namespace mortise::post {

/// A point in a subdomain.
struct PointInCell {
  std::size_t subdomain;      ///< of this rank
  std::size_t cell;           ///< of solid(); of a surface alone any
  Eigen::Vector3d reference;  ///< coordinates in the cell
  Point at;
};

/// Whether a subdomain is known by its skin alone, without cells inside.
inline bool is_surface_alone(const partition::Subdomain& subdomain)
{
  return subdomain.skin && subdomain.inside.cells.size() == 0;
}

/// The cells that a subdomain is made of; of boundary elements those that its skin encloses, or the skin if there are none.
inline const mesh::Mesh& solid(const partition::Subdomain& subdomain)
{
  return subdomain.skin && !is_surface_alone(subdomain) ? subdomain.inside : subdomain.mesh;
}

/// A point in a body, on this rank.
struct PointInBody {
  std::size_t point;  ///< index into the points that were asked for
  Global row;         ///< counts points and, where one lies in several bodies, these, in the order of the catalogue
  int body;
  PointInCell place;
};

/// A point in no body.
struct LostPoint {
  std::size_t point;  ///< index into the points that were asked for
  double distance;    ///< to the nearest node
  int body;           ///< of that node
};

struct FoundPoints {
  std::vector<PointInBody> mine;  ///< of this rank
  Global rows = 0;                ///< on all ranks
  std::vector<LostPoint> lost;    ///< the same on every rank
};

/// Each of `points`, the same on every rank, in each body that it lies in, to 1e-6 of the body's size. One that lies in none is
/// taken to lie on the surface of the nearest body if that is not farther than 5 % of the diagonal of the cell there: so far
/// curved surfaces and their meshes may be apart. Where subdomains meet, it lies in the first of them. Collective.
FoundPoints find_points(const partition::Decomposition& decomposition, fem::Kinematics kinematics, std::span<const Point> points,
                        const Communicator& comm);

}  // namespace mortise::post
