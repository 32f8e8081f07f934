// The results of a study, one row for each run: stored under /study and /summary, and printed as a table; and the model
// of all runs of a study or a sweep, as stored and printed.
#pragma once

#include <mpi.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/study.hpp"

namespace traverse::results {

/// The model of all runs of a sweep or a study, as stored and printed.
struct RunModel {
  int modes = 0;           // 0: by elements
  int elements = 0;        // elements in the longest span, or rail elements in a sleeper bay
  bool in_bays = false;    // `elements` is the number in a sleeper bay
  double time_step = 0.0;  // s; 0: exact in time, or chosen for each run
  double accuracy = 0.0;   // accuracy for which mesh, step and modes were chosen; 0: they were given
  /// Name and relative error of each peak with an error estimate.
  std::vector<std::pair<std::string, double>> expected_errors{};
  std::string method{};  // method of batched runs, as in -ts_type; empty: PETSc's default
};

/// Attributes of the group of the runs.
std::vector<Attribute> attributes_of(const RunModel& model);
/// "by 3 modes", "by 24 elements a span and steps of 0.00055 s".
std::string method_of(const RunModel& model);
/// The note on runs with events that no trial run covered (a 1 for each in `outside_trials`); "" if there are none.
std::string extrapolation_note(const RunModel& model, const std::vector<double>& outside_trials);
/// The line about runs that were computed outside their batch; "" if there are none.
std::string separate_runs_note(long runs);

/// A result of every run.
struct StudyColumn {
  const char* name;  // name of its dataset
  const char* unit;
  enum Each { run, probe, limit } each;  // the object that has its own number
  bool of_wheels;                        // only in scenes with wheels
  bool for_people;                       // has statistics
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

  /// study: the study of the rows; all: the study of the runs, if it has more; both must outlive this object.
  StudyTable(const options::Study& study, std::size_t probes, bool wheels,
             const std::vector<options::VerdictLimit>& limits = {}, const options::Study* all = nullptr);

  const options::Study& study() const { return study_; }
  const std::vector<options::VerdictLimit>& limits() const { return limits_; }
  /// A verdict on each limit, from all runs that have ended.
  std::vector<Verdict> verdicts() const;
  std::size_t runs() const { return runs_; }
  std::size_t probes() const { return probes_; }
  /// Numbers in a row, in the order of the columns; a column has one number, or one number for each probe.
  std::size_t width() const { return width_; }
  /// The numbers of a run of the study from which rows_of made that of the table. A row of several runs is finished
  /// after the last one and has their greatest values, for least forces their least values. runs: number of runs of
  /// this row of which the numbers are the greatest.
  void put(std::size_t run, const double* numbers, std::size_t runs = 1);
  /// Collective. Copies the rows and reasons of rank 0 to all ranks.
  void broadcast(MPI_Comm comm);
  /// Sets the reason why runs cannot evaluate the quantity of a limit, in words.
  void set_reason(std::size_t limit, const std::string& why) { reasons_[limit] = why; }
  /// The reason that was set last; empty if there is none.
  std::string reason(std::size_t limit) const { return limit < reasons_.size() ? reasons_[limit] : ""; }
  bool finished(std::size_t run) const { return finished_[run] != 0.0; }
  std::size_t finished_runs() const;
  std::size_t runs_of_a_row() const { return all_ != nullptr ? all_->runs() / runs_ : 1; }

  struct Column {
    const StudyColumn* what;
    std::size_t width;           // numbers for each run
    std::vector<double> values;  // [runs, width], not_run if a run has not ended

    /// Shape of its dataset, after the number of runs or groups.
    std::vector<std::size_t> shape() const {
      return what->each == StudyColumn::run ? std::vector<std::size_t>() : std::vector<std::size_t>{width};
    }
  };
  const std::vector<Column>& columns() const { return columns_; }
  /// A column by its name; null if it does not exist.
  const Column* find(const std::string& name) const;

  /// Datasets under /study; coordinates too.
  std::vector<Recorder::Dataset> results() const;
  std::vector<Recorder::Dataset> coordinates() const;
  Recorder::Dataset finished() const;

 private:
  void merge(std::size_t row, const double* numbers);

  const options::Study& study_;
  const options::Study* all_;         // the study of the runs if a row has several of them, otherwise null
  std::vector<std::size_t> missing_;  // runs of each row that have not ended
  std::size_t runs_, probes_, width_ = 0;
  std::vector<options::VerdictLimit> limits_;
  std::vector<Column> columns_;
  std::vector<double> finished_;
  std::vector<std::string> reasons_;  // reason for each limit
};

/// The study whose runs are the rows of its table: without the options that are no factors of a sensitivity analysis. A
/// row then has the greatest values of all their combinations.
options::Study rows_of(const options::Study& study);

/// The run and probe with the largest (or least) value of a column; false if no run has ended.
struct StudyPlace {
  std::size_t run = 0, probe = 0;
  double value = 0.0;
};
bool find_extreme(const StudyTable& table, const std::string& column, bool largest, StudyPlace& place);
/// Searches only the runs from first to end - 1.
bool find_extreme(const StudyTable& table, const std::string& column, bool largest, StudyPlace& place,
                  std::size_t first, std::size_t end);

/// "track_seed 5, train_speed 83.3"; for a sweep "A3 at 83.3 m/s (300 km/h)".
std::string point_text(const options::Study& study, std::size_t run);
/// Peaks of all runs, each with its run, or for a sweep with its train and speed. Unknown peaks are omitted.
std::vector<Attribute> summary_of(const StudyTable& table);
void print_study(const StudyTable& table);

}  // namespace traverse::results
