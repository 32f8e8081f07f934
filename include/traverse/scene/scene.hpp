// A scene as the user wrote it, checked and with every default filled in. Built by read_scene, the only reader of
// options; the physics sees nothing but these structures.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/options/norm_rules.hpp"
#include "traverse/options/options.hpp"
#include "traverse/options/rail_loads.hpp"
#include "traverse/options/study.hpp"
#include "traverse/options/verdict_limit.hpp"
#include "traverse/scene/numerical_model.hpp"
#include "traverse/track/profile.hpp"
#include "traverse/train/vehicle.hpp"

namespace traverse::app {

enum class Start { equilibrium, given };

using options::Analysis;
using options::Study;
using options::StudyDimension;
using train::Coupler;
using train::Drive;
using train::MovingLoad;
using train::Train;
using train::Vehicle;
using train::Wheel;

struct Damping {
  std::optional<std::pair<double, double>> rayleigh;     // a, b given
  std::optional<std::pair<double, double>> ratios;       // zeta1, zeta2
  std::optional<std::pair<double, double>> frequencies;  // Hz, the pair that the ratios belong to, when named
};

struct Output {
  std::string file;                // HDF5; empty: none
  std::optional<double> interval;  // s; left out: chosen with the step
  std::vector<double> probes;      // stations; default: the middle of every span (of the first 200)
  std::optional<double> low_pass;  // Hz, up to which deck accelerations count; 0: all; left out: as EN 1990 has it
  bool low_pass_asked = false;     // else deck accelerations are filtered where limits ask for it
  bool low_passed_series = false;  // filtered accelerations are stored
  double wheel_low_pass = 20.0;    // Hz, up to which wheel forces count
  bool wheels_filtered = false;    // asked for; else where limits ask for it
  double unloading_level = 0.6;    // part of its force from which on a wheel counts as unloaded
  std::vector<double> passages;    // m: where the force of every wheel that passes is noted
  std::vector<double> sleepers;    // m: of a layered track, whose forces are stored
};

/// The random running surfaces that one spectrum describes.
struct Roughness {
  track::Spectrum spectrum;
  double shortest = 0.0, longest = 0.0;  // m: waves
  double start = 0.0;                    // m: before it the track is level
  bool to_the_left = false;              // else it begins to the right of that
  std::vector<track::Dip> dips = {};     // on top of each of them

