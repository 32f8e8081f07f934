// What was chosen for a scene, in a small file beside its results, so that the same scene need not be tried again.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What choosing fills in of a scene, written or read.
struct ChosenOf {
  Scene& scene;
  void keep(base::Bytes& bytes);
};

class KeptChoice {
 public:
  /// Collective. Of this scene as it was read, by this program as it was built. Nothing is kept of scenes whose results
  /// go to no file, or where `accuracy_cache` is false.
  KeptChoice(MPI_Comm comm, const Scene& scene);

  /// Whether these were kept; then they are read, and `notes` says so.
  template <class... Parts>
  bool read(std::vector<std::string>& notes, Parts&&... parts) {
    if (known_.empty()) return false;
    base::Bytes bytes{std::span<const char>(known_)};
    bytes(parts..., notes);
    notes.insert(notes.begin(), "chosen as before for this scene; -accuracy_cache false tries again");
    return true;
  }
  /// Keeps them; what cannot be written is not kept.
  template <class... Parts>
  void write(std::vector<std::string>& notes, Parts&&... parts) {
    base::Bytes bytes;
    bytes(parts..., notes);
    write_file(bytes.written());
  }

 private:
  void write_file(const std::string& bytes) const;

  std::string path_;   // empty: nothing is kept
  bool writes_;        // on this rank
  std::string known_;  // what was kept; empty: nothing
};

}  // namespace traverse::app
