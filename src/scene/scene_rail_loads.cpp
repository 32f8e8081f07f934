// Reads the loads of UIC 774-3 for the track-bridge interaction.
#include <fmt/format.h>

#include <cmath>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;
using options::RailLoads;

constexpr double most_fronts = 1e4;
constexpr double behind_the_bridge = 90.0, step_of_fronts = 10.0;  // m

/// The positions of the train's front, from the given first, last and step or from the length of the bridge.
std::vector<double> read_fronts(const Options& o, double length) {
  std::vector<double> given = {0.0, length + behind_the_bridge, step_of_fronts};
  if (o.has("uic774_fronts")) given = o.numbers("uic774_fronts");
  const double steps = (given[1] - given[0]) / given[2];
  if (!(given[2] > 0.0) || !(steps >= 0.0) || steps > most_fronts)
    o.refuse(
        "uic774_fronts",
        fmt::format("allowed: first, last, step, with last not below first and at most {:g} positions", most_fronts));
  std::vector<double> fronts;
  for (int i = 0; i <= std::floor(steps + 1e-9); ++i) fronts.push_back(given[0] + i * given[2]);
  return fronts;
}

}  // namespace

void read_rail_loads(const Options& o, Scene& scene) {
  if (scene.analysis != Analysis::rail_forces) {
    if (const options::Entry* entry = o.first_with_prefix("uic774_"))
      scene.notes.push_back(entry->name + " has no effect: it belongs to scene_analysis rail");
    return;
  }
  if (!scene.beam || !scene.beam->track)
    o.refuse("scene_analysis", "rail needs a bridge with a layered track (beam_spans, track_rail_EI)");
  if (!scene.beam->axial) o.refuse("scene_analysis", "rail needs beam_EA, track_rail_EA and track_longitudinal_k");
  if (!o.has("track_rail_area")) o.refuse("scene_analysis", "rail needs track_rail_area, for the stress of the rails");
  if (!scene.vehicles.empty() || !scene.load.forces.empty())
    scene.notes.emplace_back(
        "scene_analysis rail: the train is that of uic774_train_length; vehicles and moving "
        "forces have no effect");
  RailLoads loads;
  loads.length = o.number("uic774_train_length");
  loads.weight = o.number("uic774_weight");
  loads.braking = o.number("uic774_braking");
  loads.most_braking = o.number("uic774_most_braking");
  loads.traction = o.number("uic774_traction");
  loads.most_traction = o.number("uic774_most_traction");
  loads.fronts = read_fronts(o, scene.beam->length());
  const std::string direction = o.choice("uic774_direction");
  loads.runs = direction == "left"   ? options::Runs::to_the_left
               : direction == "both" ? options::Runs::both_ways
                                     : options::Runs::to_the_right;
  loads.rail_area = o.number("track_rail_area");
  const beam::RailMesh rail = beam::rail_mesh(*scene.beam);
  const double before = -rail.start, behind = rail.x(rail.elements) - scene.beam->length();
  const double rear = loads.length - loads.fronts.front(), front = loads.fronts.back() - scene.beam->length();
  const double needed = std::max(rear, front);
  if (std::min(before, behind) < needed * (1.0 - 1e-9))
    o.refuse("track_approach",
             fmt::format("the train would extend beyond the modelled track (uic774_train_length, uic774_fronts); "
                         "allowed: at least {:g} m",
                         needed));
  scene.rail_loads = loads;
}

}  // namespace traverse::scene
