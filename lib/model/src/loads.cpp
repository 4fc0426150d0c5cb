// The consistent load of every subdomain.
#include "fem/loads.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "model/model.hpp"
#include "points.hpp"

namespace mortise::model {

std::vector<Eigen::VectorXd> Model::loads(const LoadState& state, const Communicator& comm) const
{
  const int dimension = deck_.dimension();
  std::vector<Eigen::VectorXd> f;
  for (const auto& subdomain : decomposition_.subdomains)
    f.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomain.mesh.node_count()) * dimension));
  collectively(comm, [&] {
    for (std::size_t s = 0; s < f.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      if (const auto warmer = temperature_change(subdomain, state); warmer.any() && !subdomain.skin)
        fem::add_expansion(subdomain.mesh, materials(subdomain), deck_.kinematics, warmer, f[s], formulation(subdomain));
    }
  });
  for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
    const auto& load = deck_.loads[i];
    const double factor = state.load[i];
    if (factor == 0 || load.temperature_change || !load.coupling.empty() || !load.points.empty()) continue;
    if (load.acceleration) {
      const auto on_body = bodies_named(load.body);
      for (std::size_t s = 0; s < f.size(); ++s)
        if (const auto& subdomain = decomposition_.subdomains[s];
            on_body[static_cast<std::size_t>(subdomain.body)] && !subdomain.skin)
          fem::add_acceleration(subdomain.mesh, deck_.kinematics, materials(subdomain), Point(factor * place(*load.acceleration)),
                                f[s]);
      continue;
    }
    if (load.centrifugal) {
      const auto on_body = bodies_named(load.body);
      for (std::size_t s = 0; s < f.size(); ++s)
        if (const auto& subdomain = decomposition_.subdomains[s]; on_body[static_cast<std::size_t>(subdomain.body)])
          fem::add_acceleration(
              subdomain.mesh, deck_.kinematics, materials(subdomain),
              [&](const Point& x) { return Point(factor * fem::centrifugal_acceleration(*load.centrifugal, x)); }, f[s]);
      continue;
    }
    add_boundary_load(i, state, f, comm);
  }
  add_distributed(couplings(state, comm), f, comm);
  add_point_forces(state, f, comm);
  return f;
}

std::vector<double> Model::opposed_loads(const LoadState& state, const Communicator& comm) const
{
  constexpr double rounding = 1e-9;
  std::vector<double> sums(4 * decomposition_.catalogue.bodies.size(), 0.0);  // of each body the resultant and the sum of sizes
  collectively(comm, [&] {
    for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
      const auto& load = deck_.loads[i];
      if (state.load[i] == 0 || (!load.pressure && !load.traction)) continue;
      const auto [boundary, on_body] = select(load.boundary);
      const auto traction = traction_of(i, state);
      for (const auto& subdomain : decomposition_.subdomains) {
        if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
        double* const sum = &sums[4 * static_cast<std::size_t>(subdomain.body)];
        const auto visit = [&](std::span<const Local> nodes, const Eigen::VectorXd& shape, const Point& area) {
          Point x = Point::Zero();
          for (std::size_t n = 0; n < nodes.size(); ++n)
            x += shape[static_cast<Eigen::Index>(n)] * subdomain.mesh.points[static_cast<std::size_t>(nodes[n])];
          Point force = Point::Zero();
          if (load.pressure) force += pressure_at(i, state, x) * area;
          if (load.traction) force += traction(x) * area.norm();
          for (int c = 0; c < 3; ++c) sum[c] += force[c];
          sum[3] += force.norm();
        };
        fem::for_each_point_of_boundary(subdomain.mesh, boundary, deck_.kinematics, visit);
      }
    }
  });
  comm.sum_in_place(sums);
  std::vector<double> result(sums.size() / 4, 0.0);
  for (std::size_t b = 0; b < result.size(); ++b) {
    const double* const sum = &sums[4 * b];
    const double cancels = sum[3] - std::hypot(sum[0], sum[1], sum[2]);
    if (cancels > rounding * sum[3]) result[b] = cancels;
  }
  return result;
}

