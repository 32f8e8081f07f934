// Reads the command line into the options in force. PETSc's options in the option table are copied into PETSc's own
// table; none of them starts a program, loads code or writes a file (table.hpp, passes_to_petsc).
//
//   Input input = read_input(argc, argv);              // before PETSc starts; reads the options files
//   if (input.help) ...                                // print help_text(input.help_about) and exit
//   Arguments words(input.petsc_words);                // the options for PETSc
//   SlepcInitialize(words.argc(), words.argv(), ...);
//   put_into_petsc(input);
//   Scene scene = read_scene();
//   ... TSSetFromOptions ...
//   notes_on_unused(input.entries);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

struct Input {
  Entries entries;         // last entry of each name; always contains scene_name (default: the name of the first file)
  bool help = false;       // -help, -h
  std::string help_about;  // the value of -help; empty for the complete list
  bool version = false;    // -version
  std::vector<std::string> notes;        // on former names, and the effect of each option of .petscrc and PETSC_OPTIONS
  std::vector<std::string> petsc_words;  // the program's name, then the options for PETSc
};

/// Reads the command line and each file that -options_file names, at its position. With `petscrc` also reads, with the
/// lowest precedence, .petscrc and PETSC_OPTIONS. PETSC_OPTIONS is removed from the environment, so that PETSc does not
/// read them.
/// `before`: options that the command line overrides. InputError for options of PETSc that are not permitted.
Input read_input(int argc, char** argv, const std::vector<Entry>& before = {}, bool petscrc = true);

/// The entries as a scene is read from them: options of PETSc by their names in Traverse, and a name of the scene (by
/// default scene_name). InputError for options of PETSc that are not permitted.
Entries complete(Entries entries, const std::string& scene_name);

/// The words as argc and argv, which are valid as long as the object exists.
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

/// Sets the options in force and copies the options of TS into PETSc's table. Call after PetscInitialize.
void put_into_petsc(const Input& input);

/// Sets those of these options that the solvers of PETSc read in its table, as long as the object exists.
class InPetsc {
 public:
  explicit InPetsc(const Entries& entries);
  ~InPetsc();
  InPetsc(const InPetsc&) = delete;
  InPetsc& operator=(const InPetsc&) = delete;

 private:
  std::vector<std::string> names_;
};

/// Hides from PETSc, as long as the object exists, the options that print the progress of its solvers or end a run
/// early: they apply to the requested run and not to trial runs.
class WithoutMonitors {
 public:
  WithoutMonitors();
  ~WithoutMonitors();
  WithoutMonitors(const WithoutMonitors&) = delete;
  WithoutMonitors& operator=(const WithoutMonitors&) = delete;

 private:
  std::vector<Entry> hidden_;
};

/// The entries of the last call of put_into_petsc.
const Entries& in_force();
/// Input::notes of the last call of put_into_petsc.
const std::vector<std::string>& notes_on_input();

/// Throws an InputError for a message of PETSc about a value of its solvers' options, with the name of the option.
[[noreturn]] void refuse_by_petsc(const std::string& message);

/// Notes on options of TS without effect in this scene. Call after TSSetFromOptions.
std::vector<std::string> notes_on_unused(const Entries& entries);

}  // namespace traverse::options
