// The readers that read_scene calls. Each fills its part of the scene and checks it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "options/parse_number.hpp"
#include "options/read_table.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::scene {

/// A block of options of a train, a load or a track.
struct Block {
  std::string name;                   // "train", "load" or a name from the options trains, loads and tracks
  std::vector<std::string> vehicles;  // vehicles of a train, from the front
  /// The name of an option of this block.
  std::string option(std::string_view word) const { return name + "_" + std::string(word); }
};

/// What `make` returns for the columns of the file that an option names (options::read_columns). The message of an
/// InputError names the option.
template <class Make>
auto from_table(const options::Options& o, const std::string& name, const options::WantedColumns& wanted, Make&& make) {
  try {
    return make(options::read_columns(o, name, wanted));
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with(name)) throw;  // it names the option already
    o.refuse(name, error.what());
  }
}

/// Two columns whose first one must increase.
inline constexpr options::WantedColumns rising_pairs = {2, 2, options::Order::rising};
/// x and height of the running surface, also of the left and the right rail.
inline constexpr options::WantedColumns profile_columns = {2, 2, options::Order::unsorted, {}, true, true};

/// The names of all vehicles.
struct NamedVehicles {
  std::vector<std::string> train;   // vehicles of all trains, from the front
  std::vector<Block> trains;        // one per train
  std::vector<std::string> unused;  // defined, but in no train
};

/// Declares the options of all named parts of a scene: trains and loads, vehicles, couplers, parts of a layered track.
NamedVehicles declare_parts(options::Options& options);
/// Checks the names and values of all options, and the relations between those of a study.
void check_options(const options::Options& options);
/// Finds the vehicles of a scene, reads their files and declares the options of their parts.
NamedVehicles declare_vehicles(options::Options& options);
/// Reads one vehicle.
Vehicle read_vehicle(const options::Options& options, const std::string& name);

/// Declares the options of the trains, loads and tracks that `trains`, `loads` and `tracks` name.
void declare_blocks(options::Options& options);
/// The blocks of `trains`, `loads` or `tracks`; without names the block train or load, but no track.
std::vector<Block> blocks_of(const options::Options& options, const char* list);
/// The track that a train or load names; null if no tracks have names.
const Track* track_of_block(const options::Options& options, const Block& block, const Scene& scene);
/// The number of a track among those of the beam that carry something; it is added if it is new.
int carry(const Track* track, Scene& scene);
int carry(const beam::ActionLine& line, Scene& scene);
/// The option of a block that has a table of its motion, speed_file or position_file; empty without one.
std::string table_of_motion(const options::Options& options, const Block& block);
/// x of the first wheel or force at t = 0 by a block's position_file, m; none without one.
std::optional<double> start_by_table(const options::Options& options, const Block& block);
/// The direction of a block's speed or table of motion: 1 to the right, -1 to the left.
double direction_of(const options::Options& options, const Block& block);
/// Whether the speed 0 is given for a train or load.
bool stands(const options::Options& options, const Block& block);
/// x of the bridge end at which trains in this direction enter, m.
double entrance(const Scene& scene, double direction);
/// The speed law of a block's table of motion for a first wheel or force at `front` at t = 0.
base::SpeedLaw read_motion(const options::Options& options, const Block& block, double front);
/// Whether a load has line loads, moments or a part that varies over time.
bool has_line_loads_or_variation(const options::Options& options, const Block& block);
/// Sets a load that consists of moments only (load_moments). Without given positions the first moment is at `entrance`.
void place_moments(const options::Options& options, const Block& block, double entrance, MovingLoad& load);
/// Adds load_moments to the forces of a load.
void add_moments(const options::Options& options, const Block& block, MovingLoad& load);
/// Appends the line loads of load_distributed.
void add_line_loads(const options::Options& options, const Block& block, MovingLoad& load);
/// load_table and the harmonics of load_frequency; throws InputError with one line.
train::ForceVariation read_variation(const options::Options& options, const Block& block);
/// Whether the blocks need courses: there are several, or one has a variable or negative speed, its own profile, line
/// loads, moments or forces that vary.
bool needs_courses(const options::Options& options, const std::vector<Block>& blocks);
/// Whether there are several courses, or a train and a load of which one has a course.
bool several_courses(const Scene& scene);
/// Adds a note on the courses, and refuses options that are not allowed with them.
void check_courses(const options::Options& options, Scene& scene);

/// Declares the options of the trains' couplers.
void declare_couplers(options::Options& options);
/// Declares the options GROUP_NAME_<row> for each NAME in the list of the option `list`, the names of things that
/// `what` says.
void declare_named(options::Options& options, const std::string& list, const std::string& group,
                   const std::string& what, std::span<const options::Row> rows);
/// Declares the options of the parts of a layered track with different properties (TrackStretch).
void declare_stretches(options::Options& options);
/// Declares the options of the beam's tuned mass dampers (beam::MassDamper).
void declare_dampers(options::Options& options);
/// Reads point masses and mass dampers of a beam whose spans have been read.
void read_masses(const options::Options& options, beam::BeamModel& beam);
/// Reads a coupler of a train, without checking its bodies.
Coupler read_coupler(const options::Options& options, const Block& train, const std::string& name);

