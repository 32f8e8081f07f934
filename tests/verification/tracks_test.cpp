// Several tracks on a bridge that twists: superposition of trains and forces on two of them, by elements and by modes,
// the probes of each, and bearings beside the axis with equilibrium and uplift.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double L = 24.0, e = 2.25;

/// A bridge on forks with two tracks.
std::string bridge(const std::string& rest, const std::string& more = "") {
  return "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4, damping_ratios: 0.02" + more +
         "}\nsupport: {types: [pinned, roller]}\n"
         "tracks: {left: {eccentricity: 2.25}, right: {eccentricity: -2.25}}\n"
         "output: {probes: [6, 12], interval: 2e-3}\nts: {max_time: 0.6, dt: 5e-4}\n" +
         rest;
}

const std::string up = "up: {forces: [2.0e5, 1.5e5], positions: [0, -3], speed: 50, track: left}\n",
                  down = "down: {forces: 1.8e5, speed: -40, track: right}\n";

// By modes, the forces in one direction alone are exact in time; then the difference is the error of the steps.
TEST(Tracks, ForcesOnTwoTracksAddUp) {
  for (const auto& [modes, bound] : {std::pair("0", 1e-9), {"24", 2e-4}}) {
    const Values model = {{"model_modes", modes}};
    Results both = run_yaml(bridge("loads: [up, down]\n" + up + down), model),
            first = run_yaml(bridge("loads: up\n" + up), model),
            second = run_yaml(bridge("loads: down\n" + down), model);
    for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/twist", "/probes/torsional_moment",
                             "/probes/moment", "/supports/torque"}) {
      std::vector<double> sum = first(name);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second(name)[i];
      EXPECT_LT(relative_difference(both(name), sum), bound) << name << ", modes " << modes;
    }
    EXPECT_LT(energy_error(both), 1e-4) << modes;
  }
}

// The probes of both tracks: half of the sum of their deflections is that of the axis, half of the difference e times
// the twist.
TEST(Tracks, EachTrackHasItsProbes) {
  Results run = run_yaml(bridge("loads: up\n" + up));
  EXPECT_EQ(run("/probes/x"), (std::vector<double>{6, 12, 6, 12}));
  EXPECT_EQ(run("/probes/eccentricity"), (std::vector<double>{e, e, -e, -e}));
  for (std::size_t p = 0; p < 2; ++p) {
    std::vector<double> difference = run.column("/probes/deflection", p), twist = run.column("/probes/twist", p);
    const std::vector<double> right = run.column("/probes/deflection", p + 2);
    for (std::size_t i = 0; i < difference.size(); ++i) {
      difference[i] -= right[i];
      twist[i] *= 2.0 * e;
    }
    EXPECT_LT(relative_difference(difference, twist), 1e-9) << p;
  }
}

// A scene with names, a scene without, and the other direction on the mirrored track agree.
TEST(Tracks, OneTrackWithAName) {
  const std::string start = "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4}\n",
                    rest =
                        "support: {types: [pinned, roller]}\noutput: {probes: 12, interval: 2e-3}\n"
                        "load: {forces: 2.0e5, speed: 50}\nmodel: {modes: 12}\n";
  Results named = run_yaml(start + "tracks: {left: {eccentricity: 2.25}}\n" + rest),
          plain = run_yaml(start + "track: {eccentricity: 2.25}\n" + rest);
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/twist"})
    EXPECT_EQ(named(name), plain(name)) << name;
}

/// Vehicles on two tracks in both directions, by elements and by modes.
TEST(Tracks, TrainsOnTwoTracks) {
  const std::string rest = "vehicle:\n  coach:\n    file: " + source_folder() +
                           "/options/vehicles/manchester.yml\n"
                           "trains: {up: {vehicles: coach, speed: 60, track: left}, "
                           "down: {vehicles: coach, speed: -50, track: right}}\n",
                    more = ", elements_per_span: 48";
  const Values wide = {{"ts_max_time", "0.9"}};
  Results elements = run_yaml(bridge(rest, more), wide);
  Values by_modes = wide, full = wide;
  by_modes.emplace_back("model_modes", "40");
  full.emplace_back("model_vehicles", "full");
  Results modes = run_yaml(bridge(rest, more), by_modes), mechanisms = run_yaml(bridge(rest, more), full);
  for (const char* name : {"/probes/deflection", "/probes/twist"}) {
    EXPECT_LT(relative_difference(modes(name), elements(name)), 3e-3) << name;
    EXPECT_LT(relative_difference(mechanisms(name), elements(name)), 1e-4) << name;
  }
  EXPECT_LT(energy_error(elements), 1e-4);
}

