// The program traverse: computes vehicles crossing flexible beams. See README.md.
#include <hdf5.h>
#include <slepceps.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "applications.hpp"
#include "base/one_step_methods.hpp"
#include "integrate/integrators.hpp"
#include "options/help_groups.hpp"
#include "process_start.hpp"
#include "results/origin.hpp"
#include "run/process.hpp"
#include "traverse/app/run.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"
#include "traverse/options/table.hpp"
#include "traverse/scene/scene.hpp"
#include "versions.hpp"

namespace {

// The system calls the functions of this section before it initialises the libraries.
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = traverse::run::store_ignored_signals;

/// Whether this is the first rank, before and after MPI too.
bool first_rank() {
  int started = 0, ended = 0;
  static int rank = [] {  // stored, because MPI does not return it after MPI_Finalize
    const char* told = traverse::app::rank_of_launcher();
    return told == nullptr ? 0 : std::atoi(told);
  }();
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  if (started != 0 && ended == 0) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

int print_error(const traverse::Error& error) {
  if (first_rank()) traverse::run::print_error(error);
  return error.status();
}

/// Verbs that scripts carry out: `traverse check ...` becomes the script traverse-check.
constexpr std::array<std::string_view, 3> verbs = {"check", "fault", "serve"};

/// Becomes the script of a verb, which is beside the installed program, or in the folder scripts beside the build
/// folder. Throws FileError if the script cannot be started; returns for all other words.
void start_script(int argc, char** argv) {
  const std::string_view verb = argc < 2 ? "" : argv[1];
  if (std::find(verbs.begin(), verbs.end(), verb) == verbs.end()) return;
  const std::string name = "traverse-" + std::string(verb);
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe"), folder = program.parent_path();
  std::vector<char*> words(argv + 1, argv + argc);
  words.push_back(nullptr);
  setenv("TRAVERSE_BINARY", program.c_str(), 1);
  for (const std::filesystem::path& script : {folder / name, folder / "../scripts" / name}) {
    words.front() = const_cast<char*>(script.c_str());
    execv(script.c_str(), words.data());
  }
  throw traverse::FileError(name +
                            ", which is installed beside the program, cannot be started: " + std::strerror(errno));
}

/// The verb of `traverse VERB SCENE.yml ...`; empty: none.
std::string verb_of(int argc, char** argv) { return argc > 1 && traverse::app::is_verb(argv[1]) ? argv[1] : ""; }

/// `traverse VERB SCENE.yml ...` reads the scene file; `traverse RESULTS.h5 ...` repeats the run that wrote the results
/// file.
traverse::options::Input read_input(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  std::vector<traverse::options::Entry> before;
  if (const std::string verb = verb_of(argc, argv); !verb.empty()) {
    words.erase(words.begin() + 1);
    if (words.size() > 1 && !words[1].starts_with("-")) words.insert(words.begin() + 1, "-options_file");
    if (verb == "describe") words.emplace_back("-describe");
  } else if (argc > 1 && traverse::results::is_hdf5(argv[1])) {
    before = traverse::results::origin_of(argv[1]);
    words.erase(words.begin() + 1);
  }
  traverse::options::Arguments arguments(std::move(words));
  return traverse::options::read_input(*arguments.argc(), *arguments.argv(), before);
}

/// Help text on everything (empty `what`), on a group of options, on one option or on `integrators`; `man`: the manual
/// page; `bash`: the completion for that shell. InputError for any other word.
std::string help_about(const std::string& what) {
  const std::string integrators = traverse::integrate::integrators_help();
  if (what == "integrators" || what == "ts_type") return integrators.substr(1);  // without the leading newline
  if (what == "man") return traverse::options::manual_page(integrators);
  if (what == "bash") {
    std::vector<std::string> types;
    for (const traverse::base::MethodRow& row : traverse::base::methods()) types.emplace_back(row.name);
    for (const traverse::integrate::PetscType& type : traverse::integrate::petsc_types()) types.emplace_back(type.name);
    return traverse::options::bash_completion(types);
  }
  return traverse::options::help_text(what) + (what.empty() ? integrators : "");
}

int run(traverse::options::Input& input, const std::string& verb) {
  try {
    traverse::options::put_into_petsc(input);
    const traverse::scene::Scene scene = traverse::scene::read_scene();
    traverse::app::check_verb(verb, scene);
    return traverse::app::run(PETSC_COMM_WORLD, scene);
  } catch (const traverse::Error& error) {
    return print_error(error);
  } catch (const std::exception& failure) {  // the failure may be on this rank only, and other ranks wait for it
    traverse::run::leave_together(PETSC_COMM_WORLD, traverse::run::as_error(failure));
  }
}

/// The exit status of the program, which reports lost output as a failure.
int after_output(int status) {
  const int lost = traverse::app::lost_output();
  if (status != 0 || lost == 0) return status;
  if (lost == EPIPE) return 128 + SIGPIPE;  // the reader has ended: no message is necessary
  return print_error(traverse::FileError(std::string("standard output could not be written: ") + std::strerror(lost) +
                                         "; the results file, if one was asked for, is complete"));
}

}  // namespace

int main(int argc, char** argv) {
  (void)H5dont_atexit();  // HDF5's exit handler may crash if a file could not be written
  traverse::app::guard_standard_output();
  traverse::run::install_handlers();
  traverse::run::set_cpu_limit_timer();
  traverse::run::print_signals(first_rank());
  traverse::app::start_lightly();
  const traverse::app::OneThreadOfBlas one_thread;
  try {
    start_script(argc, argv);
    traverse::options::Input input = read_input(argc, argv);
    if (input.help) {
      const std::string text = help_about(input.help_about);
      return after_output(std::fputs(text.c_str(), stdout) < 0 ? 1 : 0);
    }
    if (input.version) return after_output(std::fputs(traverse::app::versions().c_str(), stdout) < 0 ? 1 : 0);
    traverse::options::Arguments words(input.petsc_words);
    if (SlepcInitialize(words.argc(), words.argv(), nullptr, nullptr) != 0) return EXIT_FAILURE;
    traverse::app::started();
    (void)PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
    traverse::run::install_handlers();  // replaces the handlers of PETSc
    traverse::run::print_signals(first_rank());
    const int status = run(input, verb_of(argc, argv));
    (void)SlepcFinalize();
    return after_output(status);
  } catch (const traverse::Error& error) {  // before MPI_Init
    // Open MPI 5 ends all ranks if one rank ends; the others wait until the first rank has printed the message.
    if (!first_rank()) std::this_thread::sleep_for(std::chrono::seconds(1));
    return print_error(error);
  } catch (const std::exception& failure) {
    return print_error(traverse::run::as_error(failure));
  }
}
