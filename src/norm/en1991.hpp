// EN 1991-2, clauses 6.3 and 6.4: the formulas of static and dynamic effects of trains on bridges, each with its
// clause. Whoever has the norm checks and changes them here. Lengths in m, frequencies in Hz, speeds in m/s.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {

/// 6.4.5.3, table 6.2, case 5.2: of a run of continuous spans k times their mean, k = 1.2 to 1.5 of 2 to 5 and more
/// spans, at least the longest of them.
double determinant_length(std::span<const double> spans);
/// Of each span of a bridge: of the run of spans without a joint between two decks that it belongs to.
std::vector<double> determinant_lengths(const beam::BeamModel& model);

/// 6.4.5.2 (6.4): of carefully maintained track, from 1 to 1.67.
double phi2(double length);
/// 6.4.5.2 (6.5): of track with standard maintenance, from 1 to 2.
double phi3(double length);

/// Annex C (C.3) to (C.5): of a bridge with the first frequency of bending n0 at the speed v.
double phi_of_speed(double v, double length, double n0);
/// Annex C (C.6) to (C.8): of irregularities of the track.
double phi_of_track(double v, double length, double n0);

/// 6.4.4, figure 6.10: between which first frequencies phi' and phi'' hold; none outside 4 to 100 m.
std::optional<std::pair<double, double>> frequency_bounds(double length);

/// 6.4.6.3.1, table 6.6: the lower bound of the damping ratio over the span length.
double least_damping(options::BridgeMaterial material, double span);
/// 6.4.6.4: what vehicles add to it on spans below 30 m.
double additional_damping(double span);

}  // namespace traverse::norm
