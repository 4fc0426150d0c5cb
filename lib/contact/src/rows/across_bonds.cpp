#include "rows/across_bonds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "contact/cyclic.hpp"
#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

constexpr double same_node_of_bond = 1e-3, beside_edge = 0.05;  // of the distance between nodes
constexpr double same_normal_at_bond = 0.99;                    // cosine
constexpr double nothing_of_row = 1e-9;

// A node of a bond.
struct NodeOfSide {
  Global node;
  int bond;  // index of the pair
  int side;  // 1 the secondary one, 0 the primary one
};

// A contact node on a bond, on its way to all ranks. Its place and directions are those on the secondary side of the bond: of
// nodes of the primary side they are rotated.
struct Candidate {
  int contact, bond, side;
  int rank, index;  // of its rank's contact nodes
  Global node;
  enum class Kind : int { node, corner, between } kind;  // itself, a corner of the primary side beside it, a place between nodes
  int tangents;
  double area, weight, gap, prescribed_share;
  std::array<double, 3> at, normal;
  std::array<std::array<double, 3>, 2> tangent;
};

// A coefficient of its rows, or what a support holds of them, or their bounds; of a place between nodes, what one of them bears.
struct SentEntry {
  int rank, index, row;
  enum class Kind : int { entry, prescribed, bound, part } kind;
  Global node;
  int component, support;
  double value;
  std::array<double, 3> at;
  int coupling = -1;
  std::array<double, 3> arm{};
};

// What a node on the primary side of a bond takes over of one on the secondary side.
struct HandedOver {
  const Candidate* from;
  const Candidate* to;
  double part;  // of the row of `from`
};

// The contact nodes at one bond, on both of its sides.
class EdgeAtBond {
 public:
  explicit EdgeAtBond(std::span<const Pair> pairs) : pairs_(pairs) {}

  void add(const Candidate& c) { (c.side == 1 ? from_ : to_).push_back(&c); }

  void share_out(std::vector<HandedOver>& result) const
  {
    for (const auto* from : from_) {
      const auto shares = shares_of(*from);
      if (std::ranges::all_of(shares, [](const HandedOver& s) { return same_rows(*s.from, *s.to); }))
        result.insert(result.end(), shares.begin(), shares.end());
    }
  }

 private:
  // Parts of a contact that goes on may be contacts of their own.
  bool same_law(const Candidate& a, const Candidate& b) const
  {
    const auto& one = pairs_[static_cast<std::size_t>(a.contact)].options;
    const auto& other = pairs_[static_cast<std::size_t>(b.contact)].options;
    return a.contact == b.contact ||
           (one.law == other.law && one.friction == other.friction && one.interference == other.interference);
  }

  static bool same_rows(const Candidate& a, const Candidate& b)
  {
    if (a.rank == b.rank && a.index == b.index) return false;  // on the axis
    if (a.tangents != b.tangents || unpacked(a.normal).dot(unpacked(b.normal)) < same_normal_at_bond) return false;
    const auto tangents = static_cast<std::size_t>(b.tangents);
    for (std::size_t t = 0; t < tangents; ++t) {
      double square = 0;
      for (std::size_t s = 0; s < tangents; ++s) square += std::pow(unpacked(b.tangent[t]).dot(unpacked(a.tangent[s])), 2);
      if (square < same_normal_at_bond) return false;
    }
    return true;
  }

  // The image of a node, or the two that it lies between; none if there is nothing.
  std::vector<HandedOver> shares_of(const Candidate& from) const
  {
    const Point x = unpacked(from.at);
    std::vector<std::pair<double, const Candidate*>> near;
    for (const auto* to : to_)
      if (to->kind == from.kind && same_law(from, *to) && unpacked(to->normal).dot(unpacked(from.normal)) > same_normal_at_bond)
        near.emplace_back((unpacked(to->at) - x).norm(), to);
    std::ranges::sort(near, {}, [&](const auto& n) {
      return std::tuple(n.first, n.second->contact != from.contact, n.second->contact, n.second->node);
    });
    if (near.empty()) return {};
    const Point first = unpacked(near[0].second->at);
    double next = std::sqrt(from.area);  // one node alone: the edge of a plane model
    if (near.size() > 1) next = (unpacked(near[1].second->at) - first).norm();
    if (near[0].first <= same_node_of_bond * next) return {{&from, near[0].second, 1}};
    if (from.kind != Candidate::Kind::node) return {};
    for (std::size_t i = 1; i < near.size(); ++i) {
      const Point along = unpacked(near[i].second->at) - first;
      const double t = (x - first).dot(along) / along.squaredNorm();
      if (!(t > 0 && t < 1) || (x - first - t * along).norm() > beside_edge * along.norm()) continue;
      return {{&from, near[0].second, 1 - t}, {&from, near[i].second, t}};
    }
    return {};
  }

