#include "model/curved_faces.hpp"

#include <algorithm>
#include <charconv>

#include "partition/skin.hpp"

namespace mortise::model {

namespace {

// The faces of the contacts that ask the geometry, ascending.
std::vector<Global> asked_faces(const std::vector<contact::Pair>& pairs)
{
  std::vector<Global> faces;
  for (const auto& pair : pairs) {
    if (!contact::asks_geometry(pair.options) || !pair.primary) continue;
    faces.insert(faces.end(), pair.secondary.face_id.begin(), pair.secondary.face_id.end());
    faces.insert(faces.end(), pair.primary->face_id.begin(), pair.primary->face_id.end());
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

// How a body was moved from where its part lies in the mesh.
std::optional<mesh::Motion> motion_of(const mesh::Body& body, const Deck& deck)
{
  const auto copies = deck.mesh.instances.find(body.group);
  if (body.instance.empty() || copies == deck.mesh.instances.end()) return {};
  std::size_t number = 0;  // group.number, from 1
  const char* end = body.instance.data() + body.instance.size();
  std::from_chars(body.instance.data() + body.group.size() + 1, end, number);
  return copies->second.at(number - 1);
}

}  // namespace

std::vector<contact::CurvedFace> curved_faces(const Deck& deck, const partition::Decomposition& decomposition,
                                              const std::vector<contact::Pair>& pairs)
{
  const auto& catalogue = decomposition.catalogue;
  std::vector<std::optional<mesh::CurvedSurface>> surfaces;
  for (const auto& name : catalogue.boundaries) surfaces.push_back(mesh::curved_surface(name));
  std::vector<contact::CurvedFace> faces;
  if (std::none_of(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.has_value(); })) return faces;
  const auto asked = asked_faces(pairs);
  for (const auto& subdomain : decomposition.subdomains) {
    const auto motion = motion_of(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], deck);
    const auto& boundary = subdomain.mesh.facets.boundary;
    for (std::size_t f = 0; f < boundary.size(); ++f) {
      const auto& surface = surfaces[static_cast<std::size_t>(boundary[f])];
      if (!surface) continue;
      const Global face = partition::face_number(subdomain.mesh, f);
      if (std::binary_search(asked.begin(), asked.end(), face))
        faces.emplace_back(face, motion ? mesh::moved(*surface, *motion) : *surface);
    }
  }
  return faces;
}

}  // namespace mortise::model
