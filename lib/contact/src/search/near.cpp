#include "search/near.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "integrals/overlap.hpp"
#include "search/boxes.hpp"
#include "search/tree.hpp"

namespace mortise::contact {

namespace {

// Boxes that a rank tells the others of its part of a surface.
constexpr std::size_t most_boxes_of_rank = 64;
struct Extent {
  std::array<double, 3> low, high;
  double face = 0;
};

Extent extent_of(const mesh::Surface& side)
{
  Extent extent;
  extent.low.fill(std::numeric_limits<double>::max());
  extent.high.fill(std::numeric_limits<double>::lowest());
  for (const auto& p : side.points)
    for (std::size_t c = 0; c < 3; ++c) {
      extent.low[c] = std::min(extent.low[c], p[static_cast<Eigen::Index>(c)]);
      extent.high[c] = std::max(extent.high[c], p[static_cast<Eigen::Index>(c)]);
    }
  for (std::size_t f = 0; f < side.faces.size(); ++f) extent.face = std::max(extent.face, corners_of(side, f).size());
  return extent;
}

Extent joined(const Extent& a, const Extent& b)
{
  Extent result = a;
  for (std::size_t c = 0; c < 3; ++c) {
    result.low[c] = std::min(a.low[c], b.low[c]);
    result.high[c] = std::max(a.high[c], b.high[c]);
  }
  result.face = std::max(a.face, b.face);
  return result;
}

double diagonal(const Extent& extent)
{
  double square = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double length = extent.high[c] - extent.low[c];
    square += length > 0 ? length * length : 0;
  }
  return std::sqrt(square);
}

// Boxes round the parts of a surface, of all ranks. Collective.
Tree tree_of_ranks(const std::vector<Box>& boxes, const Communicator& comm)
{
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::array<double, 6>> sent;
  halve(boxes, order, std::max<std::size_t>(4, 2 * boxes.size() / most_boxes_of_rank), [&](const Box& box, std::span<const int>) {
    sent.push_back({box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]});
  });
  std::vector<Box> all;
  for (const auto& b : comm.all_gather(sent)) all.emplace_back(Point(b[0], b[1], b[2]), Point(b[3], b[4], b[5]));
  return Tree(std::move(all));
}

mesh::Surface select(const mesh::Surface& side, const std::vector<Box>& boxes, const Tree& others, double distance)
{
  std::vector<std::size_t> chosen;
  const Point margin = Point::Constant(distance);
  for (std::size_t f = 0; f < boxes.size(); ++f)
    if (others.meets(Box(boxes[f].min() - margin, boxes[f].max() + margin))) chosen.push_back(f);
  return part_of(side, chosen);
}

}  // namespace

std::vector<PairSize> measure(std::span<const Pair> pairs, const Communicator& comm)
{
  std::vector<Extent> mine;
  for (const auto& pair : pairs) {
    mine.push_back(extent_of(pair.secondary));
    mine.push_back(pair.primary ? extent_of(*pair.primary) : mine.back());
  }
  const auto all = comm.all_gather(mine);
  std::vector<PairSize> sizes;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    Extent secondary = all[2 * c], primary = all[2 * c + 1];
    for (std::size_t r = 1; r < static_cast<std::size_t>(comm.size()); ++r) {
      secondary = joined(secondary, all[2 * (pairs.size() * r + c)]);
      primary = joined(primary, all[2 * (pairs.size() * r + c) + 1]);
    }
    const double extent = std::min(diagonal(secondary), diagonal(primary)), given = pairs[c].options.search_distance;
    sizes.push_back(
        {given > 0 ? given : std::max({0.1 * extent, secondary.face, primary.face}), extent, secondary.face, primary.face});
  }
  return sizes;
}

std::vector<double> search_distances(std::span<const Pair> pairs, const Communicator& comm)
{
  std::vector<double> result;
  for (const auto& size : measure(pairs, comm)) result.push_back(size.reach);
  return result;
}

mesh::Surface near_secondary(const Pair& pair, const PairSize& size, const Communicator& comm)
{
  if (!pair.primary) return pair.secondary;
  const double margin = slack * rings * std::max(size.secondary_face, size.primary_face);
  return select(pair.secondary, boxes_of_faces(pair.secondary), tree_of_ranks(boxes_of_faces(*pair.primary), comm),
                size.reach + margin);
}

}  // namespace mortise::contact
