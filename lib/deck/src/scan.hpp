// A look at YAML before anything is built of it. Aliases make a short text as large as one likes, or without end; numbers of
// nodes and depths are those of the text with every alias written out.
#pragma once

#include <optional>
#include <string>

namespace mortise::deck {

/// What a deck cannot be: where, and what would help.
struct Flaw {
  int line;          ///< from 1
  std::string path;  ///< such as bodies.a.instances[0]; "" where there is none
  std::string message;
};

struct Scan {
  bool has_aliases = false;
  std::optional<Flaw> flaw;          ///< the first
  std::optional<int> next_document;  ///< the line, from 1, where another document begins
};

/// Whether a character is none of a text: not those that end lines, and no tab.
bool is_control(char c);

/// The first document in `text`, and whether another one follows: of `[],` the parser makes documents without end. Throws
/// YAML::Exception where it is no YAML; needs memory of the text's size.
Scan scan(const std::string& text);

/// The first line of `text` that is not UTF-8, or holds characters that are no text: YAML readers stop at some of them without a
/// word. None: all is well.
std::optional<Flaw> foreign_characters(const std::string& text);

}  // namespace mortise::deck
