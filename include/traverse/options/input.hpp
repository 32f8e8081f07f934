// From the command line to the options in force, some of which pass into PETSc's own table: those that the table of
// options lists, none that starts a program, loads code or writes a file (options/table.hpp, passes_to_petsc).
//
//   Input input = read_input(argc, argv);              // before PETSc starts; reads the options files
//   if (input.help) ...                                // print help_text(input.help_about) and leave
//   Arguments words(input.petsc_words);                // what passes to PETSc
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
  Entries entries;         // the last one of each name by position; scene_name always (default: the first file's)
  bool help = false;       // -help, -h
  std::string help_about;  // what -help asks about; empty: everything
  bool version = false;    // -version
  std::vector<std::string> notes;        // on options by .petscrc and PETSC_OPTIONS: what each of them does
  std::vector<std::string> petsc_words;  // the program's name, then the options that pass to PETSc
};

/// Reads the command line and every file named by -options_file, at its position; weakest of all, where `petscrc` says
/// so, .petscrc and PETSC_OPTIONS, which it takes out of the environment: PETSc reads neither. `before`: options that
/// those of the command line win over. InputError for options of PETSc's kinds that do not pass to it.
Input read_input(int argc, char** argv, const std::vector<Entry>& before = {}, bool petscrc = true);

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

/// After PetscInitialize: the options are in force, and TS finds its own in PETSc's table.
void put_into_petsc(const Input& input);

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
/// What it was told of .petscrc and PETSC_OPTIONS: a line on each option.
const std::vector<std::string>& notes_on_petscrc();

/// Throws the InputError for what PETSc says about a value while it reads its solvers' options: names the option.
[[noreturn]] void refuse_by_petsc(const std::string& message);

/// After TSSetFromOptions: notes on options of TS without effect in this scene.
std::vector<std::string> notes_on_unused(const Entries& entries);

}  // namespace traverse::options
