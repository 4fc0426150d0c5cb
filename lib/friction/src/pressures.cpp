#include "pressures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortise::friction {

namespace {

constexpr double idle_part = 1e-3;    // of a pressure and of a load
constexpr double loaded_part = 1e-7;  // of the largest load of a body, below which a load is none

double least_load_of(const feti::DualProblem& problem)
{
  auto loads = problem.loads_of_bodies();
  for (const auto& coupling : problem.constraints().couplings)
    if (coupling.rigid) loads.push_back(std::hypot(coupling.load[0], coupling.load[1], coupling.load[2]));
  const double nothing = loads.empty() ? 0 : loaded_part * *std::max_element(loads.begin(), loads.end());
  double least = std::numeric_limits<double>::infinity();
  for (const double load : loads)
    if (load > nothing) least = std::min(least, load);
  return least;
}

}  // namespace

Pressures::Pressures(const feti::DualProblem& problem, const Vector& x) : problem_(problem), least_load_(least_load_of(problem))
{
  const auto& comm = problem.communicator();
  const auto value = view(x);
  const auto& points = problem.constraints().contacts.nodes;
  int count = 0;
  for (const auto& point : points) count = std::max(count, point.contact + 1);
  largest_.assign(static_cast<std::size_t>(comm.max(static_cast<long long>(count))), 0.0);
  force_ = largest_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto contact = static_cast<std::size_t>(points[i].contact);
    const double multiplier = value[problem.node_rows()[i].normal];
    largest_[contact] = std::max(largest_[contact], of(i, multiplier));
    if (!problem.constraints().contacts.bonded[i])
      force_[contact] += std::max(problem.jump().force(problem.node_rows()[i].normal, multiplier), 0.0);
  }
  for (auto& pressure : largest_) all_ = std::max(all_, pressure = comm.max(pressure));
  comm.sum_in_place(force_);
}

double Pressures::of(std::size_t point, double multiplier) const
{
  const auto& contacts = problem_.constraints().contacts;
  const auto& node = contacts.nodes[point];
  if (contacts.bonded[point] || node.cover < narrow_cover || !(node.area > 0)) return 0;
  return problem_.jump().force(problem_.node_rows()[point].normal, multiplier) / node.area;
}

bool Pressures::idle(std::size_t contact) const
{
  return largest_[contact] < idle_part * all_ && force_[contact] < idle_part * least_load_;
}

}  // namespace mortise::friction
