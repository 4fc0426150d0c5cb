#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/error.hpp"
#include "bem/plane_state.hpp"
#include "bem/steklov_poincare.hpp"
#include "contact/cyclic.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "model/patterns.hpp"
#include "points.hpp"

namespace mortise::model {

namespace {

// A node nearer to the axis than this part of the radius of the model lies on it.
constexpr double on_the_axis = 1e-9;

Point point(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

}  // namespace

std::vector<bool> Model::bodies_named(const std::string& name) const
{
  std::vector<bool> result;
  for (const auto& body : decomposition_.catalogue.bodies) result.push_back(name.empty() || matches_name(body, name));
  return result;
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
  const auto& body = body_entry(deck_, catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->second;
  const auto placed = [&](const std::string& name) {
    auto material = deck_.materials.at(name);
    if (material.orthotropic && !material.orthotropic->axes.empty())
      material.directions = std::make_shared<const deck::LocalAxes>(local_axes(deck_, material.orthotropic->axes));
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
      sum += state.load[i] * point(*load.acceleration);
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

// A part of the largest distance from the axis of revolution; in other models from the origin.
double Model::rounding(const Communicator& comm) const
{
  double largest = 0;
  for (const auto& subdomain : decomposition_.subdomains)
    for (const auto& p : subdomain.mesh.points) largest = std::max(largest, deck_.axisymmetric() ? std::abs(p[0]) : p.norm());
  return on_the_axis * comm.max(largest);
}

void Model::require_formulations(deck::Document& document) const
{
  std::map<std::string, mesh::CellType> wrong;  // entry of the deck's section, a cell of it
  for (const auto& subdomain : decomposition_.subdomains)
    for (const auto type : subdomain.mesh.cells.type)
      if (!fem::applies(formulation(subdomain), type))
        wrong.emplace(body_entry(deck_, decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->first,
                      type);
  for (const auto& [body, type] : wrong)
    document.error("bodies." + body + ".formulation",
                   "this is not for the body's cells of type " + std::string(mesh::name(type)) +
                       "; bbar is for hex8, quad4 and prism6, incompatible for hex8 and quad4, standard for all");
}

void Model::require_axis(deck::Document& document, double rounding) const
{
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& points = subdomain.mesh.points;
    const auto leftmost =
        std::min_element(points.begin(), points.end(), [](const Point& a, const Point& b) { return a[0] < b[0]; });
    if (leftmost == points.end() || (*leftmost)[0] >= -rounding) continue;
    document.error(
        "dimension",
        fmt::format("body \"{}\" reaches to x = {:.4g}, beyond the axis of revolution x = 0; draw the half with x >= 0",
                    decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].name, (*leftmost)[0]));
    return;
  }
}

// Files with temperatures have to cover the nodes of their bodies.
void Model::require_temperatures(deck::Document& document) const
{
  for (const auto& [load, field] : temperatures_) {
    const auto on_body = bodies_named(deck_.loads[load].body);
    for (const auto& subdomain : decomposition_.subdomains) {
      if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      try {
        for (const auto& x : subdomain.mesh.points) (*field)(x);
      } catch (const Error& error) {
        const auto& body = decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
        document.error(fmt::format("loads[{}].temperature_change.file", load),
                       fmt::format("body \"{}\": {}", body.name, error.what()));
        break;
      }
    }
  }
}

void Model::require_fit(deck::Document& document, const Communicator& comm) const
{
  const double near = rounding(comm);
  std::vector<std::pair<std::string, std::string>> named;  // boundary, key
  for (std::size_t i = 0; i < deck_.supports.size(); ++i)
    named.emplace_back(deck_.supports[i].boundary, fmt::format("supports[{}].boundary", i));
  for (const auto& [name, coupling] : deck_.couplings) named.emplace_back(coupling.boundary, "couplings." + name + ".boundary");
  const std::size_t before_contacts = named.size();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    named.emplace_back(contacts_[i].secondary, contacts_.path(i) + ".secondary");
    named.emplace_back(contacts_[i].obstacle ? "" : contacts_[i].primary, contacts_.path(i) + ".primary");
  }
  std::vector<double> faces, common;  // of each; of each contact's two sides
  std::vector<Global> before;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i].first.empty()) {  // an obstacle, or the point of a coupling
      faces.push_back(1);
      common.push_back(0);
      continue;
    }
    const auto [index, on_body] = select(named[i].first);
    auto ids = partition::boundary_surface(decomposition_, index, on_body).face_id;
    faces.push_back(static_cast<double>(ids.size()));
    if (i < before_contacts) continue;
    std::sort(ids.begin(), ids.end());
    std::vector<Global> both;
    if ((i - before_contacts) % 2 == 1) {
      std::set_intersection(before.begin(), before.end(), ids.begin(), ids.end(), std::back_inserter(both));
      common.push_back(static_cast<double>(both.size()));
    }
    before = std::move(ids);
  }
  comm.sum_in_place(faces);
  comm.sum_in_place(common);
  collectively(comm, [&] {
    for (std::size_t i = 0; i < named.size(); ++i)
      if (faces[i] == 0)
        document.error(named[i].second,
                       fmt::format("\"{}\" has no face: its boundary does not lie on that body", named[i].first));
    for (std::size_t c = 0; c < common.size(); ++c)
      if (common[c] > 0)
        document.error(contacts_.path(c),
                       fmt::format("\"{}\" and \"{}\" have faces in common; contact of a surface with itself is not available",
                                   contacts_[c].secondary, contacts_[c].primary));
    require_formulations(document);
    if (deck_.axisymmetric()) require_axis(document, near);
    require_temperatures(document);
    document.check();
  });
  require_points(document, comm);
}

