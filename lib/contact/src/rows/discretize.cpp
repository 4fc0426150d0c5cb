// discretize() works out one contact after the other. Bonded contacts come last: a seam has no multipliers where it ends at
// another contact. Where bonds share secondary nodes each of these belongs to one of them.
#include <algorithm>
#include <memory>
#include <utility>

#include "rows/across_bonds.hpp"
#include "rows/by_node.hpp"
#include "rows/contact_rows.hpp"

namespace mortise::contact {

namespace {

// An integrated contact, and the share of its faces that it refers to.
struct Work {
  std::unique_ptr<Share> share;
  IntegratedContact contact;
};

// One contact after the other, and what all of them ask for.
class OneByOne {
 public:
  // All arguments outlive it. Collective.
  OneByOne(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed, fem::Kinematics kinematics,
           const Communicator& comm, std::span<const constraint::SkewSupport> skew_supports,
           std::span<const CurvedFace> curved_faces, std::vector<InitialGap>* initial_gaps)
      : pairs_(pairs),
        kinematics_(kinematics),
        comm_(comm),
        initial_gaps_(initial_gaps),
        sizes_(measure(pairs, comm)),
        directory_(prescribed, skew_supports, comm),
        curved_(curved_faces, comm),
        at_bonds_(pairs, kinematics, comm)
  {
    if (initial_gaps) initial_gaps->assign(pairs.size(), {});
  }

  // Collective.
  constraint::Contacts discretize()
  {
    std::vector<std::size_t> bonds;
    for (std::size_t c = 0; c < pairs_.size(); ++c)
      if (pairs_[c].options.law == Law::bonded)
        bonds.push_back(c);
      else
        add(work_on(pairs_[c], c), {}, c);
    if (bonds.empty()) return std::move(contacts_);
    join_across_bonds(pairs_, contacts_, comm_);
    add_bonds(bonds);
    return std::move(contacts_);
  }

 private:
  Work work_on(const Pair& pair, std::size_t c) const
  {
    auto share = std::make_unique<Share>(share_out(pair, sizes_[c], kinematics_, comm_));
    auto sides = std::make_unique<OpposedSides>(pair.options, *share, sizes_[c].reach, static_cast<int>(c), directory_, at_bonds_,
                                                kinematics_, comm_);
    return {std::move(share), integrate(std::move(sides), comm_)};
  }

  RowsFound add_rows_of(Work work, const OthersNodes& others, std::size_t c, constraint::Contacts& contacts) const
  {
    InitialGap gap;
    gap.touching = touching_gap(sizes_[c].extent, sizes_[c].secondary_face);
    gap.face = sizes_[c].secondary_face;
    return add_rows(std::move(work.contact), others, gap, directory_, curved_, contacts, comm_);
  }

  void add(Work work, const OthersNodes& others, std::size_t c)
  {
    const auto found = add_rows_of(std::move(work), others, c, contacts_);
    if (initial_gaps_) (*initial_gaps_)[c] = over_ranks(found.initial_gap, comm_);
    if (pairs_[c].options.cyclic) check_cuts(c, over_ranks(found.fit, comm_));
    found.conflicts.refuse(pairs_[c].options, sizes_[c].reach, comm_);
  }

  // All of them are integrated before the first has rows. Lists of nodes are those of this rank's by number, not by place; see
  // by_node().
  void add_bonds(const std::vector<std::size_t>& bonds)
  {
    std::vector<NodeOfBond> unbonded, sides;
    std::vector<CoveredNode> covered;
    for (const auto& node : contacts_.nodes) unbonded.push_back({node.node});
    std::vector<Work> works;
    for (const std::size_t c : bonds) {
      works.push_back(work_on(pairs_[c], c));
      const auto& share = *works.back().share;
      for (const auto* side : {&share.secondary, &share.primary})
        for (const Global node : side->node_id) sides.push_back({node, static_cast<int>(c)});
      const auto nodes = covered_nodes(works.back().contact);
      covered.insert(covered.end(), nodes.begin(), nodes.end());
    }
    unbonded = by_node<NodeOfBond>(unbonded, comm_);
    const auto others = nodes_of_others(by_node<CoveredNode>(covered, comm_), by_node<NodeOfBond>(sides, comm_), comm_);
    for (std::size_t b = 0; b < bonds.size(); ++b) {
      const auto asked = ask(works[b].share->secondary.node_id, comm_);
      OthersNodes here;
      for (const auto& node : answer(unbonded, asked, comm_)) here.of_contacts.push_back(node.node);
      for (const auto& node : answer(others, asked, comm_))
        if (node.bond == static_cast<int>(bonds[b])) here.of_bonds.push_back(node.node);
      add(std::move(works[b]), here, bonds[b]);
    }
  }

  // What touches nothing, or lies far from what it should, once more with its primary side rotated the other way.
  void check_cuts(std::size_t c, const CutFit& fit) const
  {
    if (pairs_[c].options.law == Law::bonded) return require_one_surface(pairs_[c], sizes_[c], fit, comm_);
    if (!may_be_rotated_wrongly(pairs_[c], sizes_[c], fit)) return;
    const Pair other = rotated_the_other_way(pairs_[c]);
    constraint::Contacts tried;
    const auto found = add_rows_of(work_on(other, c), {}, c, tried);
    require_this_way(pairs_[c], sizes_[c], fit, over_ranks(found.fit, comm_));
  }

  std::span<const Pair> pairs_;
  fem::Kinematics kinematics_;
  const Communicator& comm_;
  std::vector<InitialGap>* initial_gaps_;
  std::vector<PairSize> sizes_;
  SupportDirectory directory_;
  CurvedFaces curved_;
  FacesAtBonds at_bonds_;
  constraint::Contacts contacts_;
};

}  // namespace

constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed,
                                fem::Kinematics kinematics, const Communicator& comm,
                                std::span<const constraint::SkewSupport> skew_supports, std::span<const CurvedFace> curved_faces,
                                std::vector<InitialGap>* initial_gaps)
{
  return OneByOne(pairs, prescribed, kinematics, comm, skew_supports, curved_faces, initial_gaps).discretize();
}

}  // namespace mortise::contact
