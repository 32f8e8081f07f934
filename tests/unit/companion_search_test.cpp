// The search of mesh and step on runs whose errors are known.
#include "error_control/companion_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace traverse::error_control {
namespace {

/// Runs whose two peaks have errors of a known order in step and elements.
class KnownRuns : public Companions {
 public:
  double order = 4.0, in_time = 0.03, in_space = 0.03;  // errors of the second run
  double longest = 1.0;                                 // s: longer steps fail
  double noise = 0.0;                                   // of the second quantity, whatever the model is
  std::vector<Discretisation> done;

  bool run(const Discretisation& model) override {
    if (std::ranges::find(done, model) == done.end()) done.push_back(model);
    return model.step <= longest;
  }
  PeakErrors change(const Discretisation& coarse, const Discretisation& fine) override {
    PeakErrors changes{};
    changes[0] = changes[1] = std::abs(error(coarse) - error(fine));
    changes[1] += noise;
    return changes;
  }
  double seconds(const Discretisation& model) override { return (10.0 + model.elements) / model.step; }
  double error(const Discretisation& model) const {
    return in_time * std::pow(model.step / 0.05, order) + in_space * std::pow(8.0 / model.elements, order);
  }
  double cost() {
    double sum = 0.0;
    for (const Discretisation& model : done) sum += seconds(model);
    return sum;
  }
};

SearchTask task(double accuracy) {
  SearchTask task;
  task.accuracy = accuracy;
  task.wanted[0] = task.wanted[1] = true;
  task.coarse = {4, 0.1};
  task.fine = {8, 0.05};
  task.most_elements = 1000;
  return task;
}

TEST(CompanionSearch, KeepsTheAccuracyAtTheCostOfAboutOneMoreRun) {
  for (const double order : {2.0, 3.0, 4.0})
    for (const double accuracy : {1e-2, 1e-3}) {
      KnownRuns runs;
      runs.order = order;
      CompanionSearch search(runs, task(accuracy));
      search.run();
      EXPECT_TRUE(search.why_not(0).empty()) << search.why_not(0);
      EXPECT_LE(runs.error(search.model()), search.errors()[0]) << order << ' ' << accuracy;
      EXPECT_LE(search.errors()[0], accuracy);
      EXPECT_LT(runs.cost(), 3.0 * runs.seconds(search.model())) << order << ' ' << accuracy;
    }
}

TEST(CompanionSearch, TakesShorterStepsWhereLongOnesFail) {
  KnownRuns runs;
  runs.longest = 0.03;
  CompanionSearch search(runs, task(1e-3));
  search.run();
  EXPECT_LE(search.model().step, runs.longest);
  EXPECT_LE(runs.error(search.model()), 1e-3);
}

TEST(CompanionSearch, RefinesOnlyWhatIsOpen) {
  KnownRuns runs;
  runs.in_time = 1e-5;
  SearchTask given = task(1e-3);
  given.open_step = false;
  CompanionSearch search(runs, given);
  search.run();
  EXPECT_EQ(search.model().step, given.fine.step);
  EXPECT_GT(search.model().elements, given.fine.elements);
  EXPECT_LE(runs.error(search.model()), 1e-3);
}

TEST(CompanionSearch, RejectsWhatAGivenStepMakesInaccurate) {
  KnownRuns runs;
  SearchTask given = task(1e-3);
  given.open_step = false;
  given.open_mesh = false;
  CompanionSearch search(runs, given);
  search.run();
  EXPECT_NE(search.why_not(0).find("the error with the given step of 0.05 s is"), std::string::npos);
  EXPECT_EQ(search.model(), given.fine);
}

TEST(CompanionSearch, RejectsWhatDoesNotConvergeAndServesTheOthers) {
  KnownRuns runs, alone;
  runs.noise = 0.1;
  CompanionSearch search(runs, task(1e-2)), other(alone, task(1e-2));
  search.run();
  other.run();
  EXPECT_FALSE(search.why_not(1).empty());
  EXPECT_TRUE(search.why_not(0).empty());
  EXPECT_LE(search.errors()[0], 1e-2);
  EXPECT_LE(runs.seconds(search.model()), 8.0 * alone.seconds(other.model()));
}

TEST(CompanionSearch, LeavesTheLastRunToTheCaller) {
  KnownRuns whole, runs;
  CompanionSearch search(runs, task(1e-3)), complete(whole, task(1e-3));
  complete.run();
  search.run(true);
  ASSERT_TRUE(search.open());
  while (search.open()) {
    const Discretisation last = search.model();
    EXPECT_EQ(std::ranges::find(runs.done, last), runs.done.end());
    search.add_last(last);
  }
  EXPECT_EQ(search.model(), complete.model());
  EXPECT_EQ(search.errors(), complete.errors());
}

}  // namespace
}  // namespace traverse::error_control
