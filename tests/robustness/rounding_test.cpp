// What rounding would hide is named by its option, before anything is computed; what has no end is not begun.
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace traverse::test {
namespace {

const std::string beam =
    "beam: {spans: [20.0], EI: 5.0e9, mass: 8.0e3, elements_per_span: 4}\nload: {forces: 1.0e5, speed: 40}\n";

void expect_refused(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
  const Workplace workplace(beam);
  SCOPED_TRACE(words.front() + " " + words[1]);
  expect_refusal(workplace, workplace.run(words), parts);
}

TEST(Rounding, HidesElementsBesideMuchLongerOnes) {
  expect_refused({"-beam_cracks_x", "10", "-beam_cracks_width", "1e-9", "-beam_cracks_EI_factor", "0.5"},
                 {"beam_cracks_width", "1e-09 m apart", "at least 0.001 m"});
  expect_refused({"-beam_cracks_x", "10,10.0000001", "-beam_cracks_k", "1e9"}, {"beam_cracks_x", "1e-07 m apart"});
  expect_refused({"-beam_hinges", "19.9999999", "-beam_spans", "20,20"}, {"beam_hinges", "1e-07 m apart"});
}

// Sums of spans and of widths are rounded: what is meant to be one station is one.
TEST(Rounding, DividesNoBeamTwiceAtOnePlace) {
  const Workplace workplace(beam);
  const std::vector<std::string> spans = {"-beam_spans", "13.1,13.2,10", "-describe"};
  for (std::vector<std::string> words : std::vector<std::vector<std::string>>{
           {"-beam_hinges", "26.3"},
           {"-beam_cracks_x", "26.3", "-beam_cracks_k", "1e9"},
           {"-beam_cracks_x", "12.9,13.2", "-beam_cracks_width", "0.3,0.3", "-beam_cracks_EI_factor", "0.5,0.4"}}) {
    SCOPED_TRACE(words.front() + " " + words[1]);
    words.insert(words.end(), spans.begin(), spans.end());
    const Outcome outcome = workplace.run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
}

TEST(Rounding, HidesBendingBesideShear) {
  expect_refused({"-beam_GA", "1e-6"}, {"beam_GA", "rounding hides bending below"});
}

// 280 s and 6 GB before they were named.
TEST(Rounding, HidesFrequenciesOfTooManyElements) {
  const std::vector<std::string> many = {"-beam_spans", "20*5", "-beam_elements_per_span", "20000"};
  std::vector<std::string> check = many, modes = many;
  check.insert(check.end(), {"-describe"});
  modes.insert(modes.end(), {"-scene_analysis", "modes", "-modes_count", "3"});
  for (const std::vector<std::string>& words : {check, modes})
    expect_refused(words, {"beam_elements_per_span", "rounding hides the lowest frequencies"});
}

TEST(Lengths, OfSleepersAreThoseOfSleepers) { expect_refused({"-load_spread", "1e9"}, {"load_spread", "at most 10"}); }

// One section a span at least: its ends.
TEST(Lengths, OfSectionsBeyondTheSpanAreTheSpan) {
  const Workplace workplace(beam);
  const std::vector<std::string> words = {"-scene_analysis", "envelope", "-norm_load_models", "lm71"};
  std::vector<std::string> wide = words;
  wide.insert(wide.end(), {"-norm_spacing", "1e9"});
  const Outcome outcome = workplace.run(wide);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find(" nan"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace traverse::test
