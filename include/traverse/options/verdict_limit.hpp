// Limits that users set for the results of a run, and the quantities that can have a limit.
#pragma once

#include <string>
#include <string_view>

namespace traverse::options {

/// A limit is satisfied if `factor` times the computed quantity does not exceed `value`.
struct VerdictLimit {
  std::string clause;    // the source, e.g. "EN 1990 A2.4.4.2.1"
  std::string quantity;  // one of limit_quantities
  double value = 0.0;    // in the unit of its quantity
  std::string text;      // the user's description
  double factor = 1.0;   // of effects that the computation neglects, such as track defects by EN 1991-2 6.4.6.4
};

/// The computation that evaluates a quantity: a transient run, the static effects of EN 1991-2, or scene_analysis rail.
enum class LimitFinder { run, norm, rail };

struct LimitQuantity {
  std::string_view name;  // name that the user writes
  std::string_view unit;  // "1" for a ratio
  std::string_view words;
  LimitFinder finder = LimitFinder::run;
};

/// src/run/limit_check.cpp evaluates each of them for a run.
inline constexpr LimitQuantity limit_quantities[] = {
    {"deck_acceleration", "m/s2", "largest low-passed vertical acceleration at the probes (output_lowpass)"},
    {"unfiltered_deck_acceleration", "m/s2", "largest unfiltered vertical acceleration at the probes"},
    {"deflection_over_span", "1", "largest deflection at a probe over the length of its span"},
    {"end_rotation", "rad", "largest rotation of the deck at either end of the bridge"},
    {"joint_rotation", "rad", "largest difference of the rotations on the two sides of a joint between two decks"},
    {"track_twist", "m", "largest twist of a track of 1.435 m over 3 m, by its rate along the bridge at the probes"},
    {"bearing_uplift", "N",
     "largest force by which a bearing would have to hold the bridge down (support_bearing_spacing)"},
    {"car_acceleration", "m/s2", "largest vertical acceleration of the heaviest body of a vehicle, at its centre"},
    {"wheel_unloading", "1", "largest lost fraction of a wheel's initial force"},
    {"filtered_wheel_unloading", "1",
     "largest lost fraction of a wheel's initial force, low-passed (output_wheel_lowpass)"},
    {"unloading_time", "s",
     "longest time in which the lost fraction of a wheel's low-passed force exceeds output_unloading_level"},
    {"contact_loss", "s", "longest time in which a wheel has no contact with the track"},
    {"amplification", "1", "largest deflection over the largest static deflection at its probe"},
    {"lm71_deflection_over_span", "1", "static deflection under LM71 times alpha and Phi over the length of its span",
     LimitFinder::norm},
    {"lm71_end_rotation", "rad", "static rotation of the deck at the bridge's ends under LM71 times alpha and Phi",
     LimitFinder::norm},
    {"lm71_joint_rotation", "rad",
     "difference of static rotations of two decks at a joint under LM71 times alpha and Phi", LimitFinder::norm},
    {"lm71_track_twist", "m", "static twist of a track of 1.435 m over 3 m under LM71 times alpha and Phi",
     LimitFinder::norm},
    {"train_over_lm71", "1", "dynamic effect of the trains over Phi times LM71, EN 1991-2 6.4.6.5", LimitFinder::norm},
    {"rail_tension", "Pa", "largest additional tension of the rails along x (track_rail_area)", LimitFinder::rail},
    {"rail_compression", "Pa", "largest additional compression of the rails along x (track_rail_area)",
     LimitFinder::rail},
    {"rail_slip", "m", "largest displacement of the rail relative to the deck or the ground under braking or traction",
     LimitFinder::rail},
    {"deck_displacement", "m", "largest displacement of a deck end along x under braking or traction",
     LimitFinder::rail},
    {"deck_end_displacement", "m", "largest displacement of the top of a deck end along x from bending of the deck",
     LimitFinder::rail},
    {"rail_device_opening", "m", "largest opening or closing of a rail expansion device since the rail was laid",
     LimitFinder::rail},
};

/// The row of a name; null for an unknown name.
constexpr const LimitQuantity* limit_quantity(std::string_view name) {
  for (const LimitQuantity& row : limit_quantities)
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace traverse::options
