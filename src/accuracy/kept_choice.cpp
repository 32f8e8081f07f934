#include "kept_choice.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/digest.hpp"
#include "options/input_texts.hpp"
#include "results/own_file.hpp"
#include "run/scene_digest.hpp"

namespace traverse::app {
namespace {

constexpr const char* folder_name = ".traverse_choices";
constexpr std::array<std::string_view, 10> free_options = {
    "scene_name",   "restart",      "checkpoint_interval", "checkpoint_file", "output_file",
    "output_quiet", "options_file", "ts_max_steps",        "study_resume",    "accuracy_report"};

/// The file that this code is in, as it was built.
std::string build() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<const void*>(&build), &self) == 0) return {};
  struct stat file {};  // a program's own name may be one that the shell has found
  if (stat(self.dli_fname[0] == '/' ? self.dli_fname : "/proc/self/exe", &file) != 0) return {};
  return fmt::format("{} {}.{}", file.st_size, file.st_mtim.tv_sec, file.st_mtim.tv_nsec);
}

std::string digest_of_bytes(std::string_view bytes) {
  base::Digest digest;
  digest.add(bytes);
  return fmt::format("{:016x}", digest.value());
}

/// A digest of what follows it, and that; empty where the file is not there or not whole.
std::string read_file(const std::string& path) {
  const results::Descriptor found = results::open_ordinary(path, false);
  std::ifstream file(found.path(), std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t size = digest_of_bytes({}).size();
  if (text.size() <= size || digest_of_bytes(std::string_view(text).substr(size)) != text.substr(0, size)) return {};
  return text.substr(size);
}

}  // namespace

void ChosenOf::keep(base::Bytes& bytes) {
  int bays = scene.beam && scene.beam->track ? scene.beam->track->elements_per_bay : 0;
  std::vector<int> elements = scene.beam ? scene.beam->elements : std::vector<int>();
  Sweep sweep = scene.sweep.value_or(Sweep());
  bytes(elements, bays, sweep.method, sweep.trials_reach, sweep.trials_lost_contact, scene.time_step, scene.integrator,
        scene.model_modes, scene.step_probes, scene.contact_seats, scene.rest_tolerance, scene.vehicle_model,
        scene.most_defect, scene.output.low_pass);
  if (scene.beam) scene.beam->elements = elements;
  if (scene.beam && scene.beam->track) scene.beam->track->elements_per_bay = bays;
  if (scene.sweep) scene.sweep = sweep;
}

KeptChoice::KeptChoice(MPI_Comm comm, const Scene& scene) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  writes_ = rank == 0;
  if (scene.output.file.empty() || !scene.accuracy_cache) return;
  const std::string own_build = build();
  if (own_build.empty()) return;  // the same on all ranks
  const std::string key = digest_of(scene, free_options, options::inputs_read(), own_build);
  const std::filesystem::path folder = std::filesystem::path(scene.output.file).parent_path() / folder_name;
  std::error_code ignored;
  if (!std::filesystem::is_symlink(folder, ignored)) path_ = (folder / key).string();
  if (writes_ && !path_.empty()) known_ = read_file(path_);
  auto size = static_cast<int>(known_.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  known_.resize(static_cast<std::size_t>(size));
  MPI_Bcast(known_.data(), size, MPI_CHAR, 0, comm);
}

// Aside and renamed: others may read or write the same.
void KeptChoice::write_file(const std::string& bytes) const {
  if (!writes_ || path_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), ignored);
  const std::string aside = fmt::format("{}.{}", path_, getpid());
  const results::Descriptor file = results::make_file(aside);
  if (!file.open()) return;
  const bool whole = results::write_all(file, digest_of_bytes(bytes)) && results::write_all(file, bytes);
  if (!whole || !results::move_to_free_name(aside, path_)) (void)unlink(aside.c_str());
}

}  // namespace traverse::app
