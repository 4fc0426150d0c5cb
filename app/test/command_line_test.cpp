#include "command_line.hpp"

#include <gtest/gtest.h>

namespace mortise {
namespace {

Parsed parse(std::vector<const char*> words)
{
  words.insert(words.begin(), "mortise");
  return parse_command_line(static_cast<int>(words.size()), words.data());
}

TEST(CommandLine, KnowsItsOptions)
{
  const auto parsed = parse({"a.yaml", "--set", "solver.tolerance=1e-6", "--set", "title=x", "--output", "out", "--check"});
  ASSERT_TRUE(parsed.command_line);
  EXPECT_EQ(parsed.command_line->deck, "a.yaml");
  EXPECT_EQ(parsed.command_line->settings, (std::vector<std::string>{"solver.tolerance=1e-6", "title=x"}));
  EXPECT_EQ(parsed.command_line->output, "out");
  EXPECT_TRUE(parsed.command_line->check);
  EXPECT_EQ(parse({"--help"}).status, 0);
  EXPECT_NE(parse({"--version"}).text.find("mortise "), std::string::npos);
  EXPECT_EQ(parse({}).status, 1);
  EXPECT_EQ(parse({"a.yaml", "--frobnicate"}).status, 1);
  EXPECT_EQ(parse({"a.yaml", "b.yaml"}).status, 1);
  EXPECT_NE(parse({"a.yaml", "--set", "title=x", "dimension=2"}).text.find("its own --set"), std::string::npos);
}

}  // namespace
}  // namespace mortise
