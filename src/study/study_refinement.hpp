// Speeds that a study or a sweep adds by itself near its peaks.
#pragma once

#include <vector>

#include "results/study_table.hpp"
#include "study/speed_refinement.hpp"

namespace traverse::app {

/// Of every combination of the options that neither are speeds nor have statistics over them: the peaks at the worst
/// probe, the greatest wheel force and what limits are of, the greatest of what statistics go over. At the speeds in
/// ascending order. For a study whose speeds are refined.
std::vector<SpeedCurve> curves_of(const results::StudyTable& table);

/// Those of the limited quantities that are kept at all speeds so far, each with its limit.
std::vector<LimitedCurve> curves_in_doubt(const results::StudyTable& table);

/// The next speeds of a table's study, until the peaks over the speed are known to `refine` of it or, where that is
/// below 0, no limit may be broken between two speeds. width: of a resonance, as refine_for_limits has it.
Refinement next_speeds(const results::StudyTable& table, double width);

/// The study with these speeds (m/s) as well, all in ascending order.
options::Study with_speeds(options::Study study, const std::vector<double>& added);

/// The speeds of a study, ascending.
std::vector<double> speeds_of(const options::Study& study);

}  // namespace traverse::app