/// Reads beam, supports, foundation and damping.
void read_beam(const options::Options& options, Scene& scene);
/// Reads a bridge with given modes; false if the scene has none.
bool read_given_bridge(const options::Options& options, Scene& scene);
/// Reads the number of these modes and refuses results that they do not have. Called instead of read_modal.
void read_modes_of_given(const options::Options& options, Scene& scene);
/// Reads the foundation of a beam whose spans and joints have been read.
beam::Foundation read_foundation(const options::Options& options, const beam::BeamModel& beam);
/// x, or the span end that equals x within rounding. The spans must have been read.
double as_division(const beam::BeamModel& beam, double x);
/// Reads cracks as springs, or as ranges of reduced EI. EI must have been read.
void read_cracks(const options::Options& options, beam::BeamModel& beam);
/// Reads elastic and settled supports. Supports and foundation must have been read.
void read_bearings(const options::Options& options, beam::BeamModel& beam);
/// Reads the motion of the supports, after the modes and the layered track.
void read_support_motion(const options::Options& options, Scene& scene);
/// The temperature of the beam; none without temperature differences.
std::optional<beam::Temperature> read_temperature(const options::Options& options);
/// x, at most the length of the beam but for rounding; InputError for an x of option `name` that is not on the beam.
double place_on_beam(const options::Options& options, const std::string& name, double x, double length);
/// A number or the table of a file x,value, checked for the range of the option.
beam::Distribution read_distribution(const options::Options& options, const std::string& name);
/// Reads the trains with their vehicles, positions and speeds.
void read_trains(const options::Options& options, const NamedVehicles& vehicles, Scene& scene);
/// Reads the moving forces.
void read_load(const options::Options& options, Scene& scene);
/// Reads the options of a sweep, before train and load, because it may set their speed.
void read_sweep(const options::Options& options, Scene& scene);
inline constexpr std::size_t fewest_to_refine = 3;  // least number of speeds between which others can be added
/// The speeds of a given option: from, from + step, ...; InputError if they are none or too many.
std::vector<double> read_speeds(const options::Options& options, std::string_view name);
/// The speeds from, from + step, ...; the last one is `to` if it is a multiple of the step within the tolerance.
std::vector<double> speeds_between(double from, double to, double step);
/// Whether the options describe a study.
bool describes_study(const options::Options& options);
/// The scene of a study's first run, with the study.
Scene read_study(const options::Options& options);
/// The reason why runs cannot have different values of an option; empty if they can.
std::string why_not_varied(const options::Options& options, const std::string& option);
/// The least given damping ratio of the bridge; 0 if none is given.
double least_damping(const Scene& scene);
/// Whether the options ask for values of an option that keep limits (find_option).
bool describes_search(const options::Options& options);
/// The option of a search with the ends of its range.
StudyDimension searched_dimension(const options::Options& options);
/// Reads find_... into a study that has the dimension of the search.
void read_search(const options::Options& options, Study& study);
/// Sets the first values of a search and its condition, by the limits of the scene.
void finish_search(const options::Options& options, Scene& scene);
/// Whether the options describe a fit to measurements.
bool describes_fit(const options::Options& options);
/// The scene at the start of a fit, with the fit.
Scene read_fit(const options::Options& options);
/// The one given option that selects the forces of a load; empty if there is none.
std::string load_option(const options::Options& options, const std::string& load = "load");
/// Whether the file that the option names is a table of formations, not of two columns.
bool has_formations(const options::Options& options, const std::string& option);
/// Whether there are any moving forces.
bool forces_move(const options::Options& options);
/// Reads model_modes and its damping, after trains and loads, on which it depends.
void read_modal(const options::Options& options, Scene& scene);
/// Reads the running surface, after the trains, because the roughness begins at their first wheel.
void read_track(const options::Options& options, Scene& scene);
/// A running surface, with the roughness that it is a sample of, if any.
struct ReadProfile {
  track::Profile profile;
  std::optional<Roughness> roughness;
};
/// The profile of the options with this prefix, "track" or the name of a train. Roughness begins at `start`.
ReadProfile read_profile(const options::Options& options, const std::string& prefix, double start, bool to_the_left,
                         Scene& scene);
/// Reads the layered track, after trains and loads, which set its length.
void read_layers(const options::Options& options, Scene& scene);
/// Reads the options of the results, after layers and limits.
void read_output(const options::Options& options, Scene& scene);
/// Removes from accuracy_of the peaks that the runs of sweeps and studies do not evaluate: shear and axial ones, and
/// low-passed deck accelerations without a limit on them.
void drop_peaks_without_estimate(Scene& scene);
/// Decides whether the beam has axial unknowns, after beam, trains and track.
void decide_axial(const options::Options& options, Scene& scene);
/// Reads the lower bounds of damping of EN 1991-2, after read_modal.
void read_damping_bound(const options::Options& options, Scene& scene);
/// Reads the options of the static effects of EN 1991-2, after beam and limits.
void read_norm(const options::Options& options, Scene& scene);
/// Reads the loads of UIC 774-3, after the track.
void read_rail_loads(const options::Options& options, Scene& scene);
/// Reads the options of a screen, after the limits.
void read_screen(const options::Options& options, Scene& scene);
/// Refuses input that is possible but certainly not intended, and adds notes on unusual input. Called last.
void check_plausibility(const options::Options& options, const NamedVehicles& vehicles, Scene& scene);

}  // namespace traverse::scene
