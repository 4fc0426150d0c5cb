#include "shear_free_nodes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "at_nodes.hpp"
#include "mesh/shape_functions.hpp"
#include "nodes_in_rows.hpp"
#include "planes_at_copies.hpp"
#include "sent_points.hpp"

namespace mortise::analysis {

namespace {

constexpr double one_surface = 0.65;     // cosine of the angle between faces of one curved surface
constexpr double same_plane = 1 - 1e-9;  // the same, but for rounding
constexpr double reentrant = 0.02;       // sine of the angle by which a face rises out of the plane of another
constexpr double about_right = 0.3;      // cosine: facets of curved surfaces tilt by so much where they end at a plane

// A face at one of its nodes.
struct FaceAtNode {
  Global node, face;
  std::array<double, 3> normal, to_middle;  // unit normal out of the body; from the node to the middle of the face
  double area;                              // over that of the reference face
  bool plane;
};

// Faces that make one surface.
struct SurfacePart {
  Point normal = Point::Zero(), to_middle = Point::Zero();  // sums, weighted by area
  bool flat = true;
};

// A face of the surface: its corners, and the normal of the curved face at each node.
class FaceNormals {
 public:
  FaceNormals(const mesh::Surface& surface, std::size_t face)
      : functions_(mesh::shape_functions(surface.faces.type[face])), corners_(mesh::corner_count(surface.faces.type[face]))
  {
    for (const Local n : surface.faces[face]) at_.push_back(surface.points[static_cast<std::size_t>(n)]);
    for (int i = 0; i < corners_; ++i) middle_ += at_[static_cast<std::size_t>(i)] / corners_;
  }

  const Point& middle() const { return middle_; }
  bool plane() const
  {
    const Point first = normal(0).normalized();
    for (std::size_t i = 1; i < at_.size(); ++i)
      if (!(normal(i).normalized().dot(first) > same_plane)) return false;
    return true;
  }
  // Length: area per area of the reference face.
  Point normal(std::size_t node) const
  {
    Eigen::VectorXd value(functions_.count());
    Eigen::MatrixXd gradient;
    functions_.evaluate(functions_.nodes()[node], value, &gradient);
    std::array<Point, 2> along{Point::Zero(), Point::UnitZ()};  // of an edge of a plane cell: across the plane
    for (Eigen::Index a = 0; a < gradient.cols(); ++a) {
      Point& tangent = along[static_cast<std::size_t>(a)];
      tangent.setZero();
      for (std::size_t i = 0; i < at_.size(); ++i) tangent += gradient(static_cast<Eigen::Index>(i), a) * at_[i];
    }
    return along[0].cross(along[1]);
  }

 private:
  const mesh::ShapeFunctions& functions_;
  int corners_;
  std::vector<Point> at_;
  Point middle_ = Point::Zero();
};

// On the homes of the nodes, ascending. Collective.
std::vector<FaceAtNode> faces_at_nodes(const mesh::Surface& surface, const partition::NodeHomes& homes, const Communicator& comm)
{
  std::vector<std::vector<FaceAtNode>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto nodes = surface.faces[f];
    const FaceNormals face(surface, f);
    const bool plane = face.plane();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto at = static_cast<std::size_t>(nodes[i]);
      const Global node = surface.node_id[at];
      const Point normal = face.normal(i);
      const double size = normal.norm();
      if (!(size > 0)) continue;
      send[homes(node)].push_back(
          {node, surface.face_id[f], components(normal / size), components(face.middle() - surface.points[at]), size, plane});
    }
  }
  return by_node_and_face(send, comm);
}

// What acts at a node: on a plane that it may slide along, with this normal, or something that may act along faces.
struct Touch {
  Global node;
  bool along_faces;
  std::array<double, 3> normal;
};

// On the homes of the nodes, ascending. Collective.
std::vector<Touch> touches(const model::Model& model, const Rows& rows, const partition::NodeHomes& homes,
                           const Communicator& comm)
{
  std::vector<std::vector<Touch>> send(static_cast<std::size_t>(comm.size()));
  const auto touch = [&](const Touch& t) { send[homes(t.node)].push_back(t); };
  for (const auto& action : model.face_actions(rows.acts, comm))
    touch({action.node, action.kind != model::FaceAction::Kind::prescribed, action.normal});
  for (const Global node : nodes_in_rows(rows.constraints.contacts)) touch({node, true, {}});
  std::vector<Touch> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::ranges::sort(result, {}, &Touch::node);
  return result;
}

