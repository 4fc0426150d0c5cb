#include "points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "partition/node_directory.hpp"

namespace mortise::model {

namespace {

constexpr double at_a_point = 1e-4;  // of the model's size: as far may a node lie from the place that is given
constexpr std::size_t record = 8;    // numbers that tell of a candidate

struct Wanted {
  deck::Place place;
  std::string body, path;
};

std::string text(const Point& x)
{
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::vector<Wanted> wanted_points(const Deck& deck)
{
  std::vector<Wanted> wanted;
  const auto path = [](const std::string& of, const std::vector<deck::Place>& points, std::size_t k) {
    return points.size() == 1 && !points[0].name.empty() ? of + ".points" : fmt::format("{}.points[{}]", of, k);
  };
  const auto add = [&](const auto& section, const char* name) {
    for (std::size_t i = 0; i < section.size(); ++i)
      for (std::size_t k = 0; k < section[i].points.size(); ++k)
        wanted.push_back({section[i].points[k], section[i].body, path(fmt::format("{}[{}]", name, i), section[i].points, k)});
  };
  add(deck.supports, "supports");
  add(deck.loads, "loads");
  for (const auto& [name, spring] : deck.springs)
    for (std::size_t k = 0; k < spring.points.size(); ++k)
      wanted.push_back({spring.points[k], spring.bodies.empty() ? std::string() : spring.bodies[k],
                        path("springs." + name, spring.points, k)});
  return wanted;
}

const mesh::NodeSet* find_set(const mesh::Catalogue& catalogue, const std::string& name)
{
  const auto& sets = catalogue.node_sets;
  const auto found = std::find_if(sets.begin(), sets.end(), [&](const mesh::NodeSet& set) { return set.name == name; });
  return found == sets.end() ? nullptr : &*found;
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

// The nodes that may be meant by each of some places. By coordinates: of each body's nodes the nearest. By name: all nodes of the
// set.
class Model::CandidatesAtPoints {
 public:
  CandidatesAtPoints(const std::vector<deck::Place>& places, const mesh::Catalogue& catalogue)
      : places_(places), catalogue_(catalogue), nearest_(places.size()), named_(places.size())
  {
    for (std::size_t w = 0; w < places.size(); ++w)
      if (places[w].name.empty()) {
        nearest_[w].resize(catalogue.bodies.size());
      } else if (const auto* set = find_set(catalogue, places[w].name)) {
        for (const Global node : set->nodes) named_[w][node];
      }
  }

  // Of equal ones the lowest copy is kept.
  void offer(std::size_t w, NodeAtPoint node)
  {
    if (places_[w].name.empty()) {
      node.distance = (node.at - place(places_[w].at)).norm();
      if (auto& best = nearest_[w][static_cast<std::size_t>(node.body)]; before(node, best)) best = node;
    } else if (const auto of_set = named_[w].find(node.node); of_set != named_[w].end()) {
      node.distance = 0;
      if (before(node, of_set->second)) of_set->second = node;
    }
  }

  // Offers each rank's candidates to all others. Collective.
  void exchange(const Communicator& comm)
  {
    std::vector<double> own;
    for (std::size_t w = 0; w < places_.size(); ++w) {
      for (const auto& c : nearest_[w]) tell(w, c, own);
      for (const auto& [id, c] : named_[w]) tell(w, c, own);
    }
    const auto all = comm.all_gather(own);
    for (std::size_t i = 0; i + record <= all.size(); i += record) {
      NodeAtPoint node;
      node.node = static_cast<Global>(all[i + 1]), node.subdomain = static_cast<Global>(all[i + 2]);
      node.body = static_cast<int>(all[i + 3]), node.local = static_cast<Local>(all[i + 4]);
      node.at = Point(all[i + 5], all[i + 6], all[i + 7]);
      offer(static_cast<std::size_t>(all[i]), node);
    }
  }

  // [place][node]; those of sets with their shares.
  std::vector<std::vector<NodeAtPoint>> found() const
  {
    auto result = nearest_;
    for (std::size_t w = 0; w < places_.size(); ++w) {
      if (named_[w].empty()) continue;
      const auto* set = find_set(catalogue_, places_[w].name);
      for (std::size_t i = 0; i < set->nodes.size(); ++i) {
        result[w].push_back(named_[w].at(set->nodes[i]));
        result[w].back().share = set->weights[i];
      }
    }
    return result;
  }

 private:
  static bool before(const NodeAtPoint& a, const NodeAtPoint& b)
  {
    return std::tie(a.distance, a.node, a.subdomain) < std::tie(b.distance, b.node, b.subdomain);
  }
  static void tell(std::size_t w, const NodeAtPoint& c, std::vector<double>& own)
  {
    if (c.node >= 0)
      own.insert(own.end(), {static_cast<double>(w), static_cast<double>(c.node), static_cast<double>(c.subdomain),
                             static_cast<double>(c.body), static_cast<double>(c.local), c.at[0], c.at[1], c.at[2]});
  }

  const std::vector<deck::Place>& places_;
  const mesh::Catalogue& catalogue_;
  std::vector<std::vector<NodeAtPoint>> nearest_;
  std::vector<std::map<Global, NodeAtPoint>> named_;
};

std::vector<std::vector<Model::NodeAtPoint>> Model::candidates_at_points(const Communicator& comm) const
{
  const auto wanted = wanted_points(deck_);
  if (wanted.empty()) return {};
  std::vector<deck::Place> places;
  for (const auto& w : wanted) places.push_back(w.place);
  CandidatesAtPoints candidates(places, decomposition_.catalogue);
  for (const auto& subdomain : decomposition_.subdomains)
    for (const Local n : partition::surface_nodes(subdomain)) {
      const auto i = static_cast<std::size_t>(n);
      NodeAtPoint node;
      node.node = subdomain.mesh.node_id[i], node.subdomain = subdomain.id, node.body = subdomain.body, node.local = n;
      node.at = subdomain.mesh.points[i];
      for (std::size_t w = 0; w < places.size(); ++w) candidates.offer(w, node);
    }
  candidates.exchange(comm);
  return candidates.found();
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
      const auto first = static_cast<std::ptrdiff_t>(found.size());
      NodeAtPoint best;
      double sum = 0;
      for (const auto& c : candidates[next]) {
        if (c.node < 0 || !on_body[static_cast<std::size_t>(c.body)]) continue;
        if (c.distance < best.distance) best = c;
        if (!wanted[next].place.name.empty()) found.push_back(c), sum += c.share;
      }
      if (wanted[next].place.name.empty()) found.push_back(best), sum = best.share;
      std::for_each(found.begin() + first, found.end(),
                    [&](NodeAtPoint& node) { node.share /= sum * static_cast<double>(options.points.size()); });
    }
  };
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    auto& nodes = result.supports[i];
    choose(deck_.supports[i], nodes);
    std::set<Global> held;  // curves meet in nodes
    std::erase_if(nodes, [&](const NodeAtPoint& node) { return !held.insert(node.node).second; });
  }
  for (std::size_t i = 0; i < deck_.loads.size(); ++i) choose(deck_.loads[i], result.loads[i]);
  auto springs = result.springs.begin();
  for (const auto& [name, spring] : deck_.springs) choose(spring, *springs++);
  return result;
}

// A name must be that of nodes of a surface.
std::string Model::wrong_name(const std::string& name, const std::string& body, bool one,
                              const std::vector<NodeAtPoint>& candidates) const
{
  const auto& catalogue = decomposition_.catalogue;
  const auto sets =
      std::count_if(catalogue.node_sets.begin(), catalogue.node_sets.end(), [&](const auto& set) { return set.name == name; });
  if (sets > 1) return fmt::format("the mesh has a curve as well as points that are called \"{}\"; rename one of them", name);
  if (sets == 0) {
    const auto& boundaries = catalogue.boundaries;
    if (std::find(boundaries.begin(), boundaries.end(), name) != boundaries.end())
      return fmt::format("\"{0}\" is a boundary of the mesh; name it by `boundary: {0}`", name);
    std::vector<std::string> names;
    for (const auto& set : catalogue.node_sets) names.push_back(set.name);
    return fmt::format("the mesh has no curve or point \"{}\"{}", name, deck::suggestion(name, names));
  }
  const auto on_body = bodies_named(body);
  std::size_t count = 0, inside = 0;
  for (const auto& c : candidates) {
    if (c.node < 0)
      ++inside;
    else if (on_body[static_cast<std::size_t>(c.body)])
      ++count;
  }
  if (inside > 0)
    return fmt::format("{} nodes of \"{}\" lie inside a body; only nodes of surfaces can be held or loaded", inside, name);
  if (count == 0)
    return body.empty() ? fmt::format("no body has a node of \"{}\"", name)
                        : fmt::format("the body \"{}\" has no node of \"{}\"", body, name);
  if (one && count > 1)
    return fmt::format("a spring ends in one node, and \"{}\" has {}{}", name, count,
                       body.empty() ? "; where it has one a body, say which with `bodies`" : "");
  return "";
}

void Model::require_points(deck::Document& document, const Communicator& comm) const
{
  const auto wanted = wanted_points(deck_);
  if (wanted.empty()) return;
  const auto candidates = candidates_at_points(comm);
  const double reach = at_a_point * size_of(decomposition_, comm);
  collectively(comm, [&] {
    for (std::size_t w = 0; w < wanted.size(); ++w) {
      const auto& named = wanted[w].place.name;
      if (!named.empty()) {
        const auto why = wrong_name(named, wanted[w].body, wanted[w].path.starts_with("springs"), candidates[w]);
        if (!why.empty()) document.error(wanted[w].path, why);
        continue;
      }
      const Point at = place(wanted[w].place.at);
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
        document.error(wanted[w].path, fmt::format("no node of a surface lies at {}; the nearest is at {}, {:.3g} away", text(at),
                                                   text(nearest->at), nearest->distance));
      else if (count > 1)
        document.error(wanted[w].path, fmt::format("bodies {} have nodes at {}; say which is meant, with `{}`", there, text(at),
                                                   wanted[w].path.starts_with("springs") ? "bodies" : "body"));
    }
    document.check();
  });
}

}  // namespace mortise::model
