#include "analysis/probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "io/point_file.hpp"
#include "io/section.hpp"
#include "mesh/curved_surface.hpp"
#include "mesh/inverse_map.hpp"
#include "model/patterns.hpp"
#include "post/bodies.hpp"

namespace mortise::analysis {

namespace {

constexpr double usual_part = 0.02;     // of a body's size: that of the triangles of a section
constexpr double rounding = 1e-9;       // of a body's size: how far a node of the plane may be off it
constexpr double most_triangles = 2e6;  // of a section, on all ranks
constexpr std::size_t most_told = 10;   // points in no body

Point point_of(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

// The deck's points; of those of a file with their lines, else 0. What is wrong with the file goes to the document.
std::vector<io::ListedPoint> listed_points(const model::Deck& deck, deck::Document& document, const Communicator& comm)
{
  const auto& interior = deck.output.interior;
  std::vector<io::ListedPoint> result;
  for (const auto& x : interior.points) result.push_back({point_of(x), 0});
  if (interior.point_file.empty()) return result;
  try {
    return io::read_points(interior.point_file, deck.dimension(), comm);
  } catch (const Error& error) {
    document.error("output.interior.points", error.what());
    return {};
  }
}

void find(const model::Model& model, deck::Document& document, const Communicator& comm, post::Probes& probes)
{
  const auto& deck = model.deck();
  const auto listed = listed_points(deck, document, comm);
  if (listed.empty()) return;
  std::vector<Point> points;
  for (const auto& point : listed) points.push_back(point.at);
  auto found = post::find_points(model.decomposition(), deck.kinematics, points, comm);
  for (std::size_t i = 0; i < found.lost.size(); ++i) {
    const auto& [point, distance, body] = found.lost[i];
    const auto& [x, line] = listed[point];
    const auto path = line == 0 ? fmt::format("output.interior.points[{}]", point) : "output.interior.points";
    const auto where = line == 0 ? "" : fmt::format("{}:{}: ", deck.output.interior.point_file, line);
    if (i == most_told) {
      document.error(path, fmt::format("{}lies in no body, as do {} others after it", where, found.lost.size() - i - 1));
      break;
    }
    document.error(
        path,
        fmt::format("{}the point ({:.6g}, {:.6g}, {:.6g}) lies in no body; the nearest node, of \"{}\", is {:.4g} away", where,
                    x[0], x[1], x[2], model.decomposition().catalogue.bodies[static_cast<std::size_t>(body)].name, distance));
  }
  probes.points = std::move(found.mine);
  probes.rows = found.rows;
}

// Points and paths of named probes. Of a path, which may cross gaps and holes, one point in a body is enough.
void find_samples(const model::Model& model, deck::Document& document, const Communicator& comm, post::Probes& probes)
{
  const auto& deck = model.deck();
  std::vector<Point> points;
  std::vector<std::pair<const std::string*, const io::ProbeOptions*>> probe_of;  // of each point
  for (const auto& [name, probe] : deck.output.probes)
    for (const auto& x : probe.points()) {
      points.push_back(point_of(x));
      probe_of.emplace_back(&name, &probe);
    }
  if (points.empty()) return;
  auto found = post::find_points(model.decomposition(), deck.kinematics, points, comm);
  std::map<std::string, std::size_t> lost_of_path;
  for (const auto& [point, distance, body] : found.lost) {
    const auto& [name, probe] = probe_of[point];
    const auto where = [&, d = distance, b = body](const Point& x, const char* what) {
      return fmt::format("{} ({:.6g}, {:.6g}, {:.6g}) lies in no body; the nearest node, of \"{}\", is {:.4g} away", what, x[0],
                         x[1], x[2], model.decomposition().catalogue.bodies[static_cast<std::size_t>(b)].name, d);
    };
    if (!probe->is_path())
      document.error("output.probes." + *name + ".point", where(points[point], "the point"));
    else if (++lost_of_path[*name] == probe->points().size())
      document.error("output.probes." + *name, where(points[point], "no point of the path lies in a body; its end"));
  }
  probes.sampled = std::move(found.mine);
  probes.samples = found.rows;
}

// Where an extreme is looked for.
class Whereabouts {
 public:
  Whereabouts(const model::Model& model, const Communicator& comm)
      : model_(model), catalogue_(model.decomposition().catalogue), comm_(comm)
  {
    for (const auto& boundary : catalogue_.boundaries)  // not those that patterns made, or the geometry
      is_named_.push_back(!model::is_pattern(boundary) && !mesh::curved_surface(boundary));
  }

  post::ExtremeProbe find(const std::string& name, const io::ProbeOptions& options, deck::Document& document) const
  {
    post::ExtremeProbe probe;
    probe.quantity = *fem::quantity(options.quantity());
    probe.smallest = options.largest.empty();
    if (!options.axes.empty()) probe.axes = model::local_axes(model_.deck(), options.axes);
    const auto path = "output.probes." + name + (options.of.empty() ? "" : ".of");
    const bool of_contact = probe.quantity == fem::Quantity::pressure;
    const bool known = on_bodies(options.of, probe) || on_boundary(options.of, probe);
    if (of_contact)
      on_contacts(options.of, known, path, document, probe);
    else if (!known)
      document.error(
          path, fmt::format("the mesh has no body and no boundary \"{}\"{}", options.of, deck::suggestion(options.of, names())));
    return probe;
  }

 private:
  bool on_bodies(const std::string& of, post::ExtremeProbe& probe) const
  {
    for (const auto& body : catalogue_.bodies) probe.on_body.push_back(of.empty() || model::matches_name(body, of));
    return std::find(probe.on_body.begin(), probe.on_body.end(), true) != probe.on_body.end();
  }

  bool means(const std::string& of, int boundary, int body) const
  {
    const auto b = static_cast<std::size_t>(boundary);
    if (!is_named_[b]) return false;
    const auto& name = catalogue_.boundaries[b];
    if (of.find(':') == std::string::npos) return model::matches(of, name);
    const auto& on = catalogue_.bodies[static_cast<std::size_t>(body)];
    return model::matches(of, on.name + ":" + name) || model::matches(of, on.group + ":" + name) ||
           (!on.instance.empty() && model::matches(of, on.instance + ":" + name));
  }

  bool on_boundary(const std::string& of, post::ExtremeProbe& probe) const
  {
    bool any = false;
    for (const auto& subdomain : model_.decomposition().subdomains) {
      const auto& facets = subdomain.mesh.facets;
      auto& nodes = probe.nodes.emplace_back(subdomain.mesh.node_count(), false);
      for (std::size_t f = 0; f < facets.cells.size(); ++f) {
        if (!means(of, facets.boundary[f], subdomain.body)) continue;
        any = true;
        for (const Local n : facets.cells[f]) nodes[static_cast<std::size_t>(n)] = true;
      }
    }
    probe.on_body.assign(catalogue_.bodies.size(), true);
    return comm_.any(any);
  }

  // The nodes of secondary sides: of contacts of that name or, if there are none, of faces on the bodies or the boundary.
  void on_contacts(const std::string& of, bool known, const std::string& path, deck::Document& document,
                   post::ExtremeProbe& probe) const
  {
    const auto& contacts = model_.contacts();
    std::vector<std::string> contact_names;
    for (const auto& contact : contacts.options) contact_names.push_back(contact.name);
    std::vector<bool> meant;
    for (const auto& name : contact_names) meant.push_back(of.empty() || model::matches(of, name));
    const bool by_name = std::find(meant.begin(), meant.end(), true) != meant.end();
    if (!by_name && !known) {
      auto all = contact_names;
      for (auto& name : names()) all.push_back(std::move(name));
      document.error(path, contacts.size() == 0
                               ? "the model has no contact that has a pressure"
                               : fmt::format("there is no contact, body or boundary \"{}\"{}", of, deck::suggestion(of, all)));
      return;
    }
    const auto nodes_of_boundary = probe.nodes.empty() ? std::vector<std::vector<Global>>{} : faces_on(of);
    const auto means_face = [&](const mesh::Surface& side, std::size_t f) {
      return probe.nodes.empty()
                 ? probe.on_body[static_cast<std::size_t>(side.body[f])]
                 : std::binary_search(nodes_of_boundary.begin(), nodes_of_boundary.end(), ascending(side.faces[f], side.node_id));
    };
    bool any = false;
    const auto pairs = model_.contact_pairs(model::load_states(model_.deck(), contacts).front());
    for (std::size_t c = 0; c < pairs.size(); ++c) {
      const auto& side = pairs[c].secondary;
      auto& nodes = probe.contact_nodes.emplace_back(side.points.size(), by_name && meant[c]);
      any = any || (by_name && meant[c]);
      if (by_name) continue;
      for (std::size_t f = 0; f < side.faces.size(); ++f) {
        if (!means_face(side, f)) continue;
        any = true;
        for (const Local n : side.faces[f]) nodes[static_cast<std::size_t>(n)] = true;
      }
      if (!pairs[c].options.exchanged) continue;
      // Of what the deck calls secondary, the whole: the pressure is the same on either side.
      bool whole = true;
      for (std::size_t f = 0; f < pairs[c].primary->faces.size(); ++f) whole = whole && means_face(*pairs[c].primary, f);
      if (comm_.any(!whole)) continue;
      any = true;
      nodes.assign(nodes.size(), true);
    }
    if (!comm_.any(any))
      document.error(path, contacts.size() == 0
                               ? "the model has no contact that has a pressure"
                               : fmt::format("no contact has its secondary side, which has the pressures, on \"{}\"{}", of,
                                             deck::suggestion(of, contact_names)));
  }

  static std::vector<Global> ascending(std::span<const Local> face, const std::vector<Global>& node_id)
  {
    std::vector<Global> nodes;
    for (const Local n : face) nodes.push_back(node_id[static_cast<std::size_t>(n)]);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  // The faces on a boundary, ascending, each by its nodes.
  std::vector<std::vector<Global>> faces_on(const std::string& of) const
  {
    std::vector<std::vector<Global>> faces;
    for (const auto& subdomain : model_.decomposition().subdomains) {
      const auto& facets = subdomain.mesh.facets;
      for (std::size_t f = 0; f < facets.cells.size(); ++f)
        if (means(of, facets.boundary[f], subdomain.body)) faces.push_back(ascending(facets.cells[f], subdomain.mesh.node_id));
    }
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> result;
    for (const auto& body : catalogue_.bodies)
      for (const auto& name : {body.name, body.instance, body.group})
        if (!name.empty() && std::find(result.begin(), result.end(), name) == result.end()) result.push_back(name);
    for (std::size_t b = 0; b < catalogue_.boundaries.size(); ++b)
      if (is_named_[b]) result.push_back(catalogue_.boundaries[b]);
    return result;
  }

  const model::Model& model_;
  const mesh::Catalogue& catalogue_;
  const Communicator& comm_;
  std::vector<bool> is_named_;
};

// The heights of a subdomain's nodes over a plane, zero within rounding.
std::vector<double> heights(const mesh::Mesh& mesh, const Point& origin, const Point& normal, double zero)
{
  std::vector<double> result;
  for (const auto& p : mesh.points) {
    const double height = normal.dot(p - origin);
    result.push_back(std::abs(height) <= zero ? 0 : height);
  }
  return result;
}

double area(const io::Section& section)
{
  double sum = 0;
  const auto point = [&](Local p) -> const Point& { return section.points[static_cast<std::size_t>(p)]; };
  for (const auto& t : section.triangles) sum += (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0])).norm() / 2;
  return sum;
}

// The points of a section as places; where materials meet, one for each.
void append(const io::Section& section, const model::Model& model, std::size_t s, post::PlaneSection& to)
{
  const auto& subdomain = model.decomposition().subdomains[s];
  const auto& mesh = post::solid(subdomain);
  const auto materials = model.materials(subdomain);
  std::map<std::pair<Local, std::size_t>, Local> place;  // of a point and a material
  std::vector<Point> nodes;
  for (std::size_t t = 0; t < section.triangles.size(); ++t) {
    auto& triangle = to.triangles.emplace_back();
    const auto cell = static_cast<std::size_t>(section.cell[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Local p = section.triangles[t][k];
      const auto [at, fresh] =
          place.emplace(std::pair(p, subdomain.skin ? 0 : materials.index(cell)), static_cast<Local>(to.places.size()));
      triangle[k] = at->second;
      if (!fresh) continue;
      const Point& x = section.points[static_cast<std::size_t>(p)];
      if (post::is_surface_alone(subdomain)) {
        to.places.push_back({s, cell, Point::Zero(), x});
        continue;
      }
      nodes.clear();
      for (const Local n : mesh.cells[cell]) nodes.push_back(mesh.points[static_cast<std::size_t>(n)]);
      to.places.push_back({s, cell, mesh::find_in_cell(mesh.cells.type[cell], nodes, x).reference, x});
    }
  }
}

post::PlaneSection section_of(const model::Model& model, const std::string& name, const io::PlaneOptions& plane,
                              const std::vector<double>& sizes, deck::Document& document, const Communicator& comm)
{
  const Point origin = point_of(plane.point), normal = point_of(plane.normal).normalized();
  const auto& subdomains = model.decomposition().subdomains;
  const auto height = [&](const partition::Subdomain& subdomain) {
    return heights(post::solid(subdomain), origin, normal, rounding * sizes[static_cast<std::size_t>(subdomain.body)]);
  };
  // Zeros count as above: a body that begins at the plane is cut the other way round.
  std::vector<double> below(sizes.size(), 0.0);
  for (const auto& subdomain : subdomains)
    for (const double h : height(subdomain))
      if (h < 0) below[static_cast<std::size_t>(subdomain.body)] = 1;
  comm.sum_in_place(below);
  const auto size_of = [&](const partition::Subdomain& subdomain) {
    return plane.size.value_or(usual_part * sizes[static_cast<std::size_t>(subdomain.body)]);
  };
  std::vector<io::Section> sections;
  double triangles = 0, square = 0;
  collectively(comm, [&] {
    for (const auto& subdomain : subdomains) {
      auto h = height(subdomain);
      if (below[static_cast<std::size_t>(subdomain.body)] == 0)
        for (double& value : h) value = -value;
      const auto& mesh = post::solid(subdomain);
      sections.push_back(post::is_surface_alone(subdomain) ? io::enclosed(mesh.points, mesh.cells, h, normal)
                                                           : io::cut(mesh.points, mesh.cells, h));
      if (!subdomain.skin) continue;
      const double own = area(sections.back());
      square += own;
      triangles += 4 * own / std::pow(size_of(subdomain), 2);
    }
  });
  triangles = comm.sum(triangles);
  square = comm.sum(square);
  if (triangles > most_triangles) {
    document.error("output.interior.planes." + name + ".size",
                   fmt::format("the section would have about {:.2g} triangles; expected a size of {:.2g} or more", triangles,
                               std::sqrt(4 * square / most_triangles)));
    return {};
  }
  post::PlaneSection result;
  collectively(comm, [&] {
    for (std::size_t s = 0; s < subdomains.size(); ++s) {
      if (subdomains[s].skin) sections[s] = io::refined(std::move(sections[s]), size_of(subdomains[s]));
      append(sections[s], model, s, result);
    }
  });
  return result;
}

}  // namespace

post::Probes find_probes(const model::Model& model, deck::Document& document, const Communicator& comm)
{
  const auto& interior = model.deck().output.interior;
  post::Probes probes;
  probes.cells = interior.cells;
  find(model, document, comm, probes);
  find_samples(model, document, comm, probes);
  const Whereabouts whereabouts(model, comm);
  for (const auto& [name, probe] : model.deck().output.probes)
    if (probe.is_extreme()) probes.extremes.push_back(whereabouts.find(name, probe, document));
  if (!interior.planes.empty()) {
    const auto sizes = post::body_sizes(model.decomposition(), model.deck().kinematics, comm);
    for (const auto& [name, plane] : interior.planes)
      probes.planes.push_back(section_of(model, name, plane, sizes, document, comm));
  }
  document.check();
  return probes;
}

std::vector<Warning> idle_planes(const model::Deck& deck, const post::Probes& probes, const Communicator& comm)
{
  std::vector<Warning> warnings;
  auto plane = deck.output.interior.planes.begin();
  for (const auto& section : probes.planes) {
    const auto& [name, options] = *plane++;
    if (comm.any(!section.triangles.empty())) continue;
    warnings.push_back({"idle_plane", fmt::format("the plane \"{}\" meets no body", name),
                        "look at the `point` and the `normal` of output.interior.planes." + name, point_of(options.point)});
  }
  return warnings;
}

}  // namespace mortise::analysis
