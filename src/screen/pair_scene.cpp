// The scene of one pair as an options file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "screen/pair.hpp"
#include "screen/screen.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

constexpr int parts_of_span =
    100;  // between probes: a peak between two of them is at most 0.1 % larger for three modes

template <class Thing>
const Thing& find(const std::vector<Thing>& things, const std::string& name, const char* what) {
  const auto found = std::find_if(things.begin(), things.end(), [&](const Thing& thing) { return thing.name == name; });
  if (found == things.end()) throw InputError(fmt::format("screen_pair: there is no {} '{}'", what, name));
  return *found;
}

std::string bridge_text(const options::Screen& screen, const Bridge& bridge) {
  const BridgeModel model(bridge, screen.modes, screen.parts, screen.speeds, screen.samples);
  const std::string torsion = bridge.eccentricity == 0.0
                                  ? ""
                                  : fmt::format("  GJ: {}\n  polar_inertia: {}\ntrack:\n  eccentricity: {}\n",
                                                bridge.GJ, bridge.polar_inertia, bridge.eccentricity);
  return fmt::format("beam:\n  spans: [{}]\n  EI: {}\n  mass: {}\n{}model:\n  modes: {}\n  damping_ratios: {}\n",
                     fmt::join(bridge.spans, ", "), bridge.EI, bridge.mass, torsion, model.modes().size(),
                     bridge.damping);
}

/// The sweep of the formation's forces, with many probes, because a screen finds peaks at any place.
std::string forces_text(const options::Screen& screen, const Bridge& bridge, const Formation& formation) {
  const double fastest = std::min(formation.speed, bridge.speed) * (1.0 + 1e-9);
  const double step = screen.speeds.size() > 1 ? screen.speeds[1] - screen.speeds[0] : screen.speeds[0];
  double last = screen.speeds.front(), start = 0.0;
  for (const double speed : screen.speeds)
    if (speed <= fastest) last = speed;
  std::vector<double> positions, probes;
  for (const double distance : formation.distance) positions.push_back(0.0 - distance);
  for (const double span : bridge.spans) {
    for (int part = 1; part < parts_of_span; ++part) probes.push_back(start + span * part / parts_of_span);
    start += span;
  }
  return fmt::format(
      "load:\n  forces: [{}]\n  positions: [{}]\nsweep:\n  speed: [{}, {}, {}]\noutput:\n  probes: [{}]\n"
      "  lowpass: none\nscene:\n  tail: 1.0\n",
      fmt::join(formation.loads, ", "), fmt::join(positions, ", "), screen.speeds.front(), last, step,
      fmt::join(probes, ", "));
}

/// The vehicles of an options file on a rough track, at the permitted speed of the formation or at the lowest one.
std::string vehicles_text(const options::Screen& screen, const Bridge& bridge, const Formation& formation) {
  const BridgeModel model(bridge, screen.modes, screen.parts, screen.speeds, screen.samples);
  const double permitted = Pairs(model).judge(formation).permitted;
  return fmt::format(
      "train:\n  speed: {}\n  positions: -120.0\ntrack_profile: german_low\ntrack_wavelengths: [2.0, 80.0]\n",
      permitted > 0.0 ? permitted : screen.speeds.front());
}

}  // namespace

std::string pair_scene(const Problem& problem) {
  const options::Screen& screen = *problem.scene.screen;
  const Bridge& bridge = find(problem.stock, screen.pair[0], "bridge");
  const Formation& formation = find(problem.fleet, screen.pair[1], "formation");
  const bool vehicles = screen.pair.size() == 3;
  const std::string head = fmt::format(
      "# What: {} over {}, {}.\n# Source: {} and {}.\n# Expected: {}\n", printable(formation.name),
      printable(bridge.name),
      vehicles ? "vehicles on a rough track at the permitted speed" : "moving forces at all speeds",
      printable(screen.fleet), printable(screen.stock),
      vehicles ? "accelerations that the moving forces of a screen do not have." : "the peaks of the screen.");
  return vehicles ? head + fmt::format("options_file: {}\n", printable(screen.pair[2])) + bridge_text(screen, bridge) +
                        vehicles_text(screen, bridge, formation)
                  : head + bridge_text(screen, bridge) + forces_text(screen, bridge, formation);
}

}  // namespace traverse::screen
