#include "analysis/probes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/error.hpp"
#include "io/point_file.hpp"
#include "io/section.hpp"
#include "mesh/inverse_map.hpp"
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
