// The bridge under static vertical loads: its influence lines, each by one solution with a common factorisation, and
// the least and the greatest of every effect along it under trains and load models over all their positions.
//
// The coefficients of the nodal values in a quantity are the nodal forces of a load on the structure. The deflections
// under this load are the influence line of the quantity (Maxwell and Betti). A force on that element has an additional
// direct effect between its nodes, which is added.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "norm/influence_line.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"

namespace traverse::norm {

class StaticBridge {
 public:
  static constexpr std::size_t most_spans = 200;

  /// The bridge with linear foundations, on this rank only, with its own mesh. A layered track contributes its mass
  /// only, and loads act on the bridge. InputError if the beam has no support.
  explicit StaticBridge(const beam::BeamModel& model);
  StaticBridge(const StaticBridge&) = delete;
  StaticBridge& operator=(const StaticBridge&) = delete;

  /// The tracks on which loads move; the lines below are for a load on each of them.
  int tracks() const { return beam_.bridge().tracks(); }
  /// Lines at a station, at this distance to the left of the shear centre (m): deflection (m/N, upward), moment (m,
  /// sagging), shear (1, d moment/dx) and, if the beam twists, the twist of a track over 3 m (m/N).
  using Lines = std::vector<InfluenceLine>;
  std::vector<Lines> lines_at(double x, double eccentricity = 0.0);
  /// A support or a point spring, whose force on the bridge under a unit force is positive upward.
  struct Bearing {
    double x = 0.0;
    int span_end = -1;          // number of a support's span end; -1: a spring
    double stiffness = 0.0;     // stiffness of a spring, N/m
    double eccentricity = 0.0;  // of a spring, m
  };
  const std::vector<Bearing>& bearings() const { return bearings_; }
  std::vector<InfluenceLine> reaction(const Bearing& bearing);
  /// Rotation of the deck at the left or right end of the bridge, 1/N.
  std::vector<InfluenceLine> end_rotation(bool right);
  /// Inner span ends at which the slope may jump, and the difference of the rotations of both sides there, 1/N.
  std::vector<int> joints() const;
  std::vector<InfluenceLine> joint_rotation(int span_end);

  const beam::BeamModel& model() const { return beam_.model(); }
  /// The first bending frequency, Hz.
  double first_frequency() const;

 private:
  std::vector<InfluenceLine> rotation_of(const std::vector<std::pair<int, double>>& form);
  std::vector<InfluenceLine> lines_of(const std::vector<double>& nodal);
  InfluenceLine line_of(const std::vector<double>& nodal, int track, const recovery::Recovery* recovery,
                        double recovery::Response::*direct);

  beam::Beam beam_;
  structure::BeamOperator statics_;
  std::vector<Bearing> bearings_;
};

enum class Effect { deflection, moment, shear, track_twist, reaction, end_rotation, joint_rotation };
struct EffectRow {
  std::string_view name, words, unit;
};
/// The effects in the order of Effect.
inline constexpr EffectRow effect_rows[] = {
    {"deflection", "deflection", "m"},           {"moment", "moment", "N m"},   {"shear", "shear", "N"},
    {"track_twist", "twist over 3 m", "m"},      {"reaction", "reaction", "N"}, {"end_rotation", "end rotation", "rad"},
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

/// Static effects of trains and load models over all their positions: the least and the greatest of every effect along
/// the bridge.
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
