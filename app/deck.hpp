// The deck as a whole: the sections of all modules, and the checks that cross them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "constraint/options.hpp"
#include "contact/options.hpp"
#include "deck/document.hpp"
#include "fem/options.hpp"
#include "feti/options.hpp"
#include "friction/options.hpp"
#include "io/options.hpp"
#include "mesh/mesh.hpp"
#include "mesh/options.hpp"
#include "partition/options.hpp"
#include "qp/options.hpp"
#include "steps.hpp"

namespace mortise {

/// The section `solver` has keys of two modules.
struct SolverOptions {
  qp::Options programme;
  feti::Options subdomains;
};

struct Deck {
  std::string title;
  fem::Kinematics kinematics = fem::Kinematics::solid;
  mesh::Options mesh;
  std::map<std::string, fem::Material> materials;
  std::map<std::string, fem::BodyOptions> bodies;
  std::vector<constraint::SupportOptions> supports;
  std::vector<fem::LoadOptions> loads;
  std::vector<contact::Options> contacts;
  std::vector<StepOptions> steps;
  partition::Options decomposition;
  SolverOptions solver;
  friction::Options friction_loop;
  io::Options output;

  int dimension() const { return fem::dimension(kinematics); }
  /// Which entry of the deck's section each of `contacts` comes from: a wild card makes many of one. Empty: each from its own.
  std::vector<std::size_t> contact_entries;
  /// Names of the section's entries, which load steps know.
  std::vector<std::string> contact_names;
  /// Where a contact stands in the deck, for messages.
  std::string contact_path(std::size_t contact) const
  {
    return "contacts[" + std::to_string(contact_entries.empty() ? contact : contact_entries[contact]) + "]";
  }
  bool axisymmetric() const { return kinematics == fem::Kinematics::axisymmetric; }
};

/// Reads the deck from `document`: all sections and the checks between them. Paths in the result are absolute. `output` replaces
/// the deck's output directory if it is not empty. Errors go to the document.
Deck read_deck(deck::Document& document, const std::string& output);

/// A boundary by its name in the deck: `boundary`, or `body:boundary` for the part of it that lies on one body, instance or
/// group. A name with wild cards is one boundary: see patterns.hpp.
struct BoundaryName {
  std::string boundary;
  std::string body;  ///< empty: all bodies
};
BoundaryName parse_boundary(const std::string& name);

/// Checks that contacts have names and faces of their own. Errors go to the document.
void check_contact_names(const Deck& deck, deck::Document& document);

/// Checks all names against the mesh: each body group has an entry, each entry a body, each boundary exists. Errors go to the
/// document.
void check_names(const Deck& deck, deck::Document& document, const mesh::Catalogue& catalogue);

/// The deck with every default filled in, as YAML that reads back to the same deck.
std::string write_deck(const Deck& deck);

/// JSON schema of a deck.
std::string deck_schema();

}  // namespace mortise
