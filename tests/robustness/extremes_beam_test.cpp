// Beams, beds, damping and speeds at the edge: a force moves over the beam of R1, whose modes' series is exact.
#include "support/extremes.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

constexpr double L = 25.0, EI = 8.323e9, m = 2303.0, F = 1.0e5;
const double omega1 = std::numbers::pi * std::numbers::pi / (L * L) * std::sqrt(EI / m);  // 30.02 rad/s
const double static_deflection = F * L * L * L / (48.0 * EI);

std::string beam(int elements, const std::string& more = "") {
  return "beam: {spans: 25.0, elements_per_span: " + std::to_string(elements) + ", EI: " + text(EI) +
         ", mass: " + text(m) + "}\nsupport: {types: [pinned, roller]}\nload: {forces: " + text(F) +
         "}\noutput: {probes: [6.25, 12.5]}\n" + more;
}

/// Largest difference from the series while the force is on the beam, over its largest value.
double error(Results& run, const MovingForce& exact) {
  const std::vector<double> t = run.time(), &v = run("/probes/deflection");
  double largest = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < t.size() && exact.speed * t[i] < L; i += std::max<std::size_t>(1, t.size() / 60))
    for (std::size_t p = 0; p < 2; ++p) {
      const double w = exact.deflection(p == 0 ? 0.25 * L : 0.5 * L, t[i]);
      largest = std::max(largest, std::abs(w));
      worst = std::max(worst, std::abs(-v[2 * i + p] - w));
    }
  testing::Test::RecordProperty("error", text(worst / largest));
  return worst / largest;
}

// --- speeds ----------------------------------------------------------------------------------------------------------

// alpha = v pi/(L omega1): creeping, at the critical speed, where the first mode resonates without damping, and beyond.
// Twenty elements give R1 to 2e-5; the undamped higher modes that a fast force stirs are worse, 20 times at most.
class Speed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Beam, Speed, testing::Values(1e-2, 0.5, 1.0, 3.0));

TEST_P(Speed, OverCritical) {
  const double speed = GetParam() * omega1 * L / std::numbers::pi, crossing = L / speed;
  const double step = std::min(crossing / 1000.0, 1e-3);
  Results run = run_yaml(beam(20), {{"load_speed", text(speed)}, {"ts_dt", text(step)}});
  EXPECT_LT(error(run, {L, EI, m, F, speed}), 1e-3);
}

TEST(Speed, AMicrometreASecondIsStatic) {
  Results run =
      run_yaml(beam(4), {{"load_speed", "1e-6"}, {"load_positions", "12.5"}, {"ts_max_time", "10"}, {"ts_dt", "0.1"}});
  for (const double v : run.column("/probes/deflection", 1))
    ASSERT_NEAR(-v, static_deflection, 1e-9 * static_deflection);
}

// R10: v_cr = (4 k EI/m^2)^(1/4), on a bed of 1/lambda = 1.9 m; elements of 0.25 m. Without damping the deflection
// grows all the way.
class OnABed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Beam, OnABed, testing::Values(0.5, 1.0, 3.0));

TEST_P(OnABed, OverCritical) {
  constexpr double k = 2.5e9;
  const double speed = GetParam() * std::pow(4.0 * k * EI / (m * m), 0.25);
  Results run = run_yaml(
      beam(100),
      {{"foundation_vertical_bed_k", text(k)}, {"load_speed", text(speed)}, {"ts_dt", text(L / speed / 1000.0)}});
  EXPECT_LT(error(run, {L, EI, m, F, speed, k}), 1e-2);
}

// --- damping ---------------------------------------------------------------------------------------------------------

// What is damped so strongly moves near the force only, which takes twice the mesh. Damping ratios of both modes above
// 1: (a/w + b w)/2 for w = 30 and 120 rad/s.
TEST(Damping, Overdamped) {
  const double speed = 0.25 * omega1 * L / std::numbers::pi;
  struct Pair {
    double a, b;
  };
  for (const Pair& p : {Pair{600.0, 0.0}, {0.0, 0.2}, {200.0, 0.05}, {1e5, 0.0}, {0.0, 1e3}}) {
    SCOPED_TRACE(testing::Message() << "a = " << p.a << ", b = " << p.b);
    EXPECT_GT(0.5 * (p.a / (4.0 * omega1) + p.b * 4.0 * omega1), 1.0);
    Results run = run_yaml(
        beam(40), {{"beam_rayleigh", text(p.a) + "," + text(p.b)}, {"load_speed", text(speed)}, {"ts_dt", "1e-3"}});
    EXPECT_LT(error(run, {L, EI, m, F, speed, 0.0, p.a, p.b}), 1e-3);
    EXPECT_LT(energy_error(run), 1e-3);
  }
}

