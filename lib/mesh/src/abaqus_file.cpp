// The mesh of an Abaqus or CalculiX input file [Abaqus Keywords Reference Guide; CalculiX CrunchiX USER'S MANUAL]: the cards
// *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE and *SOLID SECTION of one flat model. Its physics is not read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include "abaqus_elements.hpp"
#include "abaqus_reader.hpp"
#include "gmsh_file.hpp"
#include "mesh/topology.hpp"

namespace mortise::mesh {

// The sets that are bodies: those of *SOLID SECTION; without one those of *ELSET or, if these do not hold every cell once, of
// *ELEMENT.
std::vector<std::string> AbaqusReader::bodies() const
{
  if (!sections_.empty()) {
    auto names = sections_;
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
  }
  std::size_t cells = 0;
  const auto is_cell = [&](long long e) {
    const auto found = elements_.find(e);
    return found != elements_.end() && mesh::dimension(found->second.type) == dimension_;
  };
  for (const auto& [number, element] : elements_) cells += mesh::dimension(element.type) == dimension_ ? 1 : 0;
  std::vector<std::string> all;
  for (const bool of_cards : {false, true}) {
    std::vector<std::string> names;
    std::set<long long> held;
    std::size_t sum = 0;
    for (const auto& [name, members] : element_sets_) {
      if (of_cards != sets_of_cards_.contains(name)) continue;
      const std::set<long long> once(members.begin(), members.end());
      const auto own = static_cast<std::size_t>(std::count_if(once.begin(), once.end(), is_cell));
      if (own == 0) continue;
      names.push_back(name);
      all.push_back(name);
      sum += own;
      for (const auto e : once)
        if (is_cell(e)) held.insert(e);
    }
    if (!names.empty() && sum == cells && held.size() == cells) return names;
  }
  if (all.empty())
    fail(options_.file,
         "has no ELSET of cells: nothing says what the bodies are called; give *ELEMENT an ELSET=, or add *SOLID SECTION");
  fail(options_.file,
       fmt::format("cannot tell which ELSETs are the bodies ({}): neither those of *ELSET nor those of *ELEMENT hold every "
                   "cell exactly once; say it by *SOLID SECTION, ELSET=...",
                   fmt::join(all, ", ")));
}

void AbaqusReader::add_cells(RawMesh& raw)
{
  raw.volumes = bodies();
  std::map<long long, int> volume;
  for (std::size_t v = 0; v < raw.volumes.size(); ++v) {
    const auto set = element_sets_.find(raw.volumes[v]);
    if (set == element_sets_.end())
      fail(options_.file, fmt::format("*SOLID SECTION names the ELSET \"{}\", which does not exist", raw.volumes[v]));
    for (const auto e : set->second)
      if (const auto [at, fresh] = volume.emplace(e, static_cast<int>(v)); !fresh && at->second != static_cast<int>(v))
        fail(options_.file, fmt::format("element {} belongs to two bodies, \"{}\" and \"{}\"", e,
                                        raw.volumes[static_cast<std::size_t>(at->second)], raw.volumes[v]));
  }
  for (const auto& [number, element] : elements_) {
    if (mesh::dimension(element.type) != dimension_) continue;
    const auto found = volume.find(number);
    if (found == volume.end()) fail(options_.file, fmt::format("element {} is in no ELSET of a *SOLID SECTION", number));
    raw.cells.add(element.type, element.nodes);
    raw.tag.push_back(static_cast<std::size_t>(number));
    raw.volume.push_back(found->second);
  }
  if (raw.volume.empty()) fail(options_.file, fmt::format("holds no cells of dimension {}", dimension_));
}

// Sets of surface elements.
void AbaqusReader::add_element_sets(RawMesh& raw) const
{
  for (const auto& [name, members] : element_sets_) {
    RawMesh::Boundary boundary{name, -1, {}, true};
    for (const auto e : members) {
      const auto found = elements_.find(e);
      if (found == elements_.end() || mesh::dimension(found->second.type) != dimension_ - 1) continue;
      const auto& nodes = found->second.nodes;
      boundary.faces.push_back(face_key(std::span(nodes).first(static_cast<std::size_t>(corner_count(found->second.type)))));
    }
    const bool taken = surfaces_.contains(name);
    if (!boundary.faces.empty() && !taken) raw.boundaries.push_back(std::move(boundary));
  }
}

void AbaqusReader::add_surfaces(RawMesh& raw) const
{
  for (const auto& [name, lines] : surfaces_) {
    RawMesh::Boundary boundary{name, -1, {}, true};
    for (const auto& [of, side, line] : lines) {
      Numbers members;
      if (std::isdigit(static_cast<unsigned char>(of[0])))
        members.push_back(number(of, line));
      else if (const auto spelled = spelling_.find(upper(of));
               spelled != spelling_.end() && element_sets_.contains(spelled->second))
        members = element_sets_.at(spelled->second);
      else
        report_error(line, fmt::format("the surface \"{}\" names the ELSET \"{}\", which does not exist", name, of));
      for (const auto e : members) {
        const auto found = elements_.find(e);
        if (found == elements_.end())
          report_error(line, fmt::format("the surface \"{}\" names element {}, which is not in the mesh", name, e));
        const auto& [type, nodes] = found->second;
        std::vector<int> corners;
        if (mesh::dimension(type) == dimension_ - 1) {
          for (int i = 0; i < corner_count(type); ++i) corners.push_back(i);
        } else {
          const auto table = abaqus_faces(first_order(type));
          if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || static_cast<std::size_t>(side[1] - '1') >= table.size())
            report_error(line, fmt::format("expected a face S1 to S{} of element {}, found \"{}\"", table.size(), e, side));
          corners = table[static_cast<std::size_t>(side[1] - '1')];
        }
        std::vector<Local> face;
        for (const int c : corners) face.push_back(nodes[static_cast<std::size_t>(c)]);
        boundary.faces.push_back(face_key(face));
      }
    }
    raw.boundaries.push_back(std::move(boundary));
  }
}

