// What scene_analysis may ask for. How each is carried out stands in src/app/analyses.hpp.
#pragma once

#include <string_view>

namespace traverse::options {

enum class Analysis { transient, modes, static_response, static_envelope, rail_forces };

struct AnalysisRow {
  Analysis analysis;
  std::string_view name;   // as the user writes it
  std::string_view words;  // for -help
};

/// The default first.
inline constexpr AnalysisRow analyses[] = {
    {Analysis::transient, "transient", "the motion in time"},
    {Analysis::modes, "modes", "natural frequencies and shapes"},
    {Analysis::static_response, "static", "rest where the loads stand at t = 0"},
    {Analysis::static_envelope, "envelope", "the largest static effects of the loads, wherever they stand"},
    {Analysis::rail_forces, "rail",
     "rail and bridge together at rest under temperature, braking and a train's weight, UIC 774-3"},
};

/// Of a name in the list; the default otherwise.
constexpr Analysis analysis_of(std::string_view name) {
  for (const AnalysisRow& row : analyses)
    if (row.name == name) return row.analysis;
  return analyses[0].analysis;
}

}  // namespace traverse::options
