// What is checked of a deck without its mesh: keys of one section beside those of others. Errors go to the document.
#pragma once

#include "model/deck.hpp"

namespace mortise::model {

/// Bodies beside materials, formulations and methods; cells of blocks beside the dimension.
void check_bodies(const Deck& deck, deck::Document& document);
/// `method: grid` beside blocks, clusters beside boundary elements.
void check_decomposition(const Deck& deck, deck::Document& document);
/// Rounded factors beside the tolerance.
void check_solver(const Deck& deck, deck::Document& document);
/// In a plane model nothing has a z component, in one of dimension 3 no vector has two entries.
void check_vectors(const Deck& deck, deck::Document& document);
/// Couplings by their names, and what prescribes or touches them.
void check_couplings(const Deck& deck, deck::Document& document);
/// Local axes by their names, and what has components along them.
void check_axes(const Deck& deck, deck::Document& document);
/// r and theta are polar coordinates of x and y, which are the radius and the axis in an axisymmetric model.
void check_formulas_of_rings(const Deck& deck, deck::Document& document);

}  // namespace mortise::model
