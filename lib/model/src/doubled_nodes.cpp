#include "model/doubled_nodes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "contact/doubled_faces.hpp"
#include "contact/hanging_faces.hpp"
#include "contact_sides.hpp"
#include "model/patterns.hpp"
#include "partition/skin.hpp"

namespace mortise::model {

namespace {

// Of some places, by their numbers, the one that is nearest to their middle; of equals the first.
template <class Number>
Point nearest_to_middle(const std::map<Number, Point>& places)
{
  constexpr double nearer = 1e-6;
  Point mean = Point::Zero();
  for (const auto& [number, x] : places) mean += x / static_cast<double>(places.size());
  const Point* best = &places.begin()->second;
  for (const auto& [number, x] : places)
    if ((x - mean).norm() < (1 - nearer) * (*best - mean).norm()) best = &x;
  return *best;
}

std::vector<DoubledNodes> doubled_nodes(const std::vector<contact::DoubledFaces>& doubled, const contact::ContactSides& sides)
{
  std::map<int, std::map<std::array<Global, 2>, Point>> of_body;
  for (const auto& two : doubled) {
    if (sides.opposite(two.faces[0], two.faces[1])) continue;
    for (const auto& node : two.nodes) of_body[two.body].emplace(node.numbers, node.at);
  }
  std::vector<DoubledNodes> result;
  for (const auto& [body, nodes] : of_body)
    result.push_back({body, static_cast<long long>(nodes.size()), nearest_to_middle(nodes)});
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.nodes > b.nodes; });
  return result;
}

// Of each body the first one of its group or instance: parts that a mesh leaves side by side are one body to whoever meshed them.
std::vector<int> first_parts(const mesh::Catalogue& catalogue)
{
  std::map<std::string, int> first;
  std::vector<int> result;
  for (std::size_t b = 0; b < catalogue.bodies.size(); ++b)
    result.push_back(first.emplace(mesh::whole_of(catalogue.bodies[b]), static_cast<int>(b)).first->second);
  return result;
}

// Faces on boundaries that supports hold, of all ranks. Collective.
std::set<Global> supported_faces(const Model& model, const Communicator& comm)
{
  const auto& catalogue = model.decomposition().catalogue;
  std::map<int, std::vector<std::string>> supported;  // boundary: names of bodies
  for (const auto& support : model.deck().supports) {
    const auto [boundary, body] = parse_boundary(support.boundary);
    const auto found = std::find(catalogue.boundaries.begin(), catalogue.boundaries.end(), boundary);
    if (found != catalogue.boundaries.end()) supported[static_cast<int>(found - catalogue.boundaries.begin())].push_back(body);
  }
  std::vector<Global> faces;
  for (const auto& subdomain : model.decomposition().subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.boundary.size(); ++f)
      if (const auto found = supported.find(facets.boundary[f]); found != supported.end())
        for (const auto& body : found->second)
          if (body.empty() || matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body))
            faces.push_back(partition::face_number(subdomain.mesh, f));
  }
  faces = comm.all_gather(faces);
  return {faces.begin(), faces.end()};
}

// Collective.
std::vector<HangingNodes> hanging_nodes(const std::vector<contact::HangingFaces>& hanging, const contact::ContactSides& sides,
                                        const Model& model, const Communicator& comm)
{
  if (hanging.empty()) return {};
  const auto supported = supported_faces(model, comm);
  std::map<int, std::map<Global, Point>> of_body;  // by the face whose middle lies on another
  for (const auto& two : hanging) {
    const auto in_contact = [&](Global face) { return sides.of_face.contains(face); };
    if (std::any_of(two.faces.begin(), two.faces.end(), in_contact)) continue;
    if (supported.contains(two.faces[0]) && supported.contains(two.faces[1])) continue;
    of_body[two.body].emplace(two.middle_of, two.at);
  }
  std::vector<HangingNodes> result;
  for (const auto& [body, faces] : of_body)
    result.push_back({body, static_cast<long long>(faces.size()), nearest_to_middle(faces)});
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.faces > b.faces; });
  return result;
}

}  // namespace

OpenSeams open_seams(const Model& model, const Communicator& comm)
{
  auto skin = model.outer_surface(comm);
  const auto first = first_parts(model.decomposition().catalogue);
  for (int& body : skin.body) body = first[static_cast<std::size_t>(body)];
  const auto kinematics = model.deck().kinematics;
  const auto doubled = contact::find_doubled_faces(skin, kinematics, comm);
  const auto hanging = contact::find_hanging_faces(skin, kinematics, comm);
  if (doubled.empty() && hanging.empty()) return {};
  const auto sides = sides_of_contacts(model, nullptr, comm);
  return {doubled_nodes(doubled, sides), hanging_nodes(hanging, sides, model, comm)};
}

}  // namespace mortise::model
