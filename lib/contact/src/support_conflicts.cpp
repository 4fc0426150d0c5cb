#include "support_conflicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"

namespace mortise::contact {

namespace {

[[noreturn]] void refuse_tear(const Options& options, double tear)
{
  throw Error(
      ExitStatus::bad_input,
      fmt::format("contact {}: supports hold both sides, \"{}\" and \"{}\", and move them {:.3g} apart, which the bond does "
                  "not let them; change one of the supports",
                  options.name, options.secondary, options.primary, tear));
}

[[noreturn]] void refuse_crossing(const Options& options, double crossing)
{
  const auto what =
      options.obstacle
          ? fmt::format("supports hold \"{}\" {:.3g} inside the {}; change the supports or the obstacle", options.secondary,
                        crossing, shape_name(*options.obstacle))
          : fmt::format(
                "supports hold both sides, \"{}\" and \"{}\", and push them {:.3g} into each other; change one of the supports",
                options.secondary, options.primary, crossing);
  throw Error(ExitStatus::bad_input, fmt::format("contact \"{}\": {}", options.name, what));
}

}  // namespace

// At the border of a side supports may move it along a curved surface, which normals of the meshes see as a little of a crossing,
// and what overlaps in the mesh has its own warning.
void SupportConflicts::note_crossing(std::span<const Term> terms, double d, const Point& normal, double gap,
                                     const Directions& held, bool stranded)
{
  constexpr double along = 0.1;  // of the motion: that of what slides along a coarse mesh
  const double into = writer_.prescribed_part(terms, d, normal);
  if (stranded) {
    crossing_ = std::max(crossing_, into - gap);
    return;
  }
  double square = into * into;
  for (const auto& tangent : held.tangents) square += std::pow(writer_.prescribed_part(terms, d, tangent), 2);
  if (into > along * std::sqrt(square)) crossing_ = std::max(crossing_, into - std::max(gap, 0.0));
}

void SupportConflicts::note_tear(std::span<const Term> terms, double d, const Point& normal)
{
  const auto note = [&](const Point& direction) {
    if (!writer_.moves(terms, d, direction)) tear_ = std::max(tear_, std::abs(writer_.prescribed_part(terms, d, direction)));
  };
  note(normal);
  for (const auto& tangent : directions(normal, {false, false, false}, {}, dimension_).tangents) note(tangent);
}

// A node of the secondary side, and what it meets.
std::vector<Term> SupportConflicts::terms_of(Local node, const Opposite& opposite) const
{
  const auto nodes = primary_.faces[static_cast<std::size_t>(primary_.face_of[opposite.facet])];
  const FaceShape shape = primary_.shape_in_face(opposite.facet, opposite.hit.shape, opposite.hit.frame, Plane::Zero());
  std::vector<Term> terms{{node, false, 1}};
  for (std::size_t j = 0; j < nodes.size(); ++j)
    if (const double part = shape[static_cast<Eigen::Index>(j)]; std::abs(part) > 1e-9) terms.push_back({nodes[j], true, -part});
  return terms;
}

void SupportConflicts::note_held_crossing(Local node, const Point& normal, const Opposite& opposite, const Directions& directions)
{
  if (!std::isfinite(opposite.gap)) return;
  auto terms = terms_of(node, opposite);  // and of the primary side only the nodes that are held, which move alike
  std::erase_if(terms,
                [&](const Term& term) { return term.on_primary && writer_.freedom(std::span(&term, 1), true, normal) > 0.5; });
  double sum = 0;
  for (const auto& term : terms) sum += term.on_primary ? term.value : 0;
  if (sum == 0) return;
  for (auto& term : terms)
    if (term.on_primary) term.value /= -sum;
  constexpr double alike = 0.15;  // of the motion: meshes that do not match have the same curved one to their own error
  const double own = writer_.prescribed_part(std::span(terms).first(1), 1, normal),
               other = writer_.prescribed_part(std::span(terms).subspan(1), 1, normal);
  if (std::abs(own + other) <= alike * std::max(std::abs(own), std::abs(other))) return;
  note_crossing(terms, 1, normal, opposite.gap, directions, false);
}

// What supports say of normals of meshes may differ a little.
void SupportConflicts::note_held_tear(Local node, const Point& normal, const Opposite& opposite)
{
  constexpr double of_normals = 1e-3;
  if (!std::isfinite(opposite.gap)) return;
  const auto terms = terms_of(node, opposite);
  const auto note = [&](const Point& direction) {
    if (writer_.moves(terms, 1, direction)) return;
    const double own = writer_.prescribed_part(std::span(terms).first(1), 1, direction),
                 other = writer_.prescribed_part(std::span(terms).subspan(1), 1, direction);
    if (std::abs(own + other) > of_normals * std::max(std::abs(own), std::abs(other)))
      tear_ = std::max(tear_, std::abs(own + other));
  };
  note(normal);
  for (const auto& tangent : directions(normal, {false, false, false}, {}, dimension_).tangents) note(tangent);
}

void SupportConflicts::refuse(const Options& options, double reach, const Communicator& comm) const
{
  if (const double crossing = comm.max(crossing_); crossing > 1e-9 * reach) refuse_crossing(options, crossing);
  if (const double tear = comm.max(tear_); tear > 1e-9 * reach) refuse_tear(options, tear);
}

}  // namespace mortise::contact