  std::span<const Pair> pairs_;
  std::vector<const Candidate*> from_, to_;  // on the secondary side of the bond and on the primary one
};

// The rows of one contact node, to be added to.
struct NodeRows {
  std::vector<std::map<std::pair<Global, int>, double>> entries;
  std::vector<std::vector<constraint::PrescribedEntry>> prescribed;
  std::vector<double> bound;

  explicit NodeRows(std::size_t rows) : entries(rows), prescribed(rows), bound(rows, 0.0) {}

  void add(const SentEntry& e, std::size_t row, double factor)
  {
    if (std::abs(factor) < nothing_of_row) return;
    if (e.kind == SentEntry::Kind::bound) bound[row] += factor * e.value;
    if (e.kind == SentEntry::Kind::entry) entries[row][{e.node, e.component}] += factor * e.value;
    if (e.kind == SentEntry::Kind::prescribed)
      prescribed[row].push_back({0, e.component, e.support, factor * e.value, e.at, e.coupling, e.arm});
  }
};

// A contact node: its rank, and its number there.
using NodeOfRank = std::pair<int, int>;
NodeOfRank key_of(const Candidate& c)
{
  return {c.rank, c.index};
}

// A pretension section parts by more than nothing.
bool is_bond(const Pair& pair)
{
  return pair.options.law == Law::bonded && !pair.options.preload && pair.primary;
}

class Joining {
 public:
  Joining(std::span<const Pair> pairs, constraint::Contacts& contacts, const Communicator& comm)
      : pairs_(pairs), contacts_(contacts), comm_(comm)
  {
  }

  void run()
  {
    candidates_ = comm_.all_gather(own_candidates());
    std::map<int, EdgeAtBond> edges;
    for (const auto& c : candidates_) edges.try_emplace(c.bond, pairs_).first->second.add(c);
    std::vector<HandedOver> shares;
    for (const auto& [bond, edge] : edges) edge.share_out(shares);
    // Each gives to one bond, and not to who gives.
    std::map<NodeOfRank, int> bond_of;
    for (const auto& s : shares) bond_of.emplace(key_of(*s.from), s.from->bond);
    std::set<NodeOfRank> kept;
    for (const auto& s : shares)
      if (bond_of.contains(key_of(*s.to))) kept.insert(key_of(*s.from));
    std::erase_if(shares, [&](const HandedOver& s) {
      return kept.contains(key_of(*s.from)) || bond_of.at(key_of(*s.from)) != s.from->bond;
    });
    if (shares.empty()) return;
    for (const auto& s : shares) {
      given_.insert({key_of(*s.from), s.from});
      taken_[key_of(*s.to)].push_back(s);
    }
    sent_ = comm_.all_gather(sent_rows());
    rebuild();
  }

 private:
  std::vector<NodeOfSide> nodes_of_bonds() const
  {
    std::vector<NodeOfSide> result;
    for (std::size_t c = 0; c < pairs_.size(); ++c) {
      if (!is_bond(pairs_[c])) continue;
      for (const Global node : pairs_[c].secondary.node_id) result.push_back({node, static_cast<int>(c), 1});
      for (const Global node : pairs_[c].primary->node_id) result.push_back({node, static_cast<int>(c), 0});
    }
    return result;
  }

