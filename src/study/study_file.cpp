// Writes the table of runs at limited cost, checks whether an earlier file belongs to the same study, and copies its
// finished runs.
#include "study/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "results/sensitivity.hpp"
#include "results/study_statistics.hpp"
#include "results/sweep.hpp"
#include "run/model_record.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "study/find.hpp"

namespace traverse::study {
namespace {

constexpr double write_every = 5.0,
                 cost_factor =
                     20.0;  // least interval of two writes, s; ratio of this interval to the duration of a write

/// Whether an option changes no run.
bool changes_no_run(const std::string& name, const options::Study& study) {
  if (name.starts_with("study_") || name.starts_with("sweep_") || name == "scene_name" || name == "output_file" ||
      name == "output_quiet" || name == "options_file")
    return true;
  return std::any_of(study.dimensions.begin(), study.dimensions.end(), [&](const options::StudyDimension& d) {
    return std::find(d.options.begin(), d.options.end(), name) != d.options.end();
  });
}

/// Why the file's runs do not belong to this study; empty if they do.
std::string contradiction(const results::StoredStudy& stored, const scene::Scene& scene,
                          const results::RunModel& model) {
  std::map<std::string, std::string> now(scene.options.begin(), scene.options.end());
  for (const auto& [name, value] : stored.options) {
    if (changes_no_run(name, *scene.study)) continue;
    if (!now.contains(name)) return fmt::format("it was computed with {} = {}", name, value);
    if (now[name] != value) return fmt::format("it was computed with {} = {}, not {}", name, value, now[name]);
  }
  for (const auto& [name, value] : now)
    if (!changes_no_run(name, *scene.study) && !stored.options.contains(name))
      return fmt::format("it was computed without {} = {}", name, value);
  for (const options::StudyDimension& d : scene.study->dimensions)
    if (!stored.datasets.contains(d.name())) return fmt::format("{} was not varied in it", d.name());
  for (const results::Attribute& attribute : results::attributes_of(model)) {
    const double* number = std::get_if<double>(&attribute.value);
    const long* whole = std::get_if<long>(&attribute.value);
    const auto known = stored.numbers.find(attribute.name);
    if (number == nullptr && whole == nullptr) {
      const auto text = stored.texts.find(attribute.name);
      if (text == stored.texts.end() || text->second != std::get<std::string>(attribute.value))
        return fmt::format("its runs have another {}", attribute.name);
    } else if (known == stored.numbers.end() ||
               known->second != (number != nullptr ? *number : static_cast<double>(*whole))) {
      return fmt::format("its runs have another {}", attribute.name);
    }
  }
  return "";
}

/// Copies the finished runs of a file into the table, by their coordinates.
void copy_finished(const results::StoredStudy& stored, results::StudyTable& table) {
  const options::Study& study = table.study();
  const auto finished = stored.datasets.find("finished");
  if (finished == stored.datasets.end()) return;
  std::map<std::vector<double>, std::size_t> rows;
  for (std::size_t row = 0; row < finished->second.size(); ++row) {
    if (finished->second[row] != 1.0) continue;
    std::vector<double> point;
    for (const options::StudyDimension& d : study.dimensions) point.push_back(stored.datasets.at(d.name()).at(row));
    rows.emplace(std::move(point), row);
  }
  for (std::size_t run = 0; run < table.runs(); ++run) {
    std::vector<double> point, numbers;
    for (const options::StudyDimension& d : study.dimensions) point.push_back(study.value(run, d));
    const auto row = rows.find(point);
    if (row == rows.end()) continue;
    for (const results::StudyTable::Column& column : table.columns()) {
      const auto found = stored.datasets.find(column.what->name);
      if (found == stored.datasets.end() || found->second.size() != finished->second.size() * column.width) return;
      const auto from = found->second.begin() + static_cast<std::ptrdiff_t>(row->second * column.width);
      numbers.insert(numbers.end(), from, from + static_cast<std::ptrdiff_t>(column.width));
    }
    table.put(run, numbers.data());
  }
}

}  // namespace

results::StoredStudy stored_of(MPI_Comm comm, const scene::Scene& scene, const results::RunModel& model) {
  results::StoredStudy stored;
  if (!scene.study || !scene.study->resume) return stored;
  results::read_to_resume(comm, "study_resume", scene.output.file, "other runs", "all runs are", [&] {
    stored = results::read_study(scene.output.file);
    return stored.datasets.empty() ? "" : contradiction(stored, scene, model);
  });
  return stored;
}

std::vector<char> copy_known(MPI_Comm comm, const results::StoredStudy& stored, results::StudyTable& table) {
  copy_finished(stored, table);
  std::vector<char> known(table.runs());
  for (std::size_t run = 0; run < table.runs(); ++run) known[run] = table.finished(run) ? 1 : 0;
  MPI_Bcast(known.data(), static_cast<int>(known.size()), MPI_CHAR, 0, comm);
  return known;
}

results::StoredStudy stored_of(const results::StudyTable& table) {
  results::StoredStudy stored;
  const auto add = [&stored](const results::Recorder::Dataset& set) {
    stored.datasets[set.name.substr(std::string_view("/study/").size())] = set.values;
  };
  for (const results::Recorder::Dataset& set : table.coordinates()) add(set);
  for (const results::Recorder::Dataset& set : table.results()) add(set);
  add(table.finished());
  return stored;
}

namespace {

results::Recorder::Dataset digests_of(const results::StudyTable& table) {
  return {std::string("/study/") + results::row_digest,
          {table.runs()},
          results::row_digests(stored_of(table).datasets),
          "1"};
}

}  // namespace

StudyFile::StudyFile(MPI_Comm comm, results::Place place, const scene::Scene& scene, const results::RunModel& model,
                     const results::StudyTable& table, const std::vector<std::string>& notes)
    : comm_(comm), table_(table), model_(model), recorder_([&] {
        results::Recorder made(comm, std::move(place), run::layout_without_series(scene), run::attributes(comm, scene),
                               scene.options);
        run::record_model(scene, notes, made);
        results::record_limits(made, table.limits());
        if (!table.study().sweep) made.datasets(table.coordinates());
        made.datasets(results());
        return made;
      }()) {
  const std::string folder = table.study().sweep ? "/sweep" : "/study";
  if (!table.study().sweep) {
    std::string dimensions, axes;
    for (const options::StudyDimension& d : table.study().dimensions) {
      dimensions += (dimensions.empty() ? "" : ",") + d.name();
      recorder_.attributes(folder + "/" + d.name(), {{"axis", static_cast<long>(d.axis)}, {"law", d.law}});
    }
    for (const options::Study::Axis& axis : table.study().axes) axes += (axes.empty() ? "" : ",") + axis.name;
    recorder_.attributes(folder, {{"dimensions", dimensions}, {"axes", axes}});
  }
  recorder_.attributes(folder, results::attributes_of(model));
  recorder_.publish();
}

std::vector<results::Recorder::Dataset> StudyFile::results() const {
  if (table_.study().sweep) return results::sweep_datasets(table_, !model_.expected_errors.empty());
  std::vector<results::Recorder::Dataset> sets = table_.results();
  sets.push_back(digests_of(table_));
  sets.push_back(table_.finished());
  return sets;
}

void StudyFile::write() {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<results::Recorder::Dataset> sets = results();
  const results::Recorder::Dataset last = std::move(sets.back());
  sets.pop_back();
  recorder_.rewrite(sets);
  recorder_.rewrite({last});  // after all others are on the disk
  written_ = std::chrono::steady_clock::now();
  cost_ = std::chrono::duration<double>(written_ - begin).count();
}

void StudyFile::update() {
  const double since = std::chrono::duration<double>(std::chrono::steady_clock::now() - written_).count();
  if (cost_ > 0.0 && since < std::max(write_every, cost_factor * cost_)) return;
  try {
    write();
  } catch (const FileError& error) {
    run::leave_together(comm_, error);
  }
}

void StudyFile::finish(const StudyCourse& course, const std::vector<results::Verdict>& verdicts,
                       const SweepFindings* findings) {
  if (!recorder_.writes()) return;
  write();
  recorder_.change_beside();
  const results::StudyStatistics statistics(table_);
  recorder_.datasets(statistics.datasets());
  if (statistics.groups() > 0) recorder_.attributes("/study/statistics", {{"confidence", table_.study().confidence}});
  if (course.refined && table_.study().sweep)
    recorder_.datasets({{"/sweep/added", {course.refined->added.size()}, course.refined->added, "1"}});
  if (findings != nullptr) findings->record(recorder_);
  if (table_.finished_runs() == table_.runs()) {
    if (table_.study().sensitivity) results::SensitivityAnalysis(table_).record(recorder_);
    if (table_.study().find) record_answers(table_, answers_of(table_), recorder_);
  }
  results::record_verdicts(recorder_, verdicts);
  std::vector<results::Attribute> summary = results::summary_of(table_);
  for (const auto& [quantity, error] : model_.expected_errors) summary.push_back({"expected_error_" + quantity, error});
  if (course.refined) results::add_to(summary, *course.refined);
  const auto of_a_row = static_cast<long>(table_.runs_of_a_row());
  summary.push_back({"runs", of_a_row * static_cast<long>(table_.finished_runs())});
  summary.push_back({"runs_planned", of_a_row * static_cast<long>(table_.runs())});
  if (!table_.study().sweep) summary.push_back({"runs_known", course.known});
  summary.push_back({"wall_seconds", course.wall_seconds});
  summary.push_back({"ended", course.ended});
  recorder_.finish_with(summary, {"runs", "wall_seconds"});
}

void print_study_course(const results::StudyTable& table, const results::RunModel& model, const StudyCourse& course,
                        const std::vector<results::Verdict>& verdicts, const SweepFindings* findings,
                        const scene::Scene& scene) {
  const bool sweep = table.study().sweep;
  if (table.finished_runs() > 0) {
    sweep ? results::print_sweep(table) : results::print_study(table);
    if (course.refined) results::print(*course.refined);
    if (findings != nullptr) findings->print();
    if (table.finished_runs() == table.runs()) {
      if (table.study().sensitivity) results::SensitivityAnalysis(table).print();
      if (table.study().find) print_answers(table, answers_of(table));
    }
    results::StudyStatistics(table).print();
    results::print_verdicts(verdicts, scene.unusual);
  }
  if (const std::string warning = results::extrapolation_note(model, table.find("unseen")->values); !warning.empty())
    fmt::print("  note: {}\n", warning);
  fmt::print("{}", results::separate_runs_note(course.separate_runs));
  const auto of_a_row = static_cast<long>(table.runs_of_a_row());
  const long done = of_a_row * static_cast<long>(table.finished_runs()) - course.known;
  fmt::print("  {} of {} runs {} in {:.3g} s, {:.3g} ms each{}\n  {:<22}{}\nresults  {}\n", done,
             of_a_row * static_cast<long>(table.runs()) - course.known, results::method_of(model), course.wall_seconds,
             1e3 * course.wall_seconds / static_cast<double>(std::max(done, 1L)),
             course.known > 0 ? fmt::format(", and {} known before", course.known) : "",
             sweep ? "the sweep" : "the study", course.ended, scene.output.file.empty() ? "none" : scene.output.file);
}

}  // namespace traverse::study
