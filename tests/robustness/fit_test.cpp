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
      {"fit: {vary: {beam_EI: [-1, 1e10]}, " + to_first + "}",
       {"fit_vary_beam_EI", "-1 is not a value of beam_EI", "above"}},
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
      {fit_to("series: a.csv, quantity: deflection, x: 50"), {"fit_to_midspan_x", "outside the beam"}},
      {fit_to("series: a.csv, dataset: probes/deflektion"), {"fit_to_midspan_dataset", "mean /probes/deflection?"}},
      {fit_to("series: a.csv, dataset: probes/deflection, component: 9"), {"fit_to_midspan_component", "rows of 2"}},
      {fit_to("series: a.csv, dataset: probes/deflection, x: 10"), {"fit_to_midspan_x", "not allowed with"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, column: 3"), {"2 columns", "at least 3"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, factor: 0"), {"fit_to_midspan_factor", "but 0"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, from: 0.95"), {"2 rows"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, lowpass: 40"), {"fit_to_midspan_lowpass", "below 25 Hz"}},
      {fit_to("series: a.csv, quantity: deflection, x: 10, lowpass: 0.5"),
       {"fit_to_midspan_lowpass", "from 1.02 Hz on"}},
      {fit_to("series: comma.csv, quantity: deflection, x: 10"), {"comma.csv:1", "decimals need a point"}},
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
    workplace.write("comma.csv", "0,00;0.25\n0,02;0.50\n0,04;0.75\n");
    expect_refusal(workplace, workplace.run(), one.parts);
  }
}

// --- records in another unit, with another sign, clock or zero
// -----------------------------------------------------------

constexpr double span = 30.0, true_EI = 1.6e11, mass = 2.0e4, force = 1.7e5, speed = 40.0, damping = 0.02;

/// The deflection of midspan by the first mode, 2 P/(m L) times the response of an oscillator to sin(Omega t), Omega =
/// pi v/L, while the force crosses the span and 0.25 s later.
double deflection(double t) {
  const double pi = std::acos(-1.0), omega = std::pow(pi / span, 2) * std::sqrt(true_EI / mass),
               drive = pi * speed / span;
  const double a = omega * omega - drive * drive, b = 2.0 * damping * omega * drive, sum = a * a + b * b;
  const double sine = a / sum, cosine = -b / sum, damped = omega * std::sqrt(1.0 - damping * damping);
  // u = sine sin(drive t) + cosine cos(drive t) + exp(-zeta omega t) (p cos(damped t) + q sin(damped t)), at rest at 0
  const auto forced = [&](double s) { return sine * std::sin(drive * s) + cosine * std::cos(drive * s); };
  const auto rate = [&](double s) { return drive * (sine * std::cos(drive * s) - cosine * std::sin(drive * s)); };
  const auto free = [&](double s, double u, double v) {
    return std::exp(-damping * omega * s) *
           (u * std::cos(damped * s) + (v + damping * omega * u) / damped * std::sin(damped * s));
  };
  const auto response = [&](double s) { return forced(s) - free(s, forced(0.0), rate(0.0)); };
  const double end = span / speed, h = 1e-5;
  const double u = t <= end ? response(t) : free(t - end, response(end), (response(end) - response(end - h)) / h);
  return -2.0 * force / (mass * span) * u;
}

/// A fit of EI, from 0.8 of its true value, to the record factor*deflection(t) + offset at the times t + shift.
struct Measured {
  double factor = 1.0, shift = 0.0, offset = 0.0;
  std::string words = {};
  std::string bounds = "1.0e11, 3.0e11";
  std::vector<std::string> options = {};
};

Outcome fitted(const Measured& measured) {
  const Workplace workplace(
      "beam: {spans: 30.0, EI: 1.28e11, mass: 2.0e4, elements_per_span: 8}\n"
      "model: {modes: 1, damping_ratios: 0.02}\nload: {forces: 1.7e5, speed: 40.0}\n"
      "fit: {vary: {beam_EI: [" +
      measured.bounds + "]}, to: {middle: {series: a.csv, quantity: deflection, x: 15" + measured.words +
      "}}}\noutput: {file: fit.h5}\n");
  std::string text;
  for (int i = 0; i <= 100; ++i)
    text += std::to_string(0.01 * i + measured.shift) + ", " +
            std::to_string(1e6 * (measured.factor * deflection(0.01 * i) + measured.offset)) + "e-6\n";
  workplace.write("a.csv", text);
  return workplace.run(measured.options);
}

