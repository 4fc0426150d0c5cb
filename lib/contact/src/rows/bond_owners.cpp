#include "rows/bond_owners.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

constexpr double as_much = 1e-3;    // of a cover
constexpr double same_node = 1e-6;  // of a face

using Pairs = std::set<std::array<int, 2>>;

std::array<int, 2> ordered(int a, int b)
{
  return {std::min(a, b), std::max(a, b)};
}

// Of all ranks. Collective.
template <class T>
std::set<T> united(const std::set<T>& some, const Communicator& comm)
{
  const auto all = comm.all_gather(std::vector<T>(some.begin(), some.end()));
  return {all.begin(), all.end()};
}

// The bonds, and the nodes that they have in common.
class Bonds {
 public:
  // `sides`: of this rank's nodes by number, ascending. `known`: of the nodes that are asked about, ascending. Collective.
  Bonds(const std::vector<CoveredNode>& covered, const std::vector<NodeOfBond>& sides, std::vector<NodeOfBond> known,
        const Communicator& comm)
      : known_(std::move(known))
  {
    Pairs beside;
    std::set<int> unmatched, cyclic, preloaded;
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (std::size_t j = i + 1; j < sides.size() && sides[j].node == sides[i].node; ++j)
        if (sides[i].bond != sides[j].bond) beside.insert(ordered(sides[i].bond, sides[j].bond));
    for (const auto& node : covered) {
      if (!node.matches) unmatched.insert(node.bond);
      if (node.cyclic) cyclic.insert(node.bond);
      if (node.preloaded) preloaded.insert(node.bond);
    }
    beside_ = united(beside, comm);
    unmatched_ = united(unmatched, comm);
    cyclic_ = united(cyclic, comm);
    preloaded_ = united(preloaded, comm);
    for (const auto& [a, b] : beside_) all_.merge(std::set<int>{a, b});
  }

  std::set<int> of(Global node) const
  {
    std::set<int> result;
    const auto [first, last] = std::ranges::equal_range(known_, node, {}, &NodeOfBond::node);
    for (auto entry = first; entry != last; ++entry) result.insert(entry->bond);
    return result;
  }
  // Of what lies opposite a node, but for those of the node itself.
  std::set<int> opposite(const CoveredNode& node, const std::set<int>& of_node) const
  {
    std::set<int> result;
    for (const Global other : node.opposite)
      if (other >= 0) result.merge(of(other));
    for (const int bond : of_node) result.erase(bond);
    return result;
  }

  // Whether two bonds have nodes in common.
  bool beside(int a, int b) const { return a == b || beside_.contains(ordered(a, b)); }
  // Where rings of bonds close the last one gives way: a preloaded one, or one that does not match all over, if there are any.
  std::array<int, 3> rank(int bond) const { return {preloaded_.contains(bond), unmatched_.contains(bond), bond}; }
  bool comes_before(int a, int b) const { return rank(a) < rank(b); }
  bool cyclic(int bond) const { return cyclic_.contains(bond); }
  const std::set<int>& all() const { return all_; }

 private:
  std::vector<NodeOfBond> known_;
  Pairs beside_;
  std::set<int> unmatched_, cyclic_, preloaded_;
  std::set<int> all_;  // that have nodes in common with others
};

// Whether what lies opposite in `bond` is tied to what does in `cut`, in the next sector: by a cut of its own, and there by a
// bond to the same body, which may be this one again.
bool tied_round(const CoveredNode& bond, const CoveredNode& cut, const Bonds& bonds)
{
  const auto of_opposite = bonds.opposite(bond, {bond.bond}), of_next = bonds.opposite(cut, {cut.bond});
  return std::ranges::any_of(of_opposite, [&](int other) {
    return bonds.cyclic(other) &&
           std::ranges::any_of(of_next, [&](int next) { return !bonds.cyclic(next) && bonds.beside(other, next); });
  });
}

// Whether what lies opposite in one bond is tied to what does in the other: it is the same body, they are bonded to each other,
// or both to a third one.
bool tied(const CoveredNode& a, const CoveredNode& b, const std::set<int>& of_node, const Bonds& bonds)
{
  if (a.cyclic != b.cyclic) return a.cyclic ? tied_round(b, a, bonds) : tied_round(a, b, bonds);
  for (const Global other : a.opposite)
    if (other >= 0 && std::ranges::find(b.opposite, other) != b.opposite.end()) return true;
  const auto of_a = bonds.opposite(a, of_node), of_b = bonds.opposite(b, of_node);
  return std::ranges::any_of(
      of_a, [&](int bond) { return std::ranges::any_of(of_b, [&](int other) { return bonds.beside(bond, other); }); });
}

// Whether the bond of a node is the last of a ring of three or four that closes there: the node's body has another one, and so
// has what lies opposite, with nodes in common or a further bond between them. Round a sector both may be the same. `parted`:
// bonds that rings do not go through.
bool closes_ring(const CoveredNode& node, const std::set<int>& of_node, const Bonds& bonds, const Pairs& parted)
{
  const auto before = [&](int bond) { return bond != node.bond && bonds.comes_before(bond, node.bond); };
  const auto goes_on = [&](int a, int b) { return bonds.beside(a, b) && !parted.contains(ordered(a, b)); };
  const auto of_opposite = bonds.opposite(node, {node.bond});
  for (const int own : of_node)
    for (const int other : of_opposite) {
      if (!before(own) || !before(other) || !goes_on(node.bond, own) || !goes_on(node.bond, other)) continue;
      if (own != other && goes_on(own, other)) return true;
      for (const int between : bonds.all())
        if (before(between) && between != own && between != other && goes_on(own, between) && goes_on(between, other))
          return true;
    }
  return false;
}

