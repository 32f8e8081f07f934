// Compares each bridge and each formation with usual ranges.
#include "screen/unusual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"
#include "screen/beam_modes.hpp"

namespace traverse::screen {
namespace {

constexpr double lightest_train = 45e3;  // N: the heaviest axle of any train is heavier

/// Findings of one kind.
class Finding {
 public:
  void add(const std::string& name, const std::string& line) {
    if (line.empty()) return;
    if (count_++ == 0) first_ = name + ": " + line;
  }
  void write(const char* others, std::vector<std::string>& lines) const {
    if (count_ > 0)
      lines.push_back(count_ == 1 ? first_ : fmt::format("{} (and {} more {})", first_, count_ - 1, others));
  }

 private:
  std::size_t count_ = 0;
  std::string first_;
};

std::string unusual_load(const Formation& formation) {
  const double heaviest = *std::max_element(formation.loads.begin(), formation.loads.end());
  if (heaviest > norm::heaviest_axle * norm::earth)
    return fmt::format("{:.4g} kN, {:.3g} t, on one axle; the heaviest on rails carry 40 t", 1e-3 * heaviest,
                       1e-3 * heaviest / norm::earth);
  if (heaviest < lightest_train)
    return fmt::format(
        "its heaviest axle has {:.3g} kN, less than that of any train; its loads are possibly given in "
        "another unit than the name of their column",
        1e-3 * heaviest);
  return "";
}

std::string unusual_speed(double speed) { return std::isfinite(speed) ? norm::unusual_speed("speed", speed) : ""; }

}  // namespace

std::vector<std::string> unusual_in(const Problem& problem) {
  Finding units, frequencies, masses, damping, bridge_speeds, loads, speeds;
  for (const Bridge& bridge : problem.stock) {
    const std::string frequency =
        norm::unusual_frequency(first_frequency(bridge), norm::determinant_length(bridge.spans), "EI", "mass");
    (frequency.find("possibly") == frequency.npos ? frequencies : units).add(bridge.name, frequency);
    const double shortest = *std::min_element(bridge.spans.begin(), bridge.spans.end());
    masses.add(bridge.name, norm::unusual_bridge_mass(bridge.mass, shortest, "mass"));
    damping.add(bridge.name, norm::unusual_damping(bridge.damping));
    bridge_speeds.add(bridge.name, unusual_speed(bridge.speed));
  }
  for (const Formation& formation : problem.fleet) {
    loads.add(formation.name, unusual_load(formation));
    speeds.add(formation.name, unusual_speed(formation.speed));
  }
  std::vector<std::string> lines;
  if (std::string line = norm::unusual_speed("screen_speeds", problem.scene.screen->speeds.back()); !line.empty())
    lines.push_back(std::move(line));
  for (const Finding* finding : {&units, &frequencies, &masses, &damping, &bridge_speeds})
    finding->write("bridges", lines);
  for (const Finding* finding : {&loads, &speeds}) finding->write("formations", lines);
  return lines;
}

}  // namespace traverse::screen
