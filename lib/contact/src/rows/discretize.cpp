// discretize() works out one contact after the other. Bonded contacts come last: a seam has no multipliers where it ends at
// another contact.
#include <algorithm>

#include "rows/across_bonds.hpp"
#include "rows/by_node.hpp"
#include "rows/contact_builder.hpp"

namespace mortise::contact {

constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed,
                                fem::Kinematics kinematics, const Communicator& comm,
                                std::span<const constraint::SkewSupport> skew_supports, std::span<const CurvedFace> curved_faces,
                                std::vector<InitialGap>* initial_gaps)
{
  constraint::Contacts contacts;
  const auto sizes = measure(pairs, comm);
  const SupportDirectory directory(prescribed, skew_supports, comm);
  std::vector<UnbondedNode> unbonded_nodes;  // this rank's nodes by number, not by place; see by_node()
  const CurvedFaces curved(curved_faces, comm);
  const FacesAtBonds at_bonds(pairs, kinematics, comm);
  if (initial_gaps) initial_gaps->assign(pairs.size(), {});
  // What touches nothing, or lies far from what it should, once more with its primary side turned the other way.
  const auto check_cuts = [&](std::size_t c, const CutFit& fit) {
    if (pairs[c].options.law == Law::bonded) return require_one_surface(pairs[c], sizes[c], fit, comm);
    if (!may_be_turned_wrongly(pairs[c], sizes[c], fit)) return;
    const Pair other = turned_back(pairs[c]);
    const Share share = share_out(other, sizes[c], kinematics, comm);
    const std::vector<UnbondedNode> none;
    ContactBuilder builder(other.options, share, sizes[c].reach, static_cast<int>(c), directory, at_bonds, none, curved,
                           kinematics, comm);
    constraint::Contacts tried;
    builder.add_rows(tried, directory, comm);
    require_this_way(pairs[c], sizes[c], fit, over_ranks(builder.fit(), comm));
  };
  const auto add = [&](std::size_t c) {
    const auto& options = pairs[c].options;
    const Share share = share_out(pairs[c], sizes[c], kinematics, comm);
    std::vector<UnbondedNode> at_seam;
    if (options.law == Law::bonded && comm.any(!unbonded_nodes.empty()))
      at_seam = answer(unbonded_nodes, ask(share.secondary.node_id, comm), comm);
    ContactBuilder builder(options, share, sizes[c].reach, static_cast<int>(c), directory, at_bonds, at_seam, curved, kinematics,
                           comm);
    builder.set_lengths(touching_gap(sizes[c].extent, sizes[c].secondary_face), sizes[c].secondary_face);
    builder.add_rows(contacts, directory, comm);
    if (initial_gaps) (*initial_gaps)[c] = over_ranks(builder.initial_gap(), comm);
    if (options.cyclic) check_cuts(c, over_ranks(builder.fit(), comm));
    builder.conflicts().refuse(options, sizes[c].reach, comm);
  };
  const auto is_bonded = [](const Pair& pair) { return pair.options.law == Law::bonded; };
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (!is_bonded(pairs[c])) add(c);
  if (std::none_of(pairs.begin(), pairs.end(), is_bonded)) return contacts;
  join_across_bonds(pairs, contacts, comm);
  for (const auto& point : contacts.nodes) unbonded_nodes.push_back({point.node});
  unbonded_nodes = by_node<UnbondedNode>(unbonded_nodes, comm);
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (is_bonded(pairs[c])) add(c);
  return contacts;
}

}  // namespace mortise::contact