  std::vector<Candidate> own_candidates() const
  {
    std::vector<Global> nodes;
    for (const auto& node : contacts_.nodes) nodes.push_back(node.node);
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
    auto bonds = answer(by_node<NodeOfSide>(nodes_of_bonds(), comm_), ask(nodes, comm_), comm_);
    const auto key = [](const NodeOfSide& n) { return std::tuple(n.node, n.bond, n.side); };
    std::ranges::sort(bonds, {}, key);
    bonds.erase(std::ranges::unique(bonds, {}, key).begin(), bonds.end());
    std::vector<Candidate> result;
    for (std::size_t i = 0; i < contacts_.nodes.size(); ++i) {
      const auto& node = contacts_.nodes[i];
      const auto& options = pairs_[static_cast<std::size_t>(node.contact)].options;
      if (contacts_.bonded[i] || options.cyclic) continue;
      for (const auto& bond : std::ranges::equal_range(bonds, node.node, {}, &NodeOfSide::node))
        result.push_back(candidate(static_cast<int>(i), bond));
    }
    return result;
  }

  Candidate candidate(int index, const NodeOfSide& bond) const
  {
    const auto& node = contacts_.nodes[static_cast<std::size_t>(index)];
    const auto motion = bond.side == 0 ? motion_of(bond.bond) : mesh::Motion();
    using Kind = Candidate::Kind;
    const Kind kind = !node.parts.empty() ? Kind::between : node.cover == 0 ? Kind::corner : Kind::node;
    Candidate c{node.contact, bond.bond,   bond.side, comm_.rank(),
                index,        node.node,   kind,      static_cast<int>(node.tangents.size()),
                node.area,    node.weight, node.gap,  node.prescribed_share,
                {},           {},          {}};
    c.at = packed(motion(node.at));
    c.normal = packed(motion.rotation * node.normal);
    for (std::size_t t = 0; t < node.tangents.size(); ++t) c.tangent[t] = packed(motion.rotation * node.tangents[t]);
    return c;
  }

  // Of the primary side of a bond.
  mesh::Motion motion_of(int bond) const
  {
    return rotation_of(pairs_[static_cast<std::size_t>(bond)].options).value_or(mesh::Motion());
  }

  // What supports hold of the rows of a node.
  std::span<const constraint::PrescribedEntry> prescribed_of(const constraint::ContactNode& node) const
  {
    const auto row = &constraint::PrescribedEntry::row;
    const auto begin = std::ranges::lower_bound(contacts_.prescribed, node.row, {}, row),
               end = std::ranges::lower_bound(contacts_.prescribed, node.row + node.tangents.size() + 1, {}, row);
    return {begin, end};
  }

  // The rows of this rank's node `index`.
  std::vector<SentEntry> entries_of(int index) const
  {
    const auto& node = contacts_.nodes[static_cast<std::size_t>(index)];
    const auto end = node.row + node.tangents.size() + 1;
    std::vector<SentEntry> result;
    for (std::size_t r = node.row; r < end; ++r) {
      const auto row = static_cast<int>(r - node.row);
      result.push_back({comm_.rank(), index, row, SentEntry::Kind::bound, 0, 0, 0, contacts_.rows.bound[r], {}});
      for (const auto& e : contacts_.rows[r])
        result.push_back({comm_.rank(), index, row, SentEntry::Kind::entry, e.node, e.component, 0, e.coefficient, {}});
    }
    for (const auto& p : prescribed_of(node))
      result.push_back({comm_.rank(), index, static_cast<int>(p.row - node.row), SentEntry::Kind::prescribed, 0, p.component,
                        p.support, p.coefficient, p.at, p.coupling, p.arm});
    for (const auto& part : node.parts)
      result.push_back({comm_.rank(), index, 0, SentEntry::Kind::part, part.node, 0, 0, part.part, {}});
    return result;
  }

  std::vector<SentEntry> sent_rows() const
  {
    std::vector<SentEntry> result;
    for (const auto& [key, from] : given_)
      if (from->rank == comm_.rank()) {
        const auto entries = entries_of(from->index);
        result.insert(result.end(), entries.begin(), entries.end());
      }
    return result;
  }

