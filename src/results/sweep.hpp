// The table of a sweep by trains and speeds, for /sweep and for the terminal.
#pragma once

#include <vector>

#include "results/study_table.hpp"

namespace traverse::results {

inline constexpr const char* speed_of_sweep = "speed";  // name of its dimension
/// The study of a sweep: its axes are trains and speeds (m/s). trains: numbers of HSLM-A; empty: a single train.
options::Study sweep_study(const std::vector<int>& trains, std::vector<double> speeds);
/// The numbers of trains, and the speeds.
std::size_t trains_of(const options::Study& sweep);
const std::vector<double>& speeds_of_sweep(const options::Study& sweep);
/// "A3"; empty if the trains have no names.
std::string train_name(const options::Study& sweep, std::size_t train);

/// Datasets [trains, speeds] or [trains, speeds, probes] under /sweep; NaN if a run has not ended. estimates: the runs
/// have error estimates, except for those with events that no trial run covered.
std::vector<Recorder::Dataset> sweep_datasets(const StudyTable& table, bool estimates);
/// Prints the peaks of each train over all speeds and probes, each with its speed and probe, and the amplification at
/// the largest deflection.
void print_sweep(const StudyTable& table);

}  // namespace traverse::results
