// What was chosen for a scene, in a small file beside its results, so that the same scene need not be tried again.
#pragma once

#include <mpi.h>

#include <string>
#include <string_view>
#include <vector>

#include "error_control/model_choice.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Whether what was chosen is within the ranges that choosing itself keeps to.
bool is_possible(const Choice& choice, const Scene& scene);

class ChoiceCache {
 public:
  /// Collective. Of this scene as it was read, by this program as it was built. Nothing is kept of scenes whose results
  /// go to no file, or where `accuracy_cache` is false.
  ChoiceCache(MPI_Comm comm, const Scene& scene);

  /// Whether a choice was kept that the scene can have; then it is read, and `notes` says so.
  bool read(const Scene& scene, std::vector<std::string>& notes, Choice& choice) const;
  /// Keeps it with its notes; what cannot be written is not kept.
  void write(std::vector<std::string>& notes, Choice& choice);

 private:
  void write_file(const std::string& bytes) const;
  /// Of what is kept, of this scene, by this version, for its accuracy.
  std::string digest_of_choice(std::string_view bytes) const;
  /// What is kept in the file at path_; empty where it is not there, or not whole.
  std::string read_file() const;

  std::string path_;   // empty: nothing is kept
  std::string bound_;  // what the digest binds a choice to
  bool writes_;        // on this rank
  std::string known_;  // what was kept; empty: nothing
};

}  // namespace traverse::app
