// Displacements and stresses at the points of a piece.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/quantity.hpp"
#include "io/vtk.hpp"
#include "model/deck.hpp"

namespace mortise::output {

/// Those fields that the deck asks for: displacement, von_mises, stress and principal_stress, and where `output.axes` names axes
/// displacement_local and stress_local along these.
class PointFields {
 public:
  PointFields(const model::Deck& deck, std::size_t points);

  /// Of the point of this number, which lies at `place`.
  void set(std::size_t number, const Point& place, const Point& displacement, const fem::Stress& stress);

  /// Adds them to the piece's, in the order above.
  void move_to(io::Piece& piece);

 private:
  struct Values;
  struct Kind;
  static const std::vector<Kind>& kinds();

  std::optional<deck::LocalAxes> axes_;
  std::vector<const Kind*> kind_;  // of each field
  std::vector<io::Field> fields_;
};

}  // namespace mortise::output
