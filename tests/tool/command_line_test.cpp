// SPDX-License-Identifier: Apache-2.0
// The description of the command line that help, completion and man pages are made from.
#include <gmock/gmock.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "cli/command_tree.h"
#include "cli/completion.h"
#include "cli/help.h"
#include "cli/nearest.h"
#include "cli/wrap.h"
#include "commands.h"
#include "io/temporary_folder.h"
#include "progress_line.h"

namespace vdbfuse::tool {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::StartsWith;

struct CommandLine {
  CLI::App app;
  Action action;
  CommandLine() { declareCommandLine(app, action); }
};

std::vector<CommandInfo> allCommands(const CLI::App& app) {
  std::vector<CommandInfo> commands = describeSubcommands(app);
  commands.push_back(describe(app));
  return commands;
}

TEST(CommandLine, EveryOptionHasAKindAndADefaultOrIsRequired) {
  const CommandLine line;
  std::vector<std::string> kinds;
  for (const ValueKind& kind : valueKinds()) kinds.emplace_back(kind.name);
  for (const CommandInfo& command : allCommands(line.app)) {
    for (const ArgumentInfo& option : command.options) {
      if (option.is_flag) continue;
      const std::string where = command.name + " " + option.name;
      EXPECT_THAT(kinds, testing::Contains(option.value)) << where;
      EXPECT_TRUE(option.required || !option.fallback.empty()) << where << " has no default";
      EXPECT_EQ(option.value == "WORD" || option.value == "WORDS", !option.choices.empty()) << where;
    }
  }
}

TEST(CommandLine, EveryTextBeginsWithACapitalLetterOrAValueAndEndsWithoutAStop) {
  const CommandLine line;
  for (const CommandInfo& command : allCommands(line.app)) {
    EXPECT_TRUE(std::isupper(command.summary.front())) << command.name;
    for (const ArgumentInfo& option : command.options) {
      EXPECT_FALSE(option.text.empty()) << command.name << " " << option.name;
      EXPECT_NE(option.text.back(), '.') << command.name << " " << option.name;
    }
  }
}

TEST(CommandLine, NoDefaultIsToldTwice) {
  const CommandLine line;
  for (const CommandInfo& command : allCommands(line.app))
    for (const ArgumentInfo& option : command.options)
      EXPECT_EQ(option.text.find("default"), std::string::npos) << command.name << " " << option.name;
}

// The words of an example as a shell would split them, up to a pipe or a remark.
std::string commandIn(const std::string& example) {
  const std::string begin = "vdbfuse ";
  const std::size_t from = example.find(begin);
  return example.substr(from + begin.size(), example.find_first_of("|#)", from) - from - begin.size());
}

TEST(CommandLine, EverySubcommandHasExamplesAndEachIsUnderstood) {
  const TemporaryFolder folder;
  std::ofstream(folder / "run.toml") << "[fuse]\ninput = \"scan\"\n";
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const CommandLine described;
  for (const CommandInfo& command : allCommands(described.app)) {
    EXPECT_FALSE(command.examples.empty()) << command.name;
    for (const std::string& example : command.examples) {
      CommandLine line;
      EXPECT_NO_THROW(line.app.parse(commandIn(example))) << example;
      EXPECT_TRUE(line.action.run) << example;
    }
  }
  std::filesystem::current_path(before);
}

TEST(CommandLine, HelpBeginsWithAnExample) {
  const CommandLine line;
  for (const CommandInfo& command : allCommands(line.app))
    EXPECT_THAT(helpOf(*command.app), StartsWith("Example: ")) << command.name;
}

TEST(CommandLine, HelpIsNoWiderThanAHundredColumns) {
  const CommandLine line;
  for (const CommandInfo& command : allCommands(line.app)) {
    std::istringstream help(helpOf(*command.app));
    for (std::string text; std::getline(help, text);) EXPECT_LE(text.size(), 100u) << text;
  }
}

TEST(CommandLine, CompletionKnowsEveryOptionOfEverySubcommand) {
  const CommandLine line;
  const std::string bash = bashCompletion(line.app), zsh = zshCompletion(line.app);
  for (const CommandInfo& command : describeSubcommands(line.app)) {
    for (const ArgumentInfo& option : command.options) {
      EXPECT_THAT(bash, HasSubstr(option.name)) << command.name;
      EXPECT_THAT(zsh, HasSubstr("'" + option.name + "[")) << command.name;
    }
  }
}

TEST(EditDistance, CountsLettersInsertedLeftOutReplacedAndSwapped) {
  EXPECT_EQ(editDistance("voxel", "voxel"), 0u);
  EXPECT_EQ(editDistance("voxl", "voxel"), 1u);
  EXPECT_EQ(editDistance("voxeel", "voxel"), 1u);
  EXPECT_EQ(editDistance("vaxel", "voxel"), 1u);
  EXPECT_EQ(editDistance("voxle", "voxel"), 1u);
  EXPECT_EQ(editDistance("", "voxel"), 5u);
}

TEST(EditDistance, IsTheSameBothWays) {
  for (const char* a : {"trim", "lambda", "sensor", ""})
    for (const char* b : {"rule", "lamdba", "sense", "mu"})
      EXPECT_EQ(editDistance(a, b), editDistance(b, a)) << a << " " << b;
}

TEST(Nearest, FindsTheMistypedWordAndNoneThatIsFar) {
  const std::vector<std::string> words = {"--voxel", "--view", "--trim", "--threads", "--thickness"};
  EXPECT_EQ(nearest("--voxl", words), "--voxel");
  EXPECT_EQ(nearest("--tirm", words), "--trim");
  EXPECT_EQ(nearest("--colour", words), std::nullopt);
}

TEST(Nearest, TakesTheBeginningOfOneWordForIt) {
  const std::vector<std::string> words = {"--resolution", "--no-denial", "--no-return"};
  EXPECT_EQ(nearest("--reso", words), "--resolution");
  EXPECT_EQ(nearest("--no-", words), std::nullopt);
}

TEST(Wrap, BreaksAtSpacesAndIndentsWhatFollows) {
  EXPECT_EQ(wrap("one two three", 8, 2), "one two\n  three");
  EXPECT_EQ(wrap("first\n\nsecond", 20, 2), "first\n\n  second");
}

TEST(TimeLeft, IsTheRestAtTheSpeedSoFar) {
  const TimeLeft time({{"read", 1}, {"cut", 3}});
  EXPECT_DOUBLE_EQ(time.after("read", 1.0, 10), 30);
  EXPECT_DOUBLE_EQ(time.after("cut", 0.5, 10), 6);
  EXPECT_DOUBLE_EQ(time.after("cut", 1.0, 10), 0);
}

TEST(TimeLeft, IsNotKnownOfAStepOutsideTheListNorAtTheVeryBeginning) {
  const TimeLeft time({{"read", 1}, {"cut", 3}});
  EXPECT_LT(time.after("colour", 0.5, 10), 0);
  EXPECT_LT(time.after("read", 0.1, 10), 0);
}

}  // namespace
}  // namespace vdbfuse::tool
