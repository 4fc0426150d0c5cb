// discretize() works out one contact after the other. Bonded contacts come last: a seam has no multipliers where it ends at
// another contact. Where bonds share secondary nodes each of these belongs to one of them.
#include <algorithm>
#include <memory>

#include "rows/across_bonds.hpp"
#include "rows/by_node.hpp"
#include "rows/contact_builder.hpp"

namespace mortise::contact {

namespace {

constexpr double as_much = 1e-3;  // of a cover

// A contact at work.
struct Work {
  Share share;
  std::vector<NodeOfContact> others;
  std::unique_ptr<ContactBuilder> builder;
};

// Of the nodes of several bonds, each with the bond that it belongs to: the one that covers most of what is round it, the first
// of several. `nodes`: ascending.
std::vector<NodeOfContact> owners(const std::vector<NodeOfContact>& nodes)
{
  std::vector<NodeOfContact> result;
  for (std::size_t i = 0, end = 0; i < nodes.size(); i = end) {
    while (end < nodes.size() && nodes[end].node == nodes[i].node) ++end;
    std::size_t owner = i;
    for (std::size_t j = i + 1; j < end; ++j) {
      const double more = nodes[j].cover - nodes[owner].cover;
      if (more > as_much || (more >= -as_much && nodes[j].contact < nodes[owner].contact)) owner = j;
    }
    if (end - i > 1) result.push_back(nodes[owner]);
  }
  return result;
}

}  // namespace

constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed,
                                fem::Kinematics kinematics, const Communicator& comm,
                                std::span<const constraint::SkewSupport> skew_supports, std::span<const CurvedFace> curved_faces,
                                std::vector<InitialGap>* initial_gaps)
{
  constraint::Contacts contacts;
  const auto sizes = measure(pairs, comm);
  const SupportDirectory directory(prescribed, skew_supports, comm);
  const CurvedFaces curved(curved_faces, comm);
  const FacesAtBonds at_bonds(pairs, kinematics, comm);
  if (initial_gaps) initial_gaps->assign(pairs.size(), {});
  const auto integrate = [&](const Pair& pair, std::size_t c) {
    auto work = std::make_unique<Work>(Work{share_out(pair, sizes[c], kinematics, comm), {}, nullptr});
    work->builder = std::make_unique<ContactBuilder>(pair.options, work->share, sizes[c].reach, static_cast<int>(c), directory,
                                                     at_bonds, work->others, curved, kinematics, comm);
    work->builder->integrate(comm);
    return work;
  };
  // What touches nothing, or lies far from what it should, once more with its primary side turned the other way.
  const auto check_cuts = [&](std::size_t c, const CutFit& fit) {
    if (pairs[c].options.law == Law::bonded) return require_one_surface(pairs[c], sizes[c], fit, comm);
    if (!may_be_turned_wrongly(pairs[c], sizes[c], fit)) return;
    const Pair other = turned_back(pairs[c]);
    const auto work = integrate(other, c);
    constraint::Contacts tried;
    work->builder->add_rows(tried, directory, comm);
    require_this_way(pairs[c], sizes[c], fit, over_ranks(work->builder->fit(), comm));
  };
  const auto add = [&](ContactBuilder& builder, std::size_t c) {
    builder.set_lengths(touching_gap(sizes[c].extent, sizes[c].secondary_face), sizes[c].secondary_face);
    builder.add_rows(contacts, directory, comm);
    if (initial_gaps) (*initial_gaps)[c] = over_ranks(builder.initial_gap(), comm);
    if (pairs[c].options.cyclic) check_cuts(c, over_ranks(builder.fit(), comm));
    builder.conflicts().refuse(pairs[c].options, sizes[c].reach, comm);
  };
  std::vector<std::size_t> bonds;
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (pairs[c].options.law == Law::bonded)
      bonds.push_back(c);
    else
      add(*integrate(pairs[c], c)->builder, c);
  if (bonds.empty()) return contacts;
  join_across_bonds(pairs, contacts, comm);

  // Nodes are this rank's by number, not by place; see by_node().
  std::vector<NodeOfContact> unbonded, bonded;
  for (const auto& point : contacts.nodes) unbonded.push_back({point.node});
  std::vector<std::unique_ptr<Work>> works;
  for (const std::size_t c : bonds) {
    works.push_back(integrate(pairs[c], c));
    const auto nodes = works.back()->builder->nodes_of_bond();
    bonded.insert(bonded.end(), nodes.begin(), nodes.end());
  }
  auto known = by_node<NodeOfContact>(unbonded, comm);
  const auto owned = owners(by_node<NodeOfContact>(bonded, comm));
  known.insert(known.end(), owned.begin(), owned.end());
  std::ranges::stable_sort(known, {}, &NodeOfContact::node);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const auto c = bonds[b];
    auto& [share, others, builder] = *works[b];
    others = answer(known, ask(share.secondary.node_id, comm), comm);
    std::erase_if(others, [&](const NodeOfContact& node) { return node.bonded && node.contact == static_cast<int>(c); });
    add(*builder, c);
    works[b].reset();
  }
  return contacts;
}

}  // namespace mortise::contact
