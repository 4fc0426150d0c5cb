#include "contact/hanging_faces.hpp"

#include <algorithm>
#include <map>

#include "crossing/near_itself.hpp"
#include "pairing/facing.hpp"
#include "search/boxes.hpp"
#include "surface/bulge.hpp"
#include "surface/surface_nodes.hpp"

namespace mortise::contact {

namespace {

constexpr double looks_back = -0.8;  // cosine between normals: facets of curved surfaces
constexpr double near = 0.15;        // of the smaller face's size: facets stand out no more
constexpr double lies_on = 1e-4;     // of it, as for doubled faces
constexpr double fits = 0.25;        // of what the smooth surfaces stand out of both facets
constexpr double overlaps = 0.05;    // of it, and
constexpr double no_overlap = 1e-6;  // of a face's size: thin plates have faces that look away from each other
constexpr Global faces_of_cell = 6;  // see partition::face_number()

// Faces through their corners, to be looked up.
struct FlatFaces {
  std::vector<FaceGeometry> face;
  std::vector<Point> normal;
  std::vector<double> size;

  FlatFaces(const std::vector<Point>& points, const mesh::Cells& faces)
  {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      FaceGeometry corners{mesh::first_order(faces.type[f]), {}};
      for (std::size_t k = 0; k < at(mesh::corner_count(faces.type[f])); ++k) corners.nodes.push_back(points[at(faces[f][k])]);
      normal.push_back(corners.normal());
      size.push_back(corners.size());
      face.push_back(corners);
    }
  }
};

Box box_round(const Point& x, double reach)
{
  return {x - Point::Constant(reach), x + Point::Constant(reach)};
}

// Appends both numbers where the middle of one face is near another one of its body that looks back. Of `first`, `first` +
// `step`,
// ... each with all.
void add_near(const FlatFaces& flat, const std::vector<Global>& number, const std::vector<int>& body, std::size_t first,
              std::size_t step, std::vector<Global>& found)
{
  const Tree tree = tree_of(flat.face);
  std::vector<int> candidates;
  for (std::size_t f = first; f < flat.face.size(); f += step) {
    const Point middle = flat.face[f].centre();
    tree.candidates(box_round(middle, near * flat.size[f]), candidates);
    for (const int candidate : candidates) {
      const std::size_t g = at(candidate);
      if (body[g] != body[f] || !(flat.normal[f].dot(flat.normal[g]) < looks_back) ||
          number[f] / faces_of_cell == number[g] / faces_of_cell)
        continue;
      const auto hit = shoot(middle, flat.normal[f], flat.face[g]);
      if (hit.found && std::abs(hit.distance) <= near * std::min(flat.size[f], flat.size[g]))
        found.insert(found.end(), {number[f], number[g]});
    }
  }
}

// Faces that may lie on others, of all ranks. Collective.
std::vector<Global> near_others_of_body(const mesh::Surface& skin, fem::Kinematics kinematics, const Communicator& comm)
{
  std::vector<Global> found;
  add_near({skin.points, skin.faces}, skin.face_id, skin.body, 0, 1, found);
  if (comm.size() > 1) {
    const Skin seam = gather_skin(part_of(skin, near_other_ranks(skin, near, comm)), kinematics, comm);
    add_near({seam.side.points, seam.side.faces}, seam.face_id, seam.body, at(comm.rank()), at(comm.size()), found);
  }
  found = comm.all_gather(found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// The faces `chosen` and all round them, which tell their normals. Collective.
Skin with_neighbours(const mesh::Surface& skin, const std::vector<Global>& chosen, fem::Kinematics kinematics,
                     const Communicator& comm)
{
  std::vector<Global> nodes;
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    if (std::binary_search(chosen.begin(), chosen.end(), skin.face_id[f]))
      for (const Local n : skin.faces[f]) nodes.push_back(skin.node_id[at(n)]);
  nodes = comm.all_gather(nodes);
  std::sort(nodes.begin(), nodes.end());
  std::vector<std::size_t> near_them;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    const auto of_face = skin.faces[f];
    if (std::any_of(of_face.begin(), of_face.end(),
                    [&](Local n) { return std::binary_search(nodes.begin(), nodes.end(), skin.node_id[at(n)]); }))
      near_them.push_back(f);
  }
  return gather_skin(part_of(skin, near_them), kinematics, comm);
}

// Whether each corner of a face has one of another face at its place, with nodes of its own.
bool doubled(const Skin& skin, std::size_t face, std::size_t other)
{
  const auto& side = skin.side;
  const auto corners = [&](std::size_t f) {
    const auto nodes = side.faces[f];
    return nodes.first(at(mesh::corner_count(side.faces.type[f])));
  };
  const auto own = corners(face), others = corners(other);
  if (own.size() != others.size()) return false;
  bool shared = true;
  for (const Local n : own) {
    const auto twin = std::find_if(others.begin(), others.end(), [&](Local m) {
      return (side.points[at(m)] - side.points[at(n)]).norm() <= lies_on * skin.size[face];
    });
    if (twin == others.end()) return false;
    shared = shared && *twin == n;
  }
  return !shared;
}

}  // namespace

std::vector<HangingFaces> find_hanging_faces(const mesh::Surface& skin, fem::Kinematics kinematics, const Communicator& comm)
{
  const auto chosen = near_others_of_body(skin, kinematics, comm);
  if (chosen.empty()) return {};
  const Skin all = with_neighbours(skin, chosen, kinematics, comm);
  const auto surface_nodes = surface_nodes_of_facets(all.side, false);
  const auto size = [&](std::size_t facet) { return all.facet[facet].size(); };
  const Tree tree = tree_of(all.facet);
  std::map<std::array<Global, 2>, HangingFaces> found;  // by the face that has the middle, and the other
  for (std::size_t i = 0; i < all.facet.size(); ++i) {
    const auto f = at(all.side.face_of[i]);
    if (!std::binary_search(chosen.begin(), chosen.end(), all.face_id[f])) continue;
    const Point middle = all.facet[i].centre();
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    mean.head(static_cast<Eigen::Index>(all.facet[i].nodes.size()))
        .setConstant(1.0 / static_cast<double>(all.facet[i].nodes.size()));
    const double rise = Bulge(all.side, surface_nodes, i)(mean);
    for (const int candidate : tree.candidates(box_round(middle, near * size(i)))) {
      const std::size_t j = at(candidate), g = at(all.side.face_of[j]);
      if (g == f || all.body[g] != all.body[f] || all.face_id[f] / faces_of_cell == all.face_id[g] / faces_of_cell ||
          !(all.facet_normal[i].dot(all.facet_normal[j]) < looks_back))
        continue;
      const auto hit = shoot(middle, all.facet_normal[i], all.facet[j]);
      if (!hit.found) continue;
      const double other = Bulge(all.side, surface_nodes, j)(hit.shape), gap = hit.distance - rise - other;
      const double both = std::abs(rise) + std::abs(other), least = std::min(size(i), size(j));
      if (gap > fits * both + lies_on * least || gap < -overlaps * both - no_overlap * least || doubled(all, f, g)) continue;
      const auto [low, high] = std::minmax(all.face_id[f], all.face_id[g]);
      found.try_emplace({all.face_id[f], all.face_id[g]}, HangingFaces{all.body[f], {low, high}, all.face_id[f], middle});
    }
  }
  std::vector<HangingFaces> result;
  for (const auto& [faces, two] : found) result.push_back(two);
  return result;
}

}  // namespace mortise::contact