std::vector<partition::CopyOf> Model::congruent() const
{
  std::vector<int> kind;  // which of the different sets of materials of all cells and formulation
  std::map<std::pair<std::vector<std::string>, std::vector<std::size_t>>, int> kinds;
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& body = body_entry(deck_, decomposition_.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->second;
    const auto own = materials(subdomain);
    std::vector<std::size_t> detail{static_cast<std::size_t>(formulation(subdomain))};
    // An orthotropic piece is another one when it is turned, with cylindrical directions even when it is moved.
    for (std::size_t m = 0; m < own.count(); ++m)
      if (own[m].orthotropic) detail.push_back(static_cast<std::size_t>(subdomain.id));
    for (std::size_t c = 0; own.count() > 1 && c < subdomain.mesh.cells.size(); ++c) detail.push_back(own.index(c));
    kind.push_back(
        kinds.emplace(std::pair(material_names(body), std::move(detail)), static_cast<int>(kinds.size())).first->second);
  }
  return partition::congruent(decomposition_.subdomains, kind,
                              deck_.axisymmetric() ? partition::Motions::along_y : partition::Motions::rigid);
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
        fem::add_expansion(subdomain.mesh, materials(subdomain), deck_.kinematics, warmer, f[s]);
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
          fem::add_acceleration(subdomain.mesh, deck_.kinematics, materials(subdomain), Point(factor * point(*load.acceleration)),
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

void Model::add_point_forces(const LoadState& state, std::vector<Eigen::VectorXd>& f, const Communicator& comm) const
{
  const auto places = nodes_at_points(comm);
  const int dimension = deck_.dimension();
  for (std::size_t i = 0; i < deck_.loads.size(); ++i)
    for (const auto& found : places.loads[i]) {
      if (found.subdomain < 0 || decomposition_.rank_of(found.subdomain) != comm.rank()) continue;
      const auto s = static_cast<std::size_t>(found.subdomain - decomposition_.subdomains.front().id);
      const Point force = state.load[i] * found.share * force_of(deck_.loads[i]);
      f[s].segment(found.local * dimension, dimension) += force.head(dimension);
    }
}

// The resultant of a load along the axes of the model.
Point Model::force_of(const fem::LoadOptions& load) const
{
  const Point force = point(*load.force);
  if (load.axes.empty()) return force;
  return local_axes(deck_, load.axes).at(Point::Zero())->transpose() * force;
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
  const auto value = [&](const deck::Formula& formula, const Point& x) {
    const double found = formula(x, state.time);
    if (!std::isfinite(found))
      throw Error(ExitStatus::bad_input, fmt::format("loads[{}]: \"{}\" is no number at ({:.6g}, {:.6g}, {:.6g}), t = {:.6g}",
                                                     index, formula.text(), x[0], x[1], x[2], state.time));
    return factor * found;
  };
  std::optional<deck::LocalAxes> axes;
  if (!load.axes.empty()) axes = local_axes(deck_, load.axes);
  const auto turned = [&](const Point& along, const Point& x) {
    if (!axes) return along;
    const auto rows = axes->at(x);
    if (!rows)
      throw Error(ExitStatus::bad_input, fmt::format("loads[{}]: ({:.6g}, {:.6g}, {:.6g}) lies on the axis of \"{}\", where "
                                                     "nothing is radial or tangential",
                                                     index, x[0], x[1], x[2], load.axes));
    return Point(rows->transpose() * along);
  };
  collectively(comm, [&] {
    for (std::size_t s = 0; s < f.size(); ++s) {
      const auto& subdomain = decomposition_.subdomains[s];
      if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
      if (load.pressure)
        fem::add_pressure(
            subdomain.mesh, boundary, deck_.kinematics, [&](const Point& x) { return value(*load.pressure, x); }, f[s]);
      if (load.traction)
        fem::add_traction(
            subdomain.mesh, boundary, deck_.kinematics,
            [&, t = *load.traction](const Point& x) { return turned(Point(value(t[0], x), value(t[1], x), value(t[2], x)), x); },
            f[s]);
      if (load.force) fem::add_traction(subdomain.mesh, boundary, deck_.kinematics, Point(factor * force_of(load) / area), f[s]);
    }
  });
}

std::vector<constraint::Support> Model::supports(const LoadState& state) const
{
  std::vector<constraint::Support> supports;
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& options = deck_.supports[i];
    auto& support = supports.emplace_back();
    support.boundary = options.points.empty() ? options.boundary : "points";
    support.name = options.name;
    if (!options.axes.empty()) support.axes = local_axes(deck_, options.axes);
    if (!options.coupling.empty() || !state.acting[i]) continue;  // motions of points are those of their couplings
    const auto act = [&](const std::optional<deck::Formula>& value) -> std::optional<deck::Formula> {
      return value ? std::optional(value->at(state.support[i], state.time)) : std::nullopt;
    };
    for (std::size_t c = 0; c < 3; ++c) support.displacement[c] = act(options.displacement[c]);
    support.normal = act(options.normal);
  }
  if (deck_.axisymmetric()) {
    supports.emplace_back().boundary = "the axis of revolution";
    supports.back().displacement[0] = 0.0;
  }
  for (const auto& [name, coupling] : deck_.couplings) {
    supports.emplace_back().boundary = "coupling " + name;
    supports.back().name = name;
  }
  return supports;
}

std::vector<constraint::SupportNodes> Model::support_nodes(std::span<const constraint::Support> supports,
                                                           const Communicator& comm) const
{
  std::vector<constraint::SupportNodes> nodes(supports.size());
  const auto places = nodes_at_points(comm);
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    if (!support.points.empty()) {
      for (const auto& found : places.supports[i]) {
        if (found.subdomain < 0 || decomposition_.rank_of(found.subdomain) != comm.rank()) continue;
        nodes[i].id.push_back(found.node);
        nodes[i].at.push_back(found.at);
      }
    } else if (!support.boundary.empty()) {
      const auto [boundary, on_body] = select(support.boundary);
      auto surface = partition::boundary_surface(decomposition_, boundary, on_body);
      nodes[i] = {std::move(surface.node_id), std::move(surface.points)};
    }
  }
  if (!deck_.axisymmetric()) return nodes;
  const double near = rounding(comm);
  auto& on_axis = nodes[deck_.supports.size()];
  for (const auto& subdomain : decomposition_.subdomains)
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      if (std::abs(subdomain.mesh.points[n][0]) <= near) {
        on_axis.id.push_back(subdomain.mesh.node_id[n]);
        on_axis.at.push_back(subdomain.mesh.points[n]);
      }
  return nodes;
}

