#include "mesh/instances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "mesh/curved_surface.hpp"

namespace mortise::mesh {

namespace {

Point point(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

// The powers of the entry's motion, from the first-th up to the one before the last-th. Each rotation is one by k times the
// angle, so that no rounding adds up in it.
std::vector<Motion> powers(const InstanceOptions& entry, int first, int last)
{
  std::vector<Motion> result;
  if (!entry.rotate) {
    for (int k = first; k < last; ++k) result.push_back({Eigen::Matrix3d::Identity(), k * point(entry.translate)});
    return result;
  }
  const Point axis = point(entry.rotate->axis).normalized(), centre = point(entry.rotate->center);
  const double angle = entry.rotate->angle * std::numbers::pi / 180;
  Point shift = Point::Zero();  // of all turns before
  for (int k = 0; k < last; ++k) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(k * angle, axis).toRotationMatrix();
    if (k >= first) result.push_back({rotation, centre - rotation * centre + shift});
    shift += rotation * point(entry.translate);
  }
  return result;
}

// 36, or 360/35.
void read_angle(RotationOptions& rotation, const YAML::Node& node, const std::string& path, deck::Document& document,
                const deck::Limits& limits)
{
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const auto slash = text.find('/');
  if (slash == std::string::npos) return deck::Codec<double>::read(rotation.angle, node, path, document, limits);
  double parts[2] = {0, 0};
  const auto before = document.error_count();
  deck::Codec<double>::read(parts[0], YAML::Node(text.substr(0, slash)), path, document, {});
  deck::Codec<double>::read(parts[1], YAML::Node(text.substr(slash + 1)), path, document, {});
  if (document.error_count() > before) return;
  if (parts[1] == 0) return document.error(path, "divides by zero");
  rotation.angle = parts[0] / parts[1];
}

// The name of a boundary without that of its body.
std::string own_name(const std::string& boundary, const std::string& group)
{
  if (boundary.size() > group.size() + 1 && boundary.rfind(group, 0) == 0 &&
      (boundary[group.size()] == '.' || boundary[group.size()] == '_'))
    return boundary.substr(group.size() + 1);
  return boundary;
}

// Node sets in the numbers of the assembly: of all instances, and those of each instance alone.
void place_node_sets(const std::vector<NodeSet>& sets, const std::vector<Global>& first_node, Layout& layout)
{
  auto& placed = layout.catalogue.node_sets;
  placed.clear();
  for (const auto& set : sets) {
    NodeSet all{set.name, {}, {}};
    std::map<std::string, NodeSet> own;
    for (std::size_t b = 0; b < layout.bodies.size(); ++b) {
      const auto& instance = layout.bodies[b];
      const auto& body = layout.catalogue.bodies[b];
      const auto part = static_cast<std::size_t>(instance.part);
      for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        if (set.nodes[i] < first_node[part] || set.nodes[i] >= first_node[part + 1]) continue;
        const auto add = [&](NodeSet& to) {
          to.nodes.push_back(set.nodes[i] + instance.node_shift);
          to.weights.push_back(set.weights[i]);
        };
        add(all);
        if (!body.instance.empty()) add(own[body.instance + "." + own_name(set.name, body.group)]);
      }
    }
    placed.push_back(std::move(all));
    for (auto& [name, nodes] : own) {
      nodes.name = name;
      placed.push_back(std::move(nodes));
    }
  }
}

}  // namespace

Motion compose(const Motion& second, const Motion& first)
{
  return {second.rotation * first.rotation, second(first.translation)};
}

double count_of(const std::vector<InstanceOptions>& instances)
{
  double sum = 0;  // which does not overflow
  for (const auto& entry : instances) sum += entry.count.value_or(1) * (entry.of.empty() ? 1 : count_of(entry.of));
  return sum;
}

std::vector<Motion> motions(const std::vector<InstanceOptions>& instances)
{
  std::vector<Motion> result;
  for (const auto& entry : instances) {
    const auto inner = entry.of.empty() ? std::vector<Motion>(1) : motions(entry.of);
    const int first = entry.count ? 0 : 1, last = entry.count ? *entry.count : 2;
    for (const auto& outer : powers(entry, first, last))
      for (const auto& motion : inner) result.push_back(compose(outer, motion));
  }
  return result;
}

