// Problems in a program: results of single runs and of many, observers, tables and changes of its own, and refusals.
#include "traverse/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "support/scene_run.hpp"

namespace traverse {
namespace {

Problem force_over_bridge() {
  return {{"beam_spans", 20.0}, {"beam_EI", 3e10},    {"beam_mass", 1.8e4},
          {"load_forces", 1e5}, {"load_speed", 30.0}, {"beam_damping_ratios", 0.01}};
}

constexpr auto deflection = &ProbeResult::deflection;

TEST(Simulate, HasTheStaticDeflectionOfASlowForce) {
  Problem slow = force_over_bridge();
  slow.set("load_speed", 0.5).set("ts_dt", 0.02).set("beam_elements_per_span", 4);
  const Result result = simulate(slow);
  const double exact = 1e5 * std::pow(20.0, 3) / (48.0 * 3e10);
  ASSERT_EQ(result.probes.size(), 1u);
  EXPECT_EQ(result.probes[0].x, 10.0);
  EXPECT_NEAR(result.probes[0].deflection.value / exact, 1.0, 5e-3);
  EXPECT_NEAR(result.probes[0].static_deflection / exact, 1.0, 1e-6);
  EXPECT_NEAR(result.probes[0].deflection.time, 20.0, 1.0);
  EXPECT_LT(result.energy_residual, 1e-6);
  EXPECT_TRUE(std::isnan(result.least_wheel_force));
}

TEST(Simulate, ComputesProblemsThatDifferInNumbersAsAStudy) {
  std::vector<Problem> problems;
  for (const double speed : {20.0, 40.0, 30.0})
    for (const double EI : {3e10, 4e10})
      problems.push_back(force_over_bridge().set("load_speed", speed).set("beam_EI", EI));
  problems.push_back(force_over_bridge().set("beam_spans", {20.0, 20.0}));
  problems.push_back(problems[1]);
  const std::vector<Result> results = simulate(problems);
  ASSERT_EQ(results.size(), problems.size());
  EXPECT_EQ(results[6].probes.size(), 2u);
  EXPECT_EQ(results[7].largest(deflection).value, results[1].largest(deflection).value);
  for (std::size_t i = 0; i < results.size(); ++i)
    EXPECT_NEAR(results[i].largest(deflection).value / simulate(problems[i]).largest(deflection).value, 1.0, 2e-3) << i;
}

TEST(Simulate, KnowsNothingOfOtherProblems) {
  Problem with_table = force_over_bridge(), other = force_over_bridge();
  with_table.table("stiffness", {{0.0, 20.0}, {3e10, 3e10}}).set("beam_EI", "stiffness");
  EXPECT_NEAR(simulate(with_table).largest(deflection).value / simulate(other).largest(deflection).value, 1.0, 1e-4);
  EXPECT_THROW((void)other.set("beam_EI", "stiffness").scene(), InputError);
}

/// Counts samples, and ends the run after some.
class Counter : public Observer {
 public:
  explicit Counter(int most) : most_(most) {}
  void begin(Instant& now) override { begun = now.time() == 0.0; }
  bool sample(Instant& now) override {
    EXPECT_NEAR(now.time(), 0.01 * ++samples, 1e-12);
    largest = std::max(largest, std::abs(now.read("/probes/deflection")[0]));
    return samples < most_;
  }
  void end(const Result& result) override { peak = result.largest(deflection).value; }
  bool begun = false;
  int samples = 0;
  double largest = 0.0, peak = 0.0;

