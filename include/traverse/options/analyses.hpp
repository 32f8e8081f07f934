// The analyses of the option scene_analysis. src/app/analyses.hpp has the function of each.
#pragma once

#include <string_view>

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

}  // namespace traverse::options
