// Displacements and stresses along the axes that the deck's `output.axes` names.
#pragma once

#include <algorithm>
#include <optional>

#include "fem/quantity.hpp"
#include "io/vtk.hpp"
#include "model/deck.hpp"

namespace mortise {

/// The fields displacement_local and stress_local of a piece, of as many points as it has; none if the deck names no axes.
class LocalFields {
 public:
  LocalFields(const model::Deck& deck, std::size_t points) : deck_(deck)
  {
    if (deck.output.axes.empty()) return;
    axes_ = model::local_axes(deck, deck.output.axes);
    displacement_.values.resize(3 * points);
    stress_.values.resize(6 * points);
  }

  /// Of the point of this number.
  void set(std::size_t number, const Point& place, const Point& displacement, const fem::Stress& stress)
  {
    if (!axes_) return;
    const auto axes = axes_->everywhere(place);
    Eigen::Map<Point>(&displacement_.values[3 * number]) = axes * displacement;
    Eigen::Map<fem::Stress>(&stress_.values[6 * number]) = fem::along(axes, stress);
  }

  void move_to(io::Piece& piece)
  {
    if (!axes_) return;
    for (auto* field : {&displacement_, &stress_}) {
      const auto of = field->name.substr(0, field->name.find('_'));
      const auto& wanted = deck_.output.fields;
      if (std::find(wanted.begin(), wanted.end(), of) != wanted.end()) piece.point_fields.push_back(std::move(*field));
    }
  }

 private:
  const model::Deck& deck_;
  std::optional<deck::LocalAxes> axes_;
  io::Field displacement_{"displacement_local", 3, {}}, stress_{"stress_local", 6, {}};
};

}  // namespace mortise
