#include "pairing/skin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "search/boxes.hpp"

namespace mortise::contact {

namespace {

// Part of the smaller body's diagonal over which a zone of contact can grow. Hertz: at its border the surfaces of a sphere of
// radius R were a^2 / 2R apart, which is 0.07 R for a = 0.37 R.
constexpr double part_of_body = 0.02;
// Faces round those within reach that normals depend on, as in share_out().
constexpr double rings_of_patches = 9;
// Parts of a rank's piece of a body that the other ranks are told of.
constexpr std::size_t most_boxes = 64;

// A box round some faces of one body.
struct Part {
  std::array<double, 6> box;
  double size;  // of its largest face
  int body;
};

// Of all ranks. Collective.
std::vector<Part> parts_of(const mesh::Surface& skin, const std::vector<Box>& boxes, const std::vector<double>& sizes,
                           const Communicator& comm)
{
  std::map<int, std::vector<int>> of_body;
  for (std::size_t f = 0; f < boxes.size(); ++f) of_body[skin.body[f]].push_back(static_cast<int>(f));
  std::vector<Part> parts;
  for (auto& [body, faces] : of_body)
    halve(boxes, faces, std::max<std::size_t>(4, 2 * faces.size() / most_boxes), [&](const Box& box, std::span<const int> some) {
      Part part{{box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]}, 0, body};
      for (const int f : some) part.size = std::max(part.size, sizes[at(f)]);
      parts.push_back(part);
    });
  return comm.all_gather(parts);
}

}  // namespace

std::pair<double, double> Lengths::window(double size, double other) const
{
  const double d = given > 0 ? given : part_of_face * std::min(size, other);
  return {-d + std::min(interference, 0.0), d + std::max(interference, 0.0)};
}

double Lengths::longest(double size) const
{
  return (given > 0 ? given : part_of_face * size) + std::abs(interference);
}

double Lengths::reach(double largest, int body, int other) const
{
  const double usual = std::max(largest, part_of_body * std::min(diagonal[at(body)], diagonal[at(other)]));
  return (given > 0 ? given : usual) + std::abs(interference);
}

double Lengths::margin(double size, int body, double other_size, int other) const
{
  const double largest = std::max(size, other_size);
  return 2 * reach(largest, body, other) + rings_of_patches * largest;
}

std::vector<double> diagonals(const mesh::Surface& skin, int bodies, const Communicator& comm)
{
  constexpr double none = std::numeric_limits<double>::max();
  std::vector<std::array<double, 6>> mine(at(bodies), {none, none, none, -none, -none, -none});
  const auto extend = [](std::array<double, 6>& box, std::size_t c, double low, double high) {
    box[c] = std::min(box[c], low);
    box[3 + c] = std::max(box[3 + c], high);
  };
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f])
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = skin.points[at(n)][static_cast<Eigen::Index>(c)];
        extend(mine[at(skin.body[f])], c, x, x);
      }
  const auto all = comm.all_gather(mine);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) extend(mine[i % at(bodies)], c, all[i][c], all[i][3 + c]);
  std::vector<double> result;
  for (const auto& box : mine)
    result.push_back(box[0] > box[3] ? 0 : Point(box[3] - box[0], box[4] - box[1], box[5] - box[2]).norm());
  return result;
}

std::vector<double> sizes_of(const mesh::Surface& skin)
{
  std::vector<double> sizes;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) sizes.push_back(corners_of(skin, f).size());
  return sizes;
}

mesh::Surface near_others(const mesh::Surface& skin, const Lengths& lengths, const Communicator& comm)
{
  const auto boxes = boxes_of_faces(skin);
  const auto sizes = sizes_of(skin);
  const auto parts = parts_of(skin, boxes, sizes, comm);
  std::vector<Box> part_boxes;
  std::vector<double> largest(lengths.diagonal.size(), 0.0);
  for (const auto& part : parts) {
    part_boxes.emplace_back(Point(part.box[0], part.box[1], part.box[2]), Point(part.box[3], part.box[4], part.box[5]));
    largest[at(part.body)] = std::max(largest[at(part.body)], part.size);
  }
  const Tree tree(part_boxes);
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const int body = skin.body[f];
    double widest = 0;
    for (std::size_t b = 0; b < largest.size(); ++b)
      if (static_cast<int>(b) != body && largest[b] > 0)
        widest = std::max(widest, lengths.margin(sizes[f], body, largest[b], static_cast<int>(b)));
    if (tree.any_of(grown(boxes[f], widest), [&](int p) {
          const auto& part = parts[at(p)];
          return part.body != body &&
                 grown(boxes[f], lengths.margin(sizes[f], body, part.size, part.body)).intersects(part_boxes[at(p)]);
        }))
      chosen.push_back(f);
  }
  return part_of(skin, chosen);
}

Skin gather_skin(const mesh::Surface& near, fem::Kinematics kinematics, const Communicator& comm)
{
  Skin skin;
  std::tie(skin.side, skin.body) = gather_with_bodies(near, kinematics, comm);
  skin.face_id = skin.side.face_id;
  const auto& faces = skin.side.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    FaceGeometry corners{mesh::first_order(faces.type[f]), {}};
    for (int k = 0; k < mesh::corner_count(faces.type[f]); ++k) corners.nodes.push_back(skin.side.points[at(faces[f][at(k)])]);
    skin.size.push_back(corners.size());
    skin.normal.push_back(corners.normal());
    Box box;
    for (const Local n : faces[f]) box.extend(skin.side.points[at(n)]);
    skin.box.push_back(box);
    skin.area.push_back(0);
  }
  for (std::size_t i = 0; i < skin.side.facets.size(); ++i) {
    skin.facet.push_back(skin.side.geometry(i));
    skin.facet_normal.push_back(skin.facet.back().normal());
    const auto corners = static_cast<Eigen::Index>(skin.facet.back().nodes.size());
    Eigen::Vector4d middle = Eigen::Vector4d::Zero();
    middle.head(corners).setConstant(1.0 / static_cast<double>(corners));
    skin.area[at(skin.side.face_of[i])] += skin.facet.back().area() * skin.side.thickness(i, middle);
  }
  return skin;
}

}  // namespace mortise::contact
