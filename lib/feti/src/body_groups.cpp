#include "feti/body_groups.hpp"

#include <algorithm>
#include <numeric>

namespace mortise::feti {

namespace {

// The lowest group of each owned row's bodies, as `count` less its number, and 0 for a row without any: what Tpetra takes the
// largest of. Collective.
Vector lowest_of_rows(const partition::Decomposition& decomposition, const JumpOperator& jump, const std::vector<int>& groups)
{
  Vector touched(jump.touched_rows()), owned(jump.rows());
  auto value = view(touched);
  for (std::size_t s = 0; s < jump.blocks().size(); ++s) {
    const auto group = groups[static_cast<std::size_t>(decomposition.subdomains[s].body)];
    const auto above = static_cast<double>(groups.size()) - group;
    for (const Local row : jump.blocks()[s].row) value[row] = std::max(value[row], above);
  }
  owned.doExport(touched, jump.import(), Tpetra::ABSMAX);
  return owned;
}

}  // namespace

BodyGroups body_groups(const partition::Decomposition& decomposition, const JumpOperator& jump,
                       std::span<const constraint::PrescribedDof> prescribed, const Communicator& comm)
{
  BodyGroups groups;
  groups.of_body.resize(decomposition.catalogue.bodies.size());
  std::iota(groups.of_body.begin(), groups.of_body.end(), 0);
  const auto count = static_cast<double>(groups.of_body.size());
  int couplings = 0;
  for (const auto& dof : prescribed) couplings = std::max(couplings, dof.coupling + 1);
  couplings = static_cast<int>(comm.max(static_cast<long long>(couplings)));
  while (true) {
    Vector lowest = lowest_of_rows(decomposition, jump, groups.of_body);
    auto of_row = view(lowest);
    std::vector<double> of_coupling(static_cast<std::size_t>(couplings), 0.0);
    const auto each_coupled = [&](const auto& visit) {
      for (std::size_t i = 0; i < prescribed.size(); ++i)
        if (prescribed[i].unknown)
          visit(of_row[jump.ranges().dirichlet + static_cast<Local>(i)],
                of_coupling[static_cast<std::size_t>(prescribed[i].coupling)]);
    };
    each_coupled([](double& row, double& coupling) { coupling = std::max(coupling, row); });
    for (auto& value : of_coupling) value = comm.max(value);
    each_coupled([](double& row, double& coupling) { row = std::max(row, coupling); });

    Vector touched(jump.touched_rows());
    touched.doImport(lowest, jump.import(), Tpetra::INSERT);
    std::vector<double> of_body(groups.of_body.size(), 0.0);
    for (std::size_t s = 0; s < jump.blocks().size(); ++s)
      for (const Local row : jump.blocks()[s].row) {
        auto& value = of_body[static_cast<std::size_t>(decomposition.subdomains[s].body)];
        value = std::max(value, view(touched)[row]);
      }
    bool changed = false;
    for (std::size_t b = 0; b < of_body.size(); ++b) {
      const int group = std::min(groups.of_body[b], static_cast<int>(count - comm.max(of_body[b])));
      changed = changed || group != groups.of_body[b];
      groups.of_body[b] = group;
    }
    if (changed) continue;
    groups.of_row.clear();
    for (Eigen::Index i = 0; i < of_row.size(); ++i)
      groups.of_row.push_back(of_row[i] > 0 ? static_cast<int>(count - of_row[i]) : -1);
    return groups;
  }
}

}  // namespace mortise::feti
