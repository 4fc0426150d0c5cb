// Faces on planes that supports hold along their normals alone, and what else acts there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "mesh/face_area.hpp"
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
  plane.normal = mesh::area_vector(mesh.points, nodes, mesh.facets.cells.type[facet]).normalized();
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

// Whether a facet belongs to the boundary of a name; each name is looked up once.
template <class Select>
auto selections(const Select& select)
{
  return
      [known = std::map<std::string, decltype(select(""))>(), select](const std::string& name, int boundary, int body) mutable {
        if (name.empty()) return false;
        auto at = known.find(name);
        if (at == known.end()) at = known.emplace(name, select(name)).first;
        return at->second.boundary == boundary && at->second.on_body[static_cast<std::size_t>(body)];
      };
}

// Collects what acts on the faces of this rank, which begin() names one after the other.
class FaceActions {
 public:
  // Facet `facet` of `mesh` is the next face.
  void begin(const mesh::Mesh& mesh, std::size_t facet)
  {
    mesh_ = &mesh;
    facet_ = facet;
    plane_ = plane_of(mesh, facet);
    face_ = partition::face_number(mesh, facet);
  }
  void add(const constraint::SupportOptions& options, const constraint::Support& support);
  void add(const fem::LoadOptions& load, const std::optional<deck::LocalAxes>& axes);
  void add_coupling() { note_all(Kind::coupled, plane_.normal, plane_.normal); }
  // The axis of revolution, a face beside the others: nodes not farther from it than `near` stay on it.
  void add_axis(const mesh::Mesh& mesh, double near)
  {
    for (std::size_t n = 0; n < mesh.node_count(); ++n)
      if (const Point& x = mesh.points[n]; std::abs(x[0]) <= near)
        found.push_back({mesh.node_id[n], array_of(x), {-1, 0, 0}, {-1, 0, 0}, near, -1, Kind::prescribed});
  }

  std::vector<FaceAction> found;

 private:
  std::span<const Local> nodes() const { return mesh_->facets.cells[facet_]; }
  void note(Local n, Kind kind, const Point& normal, const Point& direction)
  {
    const auto node = static_cast<std::size_t>(n);
    found.push_back(
        {mesh_->node_id[node], array_of(mesh_->points[node]), array_of(normal), array_of(direction), plane_.size, face_, kind});
  }
  void note_all(Kind kind, const Point& normal, const Point& direction)
  {
    for (const Local n : nodes()) note(n, kind, normal, direction);
  }

  const mesh::Mesh* mesh_ = nullptr;
  std::size_t facet_ = 0;  // the face in its mesh
  Global face_ = -1;
  Plane plane_;
};

// What a support prescribes, or its springs hold.
void FaceActions::add(const constraint::SupportOptions& options, const constraint::Support& support)
{
  if (support.normal && plane_.flat) note_all(Kind::prescribed, plane_.normal, plane_.normal);
  const auto prescribed =
      directions(*mesh_, facet_, support.axes, [&](std::size_t c) { return support.displacement[c].has_value(); });
  const bool normal =
      plane_.flat && prescribed.size() == nodes().size() &&
      std::all_of(prescribed.begin(), prescribed.end(), [&](const auto& d) { return along(d.second, plane_.normal); });
  for (const auto& [n, direction] : prescribed)
    if (normal)
      note(n, Kind::prescribed, support.axes ? plane_.normal : Point(std::round(direction.dot(plane_.normal)) * direction),
           direction);
    else if (!along(direction, plane_.normal))
      note(n, Kind::tangential, plane_.normal, direction);
  const auto& springs = options.stiffness;
  for (int c = 0; c < 3; ++c)
    if (springs.tangential || springs.along[static_cast<std::size_t>(c)])
      note_all(Kind::tangential, plane_.normal, Point::Unit(c));
}

