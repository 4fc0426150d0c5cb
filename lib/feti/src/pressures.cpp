#include "pressures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortise::feti {

namespace {

constexpr double idle_part = 1e-3;   // of a pressure and of a load
constexpr double none_part = 1e-10;  // of the largest load of a body, or pressure, below which there is none

// The least load of the bodies of each group, infinite where none is loaded. Collective.
std::vector<double> least_loads(const DualProblem& problem)
{
  const auto& groups = problem.system().groups();
  auto loads = problem.loads_of_bodies();
  auto group = groups.of_body;
  const auto& constraints = problem.constraints();
  const auto& comm = problem.communicator();
  for (std::size_t k = 0; k < constraints.couplings.size(); ++k) {
    const auto& coupling = constraints.couplings[k];
    if (!coupling.rigid) continue;
    long long of_coupling = -1;
    for (std::size_t i = 0; i < constraints.prescribed.size(); ++i)
      if (constraints.prescribed[i].coupling == static_cast<int>(k))
        of_coupling =
            std::max<long long>(of_coupling, groups.of_row[static_cast<std::size_t>(problem.jump().ranges().dirichlet) + i]);
    of_coupling = comm.max(of_coupling);
    if (of_coupling < 0) continue;
    loads.push_back(std::hypot(coupling.load[0], coupling.load[1], coupling.load[2]));
    group.push_back(static_cast<int>(of_coupling));
  }
  const double nothing = loads.empty() ? 0 : none_part * *std::max_element(loads.begin(), loads.end());
  std::vector<double> least(groups.of_body.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    auto& value = least[static_cast<std::size_t>(group[i])];
    if (loads[i] > nothing) value = std::min(value, loads[i]);
  }
  return least;
}

}  // namespace

Pressures::Pressures(const DualProblem& problem, const Vector& x) : problem_(problem), least_load_(least_loads(problem))
{
  const auto& comm = problem.communicator();
  const Eigen::VectorXd forces = problem.forces(x);
  find_parts();
  largest_.assign(group_.size(), 0.0);
  force_ = largest_;
  const auto& contacts = problem.constraints().contacts;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const double force = forces[problem.node_rows()[i].normal];
    largest_[part_[i]] = std::max(largest_[part_[i]], of(i, force));
    if (!contacts.bonded[i]) force_[part_[i]] += std::max(force, 0.0);
  }
  comm.sum_in_place(force_);
  all_.assign(least_load_.size(), 0.0);
  double whole = 0;
  for (std::size_t p = 0; p < group_.size(); ++p) {
    largest_[p] = comm.max(largest_[p]);
    all_[group_[p]] = std::max(all_[group_[p]], largest_[p]);
    whole = std::max(whole, largest_[p]);
  }
  for (auto& pressure : all_) pressure = std::max(pressure, none_part / idle_part * whole);
}

// Points with the same contact and the same group. Collective.
void Pressures::find_parts()
{
  struct Part {
    int contact, group;
    auto operator<=>(const Part&) const = default;
  };
  const auto& nodes = problem_.constraints().contacts.nodes;
  const auto& groups = problem_.system().groups();
  std::vector<Part> own;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    own.push_back({nodes[i].contact, std::max(groups.of_row[static_cast<std::size_t>(problem_.node_rows()[i].normal)], 0)});
  const auto each_once = [](std::vector<Part> parts) {
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
  };
  const auto all = each_once(problem_.communicator().all_gather(each_once(own)));
  for (const auto& part : own)
    part_.push_back(static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), part) - all.begin()));
  for (const auto& part : all) group_.push_back(static_cast<std::size_t>(part.group));
}

double Pressures::of(std::size_t point, double force) const
{
  const auto& contacts = problem_.constraints().contacts;
  const auto& node = contacts.nodes[point];
  if (contacts.bonded[point] || node.cover < narrow_cover || !(node.area > 0)) return 0;
  return force / node.area;
}

double Pressures::force_that_counts(std::size_t part) const
{
  const double load = least_load_[group_[part]];
  if (std::isfinite(load)) return idle_part * load;
  double largest = 0;
  for (std::size_t p = 0; p < group_.size(); ++p)
    if (group_[p] == group_[part]) largest = std::max(largest, force_[p]);
  return idle_part * largest;
}

bool Pressures::idle(std::size_t part) const
{
  return largest_[part] < idle_part * all_[group_[part]] && force_[part] < idle_part * least_load_[group_[part]];
}

}  // namespace mortise::feti
