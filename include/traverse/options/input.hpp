// From the command line to the options in force, and into PETSc's own table.
//
//   Input input = read_input(argc, argv);              // before PETSc starts; reads the options files
//   if (input.help) ...                                // print help_text(input.help_about) and leave
//   Arguments words(input.petsc_words);                // PETSc sees what it owns, also out of files
//   SlepcInitialize(words.argc(), words.argv(), ...);
//   put_into_petsc(input);                             // all the rest, so that -options_view shows it
//   Scene scene = read_scene();
//   ... TSSetFromOptions ...
//   check_all_used(input.entries);                     // -ts_tpye is refused here
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// PETSc's table holds 512 options; a few places are left to PETSc itself.
inline constexpr std::size_t most_options = 500;

struct Input {
  Entries entries;         // the last one of each name by position; scene_name always (default: the first file's)
  bool help = false;       // -help, -h
  std::string help_about;  // what -help asks about; empty: everything
  bool version = false;    // -version
  std::vector<std::string> petsc_words;  // the program's name, then the options that PETSc owns
};

/// Reads the command line and every file named by -options_file, at its position. `before`: options that these win
/// over. Throws InputError.
Input read_input(int argc, char** argv, const std::vector<Entry>& before = {});

/// The words as argc and argv, kept until the object goes.
class Arguments {
 public:
  explicit Arguments(std::vector<std::string> words);
  int* argc() { return &argc_; }
  char*** argv() { return &argv_; }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
  int argc_ = 0;
  char** argv_ = nullptr;
};

/// After PetscInitialize: adds options of ours that came by PETSC_OPTIONS or .petscrc to input.entries (weakest of
/// all), then puts all entries into PETSc's table. Refuses names of PETSc's own kind (-log_, -mpi, -draw_) that it has
/// not asked for and that are no common name.
void put_into_petsc(Input& input);

/// While it lives PETSc does not see those options that show what its solvers do or that end a run early: they are
/// meant for the run that the user asked for, not for trial runs.
class WithoutMonitors {
 public:
  WithoutMonitors();
  ~WithoutMonitors();
  WithoutMonitors(const WithoutMonitors&) = delete;
  WithoutMonitors& operator=(const WithoutMonitors&) = delete;

 private:
  std::vector<Entry> aside_;
};

/// The entries that put_into_petsc saw last.
const Entries& in_force();

/// Throws the InputError for what PETSc says about a value while it reads its solvers' options: names the option.
[[noreturn]] void refuse_by_petsc(const std::string& message);

/// After all XxxSetFromOptions: refuses options of PETSc's kind that nobody asked for and that are no common name
/// (InputError with the nearest name). Returns notes on common ones without effect in this scene.
std::vector<std::string> check_all_used(const Entries& entries);

}  // namespace traverse::options