// A force or traction, in its axes.
void FaceActions::add(const fem::LoadOptions& load, const std::optional<deck::LocalAxes>& axes)
{
  const auto push = constant_push(load);
  if (push && push->isZero(0)) return;
  const auto pushes = [&](std::size_t c) {
    return !push && !((*load.traction)[c].is_constant() && (*load.traction)[c].constant() == 0);
  };
  for (const auto& [n, direction] : directions(*mesh_, facet_, axes, pushes)) note(n, Kind::pushed, plane_.normal, direction);
  for (const Local n : nodes())
    if (const auto rows = axes.value_or(deck::LocalAxes()).at(mesh_->points[static_cast<std::size_t>(n)]); push && rows)
      note(n, Kind::pushed, plane_.normal, (rows->transpose() * *push).normalized());
}

}  // namespace

std::vector<FaceAction> Model::face_actions(const LoadState& state, const Communicator& comm) const
{
  const auto supports = this->supports(state);
  auto selected = selections([this](const std::string& name) { return select(name); });
  std::vector<std::optional<deck::LocalAxes>> load_axes;
  for (const auto& load : deck_.loads)
    load_axes.push_back(load.axes.empty() ? std::nullopt : std::optional(local_axes(deck_, load.axes)));

  FaceActions actions;
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.cells.size(); ++f) {
      const auto here = [&](const std::string& name) { return selected(name, facets.boundary[f], subdomain.body); };
      actions.begin(subdomain.mesh, f);
      for (std::size_t i = 0; i < deck_.supports.size(); ++i)
        if (state.acting[i] && here(deck_.supports[i].boundary)) actions.add(deck_.supports[i], supports[i]);
      for (std::size_t i = 0; i < deck_.loads.size(); ++i)
        if (state.load[i] != 0 && here(deck_.loads[i].boundary)) actions.add(deck_.loads[i], load_axes[i]);
      for (const auto& [name, coupling] : deck_.couplings)
        if (here(coupling.boundary)) actions.add_coupling();
    }
  }
  if (deck_.axisymmetric()) {
    const double near = rounding(comm);
    for (const auto& subdomain : decomposition_.subdomains) actions.add_axis(subdomain.mesh, near);
  }
  return std::move(actions.found);
}

std::vector<FacePressure> Model::face_pressures(const LoadState& state) const
{
  auto selected = selections([this](const std::string& name) { return select(name); });
  std::vector<FacePressure> result;
  for (const auto& subdomain : decomposition_.subdomains) {
    const auto& mesh = subdomain.mesh;
    for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
      const auto here = [&](const std::string& name) { return selected(name, mesh.facets.boundary[f], subdomain.body); };
      const auto pushes = [&](std::size_t i) {
        return state.acting[i] && deck_.supports[i].stiffness.normal && here(deck_.supports[i].boundary);
      };
      bool unknown = false;
      for (std::size_t i = 0; i < deck_.supports.size(); ++i) unknown = unknown || pushes(i);
      std::vector<std::size_t> pressing;
      for (std::size_t i = 0; i < deck_.loads.size(); ++i)
        if (deck_.loads[i].pressure && state.load[i] != 0 && here(deck_.loads[i].boundary)) pressing.push_back(i);
      if (!unknown && pressing.empty()) continue;
      const auto normal = array_of(plane_of(mesh, f).normal);
      for (const Local n : mesh.facets.cells[f]) {
        const auto node = static_cast<std::size_t>(n);
        double pressure = unknown ? std::numeric_limits<double>::quiet_NaN() : 0;
        for (const std::size_t i : pressing)
          pressure += state.load[i] * (*deck_.loads[i].pressure)(mesh.points[node], state.time);
        if (!std::isfinite(pressure)) pressure = std::numeric_limits<double>::quiet_NaN();  // a formula may have no value there
        result.push_back({mesh.node_id[node], normal, pressure, partition::face_number(mesh, f)});
      }
    }
  }
  return result;
}

}  // namespace mortise::model
