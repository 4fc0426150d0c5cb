#include "rows/rows.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

constexpr double negligible_coefficient = 1e-12;  // of a coefficient
constexpr double prescribed_but_for = 0.1;        // of what all terms together could move: that much is no slip
constexpr double least_prescribed = 0.1;          // of a side, to bear what rubs there

}  // namespace

const std::vector<RowWriter::Coefficient>& RowWriter::coefficients(std::span<const Term> terms, double d, const Point& axis)
{
  coefficients_.clear();
  append_coefficients(terms, d, axis);
  if (rotation_) merge();
  return coefficients_;
}

void merge_terms(std::vector<Term>& terms)
{
  std::stable_sort(terms.begin(), terms.end(),
                   [](const Term& a, const Term& b) { return std::tie(a.on_primary, a.node) < std::tie(b.on_primary, b.node); });
  std::size_t end = 0;
  for (const auto& term : terms) {
    if (end > 0 && terms[end - 1].on_primary == term.on_primary && terms[end - 1].node == term.node)
      terms[end - 1].value += term.value;
    else
      terms[end++] = term;
  }
  terms.resize(end);
}

void RowWriter::append_coefficients(std::span<const Term> terms, double d, const Point& axis)
{
  for (const auto& term : terms) {
    if (!(std::abs(term.value) > negligible_coefficient * d)) continue;
    const Global node = node_of(term);
    const auto& supports = term.on_primary ? primary_supports_ : supports_;
    Point rest = axis_of(term, axis);
    // What skew supports leave of the axis; parts that are rounding are 0.
    if (const auto skew_supports = supports.skew_supports(node); !skew_supports.empty()) {
      const Point whole = rest;
      for (const auto& i : skew_supports) rest -= whole.dot(along(i)) * along(i);
      rest = (rest.array().abs() < 1e-9).select(0.0, rest);
    }
    for (int c = 0; c < dimension_; ++c)
      if (std::abs(rest[c]) > 1e-14) coefficients_.push_back({node, c, term.value / d * rest[c], supports.find(node, c)});
  }
}

// Nodes on the axis of a cyclic pair are on both of its sides; those of a couple have coefficients already.
void RowWriter::merge()
{
  std::stable_sort(coefficients_.begin(), coefficients_.end(), [](const Coefficient& a, const Coefficient& b) {
    return std::tie(a.node, a.component) < std::tie(b.node, b.component);
  });
  std::size_t end = 0;
  for (const auto& c : coefficients_) {
    if (end > 0 && coefficients_[end - 1].node == c.node && coefficients_[end - 1].component == c.component)
      coefficients_[end - 1].value += c.value;
    else
      coefficients_[end++] = c;
  }
  coefficients_.resize(end);
  std::erase_if(coefficients_, [](const Coefficient& c) { return std::abs(c.value) < negligible_coefficient; });
}

Few<Point, 3> directions_of_most(const Eigen::Matrix3d& part, std::span<const Point> among, double least)
{
  Eigen::Matrix3d within = Eigen::Matrix3d::Zero();  // among = columns of A: A A' part A A'
  for (const Point& a : among)
    for (const Point& b : among) within += a.dot(part * b) * a * b.transpose();
  const auto found = dense::space_eigenpairs(within);
  Few<Point, 3> result;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (found.values[k] > least) result.push_back(found.vectors.col(k));
  return result;
}

bool RowWriter::moves(std::span<const Term> terms, double d, const Point& axis)
{
  if (!terms.empty() && !rotation_) {  // mostly the first term says it
    if (const auto& first = coefficients(terms.first(1), d, axis);
        !first.empty() && !first[0].prescribed && std::abs(first[0].value) > nothing_moves)
      return true;
  }
  return part_that_moves(terms, d, axis) > nothing_moves;
}

double RowWriter::part_that_moves(std::span<const Term> terms, double d, const Point& axis)
{
  double all = 0, free = 0;
  for (const auto& term : terms) all += term.value / d * (term.value / d);
  for (const auto& c : coefficients(terms, d, axis))
    if (!c.prescribed) free += c.value * c.value;
  return std::sqrt(free / all);
}

double RowWriter::freedom(std::span<const Term> terms, bool on_primary, const Point& axis) const
{
  double free = 0, all = 0;
  for (const auto& term : terms) {
    if (term.on_primary != on_primary) continue;
    const auto& supports = on_primary ? primary_supports_ : supports_;
    if (!one_node(term)) free += term.value * supports.freedom(node_of(term), axis_of(term, axis), dimension_);
    all += term.value;
  }
  return all != 0 ? free / all : 1;
}