/// The last value of each bearing under a force that stands.
std::vector<double> bearings(const std::string& one_sided, double eccentricity, double skew) {
  Results run = run_yaml(
      "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4, self_weight: true}\n"
      "support: {types: [free, free]}\n"
      "foundation: {vertical: {k: 2.0e9, eccentricity: [-2, 2, -2, 2], one_sided: " +
          one_sided +
          "}}\n"
          "load: {forces: 1.2e6, positions: 10, speed: 0}\nts: {max_time: 0.01}\noutput: {probes: 12}\n",
      {{"track_eccentricity", text(eccentricity)},
       {"foundation_vertical_x", text(0.0) + "," + text(skew) + "," + text(L - skew) + "," + text(L)}});
  const std::vector<double> all = run("/foundation/vertical/force");
  return {all.end() - 4, all.end()};
}

// Bearings of a skew bridge are at different x on both sides. Their forces balance weight and load about both axes.
TEST(Tracks, BearingsOfASkewBridge) {
  constexpr double F = 1.2e6, weight = 9.0e3 * 9.81 * L, x = 10.0, skew = 1.5;
  for (const char* one_sided : {"false", "true"})
    for (const double from_axis : {1.0, 5.0}) {
      const std::vector<double> R = bearings(one_sided, from_axis, skew), at = {0.0, skew, L - skew, L},
                                side = {-2.0, 2.0, -2.0, 2.0};
      double force = 0.0, moment = 0.0, torque = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        force += R[i];
        moment += R[i] * at[i];
        torque += R[i] * side[i];
      }
      EXPECT_NEAR(force, F + weight, 1e-6 * F);
      EXPECT_NEAR(moment, F * x + weight * 0.5 * L, 1e-6 * F * L);
      EXPECT_NEAR(torque, F * from_axis, 1e-6 * F * from_axis);
      const double least = *std::min_element(R.begin(), R.end());
      if (from_axis == 1.0) EXPECT_GT(least, 1e5);
      if (from_axis == 5.0 && one_sided == std::string("false")) EXPECT_LT(least, -1e5);
      if (one_sided == std::string("true")) EXPECT_GE(least, -1e-6 * F);
    }
}

// Static effects: a force on the track, and LM71 on one track or on both, whose torques cancel.
TEST(Tracks, LoadModelsOnOneAndTwoTracks) {
  const std::string flat = "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3", twisting = ", GJ: 1.1e10, polar_inertia: 4.0e4",
                    rest =
                        "}\nsupport: {types: [pinned, roller]}\nscene: {analysis: envelope}\n"
                        "norm_load_models: lm71\nload: {forces: 2.0e5}\noutput: {probes: 12}\n";
  Results plain = run_yaml(flat + rest), one = run_yaml(flat + twisting + rest, {{"track_eccentricity", "2.25"}}),
          two = run_yaml(flat + twisting + rest, {{"track_eccentricity", "2.25"}, {"norm_second_track", "-2.25"}});
  const std::size_t places = plain("/static/x").size(), middle = places / 2;
  const auto least = [&](Results& run, const char* name, std::size_t load) {
    return run(name)[2 * (load * places + middle)];
  };
  const auto greatest = [&](Results& run, const char* name, std::size_t load) {
    return run(name)[2 * (load * places + middle) + 1];
  };
  constexpr double F = 2.0e5, EI = 3.0e10, GJ = 1.1e10;
  const double force = -F * (std::pow(L, 3) / (48.0 * EI) + e * e * L / (4.0 * GJ));
  EXPECT_NEAR(least(one, "/static/deflection", 0), force, 1e-9 * std::abs(force));
  EXPECT_NEAR(least(two, "/static/deflection", 0), force, 1e-9 * std::abs(force));
  EXPECT_LT(least(one, "/static/deflection", 1), 1.05 * least(plain, "/static/deflection", 1));
  EXPECT_NEAR(least(two, "/static/deflection", 1) / least(plain, "/static/deflection", 1), 2.0, 1e-9);
  // The rate of the twist on both sides of the force in the middle.
  const double twist = 0.5 * 1.435 * 3.0 * F * e / GJ;
  EXPECT_NEAR(greatest(one, "/static/track_twist", 0), twist, 1e-5 * twist);
  EXPECT_NEAR(greatest(two, "/static/track_twist", 0), twist, 1e-5 * twist);
  EXPECT_NEAR(greatest(one, "/static/moment", 1) / greatest(plain, "/static/moment", 1), 1.0, 1e-9);
  EXPECT_NEAR(greatest(two, "/static/moment", 1) / greatest(plain, "/static/moment", 1), 2.0, 1e-9);
  Results named =
      run_yaml("tracks: {left: {eccentricity: 2.25}, right: {eccentricity: -2.25}}\n" + flat + twisting + rest,
               {{"load_track", "left"}});
  for (const char* name : {"/static/deflection", "/static/track_twist", "/static/reaction"})
    EXPECT_EQ(named(name), two(name)) << name;
  // On cant a force at rest acts beside the track, whose own place is that of the deflection.
  Results canted = run_yaml(flat + twisting + rest, {{"track_eccentricity", "2.25"},
                                                     {"track_cant", "0.16"},
                                                     {"track_cant_base", "1.5"},
                                                     {"track_load_height", "1.8"}});
  EXPECT_NEAR(greatest(canted, "/static/track_twist", 0) / twist, (e + 1.8 * 0.16 / 1.5) / e, 1e-5);
}

