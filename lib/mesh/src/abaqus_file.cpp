// The mesh of an Abaqus or CalculiX input file [Abaqus Keywords Reference Guide; CalculiX CrunchiX USER'S MANUAL]: the cards
// *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE and *SOLID SECTION of one flat model. Its physics is not read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "abaqus_elements.hpp"
#include "base/error.hpp"
#include "gmsh_file.hpp"
#include "mesh/topology.hpp"
#include "raw_mesh.hpp"

namespace mortise::mesh {

namespace {

std::string upper(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r\""), last = text.find_last_not_of(" \t\r\"");
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line)
{
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= line.size();) {
    const auto comma = std::min(line.find(',', at), line.size());
    words.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  while (!words.empty() && words.back().empty()) words.pop_back();
  return words;
}

// One card: its name, its parameters, and the line that it stands in.
struct Card {
  std::string name;
  std::map<std::string, std::string> parameters;
  int line = 0;
  bool has(const std::string& key) const { return parameters.contains(key); }
};

using Numbers = std::vector<long long>;

class Reader {
 public:
  Reader(const Options& options, int dimension) : options_(options), dimension_(dimension) {}
  RawMesh read();

 private:
  struct Face {
    std::string of;  // element or set
    std::string side;
    int line;
  };
  [[noreturn]] void complain(int line, const std::string& what) const
  {
    throw Error(ExitStatus::bad_input, fmt::format("{}:{}: {}", options_.file, line, what));
  }
  long long number(const std::string& word, int line) const;
  double value(const std::string& word, int line) const;
  void begin(const std::string& line);
  void data(const std::string& line);
  void finish_element();
  void add_to_set(std::map<std::string, Numbers>& sets, const std::vector<std::string>& words);
  const std::string& known_name(const std::string& name);
  std::vector<std::string> bodies() const;
  void add_cells(RawMesh& raw);
  void add_element_sets(RawMesh& raw) const;
  void add_surfaces(RawMesh& raw) const;
  void add_node_sets(RawMesh& raw) const;

  struct Element {
    CellType type;
    std::vector<Local> nodes;  // in our order
  };

  const Options& options_;
  int dimension_;
  int line_ = 0;
  Card card_;
  bool over_ = false;                     // at *STEP
  Numbers pending_;                       // the element that is being read
  std::optional<CellType> pending_type_;  // of the card
  std::size_t pending_nodes_ = 0;         // 0: elements of this card are left out
  std::unordered_map<long long, Local> node_;
  std::vector<Point> points_;
  std::map<long long, Element> elements_;
  std::map<std::string, Numbers> element_sets_, node_sets_, sets_of_cards_;  // the last: by ELSET= of *ELEMENT alone
  std::map<std::string, std::vector<Face>> surfaces_;
  std::vector<std::string> sections_;
  std::map<std::string, std::string> spelling_;  // names are the same in capitals
  std::set<std::string> left_out_;
  std::string open_surface_;
};

long long Reader::number(const std::string& word, int line) const
{
  long long result = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), result);
  if (error != std::errc() || end != word.data() + word.size())
    complain(line, fmt::format("expected a number, found \"{}\"", word));
  return result;
}

double Reader::value(const std::string& word, int line) const
{
  auto text = word;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  if (!text.empty() && text.front() == '+') text.erase(0, 1);
  double result = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc() || end != text.data() + text.size())
    complain(line, fmt::format("expected a coordinate, found \"{}\"", word));
  return result;
}

// A name as it was spelled first.
const std::string& Reader::known_name(const std::string& name)
{
  return spelling_.emplace(upper(name), name).first->second;
}

void Reader::finish_element()
{
  if (pending_.empty()) return;
  complain(line_, fmt::format("element {} has {} nodes, its type needs {}", pending_[0], pending_.size() - 1, pending_nodes_));
}

