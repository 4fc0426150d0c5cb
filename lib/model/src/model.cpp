#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "bem/plane_state.hpp"
#include "bem/steklov_poincare.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "model/patterns.hpp"
#include "partition/skin.hpp"
#include "parts.hpp"
#include "points.hpp"

namespace mortise::model {

std::vector<bool> Model::bodies_named(const std::string& name) const
{
  std::vector<bool> result;
  for (const auto& body : decomposition_.catalogue.bodies) result.push_back(name.empty() || matches_name(body, name));
  return result;
}

const mesh::Surface& Model::outer_surface(const Communicator& comm) const
{
  if (!outer_surface_) outer_surface_ = partition::outer_surface(decomposition_, comm);
  return *outer_surface_;
}

Model::Selection Model::select(const std::string& name) const
{
  const auto [boundary, body] = parse_boundary(name);
  const auto& known = decomposition_.catalogue.boundaries;
  return {static_cast<int>(std::find(known.begin(), known.end(), boundary) - known.begin()), bodies_named(body)};
}

std::vector<std::string> material_names(const fem::BodyOptions& body)
{
  if (body.volumes.empty()) return {body.material};
  std::vector<std::string> names;
  for (const auto& [volume, material] : body.volumes)
    if (std::find(names.begin(), names.end(), material) == names.end()) names.push_back(material);
  return names;
}

fem::Materials Model::materials(const partition::Subdomain& subdomain) const
{
  const auto& catalogue = decomposition_.catalogue;
  const auto& named = catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
  const auto& body = body_entry(deck_, named.group)->second;
  const auto placed = [&](const std::string& name) {
    auto material = deck_.materials.at(name);
    if (!material.orthotropic) return material;
    const auto motion = motion_of(named, deck_);  // directions are those of the part, and go with its copies
    const auto& axes = material.orthotropic->axes;
    if (axes.empty() && !motion) return material;
    const auto of_part = axes.empty() ? deck::LocalAxes() : local_axes(deck_, axes);
    material.directions =
        std::make_shared<const deck::LocalAxes>(motion ? of_part.moved(motion->rotation, motion->translation) : of_part);
    return material;
  };
  if (body.volumes.empty()) return placed(body.material);
  // In every subdomain of a body the materials stand in the same order.
  const auto names = material_names(body);
  std::vector<fem::Material> materials;
  for (const auto& name : names) materials.push_back(placed(name));
  std::vector<int> of_volume, of_cell;
  for (const auto& volume : catalogue.volumes) {
    const auto own = body.volumes.find(volume);
    const auto found = own == body.volumes.end() ? names.begin() : std::find(names.begin(), names.end(), own->second);
    of_volume.push_back(static_cast<int>(found - names.begin()));
  }
  for (const int volume : subdomain.mesh.cell_volume) of_cell.push_back(of_volume[static_cast<std::size_t>(volume)]);
  return {std::move(materials), std::move(of_cell)};
}

std::size_t Model::most_materials() const
{
  std::size_t most = 1;
  for (const auto& [name, body] : deck_.bodies) most = std::max(most, material_names(body).size());
  return most;
}

fem::Formulation Model::formulation(const partition::Subdomain& subdomain) const
{
  return body_entry(deck_, decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->second.formulation;
}

fem::Temperature Model::temperature_change(const partition::Subdomain& subdomain, const LoadState& state) const
{
  fem::Temperature warmer;
  for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
    const auto& load = deck_.loads[i];
    if (!load.temperature_change || state.load[i] == 0 || !bodies_named(load.body)[static_cast<std::size_t>(subdomain.body)])
      continue;
    const auto& change = *load.temperature_change;
    if (change.is_constant()) {
      warmer.uniform += state.load[i] * change.formula.constant();
      continue;
    }
    if (change.file) {
      warmer.varying = [before = warmer.varying, factor = state.load[i], zero = change.file->reference,
                        field = temperatures_.at(i)](const Point& x) {
        return factor * ((*field)(x)-zero) + (before ? before(x) : 0);
      };
      continue;
    }
    warmer.varying = [before = warmer.varying, formula = change.formula.at(state.load[i], state.time), i](const Point& x) {
      const double value = formula(x, 0);
      if (!std::isfinite(value))
        throw Error(ExitStatus::bad_input, fmt::format("loads[{}]: \"{}\" is no number at ({:.6g}, {:.6g}, {:.6g})", i,
                                                       formula.text(), x[0], x[1], x[2]));
      return value + (before ? before(x) : 0);
    };
  }
  return warmer;
}

Point Model::acceleration(const partition::Subdomain& subdomain, const LoadState& state) const
{
  Point sum = Point::Zero();
  for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
    const auto& load = deck_.loads[i];
    if (load.acceleration && bodies_named(load.body)[static_cast<std::size_t>(subdomain.body)])
      sum += state.load[i] * place(*load.acceleration);
  }
  return sum;
}

