// The numbers of a study, one row a run: in the file under /study and /summary, and as a table on the terminal.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/study.hpp"

namespace traverse::results {

/// What is known of every run.
struct StudyColumn {
  const char* name;  // of its dataset
  const char* unit;
  enum Each { run, probe, limit } each;  // what has a number of its own
  bool of_wheels;                        // only where there are any
  bool for_people;                       // statistics are made of it
};
inline constexpr StudyColumn study_columns[] = {
    {"probes_x", "m", StudyColumn::probe, false, false},
    {"peak_deflection", "m", StudyColumn::probe, false, true},
    {"peak_deflection_time", "s", StudyColumn::probe, false, false},
    {"peak_acceleration", "m/s2", StudyColumn::probe, false, true},
    {"peak_acceleration_time", "s", StudyColumn::probe, false, false},
    {"peak_moment", "N m", StudyColumn::probe, false, true},
    {"peak_moment_time", "s", StudyColumn::probe, false, false},
    {"static_deflection", "m", StudyColumn::probe, false, false},
    {"amplification", "1", StudyColumn::probe, false, true},
    {"least_wheel_force", "N", StudyColumn::run, true, true},
    {"greatest_wheel_force", "N", StudyColumn::run, true, true},
    {"contact_losses", "1", StudyColumn::run, true, false},
    {"longest_loss", "s", StudyColumn::run, true, false},
    {"unseen", "1", StudyColumn::run, false, false},
    {"judged", "as /verdicts/quantity", StudyColumn::limit, false, true},
    {"judged_x", "m", StudyColumn::limit, false, false},
};

class StudyTable {
 public:
  static constexpr double not_run = std::numeric_limits<double>::quiet_NaN();

  StudyTable(const options::Study& study, std::size_t probes, bool wheels,
             const std::vector<options::VerdictLimit>& limits = {});

  const options::Study& study() const { return study_; }
  const std::vector<options::VerdictLimit>& limits() const { return limits_; }
  /// A verdict on each limit, of all runs that have ended.
  std::vector<Verdict> verdicts() const;
  std::size_t runs() const { return runs_; }
  std::size_t probes() const { return probes_; }
  /// Numbers in a row: those of each column, per probe or one, in the columns' order.
  std::size_t width() const { return width_; }
  void put(std::size_t run, const double* row);
  /// Why runs do not know the value of a limit, in words.
  void give_reason(std::size_t limit, const std::string& why) { reasons_[limit] = why; }
  bool finished(std::size_t run) const { return finished_[run] != 0.0; }
  std::size_t finished_runs() const;

  struct Column {
    const StudyColumn* what;
    std::size_t width;           // numbers a run
    std::vector<double> values;  // [runs, width], not_run where a run has not ended

    /// Of its dataset, behind the number of runs or of groups of these.
    std::vector<std::size_t> shape() const {
      return what->each == StudyColumn::run ? std::vector<std::size_t>() : std::vector<std::size_t>{width};
    }
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
  std::vector<options::VerdictLimit> limits_;
  std::vector<Column> columns_;
  std::vector<double> finished_;
  std::vector<std::string> reasons_;  // of each limit
};

/// The run and probe with the largest (or least) value of a column; false where no run has ended.
struct StudyPlace {
  std::size_t run = 0, probe = 0;
  double value = 0.0;
};
bool find_extreme(const StudyTable& table, const std::string& column, bool largest, StudyPlace& place);
/// The same among some of the runs.
bool find_extreme(const StudyTable& table, const std::string& column, bool largest, StudyPlace& place,
                  std::size_t first, std::size_t past);

/// "track_seed 5, train_speed 83.3"; of a sweep "A3 at 83.3 m/s (300 km/h)".
std::string point_text(const options::Study& study, std::size_t run);
/// Peaks of all runs, each with its run, of a sweep with its train and speed; what is not known is left out.
std::vector<Attribute> summary_of(const StudyTable& table);
void print_study(const StudyTable& table);

}  // namespace traverse::results
