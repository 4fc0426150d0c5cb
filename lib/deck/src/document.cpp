#include "deck/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "base/error.hpp"
#include "scan.hpp"

namespace mortise::deck {

namespace {

// Of a deck's errors; of a word in a message.
constexpr std::size_t most_shown = 100;
constexpr std::size_t longest_word = 80;
constexpr std::size_t most_candidates = 16;  // that are listed one and all

[[noreturn]] void fail(const std::string& text)
{
  throw Error(ExitStatus::bad_input, text);
}

// Where something is wrong with a text as a whole.
std::string at(const std::string& file, const Flaw& flaw)
{
  return fmt::format("{}:{}: {}{}{}", file, flaw.line, flaw.path, flaw.path.empty() ? "" : ": ", flaw.message);
}

// The first line that a tab indents, from 1; 0: none.
int tab_indented(const std::string& text)
{
  int line = 1;
  bool indent = true;
  for (const char c : text) {
    if (c == '\t' && indent) return line;
    indent = c == '\n' || (indent && c == ' ');
    if (c == '\n') ++line;
  }
  return 0;
}

// What the parser objects to, for people.
std::string parser_error(const std::string& file, const std::string& text, const YAML::Exception& error)
{
  if (const int line = tab_indented(text); line > 0)
    return fmt::format("{}:{}: a tab indents this line; YAML takes spaces alone", file, line);
  std::string cure;
  if (error.msg == "illegal map value")
    cure = "; a value that holds a colon and a space takes quotes, and keys of one mapping are indented alike";
  else if (error.msg.find("flow") != std::string::npos)
    cure = "; look for a bracket or brace that is not closed";
  else if (error.msg.starts_with("end of map not found"))
    cure = "; this line is indented otherwise than the keys it belongs to";
  else if (error.msg.starts_with("end of sequence"))
    cure = "; this line is indented otherwise than the entry of a list that it belongs to";
  return fmt::format("{}:{}: this is not valid YAML: {}{}", file, error.mark.line + 1, error.msg, cure);
}

// One step of a path: a key or an index.
struct Step {
  std::string key;
  std::size_t index = 0;
  bool is_index = false;
};

std::vector<Step> split(const std::string& path)
{
  std::vector<Step> steps;
  std::string word;
  const auto flush = [&] {
    if (!word.empty()) steps.push_back({word});
    word.clear();
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '.') {
      if (i == 0 || i + 1 == path.size() || path[i - 1] == '.')
        fail(fmt::format("--set {}: a key of this path is empty; expected key.path=value, as solver.tolerance=1e-6", path));
      flush();
    } else if (path[i] == '[') {
      flush();
      const auto end = path.find(']', i);
      const auto digits = end == std::string::npos ? std::string() : path.substr(i + 1, end - i - 1);
      if (i == 0 || digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos || digits.size() > 6)
        fail(fmt::format("--set {}: expected a key and an index such as loads[0]", path));
      steps.push_back({{}, std::stoul(digits), true});
      i = end;
    } else {
      word += path[i];
    }
  }
  flush();
  return steps;
}

// The tree with every alias written out, so that what is set in one place does not show in another. Keys keep their lines.
YAML::Node written_out(const YAML::Node& node)
{
  if (!node.IsSequence() && !node.IsMap()) {
    YAML::Node result(node.Type());
    if (node.IsScalar()) result = node.Scalar();
    return result;
  }
  YAML::Node result(node.Type());
  if (node.IsSequence())
    for (const auto& entry : node) result.push_back(written_out(entry));
  else
    for (const auto& entry : node) result.force_insert(entry.first, written_out(entry.second));
  return result;
}

std::string parent(const std::string& path)
{
  const auto cut = path.find_last_of(".[");
  return cut == std::string::npos ? std::string() : path.substr(0, cut);
}

std::size_t edit_distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

}  // namespace

Document::Document(const std::string& text, std::string file, const std::vector<std::string>& settings) : file_(std::move(file))
{
  if (const auto flaw = foreign_characters(text)) fail(at(file_, *flaw));
  bool has_aliases = false;
  try {
    const auto found = scan(text);
    if (found.flaw) fail(at(file_, *found.flaw));
    if (found.next_document)
      fail(fmt::format("{}:{}: {}", file_, *found.next_document,
                       text.starts_with("---") || text.find("\n---") != std::string::npos
                           ? "a second document begins, after `---`; a deck is one document, give each its own file"
                           : "something stands behind the end of the deck; look for a comma or a bracket too many"));
    has_aliases = found.has_aliases;
    root_ = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    fail(parser_error(file_, text, error));
  }
  if (root_.IsNull()) fail(fmt::format("{}:1: the deck is empty", file_));
  if (!root_.IsMap()) fail(fmt::format("{}:1: a deck is a mapping of sections such as `mesh:` and `bodies:`", file_));
  if (has_aliases && !settings.empty()) root_ = written_out(root_);
  std::string misplaced;
  for (const auto& setting : settings) try {
      set(setting);
    } catch (const Error& error) {
      misplaced += (misplaced.empty() ? "" : "\n") + std::string(error.what());
    }
  if (!misplaced.empty()) fail(misplaced);
}

