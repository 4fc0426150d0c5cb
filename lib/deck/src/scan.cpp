#include "scan.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace mortise::deck {

namespace {

// Far more than decks have: 10000 instances written one by one are some 200000 nodes, and 10 deep.
constexpr std::size_t most_nodes = 500000;
constexpr std::size_t most_levels = 50;
constexpr std::size_t longest_name = 200;

// Follows the parser. What is too large ends the walk by throwing; names are judged only if the text turns out to be YAML.
class Walk : public YAML::EventHandler {
 public:
  bool has_aliases = false;
  std::optional<Flaw> first_flaw;
  std::optional<int> first_line;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { OnScalar(mark, "", anchor, ""); }

  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& value) override
  {
    begin(mark);
    if (is_key()) name(mark, value);
    if (anchor) extents_[anchor] = {1, 1};
    end();
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override
  {
    has_aliases = true;
    for (const auto& frame : frames_)
      if (frame.anchor == anchor)
        throw flaw(mark,
                   "the alias stands within what it refers to, which has no end; write out what is meant, or refer to "
                   "something outside");
    const auto [nodes, levels] = extents_[anchor];
    count(mark, nodes);
    descend(mark, levels);
    if (is_key()) {
      if (levels > 1) keep(flaw(mark, no_name));
      frames_.back().key.assign(1, '*');
    }
    end();
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override
  {
    open(mark, anchor, false);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override
  {
    open(mark, anchor, true);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  static constexpr const char* no_name = "a key must be a word; found a list or a mapping (a name with [ or { takes quotes)";

  struct Frame {
    YAML::anchor_t anchor;
    bool is_map, awaits_key;
    std::size_t first;       // nodes counted before it
    std::size_t levels = 1;  // of what it holds, its own among them
    std::size_t entries = 0;
    std::string key = {};
  };
  struct Extent {
    std::size_t nodes, levels;
  };

  bool is_key() const { return !frames_.empty() && frames_.back().is_map && frames_.back().awaits_key; }

  Flaw flaw(const YAML::Mark& mark, const std::string& message) const
  {
    std::string path;
    for (const auto& frame : frames_)
      if (!frame.is_map)
        path += fmt::format("[{}]", frame.entries);
      else if (!frame.awaits_key)
        path.append(path.empty() ? "" : ".").append(frame.key);
    return {mark.line + 1, path, message};
  }

  void keep(Flaw flaw)
  {
    if (!first_flaw) first_flaw = std::move(flaw);
  }

  void count(const YAML::Mark& mark, std::size_t nodes)
  {
    nodes_ += nodes;
    if (nodes_ > most_nodes)
      throw flaw(mark, fmt::format("the deck has more than {} entries{}; shorten it (many copies of a body take `count`)",
                                   most_nodes, has_aliases ? " once its aliases (*name) are written out" : ""));
  }
  void descend(const YAML::Mark& mark, std::size_t levels)
  {
    if (frames_.size() + levels > most_levels)
      throw flaw(mark, fmt::format("the deck is nested more than {} deep{}; look for brackets that are not closed", most_levels,
                                   has_aliases ? " once its aliases (*name) are written out" : ""));
    if (!frames_.empty()) frames_.back().levels = std::max(frames_.back().levels, levels + 1);
  }
  void begin(const YAML::Mark& mark)
  {
    if (!first_line) first_line = mark.line + 1;
    count(mark, 1);
    descend(mark, 1);
  }
  void end()
  {
    if (frames_.empty()) return;
    auto& frame = frames_.back();
    if (!frame.is_map || !frame.awaits_key) ++frame.entries;
    if (frame.is_map) frame.awaits_key = !frame.awaits_key;
  }

  void name(const YAML::Mark& mark, const std::string& value)
  {
    if (value.empty()) keep(flaw(mark, "a key is empty; expected a word"));
    if (value.size() > longest_name)
      keep(flaw(mark, fmt::format("a key of {} characters, \"{}...\"; expected at most {}", value.size(), value.substr(0, 30),
                                  longest_name)));
    if (std::any_of(value.begin(), value.end(), is_control))
      keep(flaw(mark, "a key has characters that are no text; remove them"));
    if (std::any_of(value.begin(), value.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }))
      keep(flaw(mark, fmt::format("the key \"{}...\" goes over several lines; look for quotes that are not closed",
                                  value.substr(0, value.find_first_of("\n\r\t")))));
    frames_.back().key = value;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, bool is_map)
  {
    if (is_key()) keep(flaw(mark, no_name));
    begin(mark);
    frames_.push_back({anchor, is_map, is_map, nodes_ - 1});
  }
  void close()
  {
    const auto frame = frames_.back();
    frames_.pop_back();
    if (frame.anchor) extents_[frame.anchor] = {nodes_ - frame.first, frame.levels};
    if (!frames_.empty()) frames_.back().levels = std::max(frames_.back().levels, frame.levels + 1);
    end();
  }

  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, Extent> extents_;
  std::size_t nodes_ = 0;
};

}  // namespace

bool is_control(char c)
{
  const auto code = static_cast<unsigned char>(c);
  return (code < ' ' && c != '\t' && c != '\r' && c != '\n') || code == 0x7f;
}

Scan scan(const std::string& text)
{
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Walk walk, next;
  std::optional<int> next_document;
  try {
    parser.HandleNextDocument(walk);
    if (!walk.first_flaw && parser.HandleNextDocument(next)) next_document = next.first_line.value_or(1);
  } catch (const Flaw& flaw) {
    return {walk.has_aliases, flaw, {}};
  }
  return {walk.has_aliases, walk.first_flaw, next_document};
}

std::optional<Flaw> foreign_characters(const std::string& text)
{
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    try {
      (void)nlohmann::json(line).dump();  // the strictest of those that get to see the text
    } catch (const nlohmann::json::exception&) {
      return Flaw{number, "", "this line is not UTF-8; save the deck in that encoding"};
    }
    if (const auto found = std::find_if(line.begin(), line.end(), is_control); found != line.end())
      return Flaw{number, "",
                  fmt::format("character {} of this line is no text (code {:#04x}); remove it", found - line.begin() + 1,
                              static_cast<unsigned char>(*found))};
  }
  return {};
}

}  // namespace mortise::deck
