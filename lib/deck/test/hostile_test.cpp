// Decks that are made to break a reader, or broken in ways that readers do not notice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "deck/description.hpp"

namespace mortise::deck {
namespace {

struct Tree {
  std::string title;
  double height = 1;
  int age = 1;
  std::vector<Tree> children;
};

void describe(Description<Tree>& d)
{
  d.help("A tree.");
  d.key("title", &Tree::title, "Name.");
  d.key("height", &Tree::height, "Height.");
  d.key("age", &Tree::age, "Years.");
  d.custom(
      "children", "Trees.",
      [](Tree& tree, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits) {
        Codec<std::vector<Tree>>::read(tree.children, node, path, document, limits);
      },
      [](const Tree&) { return YAML::Node(); }, [](const Limits&) { return nlohmann::ordered_json{}; });
}

Tree read_tree(const std::string& text, const std::vector<std::string>& settings = {})
{
  Document document(text, "tree.yaml", settings);
  Tree tree;
  read(tree, document);
  document.check();
  return tree;
}

std::string complaints_of_tree(const std::string& text, const std::vector<std::string>& settings = {})
{
  try {
    read_tree(text, settings);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    return error.what();
  }
  return "";
}

void expect_complaint(const std::string& text, const std::string& expected)
{
  EXPECT_EQ(complaints_of_tree(text).substr(0, expected.size()), expected);
}

std::string repeated(const std::string& text, int times)
{
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

TEST(Hostile, AliasWithinItself)
{
  expect_complaint("height: 1\nchildren: &x [{height: 2, children: *x}]\n",
                   "tree.yaml:2: children[0].children: the alias stands within what it refers to");
  expect_complaint("&all\nheight: 1\nchildren:\n  - *all\n", "tree.yaml:4: children[0]: the alias stands within");
}

TEST(Hostile, AliasesThatMultiply)
{
  std::string text = "x0: &x0 [{height: 1}]\n";
  for (int i = 1; i < 30; ++i) {
    const auto entry = fmt::format("{{children: *x{}}}", i - 1);
    text += fmt::format("x{0}: &x{0} [{1}{2}]\n", i, repeated(entry + ", ", 9), entry);
  }
  expect_complaint(text + "children: *x29\n",
                   "tree.yaml:6: x5[6].children: the deck has more than 500000 entries once its aliases");
}

TEST(Hostile, AliasesThatDeepen)
{
  std::string text = "x0: &x0 [{height: 1}]\n";
  for (int i = 1; i < 1000; ++i) text += fmt::format("x{0}: &x{0} [{{children: *x{1}}}]\n", i, i - 1);
  expect_complaint(text, "tree.yaml:25: x24[0].children: the deck is nested more than 50 deep");
}

TEST(Hostile, Depth)
{
  for (const int depth : {51, 500, 100000}) {
    expect_complaint("height: " + repeated("[", depth) + repeated("]", depth), "tree.yaml:1: height");
    expect_complaint("height: " + repeated("{a: ", depth) + repeated("}", depth), "tree.yaml:1: height");
    expect_complaint(repeated("- ", depth) + "1", "tree.yaml:1: ");
  }
  EXPECT_EQ(complaints_of_tree(repeated("{children: [", 20) + "{height: 3}" + repeated("]}", 20)), "");
}

TEST(Hostile, SharedBranchesAreFine)
{
  const auto tree = read_tree("children: [&a {height: 3}, *a]\n");
  ASSERT_EQ(tree.children.size(), 2U);
  EXPECT_EQ(tree.children[1].height, 3);
}

TEST(Hostile, SettingsDoNotReachThroughAliases)
{
  const auto tree = read_tree("children: [&a {height: 3, age: 5}, *a, *a]\n", {"children[1].height=4"});
  EXPECT_EQ(tree.children[0].height, 3);
  EXPECT_EQ(tree.children[1].height, 4);
  EXPECT_EQ(tree.children[1].age, 5);
  EXPECT_EQ(tree.children[2].height, 3);
}

TEST(Hostile, Keys)
{
  expect_complaint("height: 1\n[1, 2]: 3\n", "tree.yaml:2: a key must be a word");
  expect_complaint("height: 1\n{a: b}: 3\n", "tree.yaml:2: a key must be a word");
  expect_complaint("height: 1\n~: 3\n", "tree.yaml:2: a key is empty");
  expect_complaint("children:\n  - {'': 3}\n", "tree.yaml:2: children[0]: a key is empty");
  expect_complaint(repeated("k", 300) + ": 3\n", "tree.yaml:1: a key of 300 characters");
  expect_complaint("\"height\\n\": 3\n", "tree.yaml:1: the key \"height...\" goes over several lines");
  expect_complaint("height: 3\nheight: 4\n", "tree.yaml:2: height: is given twice");
}

TEST(Hostile, CharactersThatAreNoText)
{
  // Where this one stands yaml-cpp ends the document as if it were complete.
  expect_complaint("height: 3\n\x04\nage: 1\n", "tree.yaml:2: character 1 of this line is no text (code 0x04)");
  expect_complaint(std::string("height: 3\nage: 1\0 2\n", 19), "tree.yaml:2: character 7 of this line is no text (code 0x00)");
  expect_complaint("height: \xc3\x28\n", "tree.yaml:1: this line is not UTF-8");
  EXPECT_EQ(complaints_of_tree("\xef\xbb\xbfheight: 3\r\nage: 2\r\n"), "");  // as some editors save it
}

TEST(Hostile, EscapesThatAreNoText)
{
  expect_complaint("title: \"a\\0b\"\n", "tree.yaml:1: title: character 2 of the value is no text (code 0x00)");
  expect_complaint("children:\n  - {\"he\\x04ight\": 3}\n", "tree.yaml:2: children[0]: a key has characters that are no text");
  EXPECT_EQ(read_tree("title: \"two\\nlines\"\n").title, "two\nlines");
}

TEST(Hostile, NumbersThatAreNone)
{
  for (const char* word :
       {".nan", "nan", "NaN", "inf", ".inf", "-.inf", "1e400", "-1e400", "0x10", "1e", "1,5", "1 2", "--1", "''", "1e5m"})
    for (const char* key : {"height", "age"})
      expect_complaint(std::string(key) + ": " + word + "\n", std::string("tree.yaml:1: ") + key + ": expected a ");
  for (const char* word : {"1e51", "-1e200", "1e-51", "-1e-300"})
    expect_complaint(std::string("height: ") + word + "\n", std::string("tree.yaml:1: height: \"") + word + "\" is too ");
  for (const char* word : {"3000000000", "-3000000000", "99999999999999999999999999", "1e20", "2147483648"})
    expect_complaint(std::string("age: ") + word + "\n", "tree.yaml:1: age: expected a whole number");
  EXPECT_EQ(read_tree("age: 2147483647\nheight: 1e50\n").age, 2147483647);
}

TEST(Hostile, LongTextsAreShortened)
{
  expect_complaint("height: " + repeated("\xc3\xa4", 1000) + "\n",
                   "tree.yaml:1: height: expected a number, found \"" + repeated("\xc3\xa4", 40) + "...\" (2000 characters)");
  std::string text;
  for (int i = 0; i < 500; ++i) text += "key" + std::to_string(i) + ": 1\n";
  EXPECT_TRUE(complaints_of_tree(text).ends_with("\nand 400 more"));
}

TEST(Hostile, SettingsWithoutAKey)
{
  for (const char* path : {".", "..", ".height", "height.", "children..height"})
    EXPECT_EQ(complaints_of_tree("height: 1\n", {std::string(path) + "=1"}),
              std::string("--set ") + path + ": a key of this path is empty; expected key.path=value, as solver.tolerance=1e-6");
  for (const char* path : {"[0]", "children[", "children[]", "children[-1]", "children[1", "children[99999999999]"})
    EXPECT_EQ(complaints_of_tree("height: 1\n", {std::string(path) + "=1"}),
              std::string("--set ") + path + ": expected a key and an index such as loads[0]");
  EXPECT_EQ(complaints_of_tree("height: 1\n", {"age=\xff"}),
            "--set: a setting is not UTF-8, or has characters that are no text; type it anew");
  EXPECT_EQ(complaints_of_tree("height: 1\n", {"children=&x [*x]"}).rfind("--set children=&x [*x]: the alias stands within", 0),
            0U);
}

}  // namespace
}  // namespace mortise::deck
