#include "contact/doubled_faces.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "crossing/near_itself.hpp"
#include "pairing/skin.hpp"
#include "search/boxes.hpp"

namespace mortise::contact {

namespace {

// Part of a face's size by which places that are the same may be apart.
constexpr double one_place = 1e-4;
// Along it no two faces of a structured mesh have the same place.
const Point no_line_of_a_mesh = Point(0.5408, 0.3217, 0.7771).normalized();
constexpr int buckets_of_rank = 64;

// The middle of a face, as plain bytes.
struct MiddleOfFace {
  double along;  // the line
  double tolerance;
  std::array<double, 3> at;
  Global face;
  int body;
};

struct TwoFaces {
  Global face, other;
  auto operator<=>(const TwoFaces&) const = default;
};

// All faces of this rank, and those in its parts of the line, and next to them, that come near faces of their body on another
// rank. Collective.
std::vector<MiddleOfFace> middles_by_place(const mesh::Surface& skin, const Communicator& comm)
{
  std::vector<MiddleOfFace> mine;
  double low = std::numeric_limits<double>::max(), high = -low, widest = 0;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    const auto corners = corners_of(skin, f);
    const Point x = corners.centre();
    mine.push_back({x.dot(no_line_of_a_mesh), one_place * corners.size(), {x[0], x[1], x[2]}, skin.face_id[f], skin.body[f]});
    low = std::min(low, mine.back().along);
    high = std::max(high, mine.back().along);
    widest = std::max(widest, mine.back().tolerance);
  }
  if (comm.size() == 1) return mine;
  low = -comm.max(-low);
  high = comm.max(high);
  widest = comm.max(widest);
  const auto ranks = static_cast<std::size_t>(comm.size());
  const double width = std::max((high - low) / (buckets_of_rank * comm.size()), 2 * widest);
  std::vector<std::vector<MiddleOfFace>> send(ranks);
  for (const std::size_t f : near_other_ranks(skin, one_place, comm)) {
    const auto& m = mine[f];
    const auto bucket = [&](double along) { return static_cast<std::size_t>(std::max(0.0, (along - low) / width)); };
    const std::size_t own = bucket(m.along), before = bucket(m.along - widest);
    const auto here = static_cast<std::size_t>(comm.rank());
    if (own % ranks != here) send[own % ranks].push_back(m);
    if (before % ranks != own % ranks && before % ranks != here) send[before % ranks].push_back(m);
  }
  for (const auto& part : comm.exchange(send)) mine.insert(mine.end(), part.begin(), part.end());
  return mine;
}

// Faces of one body with their middles at one place, over all ranks. Collective.
std::vector<TwoFaces> same_middles(const mesh::Surface& skin, const Communicator& comm)
{
  auto middles = middles_by_place(skin, comm);
  std::sort(middles.begin(), middles.end(), [](const MiddleOfFace& a, const MiddleOfFace& b) {
    return std::tie(a.body, a.along, a.face) < std::tie(b.body, b.along, b.face);
  });
  std::vector<TwoFaces> found;
  for (std::size_t i = 0; i < middles.size(); ++i)
    for (std::size_t j = i + 1;
         j < middles.size() && middles[j].body == middles[i].body && middles[j].along - middles[i].along <= middles[i].tolerance;
         ++j) {
      const auto &a = middles[i].at, &b = middles[j].at;
      if (Point(a[0] - b[0], a[1] - b[1], a[2] - b[2]).norm() <= middles[i].tolerance && middles[i].face != middles[j].face)
        found.push_back({std::min(middles[i].face, middles[j].face), std::max(middles[i].face, middles[j].face)});
    }
  found = comm.all_gather(found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Appends the nodes that two faces have at the same places. False if one has a corner where the other one has none.
bool add_doubled_nodes(const Skin& skin, std::size_t face, std::size_t other, std::vector<DoubledNode>& doubled)
{
  const auto& side = skin.side;
  const auto nodes = side.faces[face], others = side.faces[other];
  const double tolerance = one_place * skin.size[face];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Point& x = side.points[at(nodes[k])];
    const auto twin =
        std::find_if(others.begin(), others.end(), [&](Local n) { return (side.points[at(n)] - x).norm() <= tolerance; });
    if (twin == others.end()) {
      if (k < at(mesh::corner_count(side.faces.type[face]))) return false;
      continue;
    }
    const auto [low, high] = std::minmax(nodes[k], *twin);
    if (low != high) doubled.push_back({{side.node_id[at(low)], side.node_id[at(high)]}, side.points[at(low)]});
  }
  return true;
}

}  // namespace

std::vector<DoubledFaces> find_doubled_faces(const mesh::Surface& skin, fem::Kinematics kinematics, const Communicator& comm)
{
  const auto pairs = same_middles(skin, comm);
  if (pairs.empty()) return {};
  std::vector<Global> wanted;
  for (const auto& [face, other] : pairs) wanted.insert(wanted.end(), {face, other});
  std::sort(wanted.begin(), wanted.end());
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < skin.face_id.size(); ++f)
    if (std::binary_search(wanted.begin(), wanted.end(), skin.face_id[f])) chosen.push_back(f);
  const Skin near = gather_skin(part_of(skin, chosen), kinematics, comm);
  const auto place = [&](Global face) {
    return static_cast<std::size_t>(std::lower_bound(near.face_id.begin(), near.face_id.end(), face) - near.face_id.begin());
  };
  std::vector<DoubledFaces> result;
  for (const auto& [face, other] : pairs) {
    const std::size_t f = place(face), g = place(other);
    if (mesh::corner_count(near.side.faces.type[f]) != mesh::corner_count(near.side.faces.type[g])) continue;
    if (!(near.normal[f].dot(near.normal[g]) < opposed)) continue;
    DoubledFaces found{near.body[f], {face, other}, {}};
    if (add_doubled_nodes(near, f, g, found.nodes) && !found.nodes.empty()) result.push_back(std::move(found));
  }
  return result;
}

}  // namespace mortise::contact
