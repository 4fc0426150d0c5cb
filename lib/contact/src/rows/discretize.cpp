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
        add(*integrate(pairs_[c], c)->builder, c);
    if (bonds.empty()) return std::move(contacts_);
    join_across_bonds(pairs_, contacts_, comm_);
    add_bonds(bonds);
    return std::move(contacts_);
  }

 private:
  std::unique_ptr<Work> integrate(const Pair& pair, std::size_t c) const
  {
    auto work = std::make_unique<Work>(Work{share_out(pair, sizes_[c], kinematics_, comm_), {}, nullptr});
    work->builder = std::make_unique<ContactBuilder>(pair.options, work->share, sizes_[c].reach, static_cast<int>(c), directory_,
                                                     at_bonds_, work->others, curved_, kinematics_, comm_);
    work->builder->integrate(comm_);
    return work;
  }

  void add(ContactBuilder& builder, std::size_t c)
  {
    builder.set_lengths(touching_gap(sizes_[c].extent, sizes_[c].secondary_face), sizes_[c].secondary_face);
    builder.add_rows(contacts_, directory_, comm_);
    if (initial_gaps_) (*initial_gaps_)[c] = over_ranks(builder.initial_gap(), comm_);
    if (pairs_[c].options.cyclic) check_cuts(c, over_ranks(builder.fit(), comm_));
    builder.conflicts().refuse(pairs_[c].options, sizes_[c].reach, comm_);
  }

  // All of them are integrated before the first has rows. Lists of nodes are those of this rank's by number, not by place; see
  // by_node().
  void add_bonds(const std::vector<std::size_t>& bonds)
  {
    std::vector<NodeOfContact> unbonded, bonded;
    for (const auto& node : contacts_.nodes) unbonded.push_back({node.node});
    std::vector<std::unique_ptr<Work>> works;
    for (const std::size_t c : bonds) {
      works.push_back(integrate(pairs_[c], c));
      const auto nodes = works.back()->builder->nodes_of_bond();
      bonded.insert(bonded.end(), nodes.begin(), nodes.end());
    }
    auto known = by_node<NodeOfContact>(unbonded, comm_);
    const auto owned = owners(by_node<NodeOfContact>(bonded, comm_));
    known.insert(known.end(), owned.begin(), owned.end());
    std::ranges::stable_sort(known, {}, &NodeOfContact::node);
    for (std::size_t b = 0; b < bonds.size(); ++b) {
      const auto c = bonds[b];
      auto& [share, others, builder] = *works[b];
      others = answer(known, ask(share.secondary.node_id, comm_), comm_);
      std::erase_if(others, [&](const NodeOfContact& node) { return node.bonded && node.contact == static_cast<int>(c); });
      add(*builder, c);
      works[b].reset();
    }
  }

  // What touches nothing, or lies far from what it should, once more with its primary side turned the other way.
  void check_cuts(std::size_t c, const CutFit& fit) const
  {
    if (pairs_[c].options.law == Law::bonded) return require_one_surface(pairs_[c], sizes_[c], fit, comm_);
    if (!may_be_turned_wrongly(pairs_[c], sizes_[c], fit)) return;
    const Pair other = turned_back(pairs_[c]);
    const auto work = integrate(other, c);
    constraint::Contacts tried;
    work->builder->add_rows(tried, directory_, comm_);
    require_this_way(pairs_[c], sizes_[c], fit, over_ranks(work->builder->fit(), comm_));
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
