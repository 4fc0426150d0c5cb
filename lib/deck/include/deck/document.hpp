// A deck as text: YAML with line numbers, settings from the command line laid over it, and the errors found in it.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace mortise::deck {

/// Errors are collected, so that one run reports all that is wrong. A path looks like `contacts[0].friction.coulomb`.
class Document {
 public:
  /// Parses `text` and lays `settings`, each "path=value" with a YAML value, over it. Throws Error(bad_input) where the text is
  /// no UTF-8, no YAML, not one mapping, larger or deeper than a deck can be once its aliases are written out, or settings cannot
  /// be placed (all of these at once).
  Document(const std::string& text, std::string file, const std::vector<std::string>& settings);

  const YAML::Node& root() const { return root_; }   ///< the deck as one mapping, settings included
  const std::string& file() const { return file_; }  ///< the name that messages begin with

  /// Remembers the line of `node` as that of `path`, for error().
  void locate(const std::string& path, const YAML::Node& node);
  /// Adds "file:line: path: message"; the line of the nearest enclosing path that is known.
  void error(const std::string& path, const std::string& message);
  /// Throws Error(bad_input) with all errors, in the order of lines, if there are any.
  void check() const;
  /// Errors so far.
  std::size_t error_count() const { return errors_.size(); }
  /// Remembers that the vector at `path` has two entries, as plane models may have; whether this one may is checked once the
  /// dimension is known.
  void note_pair(const std::string& path) { pairs_.insert(path); }
  /// The paths of note_pair().
  const std::set<std::string>& pairs() const { return pairs_; }

 private:
  struct Complaint {
    int line;
    std::string text;
  };
  void set(const std::string& setting);

  std::string file_;
  YAML::Node root_;
  std::map<std::string, int> lines_;        // path -> line, from 1; 0 for what --set created
  std::map<std::string, std::string> set_;  // path -> the setting that gave it its value
  std::vector<Complaint> errors_;
  std::set<std::string> pairs_;
};

/// The candidate that is nearest to `name` by edit distance, or "" if none is near.
std::string nearest(const std::string& name, const std::vector<std::string>& candidates);

/// `, did you mean "x"?` if something is near, and the list of candidates if it is short.
std::string suggestion(const std::string& name, const std::vector<std::string>& candidates);

/// How a node is shown in a message: its text in quotes, "a list" or "a mapping".
std::string found(const YAML::Node& node);

}  // namespace mortise::deck