void Model::add_point_forces(const LoadState& state, std::vector<Eigen::VectorXd>& f, const Communicator& comm) const
{
  const auto places = nodes_at_points(comm);
  const int dimension = deck_.dimension();
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
    for (const auto& found : places.loads[i]) {
      if (found.subdomain < 0 || decomposition_.rank_of(found.subdomain) != comm.rank()) continue;
      const auto s = static_cast<std::size_t>(found.subdomain - decomposition_.subdomains.front().id);
      const Point force = state.load[i] * found.share * along_model(deck_.loads[i], deck_.loads[i].force);
      f[s].segment(found.local * dimension, dimension) += force.head(dimension);
    }
}

Point Model::along_model(const fem::LoadOptions& load, const std::optional<std::array<double, 3>>& value) const
{
  if (!value) return Point::Zero();
  if (load.axes.empty()) return place(*value);
  return local_axes(deck_, load.axes).at(Point::Zero())->transpose() * place(*value);
}

double Model::load_at(std::size_t index, const deck::Formula& formula, const LoadState& state, const Point& x) const
{
  const double found = formula(x, state.time);
  if (!std::isfinite(found))
    throw Error(ExitStatus::bad_input, fmt::format("loads[{}]: \"{}\" is no number at ({:.6g}, {:.6g}, {:.6g}), t = {:.6g}",
                                                   index, formula.text(), x[0], x[1], x[2], state.time));
  return state.load[index] * found;
}

double Model::pressure_at(std::size_t index, const LoadState& state, const Point& x) const
{
  return load_at(index, *deck_.loads[index].pressure, state, x);
}

std::function<Point(const Point&)> Model::traction_of(std::size_t index, const LoadState& state) const
{
  const auto& load = deck_.loads[index];
  if (!load.traction) return {};
  std::optional<deck::LocalAxes> axes;
  if (!load.axes.empty()) axes = local_axes(deck_, load.axes);
  return [this, index, &load, &state, axes, t = *load.traction](const Point& x) {
    const Point along(load_at(index, t[0], state, x), load_at(index, t[1], state, x), load_at(index, t[2], state, x));
    if (!axes) return along;
    const auto rows = axes->at(x);
    if (!rows)
      throw Error(ExitStatus::bad_input, fmt::format("loads[{}]: ({:.6g}, {:.6g}, {:.6g}) lies on the axis of \"{}\", where "
                                                     "nothing is radial or tangential",
                                                     index, x[0], x[1], x[2], load.axes));
    return Point(rows->transpose() * along);
  };
}

// Pressure, traction or force of loads[index].
void Model::add_boundary_load(std::size_t index, const LoadState& state, std::vector<Eigen::VectorXd>& f,
                              const Communicator& comm) const
{
  const auto& load = deck_.loads[index];
  const double factor = state.load[index];
  const auto [boundary, on_body] = select(load.boundary);
  double area = 0;
  for (const auto& subdomain : decomposition_.subdomains)
    if (on_body[static_cast<std::size_t>(subdomain.body)]) area += fem::area(subdomain.mesh, boundary, deck_.kinematics);
  area = comm.sum(area);
  if (area == 0) throw Error(ExitStatus::bad_input, "the loaded boundary \"" + load.boundary + "\" has no area");
  const auto traction = traction_of(index, state);
  collectively(comm, [&] {
    for (std::size_t s = 0; s < f.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      if (load.pressure)
        fem::add_pressure(
            subdomain.mesh, boundary, deck_.kinematics, [&](const Point& x) { return pressure_at(index, state, x); }, f[s]);
      if (load.traction) fem::add_traction(subdomain.mesh, boundary, deck_.kinematics, traction, f[s]);
      if (load.force)
        fem::add_traction(subdomain.mesh, boundary, deck_.kinematics, Point(factor * along_model(load, load.force) / area), f[s]);
    }
  });
}

}  // namespace mortise::model
