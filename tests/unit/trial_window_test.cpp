// What trial runs have to see beyond the beginning of a crossing, and what is promised where they have not.
#include "error_control/trial_window.hpp"

#include <gtest/gtest.h>

#include "error_control/accuracy.hpp"
#include "results/study_table.hpp"
#include "traverse/options/options.hpp"

namespace traverse::error_control {
namespace {

// Four spans of 30 m, a force of 1 N at 50 m/s that starts at their beginning.
scene::Scene scene_of(const std::string& more, const std::string& spans = "30.0*4",
                      const std::string& types = "[pinned, roller, roller, roller, roller]") {
  return scene::read_scene(options::Options::from_yaml("beam: {spans: " + spans +
                                                       ", EI: 1.0e10, mass: 1.0e4}\nsupport: {types: " + types +
                                                       "}\nload: {forces: 1.0, speed: 50.0}\n" + more));
}

constexpr double end = 10.0;  // s

std::vector<LaterEvent> later(const scene::Scene& scene) {
  return later_events(scene, initial_window(scene, end), end);
}

TEST(TrialWindow, EqualSpansHoldNothingNew) {
  const scene::Scene scene = scene_of("");
  EXPECT_NEAR(initial_window(scene, end), 1.1 * 30.0 / 50.0, 1e-12);
  EXPECT_TRUE(later(scene).empty());
  EXPECT_TRUE(later(scene_of("foundation: {vertical: {x: [30, 60, 90], k: 1.0e7}}\n", "30.0*3", "roller")).empty());
}

TEST(TrialWindow, ASpanUnlikeThoseBefore) {
  const std::vector<LaterEvent> longer = later(scene_of("", "[30.0, 30.0, 36.0, 36.0]"));
  ASSERT_EQ(longer.size(), 1U);
  EXPECT_NEAR(longer[0].until, (60.0 + 1.1 * 36.0) / 50.0, 1e-12);
  EXPECT_EQ(longer[0].what, "the span from 60 to 96 m (different from all before it)");
  EXPECT_EQ(later(scene_of("", "30.0*4", "[pinned, roller, roller, roller, clamped]")).size(), 1U);
  const std::vector<LaterEvent> prop =
      later(scene_of("foundation: {vertical: {x: 75.0, k: 1.0e8, one_sided: true}}\n"));
  ASSERT_EQ(prop.size(), 1U);  // the span behind it is like the first
  EXPECT_NEAR(prop[0].until, (60.0 + 1.1 * 30.0) / 50.0, 1e-12);
}

TEST(TrialWindow, ABump) {
  const std::string bump = "track: {profile: bump, bump: {length: 2.0, height: 0.01, start: ";
  EXPECT_TRUE(later(scene_of(bump + "-50.0}}\n")).empty());
  const std::vector<LaterEvent> late = later(scene_of(bump + "100.0}}\n"));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_NEAR(late[0].until, (102.0 + 1.1 * 30.0) / 50.0, 1e-12);
}

// Sleepers that hang late on the way have to be seen.
TEST(TrialWindow, AStretchOfTheTrack) {
  const std::string track =
      "track: {rail: {EI: 1.3e7, mass: 121.0}, spacing: 0.6, pad: {k: 1.3e8}, sleeper: {mass: 251.0}, ballast: {k: "
      "2.7e8, "
      "mass: 1000.0}, approach: 30.0, stretches: hung, hung: {gap: 1.0e-4, ";
  EXPECT_TRUE(later(scene_of(track + "from: -3.0, to: 0.0}}\n")).empty());
  const std::vector<LaterEvent> late = later(scene_of(track + "from: 90.0, to: 99.0}}\n"));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_NEAR(late[0].until, (99.0 + 10.0 * 0.6) / 50.0, 1e-12);
  EXPECT_EQ(late[0].what, "the stretch hung of the track");
}

TEST(Accuracy, IsWithdrawnWhereContactsWereLostUnseen) {
  Accuracy accuracy;
  accuracy.measured = true;
  for (ErrorEstimate& promise : accuracy.estimates) promise = {true, true, 1e-4, ""};
  const std::vector<double> losses = {0.5, 0.9};
  EXPECT_EQ(accuracy.invalidate_by_contact_loss({}), "");
  Accuracy seen = accuracy;
  seen.lost_contact = true;
  seen.covered_until = 1.0;
  EXPECT_EQ(seen.invalidate_by_contact_loss(losses), "");
  EXPECT_EQ(seen.expected().size(), static_cast<std::size_t>(run::quantities));
  seen.covered_until = 0.7;
  EXPECT_NE(seen.invalidate_by_contact_loss(losses).find("lost contact 1 times after 0.7 s, which happened in no"),
            std::string::npos);
  EXPECT_TRUE(seen.expected().empty());
  EXPECT_NE(accuracy.invalidate_by_contact_loss(losses).find("lost contact 2 times, which happened in no trial run"),
            std::string::npos);
  EXPECT_TRUE(accuracy.expected().empty());
  EXPECT_EQ(accuracy.invalidate_by_contact_loss(losses), "");
}

// What bends twice as much is four times as far off; what nobody has seen promises nothing.
TEST(Accuracy, IsWithdrawnWhereMoreComesThanTrialsSaw) {
  Accuracy accuracy;
  accuracy.measured = true;
  accuracy.covered_until = 0.7;
  for (ErrorEstimate& promise : accuracy.estimates) promise = {true, true, 1e-4, ""};
  accuracy.estimates[run::moment].expected = 5e-4;
  EXPECT_EQ(accuracy.invalidate_if_rougher(1.9, 1e-3), "");
  const std::string said = accuracy.invalidate_if_rougher(2.5, 1e-3);
  EXPECT_NE(said.find("error estimates withdrawn: moment: after 0.7 s"), std::string::npos) << said;
  EXPECT_NEAR(accuracy.estimates[run::deflection].expected, 6.25e-4, 1e-15);
  EXPECT_EQ(accuracy.expected().size(), run::quantities - 1U);
  EXPECT_EQ(accuracy.invalidate_by_new_event(""), "");
  EXPECT_NE(accuracy.invalidate_by_new_event("a stop touches at 2 s").find("a stop touches at 2 s"), std::string::npos);
  EXPECT_TRUE(accuracy.expected().empty());
}

TEST(RunModel, PromisesNothingOfRunsThatMeetWhatNoTrialHasSeen) {
  results::RunModel model;
  model.expected_errors = {{"deflection", 1e-3}};
  const std::vector<double> unseen = {0.0, 1.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
  EXPECT_EQ(results::extrapolation_note(model, {0.0, 0.0}), "");
  EXPECT_NE(results::extrapolation_note(model, unseen).find("error estimates are not valid for 2 of the runs"),
            std::string::npos);
}

}  // namespace
}  // namespace traverse::error_control
