#include "point_fields.hpp"

#include <utility>

namespace mortise::output {

// At one point.
struct PointFields::Values {
  const Eigen::Matrix3d& axes;
  const Point& displacement;
  const fem::Stress& stress;
};

struct PointFields::Kind {
  const char* name;
  const char* asked_by;  // its word in the deck's `output.fields`
  bool local;            // along the deck's `output.axes`
  int components;
  void (*put)(const Values& at, double* to);
};

// To add a field of displacements and stresses: a row here, and its word in io::Options.
const std::vector<PointFields::Kind>& PointFields::kinds()
{
  static const std::vector<Kind> all{
      {"displacement", "displacement", false, 3, [](const Values& at, double* to) { Eigen::Map<Point>{to} = at.displacement; }},
      {"von_mises", "von_mises", false, 1, [](const Values& at, double* to) { *to = fem::von_mises(at.stress); }},
      {"stress", "stress", false, 6, [](const Values& at, double* to) { Eigen::Map<fem::Stress>{to} = at.stress; }},
      {"principal_stress", "principal_stress", false, 3,
       [](const Values& at, double* to) { Eigen::Map<Point>{to} = fem::principal_stresses(at.stress); }},
      {"displacement_local", "displacement", true, 3,
       [](const Values& at, double* to) { Eigen::Map<Point>{to} = at.axes * at.displacement; }},
      {"stress_local", "stress", true, 6,
       [](const Values& at, double* to) { Eigen::Map<fem::Stress>{to} = fem::along(at.axes, at.stress); }}};
  return all;
}

PointFields::PointFields(const model::Deck& deck, std::size_t points)
{
  if (!deck.output.axes.empty()) axes_ = model::local_axes(deck, deck.output.axes);
  for (const auto& kind : kinds()) {
    if (!deck.output.has_field(kind.asked_by) || (kind.local && !axes_)) continue;
    kind_.push_back(&kind);
    fields_.push_back({kind.name, kind.components, std::vector<double>(points * static_cast<std::size_t>(kind.components))});
  }
}

void PointFields::set(std::size_t number, const Point& place, const Point& displacement, const fem::Stress& stress)
{
  const Eigen::Matrix3d axes = axes_ ? axes_->everywhere(place) : Eigen::Matrix3d::Identity();
  for (std::size_t f = 0; f < fields_.size(); ++f)
    kind_[f]->put({axes, displacement, stress}, &fields_[f].values[number * static_cast<std::size_t>(kind_[f]->components)]);
}

void PointFields::move_to(io::Piece& piece)
{
  for (auto& field : fields_) piece.point_fields.push_back(std::move(field));
}

}  // namespace mortise::output
