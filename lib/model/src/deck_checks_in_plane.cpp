// What plane and axisymmetric models have not: a third component, points that are rings, polar coordinates.
#include <fmt/format.h>

#include <cctype>

#include "deck_checks.hpp"

namespace mortise::model {

namespace {

void check_flat(const std::optional<std::array<double, 3>>& v, const std::string& path, deck::Document& document)
{
  if (v && (*v)[2] != 0) document.error(path, "a plane model has no z component");
}

void check_flat(const std::vector<deck::Place>& points, const std::string& path, deck::Document& document)
{
  for (std::size_t k = 0; k < points.size(); ++k) check_flat(points[k].at, fmt::format("{}points[{}]", path, k), document);
}

void check_plane_load(const Deck& deck, const fem::LoadOptions& load, const std::string& path, deck::Document& document)
{
  if (const auto& traction = load.traction; traction && !((*traction)[2].is_constant() && (*traction)[2].constant() == 0))
    document.error(path + "traction", "a plane model has no z component");
  if (const auto& turning = load.centrifugal) {
    const auto& axis = turning->axis;
    const auto& at = turning->point;
    if (deck.axisymmetric() ? axis[0] != 0 || axis[2] != 0 || at[0] != 0 || at[2] != 0 : axis[0] != 0 || axis[1] != 0)
      document.error(path + "centrifugal", deck.axisymmetric()
                                               ? "an axisymmetric body turns about its axis; expected axis: [0, 1, 0]"
                                               : "a plane model turns about z; expected axis: [0, 0, 1]");
  }
  check_flat(load.force, path + "force", document);
  check_flat(load.points, path, document);
  if (deck.axisymmetric() && !load.points.empty())
    document.error(path + "points", "in an axisymmetric model a point is a ring; load a boundary");
  check_flat(load.acceleration, path + "acceleration", document);
  if (const auto& moment = load.moment; moment && ((*moment)[0] != 0 || (*moment)[1] != 0))
    document.error(path + "moment", "in a plane model a moment turns about z alone; expected [0, 0, m]");
  if (deck.axisymmetric() && load.acceleration && (*load.acceleration)[0] != 0)
    document.error(path + "acceleration", "an axisymmetric body is accelerated along its axis, y, alone; expected 0 for x");
}

void check_plane_support(const Deck& deck, const constraint::SupportOptions& support, const std::string& path,
                         deck::Document& document)
{
  if (support.displacement[2])
    document.error(path + "displacement." + (support.cylindrical ? "axial" : "z"), "a plane model has no z component");
  check_flat(support.points, path, document);
  if (deck.axisymmetric() && !support.points.empty() && support.stiffness.any())
    document.error(path + "stiffness", "in an axisymmetric model a point is a ring; give a boundary a `stiffness`");
  if (support.stiffness.along[2]) document.error(path + "stiffness.z", "a plane model has no z component");
  for (const std::size_t c : {0, 1})
    if (support.rotation[c])
      document.error(path + fmt::format("rotation.{}", "xy"[c]), "in a plane model points turn about z alone");
}

void check_plane_output(const io::Options& output, deck::Document& document)
{
  const auto& interior = output.interior;
  for (std::size_t i = 0; i < interior.points.size(); ++i)
    check_flat(interior.points[i], fmt::format("output.interior.points[{}]", i), document);
  if (!interior.planes.empty()) document.error("output.interior.planes", "sections are for models of dimension 3");
  for (const auto& [name, probe] : output.probes) {
    check_flat(probe.point, "output.probes." + name + ".point", document);
    check_flat(probe.from, "output.probes." + name + ".from", document);
    check_flat(probe.to, "output.probes." + name + ".to", document);
  }
  check_flat(output.moments_about, "output.moments_about", document);
}

// Whether a formula has a variable of this name.
bool has_variable(const deck::Formula& formula, const std::string& name)
{
  const auto& text = formula.text();
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const bool begins = at == 0 || !is_of_word(text[at - 1]);
    const bool ends = at + name.size() == text.size() || !is_of_word(text[at + name.size()]);
    if (begins && ends) return true;
  }
  return false;
}

}  // namespace

void check_vectors(const Deck& deck, deck::Document& document)
{
  if (deck.dimension() == 3) {
    for (const auto& path : document.pairs()) document.error(path, "expected 3 entries, since `dimension` is 3, found 2");
    return;
  }
  for (std::size_t i = 0; i < deck.loads.size(); ++i)
    check_plane_load(deck, deck.loads[i], fmt::format("loads[{}].", i), document);
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    check_plane_support(deck, deck.supports[i], fmt::format("supports[{}].", i), document);
  for (const auto& [name, spring] : deck.springs) {
    check_flat(spring.points, "springs." + name + ".", document);
    if (deck.axisymmetric())
      document.error("springs." + name, "in an axisymmetric model a point is a ring; give a boundary a `stiffness`");
  }
  check_plane_output(deck.output, document);
}

// r and theta are polar coordinates of x and y, which are the radius and the axis there.
void check_formulas_of_rings(const Deck& deck, deck::Document& document)
{
  if (!deck.axisymmetric()) return;
  const auto check = [&](const std::vector<deck::Formula>& formulas, const std::string& path) {
    for (const auto& formula : formulas)
      for (const char* name : {"r", "theta"})
        if (has_variable(formula, name))
          document.error(path, fmt::format("\"{}\": in an axisymmetric model the radius is x and the axis is y; write x for r",
                                           formula.text()));
  };
  for (std::size_t i = 0; i < deck.loads.size(); ++i) {
    std::vector<deck::Formula> formulas;
    if (deck.loads[i].pressure) formulas.push_back(*deck.loads[i].pressure);
    if (const auto& traction = deck.loads[i].traction) formulas.insert(formulas.end(), traction->begin(), traction->end());
    if (deck.loads[i].temperature_change) formulas.push_back(deck.loads[i].temperature_change->formula);
    check(formulas, fmt::format("loads[{}]", i));
  }
  for (std::size_t i = 0; i < deck.supports.size(); ++i) {
    std::vector<deck::Formula> formulas;
    for (const auto& value : deck.supports[i].displacement)
      if (value) formulas.push_back(*value);
    if (deck.supports[i].normal) formulas.push_back(*deck.supports[i].normal);
    check(formulas, fmt::format("supports[{}]", i));
  }
}

}  // namespace mortise::model
