// What the deck asks for at points, along paths, in sections and of extremes, on a mesh.
#pragma once

#include "analysis/warnings.hpp"
#include "model/model.hpp"
#include "post/interior.hpp"

namespace mortise::analysis {

/// The sections `output.interior` and `output.probes` on the model's subdomains; extremes in the order of the latter's names.
/// Throws Error(bad_input), with the line of the deck, if a point or a whole path lies in no body, a body, boundary or contact is
/// not there, or a section would have millions of triangles. Collective.
post::Probes find_probes(const model::Model& model, deck::Document& document, const Communicator& comm);

/// "idle_plane": a plane that meets no body. Collective.
std::vector<Warning> idle_planes(const model::Deck& deck, const post::Probes& probes, const Communicator& comm);

}  // namespace mortise::analysis
