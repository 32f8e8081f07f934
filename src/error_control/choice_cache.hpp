// Stores the choice for a scene in a small file beside its results, so that the same scene needs no new trial runs.
#pragma once

#include <mpi.h>

#include <string>
#include <string_view>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Whether a choice is within the ranges that the search itself respects.
bool is_possible(const Choice& choice, const scene::Scene& scene);

class ChoiceCache {
 public:
  /// The note that a stored choice is used.
  static constexpr const char* said = "stored choice for the same scene; -accuracy_cache false repeats the trial runs";

  /// Collective. The cache entry of this scene for this build of the program. Scenes without a results file, or with
  /// `accuracy_cache` false, have none.
  ChoiceCache(MPI_Comm comm, const scene::Scene& scene);

  /// Reads the stored choice with its notes. False if there is none, or if it is not possible for the scene.
  bool read(const scene::Scene& scene, std::vector<std::string>& notes, Choice& choice) const;
  /// Stores the choice with its notes. Failures to write are ignored.
  void write(std::vector<std::string>& notes, Choice& choice);

 private:
  void write_file(const std::string& bytes) const;
  /// Digest of the content, this scene, this version and its accuracy.
  std::string digest_of_choice(std::string_view bytes) const;
  /// The content of the file at path_; empty if it does not exist or is damaged.
  std::string read_file() const;

  std::string path_;     // empty: no cache entry
  std::string key_;      // part of the digest: version, accuracy and scene
  bool writes_;          // this rank writes the file
  std::string content_;  // stored content; empty: none
};

}  // namespace traverse::error_control
