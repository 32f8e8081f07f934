// Writes the options of N four-bar linkages: rods, pins and initial velocities.
#include "support/four_bars.hpp"

namespace traverse::test {
namespace {

/// "name0, name1, ..." with a count.
std::string names(const std::string& name, int count) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i == 0 ? "" : ", ") + name + std::to_string(i);
  return list;
}

std::string pin(const std::string& name, const std::string& bodies, int x, int y) {
  return name + ": {type: revolute, bodies: [" + bodies + "], point: [" + std::to_string(x) + ", " + std::to_string(y) +
         "]}\n";
}

}  // namespace

// The crank's centre of mass moves at 0.5 m/s, turning at -1 rad/s; couplers do not turn.
std::string four_bars(int n) {
  const std::string rod = "{mass: 1.0, inertia: 0.083333333333333333, position: [";
  std::string out = "bodies: [" + names("crank", n + 1) + ", " + names("coupler", n) + "]\n";
  out += "joints: [" + names("a", n + 1) + ", " + names("b", n) + ", " + names("c", n) + "]\n";
  for (int i = 0; i <= n; ++i)
    out += "crank" + std::to_string(i) + ": " + rod + std::to_string(i) +
           ".0, 0.5], angle: 1.5707963267948966, velocity: [0.5, 0.0, -1.0]}\n";
  for (int i = 0; i < n; ++i)
    out += "coupler" + std::to_string(i) + ": " + rod + std::to_string(i) + ".5, 1.0], velocity: [1.0, 0.0, 0.0]}\n";
  for (int i = 0; i <= n; ++i) out += pin("a" + std::to_string(i), "ground, crank" + std::to_string(i), i, 0);
  for (int i = 0; i < n; ++i) {
    const std::string coupler = "coupler" + std::to_string(i);
    out += pin("b" + std::to_string(i), "crank" + std::to_string(i) + ", " + coupler, i, 1);
    out += pin("c" + std::to_string(i), coupler + ", crank" + std::to_string(i + 1), i + 1, 1);
  }
  return out;
}

}  // namespace traverse::test
