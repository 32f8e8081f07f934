// The options of EN 1991-2. The formulas are in src/norm/en1991.cpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

/// A load model of EN 1991-2, clause 6.3. src/norm/load_models.cpp has its loads.
struct LoadModelRow {
  std::string_view name;   // name in the option
  std::string_view title;  // name in results: "LM71"
  bool classified;         // the classification factor alpha applies to it, 6.3.2 (3)
  bool compared;           // 6.4.6.5 compares the dynamic effects of trains with it
};

inline constexpr LoadModelRow load_models[] = {
    {"lm71", "LM71", true, true},
    {"sw0", "SW/0", true, true},
    {"sw2", "SW/2", false, false},
};

/// The row of a name in the option; null for any other name.
constexpr const LoadModelRow* load_model_row(std::string_view name) {
  for (const LoadModelRow& row : load_models)
    if (row.name == name) return &row;
  return nullptr;
}

/// The options for the static effects of trains and load models, and for the check of 6.4.6.5.
struct NormRules {
  std::vector<std::string> load_models;  // names of load_models
  double alpha = 1.0;                    // classification factor of LM71 and SW/0, 6.3.2 (3)
  bool careful = false;                  // true: careful maintenance of the track, Phi2; false: Phi3
  std::optional<double> length;          // L_Phi of the whole bridge, m; default: computed from the spans
  double spacing = 0.0;                  // m, distance of sections; 0: a twentieth of each span
  std::optional<double> second_track;    // m, to the left of the shear centre: load models stand on it too
  /// A uniform load that accompanies the train of the scene in its static effects, where it is unfavourable, N/m; and
  /// the range without it, m from the foremost force.
  double lane_load = 0.0, lane_gap_from = 0.0, lane_gap_to = 0.0;
  /// Where the foremost force of the scene's train or forces stands in static effects, m.
  std::optional<std::array<double, 2>> range;
};

enum class BridgeMaterial { steel, composite, prestressed, reinforced, filler_beam };

/// Table 6.6: the lower bound of damping in % for spans of at least 20 m, and the increase per metre below 20 m.
struct DampingBound {
  std::string_view name;  // name in the option
  double long_spans, slope;
};

/// The rows are in the order of BridgeMaterial.
inline constexpr DampingBound damping_bounds[] = {
    {"steel", 0.5, 0.125},     {"composite", 0.5, 0.125},  {"prestressed", 1.0, 0.07},
    {"reinforced", 1.5, 0.07}, {"filler_beam", 1.5, 0.07},
};

}  // namespace traverse::options
