// Why a subdomain's stiffness matrix cannot be factorized, in the user's words.
#pragma once

#include <string>

#include "fem/materials.hpp"
#include "partition/decompose.hpp"

namespace mortise::model {

/// A message for a subdomain of the body `name` whose matrix is singular to the accuracy of numbers: what is extreme about its
/// cells and materials, and what helps.
std::string why_indefinite(const partition::Subdomain& subdomain, const fem::Materials& materials, const std::string& name);

}  // namespace mortise::model