namespace {

// What --set gives, as a node.
YAML::Node value_of(const std::string& setting, const std::string& text)
{
  try {
    if (const auto flaw = scan(text).flaw) fail(fmt::format("--set {}: {}", setting, flaw->message));
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    fail(fmt::format("--set {}: the value is not valid YAML: {}", setting, error.msg));
  }
}

}  // namespace

void Document::set(const std::string& setting)
{
  if (foreign_characters(setting)) fail("--set: a setting is not UTF-8, or has characters that are no text; type it anew");
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) fail(fmt::format("--set {}: expected key.path=value", setting));
  const std::string path = setting.substr(0, equals);
  const auto value = value_of(setting, setting.substr(equals + 1));
  YAML::Node node = root_;
  std::string walked;
  for (auto step : split(path)) {
    const bool digits =
        !step.key.empty() && step.key.size() <= 6 && step.key.find_first_not_of("0123456789") == std::string::npos;
    if (digits && node.IsSequence()) step = {{}, std::stoul(step.key), true};  // loads.0 is loads[0]
    if (step.is_index) {
      if (!node.IsSequence() || step.index >= node.size())
        fail(fmt::format("--set {}: {} has no entry [{}]{}", setting, walked, step.index,
                         node.IsSequence() ? fmt::format(", only {}", node.size()) : " because it is no list"));
      walked += fmt::format("[{}]", step.index);
      node.reset(node[step.index]);
    } else {
      if (node.IsDefined() && !node.IsMap() && !node.IsNull())
        fail(fmt::format("--set {}: {} is no mapping, it has no key \"{}\"", setting, walked, step.key));
      walked += (walked.empty() ? "" : ".") + step.key;
      node.reset(node[step.key]);
    }
  }
  node = value;
  set_[walked] = setting;
}

void Document::locate(const std::string& path, const YAML::Node& node)
{
  lines_[path] = node.Mark().line + 1;
}

void Document::error(const std::string& path, const std::string& message)
{
  const std::string shown = path.empty() ? "" : path + ": ";
  for (std::string at = path; !at.empty(); at = parent(at))
    if (const auto found = set_.find(at); found != set_.end()) {
      errors_.push_back({0, fmt::format("--set {}: {}{}", found->second, shown, message)});
      return;
    }
  int line = 1;
  for (std::string at = path; !at.empty(); at = parent(at)) {
    const auto found = lines_.find(at);
    if (found == lines_.end()) continue;
    if (found->second > 0) {
      line = found->second;
      break;
    }
    // It has no line because a setting of something in it made it.
    const auto inner = set_.lower_bound(at);
    if (inner == set_.end() || inner->first.rfind(at, 0) != 0) continue;
    errors_.push_back({0, fmt::format("--set {}: {}{}", inner->second, shown, message)});
    return;
  }
  errors_.push_back({line, fmt::format("{}:{}: {}{}", file_, line, shown, message)});
}

void Document::check() const
{
  if (errors_.empty()) return;
  auto sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Complaint& a, const Complaint& b) { return a.line < b.line; });
  std::string text;
  for (std::size_t i = 0; i < std::min(sorted.size(), most_shown); ++i) text += (text.empty() ? "" : "\n") + sorted[i].text;
  if (sorted.size() > most_shown) text += fmt::format("\nand {} more", sorted.size() - most_shown);
  throw Error(ExitStatus::bad_input, text);
}

std::string nearest(const std::string& name, const std::vector<std::string>& candidates)
{
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const auto& candidate : candidates)
    if (const auto distance = edit_distance(name, candidate);
        distance < least && distance < std::max(name.size(), candidate.size())) {
      least = distance;
      best = candidate;
    }
  return best;
}

std::string suggestion(const std::string& name, const std::vector<std::string>& candidates)
{
  std::string text;
  if (const auto colon = name.find(':');
      colon != std::string::npos && std::find(candidates.begin(), candidates.end(), name.substr(0, colon)) != candidates.end())
    return fmt::format(", a space is missing after \"{}\"", name.substr(0, colon + 1));
  if (const auto near = nearest(name, candidates); !near.empty()) text += fmt::format(", did you mean \"{}\"?", near);
  if (candidates.empty()) return text;
  const auto shown = std::min<std::size_t>(candidates.size(), candidates.size() > most_candidates ? 8 : most_candidates);
  return text + fmt::format(" (there {} {}{})", candidates.size() == 1 ? "is" : "are",
                            fmt::join(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                            shown < candidates.size() ? fmt::format(", .. and {} more", candidates.size() - shown) : "");
}

std::string found(const YAML::Node& node)
{
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a mapping";
  const auto& word = node.Scalar();
  if (word.size() <= longest_word) return "\"" + word + "\"";
  std::size_t end = longest_word;
  while (end > 0 && (static_cast<unsigned char>(word[end]) & 0xc0) == 0x80) --end;  // not within a character
  return fmt::format("\"{}...\" ({} characters)", word.substr(0, end), word.size());
}

}  // namespace mortise::deck