void Reader::begin(const std::string& line)
{
  finish_element();
  const auto words = split(line.substr(1));
  card_ = {upper(words.empty() ? "" : words[0]), {}, line_};
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto equals = words[i].find('=');
    card_.parameters[upper(trimmed(words[i].substr(0, equals)))] =
        equals == std::string::npos ? "" : trimmed(words[i].substr(equals + 1));
  }
  static const std::set<std::string> ours{"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION"};
  static const std::set<std::string> harmless{"HEADING", "PREPRINT", "END PART"};
  static const std::set<std::string> refused{"PART",  "INSTANCE", "ASSEMBLY", "INCLUDE", "NGEN",    "NFILL",
                                             "NCOPY", "ELGEN",    "ELCOPY",   "SYSTEM",  "SUBMODEL"};
  if (refused.contains(card_.name))
    complain(line_,
             fmt::format("the card *{} is not understood: write the mesh as one flat model, all nodes and elements in this file "
                         "with numbers of their own",
                         card_.name));
  if (card_.name == "STEP") over_ = true;
  if (!ours.contains(card_.name)) {
    if (!harmless.contains(card_.name)) left_out_.insert("*" + card_.name);
    return;
  }
  const auto need = [&](const char* key) {
    if (!card_.has(key) || card_.parameters[key].empty()) complain(line_, fmt::format("*{} needs {}=", card_.name, key));
  };
  if (card_.name == "NODE" && card_.has("SYSTEM") && upper(card_.parameters["SYSTEM"]) != "R")
    complain(line_, "only nodes in rectangular coordinates are understood (no SYSTEM=)");
  if (card_.name == "NSET") {
    need("NSET");
    node_sets_[known_name(card_.parameters["NSET"])];
  }
  if (card_.name == "ELSET") {
    need("ELSET");
    element_sets_[known_name(card_.parameters["ELSET"])];
  }
  if (card_.name == "SOLID SECTION") {
    need("ELSET");
    sections_.push_back(known_name(card_.parameters["ELSET"]));
  }
  if (card_.name == "SURFACE") {
    need("NAME");
    open_surface_ = known_name(card_.parameters["NAME"]);
    const auto type = card_.has("TYPE") ? upper(card_.parameters["TYPE"]) : "ELEMENT";
    if (type != "ELEMENT" && type != "NODE")
      complain(line_, fmt::format("*SURFACE, TYPE={} is not understood; expected ELEMENT or NODE", type));
    surfaces_[open_surface_];
  }
  if (card_.name != "ELEMENT") return;
  need("TYPE");
  const auto type = element_type(upper(card_.parameters["TYPE"]), dimension_);
  if (!type.known)
    complain(
        line_,
        fmt::format("elements of type {} are not understood; known are C3D4, C3D6, C3D8, C3D10, C3D15, C3D20, CPE, CPS and CAX "
                    "of 3 to 8 nodes, and surface elements (S, M3D, SFM3D) for boundaries",
                    card_.parameters["TYPE"]));
  pending_type_ = type.type;
  const int d = type.type ? mesh::dimension(*type.type) : -1;
  pending_nodes_ = d == dimension_ || d == dimension_ - 1 ? static_cast<std::size_t>(node_count(*type.type)) : 0;
  if (d > dimension_) complain(line_, "a plane model cannot have elements with a volume");
}

void Reader::add_to_set(std::map<std::string, Numbers>& sets, const std::vector<std::string>& words)
{
  auto& set = sets[known_name(card_.parameters[card_.name])];
  if (card_.has("GENERATE")) {
    if (words.size() < 2) complain(line_, "expected first, last and step");
    const auto first = number(words[0], line_), last = number(words[1], line_),
               step = words.size() > 2 ? number(words[2], line_) : 1;
    if (step < 1 || last < first || (last - first) / step > 200000000) complain(line_, "expected first <= last and a step > 0");
    for (auto n = first; n <= last; n += step) set.push_back(n);
    return;
  }
  for (const auto& word : words) {
    if (word.empty()) continue;
    if (std::isdigit(static_cast<unsigned char>(word[0]))) {
      set.push_back(number(word, line_));
      continue;
    }
    const auto other = sets.find(known_name(word));
    if (other == sets.end()) complain(line_, fmt::format("there is no set \"{}\" before this line", word));
    const auto copy = other->second;
    set.insert(set.end(), copy.begin(), copy.end());
  }
}

