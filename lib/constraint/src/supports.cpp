#include "constraint/supports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/error.hpp"

namespace mortise::constraint {

bool Support::is_uniform() const
{
  const auto constant = [](const std::optional<deck::Formula>& value) { return !value || value->is_constant(); };
  return !axes && constant(normal) && std::all_of(displacement.begin(), displacement.end(), constant);
}

double value_at(std::span<const Support> supports, int support, const deck::Formula& formula, const Point& place)
{
  const double value = formula(place, 0);  // at the time of the state
  if (std::isfinite(value)) return value;
  throw Error(ExitStatus::bad_input,
              fmt::format("supports[{}] (boundary \"{}\"): \"{}\" is no number at ({:.6g}, {:.6g}, {:.6g})", support,
                          supports[static_cast<std::size_t>(support)].boundary, formula.text(), place[0], place[1], place[2]));
}

void throw_prescribed_coupling(std::span<const Support> supports, int coupling, int support)
{
  throw Error(ExitStatus::bad_input,
              fmt::format("the {}, which is rigid, and supports[{}] (boundary \"{}\") share nodes, which cannot follow both; "
                          "prescribe the same motion of the coupling's point, as on a plane of symmetry, or make it distributing",
                          supports[static_cast<std::size_t>(coupling)].boundary, support,
                          supports[static_cast<std::size_t>(support)].boundary));
}

namespace {

void check_agreement(const PrescribedDof& a, const PrescribedDof& b, std::span<const Support> supports, double largest)
{
  if (a.unknown || b.unknown)
    throw_prescribed_coupling(supports, a.unknown ? a.support : b.support, a.unknown ? b.support : a.support);
  const bool formulas =
      !supports[static_cast<std::size_t>(a.support)].is_uniform() || !supports[static_cast<std::size_t>(b.support)].is_uniform();
  if (std::abs(a.value - b.value) <= 1e-12 * (formulas ? largest : std::max(std::abs(a.value), std::abs(b.value)))) return;
  throw Error(
      ExitStatus::bad_input,
      fmt::format("supports[{}] (boundary \"{}\") and supports[{}] (boundary \"{}\") meet in a node and prescribe different "
                  "displacements {} there: {} and {}; make them agree or drop the component from one of them",
                  a.support, supports[a.support].boundary, b.support, supports[b.support].boundary, "xyz"[a.component], a.value,
                  b.value));
}

}  // namespace

std::vector<PrescribedDof> dirichlet_rows(std::span<const Support> supports, std::span<const SupportNodes> nodes, int dimension,
                                          const Communicator& comm, std::span<const PrescribedDof> aligned)
{
  struct Sent {
    Global node;
    int component, support;
    double value;
    std::array<double, 3> at;
  };
  std::vector<std::vector<Sent>> send(static_cast<std::size_t>(comm.size()));
  collectively(comm, [&] {
    for (std::size_t i = 0; i < supports.size(); ++i) {
      if (supports[i].axes) continue;
      for (std::size_t n = 0; n < nodes[i].id.size(); ++n)
        for (int c = 0; c < dimension; ++c)
          if (const auto& formula = supports[i].displacement[static_cast<std::size_t>(c)]) {
            const Global node = nodes[i].id[n];
            const Point& x = nodes[i].at[n];
            send[static_cast<std::size_t>(node % comm.size())].push_back(
                {node, c, static_cast<int>(i), value_at(supports, static_cast<int>(i), *formula, x), {x[0], x[1], x[2]}});
          }
    }
  });

  std::vector<PrescribedDof> prescribed(aligned.begin(), aligned.end());
  for (const auto& part : comm.exchange(send))
    for (const auto& p : part) prescribed.push_back({p.node, p.component, p.value, p.support, p.at});
  std::sort(prescribed.begin(), prescribed.end(), [](const PrescribedDof& a, const PrescribedDof& b) {
    return std::tie(a.node, a.component, a.support) < std::tie(b.node, b.component, b.support);
  });
  double largest = 0;
  for (const auto& p : prescribed) largest = std::max(largest, std::abs(p.value));
  largest = comm.max(largest);
  collectively(comm, [&] {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < prescribed.size(); ++i) {
      if (kept > 0 && prescribed[kept - 1].node == prescribed[i].node &&
          prescribed[kept - 1].component == prescribed[i].component)
        check_agreement(prescribed[kept - 1], prescribed[i], supports, largest);
      else
        prescribed[kept++] = prescribed[i];
    }
    prescribed.resize(kept);
  });
  return prescribed;
}

}  // namespace mortise::constraint