// --- meshes ----------------------------------------------------------------------------------------------------------

// Statics are exact with any mesh; the first frequency of one cubic element is 11 % too high, which is said.
TEST(Mesh, OneElementASpan) {
  for (const double x : {3.0, 12.5}) {
    Results run =
        run_yaml(beam(1), {{"scene_analysis", "static"}, {"load_positions", text(x)}, {"output_probes", text(x)}});
    const double exact = F * x * x * (L - x) * (L - x) / (3.0 * EI * L);
    EXPECT_NEAR(-run("/probes/deflection")[0], exact, 1e-9 * exact);
  }
  const Workplace workplace(beam(1, "load_speed: 60.0\n"));
  const Outcome outcome = workplace.run({"-output_file", "none"});
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("-beam_elements_per_span 4"), std::string::npos) << outcome.out;
}

// In one span rounding leaves nothing of statics, in a thousand spans it is good.
TEST(Mesh, AHundredThousandElements) {
  expect_refused(
      [] {
        run_yaml(beam(100000), {{"load_speed", "60"}, {"ts_dt", "1e-3"}, {"ts_max_time", "0.01"}});
      },
      {"beam_elements_per_span"});
  const auto spans = [](const char* elements) {
    return run_yaml(beam(1), {{"beam_spans", "25*1000"},
                              {"support_types", "pinned"},
                              {"scene_analysis", "static"},
                              {"beam_elements_per_span", elements},
                              {"load_positions", "12512.5"},
                              {"output_probes", "12487.5,12512.5"}});
  };
  Results fine = spans("100"), coarse = spans("4");
  EXPECT_LT(difference(fine, coarse, "/probes/deflection"), 1e-8);
}

// A neighbour 1e8 times as stiff does not turn over its supports: a propped cantilever, 7 P L^3/(768 EI).
TEST(Mesh, NeighboursOfAHundredMillionTimesTheStiffness) {
  const Workplace workplace(small_scene());
  for (const bool left : {true, false}) {
    const std::string soft = "1.0e10", stiff = "1.0e18", a = left ? soft : stiff, b = left ? stiff : soft;
    const std::string file = workplace.write("EI.csv", "0, " + a + "\n20, " + a + "\n20, " + b + "\n40, " + b + "\n");
    const double exact = 7.0 * quarter_car_weight * 8000.0 / (768.0 * 1e10);
    Results at_rest = run_yaml(
        small_scene(), {{"beam_EI", file}, {"train_positions", left ? "10" : "30"}, {"scene_analysis", "static"}});
    EXPECT_NEAR(-at_rest("/probes/deflection")[left ? 0 : 1], exact, 1e-6 * exact);
    // Moving, against the soft span alone, clamped there.
    Results both = run_yaml(small_scene(), {{"beam_EI", file},
                                            {"ts_dt", "1e-3"},
                                            {"output_interval", "0.01"},
                                            {"train_positions", left ? "0" : "20"},
                                            {"ts_max_time", "0.5"}});
    Results alone = run_yaml(small_scene(), {{"beam_spans", "20"},
                                             {"support_types", left ? "pinned,clamped" : "clamped,roller"},
                                             {"ts_dt", "1e-3"},
                                             {"output_interval", "0.01"},
                                             {"ts_max_time", "0.5"}});
    const std::vector<double> v = both.column("/probes/deflection", left ? 0 : 1),
                              w = alone.column("/probes/deflection");
    EXPECT_LT(relative_difference(v, w), 1e-6);
  }
}

// --- beds and springs ------------------------------------------------------------------------------------------------

double static_on_bed(double k) {
  double sum = 0.0;
  for (int n = 1; n < 200000; n += 2) sum += 2.0 * F / L / (EI * std::pow(n * std::numbers::pi / L, 4) + k);
  return sum;
}