  /// The running surface whose random phases follow from the seed, with the dips on top.
  track::Profile profile(std::uint64_t seed) const {
    track::Profile p = track::Profile::rough(spectrum, shortest, longest, to_the_left ? -start : start, seed);
    if (to_the_left) p = p.reversed();
    for (const track::Dip& dip : dips) p = p.with(dip);
    return p;
  }
};

/// Runs of one scene at many speeds, with many trains of forces, or both.
struct Sweep {
  std::vector<double> speeds;        // m/s; empty: that of the scene
  std::vector<int> trains;           // HSLM-A, 1 to 10; empty: what the scene holds
  std::vector<MovingLoad> loads;     // of each of these trains, at the scene's speed
  double refine = 0.0;               // of each peak over the speed, to which speeds are added; 0: none are; below 0:
                                     // where a limit may be broken between two of them
  std::size_t lanes = 8;             // runs side by side; 0: each by itself
  double instants = 20.0;            // looked at in a period of the fastest mode, where modes move exactly in time
  std::size_t runs = 0;              // of the study that these are a part of; 0: there are no others
  std::vector<std::uint64_t> seeds;  // of some tracks of the study, which differ in them; empty: the scene's own alone
};

struct Scene {
  std::string name;                     // of the options file, for messages and default file names
  std::optional<beam::BeamModel> beam;  // absent: a mechanism on its own, or on rigid ground
  Damping damping;
  bool self_weight = false;
  std::vector<Vehicle> vehicles;  // types in use
  Train train;
  MovingLoad load;
  track::Profile profile;
  std::optional<Roughness> roughness;  // that the profile is one of
  double gravity = 9.81;
  Analysis analysis = Analysis::transient;
  Start start = Start::equilibrium;
  std::optional<double> tail;      // s after the last wheel has left
  std::optional<double> end_time;  // -ts_max_time
  NumericalModel model;            // as far as it is said
  int mode_count = 10;
  bool modes_open = false;               // a sweep may take modes where these do as well
  std::vector<double> damping_of_modes;  // ratio of each mode, the last one for all further modes; empty: Rayleigh's
  std::optional<Sweep> sweep;
  std::optional<Study> study;
  std::optional<double> contact_tolerance;  // s
  int impact_steps = 20;
  double sampling_interval =
      std::numeric_limits<double>::infinity();  // s: longest between instants at which responses are seen
  bool all_ranks = false;                       // take the steps, whether that is faster or not
  double accuracy = 1e-3;
  std::vector<std::string> accuracy_of;  // peaks, as in the option's list; empty: all
  bool mesh_open = false;                // its elements are chosen from the accuracy
  bool step_open = false;                // so is the step
  bool accuracy_report = false;          // a refined run at the end shows the true errors
  bool accuracy_whole = false;           // trial runs are as long as the run
  bool accuracy_cache = true;            // what was chosen for the same scene before is taken again
  Output output;
  std::vector<options::VerdictLimit> limits;                 // that runs are checked against
  std::optional<options::NormRules> norm;                    // static effects and the verdict of EN 1991-2 are wanted
  std::optional<options::RailLoads> rail_loads;              // of scene_analysis rail
  bool quiet = false;                                        // -output_quiet: no progress
  bool check = false;                                        // -check: it is shown, nothing is run
  std::vector<std::string> notes;                            // what was chosen and why, one line each
  std::vector<std::string> unusual;                          // of these, what is no error and hardly meant
  std::vector<std::pair<std::string, std::string>> options;  // all as given, those of vehicle files too

  /// Whether limits ask something of runs, not of static effects alone.
  bool judges_runs() const {
    return std::any_of(limits.begin(), limits.end(), [](const options::VerdictLimit& limit) {
      return options::limit_quantity(limit.quantity)->finder == options::LimitFinder::run;
    });
  }
  /// Whether a limit is on the deck's low-passed accelerations.
  bool limits_deck_acceleration() const {
    return std::any_of(limits.begin(), limits.end(),
                       [](const options::VerdictLimit& limit) { return limit.quantity == "deck_acceleration"; });
  }
  /// Whether the bridge is modes that were given, without elements behind them.
  bool by_given_modes() const { return beam && beam->given; }
  /// Modes under moving forces alone, whose motion is known exactly; single runs of given modes are stepped.
  bool exact_in_time() const {
    return model.modes > 0 && vehicles.empty() && load.courses.empty() && (!by_given_modes() || sweep);
  }
};

/// x of the wheels of vehicle `i` of the train at t = 0, in m.
std::vector<double> wheels_at_start(const Scene& scene, std::size_t i);
/// x of the wheels of all vehicles of the train at t = 0, in m.
std::vector<double> wheels_at_start(const Scene& scene);

/// The greater of the train's and the forces' speed, m/s; 0 where there are neither.
double greatest_speed(const Scene& scene);

/// The shortest wave of the track or of a wheel out of round, m; infinite where all is smooth.
double shortest_wave(const Scene& scene);

/// Reads and checks all options and the vehicle files they name. Throws InputError with one line.
Scene read_scene(options::Options options);
/// The scene of the options in force, which are those that put_into_petsc saw last.
Scene read_scene();
/// The options that a study varies with their values in one run, as a user would write them.
std::vector<std::pair<std::string, std::string>> values_of_run(const Study& study, std::size_t run);
/// The scene of a study with other values (as a user would write them) of some of its options; a sweep of itself alone.
Scene read_scene_of_study(const options::Options& given,
                          const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace traverse::app