  // Contact node `index` with what it takes over.
  constraint::ContactNode joined(int index, const std::vector<HandedOver>& shares, NodeRows& rows) const
  {
    auto node = contacts_.nodes[static_cast<std::size_t>(index)];
    double area = node.area;
    for (const auto& s : shares) area += s.part * s.from->area;
    const double own = node.area / area;
    for (const auto& e : entries_of(index)) rows.add(e, static_cast<std::size_t>(e.row), own);
    node.weight *= own, node.gap *= own, node.prescribed_share *= own;
    for (const auto& s : shares) {
      const double part = s.part * s.from->area / area;
      node.weight += part * s.from->weight, node.gap += part * s.from->gap,
          node.prescribed_share += part * s.from->prescribed_share;
      const bool between = s.from->kind == Candidate::Kind::between;
      const auto rotation = motion_of(s.from->bond).rotation;
      if (!between) node.images.push_back({s.from->contact, s.from->node, part, rotation});
      for (const auto& e : std::ranges::equal_range(sent_, key_of(*s.from), {}, sender)) {
        if (e.kind == SentEntry::Kind::part) node.images.push_back({s.from->contact, e.node, part * e.value, rotation});
        if (e.row == 0) rows.add(e, 0, part);
        for (std::size_t t = 0; t < node.tangents.size() && e.row > 0; ++t)
          rows.add(e, t + 1,
                   part * unpacked(s.to->tangent[t]).dot(unpacked(s.from->tangent[static_cast<std::size_t>(e.row - 1)])));
      }
    }
    node.area = area;
    return node;
  }

  void rebuild()
  {
    std::ranges::stable_sort(sent_, {}, sender);
    constraint::Contacts result;
    result.without_rows = contacts_.without_rows;
    for (std::size_t i = 0; i < contacts_.nodes.size(); ++i) {
      const NodeOfRank key{comm_.rank(), static_cast<int>(i)};
      if (given_.contains(key)) continue;
      if (const auto taken = taken_.find(key); taken == taken_.end())
        copy(contacts_.nodes[i], result);
      else
        add_joined(static_cast<int>(i), taken->second, result);
      result.bonded.push_back(contacts_.bonded[i]);
    }
    contacts_ = std::move(result);
  }

  void copy(constraint::ContactNode node, constraint::Contacts& to) const
  {
    for (auto p : prescribed_of(node)) p.row += to.rows.size() - node.row, to.prescribed.push_back(p);
    const auto first = node.row;
    node.row = to.rows.size();
    for (std::size_t r = first; r <= first + node.tangents.size(); ++r) {
      to.rows.entries.insert(to.rows.entries.end(), contacts_.rows[r].begin(), contacts_.rows[r].end());
      to.rows.close(contacts_.rows.bound[r]);
    }
    to.nodes.push_back(std::move(node));
  }

  void add_joined(int index, const std::vector<HandedOver>& shares, constraint::Contacts& to) const
  {
    NodeRows rows(contacts_.nodes[static_cast<std::size_t>(index)].tangents.size() + 1);
    to.nodes.push_back(joined(index, shares, rows));
    to.nodes.back().row = to.rows.size();
    for (std::size_t r = 0; r < rows.bound.size(); ++r) {
      for (auto& p : rows.prescribed[r]) p.row = to.rows.size(), to.prescribed.push_back(p);
      for (const auto& [at, value] : rows.entries[r])
        if (value != 0) to.rows.entries.push_back({at.first, at.second, value});
      to.rows.close(rows.bound[r]);
    }
  }

  static NodeOfRank sender(const SentEntry& e) { return {e.rank, e.index}; }

  std::span<const Pair> pairs_;
  constraint::Contacts& contacts_;
  const Communicator& comm_;
  std::vector<Candidate> candidates_;
  std::map<NodeOfRank, const Candidate*> given_;
  std::map<NodeOfRank, std::vector<HandedOver>> taken_;
  std::vector<SentEntry> sent_;  // of those that give
};

}  // namespace

void join_across_bonds(std::span<const Pair> pairs, constraint::Contacts& contacts, const Communicator& comm)
{
  if (std::ranges::any_of(pairs, is_bond)) Joining(pairs, contacts, comm).run();
}

}  // namespace mortise::contact
