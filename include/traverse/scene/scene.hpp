// A scene as the user describes it, checked and with all defaults, and its numerical model, given by the user or
// selected for the wanted accuracy. read_scene, the only reader of options, creates it; the physics depends only on
// these structures.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/options/fit.hpp"
#include "traverse/options/norm_rules.hpp"
#include "traverse/options/options.hpp"
#include "traverse/options/study.hpp"
#include "traverse/options/verdict_limit.hpp"
#include "traverse/track/profile.hpp"
#include "traverse/train/vehicle.hpp"

namespace traverse::scene {

/// Vehicles as mechanisms (full), or linear where possible. automatic: linear if the search for the accuracy finds the
/// difference negligible, until then mechanisms.
enum class VehicleModel { full, linear, automatic };

/// Representation of the bridge, mesh, method and step, and vehicle model.
struct NumericalModel {
  int modes = 0;  // number of modes of the bridge; 0: elements
  int elements =
      0;  // elements in the longest span, or rail elements in a sleeper bay; 0: the elements of the beam model
  std::optional<double> step;  // s; none: not yet selected, or exact in time
  std::string method;          // time integrator, a name of -ts_type; empty: the integrator in the options
  VehicleModel vehicles = VehicleModel::full;
  /// Largest permitted residual of linear vehicles over their weight, above which the run is repeated with mechanisms.
  double residual_limit = std::numeric_limits<double>::infinity();
  bool trials_lost_contact = false;  // wheels lost contact in trial runs
  double window_tolerance = -1.0;    // relative motion below which parts far from the train are excluded; -1: auto
  bool local_compliance = false;     // bridge elements deflect between their nodes under wheels
  bool step_kinks = true;            // steps end where wheels pass kinks of the surface
  bool step_probes = false;          // steps end where wheels pass probes

  bool operator==(const NumericalModel&) const = default;
};

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

/// The damping of a beam of elements.
struct Damping {
  std::optional<std::pair<double, double>> rayleigh;     // a, b
  std::optional<std::pair<double, double>> ratios;       // zeta1, zeta2
  std::optional<std::pair<double, double>> frequencies;  // Hz, at which the ratios apply, if given
};

/// The stored and reported results of a run.
struct Output {
  std::string file;                // HDF5 file; empty: none
  std::optional<double> interval;  // s; none: selected with the step
  std::vector<double> probes;      // stations, m; default: midspan of the first 200 spans; once for each named track
  std::vector<double> eccentricities;  // m, of each probe to the left of the shear centre; empty: of the only track
  std::optional<double> low_pass;      // Hz, cut-off of deck accelerations; 0: no filter; none: by EN 1990
  bool series = true;                  // false: peaks only, and trains beside the bridge are not computed
  bool low_pass_requested = false;     // false: deck accelerations are filtered only for limits
  bool low_passed_series = false;      // filtered accelerations are stored over time
  double wheel_low_pass = 20.0;        // Hz, cut-off of wheel forces
  bool wheels_filtered = false;        // true: wheel forces are filtered by request; false: only for limits
  double unloading_level = 0.6;        // lost fraction of its force from which on a wheel counts as unloaded
  std::vector<double> passages;        // m: places at which the force of each passing wheel is stored
  std::vector<double> sleepers;        // m: stations of the sleepers whose forces are stored
  std::vector<double> rail;            // m: further stations of the rail, also beyond the bridge
  bool contact_points = false;         // the motion of the running surface under each wheel is stored
  /// m: distance of the stations at which the running surface's height is stored; 0: none; empty: selected.
  std::optional<double> profile = 0.0;
};

/// A random running surface with a given spectrum.
struct Roughness {
  track::Spectrum spectrum;
  double shortest = 0.0, longest = 0.0;  // m, wavelengths
  double start = 0.0;                    // m, station before which the track is level
  bool to_the_left = false;              // true: the roughness extends to the left of start; false: to the right
  std::vector<track::Dip> dips = {};     // added to the roughness

