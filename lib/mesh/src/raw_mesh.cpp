// A RawMesh on its way out of a child process, and what must hold for any.
#include "raw_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "child.hpp"
#include "gmsh_file.hpp"
#include "mesh/extent.hpp"

namespace mortise::mesh {

namespace {

void put(const std::vector<std::string>& texts, Sender& to)
{
  to.count(texts.size());
  for (const auto& text : texts) to.text(text);
}

std::vector<std::string> get_texts(Child& from)
{
  std::vector<std::string> texts;
  for (auto n = from.count(); n > 0; --n) texts.push_back(from.text());
  return texts;
}

}  // namespace

void send(const RawMesh& raw, Sender& to)
{
  to.vector(raw.points);
  to.vector(raw.cells.type);
  to.vector(raw.cells.offset);
  to.vector(raw.cells.nodes);
  to.vector(raw.tag);
  to.vector(raw.volume);
  to.vector(raw.solid);
  put(raw.volumes, to);
  to.count(raw.boundaries.size());
  for (const auto& boundary : raw.boundaries) {
    to.text(boundary.name);
    to.vector(std::vector<int>{boundary.solid, boundary.strict ? 1 : 0});
    to.vector(boundary.faces);
  }
  to.count(raw.node_sets.size());
  for (const auto& set : raw.node_sets) {
    to.text(set.name);
    to.vector(set.nodes);
    to.vector(set.weights);
  }
  put(raw.warnings, to);
}

RawMesh receive(Child& from)
{
  RawMesh raw;
  from.vector(raw.points);
  from.vector(raw.cells.type);
  from.vector(raw.cells.offset);
  from.vector(raw.cells.nodes);
  from.vector(raw.tag);
  from.vector(raw.volume);
  from.vector(raw.solid);
  raw.volumes = get_texts(from);
  for (auto n = from.count(); n > 0; --n) {
    RawMesh::Boundary boundary{from.text(), -1, {}, true};
    std::vector<int> head;
    from.vector(head);
    if (head.size() == 2) boundary.solid = head[0], boundary.strict = head[1] != 0;
    from.vector(boundary.faces);
    raw.boundaries.push_back(std::move(boundary));
  }
  for (auto n = from.count(); n > 0; --n) {
    RawMesh::NodeSet set{from.text(), {}, {}};
    from.vector(set.nodes);
    from.vector(set.weights);
    raw.node_sets.push_back(std::move(set));
  }
  raw.warnings = get_texts(from);
  return raw;
}

void check(const RawMesh& raw, const std::string& file)
{
  const auto cells = raw.cells.size();
  const auto nodes = static_cast<Local>(raw.points.size());
  const auto in = [](const auto& list, auto first, auto end) {
    return std::all_of(list.begin(), list.end(), [&](auto x) { return x >= first && x < end; });
  };
  bool sound = raw.cells.offset.size() == cells + 1 && raw.cells.offset[0] == 0 && raw.tag.size() == cells &&
               raw.volume.size() == cells && (raw.solid.empty() || raw.solid.size() == cells) &&
               in(raw.cells.nodes, Local{0}, nodes) && in(raw.volume, 0, static_cast<int>(raw.volumes.size()));
  for (std::size_t c = 0; sound && c < cells; ++c)
    sound = static_cast<std::size_t>(raw.cells.type[c]) < cell_types &&
            raw.cells.offset[c + 1] - raw.cells.offset[c] == node_count(raw.cells.type[c]);
  sound = sound && raw.cells.offset[cells] == static_cast<Local>(raw.cells.nodes.size());
  for (const auto& boundary : raw.boundaries)
    for (const auto& face : boundary.faces) sound = sound && in(face, Local{-1}, nodes);
  for (const auto& set : raw.node_sets) sound = sound && set.nodes.size() == set.weights.size() && in(set.nodes, Local{0}, nodes);
  if (!sound) fail(file, "gmsh made a mesh of it that does not hold together; the file is likely damaged: write it anew");
  Point low = Point::Constant(HUGE_VAL), high = -low;
  for (const auto& x : raw.points) {
    if (!x.allFinite())
      fail(file, fmt::format("a node has the coordinates \"{} {} {}\" after mesh.scale; expected numbers", x[0], x[1], x[2]));
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double size = raw.points.empty() ? 0 : (high - low).maxCoeff();
  if (size > largest_size || size < smallest_size)
    fail(file, fmt::format("the mesh is {:.3g} long after mesh.scale; expected {:g} to {:g}: choose another unit of length", size,
                           smallest_size, largest_size));
}

}  // namespace mortise::mesh