// Cant and a curve: the weights act beside the track, as forces on a track at their place do, by elements and by modes.
TEST(Tracks, CantAndCurve) {
  constexpr double height = 1.8, rails = 1.0, speed = 50.0, radius = -1500.0;
  const double place = e + height * 0.1 / 1.5 - (rails + height) * speed * speed / (9.81 * radius);
  const auto run = [&](const Values& track, const char* modes) {
    Values options = track;
    options.emplace_back("model_modes", modes);
    return run_yaml(bridge("load: {forces: [2.0e5, 1.0e5], positions: [0, -3], speed: 50, track: left}\n"), options);
  };
  for (const auto& [modes, bound] : {std::pair("0", 1e-12), {"12", 1e-6}}) {
    Results given = run({{"left_cant", "0.1"}, {"left_curve_radius", "-1500"}, {"left_height", "1"}}, modes),
            moved = run({{"left_eccentricity", fmt::format("{:.17g}", place)}}, modes);
    for (const char* name : {"/probes/twist", "/probes/moment", "/probes/torsional_moment"})
      EXPECT_LT(relative_difference(given(name), moved(name)), bound) << name << ", modes " << modes;
  }
}

// A train through a curve: slowly, its torque is that of its weights at their place; and energy is conserved.
TEST(Tracks, TrainInACurve) {
  const std::string vehicle = "vehicle: {coach: {file: " + source_folder() + "/options/vehicles/manchester.yml" +
                              "}}\n" +
                              "output: {probes: 12}\ntrain: {vehicles: coach, speed: 0.5, positions: 13}\n"
                              "ts: {max_time: 0.1}\n";
  const std::string start =
      "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4}\n"
      "support: {types: [pinned, roller]}\n" +
      vehicle;
  for (const char* modes : {"", "model: {modes: 12}\n"}) {
    Results straight = run_yaml(start + modes + "track: {eccentricity: 0.5}\n"),
            curved = run_yaml(start + modes + "track: {eccentricity: 0.5, curve_radius: 0.5, cant: 0.15}\n");
    const double ratio = (0.5 + 0.18 - 1.8 * 0.25 / (9.81 * 0.5)) / 0.5;
    EXPECT_NEAR(curved("/probes/twist").front() / straight("/probes/twist").front(), ratio, 1e-4) << modes;
    EXPECT_LT(energy_error(curved), 1e-4) << modes;
  }
}

// Wind on a train that stands: a torque of force times height, whose twist is that of a bar on forks.
TEST(Tracks, ForcesToTheLeftTwist) {
  constexpr double wind = 3e3, height = 3.5, GJ = 1.1e10;
  Results run = run_yaml(bridge("loads: wind\nwind: {distributed: [0, 24, 3.0e3], sideways_height: 3.5, speed: 0}\n"),
                         {{"ts_max_time", "1e-3"}});
  const double twist = -wind * height * L * L / (8.0 * GJ);
  EXPECT_NEAR(run.column("/probes/twist", 1).front(), twist, 1e-9 * std::abs(twist));
  EXPECT_NEAR(run.column("/supports/torque", 0).front(), 0.5 * wind * height * L, 1e-6 * wind * height * L);
  EXPECT_LT(*std::ranges::max_element(run("/probes/moment")), 1e-6 * wind * height);
}

