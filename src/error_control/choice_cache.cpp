// Cache of chosen models: one file per scene in the folder .traverse_choices. Its name is a digest of options, input
// files and program build; its content is checked by a digest of its own.
#include "error_control/choice_cache.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>

#include "base/broadcast.hpp"
#include "base/digest.hpp"
#include "base/notes.hpp"
#include "base/one_step_methods.hpp"
#include "base/regular_file.hpp"
#include "integrate/integrators.hpp"
#include "options/input_texts.hpp"
#include "options/parse_number.hpp"
#include "results/place.hpp"
#include "run/model_record.hpp"
#include "scene/limits.hpp"
#include "traverse/base/version.hpp"

namespace traverse::error_control {
namespace {

constexpr const char* folder_name = ".traverse_choices";
constexpr std::string_view signature = "Traverse choice\n";  // followed by a digest and the content
constexpr std::size_t max_bytes = 1 << 26;                   // an open search contains the peaks of two runs
constexpr int max_in_a_bay = 1600;                           // sixteen times the largest track_elements_per_bay
constexpr std::array<std::string_view, 10> free_options = {
    "scene_name",   "restart",      "checkpoint_interval", "checkpoint_file", "output_file",
    "output_quiet", "options_file", "ts_max_steps",        "study_resume",    "accuracy_report"};

/// Size and time of the file that contains this code; it identifies the build.
std::string build() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<const void*>(&build), &self) == 0) return {};
  struct stat file {};  // the shell may have found a program without a path by PATH
  if (stat(self.dli_fname[0] == '/' ? self.dli_fname : "/proc/self/exe", &file) != 0) return {};
  return fmt::format("{} {}.{}", file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec);
}

bool within(double value, double least, double most) { return value >= least && value <= most; }

bool is_integrator(const std::string& name) {
  return name.empty() || base::find_method(name) != nullptr || integrate::find_petsc_type(name) != nullptr;
}

/// Whether a file is a cache file, or an empty one that an interrupted write left.
bool is_cache_file(const std::string& path) {
  std::error_code none;
  return results::begins_with(path, signature) ||
         (results::open_ordinary(path, false).open() && std::filesystem::file_size(path, none) == 0);
}

}  // namespace

bool is_possible(const Choice& choice, const scene::Scene& scene) {
  constexpr double largest = std::numeric_limits<double>::max(), endless = std::numeric_limits<double>::infinity();
  const scene::NumericalModel& model = choice.model;
  const double most = !scene.beam         ? 0.0
                      : scene.beam->track ? max_in_a_bay
                                          : scene::most_elements / static_cast<double>(scene.beam->spans.size());
  return within(model.elements, scene.beam ? 1.0 : 0.0, most) && within(model.modes, 0, scene::most_elements) &&
         (!model.step || within(*model.step, options::least_quantity, scene.end_time.value_or(largest))) &&
         is_integrator(model.method) && model.vehicles <= scene::VehicleModel::automatic &&
         within(model.residual_limit, 0.0, endless) && within(model.window_tolerance, -1.0, largest) &&
         within(choice.low_pass.value_or(0.0), 0.0, largest);
}

bool ChoiceCache::read(const scene::Scene& scene, std::vector<std::string>& notes, Choice& choice) const {
  if (content_.empty()) return false;
  Choice found;
  std::vector<std::string> stored_notes;
  try {
    base::Bytes bytes{std::span<const char>(content_)};
    bytes(found, stored_notes);
    if (!bytes.at_end() || !is_possible(found, scene)) return false;
  } catch (const FileError&) {  // damaged content
    return false;
  }
  choice = std::move(found);
  notes.clear();
  for (const std::string& note : stored_notes) {
    const std::string text = printable(base::text_of_note(note));
    notes.push_back(base::is_detail(note) ? base::detail(text) : text);
  }
  return true;
}

void ChoiceCache::write(std::vector<std::string>& notes, Choice& choice) {
  base::Bytes bytes;
  bytes(choice, notes);
  write_file(bytes.written());
}

ChoiceCache::ChoiceCache(MPI_Comm comm, const scene::Scene& scene) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  writes_ = rank == 0;
  if (scene.output.file.empty() || !scene.accuracy_cache || scene::has_own_contact_law(scene)) return;
  const std::string own_build = build();
  if (own_build.empty()) return;  // all ranks have the same own_build
  const std::string key = run::digest_of(scene, free_options, options::inputs_read(), own_build);
  const std::filesystem::path folder = std::filesystem::path(scene.output.file).parent_path() / folder_name;
  std::error_code ignored;
  if (!std::filesystem::is_symlink(folder, ignored)) path_ = (folder / key).string();
  key_ = fmt::format("{} {:.17g} {} ", version(), scene.accuracy, key);
  if (writes_ && !path_.empty()) content_ = read_file();
  content_ = base::broadcast(comm, std::move(content_));
}

std::string ChoiceCache::digest_of_choice(std::string_view bytes) const {
  base::Digest digest;
  digest.add(key_);
  digest.add(bytes);
  return fmt::format("{:016x}", digest.value());
}

std::string ChoiceCache::read_file() const {
  const results::Descriptor found = results::open_ordinary(path_, false);
  std::string text;
  const std::size_t head = signature.size() + digest_of_choice({}).size();
  if (!base::read_regular_file(found.path(), max_bytes, text).empty() || text.size() <= head) return {};
  const std::string bytes = text.substr(head);
  return text.substr(0, head) == std::string(signature) + digest_of_choice(bytes) ? bytes : "";
}

// Writes a temporary file and renames it, because other processes may read or write the same entry. An existing cache
// file was not readable and is replaced.
void ChoiceCache::write_file(const std::string& bytes) const {
  if (!writes_ || path_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), ignored);
  const std::string temporary = fmt::format("{}.{}", path_, getpid());
  const results::Descriptor file = results::make_file(temporary);
  if (!file.open()) return;
  const bool written = results::write_all(file, std::string(signature) + digest_of_choice(bytes) + bytes);
  const bool renamed = written && (is_cache_file(path_) ? std::rename(temporary.c_str(), path_.c_str()) == 0
                                                        : results::move_to_free_name(temporary, path_));
  if (!renamed) (void)unlink(temporary.c_str());
}

}  // namespace traverse::error_control
