// The lines of an Abaqus file: cards, their parameters and their data.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "abaqus_elements.hpp"
#include "abaqus_reader.hpp"

namespace mortise::mesh {

namespace {

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

}  // namespace

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

long long AbaqusReader::number(const std::string& word, int line) const
{
  long long result = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), result);
  if (error != std::errc() || end != word.data() + word.size())
    report_error(line, fmt::format("expected a number, found \"{}\"", word));
  return result;
}

double AbaqusReader::value(const std::string& word, int line) const
{
  auto text = word;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  if (!text.empty() && text.front() == '+') text.erase(0, 1);
  double result = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc() || end != text.data() + text.size())
    report_error(line, fmt::format("expected a coordinate, found \"{}\"", word));
  if (!std::isfinite(result)) report_error(line, fmt::format("expected a finite coordinate, found \"{}\"", word));
  return result;
}

// A name as it was spelled first.
const std::string& AbaqusReader::known_name(const std::string& name)
{
  return spelling_.emplace(upper(name), name).first->second;
}

void AbaqusReader::finish_element()
{
  if (pending_.empty()) return;
  report_error(line_,
               fmt::format("element {} has {} nodes, its type needs {}", pending_[0], pending_.size() - 1, pending_nodes_));
}

void AbaqusReader::begin(const std::string& line)
{
  finish_element();
  const auto words = split(line.substr(1));
  card_ = {upper(words.empty() ? "" : words[0]), {}, line_};
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto equals = words[i].find('=');
    card_.parameters[upper(trimmed(words[i].substr(0, equals)))] =
        equals == std::string::npos ? "" : trimmed(words[i].substr(equals + 1));
  }
  if (!is_ours()) return;
  if (card_.parameters.contains("INPUT"))
    report_error(line_, fmt::format("the lines of *{} are in the file \"{}\"; write them into this one", card_.name,
                                    card_.parameters["INPUT"]));
  if (card_.name == "NODE") {
    begin_node();
  } else if (card_.name == "NSET") {
    need("NSET");
    node_sets_[known_name(card_.parameters["NSET"])];
  } else if (card_.name == "ELSET") {
    need("ELSET");
    element_sets_[known_name(card_.parameters["ELSET"])];
  } else if (card_.name == "SOLID SECTION") {
    need("ELSET");
    sections_.push_back(known_name(card_.parameters["ELSET"]));
  } else if (card_.name == "SURFACE") {
    begin_surface();
  } else {
    begin_elements();
  }
}

// Whether the card says something of the mesh.
bool AbaqusReader::is_ours()
{
  static const std::set<std::string> ours{"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION"};
  static const std::set<std::string> harmless{"HEADING", "PREPRINT", "END PART"};
  static const std::set<std::string> refused{"PART",  "INSTANCE", "ASSEMBLY", "INCLUDE", "NGEN",    "NFILL",
                                             "NCOPY", "ELGEN",    "ELCOPY",   "SYSTEM",  "SUBMODEL"};
  if (refused.contains(card_.name))
    report_error(
        line_,
        fmt::format("the card *{} is not understood: write the mesh as one flat model, all nodes and elements in this file "
                    "with numbers of their own, or let `mortise import` make a deck of the file",
                    card_.name));
  if (card_.name == "STEP") over_ = true;
  if (ours.contains(card_.name)) return true;
  if (!harmless.contains(card_.name)) left_out_.insert("*" + card_.name);
  return false;
}

void AbaqusReader::need(const char* key)
{
  if (!card_.has(key) || card_.parameters[key].empty()) report_error(line_, fmt::format("*{} needs {}=", card_.name, key));
}

void AbaqusReader::begin_node() const
{
  if (card_.has("SYSTEM") && upper(card_.parameters.at("SYSTEM")) != "R")
    report_error(line_, "only nodes in rectangular coordinates are understood (no SYSTEM=)");
}

void AbaqusReader::begin_surface()
{
  need("NAME");
  open_surface_ = known_name(card_.parameters["NAME"]);
  const auto type = card_.has("TYPE") ? upper(card_.parameters["TYPE"]) : "ELEMENT";
  if (type != "ELEMENT" && type != "NODE")
    report_error(line_, fmt::format("*SURFACE, TYPE={} is not understood; expected ELEMENT or NODE", type));
  surfaces_[open_surface_];
}

