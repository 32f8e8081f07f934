// The numbers of a study, one row a run: in the file under /study and /summary, and as a table on the terminal.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "traverse/options/study.hpp"

namespace traverse::results {

/// What is known of every run.
struct StudyColumn {
  const char* name;  // of its dataset
  const char* unit;
  bool per_probe;   // else one number a run
  bool of_wheels;   // only where there are any
  bool for_people;  // statistics are made of it
};
inline constexpr StudyColumn study_columns[] = {
    {"probes_x", "m", true, false, false},
    {"peak_deflection", "m", true, false, true},
    {"peak_deflection_time", "s", true, false, false},
    {"peak_acceleration", "m/s2", true, false, true},
    {"peak_acceleration_time", "s", true, false, false},
    {"peak_moment", "N m", true, false, true},
    {"peak_moment_time", "s", true, false, false},
    {"static_deflection", "m", true, false, false},
    {"amplification", "1", true, false, true},
    {"least_wheel_force", "N", false, true, true},
    {"greatest_wheel_force", "N", false, true, true},
    {"contact_losses", "1", false, true, false},
    {"longest_loss", "s", false, true, false},
};

class StudyTable {
 public:
  static constexpr double not_run = std::numeric_limits<double>::quiet_NaN();

  StudyTable(const options::Study& study, std::size_t probes, bool wheels);

  const options::Study& study() const { return study_; }
  std::size_t runs() const { return runs_; }
  std::size_t probes() const { return probes_; }
  /// Numbers in a row: those of each column, per probe or one, in the columns' order.
  std::size_t width() const { return width_; }
  void put(std::size_t run, const double* row);
  bool finished(std::size_t run) const { return finished_[run] != 0.0; }
  std::size_t finished_runs() const;

  struct Column {
    const StudyColumn* what;
    std::size_t width;           // numbers a run
    std::vector<double> values;  // [runs, width], not_run where a run has not ended
  };
  const std::vector<Column>& columns() const { return columns_; }
  /// A column by its name; null where it is not there.
  const Column* find(const std::string& name) const;

  /// As datasets under /study; coordinates too.
  std::vector<Recorder::Dataset> results() const;
  std::vector<Recorder::Dataset> coordinates() const;
  Recorder::Dataset finished() const;

 private:
  const options::Study& study_;
  std::size_t runs_, probes_, width_ = 0;
  std::vector<Column> columns_;
  std::vector<double> finished_;
};

/// The run and probe with the largest (or least) value of a column; false where no run has ended.
struct StudyPlace {
  std::size_t run = 0, probe = 0;
  double value = 0.0;
};
bool find_extreme(const StudyTable& table, const std::string& column, bool largest, StudyPlace& place);

/// "track_seed 5, train_speed 83.3".
std::string point_text(const options::Study& study, std::size_t run);
/// Peaks of all runs, each with its run.
std::vector<Attribute> summary_of(const StudyTable& table);
void print_study(const StudyTable& table);

}  // namespace traverse::results