std::vector<mesh::Surface> Model::support_surfaces() const
{
  std::vector<mesh::Surface> surfaces;
  for (const auto& support : deck_.supports) {
    surfaces.emplace_back();
    if (!support.normal) continue;
    const auto [boundary, on_body] = select(support.boundary);
    surfaces.back() = partition::boundary_surface(decomposition_, boundary, on_body);
  }
  surfaces.resize(surfaces.size() + deck_.couplings.size());
  if (deck_.axisymmetric()) surfaces.emplace_back();
  return surfaces;
}

std::vector<mesh::Surface> Model::surfaces_held_along_normals(const LoadState& state) const
{
  std::vector<mesh::Surface> surfaces;
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    const bool on_springs = support.stiffness.normal && !support.stiffness.tangential;
    if (!state.acting[i] || !(support.normal || on_springs)) continue;
    const auto [boundary, on_body] = select(support.boundary);
    surfaces.push_back(partition::boundary_surface(decomposition_, boundary, on_body));
  }
  return surfaces;
}

Model::Facts Model::facts(const std::string& boundary, const Communicator& comm) const
{
  const auto [index, on_body] = select(boundary);
  std::vector<double> sums(4, 0.0);
  double softest = std::numeric_limits<double>::infinity();
  for (const auto& subdomain : decomposition_.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const auto moments = fem::moments(subdomain.mesh, index, deck_.kinematics);
    if (!(moments.area > 0)) continue;
    sums[3] += moments.area;
    for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += moments.first[c];
    const auto own = materials(subdomain);
    for (std::size_t m = 0; m < own.count(); ++m) softest = std::min(softest, own[m].modulus());
  }
  comm.sum_in_place(sums);
  softest = comm.min(softest);
  if (!(sums[3] > 0)) return {};
  return {sums[3], Point(sums[0], sums[1], sums[2]) / sums[3], softest};
}

