#include "side_bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "model/patterns.hpp"

namespace mortise::model {

namespace {

// Pressures at nodes of a stiff side of smaller faces start to scatter at thirty.
constexpr double far_stiffer = 20;

// The boxes of this rank's faces on a boundary, and how far apart their nodes are.
struct Faces {
  std::vector<Eigen::AlignedBox3d> box;
  std::vector<double> spacing;
  Eigen::AlignedBox3d whole;  // of all ranks
};

// Collective.
Faces faces_on(const std::string& name, const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto& catalogue = decomposition.catalogue;
  const auto [boundary, body] = parse_boundary(name);
  Faces result;
  for (const auto& subdomain : decomposition.subdomains) {
    if (!body.empty() && !matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body)) continue;
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.cells.size(); ++f) {
      if (catalogue.boundaries[static_cast<std::size_t>(facets.boundary[f])] != boundary) continue;
      const auto nodes = facets.cells[f];
      const auto at = [&](std::size_t k) { return subdomain.mesh.points[static_cast<std::size_t>(nodes[k])]; };
      const auto corners = static_cast<std::size_t>(mesh::corner_count(facets.cells.type[f]));
      Eigen::AlignedBox3d box;
      double longest = 0;
      for (std::size_t k = 0; k < corners; ++k) {
        box.extend(at(k));
        longest = std::max(longest, (at(k) - at((k + 1) % corners)).norm());
      }
      result.box.push_back(box);
      result.spacing.push_back(nodes.size() > corners ? longest / 2 : longest);
      result.whole.extend(box);
    }
  }
  for (int i = 0; i < 3; ++i) {
    result.whole.min()[i] = comm.min(result.whole.min()[i]);
    result.whole.max()[i] = comm.max(result.whole.max()[i]);
  }
  return result;
}

// The harmonic mean of spacings where the faces are next to a box: of graded sides that of the small faces, which are the many.
// Collective.
double spacing_near(const Faces& faces, const Eigen::AlignedBox3d& other, const Communicator& comm)
{
  double count = 0, sum = 0;
  for (std::size_t f = 0; f < faces.box.size(); ++f) {
    if (faces.box[f].exteriorDistance(other) > 2 * faces.spacing[f]) continue;
    ++count;
    sum += 1 / faces.spacing[f];
  }
  return comm.sum(count) / comm.sum(sum);
}

// Whether the nodes of the secondary side stand closer than those of the primary one, where they meet. Collective.
bool finer(const contact::Options& contact, const partition::Decomposition& decomposition, const Communicator& comm)
{
  constexpr double alike = 0.99;
  const auto secondary = faces_on(contact.secondary, decomposition, comm);
  const auto primary = faces_on(contact.primary, decomposition, comm);
  return spacing_near(secondary, primary.whole, comm) < alike * spacing_near(primary, secondary.whole, comm);
}

}  // namespace

std::map<int, std::set<int>> bodies_on_sides(const std::vector<contact::Options>& contacts,
                                             const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto& catalogue = decomposition.catalogue;
  std::map<std::pair<std::string, std::string>, std::vector<int>> sides;  // boundary, body: contact and side
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].automatic || contacts[c].obstacle || contacts[c].cyclic) continue;
    int side = 2 * static_cast<int>(c);
    for (const auto& name : {contacts[c].secondary, contacts[c].primary}) {
      const auto [boundary, body] = parse_boundary(name);
      sides[{boundary, body}].push_back(side++);
    }
  }
  std::set<std::array<int, 2>> mine;  // contact and side, body
  std::set<std::pair<int, int>> own;  // boundary, body
  for (const auto& subdomain : decomposition.subdomains)
    for (const int boundary : subdomain.mesh.facets.boundary) own.emplace(boundary, subdomain.body);
  for (const auto& [name, which] : sides)
    for (const auto& [boundary, body] : own)
      if (catalogue.boundaries[static_cast<std::size_t>(boundary)] == name.first &&
          (name.second.empty() || matches_name(catalogue.bodies[static_cast<std::size_t>(body)], name.second)))
        for (const int side : which) mine.insert({side, body});
  std::map<int, std::set<int>> bodies;
  for (const auto& [side, body] : comm.all_gather(std::vector(mine.begin(), mine.end()))) bodies[side].insert(body);
  return bodies;
}

double least_modulus(const Deck& deck, const mesh::Body& body)
{
  double softest = std::numeric_limits<double>::infinity();
  for (const auto& name : material_names(body_entry(deck, body.group)->second))
    softest = std::min(softest, deck.materials.at(name).modulus());
  return softest;
}

void exchange_stiff_sides(const Deck& deck, Contacts& contacts, const partition::Decomposition& decomposition,
                          const Communicator& comm)
{
  const auto sides = bodies_on_sides(contacts.options, decomposition, comm);
  const auto modulus = [&](std::size_t side) {
    double softest = std::numeric_limits<double>::infinity();
    if (const auto found = sides.find(static_cast<int>(side)); found != sides.end())
      for (const int body : found->second)
        softest = std::min(softest, least_modulus(deck, decomposition.catalogue.bodies[static_cast<std::size_t>(body)]));
    return softest;
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    auto& contact = contacts.options[c];
    if (contact.preload || !contact::sides_are_alike(contact) || !sides.count(2 * static_cast<int>(c))) continue;
    if (!(modulus(2 * c) > far_stiffer * modulus(2 * c + 1))) continue;
    if (contact.law != contact::Law::bonded && !finer(contact, decomposition, comm)) continue;
    std::swap(contact.secondary, contact.primary);
    contact.exchanged = true;
  }
}

}  // namespace mortise::model