  /// The running surface with random phases from the seed, including the dips.
  track::Profile profile(std::uint64_t seed) const {
    track::Profile p = track::Profile::rough(spectrum, shortest, longest, to_the_left ? -start : start, seed);
    if (to_the_left) p = p.reversed();
    for (const track::Dip& dip : dips) p = p.with(dip);
    return p;
  }
};

/// Runs of one scene at several speeds, with several trains of forces, or both.
struct Sweep {
  std::vector<double> speeds;        // m/s; empty: the speed of the scene
  std::vector<int> trains;           // HSLM-A, 1 to 10; empty: the loads of the scene
  std::vector<MovingLoad> loads;     // forces of each of these trains, at the scene's speed
  double refine = 0.0;               // relative accuracy of peaks over the speed, for which speeds are added; 0: no
                                     // speeds are added; below 0: only where a limit may be exceeded between two
  std::size_t lanes = 8;             // runs per SIMD batch; 0: each run separately
  double instants = 20.0;            // samples per period of the fastest mode, for modes that are exact in time
  std::size_t runs = 0;              // number of all runs of the study; 0: not part of a study
  std::vector<std::uint64_t> seeds;  // seeds of the study's random tracks; empty: only the seed of the scene
};

/// A track of a beam that twists.
struct Track {
  std::string name;
  beam::ActionLine line;
};

/// All data of one problem.
struct Scene {
  std::string name;                     // from the options file, for messages and default file names
  std::optional<beam::BeamModel> beam;  // none: mechanisms without a bridge, or on rigid ground
  Damping damping;
  bool self_weight = false;
  // Displacement of each support upward and along the beam, m; empty: at rest.
  std::vector<base::TimeFunction> support_motion, support_motion_along;
  std::vector<Vehicle> vehicles;  // types of vehicles in the trains
  Train train;
  MovingLoad load;
  std::vector<Track> tracks;  // those with names; empty: one track at track_eccentricity
  track::Profile profile;
  std::optional<Roughness> roughness;  // roughness whose sample is the profile
  double gravity = 9.81;
  Analysis analysis = Analysis::transient;
  Start start = Start::equilibrium;
  std::optional<double> tail;      // s, free vibration after the last wheel has left
  std::optional<double> end_time;  // -ts_max_time
  NumericalModel model;            // values that the user has given
  int mode_count = 10;
  bool modes_open = false;  // a sweep may use modes if they are accurate enough
  std::vector<double>
      damping_of_modes;  // damping ratio of each mode, the last one for all further modes; empty: Rayleigh damping
  std::optional<Sweep> sweep;
  std::optional<Study> study;
  std::optional<options::Fit> fit;
  std::optional<double> contact_tolerance;  // s
  int impact_steps = 20;
  double sampling_interval =
      std::numeric_limits<double>::infinity();  // s: longest time between two samples of the responses
  bool all_ranks = false;                       // use all ranks for a single run, even if that is slower
  double accuracy = 1e-3;
  std::vector<std::string> accuracy_of;  // names of peaks from the option's list; empty: all
  bool mesh_open = false;                // the elements are selected from the accuracy
  bool step_open = false;                // the step is selected from the accuracy
  bool accuracy_report = false;          // a refined run at the end gives the true errors
  bool accuracy_cache = true;            // choices for the same scene from earlier runs are used again
  Output output;
  std::vector<options::VerdictLimit> limits;                 // limits of results, checked for each run
  std::optional<options::NormRules> norm;                    // for static effects and the verdict of EN 1991-2
  std::optional<options::RailLoads> rail_loads;              // loads for scene_analysis rail
  std::optional<options::Screen> screen;                     // bridges and trains of scene_analysis screen
  bool quiet = false;                                        // -output_quiet: no progress display
  bool verbose = false;                                      // -verbose: details of the model are printed
  bool describe = false;                                     // -describe: the scene is reported, without a run
  std::vector<std::string> notes;                            // choices with their reasons, one line each
  std::vector<std::string> unusual;                          // the notes on possible but unusual input
  std::vector<std::pair<std::string, std::string>> options;  // all given options, also the options in vehicle files
  std::shared_ptr<const options::Entries> given;             // the options that describe it, with their sources

