// A fit's results do not depend on how many ranks share its runs: to the last bit.
#include <gtest/gtest.h>

#include <cmath>

#include "support/folders.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

TEST(FitOnRanks, FitToAFrequencyAndASeries) {
  const std::string yaml = "options_file: " + source_folder() +
                           "/options/studies/fit_to_a_passage.yml\n"
                           "fit: {to: {first: {frequency: 1, value: 1.85, sd: 0.01}}, starts: 2}\n"
                           "model_modes: 2\nfit_to_midspan_to: 3.0\n";
  Results all = run_yaml(yaml, {}, MPI_COMM_WORLD);
  Results one = run_yaml(yaml, {}, MPI_COMM_SELF);
  for (const char* name : {"estimate", "standard_error", "starts/misfit", "series/midspan/computed"}) {
    EXPECT_EQ(all(std::string("/fit/") + name), one(std::string("/fit/") + name)) << name;
    for (const double value : all(std::string("/fit/") + name)) EXPECT_TRUE(std::isfinite(value)) << name;
  }
}

}  // namespace
}  // namespace traverse::test
