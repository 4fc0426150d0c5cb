#include "pairing/facing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace mortise::contact {

namespace {

// Faces that enclose more than about 40 degrees meet at an edge or not at all: what a ball has beside the rim of its socket is no
// contact.
constexpr double facing = kink;

// Places from which lines start: the centre of a facet, and so far from there to its corners.
constexpr double to_corners = 0.9;

// What faces `face` on the line from `x`: the nearest, or several at one distance.
void look(const Point& x, const Point& direction, int face, const Lengths& lengths, const Skin& skin, const Tree& facets,
          std::vector<Facing>& result)
{
  const double size = skin.size[at(face)];
  const auto crossings = cross_skin(x, direction, lengths.longest(size), face, skin, facets);
  std::vector<Facing> seen;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& c : crossings) {
    if (!c.entered || skin.body[at(c.face)] == skin.body[at(face)]) continue;
    const auto [least, largest] = lengths.window(size, skin.size[at(c.face)]);
    if (c.s < least || c.s > largest || !in_sight(c, face, crossings, skin)) continue;
    if (direction.dot(skin.normal[at(c.face)]) > -facing) continue;
    seen.push_back({face, c.face, c.s});
    nearest = std::min(nearest, std::abs(c.s));
  }
  for (const auto& f : seen)
    if (std::abs(f.gap) <= nearest + rounding * size) result.push_back(f);
}

}  // namespace

Tree tree_of(const std::vector<FaceGeometry>& faces)
{
  std::vector<Box> boxes(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const auto& x : faces[i].nodes) boxes[i].extend(x);
  return Tree(std::move(boxes));
}

std::vector<Crossing> cross_skin(const Point& x, const Point& direction, double length, int from, const Skin& skin,
                                 const Tree& facets)
{
  std::vector<Crossing> result;
  const Point point = Point::Constant(rounding * skin.size[at(from)]);
  for (const int i : facets.swept(Box(x - point, x + point), length * direction)) {
    const int face = skin.side.face_of[at(i)];
    if (face == from) continue;
    const double cosine = direction.dot(skin.facet_normal[at(i)]);
    if (std::abs(cosine) < -opposed) continue;
    const bool entered = cosine < 0;
    const auto hit = shoot(x, entered ? direction : Point(-direction), skin.facet[at(i)]);
    const double s = entered ? hit.distance : -hit.distance;
    if (hit.found && std::abs(s) <= length) result.push_back({s, face, entered});
  }
  return result;
}

bool in_sight(const Crossing& seen, int from, const std::vector<Crossing>& crossings, const Skin& skin)
{
  const double nothing = 10 * rounding * std::max(skin.size[at(from)], skin.size[at(seen.face)]);
  const double low = std::min(seen.s, 0.0) + nothing, high = std::max(seen.s, 0.0) - nothing;
  return std::none_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
    const int body = skin.body[at(c.face)];
    const bool matters = seen.s > 0 || body == skin.body[at(from)] || body == skin.body[at(seen.face)];
    return matters && c.s > low && c.s < high;
  });
}

std::vector<Facing> find_facing(const Skin& skin, const Tree& facets, const Lengths& lengths, const std::set<Bodies>& known,
                                const Communicator& comm)
{
  std::vector<Facing> mine;
  for (std::size_t i = static_cast<std::size_t>(comm.rank()); i < skin.facet.size(); i += static_cast<std::size_t>(comm.size())) {
    const int face = skin.side.face_of[i];
    const Point centre = skin.facet[i].centre();
    look(centre, skin.facet_normal[i], face, lengths, skin, facets, mine);
    for (const auto& corner : skin.facet[i].nodes)
      look(centre + to_corners * (corner - centre), skin.facet_normal[i], face, lengths, skin, facets, mine);
  }
  std::erase_if(mine,
                [&](const Facing& f) { return known.contains(std::minmax(skin.body[at(f.face)], skin.body[at(f.other)])); });
  auto all = comm.all_gather(mine);
  std::sort(all.begin(), all.end(),
            [](const Facing& a, const Facing& b) { return std::tie(a.face, a.other, a.gap) < std::tie(b.face, b.other, b.gap); });
  return all;
}

}  // namespace mortise::contact