Eigen::Matrix3d RowWriter::free_part(const Term& term) const
{
  Eigen::Matrix3d result = (term.on_primary ? primary_supports_ : supports_).free_part(node_of(term), dimension_);
  if (rotation_ && term.on_primary) result = (rotation_->rotation * result * rotation_->rotation.transpose()).eval();
  return result;
}

Few<Point, 2> RowWriter::across_axis(Local node, const Point& normal, std::span<const Point> tangents) const
{
  constexpr double along_it = 1 - 1e-6;  // cosine
  Few<Point, 2> result;
  const bool on_axis = rotation_ && dimension_ == 3 && on_both_sides(node);
  const Point axis = on_axis ? Point(Eigen::AngleAxisd(rotation_->rotation).axis()) : Point::Zero();
  if (on_axis && tangents.size() == 2) return {normal.cross(axis).normalized()};
  for (const auto& tangent : tangents)
    if (std::abs(tangent.dot(axis)) < along_it) result.push_back(tangent);
  return result;
}

Eigen::Matrix3d RowWriter::mobility(std::span<const Term> terms, bool secondary_alone) const
{
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  double all = 0;
  for (const auto& term : terms) {
    if (secondary_alone && term.on_primary) continue;
    result += term.value * term.value * free_part(term);
    all += term.value * term.value;
  }
  return all > 0 ? Eigen::Matrix3d(result / all) : result;
}

Few<Point, 3> RowWriter::prescribed_on_secondary(std::span<const Term> terms) const
{
  constexpr double nothing = 0.01;  // of squares: a tenth of a coefficient, as nodes beside may have
  Eigen::Matrix3d freedom = mobility(terms, true);
  if (dimension_ == 2) freedom(2, 2) = 1;
  const auto moves = dense::space_eigenpairs(freedom);
  Few<Point, 3> result;
  for (Eigen::Index k = 0; k < 3 && moves.values[k] <= nothing; ++k) result.push_back(moves.vectors.col(k));
  return result;
}

Few<Point, 3> RowWriter::free_on_primary(std::span<const Term> terms, std::span<const Point> among, double least) const
{
  Eigen::Matrix3d freedom = Eigen::Matrix3d::Zero();
  double all = 0;
  for (const auto& term : terms) {
    if (!term.on_primary) continue;
    if (!one_node(term)) freedom += term.value * free_part(term);
    all += term.value;
  }
  return all != 0 ? directions_of_most(freedom / all, among, least) : Few<Point, 3>();
}

void RowWriter::leave_what_moves(std::span<const Term> terms, const Point& normal, std::vector<Point>& tangents)
{
  if (tangents.empty()) return;
  Eigen::Matrix3d product = mobility(terms);
  const Point felt = product * normal;
  product -= felt * felt.transpose() / felt.dot(normal);
  constexpr double least = prescribed_but_for * prescribed_but_for;
  if (tangents.size() == 1) {
    if (tangents[0].dot(product * tangents[0]) < least) tangents.clear();
    return;
  }
  Eigen::Matrix<double, 3, 2> plane;
  plane << tangents[0], tangents[1];
  const auto moves = dense::plane_eigenpairs(plane.transpose() * product * plane);
  if (moves.values[0] >= least) return;
  tangents.clear();
  if (moves.values[1] >= least) tangents.emplace_back(plane * moves.vectors.col(1));
}

std::optional<Point> RowWriter::motion_at_prescribed_nodes(std::span<const Term> terms, bool on_primary, const Point& axis,
                                                           double alike) const
{
  constexpr double nothing = 1e-6;
  std::optional<Point> moves;
  for (const auto& term : terms) {
    if (term.on_primary != on_primary) continue;
    const Point free = free_part(term) * axis;
    if (free.dot(axis) > 1 - nothing) continue;
    if (moves && (free - *moves).norm() > alike) return {};
    moves = free;
  }
  return moves;
}

double RowWriter::part_at_prescribed_nodes(std::span<const Term> terms, bool on_primary, const Point& axis) const
{
  constexpr double nothing = 1e-6;
  double prescribed = 0, all = 0;
  for (const auto& term : terms) {
    if (term.on_primary != on_primary) continue;
    const auto& supports = on_primary ? primary_supports_ : supports_;
    if (supports.freedom(node_of(term), axis_of(term, axis), dimension_) < 1 - nothing) prescribed += term.value;
    all += term.value;
  }
  return all != 0 ? prescribed / all : 1;
}

