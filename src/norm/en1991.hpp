// EN 1991-2, clauses 6.3 and 6.4: the formulas of static and dynamic effects of trains on bridges, each with its
// clause. Lengths in m, frequencies in Hz, speeds in m/s.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {

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

}  // namespace traverse::norm