// The largest twist at the probes and the uplift of a bearing as limits.
TEST(Tracks, LimitsOfTwistAndUplift) {
  const TemporaryFolder folder;
  const std::string limits = folder.write("limits.yml",
                                          "- {clause: EN 1990, quantity: track_twist, value: 1e-3}\n"
                                          "- {clause: none, quantity: bearing_uplift, value: 1}\n");
  Results run = run_yaml(bridge("load: {forces: 2.0e5, speed: 40, track: left}\nsupport_bearing_spacing: 3\n"),
                         {{"limits", limits}, {"output_interval", "5e-4"}});
  double twist = 0.0, uplift = 0.0;
  for (const double one : run("/probes/track_twist")) twist = std::max(twist, std::abs(one));
  for (const double one : run("/supports/right_bearing")) uplift = std::max(uplift, -one);
  const std::vector<double> found = run("/verdicts/value");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0] / twist, 1.0, 1e-2);
  EXPECT_GT(uplift, 1e4);
  EXPECT_NEAR(found[1] / uplift, 1.0, 5e-2);
}

// The rate of the twist jumps where a force passes. Runs by modes that are judged together know it on both sides; a run
// by itself, by modes or by elements, finds both sides from its samples, however far apart they are.
TEST(Tracks, ASweepIsJudgedByTheTwist) {
  const TemporaryFolder folder;
  const std::string limits = folder.write("limits.yml",
                                          "- {clause: EN 1990, quantity: track_twist, value: 1e-3}\n"
                                          "- {clause: EN 1990, quantity: end_rotation, value: 1e-3}\n");
  const std::string loads = "loads: up\n" + up;
  const Values judged = {{"limits", limits}, {"model_modes", "8"}};
  Results sweep = run_yaml(bridge(loads), judged + Values{{"sweep_speed", "41,61,10"}, {"sweep_refine", "0"}});
  EXPECT_EQ(sweep("/sweep/speed"), (std::vector<double>{41, 51, 61}));
  const std::vector<double> found = sweep("/sweep/judged");
  for (std::size_t run = 0; run < 3; ++run) {
    const Values speed = {{"up_speed", std::to_string(41 + 10 * run)}};
    const auto alone = [&](const Values& more) {
      Results results = run_yaml(bridge(loads), Values{{"limits", limits}} + speed + more);
      return results("/verdicts/value");
    };
    const std::vector<double> wanted = alone({{"model_modes", "8"}, {"output_interval", "2e-5"}});
    for (std::size_t limit = 0; limit < 2; ++limit)
      EXPECT_NEAR(found[2 * run + limit] / wanted[limit], 1.0, 2e-4) << run << ", limit " << limit;
    EXPECT_NEAR(alone({{"model_modes", "8"}, {"output_interval", "3e-3"}})[0] / wanted[0], 1.0, 1e-3) << run;
    EXPECT_NEAR(alone({})[0] / alone({{"step_probes", "true"}, {"ts_dt", "2e-4"}})[0], 1.0, 1e-3) << run;
  }
}

TEST(Tracks, Refusals) {
  EXPECT_EQ(message_of([] {
              run_yaml(bridge("load: {forces: 1, speed: 1}\n"), {{"left_curve_radius", "0"}});
            }).find("left_curve_radius"),
            0U);
  const auto refused = [](const std::string& yaml) { return message_of([&] { run_yaml(yaml); }); };
  EXPECT_EQ(refused(bridge("load: {forces: 1, speed: 1}\n")).find("load_track"), 0U);
  EXPECT_NE(refused(bridge("load: {forces: 1, speed: 1}\n")).find("allowed: left, right"), std::string::npos);
  EXPECT_NE(refused(bridge("load: {forces: 1, speed: 1, track: middle}\n")).find("there is no such track"),
            std::string::npos);
  EXPECT_EQ(refused("beam: {spans: 24, EI: 3.0e10, mass: 9.0e3}\nload: {forces: 1, speed: 1, track: left}\n")
                .find("load_track"),
            0U);
  EXPECT_EQ(refused("beam: {spans: 24, EI: 3.0e10, mass: 9.0e3}\ntracks: {left: {eccentricity: 1}}\n").find("tracks"),
            0U);
}

}  // namespace
}  // namespace traverse::test