std::optional<std::pair<std::size_t, std::size_t>> coinciding(const std::vector<Motion>& motions)
{
  double size = 0;
  for (const auto& m : motions) size = std::max(size, m.translation.norm());
  for (std::size_t j = 0; j < motions.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if ((motions[i].translation - motions[j].translation).norm() <= 1e-9 * size &&
          (motions[i].rotation - motions[j].rotation).norm() <= 1e-9)
        return std::pair(i, j);
  return {};
}

void describe(deck::Description<RotationOptions>& d)
{
  d.help("A turn about an axis.");
  d.key("axis", &RotationOptions::axis, "Direction of the axis, of any length; plane models: [0, 0, 1].");
  d.custom(
       "angle", "In degrees, right-handed about the axis; a number, or a quotient such as 360/35.", read_angle,
       [](const RotationOptions& rotation) { return deck::Codec<double>::write(rotation.angle); },
       [](const deck::Limits&) -> nlohmann::ordered_json {
         return {{"anyOf", {{{"type", "number"}}, {{"type", "string"}, {"pattern", "^[^/]+/[^/]+$"}}}}};
       })
      .required();
  d.key("center", &RotationOptions::center, "A point on the axis.");
  d.check([](const RotationOptions& rotation, const std::string& path, deck::Document& document) {
    if (point(rotation.axis).norm() == 0) document.error(path + ".axis", "expected a direction, found a vector of length zero");
  });
}

void describe(deck::Description<InstanceOptions>& d)
{
  d.help(
      "A copy of the body, or a row of copies: it is rotated by `rotate` first, then moved by `translate`, in the unit of the "
      "model "
      "(after mesh.scale).");
  d.key("count", &InstanceOptions::count,
        "So many copies: the first as the part lies in the mesh, the second moved once, the third twice, ...; absent: one copy, "
        "moved.")
      .at_least(1)
      .below(most_instances + 1);
  d.key("rotate", &InstanceOptions::rotate, "Turn, {axis, angle, center}; it comes before `translate`.");
  d.key("translate", &InstanceOptions::translate, "Shift, after `rotate`.");
  d.custom(
      "of", "What is copied, if not the part alone: a list of instances, which move together. So rows of rows are made.",
      [](InstanceOptions& entry, const YAML::Node& node, const std::string& path, deck::Document& document,
         const deck::Limits& limits) {
        deck::Codec<std::vector<InstanceOptions>>::read(entry.of, node, path, document, limits);
        if (node.IsSequence() && node.size() == 0) document.error(path, "expected at least one instance");
      },
      [](const InstanceOptions& entry) {
        return entry.of.empty() ? YAML::Node() : deck::Codec<std::vector<InstanceOptions>>::write(entry.of);
      },
      [](const deck::Limits&) -> nlohmann::ordered_json {
        return {{"type", "array"}, {"items", {{"type", "object"}}}};
      });
  d.check([](const InstanceOptions& entry, const std::string& path, deck::Document& document) {
    if (const double count = count_of({entry}); count > most_instances)
      document.error(path, fmt::format("makes {:.10g} copies; at most {} are possible", count, most_instances));
  });
}

Layout lay_out(Catalogue parts, const std::map<std::string, std::vector<Motion>>& instances,
               const std::vector<Global>& first_node, const std::vector<Global>& first_cell,
               const std::set<std::pair<int, int>>& on_part)
{
  Layout layout;
  auto& catalogue = layout.catalogue;
  catalogue = parts;
  catalogue.bodies.clear();
  Global nodes = 0, cells = 0;
  std::set<std::string> body_names, boundary_names(parts.boundaries.begin(), parts.boundaries.end());
  const auto add = [&](std::size_t part, Body body, const Motion* motion, const std::vector<int>& own) {
    if (!body_names.insert(body.name).second)
      throw Error(ExitStatus::bad_input,
                  fmt::format("an instance of the body \"{}\" and another body of the mesh are both called \"{}\"; give one of "
                              "them another name in the mesh",
                              body.group, body.name));
    catalogue.bodies.push_back(std::move(body));
    layout.bodies.push_back({static_cast<int>(part), motion ? std::optional(*motion) : std::nullopt, nodes - first_node[part],
                             cells - first_cell[part], own});
    nodes += first_node[part + 1] - first_node[part];
    cells += first_cell[part + 1] - first_cell[part];
  };
  for (std::size_t part = 0; part < parts.bodies.size();) {
    const auto group = parts.bodies[part].group;
    const auto found = instances.find(group);
    if (found == instances.end()) {
      add(part, parts.bodies[part], nullptr, {});
      ++part;
      continue;
    }
    std::size_t end = part;  // the bodies of one group stand side by side
    while (end < parts.bodies.size() && parts.bodies[end].group == group) ++end;
    for (std::size_t i = 0; i < found->second.size(); ++i) {
      const auto instance = fmt::format("{}.{}", group, i + 1);
      std::vector<int> own(parts.boundaries.size(), -1);
      for (std::size_t b = 0; b < parts.boundaries.size(); ++b) {
        const auto on = on_part.lower_bound({static_cast<int>(b), static_cast<int>(part)});
        if (curved_surface(parts.boundaries[b])) continue;
        if (on == on_part.end() || on->first != static_cast<int>(b) || on->second >= static_cast<int>(end)) continue;
        auto name = instance + "." + own_name(parts.boundaries[b], group);
        if (boundary_names.contains(name)) name = instance + "." + parts.boundaries[b];
        if (!boundary_names.insert(name).second)
          throw Error(ExitStatus::bad_input, fmt::format("two boundaries are called \"{}\": of an instance of \"{}\", and of the "
                                                         "mesh; give one of them another name in the mesh",
                                                         name, group));
        own[b] = static_cast<int>(catalogue.boundaries.size());
        catalogue.boundaries.push_back(name);
      }
      for (std::size_t p = part; p < end; ++p)
        add(p, {end - part == 1 ? instance : fmt::format("{}.{}", instance, p - part + 1), group, instance}, &found->second[i],
            own);
    }
    part = end;
  }
  catalogue.node_count = nodes;
  catalogue.cell_count = cells;
  place_node_sets(parts.node_sets, first_node, layout);
  return layout;
}

Mesh instantiate(Mesh piece, const PartInstance& instance, int body)
{
  for (auto& id : piece.node_id) id += instance.node_shift;
  for (auto& id : piece.cell_id) id += instance.cell_shift;
  std::fill(piece.cell_body.begin(), piece.cell_body.end(), body);
  if (instance.motion)
    for (auto& x : piece.points) x = (*instance.motion)(x);
  if (instance.own_boundary.empty()) return piece;
  auto& facets = piece.facets;
  for (std::size_t f = 0, count = facets.cells.size(); f < count; ++f) {
    const int own = instance.own_boundary[static_cast<std::size_t>(facets.boundary[f])];
    if (own < 0) continue;
    const std::vector<Local> nodes(facets.cells[f].begin(), facets.cells[f].end());
    facets.cells.add(facets.cells.type[f], nodes);
    facets.parent.push_back(facets.parent[f]);
    facets.boundary.push_back(own);
  }
  return piece;
}

}  // namespace mortise::mesh
