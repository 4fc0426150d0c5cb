#include "constraint/right_hand_sides.hpp"

#include <algorithm>

namespace mortise::constraint {

bool update_rhs(Constraints& constraints, std::vector<PrescribedDof> prescribed, std::span<const Support> supports,
                std::span<const Support> before, const Communicator& comm)
{
  const auto uniform = [](const Support& s) { return s.is_uniform(); };
  if (!std::all_of(supports.begin(), supports.end(), uniform) || !std::all_of(before.begin(), before.end(), uniform))
    return false;
  const auto value = [](const Support& s, std::size_t c) { return s.displacement[c] ? s.displacement[c]->constant() : 0; };
  const bool same =
      std::equal(prescribed.begin(), prescribed.end(), constraints.prescribed.begin(), constraints.prescribed.end(),
                 [](const PrescribedDof& a, const PrescribedDof& b) { return a.node == b.node && a.component == b.component; });
  if (comm.min(static_cast<long long>(same)) == 0) return false;
  auto& contacts = constraints.contacts;
  const auto coupled = [](const PrescribedEntry& entry) { return entry.coupling >= 0; };
  const bool moved = !std::equal(
      prescribed.begin(), prescribed.end(), constraints.prescribed.begin(),
      [](const PrescribedDof& a, const PrescribedDof& b) { return a.coupling < 0 || a.unknown || a.value == b.value; });
  if (comm.any(moved) && comm.any(std::any_of(contacts.prescribed.begin(), contacts.prescribed.end(), coupled))) return false;
  constraints.prescribed = std::move(prescribed);
  for (const auto& entry : contacts.prescribed) {
    if (coupled(entry)) continue;
    const auto support = static_cast<std::size_t>(entry.support), c = static_cast<std::size_t>(entry.component);
    contacts.rows.bound[entry.row] -= entry.coefficient * (value(supports[support], c) - value(before[support], c));
  }
  return true;
}

void add_interference(Contacts& contacts, int contact, double overlap)
{
  for (auto& node : contacts.nodes) {
    if (node.contact != contact) continue;
    const double before = bound_of(node);
    node.gap -= node.weight * overlap;
    contacts.rows.bound[node.row] += bound_of(node) - before;
  }
}

void remember_slip(Contacts& contacts, std::span<const double> jumps)
{
  contacts.slipped.resize(contacts.rows.size(), 0.0);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    if (contacts.bonded[i]) continue;
    for (std::size_t r = contacts.nodes[i].row + 1; r <= contacts.nodes[i].row + contacts.nodes[i].tangents.size(); ++r) {
      contacts.slipped[r] += jumps[r] - contacts.rows.bound[r];
      contacts.rows.bound[r] = jumps[r];
    }
  }
}

}  // namespace mortise::constraint
