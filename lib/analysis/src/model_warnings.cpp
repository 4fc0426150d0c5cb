#include "model_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "model/doubled_nodes.hpp"
#include "model/patterns.hpp"
#include "post/bodies.hpp"

namespace mortise::analysis {

std::vector<Warning> idle_contacts(const Rows& rows, const Communicator& comm)
{
  std::vector<double> points(rows.pairs.size(), 0.0);
  for (const auto& point : rows.constraints.contacts.nodes) points[static_cast<std::size_t>(point.contact)] += 1;
  comm.sum_in_place(points);
  std::vector<const contact::Options*> idle;
  for (std::size_t c = 0; c < points.size(); ++c)
    if (!(points[c] > 0)) idle.push_back(&rows.pairs[c].options);
  if (idle.empty()) return {};
  constexpr std::size_t told = 6;
  std::string others;
  for (std::size_t i = 1; i < std::min(idle.size(), told); ++i) others += (i > 1 ? ", " : "; nor have ") + idle[i]->name;
  if (idle.size() > told) others += fmt::format(" and {} more", idle.size() - told);
  const auto& first = *idle.front();
  Warning w{
      "idle_contact",
      fmt::format("contact {} has no point: its surfaces do not face each other within the search distance, share less than "
                  "a hundredth of a cell, or are held by supports along their normals; nothing else keeps them apart{}",
                  first.name, others),
      first.cyclic ? "look at angle, axis and center of the sector and at the names, or set a larger search_distance"
                   : "look at the names, set a larger search_distance, or refine the secondary side"};
  w.contact = first.name;
  w.boundary = first.secondary;
  w.limit = 1;
  return {w};
}

namespace {

// The longest edge of the cells between two corners, with its middle. Collective.
post::Found longest_edge(const partition::Decomposition& decomposition, const Communicator& comm)
{
  post::Found longest;
  for (const auto& subdomain : decomposition.subdomains) {
    const auto& [points, cells] = std::tie(subdomain.mesh.points, subdomain.mesh.cells);
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (const auto& face : mesh::faces(cells.type[c])) {
        const auto corners = static_cast<std::size_t>(mesh::corner_count(face.type));
        for (std::size_t i = 0; i < corners; ++i) {
          const auto place = [&](std::size_t k) {
            return points[static_cast<std::size_t>(cells[c][static_cast<std::size_t>(face.nodes[k % corners])])];
          };
          longest.take((place(i + 1) - place(i)).norm(), (place(i) + place(i + 1)) / 2, subdomain.body);
        }
      }
  }
  return post::largest_of_ranks({longest}, comm).front();
}

std::string others_have_some(std::size_t bodies)
{
  return bodies > 2 ? fmt::format("; {} more bodies have some", bodies - 1) : bodies == 2 ? "; another body has some" : "";
}

}  // namespace

std::vector<Warning> coarser_than_asked(const model::Model& model, const Communicator& comm)
{
  constexpr double longer = 2;  // gmsh's own cells have edges up to some 1.6 times the size
  const auto& asked = model.deck().mesh.size.max;
  if (!asked) return {};
  const auto longest = longest_edge(model.decomposition(), comm);
  if (!(longest.value > longer * *asked)) return {};
  Warning w{
      "coarser_than_asked",
      fmt::format(
          "an edge of a cell is {:.4g} long at ({:.4g}, {:.4g}, {:.4g}), and mesh.size.max is {:.4g}: the geometry says itself "
          "where nodes lie there",
          longest.value, longest.at[0], longest.at[1], longest.at[2], *asked),
      "look for Transfinite, Layers and sizes in the .geo, or give it a constant"};
  w.at = longest.at;
  if (longest.body >= 0) w.body = model.decomposition().catalogue.bodies[static_cast<std::size_t>(longest.body)].name;
  w.value = longest.value;
  w.limit = longer * *asked;
  return {w};
}

std::vector<Warning> unconnected_faces(const model::Model& model, const Communicator& comm)
{
  const auto& bodies = model.decomposition().catalogue.bodies;
  const auto [doubled, hanging] = model::open_seams(model, comm);
  std::vector<Warning> result;
  const auto tell = [&](const char* kind, const auto& worst, long long count, const std::string& what, const char* cure) {
    const auto& body = mesh::whole_of(bodies[static_cast<std::size_t>(worst.body)]);
    Warning w{kind, fmt::format("body \"{}\" has {} {}", body, count, what), cure};
    w.at = worst.at;
    w.body = body;
    w.value = static_cast<double>(count);
    result.push_back(std::move(w));
  };
  const auto as_at = [](const Point& x) { return fmt::format("as at ({:.5g}, {:.5g}, {:.5g})", x[0], x[1], x[2]); };
  if (!doubled.empty()) {
    const auto& worst = doubled.front();
    tell("doubled_nodes", worst, worst.nodes,
         "nodes twice at the same place, " + as_at(worst.at) + ": its faces there are not connected" +
             others_have_some(doubled.size()),
         "merge the nodes in the mesher, or bond the two faces; name them in a contact if they are to be a crack");
  }
  if (!hanging.empty()) {
    const auto& worst = hanging.front();
    tell("hanging_nodes", worst, worst.faces,
         "faces inside that lie on others with other corners, " + as_at(worst.at) +
             ": the cells on either side are not connected there, or by some of their nodes alone" +
             others_have_some(hanging.size()),
         "mesh its parts together (BooleanFragments in gmsh) and with cells that fit, or make them two bodies and bond these; "
         "name "
         "the faces in a contact if they are to be a crack");
  }
  return result;
}

std::vector<Warning> uncovered_temperatures(const model::Model& model, const Communicator& comm)
{
  const auto& decomposition = model.decomposition();
  const auto& bodies = decomposition.catalogue.bodies;
  std::vector<Warning> result;
  for (const auto& [load, field] : model.temperatures()) {
    post::Found farthest{0};
    for (const auto& subdomain : decomposition.subdomains) {
      if (!model::matches_name(bodies[static_cast<std::size_t>(subdomain.body)], model.deck().loads[load].body)) continue;
      for (const auto& x : subdomain.mesh.points) farthest.take(field->outside(x), x, subdomain.body);
    }
    farthest = post::largest_of_ranks({farthest}, comm).front();
    if (!(farthest.value > 0)) continue;
    const auto& body = bodies[static_cast<std::size_t>(farthest.body)].name;
    Warning w{"uncovered_temperatures",
              fmt::format(
                  "nodes of body \"{}\" lie up to {:.3g} outside what {} covers, the farthest at ({:.4g}, {:.4g}, {:.4g}): their "
                  "temperatures are guessed",
                  body, farthest.value, field->path(), farthest.at[0], farthest.at[1], farthest.at[2]),
              "give temperatures of the whole body; look at the file's place and its unit of length"};
    w.at = farthest.at;
    w.body = body;
    w.value = farthest.value;
    result.push_back(std::move(w));
  }
  return result;
}

}  // namespace mortise::analysis
