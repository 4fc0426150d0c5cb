// Faces on planes that supports hold along their normals alone, and what else acts there.
#include <algorithm>
#include <cmath>
#include <map>

#include "model/model.hpp"
#include "partition/skin.hpp"

namespace mortise::model {

namespace {

constexpr double parallel = 1e-3;  // angle, of faces of a mesh

using Kind = FaceAction::Kind;

std::array<double, 3> array_of(const Point& x)
{
  return {x[0], x[1], x[2]};
}

struct Plane {
  Point normal;
  double size = 0;
  bool flat = true;
};

// The plane of a face of a cell or of an edge of a plane cell, which is turned out of its body.
Plane plane_of(const mesh::Mesh& mesh, std::size_t facet)
{
  const auto nodes = mesh.facets.cells[facet];
  const auto at = [&](std::size_t i) -> const Point& { return mesh.points[static_cast<std::size_t>(nodes[i])]; };
  const auto corners = static_cast<std::size_t>(mesh::corner_count(mesh.facets.cells.type[facet]));
  Plane plane;
  if (corners == 2)
    plane.normal = Point(at(1)[1] - at(0)[1], at(0)[0] - at(1)[0], 0);
  else
    plane.normal = corners == 3 ? (at(1) - at(0)).cross(at(2) - at(0)) : (at(2) - at(0)).cross(at(3) - at(1));
  plane.normal.normalize();
  for (std::size_t i = 0; i < corners; ++i)
    for (std::size_t j = 0; j < i; ++j) plane.size = std::max(plane.size, (at(i) - at(j)).norm());
  for (std::size_t i = 1; i < nodes.size(); ++i)
    plane.flat = plane.flat && std::abs((at(i) - at(0)).dot(plane.normal)) < parallel * plane.size;
  return plane;
}

// Directions at each node of a face along which something acts; none where it has no axes.
template <class Given>
std::vector<std::pair<Local, Point>> directions(const mesh::Mesh& mesh, std::size_t facet,
                                                const std::optional<deck::LocalAxes>& axes, const Given& given)
{
  std::vector<std::pair<Local, Point>> result;
  for (const Local n : mesh.facets.cells[facet]) {
    const auto rows = axes.value_or(deck::LocalAxes()).at(mesh.points[static_cast<std::size_t>(n)]);
    for (int c = 0; c < 3 && rows; ++c)
      if (given(static_cast<std::size_t>(c))) result.emplace_back(n, rows->row(c).transpose());
  }
  return result;
}

// The force or traction of a load, if it is the same everywhere in its axes.
std::optional<Point> constant_push(const fem::LoadOptions& load)
{
  Point push = Point::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    if (load.traction && !(*load.traction)[c].is_constant()) return {};
    push[static_cast<Eigen::Index>(c)] = load.force ? (*load.force)[c] : load.traction ? (*load.traction)[c].constant() : 0.0;
  }
  return push;
}

bool along(const Point& direction, const Point& normal)
{
  return direction.cross(normal).norm() < parallel;
}

}  // namespace

std::vector<FaceAction> Model::face_actions(const LoadState& state, const Communicator& comm) const
{
  const auto supports = this->supports(state);
  std::map<std::string, Selection> known;
  const auto selected = [&](const std::string& name, int boundary, int body) {
    if (name.empty()) return false;
    auto at = known.find(name);
    if (at == known.end()) at = known.emplace(name, select(name)).first;
    return at->second.boundary == boundary && at->second.on_body[static_cast<std::size_t>(body)];
  };
  std::vector<std::optional<deck::LocalAxes>> load_axes;
  for (const auto& load : deck_.loads)
    load_axes.push_back(load.axes.empty() ? std::nullopt : std::optional(local_axes(deck_, load.axes)));

  std::vector<FaceAction> actions;
  std::size_t face = 0;
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& mesh = subdomain.mesh;
    for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f, ++face) {
      const auto plane = plane_of(mesh, f);
      const auto here = [&](const std::string& name) { return selected(name, mesh.facets.boundary[f], subdomain.body); };
      const auto note = [&](Local n, Kind kind, const Point& normal, const Point& direction) {
        actions.push_back({mesh.node_id[static_cast<std::size_t>(n)], array_of(mesh.points[static_cast<std::size_t>(n)]),
                           array_of(normal), array_of(direction), plane.size, face, kind});
      };
      const auto note_all = [&](Kind kind, const Point& normal, const Point& direction) {
        for (const Local n : mesh.facets.cells[f]) note(n, kind, normal, direction);
      };
      for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
        const auto& options = deck_.supports[i];
        if (!state.acting[i] || !here(options.boundary)) continue;
        if (supports[i].normal && plane.flat) note_all(Kind::held, plane.normal, plane.normal);
        const auto held = directions(mesh, f, supports[i].axes,
                                     [&](std::size_t c) { return supports[i].displacement[c].has_value(); });
        const bool normal = plane.flat && held.size() == mesh.facets.cells[f].size() &&
                            std::all_of(held.begin(), held.end(), [&](const auto& d) { return along(d.second, plane.normal); });
        for (const auto& [n, direction] : held)
          if (normal)
            note(n, Kind::held, supports[i].axes ? plane.normal : Point(std::round(direction.dot(plane.normal)) * direction),
                 direction);
          else if (!along(direction, plane.normal))
            note(n, Kind::tangential, plane.normal, direction);
        const auto& springs = options.stiffness;
        for (int c = 0; c < 3; ++c)
          if (springs.tangential || springs.along[static_cast<std::size_t>(c)])
            note_all(Kind::tangential, plane.normal, Point::Unit(c));
      }
      for (std::size_t i = 0; i < deck_.loads.size(); ++i) {
        const auto& load = deck_.loads[i];
        if (state.load[i] == 0 || !here(load.boundary)) continue;
        const auto push = constant_push(load);
        if (push && push->isZero(0)) continue;
        const auto pushes = [&](std::size_t c) {
          return !push && !((*load.traction)[c].is_constant() && (*load.traction)[c].constant() == 0);
        };
        for (const auto& [n, direction] : directions(mesh, f, load_axes[i], pushes))
          note(n, Kind::pushed, plane.normal, direction);
        for (const Local n : mesh.facets.cells[f])
          if (const auto rows = load_axes[i].value_or(deck::LocalAxes()).at(mesh.points[static_cast<std::size_t>(n)]); push && rows)
            note(n, Kind::pushed, plane.normal, (rows->transpose() * *push).normalized());
      }
      for (const auto& [name, coupling] : deck_.couplings)
        if (here(coupling.boundary)) note_all(Kind::coupled, plane.normal, plane.normal);
    }
  }
  if (!deck_.axisymmetric()) return actions;
  const double near = rounding(comm);
  for (const auto& subdomain : decomposition_.subdomains)
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      if (const Point& x = subdomain.mesh.points[n]; std::abs(x[0]) <= near)
        actions.push_back({subdomain.mesh.node_id[n], array_of(x), {-1, 0, 0}, {-1, 0, 0}, near, face, Kind::held});
  return actions;
}

}  // namespace mortise::model
