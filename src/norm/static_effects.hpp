// Static effects of trains and load models over all their positions: the least and the greatest of every effect along
// the bridge.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "norm/static_bridge.hpp"

namespace traverse::norm {

enum class Effect { deflection, moment, shear, reaction, end_rotation, joint_rotation };
struct EffectRow {
  std::string_view name, words, unit;
};
/// The effects in the order of Effect.
inline constexpr EffectRow effect_rows[] = {
    {"deflection", "deflection", "m"},
    {"moment", "moment", "N m"},
    {"shear", "shear", "N"},
    {"reaction", "reaction", "N"},
    {"end_rotation", "end rotation", "rad"},
    {"joint_rotation", "joint rotation", "rad"},
};
inline constexpr std::size_t effect_count = std::size(effect_rows);

/// Extremes of one load at one place, each with the position of the load's x = 0.
struct Extremes {
  Placed least, greatest;  // signed; `least` is not above 0

  double size() const { return greatest.value > -least.value ? greatest.value : -least.value; }
};

/// A place of the bridge with the length of its span; at a support the length of the shorter span.
struct Place {
  double x = 0.0, span = 0.0;  // m
  std::size_t number = 0;      // index of the span
};

struct StaticEffects {
  static constexpr double tie_factor = 1.0 + 1e-9;

  std::vector<LoadModel> loads;
  std::array<std::vector<Place>, effect_count> places;
  std::array<std::vector<Extremes>, effect_count> values;  // [load][place]

  const Extremes& at(Effect effect, std::size_t load, std::size_t place) const {
    const auto e = static_cast<std::size_t>(effect);
    return values[e][load * places[e].size() + place];
  }
  /// The first place with the largest magnitude times weight(place).
  template <class Weight>
  std::size_t worst(Effect effect, std::size_t load, Weight weight) const {
    const auto& all = places[static_cast<std::size_t>(effect)];
    std::size_t best = 0;
    double most = -1.0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (const double one = at(effect, load, i).size() * weight(all[i]); one > most * tie_factor) {
        most = one;
        best = i;
      }
    return best;
  }
};

/// Evaluates the effects at stations at most `spacing` m apart in each span (0: at its twentieths), at the given
/// stations, and on both sides of each support at a distance of a millionth of the span.
StaticEffects static_effects(StaticBridge& bridge, std::vector<LoadModel> loads, double spacing,
                             const std::vector<double>& given_stations);

}  // namespace traverse::norm