void AbaqusReader::begin_elements()
{
  need("TYPE");
  const auto type = element_type(upper(card_.parameters["TYPE"]), dimension_);
  if (!type.known)
    report_error(
        line_,
        fmt::format("elements of type {} are not understood; known are C3D4, C3D6, C3D8, C3D10, C3D15, C3D20, CPE, CPS and CAX "
                    "of 3 to 8 nodes, and surface elements (S, M3D, SFM3D) for boundaries",
                    card_.parameters["TYPE"]));
  pending_type_ = type.type;
  const int d = type.type ? mesh::dimension(*type.type) : -1;
  pending_nodes_ = d == dimension_ || d == dimension_ - 1 ? static_cast<std::size_t>(node_count(*type.type)) : 0;
  if (d > dimension_) report_error(line_, "a plane model cannot have elements with a volume");
}

// Short lines can name more numbers than there is memory for; those of nodes and elements in the file are fewer than its bytes.
void AbaqusReader::take_members(long long count)
{
  if (count > most_members_ - members_)
    report_error(line_,
                 fmt::format("this set would hold {} numbers, together with those before more than nodes and elements that a "
                             "file of this length can have",
                             count));
  members_ += count;
}

void AbaqusReader::add_to_set(std::map<std::string, Numbers>& sets, const std::vector<std::string>& words)
{
  auto& set = sets[known_name(card_.parameters[card_.name])];
  if (card_.has("GENERATE")) {
    if (words.size() < 2) report_error(line_, "expected first, last and step");
    const auto first = number(words[0], line_), last = number(words[1], line_),
               step = words.size() > 2 ? number(words[2], line_) : 1;
    if (step < 1 || last < first || first < 0) report_error(line_, "expected 0 <= first <= last and a step > 0");
    take_members((last - first) / step + 1);
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
    if (other == sets.end()) report_error(line_, fmt::format("there is no set \"{}\" before this line", word));
    const auto copy = other->second;
    take_members(static_cast<long long>(copy.size()));
    set.insert(set.end(), copy.begin(), copy.end());
  }
}

void AbaqusReader::data(const std::string& line)
{
  const auto words = split(line);
  if (words.empty()) return;
  if (card_.name == "NODE") {
    if (words.size() < 3) report_error(line_, "expected the number of a node and its coordinates");
    Point x = Point::Zero();
    for (std::size_t c = 0; c < 3 && c + 1 < words.size(); ++c)
      if (!words[c + 1].empty()) x[static_cast<Eigen::Index>(c)] = value(words[c + 1], line_);
    const auto n = number(words[0], line_);
    if (n < 1) report_error(line_, fmt::format("expected the number of a node, found {}", n));
    if (!node_.emplace(n, static_cast<Local>(points_.size())).second)
      report_error(line_, fmt::format("node {} is given twice", n));
    points_.push_back(options_.scale * x);
    if (card_.has("NSET")) node_sets_[known_name(card_.parameters["NSET"])].push_back(n);
  } else if (card_.name == "ELEMENT" && pending_nodes_ > 0) {
    for (const auto& word : words) pending_.push_back(number(word, line_));
    if (pending_.size() <= pending_nodes_) return;  // it goes on in the next line
    if (pending_.size() > pending_nodes_ + 1) finish_element();
    if (pending_[0] < 1) report_error(line_, fmt::format("expected the number of an element, found {}", pending_[0]));
    std::vector<Local> nodes;
    for (std::size_t i = 1; i < pending_.size(); ++i) {
      const auto found = node_.find(pending_[i]);
      if (found == node_.end())
        report_error(line_, fmt::format("element {} has the node {}, which is not given before it", pending_[0], pending_[i]));
      nodes.push_back(found->second);
    }
    const auto ours = *pending_type_ == CellType::line3 ? middle_last(nodes, points_) : cell(*pending_type_, nodes);
    if (!elements_.emplace(pending_[0], Element{*pending_type_, ours}).second)
      report_error(line_, fmt::format("element {} is given twice", pending_[0]));
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
        take_members(static_cast<long long>(other->second.size())),
            set.insert(set.end(), other->second.begin(), other->second.end());
      else
        report_error(line_, fmt::format("there is no set of nodes \"{}\" before this line", words[0]));
      return;
    }
    surfaces_[open_surface_].push_back({words[0], words.size() > 1 ? upper(words[1]) : "", line_});
  }
}

}  // namespace mortise::mesh