// The normals of the surfaces that meet at a node, those of curved ones at right angles to the others; none at a reentrant edge,
// nor where they meet at other angles. `planes`: that the node slides along.
std::vector<Point> normals_of_surfaces(std::span<const FaceAtNode> faces, std::span<const Touch> planes)
{
  std::vector<SurfacePart> parts;
  for (const auto& face : faces) {
    const Point normal = point(face.normal);
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const SurfacePart& p) { return p.normal.normalized().dot(normal) > one_surface; });
    if (part == parts.end()) part = parts.insert(parts.end(), SurfacePart());
    part->flat = part->flat && face.plane && (part->normal.isZero(0) || part->normal.normalized().dot(normal) > same_plane);
    part->normal += face.area * normal;
    part->to_middle += face.area * point(face.to_middle);
  }
  std::vector<Point> result;
  // A facet of a curved surface that ends at a plane is flat as well.
  const auto is_plane = [&](const SurfacePart& part) {
    return std::ranges::any_of(
        planes, [&](const Touch& plane) { return point(plane.normal).dot(part.normal.normalized()) > same_plane; });
  };
  std::ranges::stable_sort(parts, {}, [&](const SurfacePart& part) { return is_plane(part) ? 0 : part.flat ? 1 : 2; });
  for (const auto& part : parts) {
    Point normal = part.normal.normalized();
    for (const Point& other : result) {
      if (std::abs(normal.dot(other)) > about_right) return {};
      normal = (normal - normal.dot(other) * other).normalized();
    }
    result.push_back(normal);
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < parts.size(); ++j)
      if (i != j && parts[j].to_middle.dot(result[i]) > reentrant * parts[j].to_middle.norm()) return {};
  return result;
}

// On the homes of the nodes, ascending. Collective.
std::vector<model::FacePressure> pressures_at_nodes(const model::Model& model, const model::LoadState& acts,
                                                    const partition::NodeHomes& homes, const Communicator& comm)
{
  std::vector<std::vector<model::FacePressure>> send(static_cast<std::size_t>(comm.size()));
  for (const auto& pressed : model.face_pressures(acts)) send[homes(pressed.node)].push_back(pressed);
  std::vector<model::FacePressure> result;
  for (const auto& part : comm.exchange(send)) result.insert(result.end(), part.begin(), part.end());
  std::ranges::stable_sort(result, {}, &model::FacePressure::node);
  return result;
}

// What acts at a node across the faces with this normal: not a number where a support holds it, or where loads end.
double traction_across(const Point& normal, std::span<const FaceAtNode> faces, std::span<const Touch> planes,
                       std::span<const model::FacePressure> pressures)
{
  const auto is_of = [&](const auto& face) { return point(face.normal).dot(normal) > one_surface; };
  double pressure = 0;
  for (const auto& pressed : pressures)
    if (is_of(pressed)) pressure += pressed.pressure;
  const auto count = std::ranges::count_if(faces, is_of);
  const bool ends = std::ranges::count_if(pressures, is_of) % std::max<std::ptrdiff_t>(count, 1) != 0;
  if (count == 0 || ends || std::ranges::any_of(planes, is_of)) return std::numeric_limits<double>::quiet_NaN();
  return -pressure / static_cast<double>(count);
}

}  // namespace

std::vector<std::vector<post::SymmetricNode>> find_shear_free_nodes(const model::Model& model, const Rows& rows,
                                                                    const partition::NodeHomes& homes, const Communicator& comm)
{
  const auto faces = faces_at_nodes(model.outer_surface(comm), homes, comm);
  const auto touched = touches(model, rows, homes, comm);
  const auto pressures = pressures_at_nodes(model, rows.acts, homes, comm);
  std::vector<Global> nodes;
  std::vector<std::vector<Point>> normals;
  std::vector<std::vector<double>> tractions;
  for (std::size_t i = 0, end = 0; i < faces.size(); i = end) {
    while (end < faces.size() && faces[end].node == faces[i].node) ++end;
    const auto here = std::ranges::equal_range(touched, faces[i].node, {}, &Touch::node);
    if (std::ranges::any_of(here, &Touch::along_faces)) continue;
    const auto own = std::span(faces).subspan(i, end - i);
    auto found = normals_of_surfaces(own, {here.begin(), here.end()});
    if (found.empty()) continue;
    const auto pressing = std::ranges::equal_range(pressures, faces[i].node, {}, &model::FacePressure::node);
    auto& across = tractions.emplace_back();
    for (const Point& normal : found)
      across.push_back(traction_across(normal, own, {here.begin(), here.end()}, {pressing.begin(), pressing.end()}));
    nodes.push_back(faces[i].node);
    normals.push_back(std::move(found));
  }
  return planes_at_copies(nodes, normals, model.decomposition(), homes, comm, tractions);
}

}  // namespace mortise::analysis
