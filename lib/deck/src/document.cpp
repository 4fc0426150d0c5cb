#include "deck/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "base/error.hpp"

namespace mortise::deck {

namespace {

[[noreturn]] void fail(const std::string& text)
{
  throw Error(ExitStatus::bad_input, text);
}

// Titles and names go into files that must be UTF-8; the JSON library is strict about it.
void check_encoding(const std::string& text, const std::string& file)
{
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) try {
      (void)nlohmann::json(line).dump();
    } catch (const nlohmann::json::exception&) {
      fail(fmt::format("{}:{}: this line is not UTF-8; save the deck in that encoding", file, number));
    }
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
      flush();
    } else if (path[i] == '[') {
      flush();
      const auto end = path.find(']', i);
      const auto digits = end == std::string::npos ? std::string() : path.substr(i + 1, end - i - 1);
      if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos || digits.size() > 6)
        fail(fmt::format("--set {}: expected an index such as [0]", path));
      steps.push_back({{}, std::stoul(digits), true});
      i = end;
    } else {
      word += path[i];
    }
  }
  flush();
  return steps;
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
  check_encoding(text, file_);
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    fail(fmt::format("{}:{}: this is not valid YAML: {}", file_, error.mark.line + 1, error.msg));
  }
  if (documents.empty() || documents.front().IsNull()) fail(fmt::format("{}:1: the deck is empty", file_));
  if (documents.size() > 1)
    fail(fmt::format("{}:{}: a second document begins, after `---`; a deck is one document, give each its own file", file_,
                     documents[1].Mark().line + 1));
  root_ = documents.front();
  if (!root_.IsMap()) fail(fmt::format("{}:1: a deck is a mapping of sections such as `mesh:` and `bodies:`", file_));
  std::string misplaced;
  for (const auto& setting : settings) try {
      set(setting);
    } catch (const Error& error) {
      misplaced += (misplaced.empty() ? "" : "\n") + std::string(error.what());
    }
  if (!misplaced.empty()) fail(misplaced);
}

void Document::set(const std::string& setting)
{
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) fail(fmt::format("--set {}: expected key.path=value", setting));
  const std::string path = setting.substr(0, equals);
  YAML::Node value;
  try {
    value = YAML::Load(setting.substr(equals + 1));
  } catch (const YAML::Exception& error) {
    fail(fmt::format("--set {}: the value is not valid YAML: {}", setting, error.msg));
  }
  YAML::Node node = root_;
  std::string walked;
  for (const auto& step : split(path)) {
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
  for (std::string at = path; !at.empty(); at = parent(at))
    if (const auto found = lines_.find(at); found != lines_.end() && found->second > 0) {
      line = found->second;
      break;
    }
  errors_.push_back({line, fmt::format("{}:{}: {}{}", file_, line, shown, message)});
}

void Document::check() const
{
  if (errors_.empty()) return;
  auto sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Complaint& a, const Complaint& b) { return a.line < b.line; });
  std::string text;
  for (const auto& complaint : sorted) text += (text.empty() ? "" : "\n") + complaint.text;
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
  if (const auto near = nearest(name, candidates); !near.empty()) text += fmt::format(", did you mean \"{}\"?", near);
  if (!candidates.empty() && candidates.size() <= 12)
    text += fmt::format(" (there {} {})", candidates.size() == 1 ? "is" : "are", fmt::join(candidates, ", "));
  return text;
}

std::string found(const YAML::Node& node)
{
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a mapping";
  return "\"" + node.Scalar() + "\"";
}

}  // namespace mortise::deck
