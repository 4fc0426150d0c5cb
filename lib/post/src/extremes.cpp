#include "post/extremes.hpp"

#include <algorithm>
#include <cmath>

#include "post/interior.hpp"

namespace mortise::post {

namespace {

constexpr Global no_node = std::numeric_limits<Global>::max();

// What a rank found of a probe; plain bytes.
struct Best {
  std::size_t probe;
  double value, x, y, z;
  Global node;
  int body;
  bool found;
};

class Search {
 public:
  explicit Search(std::size_t probe, bool smallest) : best_{probe, 0, 0, 0, 0, no_node, -1, false}, smallest_(smallest) {}

  void take(double value, const Point& at, Global node, int body)
  {
    take(Best{best_.probe, value, at[0], at[1], at[2], node, body, true});
  }
  void take(const Best& other)
  {
    if (!other.found || std::isnan(other.value)) return;
    const double more = smallest_ ? best_.value - other.value : other.value - best_.value;
    if (!best_.found || more > 0 || (more == 0 && other.node < best_.node)) best_ = other;
  }
  const Best& best() const { return best_; }

 private:
  Best best_;
  bool smallest_;
};

// Which materials a node of a subdomain has cells of: node * blocks + block.
std::vector<bool> blocks_of_nodes(const partition::Subdomain& subdomain, const std::vector<int>& cell_block, std::size_t blocks)
{
  std::vector<bool> used(subdomain.mesh.node_count() * blocks, false);
  for (std::size_t c = 0; c < subdomain.mesh.cells.size(); ++c) {
    const auto block = subdomain.skin ? 0 : static_cast<std::size_t>(cell_block[c]);
    for (const Local n : subdomain.mesh.cells[c]) used[static_cast<std::size_t>(n) * blocks + block] = true;
  }
  return used;
}

double value_of(const ExtremeProbe& probe, const Point& at, const Point& displacement, const fem::Stress& stress)
{
  if (!probe.axes) return fem::value(probe.quantity, probe.smallest, displacement, stress);
  const auto axes = probe.axes->everywhere(at);
  return fem::value(probe.quantity, probe.smallest, axes * displacement, fem::along(axes, stress));
}

void at_nodes(const partition::Decomposition& decomposition, const ExtremeProbe& probe,
              const std::vector<Eigen::VectorXd>& displacement, const StressField& stress, Search& search)
{
  const int dimension = decomposition.catalogue.dimension;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    if (!probe.on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const bool mixed = !stress.by_material.empty();
    const auto& nodal = mixed ? stress.by_material[s] : stress.nodal[s];
    const auto blocks = static_cast<std::size_t>(nodal.cols()) / 6;
    const auto used = mixed ? blocks_of_nodes(subdomain, stress.cell_block[s], blocks) : std::vector<bool>{};
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      if (!probe.nodes.empty() && !probe.nodes[s][n]) continue;
      const auto row = static_cast<Eigen::Index>(n);
      Point u = Point::Zero();
      u.head(dimension) = displacement[s].segment(row * dimension, dimension);
      for (std::size_t k = 0; k < blocks; ++k)
        if (!mixed || used[n * blocks + k])
          search.take(value_of(probe, subdomain.mesh.points[n], u,
                               nodal.row(row).segment(6 * static_cast<Eigen::Index>(k), 6).transpose()),
                      subdomain.mesh.points[n], subdomain.mesh.node_id[n], subdomain.body);
    }
  }
}

// At places in bodies of boundary elements.
void at_places(const partition::Decomposition& decomposition, const ExtremeProbe& probe, const std::vector<PointInCell>& places,
               const Values& values, Search& search)
{
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& subdomain = decomposition.subdomains[places[i].subdomain];
    const auto row = static_cast<Eigen::Index>(i);
    if (subdomain.skin && probe.on_body[static_cast<std::size_t>(subdomain.body)])
      search.take(value_of(probe, places[i].at, values.displacement.row(row).transpose(), values.stress.row(row).transpose()),
                  places[i].at, no_node, subdomain.body);
  }
}

std::vector<PointInCell> places_of(const std::vector<PointInBody>& points)
{
  std::vector<PointInCell> places;
  for (const auto& point : points) places.push_back(point.place);
  return places;
}

void inside(const partition::Decomposition& decomposition, const ExtremeProbe& probe, const Probes& probes,
            const Interior& interior, Search& search)
{
  for (std::size_t s = 0; s < interior.nodes.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    if (!probe.on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const auto& values = interior.nodes[s];
    for (Eigen::Index i = 0; i < values.stress.rows(); ++i) {
      const auto n = subdomain.mesh.node_count() + static_cast<std::size_t>(i);
      search.take(
          value_of(probe, subdomain.inside.points[n], values.displacement.row(i).transpose(), values.stress.row(i).transpose()),
          subdomain.inside.points[n], subdomain.inside.node_id[n], subdomain.body);
    }
  }
  at_places(decomposition, probe, places_of(probes.points), interior.points, search);
  at_places(decomposition, probe, places_of(probes.sampled), interior.sampled, search);
  for (std::size_t k = 0; k < interior.planes.size(); ++k)
    at_places(decomposition, probe, probes.planes[k].places, interior.planes[k], search);
}

void on_contacts(const ExtremeProbe& probe, std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> surfaces,
                 Search& search)
{
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    std::vector<int> body(side.points.size(), -1);
    for (std::size_t f = 0; f < side.faces.size(); ++f)
      for (const Local n : side.faces[f]) body[static_cast<std::size_t>(n)] = side.body[f];
    for (std::size_t n = 0; n < side.points.size(); ++n)
      if (probe.contact_nodes[c][n]) search.take(surfaces[c].recovered_pressure[n], side.points[n], side.node_id[n], body[n]);
  }
}

}  // namespace

std::vector<Extreme> find_extremes(const partition::Decomposition& decomposition, const Probes& probes,
                                   const std::vector<Eigen::VectorXd>& displacement, const StressField& stress,
                                   const Interior& interior, std::span<const contact::Pair> pairs,
                                   std::span<const contact::SurfaceState> surfaces, const Communicator& comm)
{
  std::vector<Best> mine;
  std::vector<Search> all;
  for (std::size_t p = 0; p < probes.extremes.size(); ++p) {
    const auto& probe = probes.extremes[p];
    Search search(p, probe.smallest);
    if (probe.quantity == fem::Quantity::pressure) {
      on_contacts(probe, pairs, surfaces, search);
    } else {
      at_nodes(decomposition, probe, displacement, stress, search);
      if (probe.nodes.empty()) inside(decomposition, probe, probes, interior, search);
    }
    mine.push_back(search.best());
    all.emplace_back(p, probe.smallest);
  }
  for (const auto& best : comm.all_gather(mine)) all[best.probe].take(best);
  std::vector<Extreme> result;
  for (const auto& search : all) {
    const auto& best = search.best();
    auto& extreme = result.emplace_back();
    if (best.found) extreme = {best.value, {best.x, best.y, best.z}, best.body};
  }
  return result;
}

}  // namespace mortise::post
