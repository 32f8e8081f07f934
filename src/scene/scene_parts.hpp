// The readers that read_scene is made of: each fills its part of the scene and checks it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// A block of options that describes a train or a load, with the vehicles of the former.
struct Block {
  std::string name;                   // "train", "load" or as trains and loads name it
  std::vector<std::string> vehicles;  // front one first
  std::string option(std::string_view word) const { return name + "_" + std::string(word); }
};

struct NamedVehicles {
  std::vector<std::string> train;   // of all trains, front one first
  std::vector<Block> trains;        // one a train
  std::vector<std::string> unused;  // defined, and in no train
};

/// Finds the vehicles of a scene, reads their files and makes the options of their parts known.
NamedVehicles declare_vehicles(options::Options& options);
Vehicle read_vehicle(const options::Options& options, const std::string& name);

/// Makes the options of the trains and loads that `trains` and `loads` name known.
void declare_blocks(options::Options& options);
/// The blocks of `trains` or of `loads`; train or load alone where none are named.
std::vector<Block> blocks_of(const options::Options& options, const char* list);
/// Where a block's speed or speed_file leads: 1 to the right, -1 to the left.
double direction_of(const options::Options& options, const Block& block);
/// x where something that runs in this direction enters the bridge, m.
double entrance(const Scene& scene, double direction);
/// The law of a block's speed_file for something whose first wheel or force is at `front` at t = 0.
base::SpeedLaw read_speed_file(const options::Options& options, const Block& block, double front);
/// Whether the runs of block after block need courses: several of them, or a speed that changes or is below 0.
bool needs_courses(const options::Options& options, const std::vector<Block>& blocks);
/// Whether there are several trains or loads, or a train and a load of which one has a course.
bool several_courses(const Scene& scene);
/// Notes what runs where there are courses, and refuses what does not go with them.
void check_courses(const options::Options& options, Scene& scene);

/// Makes the options of the trains' couplers known.
void declare_couplers(options::Options& options);
/// Makes the options of a layered track's stretches known.
void declare_stretches(options::Options& options);
/// Bodies are not yet looked for.
Coupler read_coupler(const options::Options& options, const Block& train, const std::string& name);

void read_beam(const options::Options& options, Scene& scene);  // beam, supports, damping
/// A bridge by given modes; false where the scene names none.
bool read_given_bridge(const options::Options& options, Scene& scene);
/// How many of these, and what they cannot be asked for: last, in place of read_modal.
void read_modes_of_given(const options::Options& options, Scene& scene);
/// Of a beam whose spans and joints are known.
beam::Foundation read_foundation(const options::Options& options, const beam::BeamModel& beam);
/// x, or the end of a span that it is but for rounding; of a beam whose spans are known.
double as_division(const beam::BeamModel& beam, double x);
/// Cracks as springs, or as stretches of less EI; of a beam whose EI is known.
void read_cracks(const options::Options& options, beam::BeamModel& beam);
/// Supports that yield or have settled; of a beam whose supports and foundation are known.
void read_bearings(const options::Options& options, beam::BeamModel& beam);
std::optional<beam::Temperature> read_temperature(const options::Options& options);
/// A number or a file of x,value, inside the range of its row.
beam::Distribution read_distribution(const options::Options& options, const std::string& name);
void read_trains(const options::Options& options, const NamedVehicles& vehicles, Scene& scene);
void read_load(const options::Options& options, Scene& scene);
void read_sweep(const options::Options& options, Scene& scene);  // before train and load: it may give their speed
inline constexpr std::size_t fewest_to_refine = 3;               // speeds, between which others can be added
/// The speeds of sweep_speed, which is given.
std::vector<double> read_speeds(const options::Options& options);
bool asks_for_study(const options::Options& options);
/// The scene of a study's first run, with the study.
Scene read_study(const options::Options& options);
/// The option that says which forces of a load move, of which one may be given; empty: none.
std::string load_option(const options::Options& options, const std::string& load = "load");
/// Whether any forces move.
bool forces_move(const options::Options& options);
void read_modal(const options::Options& options, Scene& scene);  // last: it depends on what moves
void read_track(const options::Options& options, Scene& scene);  // after train: the roughness begins before it
/// The profile of the options with this prefix, "track" or a train's; roughness begins at `start`.
struct ReadProfile {
  track::Profile profile;
  std::optional<Roughness> roughness;
};
ReadProfile read_profile(const options::Options& options, const std::string& prefix, double start, bool to_the_left,
                         Scene& scene);
void read_layers(const options::Options& options, Scene& scene);  // after train and load: the track is as long
void read_output(const options::Options& options, Scene& scene);  // after layers and limits
/// In sweeps and studies, whose runs filter deck accelerations where limits ask for it alone, and have no peaks of
/// shear and axial forces.
void promise_what_many_runs_find(Scene& scene);
void decide_axial(const options::Options& options, Scene& scene);        // after beam and train
void read_damping_bound(const options::Options& options, Scene& scene);  // after modal
void read_norm(const options::Options& options, Scene& scene);           // after beam and output, whose limits it reads
void read_rail_loads(const options::Options& options, Scene& scene);     // after the track
/// Refuses what can run but cannot be meant, notes what is possible but unusual. Last.
void check_sense(const options::Options& options, const NamedVehicles& vehicles, Scene& scene);

}  // namespace traverse::app
