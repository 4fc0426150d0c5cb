// Which faces are on the two sides of contacts.
#pragma once

#include "contact/interpenetration.hpp"
#include "mesh/mesh.hpp"
#include "model/model.hpp"

namespace mortise::model {

/// The faces on the two sides of each contact between bodies; with `skin`, the outer surface, those round them, too: where the
/// sides stand in each other by next to nothing, as where bodies turn, the nearest face may be one across their edges. Contacts
/// of sectors with the next one only without `skin`. Collective.
contact::ContactSides sides_of_contacts(const Model& model, const mesh::Surface* skin, const Communicator& comm);

}  // namespace mortise::model