// Right, or the mesh is refused; a mesh that the message asks for is taken.
TEST(Bed, FromOneToTenToTheFifteen) {
  for (int power = 0; power <= 15; ++power) {
    const double k = std::pow(10.0, power), exact = static_on_bed(k);
    SCOPED_TRACE(testing::Message() << "k = 1e" << power);
    double before = 0.0;
    for (const int elements : {20, 400}) {
      const std::string message = refusal([&] {
        Results run = run_yaml(
            beam(elements),
            {{"foundation_vertical_bed_k", text(k)}, {"load_positions", "12.5"}, {"scene_analysis", "static"}});
        before = -run("/probes/deflection")[1];
        // 6 % at an element of 2/lambda, the longest that is taken; the fourth power of it below.
        const double waves = std::pow(k / (4.0 * EI), 0.25) * L / elements;
        EXPECT_NEAR(before, exact, (1e-6 + 0.06 * std::pow(waves / 2.0, 2)) * exact) << elements;
      });
      if (message.empty()) continue;
      EXPECT_EQ(elements, 20) << message;
      EXPECT_GE(power, 12);
      EXPECT_NE(message.find("beam_elements_per_span = 20"), std::string::npos) << message;
    }
  }
}

// A spring under midspan, from none to a support: what a car finds in between lies between.
TEST(Spring, FromOneToTenToTheFifteen) {
  const std::string car =
      std::string(two_spans) + quarter_car + "ts_dt: 2.0e-3\noutput: {interval: 0.01, probes: [5.0]}\n";
  const Values one_span = {{"beam_spans", "20"}, {"support_types", "pinned,roller"}, {"beam_elements_per_span", "8"}};
  Results none = run_yaml(car, one_span);
  Results support = run_yaml(car, {{"beam_spans", "10,10"}, {"beam_elements_per_span", "4"}});
  double before = 2.0 * std::abs(peak(none("/probes/deflection")).first);
  for (int power = 0; power <= 15; power += 3) {
    SCOPED_TRACE(testing::Message() << "k = 1e" << power);
    Results run = run_yaml(car, one_span + Values{{"foundation_vertical_x", "10"},
                                                  {"foundation_vertical_k", "1e" + std::to_string(power)}});
    const double now = std::abs(peak(run("/probes/deflection")).first);
    EXPECT_LT(now, before * (1.0 + 1e-6));
    before = now;
    if (power == 0) {
      EXPECT_LT(difference(run, none, "/probes/deflection"), 1e-6);
    }
    if (power == 15) {
      EXPECT_LT(difference(run, support, "/probes/deflection"), 1e-5);
      EXPECT_LT(difference(run, support, "/vehicles/0/wheel/normal_force"), 1e-5);
    }
  }
}

// Held only by springs so soft that rounding of the elements' stiffness hides them: each option is named. With beds and
// springs to all sides of that they are not.
TEST(Spring, TooSoftForRounding) {
  const std::string free =
      "beam: {spans: [20.0], EI: 5.0e9, mass: 8.0e3, elements_per_span: 8}\nload: {forces: 1.0e5, speed: 40}\n";
  const auto refused = [&](const Values& options, const std::string& option) {
    SCOPED_TRACE(option);
    for (const Values& analysis : {Values{}, Values{{"scene_analysis", "modes"}}, Values{{"model_modes", "3"}}})
      expect_refused([&] { run_yaml(free, options + analysis); }, {option, "which rounding hides", "allowed: above"});
  };
  refused({{"support_stiffness", "1e-9,1e-9"}}, "support_stiffness:");
  refused({{"support_stiffness", "1e9,1e-9"}}, "support_stiffness:");
  const Values unsupported = {{"support_types", "free,free"}};
  refused(unsupported + Values{{"foundation_vertical_bed_k", "1e-20"}}, "foundation_vertical_bed_k:");
  refused(unsupported + Values{{"foundation_vertical_x", "3,17"}, {"foundation_vertical_k", "1e-20"}},
          "foundation_vertical_k:");
  refused({{"support_types", "pinned,free"}, {"foundation_rotational_x", "0"}, {"foundation_rotational_k", "1e-20"}},
          "foundation_rotational_k:");
}

