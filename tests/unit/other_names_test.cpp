// Options that PETSc 3.25 has renamed: either name will do, with every version of PETSc.
#include <gtest/gtest.h>
#include <petscsys.h>

#include <utility>

#include "base/petsc.hpp"
#include "options/petscrc.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/options/input.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using test::message_of;

Input input_of(std::vector<std::string> words) {
  words.insert(words.begin(), "traverse");
  Arguments arguments(std::move(words));
  return read_input(*arguments.argc(), *arguments.argv());
}

TEST(OtherNames, MeanTheSameWithEveryPetsc) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("a.yml", "ts: {time_step: 0.1, max_step_rejections: 7}\n");
  Input input = input_of({"-options_file", scene});
  ASSERT_TRUE(input.entries.has("ts_dt"));
  EXPECT_EQ(input.entries.find("ts_dt")->value, "0.1");
  EXPECT_EQ(input.entries.find("ts_dt")->where(), scene + ":1");
  EXPECT_EQ(input.entries.find("ts_max_reject")->value, "7");
  EXPECT_FALSE(input.entries.has("ts_time_step"));
  std::vector<std::string> words = {"traverse", "-skip_petscrc", "true", "-options_left", "false"};
  for (const auto& [option, value] : {std::pair(base::renamed_options[0], "0.1"), {base::renamed_options[1], "7"}})
    words.insert(words.end(), {std::string("-") + option.known(), value});
  EXPECT_EQ(input.petsc_words, words);
}

TEST(OtherNames, AreExplained) { EXPECT_EQ(help_text("-ts_time_step"), help_text("ts_dt")); }

TEST(OtherNames, AreRefusedBesideOneAnother) {
  const std::string message = message_of([] { input_of({"-ts_dt", "0.1", "-ts_time_step", "0.2"}); });
  EXPECT_EQ(
      message,
      "ts_time_step = 0.2 (command line): this is another name of ts_dt = 0.1 (command line); give only one of the "
      "two");
}

TEST(OtherNames, OfTheEnvironmentAreThoseThatPetscKnows) {
  const base::RenamedOption& step = base::renamed_options[0];
  for (const char* name : {step.name, step.newer}) {
    ASSERT_EQ(setenv("PETSC_OPTIONS", (std::string("-") + name + " 0.25").c_str(), 1), 0);
    Input input = input_of({});
    put_into_petsc(input);
    ASSERT_TRUE(in_force().has("ts_dt")) << name;
    EXPECT_EQ(in_force().find("ts_dt")->value, "0.25");
    PetscReal value = 0.0;
    PetscBool found = PETSC_FALSE;
    EXPECT_EQ(PetscOptionsGetReal(nullptr, nullptr, (std::string("-") + step.known()).c_str(), &value, &found), 0);
    EXPECT_EQ(value, 0.25);
    EXPECT_EQ(PetscOptionsHasName(nullptr, nullptr, (std::string("-") + step.unknown()).c_str(), &found), 0);
    EXPECT_EQ(found, PETSC_FALSE);
    ASSERT_EQ(PetscOptionsClear(nullptr), 0);
  }
}

}  // namespace
}  // namespace traverse::options
