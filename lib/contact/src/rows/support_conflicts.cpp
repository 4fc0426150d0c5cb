#include "rows/support_conflicts.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/dense.hpp"
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

// A node that supports hold along a direction: where it is, and how far they move it.
struct PrescribedNode {
  Point at;
  double value;
};

// From what values near a place differ from a linear field: the second derivative of a quadratic one. None if there are no more
// values than a linear field takes.
std::optional<double> second_derivative(const std::vector<PrescribedNode>& near)
{
  constexpr double independent = 1e-4, of_three = 3;  // three in a row are off by a third of their second difference
  const auto count = static_cast<Eigen::Index>(near.size());
  if (count < 3) return {};
  Point centre = Point::Zero();
  double mean = 0, reach = 0;
  for (const auto& node : near) centre += node.at / static_cast<double>(count), mean += node.value / static_cast<double>(count);
  Eigen::MatrixXd places(count, 3);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& node = near[static_cast<std::size_t>(i)];
    places.row(i) = (node.at - centre).transpose();
    values[i] = node.value - mean;
    reach = std::max(reach, (node.at - centre).norm());
  }
  const auto fit = dense::minimum_norm(places, values, independent);
  if (count <= fit.rank + 1) return {};
  return of_three * (values - places * fit.x.col(0)).lpNorm<Eigen::Infinity>() / (reach * reach);
}

std::vector<std::vector<Local>> faces_round_nodes(const Side& side)
{
  std::vector<std::vector<Local>> result(side.points.size());
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    for (const Local n : side.faces[f]) result[static_cast<std::size_t>(n)].push_back(static_cast<Local>(f));
  return result;
}

}  // namespace

std::optional<double> SupportConflicts::bend(const std::set<Local>& nodes, bool on_primary, const Point& direction)
{
  const Side& side = on_primary ? primary_ : secondary_;
  std::optional<double> result;
  std::vector<PrescribedNode> prescribed;
  for (const Local middle : nodes) {
    prescribed.clear();
    for (const Local n : nodes_round(middle, on_primary)) {
      const Term alone{n, on_primary, 1};
      if (!writer_.moves(std::span(&alone, 1), 1, direction))
        prescribed.push_back(
            {side.points[static_cast<std::size_t>(n)], writer_.prescribed_part(std::span(&alone, 1), 1, direction)});
    }
    if (const auto found = second_derivative(prescribed)) result = std::max(result.value_or(0), *found);
  }
  return result;
}

std::set<Local> SupportConflicts::nodes_round(Local node, bool on_primary)
{
  const Side& side = on_primary ? primary_ : secondary_;
  auto& faces = faces_round_[on_primary];
  if (faces.empty()) faces = faces_round_nodes(side);
  std::set<Local> result;
  for (const Local f : faces[static_cast<std::size_t>(node)])
    for (const Local n : side.faces[static_cast<std::size_t>(f)]) result.insert(n);
  return result;
}

// Of a row that linear fields fulfil, a quadratic one makes half its second derivative times sum_k value_k (x_k - x)^2. Of two
// sides that are moved alike both tell that derivative; of two that are not, the one that is moved more evenly. Where one has a
// single face there, anything that the other one has along it may be the motion of both.
double SupportConflicts::of_interpolation(std::span<const Term> terms, double d, const Point& direction)
{
  constexpr double margin = 6;
  Point at = Point::Zero();
  double weight = 0, square = 0;
  for (const auto& term : terms) {
    if (term.on_primary) continue;
    at += term.value * secondary_.points[static_cast<std::size_t>(term.node)];
    weight += term.value;
  }
  if (weight == 0) return 0;
  at /= weight;
  std::array<std::set<Local>, 2> near;
  std::array<std::optional<double>, 2> second;
  for (const auto& term : terms) {
    const Side& side = term.on_primary ? primary_ : secondary_;
    square += std::abs(term.value) / d * (side.points[static_cast<std::size_t>(term.node)] - at).squaredNorm();
    near[term.on_primary].merge(nodes_round(term.node, term.on_primary));
  }
  for (const bool primary : {false, true}) second[primary] = bend(near[primary], primary, direction);
  for (const bool primary : {false, true}) {
    if (second[!primary]) continue;
    for (std::size_t n = 0; n < (primary ? primary_ : secondary_).points.size(); ++n) near[primary].insert(static_cast<Local>(n));
    second[primary] = bend(near[primary], primary, direction);
  }
  if (!second[0] && !second[1]) return 0;
  return margin * 0.5 * square * std::min(second[0] ? *second[0] : *second[1], second[1] ? *second[1] : *second[0]);
}

