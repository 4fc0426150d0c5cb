// Whether the mesh fits the deck: what `require_fit` checks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/error.hpp"
#include "model/model.hpp"
#include "model/patterns.hpp"

namespace mortise::model {

namespace {

// A node nearer to the axis than this part of the radius of the model lies on it.
constexpr double on_the_axis = 1e-9;
// Nodes of one surface in space, beyond which boundary elements take more than 4 GB and many minutes: V is 72 m^2 bytes for m = 2
// n triangles, and its factorization 9 m^3 operations.
constexpr std::size_t most_nodes_of_skin = 4000;

void require_small_skins(const partition::Decomposition& decomposition, const Deck& deck, deck::Document& document)
{
  std::map<std::string, std::size_t> large;  // entry of the deck's section, nodes of its largest piece
  for (const auto& subdomain : decomposition.subdomains) {
    const std::size_t nodes = subdomain.mesh.points.size();
    if (!subdomain.skin || decomposition.catalogue.dimension != 3 || nodes <= most_nodes_of_skin) continue;
    auto& most = large[body_entry(deck, decomposition.catalogue.bodies[static_cast<std::size_t>(subdomain.body)].group)->first];
    most = std::max(most, nodes);
  }
  for (const auto& [body, nodes] : large)
    document.error(
        "bodies." + body + ".method",
        fmt::format("boundary elements are for surfaces of up to {} nodes in a piece, and one here has {}: take a coarser "
                    "surface mesh, a body with cells, which is cut (decomposition.unknowns_per_subdomain), or "
                    "finite_elements",
                    most_nodes_of_skin, nodes));
}

}  // namespace

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
        document.error(
            contacts_.path(c),
            fmt::format("\"{}\" and \"{}\" have faces in common; contact of a surface with itself is not available. Of a "
                        "boundary that two bodies share, each side is `body:boundary`",
                        contacts_[c].secondary, contacts_[c].primary));
    require_formulations(document);
    require_small_skins(decomposition_, deck_, document);
    if (deck_.axisymmetric()) require_axis(document, near);
    require_temperatures(document);
    document.check();
  });
  require_points(document, comm);
}

}  // namespace mortise::model
