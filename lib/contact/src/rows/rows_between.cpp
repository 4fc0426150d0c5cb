#include "rows/rows_between.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/dense.hpp"
#include "rows/by_node.hpp"
#include "rows/moments.hpp"
#include "rows/rows.hpp"

namespace mortise::contact {

namespace {

constexpr double one_normal = 0.75;    // cosine: rows on the other side of a kink say nothing here
constexpr double largest_weights = 2;  // the sum of their sizes: more is an extrapolation
constexpr double least_weight = 1e-9;  // less is none
// A node's row means the field at its place, also where that was moved, if this part of its surroundings is covered, and if it
// stands in for no others to speak of.
constexpr double least_cover_of_node = 0.9, of_weight = 1e-3;

// The nodes of this rank that places of others ask for, ascending. Collective.
std::vector<Global> asked_for(std::span<const ContactPoint> places, const std::vector<Global>& own, const Communicator& comm)
{
  struct Asked {
    Global node;
  };
  std::vector<Asked> wanted;
  for (const auto& place : places)
    for (const Global node : place.round) wanted.push_back({node});
  std::vector<Global> result;
  for (const auto& asked : answer(by_node<Asked>(wanted, comm), ask(own, comm), comm)) result.push_back(asked.node);
  result.erase(std::ranges::unique(result).begin(), result.end());
  return result;
}

// Polynomials of second order at points, in rows, those of first order first.
Eigen::MatrixXd polynomials_at(const Eigen::Matrix2Xd& x, int dimension)
{
  const auto s = x.row(0).array(), t = x.row(1).array();
  const bool plane = dimension == 3;
  Eigen::MatrixXd p(plane ? 6 : 3, x.cols());
  Eigen::Index row = 0;
  p.row(row++).setOnes();
  p.row(row++) = s;
  if (plane) p.row(row++) = t;
  p.row(row++) = s * s;
  if (plane) p.row(row++) = s * t;
  if (plane) p.row(row++) = t * t;
  return p;
}

// S such that x' S^-1 x = 1 is an ellipse as large as the facet, within a square one the circle with its edge as radius; `axes`:
// of the plane, of a line the second is 0.
Eigen::Matrix2d size_of_facet(std::span<const Point> corners, const Eigen::Matrix<double, 3, 2>& axes)
{
  const double part = 1.0 / static_cast<double>(corners.size());
  Point centre = Point::Zero();
  for (const auto& x : corners) centre += part * x;
  Eigen::Matrix2d result = Eigen::Matrix2d::Zero();
  for (const auto& x : corners) {
    const Eigen::Vector2d d = axes.transpose() * (x - centre);
    result += 4 * part * d * d.transpose();
  }
  if (axes.col(1).isZero(0)) result(1, 1) = 1;
  return result;
}

// The nodes of one side that terms speak of.
template <class Terms>
Side nodes_of(const Terms& terms, bool on_primary, fem::Kinematics kinematics)
{
  std::vector<std::pair<Global, Point>> nodes;
  for (const auto& term : terms)
    if (term.on_primary == on_primary) nodes.emplace_back(term.of, unpacked(term.x));
  std::ranges::sort(nodes, {}, [](const auto& node) { return node.first; });
  nodes.erase(std::ranges::unique(nodes, {}, [](const auto& node) { return node.first; }).begin(), nodes.end());
  Side side;
  side.kinematics = kinematics;
  for (const auto& [id, x] : nodes) {
    side.node_id.push_back(id);
    side.points.push_back(x);
  }
  return side;
}

}  // namespace

Eigen::VectorXd weights_between(const Eigen::Matrix2Xd& x, int dimension)
{
  constexpr double exact = 1e-6, nearly = 1e-3;
  const Eigen::VectorXd nearness = (-0.5 * x.colwise().squaredNorm().array()).exp();
  const Eigen::MatrixXd p = polynomials_at(x, dimension);
  const Eigen::Index n = x.cols(), linear = dimension, all = p.rows();
  // Where nodes do not tell those of second order apart, what is left of them is small beside the weights.
  for (const double left : {0.0, nearly}) {
    Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(all, n + all - linear);
    conditions.leftCols(n) = p * nearness.asDiagonal();
    conditions.bottomRightCorner(all - linear, all - linear).diagonal().setConstant(left);
    const Eigen::VectorXd found = dense::minimum_norm(conditions, Eigen::VectorXd::Unit(all, 0)).col(0);
    const Eigen::VectorXd w = nearness.cwiseProduct(found.head(n));
    const Eigen::VectorXd sums = p * w - Eigen::VectorXd::Unit(all, 0);
    if (sums.head(left == 0 ? all : linear).lpNorm<Eigen::Infinity>() < exact && w.lpNorm<1>() < largest_weights) return w;
  }
  return {};
}

RowsBetween::RowsBetween(std::vector<ContactPoint> places, const Side& secondary, const std::vector<char>& own,
                         const Communicator& comm)
    : places_(std::move(places)), comm_(comm), any_(comm.any(!places_.empty()))
{
  if (!any_) return;
  std::vector<Global> mine;
  for (std::size_t n = 0; n < own.size(); ++n)
    if (own[n]) mine.push_back(secondary.node_id[n]);
  asked_ = asked_for(places_, mine, comm);
}

void RowsBetween::note(const constraint::ContactNode& node, bool means_field, std::span<const Term> terms, double d,
                       const Side& secondary, const Side& primary)
{
  if (!std::ranges::binary_search(asked_, node.node)) return;
  const auto number = static_cast<int>(std::ranges::count(nodes_, node.node, &Neighbour::node));
  nodes_.push_back({node.node, number, means_field, node.weight, node.area, node.cover, packed(node.normal), packed(node.at)});
  for (const auto& term : terms) {
    const Side& side = term.on_primary ? primary : secondary;
    const auto at = static_cast<std::size_t>(term.node);
    terms_.push_back({node.node, number, term.on_primary, side.node_id[at], term.value / d, packed(side.points[at])});
  }
}

// Those at these nodes that look the way of a normal.
std::vector<const RowsBetween::Neighbour*> RowsBetween::at(std::span<const Global> nodes, const Point& normal) const
{
  std::vector<const Neighbour*> result;
  for (const Global node : nodes)
    for (const auto& known : std::ranges::equal_range(nodes_, node, {}, &Neighbour::node))
      if (unpacked(known.normal).dot(normal) > one_normal) result.push_back(&known);
  return result;
}

// What is left between w and the shape functions of the facet sees the surface curve. It counts a little more, so that the row of
// a place is clearly closed and not pressed where the nodes round it touch; how far bodies approach as a whole stays exact.
void RowsBetween::curve_more(const ContactPoint& place, std::span<const Neighbour* const> nodes, Eigen::VectorXd& w)
{
  constexpr double more = 0.2;
  Eigen::VectorXd flat = Eigen::VectorXd::Zero(w.size());
  for (std::size_t c = 0; c < place.corners.size(); ++c) {
    const auto corner = std::ranges::find(nodes, place.corners[c], &Neighbour::node);
    if (corner == nodes.end()) return;
    flat[corner - nodes.begin()] = place.where.shape[static_cast<Eigen::Index>(c)];
  }
  w += more * (w - flat);
}

// Those round a place, and their weights in its row: of nodes that are covered and have no control values, which alone
// say what is at their places; if they are too few, of the corners of its facet, as its shape functions are.
RowsBetween::Weighted RowsBetween::round(const ContactPoint& place, int dimension) const
{
  Weighted result;
  const auto candidates = at(place.round, place.normal);
  std::vector<const Neighbour*> whole;
  for (const auto* node : candidates)
    if (node->means_field && node->cover > least_cover_of_node && std::abs(node->weight - 1) < of_weight) whole.push_back(node);
  const bool on_border = !place.edge.isZero(0);
  auto axes = tangent_plane(place.normal, dimension);
  if (on_border) axes << place.edge, Point::Zero();
  Eigen::Matrix2Xd x(2, static_cast<Eigen::Index>(whole.size()));
  for (std::size_t i = 0; i < whole.size(); ++i)
    x.col(static_cast<Eigen::Index>(i)) = axes.transpose() * (unpacked(whole[i]->at) - place.at);
  x = size_of_facet(place.facet, axes).llt().matrixL().solve(x);
  Eigen::VectorXd w = whole.empty() ? Eigen::VectorXd() : weights_between(x, on_border ? 2 : dimension);
  if (w.size() > 0) curve_more(place, whole, w);
  for (Eigen::Index i = 0; i < w.size(); ++i)
    if (std::abs(w[i]) > least_weight) result.emplace_back(whole[static_cast<std::size_t>(i)], w[i]);
  if (result.empty())
    for (const auto* node : candidates)
      if (const auto corner = std::ranges::find(place.corners, node->node); corner != place.corners.end())
        result.emplace_back(node, std::max(place.where.shape[corner - place.corners.begin()], 0.0));
  double sum = 0;
  for (const auto& part : result) sum += part.second;
  if (!(sum > 0)) return {};
  for (auto& part : result) part.second /= sum;
  return result;
}

// The terms of a row that is a sum of others, one a node, those of the secondary side first.
std::vector<Term> RowsBetween::sum_of(const Weighted& nodes, const Side& secondary, const Side& primary) const
{
  std::vector<Term> all, result;
  for (const auto& [node, w] : nodes)
    for (const auto& term : std::ranges::equal_range(terms_, std::pair(node->node, node->number), {},
                                                     [](const SentTerm& t) { return std::pair(t.node, t.number); })) {
      const auto& ids = term.on_primary ? primary.node_id : secondary.node_id;
      const auto at = std::ranges::lower_bound(ids, term.of) - ids.begin();
      all.push_back({static_cast<Local>(at), term.on_primary, w / node->weight * term.value});
    }
  const auto key = [](const Term& t) { return std::pair(t.on_primary, t.node); };
  std::ranges::stable_sort(all, {}, key);
  for (const auto& term : all) {
    if (!result.empty() && key(result.back()) == key(term))
      result.back().value += term.value;
    else
      result.push_back(term);
  }
  return result;
}

void RowsBetween::add_to(constraint::Contacts& contacts, const SupportDirectory& supports, const Setting& setting,
                         const GapAt& gap_at)
{
  if (!any_) return;
  std::vector<Global> wanted;
  for (const auto& place : places_) wanted.insert(wanted.end(), place.round.begin(), place.round.end());
  std::ranges::sort(wanted);
  wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
  const auto asked = ask(wanted, comm_);
  nodes_ = answer(by_node<Neighbour>(nodes_, comm_), asked, comm_);
  terms_ = answer(by_node<SentTerm>(terms_, comm_), asked, comm_);
  std::ranges::sort(nodes_, {}, [](const Neighbour& n) { return std::pair(n.node, n.number); });
  std::ranges::stable_sort(terms_, {}, [](const SentTerm& t) { return std::pair(t.node, t.number); });

  const Side secondary = nodes_of(terms_, false, setting.kinematics), primary = nodes_of(terms_, true, setting.kinematics);
  const SupportedNodes supported(supports, secondary.node_id, comm_), primary_supported(supports, primary.node_id, comm_);
  const int dimension = fem::dimension(setting.kinematics);
  RowWriter writer(secondary, primary, supported, primary_supported, dimension, setting.rotation);
  for (const auto& place : places_) {
    constraint::ContactNode node{setting.contact, place.node, 0, Point::Zero(), {}, contacts.rows.size()};
    node.at = place.at;
    const auto weighted = round(place, dimension);
    for (const auto& [other, w] : weighted) {
      node.area += w * other->area;
      node.parts.push_back({other->node, w, unpacked(other->normal)});
    }
    auto terms = sum_of(weighted, secondary, primary);
    const Gap gap = gap_at(place);
    if (terms.empty() || !std::isfinite(gap.mesh) || !writer.moves(terms, 1, gap.direction)) continue;
    node.normal = gap.direction;
    node.gap = gap.bound;
    std::vector<Point> fixed;  // tangents along which supports hold both sides
    if (setting.tangents) {
      node.tangents = directions(node.normal, {false, false, false}, {}, dimension).tangents;
      std::erase_if(node.tangents, [&](const Point& tangent) { return !writer.moves(terms, 1, tangent); });
      writer.leave_what_moves(terms, node.normal, node.tangents);
      for (const auto& tangent : other_tangents(node.normal, node.tangents, dimension))
        if (const auto on_both = writer.prescribed_on_both_sides(terms, node.normal, tangent))
          (on_both->moves ? node.tangents : fixed).push_back(on_both->axis);
    }
    const bool rings = setting.kinematics == fem::Kinematics::axisymmetric;  // these do not turn
    const Moments moments = rings ? Moments()
                                  : Moments(terms, 1, node.normal, Moments::across(gap.mesh, node.normal, gap.own_normal),
                                            &place.at, secondary, primary, dimension);
    writer.add(terms, 1, node.normal, node.gap, contacts);
    for (const auto& tangent : node.tangents) {
      const auto couple = rings ? std::vector<Term>() : moments.couple(tangent);
      const std::array couples{RowWriter::Couple{couple, node.normal}};
      writer.add(terms, 1, tangent, 0, contacts, couples);
    }
    for (const auto& tangent : fixed) {
      writer.add_prescribed(terms, 1, tangent, contacts);
      node.tangents.push_back(tangent);
    }
    contacts.nodes.push_back(std::move(node));
    contacts.bonded.push_back(false);
  }
}

}  // namespace mortise::contact
