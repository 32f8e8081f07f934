// What was chosen for a scene, in a small file beside its results, so that the same scene need not be tried again.
#pragma once

#include <mpi.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "traverse/base/error.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What choosing fills in of a scene, written or read.
struct ChosenOf {
  Scene& scene;
  void keep(base::Bytes& bytes);
};

/// Whether what was chosen is within the ranges that choosing itself keeps to. scene: as it was given.
bool is_possible(const Scene& chosen, const Scene& scene);

class KeptChoice {
 public:
  /// Collective. Of this scene as it was read, by this program as it was built. Nothing is kept of scenes whose results
  /// go to no file, or where `accuracy_cache` is false.
  KeptChoice(MPI_Comm comm, const Scene& scene);

  /// Whether a choice of this kind was kept that a scene can have; then it is read, and `notes` says so.
  template <class Choice>
  bool read(std::vector<std::string>& notes, Choice& choice, Scene& scene) {
    if (known_.empty()) return false;
    Choice found = choice;
    Scene chosen = scene;
    std::vector<std::string> said;
    try {
      base::Bytes bytes{std::span<const char>(known_)};
      ChosenOf parts{chosen};
      bytes(found, parts, said);
      if (!bytes.at_end() || !is_possible(chosen, scene)) return false;
    } catch (const FileError&) {  // not what was written
      return false;
    }
    choice = std::move(found);
    scene = std::move(chosen);
    notes = {"chosen as before for this scene; -accuracy_cache false tries again"};
    for (const std::string& note : said) notes.push_back(printable(note));
    return true;
  }
  /// Keeps them; what cannot be written is not kept.
  template <class Choice>
  void write(std::vector<std::string>& notes, Choice& choice, Scene& scene) {
    base::Bytes bytes;
    ChosenOf parts{scene};
    bytes(choice, parts, notes);
    write_file(bytes.written());
  }

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
