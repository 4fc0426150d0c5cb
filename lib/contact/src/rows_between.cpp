#include "rows_between.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "base/dense.hpp"
#include "by_node.hpp"
#include "moments.hpp"

namespace mortise::contact {

namespace {

constexpr double one_normal = 0.75;         // cosine: rows on the other side of a kink say nothing here
constexpr double largest_weights = 3;       // the sum of their sizes: more is an extrapolation
constexpr double least_weight = 1e-9;       // of the largest
constexpr double negligible_entry = 1e-12;  // of a row, where the largest are of size 1

using Packed = std::array<double, 3>;

Packed packed(const Point& p)
{
  return {p[0], p[1], p[2]};
}
Point unpacked(const Packed& a)
{
  return {a[0], a[1], a[2]};
}

// A contact node on its way to the places round it.
struct Neighbour {
  Global node;
  int number;  // among those at the node
  int tangents;
  double weight, area, gap;
  Packed normal, at;
  std::array<Packed, 2> axes;
  std::array<double, 3> held;  // of each row, what supports add to its bound
};

// An entry of one of its rows, or of what supports hold of it.
struct NeighbourEntry {
  Global node;
  int number, row;
  Global of;  // of free entries
  int component;
  double value;
  int support = -1;  // of held ones
  Packed at{};
};

// The nodes of this rank that places of others ask for. Collective.
std::vector<Global> asked_for(std::span<const PlaceBetween> places, const std::vector<Global>& own, const Communicator& comm)
{
  struct Asked {
    Global node;
  };
  std::vector<Asked> wanted;
  for (const auto& place : places)
    for (const Global node : place.round) wanted.push_back({node});
  std::vector<Global> result;
  for (const auto& asked : answer(by_node<Asked>(wanted, comm), ask(own, comm), comm)) result.push_back(asked.node);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// The contact nodes that places are between, with their rows.
class Neighbours {
 public:
  // Collective.
  Neighbours(std::span<const PlaceBetween> places, std::size_t first, const constraint::Contacts& contacts, const Communicator& comm)
  {
    std::vector<Global> own, wanted;
    for (std::size_t i = first; i < contacts.nodes.size(); ++i) own.push_back(contacts.nodes[i].node);
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const auto asked = asked_for(places, own, comm);
    std::vector<Neighbour> nodes;
    std::vector<NeighbourEntry> entries;
    for (std::size_t i = first; i < contacts.nodes.size(); ++i)
      if (std::binary_search(asked.begin(), asked.end(), contacts.nodes[i].node)) pack(contacts, i, nodes, entries);
    for (const auto& place : places) wanted.insert(wanted.end(), place.round.begin(), place.round.end());
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    nodes_ = answer(by_node<Neighbour>(nodes, comm), ask(wanted, comm), comm);
    entries_ = answer(by_node<NeighbourEntry>(entries, comm), ask(wanted, comm), comm);
    std::sort(nodes_.begin(), nodes_.end(), [](const Neighbour& a, const Neighbour& b) { return key(a) < key(b); });
    std::stable_sort(entries_.begin(), entries_.end(), [](const NeighbourEntry& a, const NeighbourEntry& b) {
      return std::tuple(a.node, a.number, a.row) < std::tuple(b.node, b.number, b.row);
    });
  }

  // Those at these nodes that look the way of a normal.
  std::vector<const Neighbour*> at(std::span<const Global> nodes, const Point& normal) const
  {
    std::vector<const Neighbour*> result;
    for (const Global node : nodes) {
      auto known = std::lower_bound(nodes_.begin(), nodes_.end(), node, [](const Neighbour& a, Global n) { return a.node < n; });
      for (; known != nodes_.end() && known->node == node; ++known)
        if (unpacked(known->normal).dot(normal) > one_normal) result.push_back(&*known);
    }
    return result;
  }

  std::span<const NeighbourEntry> entries(const Neighbour& node, int row) const
  {
    const auto wanted = std::tuple(node.node, node.number, row);
    const auto key_of = [](const NeighbourEntry& e) { return std::tuple(e.node, e.number, e.row); };
    const auto begin =
        std::lower_bound(entries_.begin(), entries_.end(), wanted, [&](const auto& e, const auto& k) { return key_of(e) < k; });
    auto end = begin;
    while (end != entries_.end() && key_of(*end) == wanted) ++end;
    return {begin, end};
  }

 private:
  static std::pair<Global, int> key(const Neighbour& node) { return {node.node, node.number}; }

  static void pack(const constraint::Contacts& contacts, std::size_t i, std::vector<Neighbour>& nodes,
                   std::vector<NeighbourEntry>& entries)
  {
    const auto& from = contacts.nodes[i];
    Neighbour to{from.node,           0, static_cast<int>(from.tangents.size()), from.weight, from.area, from.gap, packed(from.normal),
                packed(from.at), {}, {}};
    for (const auto& other : nodes)
      if (other.node == from.node) ++to.number;
    std::transform(from.tangents.begin(), from.tangents.end(), to.axes.begin(), packed);
    const auto rows = from.tangents.size() + 1;
    auto held = std::lower_bound(contacts.prescribed.begin(), contacts.prescribed.end(), from.row,
                                 [](const constraint::PrescribedEntry& e, std::size_t row) { return e.row < row; });
    for (std::size_t r = 0; r < rows; ++r) {
      to.held[r] = contacts.rows.bound[from.row + r] - (r == 0 ? from.gap : 0.0);
      const auto number = static_cast<int>(r);
      for (const auto& e : contacts.rows[from.row + r])
        entries.push_back({from.node, to.number, number, e.node, e.component, e.coefficient});
      for (; held != contacts.prescribed.end() && held->row == from.row + r; ++held)
        entries.push_back({from.node, to.number, number, 0, held->component, held->coefficient, held->support, held->at});
    }
    nodes.push_back(to);
  }

  std::vector<Neighbour> nodes_;
  std::vector<NeighbourEntry> entries_;
};

// A row at work: a sum of others.
class RowSum {
 public:
  explicit RowSum(const Neighbours& known) : known_(known) {}

  void add(const Neighbour& node, int row, double part)
  {
    bound_ += part * node.held[static_cast<std::size_t>(row)];
    for (auto entry : known_.entries(node, row)) {
      entry.value *= part;
      (entry.support < 0 ? free_ : held_).push_back(entry);
    }
  }

  // Appends the row <= gap + what supports add.
  void close(double gap, constraint::Contacts& contacts)
  {
    const auto row = contacts.rows.size();
    merge(free_, [](const NeighbourEntry& e) { return std::tuple(e.of, e.component); });
    for (const auto& e : free_)
      if (std::abs(e.value) > negligible_entry) contacts.rows.entries.push_back({e.of, e.component, e.value});
    merge(held_, [](const NeighbourEntry& e) { return std::tuple(e.support, e.component, e.at); });
    for (const auto& e : held_) contacts.prescribed.push_back({row, e.component, e.support, e.value, e.at});
    contacts.rows.close(gap + bound_);
  }

 private:
  template <class Key>
  static void merge(std::vector<NeighbourEntry>& entries, const Key& key)
  {
    std::stable_sort(entries.begin(), entries.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::size_t end = 0;
    for (const auto& e : entries) {
      if (end > 0 && key(entries[end - 1]) == key(e))
        entries[end - 1].value += e.value;
      else
        entries[end++] = e;
    }
    entries.resize(end);
  }

  const Neighbours& known_;
  std::vector<NeighbourEntry> free_, held_;
  double bound_ = 0;
};

// Polynomials up to an order at a place, in rows.
Eigen::MatrixXd polynomials_at(const Eigen::Matrix2Xd& x, int dimension, int order)
{
  const auto s = x.row(0).array(), t = x.row(1).array();
  const bool plane = dimension == 3;
  Eigen::MatrixXd p((order == 2 ? 3 : 2) + (plane ? (order == 2 ? 3 : 1) : 0), x.cols());
  Eigen::Index row = 0;
  p.row(row++).setOnes();
  p.row(row++) = s;
  if (plane) p.row(row++) = t;
  if (order < 2) return p;
  p.row(row++) = s * s;
  if (plane) p.row(row++) = s * t;
  if (plane) p.row(row++) = t * t;
  return p;
}

// The tangential rows of a place, along directions in which most of the others' can move.
void add_tangents(const Neighbours& known, std::span<const std::pair<const Neighbour*, double>> used, constraint::ContactNode& node,
                  int dimension, constraint::Contacts& contacts)
{
  constexpr double most = 0.5;
  const auto axes = tangent_plane(node.normal, dimension);
  for (int a = 0; a + 1 < dimension; ++a) {
    const Point tangent = axes.col(a);
    RowSum row(known);
    double moves = 0, all = 0;
    for (const auto& [other, part] : used) {
      all += std::abs(part);
      for (int k = 0; k < other->tangents; ++k) {
        const double along = tangent.dot(unpacked(other->axes[static_cast<std::size_t>(k)]));
        row.add(*other, k + 1, part * along);
        moves += std::abs(part) * along * along;
      }
    }
    if (moves < most * all) continue;
    row.close(0, contacts);
    node.tangents.push_back(tangent);
  }
}

}  // namespace

Eigen::VectorXd weights_between(const Eigen::Matrix2Xd& x, int dimension)
{
  constexpr double exact = 1e-6;
  const Eigen::VectorXd nearness = (-0.5 * x.colwise().squaredNorm().array()).exp();
  for (const int order : {2, 1}) {
    const Eigen::MatrixXd p = polynomials_at(x, dimension, order);
    const Eigen::VectorXd wanted = Eigen::VectorXd::Unit(p.rows(), 0);
    const Eigen::VectorXd w = nearness.cwiseProduct(dense::minimum_norm(p * nearness.asDiagonal(), wanted).col(0));
    if ((p * w - wanted).lpNorm<Eigen::Infinity>() < exact && w.lpNorm<1>() < largest_weights) return w;
  }
  return {};
}

std::vector<PlaceBetween> take_places_between(std::vector<NearestPoint>& nearest, const Side& secondary,
                                              const SurfaceNodes& surface_nodes, const CutFaces& faces, const std::vector<char>& own,
                                              const std::function<bool(std::size_t face)>& covered)
{
  std::vector<PlaceBetween> result;
  std::vector<std::vector<std::size_t>> faces_at;  // of each node, once it is needed
  std::map<std::size_t, bool> whole;
  for (std::size_t p = 0; p < nearest.size(); ++p) {
    if (!nearest[p].moved()) continue;
    const Rays::FacetPoint where{nearest[p].facet, nearest[p].shape};
    const auto face = static_cast<std::size_t>(secondary.face_of[where.facet]);
    if (secondary.second_order(face)) continue;
    const auto known = whole.try_emplace(face, false);
    if (known.second) known.first->second = covered(face);
    if (!known.first->second) continue;
    nearest[p] = {};
    const auto node = static_cast<std::size_t>(surface_nodes.all[p].node);
    if (!own[node]) continue;
    if (faces_at.empty()) {
      faces_at.resize(secondary.points.size());
      for (const std::size_t f : faces.round())
        for (const Local n : secondary.faces[f]) faces_at[static_cast<std::size_t>(n)].push_back(f);
    }
    PlaceBetween place{p, secondary.node_id[node], where, Point::Zero(), Point::Zero(), secondary.geometry(where.facet).size(), {}};
    for (std::size_t c = 0; c < secondary.facets[where.facet].size(); ++c) {
      const auto corner = static_cast<std::size_t>(secondary.facets[where.facet][c]);
      place.at += where.shape[static_cast<Eigen::Index>(c)] * secondary.points[corner];
      place.normal += where.shape[static_cast<Eigen::Index>(c)] * surface_nodes.normal(secondary, where.facet, c);
      for (const std::size_t f : faces_at[corner])
        for (const Local n : secondary.faces[f]) place.round.push_back(secondary.node_id[static_cast<std::size_t>(n)]);
    }
    place.normal.normalize();
    std::sort(place.round.begin(), place.round.end());
    place.round.erase(std::unique(place.round.begin(), place.round.end()), place.round.end());
    result.push_back(std::move(place));
  }
  return result;
}

void add_rows_between(std::span<const PlaceBetween> places, std::size_t first, const RowsBetween& what,
                      constraint::Contacts& contacts, const Communicator& comm)
{
  if (!comm.any(!places.empty())) return;
  const Neighbours known(places, first, contacts, comm);
  for (const auto& place : places) {
    const auto round = known.at(place.round, place.normal);
    const auto count = static_cast<Eigen::Index>(round.size());
    const auto axes = tangent_plane(place.normal, what.dimension);
    Eigen::Matrix2Xd x(2, count);
    for (Eigen::Index i = 0; i < count; ++i)
      x.col(i) = axes.transpose() * (unpacked(round[static_cast<std::size_t>(i)]->at) - place.at) / place.size;
    const Eigen::VectorXd w = count > 0 ? weights_between(x, what.dimension) : Eigen::VectorXd();
    if (w.size() == 0) continue;

    constraint::ContactNode node{what.contact, place.node, 0, Point::Zero(), {}, contacts.rows.size()};
    node.at = place.at;
    RowSum normal_row(known);
    std::vector<std::pair<const Neighbour*, double>> used;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& other = *round[static_cast<std::size_t>(i)];
      if (std::abs(w[i]) < least_weight * w.maxCoeff()) continue;
      used.emplace_back(&other, w[i] / other.weight);
      normal_row.add(other, 0, used.back().second);
      node.normal += w[i] * unpacked(other.normal);
      node.area += w[i] * other.area;
      node.parts.push_back({other.node, w[i], unpacked(other.normal)});
    }
    node.normal.normalize();
    node.gap = what.gap(place, node.normal);
    if (!std::isfinite(node.gap)) continue;
    normal_row.close(node.gap, contacts);
    if (what.tangents) add_tangents(known, used, node, what.dimension, contacts);
    contacts.nodes.push_back(std::move(node));
    contacts.bonded.push_back(false);
  }
}

}  // namespace mortise::contact