void Reader::data(const std::string& line)
{
  const auto words = split(line);
  if (words.empty()) return;
  if (card_.name == "NODE") {
    if (words.size() < 3) complain(line_, "expected the number of a node and its coordinates");
    Point x = Point::Zero();
    for (std::size_t c = 0; c < 3 && c + 1 < words.size(); ++c)
      if (!words[c + 1].empty()) x[static_cast<Eigen::Index>(c)] = value(words[c + 1], line_);
    const auto n = number(words[0], line_);
    if (!node_.emplace(n, static_cast<Local>(points_.size())).second) complain(line_, fmt::format("node {} is given twice", n));
    points_.push_back(options_.scale * x);
    if (card_.has("NSET")) node_sets_[known_name(card_.parameters["NSET"])].push_back(n);
  } else if (card_.name == "ELEMENT" && pending_nodes_ > 0) {
    for (const auto& word : words) pending_.push_back(number(word, line_));
    if (pending_.size() <= pending_nodes_) return;  // it goes on in the next line
    if (pending_.size() > pending_nodes_ + 1) finish_element();
    std::vector<Local> nodes;
    for (std::size_t i = 1; i < pending_.size(); ++i) {
      const auto found = node_.find(pending_[i]);
      if (found == node_.end())
        complain(line_, fmt::format("element {} has the node {}, which is not given before it", pending_[0], pending_[i]));
      nodes.push_back(found->second);
    }
    const auto ours = *pending_type_ == CellType::line3 ? middle_last(nodes, points_) : cell(*pending_type_, nodes);
    if (!elements_.emplace(pending_[0], Element{*pending_type_, ours}).second)
      complain(line_, fmt::format("element {} is given twice", pending_[0]));
    if (card_.has("ELSET"))
      for (auto* sets : {&element_sets_, &sets_of_cards_}) (*sets)[known_name(card_.parameters["ELSET"])].push_back(pending_[0]);
    pending_.clear();
  } else if (card_.name == "NSET") {
    add_to_set(node_sets_, words);
  } else if (card_.name == "ELSET") {
    add_to_set(element_sets_, words);
  } else if (card_.name == "SURFACE") {
    if (card_.has("TYPE") && upper(card_.parameters["TYPE"]) == "NODE") {
      surfaces_.erase(open_surface_);
      auto& set = node_sets_[open_surface_];
      if (std::isdigit(static_cast<unsigned char>(words[0][0])))
        set.push_back(number(words[0], line_));
      else if (const auto other = node_sets_.find(known_name(words[0])); other != node_sets_.end())
        set.insert(set.end(), other->second.begin(), other->second.end());
      else
        complain(line_, fmt::format("there is no set of nodes \"{}\" before this line", words[0]));
      return;
    }
    surfaces_[open_surface_].push_back({words[0], words.size() > 1 ? upper(words[1]) : "", line_});
  }
}

// The sets that are bodies: those of *SOLID SECTION; without one those of *ELSET or, if these do not hold every cell once, of
// *ELEMENT.
std::vector<std::string> Reader::bodies() const
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

void Reader::add_cells(RawMesh& raw)
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
void Reader::add_element_sets(RawMesh& raw) const
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

void Reader::add_surfaces(RawMesh& raw) const
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
        complain(line, fmt::format("the surface \"{}\" names the ELSET \"{}\", which does not exist", name, of));
      for (const auto e : members) {
        const auto found = elements_.find(e);
        if (found == elements_.end())
          complain(line, fmt::format("the surface \"{}\" names element {}, which is not in the mesh", name, e));
        const auto& [type, nodes] = found->second;
        std::vector<int> corners;
        if (mesh::dimension(type) == dimension_ - 1) {
          for (int i = 0; i < corner_count(type); ++i) corners.push_back(i);
        } else {
          const auto table = abaqus_faces(first_order(type));
          if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || static_cast<std::size_t>(side[1] - '1') >= table.size())
            complain(line, fmt::format("expected a face S1 to S{} of element {}, found \"{}\"", table.size(), e, side));
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

// Sets of nodes are the faces of the surface of a volume all of whose corners are in the set; sets without one are left out.
void Reader::add_node_sets(RawMesh& raw) const
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
    for (const auto& face : outer)
      if (std::all_of(face.corners.begin(), face.corners.end(),
                      [&](Local n) { return n < 0 || in[static_cast<std::size_t>(n)]; }))
        boundary.faces.push_back(face.corners);
    const bool taken = std::any_of(raw.boundaries.begin(), raw.boundaries.end(), [&](const auto& b) { return b.name == name; });
    if (boundary.faces.empty() || taken)
      without.push_back(name);
    else
      raw.boundaries.push_back(std::move(boundary));
  }
  if (!without.empty())
    raw.warnings.push_back(
        fmt::format("these NSETs hold no whole face of a body, or a surface has their name: they are no boundaries: {}",
                    fmt::join(without, ", ")));
}

RawMesh Reader::read()
{
  std::ifstream stream(options_.file);
  if (!stream) fail(options_.file, "there is no such file, or it cannot be read");
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

}  // namespace

RawMesh read_abaqus(const Options& options, int dimension)
{
  return Reader(options, dimension).read();
}

}  // namespace mortise::mesh
