// A sweep's table as /sweep has it, by trains and speeds, and as the terminal shows it.
#pragma once

#include <vector>

#include "results/study_table.hpp"

namespace traverse::results {

inline constexpr const char* speed_of_sweep = "speed";  // its dimension
/// The study that a sweep is: its axes are trains and speeds (m/s). trains: numbers of HSLM-A; empty: one train,
/// whatever it is.
options::Study sweep_study(const std::vector<int>& trains, std::vector<double> speeds);
/// A run's train and speed, by their indices, and how many there are.
std::size_t trains_of(const options::Study& sweep);
const std::vector<double>& speeds_of_sweep(const options::Study& sweep);
/// "A3"; empty where the trains have no names.
std::string train_name(const options::Study& sweep, std::size_t train);

/// Datasets [trains, speeds] or [trains, speeds, probes] under /sweep; NaN where a run has not ended. promises: the
/// runs' errors are promised, but for those that have met what no trial run has seen.
std::vector<Recorder::Dataset> sweep_datasets(const StudyTable& table, bool estimates);
/// Peaks of each train over all speeds and probes, each with its own speed and probe, and the amplification of the
/// largest deflection beside it.
void print_sweep(const StudyTable& table);

}  // namespace traverse::results
