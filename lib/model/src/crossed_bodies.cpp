#include "model/crossed_bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "contact/interpenetration.hpp"
#include "contact/self_crossing.hpp"
#include "contact_sides.hpp"

namespace mortise::model {

namespace {

// Of the largest displacement: what bodies cross by less is no more than corners that meet.
constexpr double crossed = 0.01;

// Moves the points of a skin by the displacements of its nodes, nodes x dimension of each subdomain. Returns the longest.
double displace(mesh::Surface& skin, const partition::Decomposition& decomposition,
                const std::vector<Eigen::VectorXd>& displacement, int dimension)
{
  double longest = 0;
  std::vector<char> moved(skin.points.size(), 0);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& ids = decomposition.subdomains[s].mesh.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const auto found = std::lower_bound(skin.node_id.begin(), skin.node_id.end(), ids[n]);
      if (found == skin.node_id.end() || *found != ids[n]) continue;
      const auto at = static_cast<std::size_t>(found - skin.node_id.begin());
      if (std::exchange(moved[at], 1)) continue;
      Point u = Point::Zero();
      u.head(dimension) = displacement[s].segment(dimension * static_cast<Eigen::Index>(n), dimension);
      skin.points[at] += u;
      longest = std::max(longest, u.norm());
    }
  }
  return longest;
}

// Of the places of one body in another, the same on every rank, the deepest: of those that are deep alike the one in their
// middle.
Point deepest_place(const std::vector<contact::Interpenetration>& places, double depth)
{
  constexpr double alike = 0.99, nearer = 1e-6;
  const auto first = std::find_if(places.begin(), places.end(), [&](const auto& p) { return p.depth >= alike * depth; });
  std::vector<Point> deep;
  Point mean = Point::Zero();
  for (auto place = first; place != places.end() && place->body == first->body; ++place)
    if (place->depth >= alike * depth) mean += deep.emplace_back(place->at);
  mean /= static_cast<double>(deep.size());
  const Point* best = &deep.front();
  for (const auto& x : deep)
    if ((x - mean).norm() < (1 - nearer) * (*best - mean).norm()) best = &x;
  return *best;
}

}  // namespace

std::vector<CrossedBodies> crossed_bodies(const Model& model, const std::vector<Eigen::VectorXd>& displacement,
                                          const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const auto bodies = static_cast<int>(decomposition.catalogue.bodies.size());
  const auto& skin = model.outer_surface(comm);
  Eigen::AlignedBox3d box;
  for (const auto& x : skin.points) box.extend(x);
  auto deformed = skin;
  const double longest = comm.max(displace(deformed, decomposition, displacement, fem::dimension(deck.kinematics)));
  // What moves by more than the model's size is told as such.
  if (!(longest > 0) || !(longest < comm.max(box.isEmpty() ? 0.0 : box.diagonal().norm()))) return {};
  const auto sides = [&] { return sides_of_contacts(model, &skin, comm); };
  // Two bodies come nearer by twice the longest displacement.
  std::map<contact::Bodies, std::vector<contact::Interpenetration>> of_bodies;
  if (bodies > 1) {
    for (const auto& place :
         contact::find_interpenetrations(skin, deformed, bodies, sides, {crossed * longest, 2 * longest}, deck.kinematics, comm))
      of_bodies[std::minmax(place.body, place.other)].push_back(place);
    for (const auto& place : contact::find_enclosed_bodies(skin, deformed, bodies, sides, deck.kinematics, comm))
      of_bodies.try_emplace(std::minmax(place.body, place.other), 1, place);
  }
  for (const auto& place : contact::find_self_crossings(skin, deformed, sides, crossed, deck.kinematics, comm))
    of_bodies[{place.body, place.body}].push_back(place);
  std::vector<CrossedBodies> result;
  for (auto& [two, their] : of_bodies) {
    double depth = 0;
    for (const auto& place : their) depth = std::max(depth, place.depth);
    result.push_back({two, depth, deepest_place(their, depth)});
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.depth > b.depth; });
  return result;
}

}  // namespace mortise::model