std::vector<fem::Constitution> Model::constitution(const LoadState& state) const
{
  std::vector<fem::Constitution> result;
  for (const auto& subdomain : decomposition_.subdomains)
    result.push_back(
        {materials(subdomain), formulation(subdomain), temperature_change(subdomain, state), acceleration(subdomain, state)});
  return result;
}

std::vector<partition::CopyOf> Model::congruent() const
{
  std::vector<int> kind;  // which of the different sets of materials of all cells and formulation
  std::map<std::pair<std::vector<std::string>, std::vector<std::size_t>>, int> kinds;
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& body = body_entry(deck_, decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->second;
    const auto own = materials(subdomain);
    std::vector<std::size_t> detail{static_cast<std::size_t>(formulation(subdomain))};
    for (std::size_t c = 0; own.count() > 1 && c < subdomain.mesh.cells.size(); ++c) detail.push_back(own.index(c));
    kind.push_back(
        kinds.emplace(std::pair(material_names(body), std::move(detail)), static_cast<int>(kinds.size())).first->second);
  }
  // The directions of orthotropic materials have to be moved alike.
  const auto alike = [&](const partition::Subdomain& original, const partition::Subdomain& copy,
                         const Eigen::Matrix3d& rotation) {
    const auto first = materials(original), second = materials(copy);
    const Point& from = original.mesh.points.front();
    const Point& to = copy.mesh.points.front();
    const double size = (original.mesh.points.back() - from).norm();
    for (std::size_t m = 0; m < first.count(); ++m) {
      if (!first[m].orthotropic) continue;
      const auto directions = [](const fem::Material& material) {
        return material.directions ? *material.directions : deck::LocalAxes();
      };
      if (!directions(first[m]).moved(rotation, to - rotation * from).coincides(directions(second[m]), size)) return false;
    }
    return true;
  };
  const bool directed =
      std::any_of(deck_.materials.begin(), deck_.materials.end(), [](const auto& m) { return m.second.orthotropic.has_value(); });
  return partition::congruent(decomposition_.subdomains, kind,
                              deck_.axisymmetric() ? partition::Motions::along_y : partition::Motions::rigid,
                              directed ? alike : partition::Alike());
}

SparseMatrix Model::stiffness(const partition::Subdomain& subdomain) const
{
  try {
    return fem::stiffness(subdomain.mesh, materials(subdomain), deck_.kinematics, formulation(subdomain));
  } catch (const Error& error) {
    const auto& body = decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
    throw Error(error.status(), fmt::format("body \"{}\": {}", body.name, error.what()));
  }
}

Eigen::MatrixXd Model::steklov_poincare(const partition::Subdomain& subdomain) const
{
  try {
    const auto material = bem::in_plane(materials(subdomain)[0], deck_.kinematics);
    if (deck_.dimension() == 2) return bem::steklov_poincare(bem::make_panels<2>(subdomain.mesh), material);
    return bem::steklov_poincare(bem::make_panels(subdomain.mesh), material);
  } catch (const Error& error) {
    const auto& body = decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
    throw Error(error.status(), fmt::format("body \"{}\": {}", body.name, error.what()));
  }
}

Model::Facts Model::facts(const std::string& boundary, const Communicator& comm) const
{
  const auto [index, on_body] = select(boundary);
  std::vector<double> sums(5, 0.0);
  double softest = std::numeric_limits<double>::infinity();
  for (const auto& subdomain : decomposition_.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const auto moments = fem::moments(subdomain.mesh, index, deck_.kinematics);
    if (!(moments.area > 0)) continue;
    sums[3] += moments.area;
    for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += moments.first[c];
    const auto own = materials(subdomain);
    double own_softest = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < own.count(); ++m) own_softest = std::min(own_softest, own[m].modulus());
    softest = std::min(softest, own_softest);
    sums[4] += moments.area * own_softest;
  }
  comm.sum_in_place(sums);
  softest = comm.min(softest);
  if (!(sums[3] > 0)) return {};
  return {sums[3], Point(sums[0], sums[1], sums[2]) / sums[3], softest, sums[4] / sums[3]};
}

}  // namespace mortise::model
