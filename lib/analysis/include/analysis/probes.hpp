// What the deck asks for inside bodies, on a mesh.
#pragma once

#include "analysis/warnings.hpp"
#include "model/model.hpp"
#include "post/interior.hpp"

namespace mortise::analysis {

/// The section `output.interior` on the model's subdomains. Throws Error(bad_input), with the line of the deck, if a point lies
/// in no body or a section would have millions of triangles. Collective.
post::Probes find_probes(const model::Model& model, deck::Document& document, const Communicator& comm);

/// "idle_plane": a plane that meets no body. Collective.
std::vector<Warning> idle_planes(const model::Deck& deck, const post::Probes& probes, const Communicator& comm);

}  // namespace mortise::analysis
