#include "constraint/coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "base/error.hpp"

namespace mortise::constraint {

namespace {

// Component c of what a unit of component k of the motion does at x - p = arm.
double part_of_motion(int k, int c, const std::array<double, 3>& arm)
{
  if (k < 3) return k == c ? 1 : 0;
  const Point turned = Point::Unit(k - 3).cross(Point(arm[0], arm[1], arm[2]));
  return turned[c];
}

// Whether a component of the motion moves a component of displacement, wherever the node is.
bool moves(int k, int c, int dimension)
{
  if (k < 3) return k == c;
  return dimension == 3 ? k - 3 != c : k == 5;
}

bool exists(int k, int dimension)
{
  return dimension == 3 || k < 2 || k == 5;
}

bool is_unknown(const Coupling& coupling, int k, int dimension)
{
  return coupling.rigid && exists(k, dimension) && !coupling.motion[static_cast<std::size_t>(k)];
}

}  // namespace

void describe(deck::Description<CouplingOptions>& d)
{
  d.help("A boundary coupled to a point, through which it is loaded and held: `coupling` in loads and supports names it.");
  d.key("boundary", &CouplingOptions::boundary, "Boundary that is coupled.").required();
  d.key("point", &CouplingOptions::point, "The point; it need not lie on the body.").required();
  d.key("kind", &CouplingOptions::kind,
        "distributing: the boundary stays flexible, forces and moments are spread over its area, and the point has its mean "
        "motion; rigid: the boundary moves as one with the point.")
      .one_of({"distributing", "rigid"});
}

std::vector<PrescribedDof> coupled_rows(std::span<const Coupling> couplings, std::span<const mesh::Surface> surfaces,
                                        int first_support, int dimension, const Communicator& comm)
{
  std::vector<std::vector<PrescribedDof>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    const auto& coupling = couplings[i];
    if (!coupling.rigid) continue;
    for (std::size_t n = 0; n < surfaces[i].node_id.size(); ++n) {
      const Point arm = surfaces[i].points[n] - coupling.point;
      PrescribedDof row{surfaces[i].node_id[n], 0, 0, first_support + static_cast<int>(i)};
      row.coupling = static_cast<int>(i);
      row.at = {surfaces[i].points[n][0], surfaces[i].points[n][1], surfaces[i].points[n][2]};
      row.arm = {arm[0], arm[1], arm[2]};
      for (row.component = 0; row.component < dimension; ++row.component) {
        row.value = 0;
        row.unknown = false;
        for (int k = 0; k < 6; ++k) {
          if (!moves(k, row.component, dimension)) continue;
          if (const auto& given = coupling.motion[static_cast<std::size_t>(k)])
            row.value += part_of_motion(k, row.component, row.arm) * *given;
          else if (exists(k, dimension))
            row.unknown = true;
        }
        send[static_cast<std::size_t>(row.node % comm.size())].push_back(row);
      }
    }
  }
  std::vector<PrescribedDof> rows;
  for (const auto& part : comm.exchange(send)) rows.insert(rows.end(), part.begin(), part.end());
  std::sort(rows.begin(), rows.end(), [](const PrescribedDof& a, const PrescribedDof& b) {
    return std::tie(a.node, a.component, a.coupling) < std::tie(b.node, b.component, b.coupling);
  });
  collectively(comm, [&] {
    std::size_t kept = 0;
    for (const auto& row : rows) {
      if (kept > 0 && rows[kept - 1].node == row.node && rows[kept - 1].component == row.component) {
        if (rows[kept - 1].coupling != row.coupling)
          throw Error(
              ExitStatus::bad_input,
              fmt::format("the rigid couplings \"{}\" and \"{}\" share nodes, which cannot follow both; couple boundaries "
                          "that do not touch, or make one of them distributing",
                          couplings[static_cast<std::size_t>(rows[kept - 1].coupling)].name,
                          couplings[static_cast<std::size_t>(row.coupling)].name));
        continue;
      }
      rows[kept++] = row;
    }
    rows.resize(kept);
  });
  return rows;
}

