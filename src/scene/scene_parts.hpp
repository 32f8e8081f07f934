// The readers that read_scene is made of: each fills its part of the scene and checks it.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct NamedVehicles {
  std::vector<std::string> train;   // front one first
  std::vector<std::string> unused;  // defined, and in no train
};

/// Finds the vehicles of a scene, reads their files and makes the options of their parts known.
NamedVehicles declare_vehicles(options::Options& options);
Vehicle read_vehicle(const options::Options& options, const std::string& name);

/// Makes the options of the train's couplers known.
void declare_couplers(options::Options& options);
/// Makes the options of a layered track's stretches known.
void declare_stretches(options::Options& options);
/// Bodies are not yet looked for.
Coupler read_coupler(const options::Options& options, const std::string& name);

void read_beam(const options::Options& options, Scene& scene);  // beam, supports, damping
/// Of a beam whose spans and joints are known.
beam::Foundation read_foundation(const options::Options& options, const beam::BeamModel& beam);
/// A number or a file of x,value, inside the range of its row.
beam::Distribution read_distribution(const options::Options& options, const std::string& name);
void read_train(const options::Options& options, const std::vector<std::string>& names, Scene& scene);
void read_load(const options::Options& options, Scene& scene);
void read_sweep(const options::Options& options, Scene& scene);  // before train and load: it may give their speed
inline constexpr std::size_t fewest_to_refine = 3;               // speeds, between which others can be added
/// The speeds of sweep_speed, which is given.
std::vector<double> read_speeds(const options::Options& options);
bool asks_for_study(const options::Options& options);
/// The scene of a study's first run, with the study.
Scene read_study(const options::Options& options);
/// The option that says which forces move, of which one may be given; empty: none.
std::string load_option(const options::Options& options);
void read_modal(const options::Options& options, Scene& scene);          // last: it depends on what moves
void read_track(const options::Options& options, Scene& scene);          // after train: the roughness begins before it
void read_layers(const options::Options& options, Scene& scene);         // after train and load: the track is as long
void decide_axial(const options::Options& options, Scene& scene);        // after beam and train
void read_damping_bound(const options::Options& options, Scene& scene);  // after modal
void read_norm(const options::Options& options, Scene& scene);           // after beam and output, whose limits it reads
/// Refuses what can run but cannot be meant, notes what is possible but unusual. Last.
void check_sense(const options::Options& options, const NamedVehicles& vehicles, Scene& scene);

}  // namespace traverse::app
