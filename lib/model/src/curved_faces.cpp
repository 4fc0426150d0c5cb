#include "model/curved_faces.hpp"

#include <algorithm>

#include "partition/skin.hpp"
#include "parts.hpp"

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
