// Searches that cannot be meant, and searches whose answer is that there is none.
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string scene =
    "beam: {spans: 20.0, EI: 2.0e10, mass: 1.5e4, damping_ratios: 0.02}\nload: {forces: 2.0e5, speed: 50.0}\n"
    "model: {modes: 3}\n";

void refused(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& word : words) all += " " + word;
  SCOPED_TRACE(all);
  const Workplace workplace(scene);
  expect_refusal(workplace, workplace.run(words), parts);
}

TEST(Find, BadInputIsRefused) {
  const auto with = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"-find_quantity", "peak_deflection", "-find_equals", "1e-3"});
    return words;
  };
  refused(with({"-find_option", "beam_E", "-find_between", "1,2"}), {"find_option", "beam_EI"});
  refused(with({"-find_option", "beam_EI"}), {"find_between is missing"});
  refused(with({"-find_option", "beam_EI", "-find_between", "2,1"}), {"find_between", "not above the first"});
  refused(with({"-find_option", "beam_EI", "-find_between", "-1,1"}),
          {"find_between", "-1 is not a value of beam_EI", "above"});
  refused(with({"-find_option", "beam_EI", "-find_between", "1,many"}), {"find_between", "many"});
  refused(with({"-find_option", "output_interval", "-find_between", "1,2"}), {"find_option", "output_interval"});
  refused(with({"-find_option", "beam_elements_per_span", "-find_between", "1,2"}), {"find_option", "whole numbers"});
  refused(with({"-find_option", "load_speed", "-find_between", "0,20"}), {"find_between", "above 0"});
  refused(with({"-find_option", "load_speed", "-find_between", "10,20", "-sweep_speed", "10,20,1"}),
          {"find_option", "sweep"});
  refused(with({"-find_option", "beam_EI", "-find_between", "1e9,2e9", "-find_for_each", "beam_mass"}),
          {"find_for_each", "beam_mass"});
  refused(with({"-find_option", "beam_EI", "-find_between", "1e9,2e9", "-find_keep", "limits"}),
          {"find_keep", "find_quantity"});
  refused({"-find_option", "beam_EI", "-find_between", "1e9,2e9"}, {"find_option", "no limits"});
  refused({"-find_option", "beam_EI", "-find_between", "1e9,2e9", "-find_quantity", "peak_deflection"},
          {"find_quantity", "find_equals"});
  refused({"-find_option", "beam_EI", "-find_between", "1e9,2e9", "-find_quantity", "colour", "-find_equals", "1"},
          {"find_quantity", "colour", "peak_deflection"});
}

// What no run determines is refused before the first one, and named.
TEST(Find, WhatNoRunDeterminesIsRefused) {
  const auto limited = [](const std::string& quantity, const std::vector<std::string>& more,
                          const std::vector<std::string>& parts) {
    const Workplace workplace(scene);
    workplace.write("limits.yml", "- {clause: own, quantity: " + quantity + ", value: 1.0, text: own}\n");
    std::vector<std::string> words = {"-limits", "limits.yml", "-find_option", "beam_EI", "-find_between", "1e9,2e9"};
    words.insert(words.end(), more.begin(), more.end());
    expect_refusal(workplace, workplace.run(words), parts);
  };
  limited("deck_acceleration", {"-output_lowpass", "none"}, {"no run determines deck_acceleration", "low-passed"});
  limited("car_acceleration", {}, {"no run determines car_acceleration", "no vehicles"});
  limited("joint_rotation", {}, {"no run determines joint_rotation", "no two decks"});
}

TEST(Find, NoValueIsAnAnswerWithTheClosestOne) {
  const Workplace workplace(scene);
  const Outcome outcome = workplace.run({"-find_option", "beam_EI", "-find_between", "1e9,2e9", "-find_quantity",
                                         "peak_deflection", "-find_equals", "1e-6"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("for no value between 1e+09 N m2 and 2e+09 N m2; closest at 2e+09"), std::string::npos)
      << outcome.out;
}

}  // namespace
}  // namespace traverse::test
