// Influence lines and the worst places of loads on them, against closed forms and published values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "support/beam_model.hpp"
#include "support/folders.hpp"
#include "support/record.hpp"
#include "support/scene_run.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::test {
namespace {

using norm::Effect;

constexpr double EI = 3e10, span = 25.0;

beam::BeamModel simple_span(double length = span) {
  beam::BeamModel model = model_of({length}, 4);
  model.EI = EI;
  return model;
}

double largest(const norm::StaticEffects& all, Effect effect, std::size_t load = 0) {
  return all.at(effect, load, all.worst(effect, load, [](const norm::Place&) { return 1.0; })).size();
}

/// A haunched girder under a force at rest, by elements an eighth as long as those of the influence lines.
TEST(InfluenceLines, OfAHaunchedGirder) {
  const std::string folder = source_folder() + "/options/bridges/haunched_";
  const std::string girder = "beam: {spans: [35.0, 50.0, 35.0], EI: " + folder + "EI.csv, mass: " + folder +
                             "mass.csv}\nscene: {analysis: static}\nload: {forces: 1.0e6}\n" +
                             "output: {probes: 11.3}\n";
  const scene::Scene scene = scene::read_scene(options::Options::from_yaml(girder));
  norm::StaticBridge bridge(*scene.beam);
  const auto lines = bridge.lines_at(11.3).front();
  double deflection_error = 0.0, moment_error = 0.0;
  for (const char* x : {"4.1", "11.9", "13.7", "40.2"}) {
    Results run = run_yaml(girder, {{"load_positions", x}, {"beam_elements_per_span", "512"}});
    const double deflection = run("/probes/deflection")[0], moment = run("/probes/moment")[0];
    deflection_error = std::max(deflection_error, std::abs(1e6 * lines[0].value(std::stod(x)) / deflection - 1.0));
    moment_error = std::max(moment_error, std::abs(1e6 * lines[1].value(std::stod(x)) / moment - 1.0));
  }
  record("deflection_error", deflection_error);
  record("moment_error", moment_error);
  EXPECT_LT(deflection_error, 1e-6);
  EXPECT_LT(moment_error, 1e-6);
}

// Six D2 wagons of EN 15528: the program's own train of that name is tested in load_models_test.cpp.
norm::LoadModel d2() {
  std::vector<double> forces, x;
  for (int wagon = 0; wagon < 6; ++wagon)
    for (const double behind : {0.0, 1.8, 9.25, 11.05}) {
      forces.push_back(22.5e3 * 9.81);
      x.push_back(-14.05 * wagon - behind);
    }
  return norm::train_of("D2", forces, x);
}

// Inside elements too: midspan is a node, the other sections and nearly all places of the force are not.
TEST(InfluenceLines, OfASimpleSpan) {
  norm::StaticBridge bridge(simple_span());
  for (const double a : {3.7, 12.5, 24.1}) {
    const auto lines = bridge.lines_at(a).front();
    for (const double x : {0.3, 3.1, 5.0, 11.9, 17.77, 24.9}) {
      const double low = std::min(a, x), high = std::max(a, x);
      const double deflection =
          low * (span - high) * (span * span - low * low - (span - high) * (span - high)) / (6.0 * EI * span);
      EXPECT_NEAR(lines[0].value(x), -deflection, 1e-11 * span * span * span / EI) << a << ", " << x;
      EXPECT_NEAR(lines[1].value(x), low * (span - high) / span, 1e-10) << a << ", " << x;
      EXPECT_NEAR(lines[2].value(x), x > a ? 1.0 - x / span : -x / span, 1e-10) << a << ", " << x;
    }
  }
  const norm::InfluenceLine reaction = bridge.reaction(bridge.bearings().front()).front();
  const norm::InfluenceLine rotation = bridge.end_rotation(false).front();
  for (const double x : {0.3, 3.1, 17.77}) {
    EXPECT_NEAR(reaction.value(x), 1.0 - x / span, 1e-10);
    EXPECT_NEAR(rotation.value(x), -x * (span - x) * (2.0 * span - x) / (6.0 * EI * span), 1e-10 * span * span / EI);
  }
}

// Two equal spans: the moment over the inner support is x (x^2 - L^2)/(4 L^2), its reaction x (3 L^2 - x^2)/(2 L^3).
TEST(InfluenceLines, OfTwoSpans) {
  beam::BeamModel model = model_of({span, span}, 3);
  norm::StaticBridge bridge(model);
  const auto lines = bridge.lines_at(span).front();
  const norm::InfluenceLine reaction = bridge.reaction(bridge.bearings()[1]).front();
  for (const double x : {1.3, 10.0, 14.4, 24.99}) {
    const double moment = x * (x * x - span * span) / (4.0 * span * span);
    EXPECT_NEAR(lines[1].value(x), moment, 1e-9);
    EXPECT_NEAR(lines[1].value(2.0 * span - x), moment, 1e-9);
    EXPECT_NEAR(reaction.value(x), x * (3.0 * span * span - x * x) / (2.0 * span * span * span), 1e-9);
  }
}

// Two decks of one span each: at the joint their ends turn by P a (L^2 - a^2)/(6 EI L) towards each other.
TEST(InfluenceLines, OfAJoint) {
  beam::BeamModel model = model_of({span, span}, 3);
  model.EI = EI;
  model.joints = {beam::Joint::separate};
  norm::StaticBridge bridge(model);
  ASSERT_EQ(bridge.joints(), std::vector{1});
  const norm::InfluenceLine line = bridge.joint_rotation(1).front();
  for (const double a : {1.3, 10.0, 24.0}) {
    const double turn = a * (span * span - a * a) / (6.0 * EI * span);
    EXPECT_NEAR(line.value(a), -turn, 1e-10 * span * span / EI);
    EXPECT_NEAR(line.value(2.0 * span - a), -turn, 1e-10 * span * span / EI);
  }
}

// On springs a rigid bridge bears by the lever: the line of a spring's force is 1 - x/L.
TEST(InfluenceLines, OfSpringsUnderTheEnds) {
  beam::BeamModel model = simple_span();
  model.supports = {beam::Support::free, beam::Support::free};
  model.foundation.vertical = {{0.0, 1e8, 0.0}, {span, 1e8, 0.0}};
  norm::StaticBridge bridge(model);
  const norm::InfluenceLine line = bridge.reaction(bridge.bearings().front()).front();
  for (const double x : {0.0, 3.1, 17.77}) EXPECT_NEAR(line.value(x), 1.0 - x / span, 1e-9);
}

// Six D2 wagons on 25 m, at midspan and anywhere on a grid of 0.25 m.
TEST(StaticEffects, CheckCaseOfEN15528) {
  norm::StaticBridge bridge(simple_span());
  const norm::StaticEffects all = norm::static_effects(bridge, {d2()}, 0.25, {});
  const auto& sections = all.places[0];
  const auto middle = std::find_if(sections.begin(), sections.end(), [](const auto& p) { return p.x == 12.5; });
  ASSERT_NE(middle, sections.end());
  const auto i = static_cast<std::size_t>(middle - sections.begin());
  const double deflection = all.at(Effect::deflection, 0, i).size(), moment = all.at(Effect::moment, 0, i).size();
  const double anywhere = largest(all, Effect::moment);
  EXPECT_NEAR(deflection, 1.125392e-2, 1e-5 * 1.125392e-2);
  EXPECT_NEAR(moment, 5.00494e6, 1e-5 * 5.00494e6);
  EXPECT_NEAR(anywhere, 5.08219e6, 1e-5 * 5.08219e6);
  record("deflection_error", std::abs(deflection / 1.125392e-2 - 1.0));
  record("moment_error", std::abs(moment / 5.00494e6 - 1.0));
  record("anywhere_error", std::abs(anywhere / 5.08219e6 - 1.0));
}

// The uniform load with the same greatest moment is 148.8, 121.5, 98.4 kN/m at 10, 20, 50 m.
TEST(StaticEffects, UniformLoadLikeLM71) {
  const double published[][2] = {{10.0, 148.8}, {20.0, 121.5}, {50.0, 98.4}};
  for (const auto& [length, uniform] : published) {
    norm::StaticBridge bridge(simple_span(length));
    const norm::StaticEffects all = norm::static_effects(bridge, {norm::load_model("lm71")}, 1e-3 * length, {});
    const double found = 8e-3 * largest(all, Effect::moment) / (length * length);
    EXPECT_NEAR(found, uniform, 0.05) << length;
    record(("error_" + std::to_string(static_cast<int>(length))).c_str(), std::abs(found - uniform));
  }
}

// A uniform load that is longer than the span: q L^2/8, q L/2, 5 q L^4/(384 EI), q L^3/(24 EI).
TEST(StaticEffects, OfALongUniformLoad) {
  norm::StaticBridge bridge(simple_span(12.0));
  const double q = 150e3, L = 12.0;
  const norm::StaticEffects all = norm::static_effects(bridge, {norm::load_model("sw2")}, 0.0, {});
  EXPECT_NEAR(largest(all, Effect::moment), q * L * L / 8.0, 1e-9 * q * L * L);
  EXPECT_NEAR(largest(all, Effect::shear), q * L / 2.0, 1e-5 * q * L);  // a millionth of the span beside the support
  EXPECT_NEAR(largest(all, Effect::reaction), q * L / 2.0, 1e-9 * q * L);
  EXPECT_NEAR(largest(all, Effect::deflection), 5.0 * q * L * L * L * L / (384.0 * EI), 1e-9);
  EXPECT_NEAR(largest(all, Effect::end_rotation), q * L * L * L / (24.0 * EI), 1e-9);
}

// Against every position on a close grid, one load after another: two continuous spans, a haunch in one of them.
TEST(StaticEffects, NothingIsWorseOnACloseGrid) {
  beam::BeamModel model = model_of({18.0, 23.0}, 3);
  model.EI = beam::Distribution({0.0, 18.0, 41.0}, {2e9, 6e9, 2e9}, "EI");
  norm::StaticBridge bridge(model);
  for (const double section : {7.0, 17.3, 30.0}) {
    const auto lines = bridge.lines_at(section).front();
    for (const norm::InfluenceLine& line : lines) {
      const norm::InfluenceLine both[] = {line, line.times(-1.0)};
      for (const norm::InfluenceLine& one : both) {
        double lm71 = 0.0, sw0 = 0.0, train = 0.0;
        constexpr int points = 20500;  // 2 mm
        constexpr double step = 41.0 / points;
        std::vector<double> value, area = {0.0}, above = {0.0};
        for (int i = 0; i < points; ++i) {
          value.push_back(one.value((i + 0.5) * step));
          area.push_back(area.back() + step * value.back());
          above.push_back(above.back() + step * std::max(value.back(), 0.0));
        }
        const auto at = [&](const std::vector<double>& sums, double x) {
          return sums[static_cast<std::size_t>(std::clamp(std::round(x / step), 0.0, static_cast<double>(points)))];
        };
        for (double s = -42.0; s < 45.0; s += 5.0 * step) {
          double of_lm71 = 80e3 * (above.back() - at(above, s + 5.6) + at(above, s - 0.8));
          for (int i = 0; i < 4; ++i) of_lm71 += 250e3 * one.value(s + 1.6 * i);
          lm71 = std::max(lm71, of_lm71);
          sw0 = std::max(sw0, 133e3 * (at(area, s + 15.0) - at(area, s) + at(area, s + 35.3) - at(area, s + 20.3)));
          double of_train = 0.0;
          for (const auto& force : d2().forces) of_train += force.force * one.value(s + force.x);
          train = std::max(train, of_train);
        }
        EXPECT_NEAR(norm::greatest(one, norm::load_model("lm71")).value, lm71, 2e-3 * lm71);
        EXPECT_NEAR(norm::greatest(one, norm::load_model("sw0")).value, sw0, 2e-3 * lm71);
        EXPECT_GE(norm::greatest(one, d2()).value, train - 1e-12 * std::abs(train));
      }
    }
  }
}

}  // namespace
}  // namespace traverse::test
