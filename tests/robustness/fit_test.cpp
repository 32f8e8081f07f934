// Fits that cannot be meant, and fits that end early: one clear line, and a file with what was known.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string forces = std::string(two_spans) + "load: {forces: 1.0e5, speed: 40}\nts_dt: 2.0e-3\n";
const std::string to_first = "to: {first: {frequency: 1, value: 4.0, sd: 0.02}}";
const std::string vary_EI = "vary: {beam_EI: [1.0e8, 1.0e12]}";

/// A measured series with 50 rows at intervals of 0.02 s, in mm.
std::string series(double first = 0.0) {
  std::string text = "# time, deflection\n";
  for (int i = 0; i < 50; ++i)
    text += std::to_string(first + 0.02 * i) + ", " + std::to_string(-std::sin(0.06 * i)) + "\n";
  return text;
}

std::string fit_to(const std::string& series) { return "fit: {" + vary_EI + ", to: {midspan: {" + series + "}}}\n"; }

TEST(FitInput, IsRefusedInOneLine) {
  const struct {
    std::string fit;
    std::vector<std::string> parts;
  } cases[] = {
      {"fit: {vary: {beam_IE: [1, 2]}, " + to_first + "}", {"fit_vary_beam_IE", "no option beam_IE", "mean beam_EI?"}},
      {"fit: {vary: {beam_EI: [2e10, 1e10]}, " + to_first + "}", {"fit_vary_beam_EI", "must be below the highest"}},
      {"fit: {vary: {beam_EI: 1e10}, " + to_first + "}", {"fit_vary_beam_EI", "1 entries"}},
      {"fit: {vary: {beam_EI: [-1, 1e10]}, " + to_first + "}", {"fit_vary_beam_EI", "'-1'", "above"}},
      {"fit: {vary: {beam_EI: [1, 2]}, " + to_first + "}", {"fit_vary_beam_EI", "outside these bounds"}},
      {"fit: {vary: {support_types: [1, 2]}, " + to_first + "}", {"support_types cannot be estimated", "not a number"}},
      {"fit: {vary: {track_seed: [1, 20]}, " + to_first + "}", {"track_seed cannot be estimated", "whole number"}},
      {"fit: {vary: {ts_dt: [1e-3, 1]}, " + to_first + "}", {"ts_dt cannot be estimated", "numerical model"}},
      {"fit: {vary: {accuracy: [1e-4, 1e-2]}, " + to_first + "}", {"accuracy cannot be estimated", "all runs"}},
      {"fit: {vary: {beam_rayleigh: [0, 1]}, " + to_first + "}", {"beam_rayleigh cannot be estimated", "2 numbers"}},
      {"fit: {" + vary_EI + "}", {"fit_to is missing"}},
      {"fit: {" + to_first + "}", {"fit_vary is missing"}},
      {"fit: {" + vary_EI + ", to: {first: {frequenzy: 1}}}", {"fit_to_first_frequenzy", "allowed", "frequency"}},
      {"fit: {" + vary_EI + ", to: {first: {frequency: 1, sd: 0.1}}}", {"fit_to_first_frequency", "needs", "value"}},
      {"fit: {" + vary_EI + ", to: {first: {frequency: 1, value: 4}}}", {"fit_to_first_frequency", "needs", "sd"}},
      {"fit: {" + vary_EI + ", to: {first: {frequency: 0, value: 4, sd: 1}}}", {"fit_to_first_frequency", "from 1"}},
      {"fit: {" + vary_EI + ", to: {last: {frequency: 99, value: 4, sd: 1}}}", {"fit_to_last_frequency", "modes only"}},
      {"fit: {" + vary_EI + ", to: {first: {sd: 1}}}", {"needs either frequency or series"}},
      {"fit: {" + vary_EI + ", to: {first: {frequency: 1, value: 4, sd: 1, x: 3}}}", {"fit_to_first_x", "not allowed"}},
      {"fit: {" + vary_EI + ", " + to_first + ", starts: 0}", {"fit_starts", "from 1"}},
      {"fit: {" + vary_EI + ", " + to_first + "}\nstudy_vary_beam_mass: [1, 2]", {"either a study or a fit"}},
      {"fit: {" + vary_EI + ", " + to_first + "}\nsweep_speed: [10, 20, 5]", {"sweep_speed", "not allowed in a fit"}},
      {"fit: {" + vary_EI + ", " + to_first + "}\ntao_type: cg", {"tao_type", "brgn, pounders"}},
      {fit_to("series: none.csv, quantity: deflection, x: 10"), {"fit_to_midspan_series", "none.csv"}},
      {fit_to("series: a.csv, x: 10"), {"fit_to_midspan_series", "needs fit_to_midspan_quantity"}},
      {fit_to("series: a.csv, quantity: slope, x: 10"), {"fit_to_midspan_quantity", "one of"}},
      {fit_to("series: a.csv, quantity: deflection, x: 50"), {"fit_to_midspan_x", "outside the bridge"}},
      {fit_to("series: a.csv, dataset: probes/deflektion"), {"fit_to_midspan_dataset", "mean /probes/deflection?"}},
      {fit_to("series: a.csv, dataset: probes/deflection, component: 9"), {"fit_to_midspan_component", "rows of 2"}},
      {fit_to("series: a.csv, dataset: probes/deflection, x: 10"), {"fit_to_midspan_x", "not allowed with"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, column: 3"), {"2 columns", "at least 3"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, factor: 0"), {"fit_to_midspan_factor", "but 0"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, from: 0.95"), {"2 rows"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, lowpass: 40"), {"fit_to_midspan_lowpass", "below 25 Hz"}},
      {fit_to("series: uneven.csv, quantity: deflection, x: 10, lowpass: 5"), {"fit_to_midspan_lowpass", "equal"}},
      {fit_to("series: early.csv, quantity: deflection, x: 10"), {"fit_to_midspan_series", "before the scene"}},
      {fit_to("series: falling.csv, quantity: deflection, x: 10"), {"falling.csv:2", "increase strictly"}},
      {fit_to("series: word.csv, quantity: deflection, x: 10"), {"word.csv:2", "'x'"}},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.fit);
    const Workplace workplace(forces + one.fit + "\n");
    workplace.write("a.csv", series());
    workplace.write("early.csv", series(-0.5));
    workplace.write("uneven.csv", "0 0\n0.02 1\n0.03 0\n0.06 0\n");
    workplace.write("falling.csv", "1 0\n0 1\n");
    workplace.write("word.csv", "1 0\n2 x\n");
    expect_refusal(workplace, workplace.run(), one.parts);
  }
}

TEST(Fit, ThatIsEndedKeepsWhatItKnows) {
  const Workplace workplace(forces + fit_to("series: a.csv, quantity: deflection, x: 10, factor: 1e-3") +
                            "fit_starts: 1000\naccuracy_cache: false\n");
  workplace.write("a.csv", series());
  Child child(workplace.command({"-output_file", "fit.h5"}), workplace.folder());
  ASSERT_TRUE(child.wait_until([&] {
    std::error_code none;
    const auto size = std::filesystem::file_size(workplace.path("fit.h5"), none);
    return !none && size > 0;
  }));
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait().status, 128 + SIGTERM);
  Results results(workplace.path("fit.h5"));
  EXPECT_EQ(results("/fit/series/midspan/measured").size(), 50U);
  EXPECT_EQ(results("/fit/starts/misfit").size(), 1000U);
  EXPECT_TRUE(std::isnan(results("/fit/starts/misfit").back()));
}

}  // namespace
}  // namespace traverse::test
