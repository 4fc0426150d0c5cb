// Elements of a .msh file of version 2 name a physical group and an entity; gmsh's library goes by the entity alone.
#pragma once

#include <string>

namespace mortise::mesh {

/// Refuses a .msh file of version 2, text or binary, in which elements of one entity belong to different physical groups: all of
/// them would be in each of these groups. An entity that is in several groups has each element once for each of them. Files of
/// other versions, and what is damaged, pass. Throws as fail().
void require_own_entities(const std::string& file);

}  // namespace mortise::mesh