std::optional<RowWriter::Prescribed> RowWriter::prescribed_on_both_sides(std::span<const Term> terms, const Point& normal,
                                                                         const Point& tangent) const
{
  constexpr double nothing = 1e-12, least_askew = 1e-3;
  const double part = std::min(part_at_prescribed_nodes(terms, false, tangent), part_at_prescribed_nodes(terms, true, tangent));
  if (!(part > least_prescribed)) return {};
  const auto secondary = motion_at_prescribed_nodes(terms, false, tangent, least_askew),
             primary = motion_at_prescribed_nodes(terms, true, tangent, least_askew);
  const bool alike = secondary && primary && (*secondary - *primary).norm() < least_askew;
  if (!secondary || !primary || alike) return Prescribed{tangent, false};
  if (askew_part(terms, normal, tangent) > least_askew) return Prescribed{tangent, true};
  const Point moves = mobility(terms) * normal;
  if (moves.squaredNorm() < nothing) return Prescribed{tangent, false};
  return Prescribed{Point(tangent - moves * (moves.dot(tangent) / moves.squaredNorm())).normalized(), false};
}

double RowWriter::askew_part(std::span<const Term> terms, const Point& normal, const Point& axis) const
{
  constexpr double nothing = 1e-6;
  double all = 0, askew = 0, alike = 0, felt = 0;
  for (const auto& term : terms) {
    const double square = term.value * term.value;
    const Eigen::Matrix3d free = free_part(term);
    const double moves = axis.dot(free * axis);
    all += square;
    felt += square * normal.dot(free * normal);
    if (moves > 1 - nothing) continue;
    askew += square * moves;
    alike += square * axis.dot(free * normal);
  }
  const double rest = felt > 0 ? askew - alike * alike / felt : askew;
  return all > 0 ? std::sqrt(std::max(rest, 0.0) / all) : 0;
}

double RowWriter::prescribed_part(std::span<const Term> terms, double d, const Point& axis)
{
  double sum = 0;
  for (const auto& term : terms)
    for (const auto& i : skew_supports_of(term)) sum += term.value / d * axis_of(term, axis).dot(along(i)) * i.value;
  for (const auto& c : coefficients(terms, d, axis))
    if (c.prescribed) sum += c.value * c.prescribed->value;
  return sum;
}

void RowWriter::take_skew_supports(std::span<const Term> terms, double d, const Point& axis, double& bound,
                                   constraint::Contacts& contacts)
{
  const auto row = contacts.rows.size();
  for (const auto& term : terms)
    for (const auto& i : skew_supports_of(term)) {
      const double coefficient = term.value / d * axis_of(term, axis).dot(along(i));
      bound -= coefficient * i.value;
      for (const auto& share : std::span(i.shares).first(static_cast<std::size_t>(i.share_count)))
        for (int c = 0; c < dimension_; ++c)
          if (const double part = coefficient * share.part[static_cast<std::size_t>(c)]; part != 0)
            contacts.prescribed.push_back({row, c, share.support, part, i.at});
    }
}

constraint::PrescribedEntry RowWriter::entry_of(std::size_t row, const Coefficient& c)
{
  const auto& prescribed = *c.prescribed;
  return {row, c.component, prescribed.support, c.value, prescribed.at, prescribed.coupling, prescribed.arm};
}

void RowWriter::add(std::span<const Term> terms, double d, const Point& axis, double bound, constraint::Contacts& contacts,
                    std::span<const Couple> couples)
{
  const auto row = contacts.rows.size();
  take_skew_supports(terms, d, axis, bound, contacts);
  for (const auto& couple : couples) take_skew_supports(couple.terms, 1, couple.axis, bound, contacts);
  coefficients(terms, d, axis);
  for (const auto& couple : couples) append_coefficients(couple.terms, 1, couple.axis);
  if (std::ranges::any_of(couples, [](const Couple& couple) { return !couple.terms.empty(); })) merge();
  for (const auto& c : coefficients_) {
    if (c.prescribed) {
      bound -= c.value * c.prescribed->value;
      contacts.prescribed.push_back(entry_of(row, c));
    } else {
      contacts.rows.entries.push_back({c.node, c.component, c.value});
    }
  }
  contacts.rows.close(bound);
}

void RowWriter::add_prescribed(std::span<const Term> terms, double d, const Point& axis, constraint::Contacts& contacts)
{
  const auto row = contacts.rows.size();
  double bound = 0;
  const std::array<double, 2> part{part_at_prescribed_nodes(terms, false, axis), part_at_prescribed_nodes(terms, true, axis)};
  std::vector<Term> all(terms.begin(), terms.end());
  for (auto& term : all) term.value /= part[term.on_primary ? 1 : 0];
  take_skew_supports(all, d, axis, bound, contacts);
  for (const auto& c : coefficients(all, d, axis)) {
    if (!c.prescribed) continue;
    bound -= c.value * c.prescribed->value;
    contacts.prescribed.push_back(entry_of(row, c));
  }
  contacts.rows.close(bound);
}

}  // namespace mortise::contact
