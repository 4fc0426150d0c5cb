#include "constraint/supports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/error.hpp"

namespace mortise::constraint {

void throw_held_coupling(std::span<const SupportOptions> supports, int coupling, int support)
{
  throw Error(ExitStatus::bad_input,
              fmt::format("the {}, which is rigid, and supports[{}] (boundary \"{}\") share nodes, which cannot follow both; "
                          "prescribe the same motion of the coupling's point, as on a plane of symmetry, or make it distributing",
                          supports[static_cast<std::size_t>(coupling)].boundary, support,
                          supports[static_cast<std::size_t>(support)].boundary));
}

namespace {

void check_agreement(const PrescribedDof& a, const PrescribedDof& b, std::span<const SupportOptions> supports)
{
  if (a.unknown || b.unknown) throw_held_coupling(supports, a.unknown ? a.support : b.support, a.unknown ? b.support : a.support);
  if (std::abs(a.value - b.value) <= 1e-12 * std::max(std::abs(a.value), std::abs(b.value))) return;
  throw Error(
      ExitStatus::bad_input,
      fmt::format("supports[{}] (boundary \"{}\") and supports[{}] (boundary \"{}\") meet in a node and prescribe different "
                  "displacements {} there: {} and {}; make them agree or drop the component from one of them",
                  a.support, supports[a.support].boundary, b.support, supports[b.support].boundary, "xyz"[a.component], a.value,
                  b.value));
}

}  // namespace

std::vector<PrescribedDof> dirichlet_rows(std::span<const SupportOptions> supports, std::span<const std::vector<Global>> nodes,
                                          int dimension, const Communicator& comm, std::span<const PrescribedDof> aligned)
{
  std::vector<std::vector<PrescribedDof>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < supports.size(); ++i)
    for (const Global node : nodes[i])
      for (int c = 0; c < dimension; ++c)
        if (const auto value = supports[i].displacement[c])
          send[static_cast<std::size_t>(node % comm.size())].push_back({node, c, *value, static_cast<int>(i)});

  std::vector<PrescribedDof> prescribed(aligned.begin(), aligned.end());
  for (const auto& part : comm.exchange(send)) prescribed.insert(prescribed.end(), part.begin(), part.end());
  std::sort(prescribed.begin(), prescribed.end(), [](const PrescribedDof& a, const PrescribedDof& b) {
    return std::tie(a.node, a.component, a.support) < std::tie(b.node, b.component, b.support);
  });
  collectively(comm, [&] {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < prescribed.size(); ++i) {
      if (kept > 0 && prescribed[kept - 1].node == prescribed[i].node &&
          prescribed[kept - 1].component == prescribed[i].component)
        check_agreement(prescribed[kept - 1], prescribed[i], supports);
      else
        prescribed[kept++] = prescribed[i];
    }
    prescribed.resize(kept);
  });
  return prescribed;
}

}  // namespace mortise::constraint
