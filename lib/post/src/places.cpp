#include "post/places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "bem/representation.hpp"
#include "mesh/inverse_map.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

namespace {

constexpr double on_surface = 1e-6;       // of a body's size
constexpr double off_the_mesh = 0.05;     // of a cell's diagonal
constexpr double beyond_the_nodes = 0.1;  // of a cell's diagonal, how far curved cells may reach

struct Candidate {
  double distance = std::numeric_limits<double>::infinity();  // 0 if the point lies in the body
  PointInCell place;
};

struct Located {
  bool inside;
  double distance, size;  // from the nearest panel, and of it
};

template <int D>
std::vector<Located> locate(const mesh::Mesh& skin, std::span<const Point> points)
{
  const auto panels = bem::make_panels<D>(skin);
  const bem::Representation<D> surface(panels, {.young_modulus = 1});  // of any material
  std::vector<Located> result;
  for (const auto& x : points) {
    const auto [inside, distance, panel] = surface.locate(x);
    result.push_back({inside, distance, D == 3 ? std::sqrt(2 * panels.area[panel]) : panels.area[panel]});
  }
  return result;
}

// The candidates of this rank, by point and body.
std::map<std::pair<std::size_t, int>, Candidate> candidates(const partition::Decomposition& decomposition,
                                                            const std::vector<double>& sizes, std::span<const Point> points)
{
  std::vector<std::size_t> by_x(points.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) { return points[a][0] < points[b][0]; });
  std::map<std::pair<std::size_t, int>, Candidate> result;
  std::vector<Point> nodes;
  const bool flat = decomposition.catalogue.dimension == 2;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& mesh = solid(decomposition.subdomains[s]);
    const int body = decomposition.subdomains[s].body;
    const double within = on_surface * sizes[static_cast<std::size_t>(body)];
    const auto take = [&](std::size_t point, double distance, double allowed, const PointInCell& place) {
      if (!(distance <= std::max(within, allowed))) return;
      auto& best = result[{point, body}];
      if (const double counts = distance <= within ? 0 : distance; counts < best.distance) best = {counts, place};
    };
    if (is_surface_alone(decomposition.subdomains[s])) {
      const auto located = flat ? locate<2>(mesh, points) : locate<3>(mesh, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [inside, distance, size] = located[i];
        take(i, inside ? 0 : distance, off_the_mesh * size, {s, 0, Point::Zero(), points[i]});
      }
      continue;
    }
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      nodes.clear();
      for (const Local n : mesh.cells[c]) nodes.push_back(mesh.points[static_cast<std::size_t>(n)]);
      Point low = nodes.front(), high = low;
      for (const auto& p : nodes) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      const double diagonal = (high - low).norm(), margin = std::max(beyond_the_nodes * diagonal, within);
      low.array() -= margin;
      high.array() += margin;
      auto i = std::lower_bound(by_x.begin(), by_x.end(), low[0], [&](std::size_t p, double x) { return points[p][0] < x; });
      for (; i != by_x.end() && points[*i][0] <= high[0]; ++i) {
        const Point& x = points[*i];
        if ((x.array() < low.array()).any() || (x.array() > high.array()).any()) continue;
        const auto [reference, distance] = mesh::find_in_cell(mesh.cells.type[c], nodes, x);
        take(*i, distance, off_the_mesh * diagonal, {s, c, reference, x});
      }
    }
  }
  return result;
}

}  // namespace

FoundPoints find_points(const partition::Decomposition& decomposition, fem::Kinematics kinematics, std::span<const Point> points,
                        const Communicator& comm)
{
  const auto mine = candidates(decomposition, body_sizes(decomposition, kinematics, comm), points);
  struct Entry {
    std::size_t point;
    double distance;
    Global subdomain;
    int body;
  };
  std::vector<Entry> entries;
  for (const auto& [key, best] : mine)
    entries.push_back({key.first, best.distance, decomposition.subdomains[best.place.subdomain].id, key.second});
  entries = comm.all_gather(entries);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.point, a.distance, a.body, a.subdomain) < std::tie(b.point, b.distance, b.body, b.subdomain);
  });
  FoundPoints result;
  for (std::size_t p = 0, next = 0; p < points.size(); ++p) {
    int last = -1;  // body
    const std::size_t first = next;
    for (; next < entries.size() && entries[next].point == p; ++next) {
      const auto& entry = entries[next];
      if ((entry.distance > 0 && next > first) || entry.body == last) continue;
      last = entry.body;
      const Global row = result.rows++;
      if (const auto own = mine.find({p, entry.body});
          own != mine.end() && decomposition.subdomains[own->second.place.subdomain].id == entry.subdomain)
        result.mine.push_back({p, row, entry.body, own->second.place});
    }
    if (next == first) result.lost.push_back({p, 0, 0});
  }
  if (result.lost.empty()) return result;

  std::vector<LostPoint> nearest;  // of each rank
  for (const auto& lost : result.lost) {
    auto& own = nearest.emplace_back(LostPoint{lost.point, std::numeric_limits<double>::infinity(), 0});
    for (const auto& subdomain : decomposition.subdomains)
      for (const auto& node : subdomain.mesh.points)
        if (const double distance = (node - points[lost.point]).norm(); distance < own.distance) {
          own.distance = distance;
          own.body = subdomain.body;
        }
  }
  nearest = comm.all_gather(nearest);
  for (std::size_t i = 0; i < result.lost.size(); ++i) {
    auto& best = result.lost[i] = nearest[i];
    for (std::size_t k = i; k < nearest.size(); k += result.lost.size())
      if (std::tie(nearest[k].distance, nearest[k].body) < std::tie(best.distance, best.body)) best = nearest[k];
  }
  return result;
}

}  // namespace mortise::post