// Sets of nodes are the faces of the surface of a volume all of whose corners are in the set; sets without one are nodes.
void AbaqusReader::add_node_sets(RawMesh& raw) const
{
  const auto all = sorted_faces(raw.cells);
  std::vector<CellFace> outer;
  const auto volume = [&](const CellFace& face) { return raw.volume[static_cast<std::size_t>(face.cell)]; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool same = i + 1 < all.size() && all[i].corners == all[i + 1].corners;
    if (!same || volume(all[i]) != volume(all[i + 1])) outer.push_back(all[i]);
    if (same) ++i;
  }
  std::vector<std::string> without;
  for (const auto& [name, members] : node_sets_) {
    std::vector<char> in(points_.size(), 0);
    for (const auto n : members) {
      const auto found = node_.find(n);
      if (found == node_.end())
        fail(options_.file, fmt::format("the NSET \"{}\" has the node {}, which does not exist", name, n));
      in[static_cast<std::size_t>(found->second)] = 1;
    }
    RawMesh::Boundary boundary{name, -1, {}, false};
    RawMesh::NodeSet set{name, {}, {}};
    for (const auto& face : outer)
      if (std::all_of(face.corners.begin(), face.corners.end(),
                      [&](Local n) { return n < 0 || in[static_cast<std::size_t>(n)]; }))
        boundary.faces.push_back(face.corners);
    const bool taken = std::any_of(raw.boundaries.begin(), raw.boundaries.end(), [&](const auto& b) { return b.name == name; });
    if (!boundary.faces.empty()) {
      if (!taken) raw.boundaries.push_back(std::move(boundary));
      if (taken) without.push_back(name);
      continue;
    }
    for (std::size_t n = 0; n < in.size(); ++n)
      if (in[n]) set.nodes.push_back(static_cast<Local>(n));
    set.weights.assign(set.nodes.size(), 1.0);
    raw.node_sets.push_back(std::move(set));
  }
  if (!without.empty())
    raw.warnings.push_back(
        fmt::format("a surface has the name of these NSETs, which are no boundaries: {}", fmt::join(without, ", ")));
}

RawMesh AbaqusReader::read()
{
  std::ifstream stream(options_.file);
  if (!stream) fail(options_.file, "there is no such file, or it cannot be read");
  std::error_code ignored;
  most_members_ = 1000000 + 20 * static_cast<long long>(std::filesystem::file_size(options_.file, ignored));
  for (std::string line; !over_ && std::getline(stream, line);) {
    ++line_;
    if (line.rfind("**", 0) == 0 || trimmed(line).empty()) continue;
    if (line[0] == '*') {
      for (std::string next; trimmed(line).ends_with(',') && std::getline(stream, next); ++line_) line = trimmed(line) + next;
      begin(line);
    } else {
      data(line);
    }
  }
  finish_element();
  if (points_.empty()) fail(options_.file, "holds no *NODE");
  RawMesh raw;
  if (dimension_ == 2) flatten(options_.file, points_);
  add_cells(raw);
  resolve_repeated_nodes(raw, options_.file, dimension_);  // before the faces of cells are looked for
  add_surfaces(raw);
  add_element_sets(raw);
  add_node_sets(raw);
  raw.points = points_;
  if (!left_out_.empty())
    raw.warnings.push_back(
        fmt::format("only the mesh is read; materials, supports, loads and contacts stand in the deck (left out: {})",
                    fmt::join(left_out_, ", ")));
  return raw;
}

RawMesh read_abaqus(const Options& options, int dimension)
{
  return AbaqusReader(options, dimension).read();
}

}  // namespace mortise::mesh
