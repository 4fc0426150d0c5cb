// What the section `bodies` says about the assembly: instances of bodies, and bodies of several volumes or
// of closed surfaces.
#pragma once

#include "model/deck.hpp"

namespace mortise::model {

/// Fills deck.mesh.instances, deck.mesh.volumes and deck.mesh.surfaces from deck.bodies, and checks what does not need the mesh:
/// motions fit the dimension of the model, no two copies lie in the same place, every volume is in one body. Errors go to the
/// document.
void describe_assembly(Deck& deck, deck::Document& document);

/// Whether the mesh has the volumes of the bodies. Errors go to the document.
void check_volumes(const Deck& deck, deck::Document& document, const mesh::Catalogue& catalogue);

/// Whether the material is one of the body's.
bool is_made_of(const fem::BodyOptions& body, const std::string& material);

/// How a body was moved from where its part lies in the mesh; none: it has no copies.
std::optional<mesh::Motion> motion_of(const mesh::Body& body, const Deck& deck);

}  // namespace mortise::model