// At the border of a side supports may move it along a curved surface, which normals of the meshes see as a little of a crossing,
// and what overlaps in the mesh has its own warning.
void SupportConflicts::note_crossing(std::span<const Term> terms, double d, const Point& normal, double gap,
                                     const Directions& directions, bool stranded)
{
  constexpr double along = 0.1;  // of the motion: that of what slides along a coarse mesh
  const double into = writer_.prescribed_part(terms, d, normal);
  double square = into * into;
  for (const auto& tangent : directions.tangents) square += std::pow(writer_.prescribed_part(terms, d, tangent), 2);
  if (!stranded && !(into > along * std::sqrt(square))) return;
  const double crossing = into - (stranded ? gap : std::max(gap, 0.0));
  if (crossing > found_.crossing && crossing > of_interpolation(terms, d, normal)) found_.crossing = crossing;
}

// How far supports move the nodes of these terms, the most along any axis.
double SupportConflicts::motion(std::span<const Term> terms, double d)
{
  double result = 0;
  for (int c = 0; c < dimension_; ++c) result = std::max(result, std::abs(writer_.prescribed_part(terms, d, Point::Unit(c))));
  return result;
}

void SupportConflicts::note_tear(std::span<const Term> terms, double d, const Point& normal)
{
  const auto note = [&](const Point& direction) {
    if (writer_.moves(terms, d, direction)) return;
    const auto own = terms.first(static_cast<std::size_t>(std::ranges::find(terms, true, &Term::on_primary) - terms.begin()));
    const double tear = std::abs(writer_.prescribed_part(terms, d, direction));
    // What hardly moves may be a node that is free, whose part is missing in the sum.
    if (tear > found_.tear && tear > nothing_moves * motion(own, d) && tear > of_interpolation(terms, d, direction))
      found_.tear = tear;
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

void SupportConflicts::note_prescribed_crossing(Local node, const Point& normal, const Opposite& opposite,
                                                const Directions& directions)
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
void SupportConflicts::note_prescribed_tear(Local node, const Point& normal, const Opposite& opposite)
{
  constexpr double of_normals = 1e-3;
  if (!std::isfinite(opposite.gap)) return;
  const auto terms = terms_of(node, opposite);
  const auto note = [&](const Point& direction) {
    if (writer_.moves(terms, 1, direction)) return;
    const double own = writer_.prescribed_part(std::span(terms).first(1), 1, direction),
                 other = writer_.prescribed_part(std::span(terms).subspan(1), 1, direction);
    const double tear = std::abs(own + other);
    if (tear > found_.tear && tear > of_normals * std::max(std::abs(own), std::abs(other)) &&
        tear > nothing_moves * motion(std::span(terms).first(1), 1) && tear > of_interpolation(terms, 1, direction))
      found_.tear = tear;
  };
  note(normal);
  for (const auto& tangent : directions(normal, {false, false, false}, {}, dimension_).tangents) note(tangent);
}

void Conflicts::refuse(const Options& options, double reach, const Communicator& comm) const
{
  if (const double most = comm.max(crossing); most > 1e-9 * reach) refuse_crossing(options, most);
  if (const double most = comm.max(tear); most > 1e-9 * reach) refuse_tear(options, most);
}

}  // namespace mortise::contact