std::vector<UnknownMotion> unknown_motions(const Constraints& constraints, int dimension)
{
  std::vector<UnknownMotion> result;
  for (std::size_t i = 0; i < constraints.couplings.size(); ++i) {
    const auto& coupling = constraints.couplings[i];
    for (int k = 0; k < 6; ++k) {
      if (!is_unknown(coupling, k, dimension)) continue;
      const double unit = k < 3 ? 1 : 1 / coupling.arm;
      UnknownMotion motion{static_cast<int>(i), k, unit, unit * coupling.load[static_cast<std::size_t>(k)], {}};
      for (std::size_t r = 0; r < constraints.prescribed.size(); ++r) {
        const auto& row = constraints.prescribed[r];
        if (row.coupling == static_cast<int>(i) && moves(k, row.component, dimension))
          motion.rows.push_back({r, unit * part_of_motion(k, row.component, row.arm)});
      }
      result.push_back(std::move(motion));
    }
  }
  return result;
}

namespace {

constexpr double rounding_of_motion = 1e-9;  // of what makes it up

// What a support prescribes, by node and component.
struct PrescribedValue {
  Global node;
  int component;
  double value;
  bool operator<(const PrescribedValue& other) const { return std::tie(node, component) < std::tie(other.node, other.component); }
};

// What supports make of a mean motion whose nodes they hold all, and the sum of what makes it up.
std::optional<std::pair<double, double>> mean_of_supports(const MeanMotion& motion, const std::vector<PrescribedValue>& values)
{
  double mean = 0, scale = 0;
  for (const auto& entry : motion.entries) {
    if (entry.coefficient == 0) continue;
    const PrescribedValue wanted{entry.node, entry.component, 0};
    const auto found = std::lower_bound(values.begin(), values.end(), wanted);
    if (found == values.end() || wanted < *found) return {};
    mean += entry.coefficient * found->value;
    scale += std::abs(entry.coefficient * found->value);
  }
  return std::pair(mean, scale);
}

bool same_entries(const MeanMotion& a, const MeanMotion& b)
{
  return std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(), [](const Entry& x, const Entry& y) {
    return x.node == y.node && x.component == y.component &&
           std::abs(x.coefficient - y.coefficient) <= rounding_of_motion * std::abs(x.coefficient);
  });
}

bool differ(double a, double b, double scale)
{
  return std::abs(a - b) > rounding_of_motion * std::max({scale, std::abs(a), std::abs(b)});
}

}  // namespace

void require_consistent(std::span<const MeanMotion> motions, std::span<const PrescribedDof> prescribed,
                        std::span<const Coupling> couplings, const Communicator& comm)
{
  if (!comm.any(!motions.empty())) return;
  std::vector<PrescribedValue> values;
  for (const auto& p : prescribed)
    if (p.coupling < 0) values.push_back({p.node, p.component, p.value});
  values = comm.all_gather(values);
  std::sort(values.begin(), values.end());
  const auto name = [&](const MeanMotion& motion) { return couplings[static_cast<std::size_t>(motion.coupling)].name; };
  collectively(comm, [&] {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const auto& motion = motions[i];
      if (const auto found = mean_of_supports(motion, values); found && differ(found->first, motion.value, found->second))
        throw Error(ExitStatus::bad_input,
                    fmt::format("coupling \"{}\" and the supports that hold its boundary prescribe different motions of it; drop "
                                "the component from one of them",
                                name(motion)));
      for (const auto& other : motions.first(i))
        if (motion.component == other.component && same_entries(motion, other) && differ(motion.value, other.value, 0))
          throw Error(ExitStatus::bad_input,
                      fmt::format("couplings \"{}\" and \"{}\" of one boundary prescribe different motions of it", name(other),
                                  name(motion)));
    }
  });
}

bool same_unknowns(std::span<const Coupling> a, std::span<const Coupling> b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Coupling& x, const Coupling& y) {
    return std::equal(x.motion.begin(), x.motion.end(), y.motion.begin(),
                      [](const auto& p, const auto& q) { return p.has_value() == q.has_value(); });
  });
}

}  // namespace mortise::constraint