std::vector<bool> Model::supported(const Communicator& comm) const
{
  std::vector<double> faces(decomposition_.catalogue.bodies.size(), 0.0);
  const auto places = nodes_at_points(comm);
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    if (!support.points.empty()) {
      for (const auto& found : places.supports[i])
        if (found.subdomain >= 0 && decomposition_.rank_of(found.subdomain) == comm.rank())
          faces[static_cast<std::size_t>(found.body)] += 1;
      continue;
    }
    const auto [boundary, on_body] =
        select(support.coupling.empty() ? support.boundary : deck_.couplings.at(support.coupling).boundary);
    for (const int body : partition::boundary_surface(decomposition_, boundary, on_body).body)
      faces[static_cast<std::size_t>(body)] += 1;
  }
  comm.sum_in_place(faces);
  std::vector<bool> result;
  for (const double count : faces) result.push_back(count > 0);
  return result;
}

std::vector<contact::Pair> Model::contact_pairs(const LoadState& state) const
{
  std::vector<contact::Pair> pairs;
  const auto surface = [&](const std::string& name) {
    const auto [boundary, on_body] = select(name);
    return partition::boundary_surface(decomposition_, boundary, on_body);
  };
  std::map<std::string, std::shared_ptr<const mesh::Surface>> primaries;  // the ring of many rollers stands here once
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto& contact = contacts_[c];
    pairs.push_back({contact, surface(contact.secondary), nullptr});
    pairs.back().options.interference *= state.contact[c];
    if (contact.obstacle) continue;
    if (contact.cyclic) {
      pairs.back().primary = std::make_shared<const mesh::Surface>(contact::rotated(surface(contact.primary), contact));
      continue;
    }
    auto& primary = primaries[contact.primary];
    if (!primary) primary = std::make_shared<const mesh::Surface>(surface(contact.primary));
    pairs.back().primary = primary;
  }
  return pairs;
}

std::vector<friction::Law> Model::friction_laws() const
{
  using Kind = friction::Law::Kind;
  std::vector<friction::Law> laws;
  for (const auto& contact : contacts_.options) {
    const Kind kind = contact.law == contact::Law::tresca    ? Kind::tresca
                      : contact.law == contact::Law::coulomb ? Kind::coulomb
                                                             : Kind::frictionless;
    laws.push_back({kind, contact.friction});
  }
  return laws;
}

std::vector<constraint::Preload> Model::preloads(const LoadState& state, const std::vector<double>& shortenings) const
{
  std::vector<constraint::Preload> preloads;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto& options = contacts_[c].preload;
    if (!options) continue;
    constraint::Preload preload{static_cast<int>(c), contacts_[c].name, {}, 0};
    if (state.locked[c])
      preload.shortening = shortenings[preloads.size()];
    else if (options->force)
      preload.force = state.contact[c] * *options->force;
    else
      preload.shortening = state.contact[c] * options->shortening.value_or(0);
    preloads.push_back(std::move(preload));
  }
  return preloads;
}

}  // namespace mortise::model
