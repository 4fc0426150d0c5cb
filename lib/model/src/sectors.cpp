#include "sectors.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "points.hpp"

namespace mortise::model {

namespace {

constexpr double off_axis = 1e-5;    // of coordinates
constexpr double rounded = 1e-12;    // coordinates that mean 0, in any unit of length
constexpr double along_axis = 1e-9;  // of a vector: its part across

bool is_across(const SectorAxis& axis, const Point& v)
{
  return axis.along.cross(v).norm() > along_axis * v.norm();
}

bool lies_along_a_coordinate(const SectorAxis& axis)
{
  return axis.along.cwiseAbs().maxCoeff() > 1 - along_axis;
}

std::string spell(const Point& x)
{
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]);
}

class Checks {
 public:
  Checks(const Deck& deck, const SectorAxis& axis, deck::Document& document) : deck_(deck), axis_(axis), document_(document) {}

  void run()
  {
    for (const auto& [name, coupling] : deck_.couplings)
      if (axis_.has(place(coupling.point)) && !lies_along_a_coordinate(axis_) &&
          (coupling.kind == "rigid" || is_prescribed(name)))
        document_.error(
            "couplings." + name + ".point",
            "on the axis of sectors a point moves along it and turns about it, as components of motions can say of x, "
            "y and z alone; turn the model until the axis is one of them");
    for (std::size_t i = 0; i < deck_.loads.size(); ++i) check_load(deck_.loads[i], fmt::format("loads[{}].", i));
    for (std::size_t i = 0; i < deck_.supports.size(); ++i) check_support(deck_.supports[i], fmt::format("supports[{}].", i));
  }

 private:
  void refuse(const std::string& path, const char* what)
  {
    document_.error(path,
                    fmt::format("the model is one of equal sectors about {} along {}: {} across that axis would turn with the "
                                "sectors, and all of them cancel; expected one along the axis, or the whole model",
                                spell(axis_.at), spell(axis_.along), what));
  }

  bool is_prescribed(const std::string& coupling) const
  {
    return std::ranges::any_of(deck_.supports, [&](const auto& support) { return support.coupling == coupling; });
  }

  bool on_axis(const std::string& coupling) const
  {
    const auto found = deck_.couplings.find(coupling);
    return found != deck_.couplings.end() && axis_.has(place(found->second.point));
  }

  bool any_on_axis(const std::vector<deck::Place>& points) const
  {
    return std::any_of(points.begin(), points.end(),
                       [&](const deck::Place& p) { return p.name.empty() && axis_.has(place(p.at)); });
  }

  void check_load(const fem::LoadOptions& load, const std::string& path)
  {
    if (load.acceleration && is_across(axis_, place(*load.acceleration))) refuse(path + "acceleration", "an acceleration");
    if (load.centrifugal && (is_across(axis_, place(load.centrifugal->axis)) || !axis_.has(place(load.centrifugal->point))))
      document_.error(path + "centrifugal", fmt::format("the model is one of equal sectors about {} along {}; expected that axis",
                                                        spell(axis_.at), spell(axis_.along)));
    if (!any_on_axis(load.points) && !on_axis(load.coupling)) return;
    const auto along_model = [&](const std::array<double, 3>& v) -> Point {
      const auto axes = deck_.axes.find(load.axes);
      if (axes == deck_.axes.end() || axes->second.axis) return place(v);
      return local_axes(deck_, load.axes).at(Point::Zero())->transpose() * place(v);
    };
    if (load.force && is_across(axis_, along_model(*load.force))) refuse(path + "force", "a force on it");
    if (load.moment && is_across(axis_, along_model(*load.moment))) refuse(path + "moment", "a moment at it");
  }

  void check_support(const constraint::SupportOptions& support, const std::string& path)
  {
    const bool at_point = support.axes.empty() && any_on_axis(support.points);
    if (!at_point && !on_axis(support.coupling)) return;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      if (!is_across(axis_, Point::Unit(c))) continue;
      const auto& moved = support.displacement[i];
      if (moved && !(moved->is_constant() && moved->constant() == 0))
        refuse(path + "displacement." + "xyz"[c], "a displacement of a point on it");
      if (support.rotation[i].value_or(0) != 0) refuse(path + "rotation." + "xyz"[c], "a turn of a point on it");
    }
  }

  const Deck& deck_;
  const SectorAxis& axis_;
  deck::Document& document_;
};

}  // namespace

bool SectorAxis::has(const Point& x) const
{
  return (x - foot(x)).norm() <= std::max(rounded, off_axis * (x.norm() + at.norm()));
}

std::optional<SectorAxis> sector_axis(const Deck& deck)
{
  for (const auto& contact : deck.contacts)
    if (contact.cyclic) return SectorAxis{place(contact.cyclic->center), place(contact.cyclic->axis).normalized()};
  return {};
}

void check_sectors(const Deck& deck, deck::Document& document)
{
  if (const auto axis = sector_axis(deck)) Checks(deck, *axis, document).run();
}

}  // namespace mortise::model
