// The deck's section `steps`: how loads, supports and overlaps change from one equilibrium to the next.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "deck/description.hpp"

namespace mortise::model {

struct Deck;
struct Contacts;

/// One load step. What it does not name stays as the step before left it. The first one comes from nothing and ends with factors
/// 1, but formulas that hold t rise by themselves.
struct StepOptions {
  std::string name;  ///< default: its number
  /// The factor of a load, a support's displacement, a contact's interference or preload, by name.
  std::map<std::string, double> scale;
  std::vector<std::string> off, on;  ///< loads and supports that cease to act, or act again
  int increments = 1;                ///< so many equilibria, between which factors change linearly
};

/// The keywords.
void describe(deck::Description<StepOptions>& d);

/// Checks that the steps name loads, supports and contacts that exist. Errors go to the document.
void check_steps(const Deck& deck, deck::Document& document);

/// One equilibrium to be found: what acts, in the order of the deck's lists.
struct LoadState {
  std::string step;                            ///< name of its step; empty if the deck has none
  double time = 1;                             ///< steps done so far; 0.5 half way through the first
  std::vector<double> load, support, contact;  ///< factors of each; 0 for a load that is off
  std::vector<bool> acting;                    ///< of each support: whether it acts
  std::vector<bool> locked;                    ///< of each contact: a preloaded bolt keeps the length it has
};

/// All states of a deck, in order; one if it has no steps. `contacts`: those of its mesh.
std::vector<LoadState> load_states(const Deck& deck, const Contacts& contacts);

}  // namespace mortise::model
