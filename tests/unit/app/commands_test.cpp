// SPDX-License-Identifier: BSD-3-Clause
// The command line: what it asks for, and what is said of a wrong call.
#include "app/commands.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rhexis::app {
namespace {

Command parsed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "rhexis");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return parse_command_line(static_cast<int>(argv.size()), argv.data(), parallel::Communicator::world());
}

TEST(CommandLine, OfARun) {
  const Command c = parsed({"run", "a.toml", "-o", "there", "--set", "time.end=1 ms", "--set",
                            "load.pressure=200 kPa", "--restart", "step.h5", "--overwrite", "--quiet"});
  EXPECT_EQ(c.action, Action::run);
  EXPECT_EQ(c.file, "a.toml");
  EXPECT_EQ(c.directory, "there");
  EXPECT_EQ(c.overrides, (std::vector<std::string>{"time.end=1 ms", "load.pressure=200 kPa"}));
  EXPECT_EQ(c.restart, "step.h5");
  EXPECT_TRUE(c.overwrite);
  EXPECT_TRUE(c.quiet);
  EXPECT_EQ(c.arguments.size(), 13u);
}

TEST(CommandLine, HasNothingThatIsNotAskedFor) {
  const Command c = parsed({"check", "a.toml"});
  EXPECT_EQ(c.action, Action::check);
  EXPECT_EQ(c.directory, "");
  EXPECT_TRUE(c.overrides.empty());
  EXPECT_FALSE(c.overwrite || c.quiet || c.embedded);
}

TEST(CommandLine, OfKeys) {
  EXPECT_EQ(parsed({"keys"}).section, "");
  const Command c = parsed({"keys", "load.pressure"});
  EXPECT_EQ(c.action, Action::keys);
  EXPECT_EQ(c.section, "load.pressure");
}

TEST(CommandLine, ThatIsWrongLeavesNothingToDo) {
  const std::vector<std::vector<std::string>> calls = {
      {},
      {"run"},
      {"simulate", "a.toml"},
      {"run", "a.toml", "--restart"},
      {"run", "a.toml", "-o", ""},
      {"run", "a\nb.toml"},
      {"run", "a.toml", "--faster"},
      {"check", "a.toml", "--overwrite"},
  };
  for (const std::vector<std::string>& call : calls) {
    const Command c = parsed(call);
    EXPECT_EQ(c.action, Action::nothing) << testing::PrintToString(call);
    EXPECT_EQ(c.status, 2) << testing::PrintToString(call);
  }
}

TEST(CommandLine, ThatAsksForTextOnlyEndsWell) {
  for (const char* word : {"--help", "--version"}) {
    const Command c = parsed({word});
    EXPECT_EQ(c.action, Action::nothing) << word;
    EXPECT_EQ(c.status, 0) << word;
  }
}

TEST(Keys, AskedForByAWrongNameAreAnInputError) {
  EXPECT_THROW(carry_out(parsed({"keys", "lode"}), parallel::Communicator::world()), InputError);
}

TEST(Run, OfAFileThatIsNotThereIsAnInputError) {
  for (const char* action : {"run", "check"})
    EXPECT_THROW(carry_out(parsed({action, "no_such.toml"}), parallel::Communicator::world()), InputError);
}

}  // namespace
}  // namespace rhexis::app