bool is_past_border(const CoveredNode& node)
{
  return std::ranges::all_of(node.opposite, [](Global other) { return other < 0; });
}

// Rows that tie pairs of nodes agree with others that do.
bool ties_pairs(const CoveredNode& node)
{
  return node.matches && !node.preloaded;
}

// Visits nodes, each with its entries, those that cover most first; but cuts that match before others, and preloads last.
template <class Visit>
void for_nodes(const std::vector<CoveredNode>& covered, const Visit& visit)
{
  for (std::size_t i = 0, end = 0; i < covered.size(); i = end) {
    while (end < covered.size() && covered[end].node == covered[i].node) ++end;
    std::vector<CoveredNode> entries(covered.begin() + static_cast<std::ptrdiff_t>(i),
                                     covered.begin() + static_cast<std::ptrdiff_t>(end));
    std::ranges::sort(entries, {}, [](const CoveredNode& e) {
      return std::tuple(e.preloaded, !(e.cyclic && e.matches), -std::llround(e.cover / as_much), e.bond);
    });
    visit(entries);
  }
}

// Those that are on the sides of several bonds, of both lists ascending.
std::vector<CoveredNode> of_several(const std::vector<CoveredNode>& covered, const std::vector<NodeOfBond>& sides)
{
  std::vector<CoveredNode> result;
  for (const auto& node : covered) {
    const auto [first, last] = std::ranges::equal_range(sides, node.node, {}, &NodeOfBond::node);
    if (std::any_of(first, last, [&](const NodeOfBond& side) { return side.bond != node.bond; })) result.push_back(node);
  }
  return result;
}

std::vector<Global> all_nodes(const std::vector<CoveredNode>& covered)
{
  std::set<Global> result;
  for (const auto& node : covered) {
    result.insert(node.node);
    for (const Global other : node.opposite)
      if (other >= 0) result.insert(other);
  }
  return {result.begin(), result.end()};
}

}  // namespace

std::vector<NodeOfBond> nodes_of_others(const std::vector<CoveredNode>& covered, const std::vector<NodeOfBond>& sides,
                                        const Communicator& comm)
{
  const auto several = of_several(covered, sides);
  const Bonds bonds(covered, sides, answer(sides, ask(all_nodes(several), comm), comm), comm);

  // Past a border nothing lies opposite: there it counts whether the two bonds are tied anywhere.
  Pairs tied_somewhere;
  for_nodes(several, [&](const std::vector<CoveredNode>& entries) {
    const auto of_node = bonds.of(entries[0].node);
    for (std::size_t i = 0; i < entries.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (!is_past_border(entries[i]) && !is_past_border(entries[j]) && tied(entries[i], entries[j], of_node, bonds))
          tied_somewhere.insert(ordered(entries[i].bond, entries[j].bond));
  });
  tied_somewhere = united(tied_somewhere, comm);

  std::vector<NodeOfBond> result;
  Pairs parted;
  for_nodes(several, [&](const std::vector<CoveredNode>& entries) {
    const auto of_node = bonds.of(entries[0].node);
    std::vector<CoveredNode> keep;
    for (const auto& entry : entries) {
      const auto other = std::ranges::find_if(keep, [&](const CoveredNode& kept) {
        if (ties_pairs(entry) && ties_pairs(kept)) return false;
        if (is_past_border(entry) || is_past_border(kept)) return tied_somewhere.contains(ordered(entry.bond, kept.bond));
        return tied(entry, kept, of_node, bonds);
      });
      if (other != keep.end()) {
        result.push_back({entry.node, entry.bond});
        parted.insert(ordered(entry.bond, other->bond));
      } else
        keep.push_back(entry);
    }
  });
  parted = united(parted, comm);
  for (const auto& node : several)
    if (!ties_pairs(node) && !is_past_border(node) && closes_ring(node, bonds.of(node.node), bonds, parted))
      result.push_back({node.node, node.bond});
  std::ranges::stable_sort(result, {}, &NodeOfBond::node);
  return result;
}

std::vector<char> on_matching_faces(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces, Rays& rays,
                                    std::span<const char> own, const Communicator& comm)
{
  const auto node_of = [&](std::size_t p) { return static_cast<std::size_t>(surface_nodes.all[p].node); };
  const auto opposite_a_node = [&](Local p) {
    const Opposite& opposite = rays.meet(static_cast<std::size_t>(p));
    return std::isfinite(opposite.gap) && opposite.hit.shape.maxCoeff() > 1 - same_node;
  };
  std::vector<char> apart(surface_nodes.all.size(), 0);
  for (const std::size_t f : faces.round()) {
    const auto pieces = faces.pieces(f);
    if (std::ranges::none_of(pieces, [&](std::size_t i) { return faces.piece(i).covered.sum() > 0; })) continue;
    const auto round = faces.surface_nodes_of(f);
    if (std::ranges::all_of(round, opposite_a_node)) continue;
    for (const Local p : round) apart[static_cast<std::size_t>(p)] = 1;
  }
  std::vector<NodeOfBond> own_apart;
  for (std::size_t p = 0; p < apart.size(); ++p)
    if (apart[p] && own[node_of(p)]) own_apart.push_back({secondary.node_id[node_of(p)]});
  const auto found = answer(by_node<NodeOfBond>(own_apart, comm), ask(secondary.node_id, comm), comm);
  std::vector<char> result(apart.size(), 0);
  for (std::size_t p = 0; p < result.size(); ++p)
    result[p] = !std::ranges::binary_search(found, secondary.node_id[node_of(p)], {}, &NodeOfBond::node);
  return result;
}

}  // namespace mortise::contact
