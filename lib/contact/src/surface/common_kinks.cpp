#include "surface/common_kinks.hpp"

#include <algorithm>
#include <cmath>

#include "search/tree.hpp"

namespace mortise::contact {

namespace {

constexpr double upon_each_other = 0.05;  // of the smaller face
constexpr double between_them = 0.5;      // of it, along the normal: what gaps and overlaps may be

bool lies_upon(const TurnedEdge& a, const TurnedEdge& b)
{
  constexpr double parallel_edges = 0.9, opposed_normals = -0.7;
  constexpr double as_much = 2;  // faces of another size turn by more or less beside the kink
  if (a.turn * b.turn >= 0 || a.normal.dot(b.normal) > opposed_normals) return false;
  if (std::abs(a.turn) > as_much * std::abs(b.turn) || std::abs(b.turn) > as_much * std::abs(a.turn)) return false;
  if (a.half > 0 && std::abs(a.along.dot(b.along)) < parallel_edges) return false;
  const double size = std::min(a.depth, b.depth);
  Point d = a.middle - b.middle;
  const double away = d.dot(b.normal), along = d.dot(b.along);
  if (std::abs(away) > between_them * size || std::abs(along) > a.half + b.half) return false;
  d -= away * b.normal + along * b.along;
  return d.norm() < upon_each_other * size;
}

enum class Told { nothing, curve, kink };

// By the wing of one edge and a shorter one upon it.
Told told_by(const TurnedEdge& edge, const TurnedEdge::Wing& wing, const TurnedEdge& upon, const TurnedEdge::Wing& shorter)
{
  constexpr double of_one_size = 0.98, nearer = 0.25;
  const Point d = shorter.far - upon.middle;
  const double y = d.dot(wing.away), rest = 1 - y / wing.depth;
  if (y > of_one_size * wing.depth) return Told::nothing;
  const double off = d.dot(edge.normal) - wing.slope * y;
  // Cubics over the large face, from the slopes by which its ends turn.
  const double beyond_kink = -wing.next / 2 * y * rest, smooth = -y * rest * (edge.turn * rest + wing.next * (1 - rest)) / 2;
  return std::abs(off - beyond_kink) < nearer * std::abs(smooth - beyond_kink) ? Told::kink : Told::curve;
}

bool faces_tell(const TurnedEdge& a, const TurnedEdge& b)
{
  bool any = false;
  for (const auto& wing : a.wings) {
    const auto& other = wing.away.dot(b.wings[0].away) > 0 ? b.wings[0] : b.wings[1];
    const Told told = wing.depth > other.depth ? told_by(a, wing, b, other) : told_by(b, other, a, wing);
    if (told == Told::curve) return false;
    any = any || told == Told::kink;
  }
  return any;
}

Box box_round(const TurnedEdge& edge, double wider)
{
  const Point reach = edge.half * edge.along.cwiseAbs() + Point::Constant(wider * edge.depth);
  return {edge.middle - reach, edge.middle + reach};
}

template <class Fits>
std::vector<std::size_t> those_with_others(std::span<const TurnedEdge> mine, std::span<const TurnedEdge> others, const Fits& fits)
{
  std::vector<Box> boxes;
  for (const auto& edge : others) boxes.push_back(box_round(edge, 0));
  const Tree tree(std::move(boxes));
  std::vector<std::size_t> result;
  std::vector<int> near;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    tree.candidates(box_round(mine[i], between_them + upon_each_other), near);
    if (std::ranges::any_of(near, [&](int other) { return fits(mine[i], others[static_cast<std::size_t>(other)]); }))
      result.push_back(i);
  }
  return result;
}

}  // namespace

std::vector<std::size_t> lie_upon_others(std::span<const TurnedEdge> mine, std::span<const TurnedEdge> others)
{
  return those_with_others(mine, others, lies_upon);
}

std::vector<std::size_t> share_kinks(std::span<const TurnedEdge> mine, std::span<const TurnedEdge> others)
{
  return those_with_others(mine, others,
                           [](const TurnedEdge& a, const TurnedEdge& b) { return lies_upon(a, b) && faces_tell(a, b); });
}

}  // namespace mortise::contact
