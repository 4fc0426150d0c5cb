#include "points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "base/error.hpp"
#include "partition/node_directory.hpp"

namespace mortise::model {

namespace {

constexpr double at_a_point = 1e-4;  // of the model's size: as far may a node lie from the place that is given
constexpr std::size_t record = 8;    // numbers that tell of a candidate

struct Wanted {
  Point at;
  std::string body, path;
};

std::string text(const Point& x)
{
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::vector<Wanted> wanted_points(const Deck& deck)
{
  std::vector<Wanted> wanted;
  const auto add = [&](const auto& section, const char* name) {
    for (std::size_t i = 0; i < section.size(); ++i)
      for (std::size_t k = 0; k < section[i].points.size(); ++k)
        wanted.push_back({place(section[i].points[k]), section[i].body, fmt::format("{}[{}].points[{}]", name, i, k)});
  };
  add(deck.supports, "supports");
  add(deck.loads, "loads");
  for (const auto& [name, spring] : deck.springs)
    for (std::size_t k = 0; k < spring.points.size(); ++k)
      wanted.push_back({place(spring.points[k]), spring.bodies.empty() ? std::string() : spring.bodies[k],
                        fmt::format("springs.{}.points[{}]", name, k)});
  return wanted;
}

// The length of the box round all bodies. Collective.
double size_of(const partition::Decomposition& decomposition, const Communicator& comm)
{
  Point low = Point::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& x : subdomain.mesh.points) low = low.cwiseMin(x), high = high.cwiseMax(x);
  for (int c = 0; c < 3; ++c) low[c] = -comm.max(-low[c]), high[c] = comm.max(high[c]);
  return (high - low).norm();
}

}  // namespace

// Of each body's nodes the nearest to each place: [place][body].
std::vector<std::vector<Model::NodeAtPoint>> Model::candidates_at_points(const Communicator& comm) const
{
  const auto wanted = wanted_points(deck_);
  const auto bodies = decomposition_.catalogue.bodies.size();
  std::vector<std::vector<NodeAtPoint>> nearest(wanted.size(), std::vector<NodeAtPoint>(bodies));
  if (wanted.empty()) return nearest;
  const auto take = [](NodeAtPoint& best, const NodeAtPoint& other) {
    if (std::tie(other.distance, other.node, other.subdomain) < std::tie(best.distance, best.node, best.subdomain)) best = other;
  };
  for (const auto& subdomain : decomposition_.subdomains)
    for (const Local n : partition::surface_nodes(subdomain)) {
      const auto i = static_cast<std::size_t>(n);
      const Point& x = subdomain.mesh.points[i];
      for (std::size_t w = 0; w < wanted.size(); ++w)
        take(nearest[w][static_cast<std::size_t>(subdomain.body)],
             {(x - wanted[w].at).norm(), subdomain.mesh.node_id[i], subdomain.id, subdomain.body, n, x});
    }
  std::vector<double> own;
  for (const auto& of_place : nearest)
    for (const auto& c : of_place)
      if (c.node >= 0)
        own.insert(own.end(), {static_cast<double>(&of_place - nearest.data()), static_cast<double>(c.node),
                               static_cast<double>(c.subdomain), static_cast<double>(c.body), static_cast<double>(c.local),
                               c.at[0], c.at[1], c.at[2]});
  const auto all = comm.all_gather(own);
  for (std::size_t i = 0; i + record <= all.size(); i += record) {
    const auto w = static_cast<std::size_t>(all[i]);
    const Point at(all[i + 5], all[i + 6], all[i + 7]);
    take(nearest[w][static_cast<std::size_t>(all[i + 3])],
         {(at - wanted[w].at).norm(), static_cast<Global>(all[i + 1]), static_cast<Global>(all[i + 2]),
          static_cast<int>(all[i + 3]), static_cast<Local>(all[i + 4]), at});
  }
  return nearest;
}

Model::NodesAtPoints Model::nodes_at_points(const Communicator& comm) const
{
  const auto candidates = candidates_at_points(comm);
  const auto wanted = wanted_points(deck_);
  NodesAtPoints result{std::vector<std::vector<NodeAtPoint>>(deck_.supports.size()),
                       std::vector<std::vector<NodeAtPoint>>(deck_.loads.size()),
                       std::vector<std::vector<NodeAtPoint>>(deck_.springs.size())};
  std::size_t next = 0;
  const auto choose = [&](const auto& options, std::vector<NodeAtPoint>& found) {
    for (std::size_t k = 0; k < options.points.size(); ++k, ++next) {
      const auto on_body = bodies_named(wanted[next].body);
      NodeAtPoint best;
      for (const auto& c : candidates[next])
        if (c.node >= 0 && on_body[static_cast<std::size_t>(c.body)] && c.distance < best.distance) best = c;
      found.push_back(best);
    }
  };
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) choose(deck_.supports[i], result.supports[i]);
  for (std::size_t i = 0; i < deck_.loads.size(); ++i) choose(deck_.loads[i], result.loads[i]);
  auto springs = result.springs.begin();
  for (const auto& [name, spring] : deck_.springs) choose(spring, *springs++);
  return result;
}

void Model::require_points(deck::Document& document, const Communicator& comm) const
{
  const auto wanted = wanted_points(deck_);
  if (wanted.empty()) return;
  const auto candidates = candidates_at_points(comm);
  const double reach = at_a_point * size_of(decomposition_, comm);
  collectively(comm, [&] {
    for (std::size_t w = 0; w < wanted.size(); ++w) {
      const auto on_body = bodies_named(wanted[w].body);
      std::string there;
      int count = 0;
      const NodeAtPoint* nearest = nullptr;
      for (const auto& c : candidates[w]) {
        if (c.node < 0 || !on_body[static_cast<std::size_t>(c.body)]) continue;
        if (!nearest || c.distance < nearest->distance) nearest = &c;
        if (c.distance > reach) continue;
        there += fmt::format("{}\"{}\"", count++ > 0 ? ", " : "",
                             decomposition_.catalogue.bodies[static_cast<std::size_t>(c.body)].name);
      }
      if (!nearest)
        document.error(wanted[w].path, fmt::format("there is no body \"{}\"", wanted[w].body));
      else if (nearest->distance > reach)
        document.error(wanted[w].path, fmt::format("no node of a surface lies at {}; the nearest is at {}, {:.3g} away",
                                                   text(wanted[w].at), text(nearest->at), nearest->distance));
      else if (count > 1)
        document.error(wanted[w].path,
                       fmt::format("bodies {} have nodes at {}; say which is meant, with `{}`", there, text(wanted[w].at),
                                   wanted[w].path.starts_with("springs") ? "bodies" : "body"));
    }
    document.check();
  });
}

}  // namespace mortise::model