TEST(FitRecord, AsItShouldBeIsFittedWithoutAWord) {
  const Outcome outcome = fitted({});
  expect_success(outcome);
  EXPECT_EQ(outcome.out.find("unusual input"), std::string::npos) << outcome.out;
  const std::size_t at = outcome.out.find("beam_EI    ");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  EXPECT_NEAR(std::stod(outcome.out.substr(at + 7)), true_EI, 1e-3 * true_EI) << outcome.out;
}

TEST(FitRecord, ThatNoValueExplainsIsRefusedBeforeTheFit) {
  const struct {
    Measured measured;
    std::vector<std::string> parts;
  } cases[] = {
      {{.factor = 1e3}, {"fit_to_middle_series: the record is", "is its unit m?", "fit_to_middle_factor 0.001?"}},
      {{.factor = 1e2, .words = ", factor: 10"}, {"fit_to_middle_series", "fit_to_middle_factor 0.01?"}},
      {{.factor = 1e-3}, {"fit_to_middle_series", "fit_to_middle_factor 1000?"}},
      {{.factor = -1e3, .words = ", align: true"}, {"fit_to_middle_series", "fit_to_middle_factor 0.001?"}},
      {{.shift = 12.37}, {"fit_to_middle_series", "but shows their passage", "fit_to_middle_align true, or false"}},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.parts.back());
    const Outcome outcome = fitted(one.measured);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    for (const std::string& part : one.parts) EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out.find("estimates"), std::string::npos) << outcome.out;
  }
}

TEST(FitRecord, WithAnotherSignClockOrZeroIsDoubted) {
  const struct {
    Measured measured;
    const char* found;
  } cases[] = {
      {{.factor = -1.0}, "the record has the opposite sign of the computed series (correlation -"},
      {{.shift = 0.3}, "if the clock of the record is 0."},
      {{.offset = 1e-3}, "the record has a constant of 0.00"},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.found);
    const Outcome outcome = fitted(one.measured);
    const std::size_t at = outcome.out.find(one.found);
    EXPECT_LT(outcome.out.find("unusual input"), at) << outcome.out << outcome.err;
    EXPECT_LT(at, outcome.out.find("modelled")) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.status, 3) << outcome.out;  // the estimates do not remove it
    EXPECT_NE(outcome.err.find(one.found[0] == 'i' ? "if the clock of the record is" : "the record has"),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.out.find("results  fit.h5"), std::string::npos) << outcome.out;
  }
}

// An answer to a doubt is taken: the record is fitted as it is.
TEST(FitRecord, WithAnAnswerIsNotDoubted) {
  for (const Measured& measured :
       {Measured{.shift = 0.3, .words = ", align: true"}, Measured{.offset = 1e-3, .words = ", offset: true"},
        Measured{.factor = -1.0, .words = ", factor: -1"}}) {
    SCOPED_TRACE(measured.words);
    const Outcome outcome = fitted(measured);
    expect_success(outcome);
    EXPECT_EQ(outcome.out.find("unusual input"), std::string::npos) << outcome.out;
  }
}

TEST(FitRecord, WithoutConvergenceIsNoSuccess) {
  const Outcome outcome =
      fitted({.options = {"-fit_vary_beam_mass", "1e4,4e4", "-fit_vary_load_speed", "20,60", "-tao_max_it", "1"}});
  EXPECT_EQ(outcome.status, 3) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find("has not converged"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("tao_max_it"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("results  fit.h5"), std::string::npos) << outcome.out;
}

// A minimum beyond the bounds is no estimate.
TEST(FitRecord, OutsideTheBoundsIsNoSuccess) {
  const Outcome outcome = fitted({.bounds = "1.0e11, 1.4e11"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("no minimum within its bounds: beam_EI at a bound"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("at a bound"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("results  fit.h5"), std::string::npos) << outcome.out;
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
