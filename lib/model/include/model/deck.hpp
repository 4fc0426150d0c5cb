// The deck as a whole: the sections of all modules, and the checks that cross them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "constraint/coupling.hpp"
#include "constraint/options.hpp"
#include "constraint/springs.hpp"
#include "contact/options.hpp"
#include "deck/document.hpp"
#include "deck/local_axes.hpp"
#include "fem/options.hpp"
#include "feti/options.hpp"
#include "friction/options.hpp"
#include "io/options.hpp"
#include "mesh/mesh.hpp"
#include "mesh/options.hpp"
#include "model/steps.hpp"
#include "partition/options.hpp"
#include "qp/options.hpp"

namespace mortise::model {

/// The section `solver` has keys of two modules.
struct SolverOptions {
  qp::Options programme;
  feti::Options subdomains;
};

/// What the user wrote, with all defaults. It does not change once it is read: what its names mean on a mesh is a Resolution.
struct Deck {
  std::string title;
  fem::Kinematics kinematics = fem::Kinematics::solid;
  mesh::Options mesh;
  std::map<std::string, fem::Material> materials;
  std::map<std::string, fem::BodyOptions> bodies;
  std::map<std::string, deck::AxesOptions> axes;
  std::map<std::string, constraint::CouplingOptions> couplings;
  std::vector<constraint::SupportOptions> supports;
  std::map<std::string, constraint::SpringOptions> springs;
  std::vector<fem::LoadOptions> loads;
  std::vector<contact::Options> contacts;
  std::vector<StepOptions> steps;
  partition::Options decomposition;
  SolverOptions solver;
  friction::Options friction_loop;
  io::Options output;

  int dimension() const { return fem::dimension(kinematics); }
  bool axisymmetric() const { return kinematics == fem::Kinematics::axisymmetric; }
};

/// Reads the deck from `document`: all sections and the checks between them. Paths in the result are absolute. `output` replaces
/// the deck's output directory if it is not empty. Errors go to the document.
Deck read_deck(deck::Document& document, const std::string& output);

/// For each body of the catalogue whether its entry says `method: boundary_elements`.
std::vector<bool> bodies_of_boundary_elements(const Deck& deck, const mesh::Catalogue& catalogue);

/// The local axes of an entry of the deck's section `axes`, which must be there.
deck::LocalAxes local_axes(const Deck& deck, const std::string& name);

/// A boundary by its name in the deck: `boundary`, or `body:boundary` for the part of it that lies on one body, instance or
/// group. A name with wild cards is one boundary: see patterns.hpp.
struct BoundaryName {
  std::string boundary;
  std::string body;  ///< empty: all bodies
};
/// The parts of a name; whether there is such a boundary is not looked at.
BoundaryName parse_boundary(const std::string& name);

/// The contacts of a deck. On a mesh an entry with wild cards, or `auto`, stands for many.
struct Contacts {
  std::vector<contact::Options> options;
  std::vector<std::size_t> entry;  ///< of each: its place in the deck's section

  std::size_t size() const { return options.size(); }
  const contact::Options& operator[](std::size_t contact) const { return options[contact]; }
  /// Where a contact stands in the deck, for messages.
  std::string path(std::size_t contact) const { return "contacts[" + std::to_string(entry[contact]) + "]"; }
};
/// The contacts before names are resolved on a mesh: each entry as one contact.
Contacts as_written(const Deck& deck);

/// Checks that contacts have names and faces of their own. Errors go to the document.
void check_contacts(const Contacts& contacts, fem::Kinematics kinematics, deck::Document& document);

/// Checks all names against the mesh: each body group has an entry, each entry a body, each boundary exists. Errors go to the
/// document.
void check_names(const Deck& deck, const Contacts& contacts, deck::Document& document, const mesh::Catalogue& catalogue);

/// The deck with every default filled in, as YAML that reads back to the same deck.
std::string write_deck(const Deck& deck);

/// JSON schema of a deck.
std::string deck_schema();

}  // namespace mortise::model
