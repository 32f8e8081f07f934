// The analyses of the option scene_analysis, and the options of rail loads and of a screen. src/app/analyses.hpp has
// the function of each analysis.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

enum class Analysis { transient, modes, static_response, static_envelope, rail_forces, screen };

struct AnalysisRow {
  Analysis analysis;
  std::string_view name;   // name that the user writes
  std::string_view words;  // for -help
};

/// The first row is the default.
inline constexpr AnalysisRow analyses[] = {
    {Analysis::transient, "transient", "response over time"},
    {Analysis::modes, "modes", "natural frequencies and mode shapes"},
    {Analysis::static_response, "static", "static equilibrium under the loads at t = 0"},
    {Analysis::static_envelope, "envelope", "largest static effects over all positions of the loads"},
    {Analysis::rail_forces, "rail",
     "track-bridge interaction under temperature, braking and the weight of a train, UIC 774-3"},
    {Analysis::screen, "screen", "verdicts on every formation of a fleet over every bridge of a stock"},
};

/// The analysis of a name in the list, the default for any other name.
constexpr Analysis analysis_of(std::string_view name) {
  for (const AnalysisRow& row : analyses)
    if (row.name == name) return row.analysis;
  return analyses[0].analysis;
}

/// The directions in which trains pass.
enum class Runs { to_the_right, to_the_left, both_ways };

/// The options of the loads of UIC 774-3: the weight, the braking force and the traction of a train.
struct RailLoads {
  double length = 300.0;                         // length of the train, m
  double weight = 8e4;                           // N/m
  double braking = 2e4, most_braking = 6e6;      // N/m, and the greatest force of the train in N
  double traction = 3.3e4, most_traction = 1e6;  // N/m, and the greatest force of the train in N
  std::vector<double> fronts;  // positions of the train's front, m, from the bridge end at which the train enters
  Runs runs = Runs::to_the_right;
  double rail_area = 0.0;  // area of both rails, m2
};

/// The options of a screen: every formation of a fleet over every bridge of a stock.
struct Screen {
  std::string stock, fleet;    // paths of the table of bridges, and of the table or folder of formations
  std::vector<double> speeds;  // m/s, ascending, with equal steps
  int modes = 3;               // of each bridge
  int parts = 10;              // of each span, between the stations
  double samples = 20.0;       // per period of the highest mode
  bool resume = false;         // bridges that are finished in the results file are not computed again
  int audit = 0;               // pairs that are checked by all passages
  /// A bridge and a formation whose scene is printed, and for one with vehicles the options file of the train; empty:
  /// none.
  std::vector<std::string> pair;
};

}  // namespace traverse::options
