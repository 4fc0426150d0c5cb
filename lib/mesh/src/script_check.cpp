// A script's words, without comments, are enough to see which macro calls which, and which names it gives values of its own.
#include "script_check.hpp"

#include <fmt/format.h>

#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "gmsh_file.hpp"

namespace mortise::mesh {

namespace {

struct Word {
  std::string text;
  int line;
};

// Names, numbers, strings (with the quote that begins them) and every other character in the script, but for spaces.
std::vector<Word> words_of(std::istream& script)
{
  std::vector<Word> words;
  int line = 1;
  std::string name;
  const auto end_name = [&] {
    if (!name.empty()) words.push_back({std::exchange(name, {}), line});
  };
  for (int c = script.get(); c != EOF; c = script.get()) {
    if (std::isalnum(c) || c == '_') {
      name += static_cast<char>(c);
      continue;
    }
    end_name();
    if (c == '/' && script.peek() == '/') {
      while (c != EOF && c != '\n') c = script.get();
    } else if (c == '/' && script.peek() == '*') {
      int before = 0;
      for (c = script.get(); c != EOF && !(before == '*' && c == '/'); c = script.get()) {
        before = c;
        if (c == '\n') ++line;
      }
    } else if (c == '"') {
      std::string text = "\"";
      for (c = script.get(); c != EOF && c != '"' && c != '\n'; c = script.get()) text += static_cast<char>(c);
      words.push_back({text, line});
    } else if (std::ispunct(c)) {
      words.push_back({std::string(1, static_cast<char>(c)), line});
    }
    if (c == '\n') ++line;
  }
  end_name();
  return words;
}

struct Call {
  std::string of;
  int line;
};
using Calls = std::map<std::string, std::vector<Call>>;

// The calls in each macro that no If and no For stands around.
Calls certain_calls(const std::vector<Word>& words)
{
  Calls calls;
  std::optional<std::string> inside;
  int conditions = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto& [word, line] = words[i];
    const auto next = [&] { return i + 1 < words.size() ? words[i + 1].text : std::string(); };
    const auto name = [&] { return next().starts_with('"') ? next().substr(1) : next(); };
    if (!inside) {
      if (word == "Macro" || word == "Function") inside = name(), conditions = 0;
      continue;
    }
    if (word == "If" || word == "For") ++conditions;
    if (word == "EndIf" || word == "EndFor") --conditions;
    if (word == "Return")
      inside.reset();  // gmsh takes the first one for the end, whatever stands around it
    else if (word == "Call" && conditions <= 0)
      calls[*inside].push_back({name(), line});
  }
  return calls;
}

// The names that stand in a DefineConstant, which leaves those that have a value theirs.
std::set<std::string> constants_of(const std::vector<Word>& words)
{
  std::set<std::string> names;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].text != "DefineConstant") continue;
    int depth = 0;
    for (++i; i < words.size(); ++i) {
      const auto& word = words[i].text;
      if (word == "[" || word == "(") ++depth;
      if ((word == "]" || word == ")") && --depth == 0) break;
      names.insert(word);
    }
  }
  return names;
}

}  // namespace

std::optional<int> overwritten_at(const std::string& name, std::istream& script)
{
  const auto words = words_of(script);
  if (constants_of(words).contains(name)) return std::nullopt;
  std::optional<int> line;
  bool first = true;   // that the name stands in the script
  int conditions = 0;  // and macros, which need not be called
  const auto text = [&](std::size_t i) { return i < words.size() ? words[i].text : std::string(); };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto& word = words[i].text;
    if (word == "If" || word == "For" || word == "Macro" || word == "Function") ++conditions;
    if (word == "EndIf" || word == "EndFor" || word == "Return") --conditions;
    if (word != name || !std::exchange(first, false)) continue;
    const bool begins = i == 0 || text(i - 1) == ";" || text(i - 1) == "]" || text(i - 1) == "}" || text(i - 1) == ")" ||
                        text(i - 1) == "EndIf" || text(i - 1) == "EndFor" || text(i - 1) == "Return";
    if (begins && conditions <= 0 && text(i + 1) == "=" && text(i + 2) != "=") line = words[i].line;
  }
  return line;
}

void check_script(const std::string& file, std::istream& script)
{
  script.clear();
  script.seekg(0);
  const auto calls = certain_calls(words_of(script));
  for (const auto& [macro, first] : calls) {
    std::set<std::string> reached;
    std::vector<Call> open = first;
    while (!open.empty()) {
      const auto call = open.back();
      open.pop_back();
      if (call.of == macro)
        fail(file, fmt::format("line {}: the macro \"{}\" calls itself, and no If ends that: gmsh would never come to an end",
                               call.line, macro));
      if (const auto found = calls.find(call.of); reached.insert(call.of).second && found != calls.end())
        open.insert(open.end(), found->second.begin(), found->second.end());
    }
  }
}

}  // namespace mortise::mesh
