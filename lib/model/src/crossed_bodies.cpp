#include "model/crossed_bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "contact/pairing.hpp"
#include "model/patterns.hpp"
#include "partition/skin.hpp"

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

// The mean of the middles of faces, of all ranks.
Point middle_of(const mesh::Surface& skin, const std::vector<Global>& faces, const Communicator& comm)
{
  std::vector<double> sum(4, 0.0);
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    if (!std::binary_search(faces.begin(), faces.end(), skin.face_id[f])) continue;
    for (const Local n : skin.faces[f]) {
      for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(k)] += skin.points[static_cast<std::size_t>(n)][k];
      sum[3] += 1;
    }
  }
  comm.sum_in_place(sum);
  return Point(sum[0], sum[1], sum[2]) / std::max(sum[3], 1.0);
}

// The faces on the two sides of each contact, and those round them: where the sides stand in each other by next to nothing, as where
// bodies turn, faces across their edges look through that. Collective.
contact::KnownContacts sides_of_contacts(const std::vector<contact::Options>& contacts, const mesh::Surface& skin,
                                         const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto& catalogue = decomposition.catalogue;
  std::map<int, std::vector<std::pair<std::string, int>>> sides;  // boundary: body's name, if any, and side
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].obstacle || contacts[c].cyclic) continue;
    int side = 2 * static_cast<int>(c);
    for (const auto& name : {contacts[c].secondary, contacts[c].primary}) {
      const auto [boundary, body] = parse_boundary(name);
      const auto found = std::find(catalogue.boundaries.begin(), catalogue.boundaries.end(), boundary);
      sides[static_cast<int>(found - catalogue.boundaries.begin())].emplace_back(body, side++);
    }
  }
  struct Of {
    Global number;  // of a face or a node
    int side, body;
  };
  std::vector<Of> mine, nodes;
  for (const auto& subdomain : decomposition.subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.boundary.size(); ++f)
      if (const auto found = sides.find(facets.boundary[f]); found != sides.end())
        for (const auto& [body, side] : found->second)
          if (body.empty() || matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body)) {
            mine.push_back({partition::face_number(subdomain.mesh, f), side, subdomain.body});
            for (const Local n : facets.cells[f])
              nodes.push_back({subdomain.mesh.node_id[static_cast<std::size_t>(n)], side, subdomain.body});
          }
  }
  std::map<Global, std::set<std::pair<int, int>>> sides_at;  // of nodes: body and side
  for (const auto& [node, side, body] : comm.all_gather(nodes)) sides_at[node].emplace(body, side);
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f])
      if (const auto found = sides_at.find(skin.node_id[static_cast<std::size_t>(n)]); found != sides_at.end())
        for (const auto& [body, side] : found->second)
          if (body == skin.body[f]) mine.push_back({skin.face_id[f], side, body});
  contact::KnownContacts known;
  for (const auto& [face, side, body] : comm.all_gather(mine)) {
    auto& of_face = known.sides_of[face];
    if (std::find(of_face.begin(), of_face.end(), side) == of_face.end()) of_face.push_back(side);
  }
  return known;
}

// Of each two bodies the shallowest crossing that is deeper than `least`: where one body stands in another, sides of it look
// through that as well. Depths are negative gaps; places are those of `skin`.
std::map<contact::Bodies, CrossedBodies> crossings(const std::vector<contact::ContactCandidate>& candidates, double least,
                                                   const mesh::Surface& skin, const Communicator& comm)
{
  std::map<contact::Bodies, CrossedBodies> shallowest;
  for (const auto& candidate : candidates) {
    const double depth = -candidate.least_gap;
    if (!(depth > least)) continue;
    const contact::Bodies bodies = std::minmax(candidate.secondary, candidate.primary);
    const auto found = shallowest.find(bodies);
    if (found != shallowest.end() && found->second.depth <= depth) continue;
    shallowest.insert_or_assign(bodies, CrossedBodies{bodies, depth, middle_of(skin, candidate.secondary_faces, comm)});
  }
  return shallowest;
}

}  // namespace

std::vector<CrossedBodies> crossed_bodies(const Model& model, const std::vector<Eigen::VectorXd>& displacement,
                                          const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const auto bodies = static_cast<int>(decomposition.catalogue.bodies.size());
  if (bodies < 2) return {};
  const auto skin = partition::outer_surface(decomposition, comm);
  Eigen::AlignedBox3d box;
  for (const auto& x : skin.points) box.extend(x);
  auto deformed = skin;
  const double longest = comm.max(displace(deformed, decomposition, displacement, fem::dimension(deck.kinematics)));
  // Two bodies come nearer by twice the longest displacement. What moves by more than the model's size is told as such.
  contact::Options search;
  search.search_distance = 2 * longest;
  if (!(longest > 0) || !(longest < comm.max(box.isEmpty() ? 0.0 : box.diagonal().norm()))) return {};
  const auto known = sides_of_contacts(model.contacts().options, skin, decomposition, comm);
  const auto find = [&](const mesh::Surface& surface) {
    return contact::find_contact_candidates(surface, bodies, known, search, deck.kinematics, comm);
  };
  const auto crossed_now = crossings(find(deformed), crossed * longest, skin, comm);
  if (crossed_now.empty()) return {};
  // Facets of bodies that fit may cross before anything moves. Nothing gets deeper by more than it moves.
  const auto crossed_before = crossings(find(skin), 0, skin, comm);
  std::vector<CrossedBodies> result;
  for (const auto& [two, crossing] : crossed_now) {
    const auto before = crossed_before.find(two);
    const double deeper = crossing.depth - (before == crossed_before.end() ? 0 : before->second.depth);
    if (deeper > crossed * longest && deeper <= 2 * longest) result.push_back(crossing);
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.depth > b.depth; });
  return result;
}

}  // namespace mortise::model
