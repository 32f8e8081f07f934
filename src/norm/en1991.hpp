// EN 1991-2, clauses 6.3 and 6.4: the load models, static loads that represent rail traffic, and the formulas of static
// and dynamic effects of trains on bridges, each with its clause. Lengths in m, frequencies in Hz, speeds in m/s. Also
// usual ranges of the numbers of bridges and trains, and which unit a number outside may have been given in: each of
// these functions returns a sentence about an unusual number, or an empty text.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "norm/influence_line.hpp"
#include "traverse/beam/model.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {

/// The load model of a row of options::load_models. Characteristic values, without alpha and Phi. InputError for any
/// other name.
LoadModel load_model(std::string_view name);

/// A train of forces (N, downward) at x, m.
LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x);

/// 6.4.5.3, table 6.2, case 5.2: for continuous spans k times their mean, k = 1.2 to 1.5 for 2 to 5 and more spans, at
/// least the longest span.
double determinant_length(std::span<const double> spans);
/// The value for each span of a bridge, from its group of spans without a joint between two decks.
std::vector<double> determinant_lengths(const beam::BeamModel& model);

/// 6.4.5.2 (6.4): Phi_2 for carefully maintained track, from 1 to 1.67.
double phi2(double length);
/// 6.4.5.2 (6.5): Phi_3 for track with standard maintenance, from 1 to 2.
double phi3(double length);

/// Annex C (C.3) to (C.5): phi' of a bridge with the first bending frequency n0 at the speed v.
double phi_of_speed(double v, double length, double n0);
/// Annex C (C.6) to (C.8): phi'' for irregularities of the track.
double phi_of_track(double v, double length, double n0);

/// 6.4.4, figure 6.10: the range of first frequencies for which phi' and phi'' are valid; empty outside 4 to 100 m.
std::optional<std::pair<double, double>> frequency_bounds(double length);

/// 6.4.6.3.1, table 6.6: the lower bound of the damping ratio for the span length.
double least_damping(options::BridgeMaterial material, double span);
/// 6.4.6.4: the additional damping by vehicles on spans below 30 m.
double additional_damping(double span);

inline constexpr double earth = 9.81;            // m/s2
inline constexpr double fast_speed = 128.0;      // m/s: 1.2 times a line speed of 384 km/h
inline constexpr double min_bridge_span = 4.0;   // m: shortest span of a bridge
inline constexpr double lightest_bridge = 50.0;  // kg/m, of a bridge
inline constexpr double heaviest_axle = 40e3;    // kg, on rails

/// The first frequency, Hz, of a bridge with this determinant length, m, compared with EN 1991-2, figure 6.10. EI and
/// mass: what the input calls them.
std::string unusual_frequency(double n0, double length, const char* EI, const char* mass);
/// The mass of a bridge, kg/m, whose shortest span has this length, m. mass: what the input calls it.
std::string unusual_bridge_mass(double value, double span, const char* mass);
/// A damping ratio of a bridge.
std::string unusual_damping(double ratio);
/// A speed in m/s. what: what has it.
std::string unusual_speed(const std::string& what, double speed);
/// Whether a load is so light that it is rather a number of kN or t than of N: less than the heaviest axle in kN.
bool is_possibly_in_kilonewtons(double force);

}  // namespace traverse::norm
