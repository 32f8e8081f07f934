// The choices of -ts_type: each in the help and in the documents.
#include "integrate/integrators.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/one_step_methods.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/scene_run.hpp"

namespace traverse::integrate {
namespace {

using test::contains;

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const base::MethodRow& row : base::methods()) list.emplace_back(row.name);
  for (const PetscType& type : petsc_types()) list.emplace_back(type.name);
  return list;
}

TEST(Integrators, AreInTheHelp) {
  const std::string help = integrators_help();
  for (const std::string& name : names()) EXPECT_PRED2(contains, help, "\n  " + name + " ");
  EXPECT_PRED2(contains, help, "default: esdirk4");
  EXPECT_PRED2(contains, help, "-ts_genalpha_radius (0.9)");
}

TEST(Integrators, AreInTheDocument) {
  std::ifstream file(source_folder() + "/doc/accuracy.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  const std::size_t begin = all.find("## Integrators");
  ASSERT_NE(begin, std::string::npos);
  const std::string section = all.substr(begin, all.find("\n## ", begin + 1) - begin);
  for (const std::string& name : names())
    EXPECT_TRUE(contains(section, "-ts_type " + name + "`") || contains(section, "`" + name + "`")) << name;
}

TEST(Integrators, AreNamedToSomebodyWhoMisspells) {
  const std::string message = test::message_of([] { test::run_scene("r1_moving_force", {{"ts_type", "esdrik4"}}); });
  for (const std::string& name : names()) EXPECT_PRED2(contains, message, name);
}

TEST(Integrators, ControlTheirStepsWhereTheyEstimateErrors) {
  const auto message = [](const std::string& type, const std::string& adapt) {
    return test::message_of([&] { test::run_scene("r1_moving_force", {{"ts_type", type}, {"ts_adapt_type", adapt}}); });
  };
  for (const std::string& name : names()) {
    const base::MethodRow* own = base::find_method(name);
    if (own != nullptr) {
      EXPECT_PRED2(contains, message(name, "basic"), "does not fit " + name + "; allowed: none, ladder (with esdirk4");
    }
    if (own == nullptr || !own->estimates_errors()) {
      EXPECT_PRED2(contains, message(name, "ladder"), "alone; ts_type is " + name);
    }
  }
}

TEST(Integrators, CheckTheirParameters) {
  for (const char* radius : {"-0.1", "1.5"}) {
    const std::string message = test::message_of([&] {
      test::run_scene("r1_moving_force", {{"ts_type", "genalpha"}, {"ts_genalpha_radius", radius}});
    });
    EXPECT_PRED2(contains, message, "ts_genalpha_radius = ");
    EXPECT_PRED2(contains, message, "allowed: 0 to 1");
  }
}

}  // namespace
}  // namespace traverse::integrate