 private:
  int most_;
};

TEST(Simulate, IsFollowedAndEndedByObservers) {
  const Problem problem = force_over_bridge().set("output_interval", 0.01).set("ts_max_time", 0.5);
  Counter all(1000), some(20);
  const Result whole = simulate(problem, {&all});
  EXPECT_TRUE(all.begun);
  EXPECT_EQ(all.samples, 50);
  EXPECT_EQ(all.peak, whole.largest(deflection).value);
  EXPECT_NEAR(all.largest / all.peak, 1.0, 1e-2);
  EXPECT_LT(simulate(problem, {&some}).largest(deflection).value, all.peak);
  EXPECT_EQ(some.samples, 20);
}

TEST(Simulate, PassesOnWhatAnObserverThrows) {
  class Thrower : public Observer {
   public:
    bool sample(Instant& now) override { return now.read("/probes/deflections").empty(); }
  } unknown_name;
  const Problem problem = force_over_bridge().set("output_interval", 0.1).set("ts_max_time", 0.5);
  EXPECT_THROW((void)simulate(problem, {&unknown_name}), RunsFailed);
  class Own : public Observer {
    bool sample(Instant& /*now*/) override { throw std::out_of_range("own"); }
  } own;
  EXPECT_THROW((void)simulate(problem, {&own}), std::out_of_range);
}

/// An actuator under midspan that carries a part of what the force weighs.
class Prop : public Observer {
 public:
  void begin(Instant& now) override { now.set_beam_force(10.0, 5e4); }
};

TEST(Simulate, HasForcesOfObservers) {
  Problem standing = force_over_bridge();
  standing.set("load_speed", 0.0)
      .set("load_positions", 10.0)
      .set("ts_max_time", 60.0)
      .set("model_modes", 0)
      .set("ts_dt", 0.02)
      .set("output_interval", 1.0)
      .set("beam_elements_per_span", 4)
      .set("ts_type", "genalpha");
  class Last : public Prop {
   public:
    bool sample(Instant& now) override {
      last = now.read("/probes/deflection")[0];
      return true;
    }
    double last = 0.0;
  } prop;
  (void)simulate(standing, {&prop});
  EXPECT_NEAR(prop.last / (-0.5 * 1e5 * std::pow(20.0, 3) / (48.0 * 3e10)), 1.0, 1e-4);
}

/// Half the stiffness of another law.
class Half : public contact::ElasticLaw {
 public:
  double force(double a) const override { return 0.5 * 1.6e6 * a; }
  double stiffness(double) const override { return 0.5 * 1.6e6; }
  double energy(double a) const override { return 0.25 * 1.6e6 * a * a; }
};

TEST(Simulate, HasLawsOfTheProgramInManyRuns) {
  const std::string wheel =
      "beam: {spans: 20.0, EI: 8.3e9, mass: 2303.0, elements_per_span: 4}\nvehicle:\n  wheel:\n"
      "    {bodies: [axle], drivers: [level], wheels: [wheel], axle: {mass: 5750.0, inertia: 100.0, position: [0, "
      "0.46]},\n"
      "     level: {body: axle, coordinate: phi, value: 0.0},\n"
      "     wheel: {body: axle, radius: 0.46, law: linear, stiffness: 8e5}}\n"
      "train: {vehicles: wheel, speed: 30.0}\nts: {dt: 2e-3}\n";
  Problem with_law = Problem::from_yaml(wheel);
  with_law.change([](scene::Scene& scene) {
    scene.vehicles[0].wheels[0].law.kind = contact::LawKind::other;
    scene.vehicles[0].wheels[0].law.elastic = std::make_shared<Half>();
  });
  std::vector<Problem> own, same;
  for (const double speed : {20.0, 30.0, 40.0}) {
    same.push_back(Problem::from_yaml(wheel).set("train_speed", speed));
    own.push_back(Problem(with_law).set("train_speed", speed));
  }
  const std::vector<Result> by_law = simulate(own), by_kind = simulate(same);
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_NEAR(by_law[i].largest(deflection).value / by_kind[i].largest(deflection).value, 1.0, 1e-6) << i;
    EXPECT_NEAR(by_law[i].greatest_wheel_force / by_kind[i].greatest_wheel_force, 1.0, 1e-5) << i;
  }
}

TEST(Simulate, RefusesWhatIsNoRunBeforeItComputes) {
  const Problem good = force_over_bridge();
  const auto message = [](const std::vector<Problem>& problems) {
    try {
      (void)simulate(problems);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({good, Problem(good).set("beam_EI", -1.0)}).find("problem 1: beam_EI"), std::string::npos);
  EXPECT_NE(message({Problem(good).set("beam_IE", 1.0)}).find("beam_IE"), std::string::npos);
  EXPECT_NE(message({Problem(good).set("study_vary_load_speed", {20.0, 30.0})}).find("one run"), std::string::npos);
  EXPECT_THROW(Problem(good).table("t", {{0.0, 1.0}, {2.0}}), InputError);
  EXPECT_THROW(Problem(good).table(
                   "t", [](double x) { return x; }, 0.0, 1.0, 0.3),
               InputError);
}

TEST(Simulate, StopsWhereProgressSaysSo) {
  const Problem problem = force_over_bridge().set("ts_dt", 1e-5).set("beam_elements_per_span", 32);
  int calls = 0;
  try {
    (void)simulate(std::vector<Problem>{problem}, [&](double done) {
      EXPECT_GE(done, 0.0);
      return ++calls < 2;
    });
    FAIL() << "it was not stopped";
  } catch (const RunsFailed& failed) {
    EXPECT_EQ(failed.status(), 130);
    EXPECT_TRUE(failed.results.front().probes.empty());
  }
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace traverse
