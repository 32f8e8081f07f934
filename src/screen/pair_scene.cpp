// The scene of one pair as an options file: a sweep of the formation's forces over the bridge.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "screen/screen.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

template <class Thing>
const Thing& find(const std::vector<Thing>& things, const std::string& name, const char* what) {
  const auto found = std::find_if(things.begin(), things.end(), [&](const Thing& thing) { return thing.name == name; });
  if (found == things.end()) throw InputError(fmt::format("screen_pair: there is no {} '{}'", what, name));
  return *found;
}

}  // namespace

std::string pair_scene(const Problem& problem, const std::string& bridge_name, const std::string& formation_name) {
  const Bridge& bridge = find(problem.stock, bridge_name, "bridge");
  const Formation& formation = find(problem.fleet, formation_name, "formation");
  const options::Screen& screen = *problem.scene.screen;
  const double fastest = std::min(formation.speed, bridge.speed),
               step = screen.speeds.size() > 1 ? screen.speeds[1] - screen.speeds[0] : screen.speeds[0];
  double last = screen.speeds.front();
  for (const double speed : screen.speeds)
    if (speed <= fastest * (1.0 + 1e-9)) last = speed;
  std::vector<double> positions, probes;
  for (const double distance : formation.distance) positions.push_back(0.0 - distance);
  double start = 0.0;
  for (const double span : bridge.spans) {
    for (int part = 1; part < screen.parts; ++part) probes.push_back(start + span * part / screen.parts);
    start += span;
  }
  return fmt::format(
      "# What: {} over {}, moving forces on {} modes; for vehicles and roughness replace load and sweep by train_ and "
      "track_ options.\n"
      "# Source: {} and {}.\n"
      "# Expected: the response over its limit in the results of the screen.\n"
      "beam:\n  spans: [{}]\n  EI: {}\n  mass: {}\n"
      "model:\n  modes: {}\n  damping_ratios: {}\n"
      "load:\n  forces: [{}]\n  positions: [{}]\n"
      "sweep:\n  speed: [{}, {}, {}]\n"
      "output:\n  probes: [{}]\n  lowpass: none\n"
      "scene:\n  tail: {:.3g}\n",
      formation.name, bridge.name, screen.modes, screen.fleet, screen.stock, fmt::join(bridge.spans, ", "), bridge.EI,
      bridge.mass, screen.modes, bridge.damping, fmt::join(formation.loads, ", "), fmt::join(positions, ", "),
      screen.speeds.front(), last, step, fmt::join(probes, ", "), 1.0);
}

}  // namespace traverse::screen