  /// A given option; null if it is not given.
  const options::Entry* find_option(std::string_view option) const { return given ? given->find(option) : nullptr; }

  /// Whether there are limits of transient runs, and not only of static effects.
  bool has_run_limits() const {
    return std::any_of(limits.begin(), limits.end(), [](const options::VerdictLimit& limit) {
      return options::limit_quantity(limit.quantity)->finder == options::LimitFinder::run;
    });
  }
  bool limits_quantity(std::string_view quantity) const {
    return std::any_of(limits.begin(), limits.end(),
                       [&](const options::VerdictLimit& limit) { return limit.quantity == quantity; });
  }
  /// Whether there is a limit of the low-passed deck acceleration.
  bool limits_deck_acceleration() const { return limits_quantity("deck_acceleration"); }
  /// Whether the bridge consists of given modes, without elements.
  bool by_given_modes() const { return beam && beam->given; }
  bool supports_move() const { return !support_motion.empty() || !support_motion_along.empty(); }
  /// Whether supports move vertically or have settled: then the relative deflections differ from those in space.
  bool supports_displaced() const {
    return !support_motion.empty() ||
           (beam && std::any_of(beam->settlement.begin(), beam->settlement.end(), [](double s) { return s != 0.0; }));
  }
  /// Whether the motion is exact in time: modes under moving forces alone, but not single runs of given
  /// modes, nor on a track with a curve or cant.
  bool exact_in_time() const {
    return model.modes > 0 && vehicles.empty() && load.courses.empty() && (!by_given_modes() || sweep) &&
           !(beam->torsion && beam->torsion->shifts());
  }
};

/// x of the wheels of vehicle `i` of the train at t = 0, in m.
std::vector<double> wheels_at_start(const Scene& scene, std::size_t i);
/// x of the wheels of all vehicles of the train at t = 0, in m.
std::vector<double> wheels_at_start(const Scene& scene);

/// The greater of the speeds of trains and forces, m/s; 0 without both.
double greatest_speed(const Scene& scene);

/// The speed of what moves where neither a sweep nor a study gives it: of the train, or of the forces beside a train
/// that stands, m/s.
double moving_speed(const Scene& scene);
/// Sets the speed (m/s) of one run of a sweep or study. What stands, with the speed 0, remains at rest, and courses
/// keep their own speeds.
void set_speed(Scene& scene, double speed);

/// Whether a program has given a wheel or a contact of bodies a law of its own (contact::LawKind::other).
bool has_own_contact_law(const Scene& scene);

/// The shortest wavelength of the track or of an out-of-round wheel, m; infinite if all are smooth.
double shortest_wave(const Scene& scene);

/// Reads and checks all options and the vehicle files they name. Throws InputError with one line.
Scene read_scene(options::Options options);
/// The scene of the options in force, which the last call of put_into_petsc has set.
Scene read_scene();
/// The varied options of a study with their values in one run, as texts.
std::vector<std::pair<std::string, std::string>> values_of_run(const Study& study, std::size_t run);
/// The scene of a study with these values, given as texts, of some of its options; it is a sweep of a single run.
Scene read_scene_of_study(const options::Options& given,
                          const std::vector<std::pair<std::string, std::string>>& values);
/// Those of these given options whose values no study varies.
std::vector<std::string> not_varied(options::Options given, const std::vector<std::string>& names);
/// The scene of a fit with these values of its parameters: its run, or its natural modes.
Scene read_scene_of_fit(const options::Options& given, const options::Fit& fit, const std::vector<double>& values,
                        bool modes);

}  // namespace traverse::scene
