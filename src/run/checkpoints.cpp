// Checks the names of output files and checkpoint, validates a restart by the digest of the scene, and writes
// checkpoints so rarely that they use at most a twentieth of the run time.
#include "run/checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "options/input_texts.hpp"
#include "options/parse_number.hpp"
#include "results/origin.hpp"
#include "results/stage.hpp"
#include "run/model_record.hpp"
#include "run/process.hpp"
#include "traverse/options/input.hpp"

namespace traverse::run {
namespace {

constexpr double default_interval = 900.0;  // s
constexpr double cost_factor = 20.0;        // ratio of the interval to the duration of writing a checkpoint
constexpr unsigned calls_per_reading = 16;  // calls of wanted() between two readings of the clock
constexpr std::array<std::string_view, 11> free_options = {
    "ts_max_time",  "scene_tail",   "scene_name",   "restart",         "checkpoint_interval", "output_file",
    "output_quiet", "options_file", "ts_max_steps", "checkpoint_file", "accuracy_cache"};

std::string option_value(const scene::Scene& scene, const char* name) {
  const options::Entry* entry = scene.find_option(name);
  return entry == nullptr ? std::string() : entry->value;
}

std::string path_for(const scene::Scene& scene) {
  std::string name = option_value(scene, "checkpoint_file");
  if (name == "none") return "";
  if (!name.empty()) return name;
  return scene.output.file.empty() ? "" : scene.output.file + ".checkpoint";
}

/// Throws InputError if results and checkpoint, including their temporary files, would be the same file.
void check_distinct_outputs(const std::string& results, const std::string& checkpoint) {
  if (checkpoint.empty() || results.empty()) return;
  const auto place = [](const std::string& name) {
    const std::filesystem::path absolute = std::filesystem::absolute(name);
    std::error_code unknown;  // a name that is too long for a file, for example
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, unknown);
    return unknown ? absolute.lexically_normal() : canonical;
  };
  for (const std::string& other : {checkpoint, results::temporary_checkpoint(checkpoint)})
    if (place(results) == place(other))
      throw InputError(fmt::format("checkpoint_file = {}: the results file {} would be written to the same place",
                                   checkpoint, results));
}

/// InputError if the results file is an input of the run; a continued study or run is an exception.
void check_output_is_no_input(const scene::Scene& scene) {
  const bool continued = !option_value(scene, "restart").empty() || (scene.study && scene.study->resume);
  if (scene.output.file.empty() || continued) return;
  std::vector<std::string> inputs = {results::opened_origin()};
  for (const options::InputText& input : options::inputs_read()) inputs.push_back(input.name);
  std::error_code ignored;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(scene.output.file, input, ignored))
      throw InputError(fmt::format("output_file = {}: the run reads this file; name another one", scene.output.file));
}

/// A continued run appends to its results file, unless the command line gives another one. The name in a checkpoint
/// must be valid as in an options file.
void set_results_file(const std::string& earlier, const std::string& restart, scene::Scene& scene) {
  const options::Entry* output = scene.find_option("output_file");
  const bool new_name = output != nullptr && !output->from_file() && !results::is_new_name(*output);
  if (new_name && earlier.empty() && !scene.output.file.empty())
    throw InputError("restart = " + restart +
                     ": that run had no results file, its rows so far are nowhere; go on with -output_file none, or "
                     "begin anew without -restart");
  if (new_name) return;
  if (!earlier.empty() && !earlier.ends_with(".h5"))
    throw InputError("restart = " + restart + ": the name of its results file, " + earlier +
                     ", does not end in .h5; name the file with -output_file");
  scene.output.file = earlier;
}

}  // namespace

results::Place claim_outputs(MPI_Comm comm, const scene::Scene& scene) {
  const bool one_run = scene.analysis == options::Analysis::transient && !scene.study && !scene.sweep;
  const std::string checkpoint = one_run ? path_for(scene) : "";
  check_distinct_outputs(scene.output.file, checkpoint);
  results::Place place = results::claim_place(comm, scene.output.file);
  check_output_is_no_input(scene);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string failure;
  try {
    if (rank == 0 && !checkpoint.empty()) results::check_checkpoint_place(checkpoint);
  } catch (const FileError& error) {
    failure = error.what();
  }
  results::share_failure(comm, failure);
  return place;
}

std::string digest_of(const scene::Scene& scene) { return digest_of(scene, free_options, options::tables_read()); }

std::optional<results::Checkpoint> earlier_of(MPI_Comm comm, scene::Scene& scene) {
  const std::string path = option_value(scene, "restart");
  if (path.empty()) return std::nullopt;
  if (scene.study || scene.sweep)
    throw InputError("restart = " + path + ": studies and sweeps have no checkpoints; a study goes on by study_resume");
  if (scene.analysis != options::Analysis::transient)
    throw InputError("restart = " + path + ": only runs in time have checkpoints");
  results::Checkpoint earlier = results::read_checkpoint(comm, path);
  if (earlier.digest != digest_of(scene))
    throw InputError("restart = " + path +
                     ": is of another scene; only ts_max_time, scene_tail, ts_max_steps and the names of files may be "
                     "changed");
  set_results_file(earlier.results.file, path, scene);
  return earlier;
}

Checkpoints::Checkpoints(MPI_Comm comm, const scene::Scene& scene, Simulation& simulation, results::Recorder& recorder,
                         results::Checkpoint state)
    : comm_(comm),
      simulation_(simulation),
      recorder_(recorder),
      state_(std::move(state)),
      own_file_(results::id_at(option_value(scene, "restart").c_str())),
      interval_(default_interval) {
  if (scene.analysis != options::Analysis::transient) return;
  path_ = path_for(scene);
  if (const std::string interval = option_value(scene, "checkpoint_interval"); !interval.empty())
    (void)options::parse_number(interval, interval_);
  if (trouble_ = simulation.passage().no_archive(); !trouble_.empty()) path_.clear();
  state_.digest = digest_of(scene);
  const Plan& plan = simulation.plan();
  state_.end_time = plan.end_time;
  state_.time_step = plan.time_step;
  state_.interval = plan.interval;
  state_.stored = plan.stored;
  state_.of_ranks.clear();
}

bool Checkpoints::wanted() {
  if (!possible()) return false;
  if (checkpoint_requested()) return true;
  if (interval_ == 0.0 || ++calls_ % calls_per_reading != 0) return false;
  return std::chrono::duration<double>(Clock::now() - last_).count() > std::max(interval_, cost_factor * cost_);
}

void Checkpoints::write(double time, double wall_seconds) {
  const results::Stage stage("checkpoint");
  const auto begin = Clock::now();
  base::Archive archive(comm_);
  simulation_.keep(archive);
  state_.results = recorder_.secure();
  state_.time = time;
  state_.wall_seconds = wall_seconds;
  results::write_checkpoint(comm_, path_, state_, archive.release());
  own_file_ = results::id_at(path_.c_str());
  last_ = Clock::now();
  cost_ = std::chrono::duration<double>(last_ - begin).count();
}

void Checkpoints::forget() {
  if (possible() && own_file_.there && results::id_at(path_.c_str()) == own_file_)
    results::remove_checkpoint(comm_, path_);
}

}  // namespace traverse::run
