#include "pairing/skin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

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

// By which a curved face may stick out of its corners, as a factor of its size.
constexpr double of_curved = 1.2;

std::vector<Box> boxes_of(const auto& parts)
{
  std::vector<Box> boxes;
  for (const auto& part : parts)
    boxes.emplace_back(Point(part.box[0], part.box[1], part.box[2]), Point(part.box[3], part.box[4], part.box[5]));
  return boxes;
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

// Of all ranks. Collective.
std::vector<PiecesOfBodies::Part> PiecesOfBodies::parts_of(const mesh::Surface& skin, const Communicator& comm)
{
  const auto boxes = boxes_of_faces(skin);
  const auto sizes = sizes_of(skin);
  std::map<int, std::vector<int>> of_body;
  for (std::size_t f = 0; f < boxes.size(); ++f) of_body[skin.body[f]].push_back(static_cast<int>(f));
  std::vector<Part> parts;
  for (auto& [body, faces] : of_body)
    halve(boxes, faces, std::max<std::size_t>(4, 2 * faces.size() / most_boxes), [&](const Box& box, std::span<const int> some) {
      const auto &low = box.min(), &high = box.max();
      Part part{{low[0], low[1], low[2], high[0], high[1], high[2]}, 0, body, comm.rank()};
      for (const int f : some) part.size = std::max(part.size, sizes[at(f)]);
      parts.push_back(part);
    });
  return comm.all_gather(parts);
}

PiecesOfBodies::PiecesOfBodies(const mesh::Surface& skin, int bodies, const Communicator& comm)
    : parts_(parts_of(skin, comm)), boxes_(boxes_of(parts_)), tree_(boxes_), largest_(at(bodies), 0.0)
{
  for (const auto& part : parts_) largest_[at(part.body)] = std::max(largest_[at(part.body)], part.size);
}

mesh::Surface PiecesOfBodies::near_others(const mesh::Surface& skin, const Lengths& lengths) const
{
  const auto boxes = boxes_of_faces(skin);
  const auto sizes = sizes_of(skin);
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const int body = skin.body[f];
    double widest = 0;
    for (std::size_t b = 0; b < largest_.size(); ++b)
      if (static_cast<int>(b) != body && largest_[b] > 0)
        widest = std::max(widest, lengths.margin(sizes[f], body, largest_[b], static_cast<int>(b)));
    if (tree_.any_of(grown(boxes[f], widest), [&](int p) {
          const auto& part = parts_[at(p)];
          return part.body != body &&
                 grown(boxes[f], lengths.margin(sizes[f], body, part.size, part.body)).intersects(boxes_[at(p)]);
        }))
      chosen.push_back(f);
  }
  return part_of(skin, chosen);
}

std::vector<std::vector<std::size_t>> PiecesOfBodies::needed_by_ranks(const mesh::Surface& near, double reach,
                                                                      const std::vector<double>& size,
                                                                      const Communicator& comm) const
{
  const auto looks = [&](double of_body) { return reach + of_body / 2; };
  const double farthest = size.empty() ? reach : looks(std::ranges::max(size));
  const auto boxes = boxes_of_faces(near);
  std::vector<std::vector<std::size_t>> result(static_cast<std::size_t>(comm.size()));
  std::vector<int> met;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const double ring = of_curved * size[at(near.body[f])];
    tree_.candidates(grown(boxes[f], farthest + ring), met);
    for (const int p : met) {
      const auto& part = parts_[at(p)];
      auto& faces = result[at(part.rank)];
      if (part.rank == comm.rank() || (!faces.empty() && faces.back() == f)) continue;
      const double distance = part.body == near.body[f] ? ring : looks(size[at(part.body)]) + ring;
      if (grown(boxes[f], distance).intersects(boxes_[at(p)])) faces.push_back(f);
    }
  }
  return result;
}

Skin gather_skin(const mesh::Surface& near, fem::Kinematics kinematics, const Communicator& comm)
{
  auto [side, bodies] = gather_with_bodies(near, kinematics, comm);
  return skin_of(std::move(side), std::move(bodies));
}

Skin skin_of(Side side, std::vector<int> body_of_face)
{
  Skin skin;
  skin.side = std::move(side);
  skin.body = std::move(body_of_face);
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