// A spring as stiff as no material is a rigid support.
TEST(Spring, OfTenToTheThirty) {
  Results rigid = run_yaml(beam(8), {{"ts_dt", "1e-3"}, {"load_speed", "40"}});
  Results stiff = run_yaml(beam(8), {{"ts_dt", "1e-3"}, {"load_speed", "40"}, {"support_stiffness", "1e30,1e30"}});
  EXPECT_LT(difference(stiff, rigid, "/probes/deflection"), 1e-6);
  EXPECT_NO_THROW(run_yaml("beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0}\nload: {forces: 1.0e5, speed: 40}\n",
                           {{"support_stiffness", "1e30,1e30"}}));
}

TEST(Tension, ThatElementsDoNotResolveIsNamed) {
  const std::string open = "beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0}\nload: {forces: 1.0e5, speed: 40}\n";
  expect_refused([&] { run_yaml(open, {{"beam_tension", "1e30"}}); }, {"beam_tension:", "elements"});
  expect_refused(
      [&] {
        run_yaml(open, {{"foundation_shear_layer", "1e30"}});
      },
      {"foundation_shear_layer:", "elements"});
  expect_refused(
      [&] {
        run_yaml(open, {{"foundation_rotational_bed_k", "1e30"}});
      },
      {"foundation_rotational_bed_k:", "elements"});
}

// --- sizes -----------------------------------------------------------------------------------------------------------

// A beam of 10 mm bends by F L^3/(48 EI) = 0.083 mm, and turns by 0.025 rad, more than its length in metres. The
// force passes in 48 of its first periods, so that it is static within 1 %.
TEST(Size, OfTenMillimetres) {
  const std::string small = "beam: {spans: 0.01, EI: 1.0e-4, mass: 1.0e-2}\nload: {forces: 0.4, speed: 0.1}\n";
  for (const char* modes : {"0", "3"}) {
    Results run = run_yaml(small, {{"model_modes", modes}});
    EXPECT_NEAR(-run.attribute("/summary", "deflection"), 0.4 * 1e-6 / 48e-4, 0.01 * 0.4 * 1e-6 / 48e-4) << modes;
  }
}

// The first period is 64,000 s: the steps follow from it. The peak is that of the series of modes.
TEST(Size, OfAPeriodOfAlmostADay) {
  const MovingForce exact{10.0, 1.0, 1.0e6, 1.0e-3, 1.0e-4};
  double largest = 0.0;
  for (double t = 0.0; t < 1.0e5; t += 50.0) largest = std::max(largest, exact.deflection(5.0, t));
  Results run = run_yaml("beam: {spans: 10, EI: 1.0, mass: 1.0e6}\nload: {forces: 1.0e-3, speed: 1.0e-4}\n");
  EXPECT_NEAR(-run.attribute("/summary", "deflection"), largest, 2e-3 * largest);
}

// --- loads -----------------------------------------------------------------------------------------------------------

// Loads that cancel leave only rounding errors: their energies do not have to balance. Later the rest of the first
// load enters, and the response is the sum of those of both loads.
TEST(Loads, ThatCancel) {
  const auto both = [](const std::string& distributed) {
    return "beam: {spans: [20.0], EI: 5.0e9, mass: 8.0e3, damping_ratios: 0.01, elements_per_span: 4}\n"
           "load: {distributed: [" +
           distributed + "], speed: 40}\nts: {dt: 1.0e-3, max_time: 0.6}\n";
  };
  for (const char* modes : {"0", "3"}) {
    const Values by{{"model_modes", modes}};
    Results sum = run_yaml(both("-10, 0, 8.0e4, -5, 0, -8.0e4"), by), one = run_yaml(both("-10, 0, 8.0e4"), by),
            other = run_yaml(both("-5, 0, -8.0e4"), by);
    const auto &v = sum("/probes/deflection"), &a = one("/probes/deflection"), &b = other("/probes/deflection");
    ASSERT_EQ(v.size(), a.size());
    ASSERT_EQ(v.size(), b.size());
    const double scale = std::abs(peak(a).first);
    for (std::size_t i = 0; i < v.size(); ++i) ASSERT_NEAR(v[i], a[i] + b[i], 1e-9 * scale) << modes;
    EXPECT_GT(std::abs(peak(v).first), 0.1 * scale);
  }
}

}  // namespace
}  // namespace traverse::test
