// Which options reach PETSc: those of a list, with values that name no file, program or library, wherever they stand;
// and options that do nothing.
#include <gtest/gtest.h>
#include <petscsys.h>

#include <algorithm>

#include "options/petscrc.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/options/input.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using test::any_contains;
using test::contains;
using test::message_of;

Input input_of(std::vector<std::string> words, const std::vector<Entry>& before = {}) {
  words.insert(words.begin(), "traverse");
  Arguments arguments(std::move(words));
  return read_input(*arguments.argc(), *arguments.argv(), before);
}

const std::vector<std::string> dangerous = {"python",
                                            "info",
                                            "history",
                                            "citations",
                                            "malloc_view",
                                            "malloc_dump",
                                            "memory_view",
                                            "objects_dump",
                                            "mpidump",
                                            "options_view",
                                            "options_file_yaml",
                                            "options_string",
                                            "options_monitor",
                                            "start_in_debugger",
                                            "on_error_attach_debugger",
                                            "on_error_emacs",
                                            "stop_for_debugger",
                                            "debugger_nodes",
                                            "display",
                                            "x_virtual",
                                            "log_all",
                                            "log_trace",
                                            "log_mpe",
                                            "log_summary",
                                            "log_view_memory",
                                            "log_viewer",
                                            "viewer_binary_filename",
                                            "viewer_socket_machine",
                                            "draw_save",
                                            "tmp",
                                            "shared_tmp",
                                            "saws_port",
                                            "prefix_push",
                                            "prefix_pop",
                                            "mat_view",
                                            "vec_view",
                                            "mat_type",
                                            "ksp_view",
                                            "pc_type",
                                            "eps_view",
                                            "st_type",
                                            "ts_monitor_solution",
                                            "ts_monitor_solution_vtk",
                                            "ts_monitor_draw_solution",
                                            "ts_save_trajectory",
                                            "ts_trajectory_dirname",
                                            "ts_view_pre",
                                            "ts_adapt_history",
                                            "ts_python_type",
                                            "snes_monitor",
                                            "snes_python_type",
                                            "petscdevice",
                                            "slepc_view",
                                            "hdf5_chunk",
                                            "error_output_stderr",
                                            "mpi_linear_solver_server"};

TEST(PetscList, NamesOfPetscThatAreNotOnItAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string& name : dangerous) {
    SCOPED_TRACE(name);
    EXPECT_FALSE(passes_to_petsc(name));
    const std::string inner = folder.write("inner.yml", name + ": 'x #'\n");
    const std::string scene = folder.write("scene.yml", "options_file: inner.yml\n");
    const std::string classic = folder.write("scene.opt", "-" + name + " 'x #'\n");
    EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", scene}); }), inner + ":1");
    EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", classic}); }), "scene.opt:1");
    EXPECT_PRED2(contains, message_of([&] { input_of({"-" + name, "x"}); }), "option " + name + " = x (command line)");
    EXPECT_PRED2(contains, message_of([&] { input_of({}, {{name, "x", "r.h5:scene.yml", 3}}); }), "r.h5:scene.yml:3");
  }
}

// PETSc does not tell capitals from small letters. What it knows as its own and we do not stays out of its table.
TEST(PetscList, OtherNamesNeverReachPetsc) {
  for (const std::string name : {"Python", "LOG_VIEW", "Info", "TS_MONITOR", "dll_append", "alias", "beam_EI"}) {
    const Input input = input_of({"-" + name, "victim"});
    EXPECT_FALSE(any_contains(input.petsc_words, "victim")) << name;
    put_into_petsc(input);
    PetscBool found = PETSC_TRUE;
    ASSERT_EQ(PetscOptionsHasName(nullptr, nullptr, ("-" + name).c_str(), &found), 0);
    EXPECT_EQ(found, PETSC_FALSE) << name;
  }
}

TEST(PetscList, ValuesNameNoFilesAndNoViewers) {
  for (const Row& row : fixed_rows()) {
    if (!passes_to_petsc(row.name) || row.name == "skip_petscrc") continue;
    for (const char* value : {":victim", "ascii:victim", "draw", "python:x", "a/b", "../x", "x y", "$HOME", "a;b"}) {
      if (row.kind == Kind::text && std::string_view(value) == "draw") continue;  // a name of no integrator: later
      const std::string message = message_of([&] { input_of({"-" + std::string(row.name), value}); });
      EXPECT_PRED2(contains, message, std::string(row.name) + " = " + value);
    }
  }
}

TEST(PetscList, ViewersArePutWithoutAValue) {
  const Input on = input_of({"-ts_monitor", "true", "-log_view", "yes"}), off = input_of({"-ts_monitor", "false"});
  EXPECT_EQ(std::vector<std::string>(on.petsc_words.end() - 2, on.petsc_words.end()),
            (std::vector<std::string>{"-ts_monitor", "-log_view"}));
  EXPECT_FALSE(any_contains(off.petsc_words, "ts_monitor"));
}

TEST(PetscList, FilesDoNotSayThatFilesAreNotRead) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.write("scene.yml", "skip_petscrc: true\n");
  EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", scene}); }), "allowed only on the command line");
}

// --- .petscrc and PETSC_OPTIONS --------------------------------------------------------------------------------------

/// In a folder of its own, which is the home, too.
class Petscrc : public testing::Test {
 protected:
  Petscrc() {
    std::filesystem::create_directory(folder_.path("home"));
    std::filesystem::current_path(folder_.path(""));
    setenv("HOME", folder_.path("home").c_str(), 1);
  }
  ~Petscrc() override {
    std::filesystem::current_path(before_);
    setenv("HOME", home_.c_str(), 1);
  }
  const test::TemporaryFolder folder_;

 private:
  std::string before_ = std::filesystem::current_path(), home_ = getenv("HOME") == nullptr ? "" : getenv("HOME");
};

TEST_F(Petscrc, LaterPlacesWinAndEachOptionHasItsLine) {
  folder_.write("home/.petscrc", "-gravity 1\n-accuracy 1e-2\n");
  folder_.write(".petscrc", "# mine\n-gravity 2\n-train_speed 20\n");
  setenv("PETSC_OPTIONS", "-gravity 3 -load_speed 30 -ksp_rtol 1e-3 -da_grid_x 4", 1);
  const std::string scene = folder_.write("scene.yml", "train: {speed: 40}\n");
  const Input input = input_of({"-options_file", scene});
  EXPECT_EQ(input.entries.find("gravity")->value, "3");
  EXPECT_EQ(input.entries.find("accuracy")->where(), folder_.path("home/.petscrc") + ":2");
  EXPECT_EQ(input.entries.find("train_speed")->value, "40");
  EXPECT_EQ(input.entries.find("load_speed")->where(), "PETSC_OPTIONS");
  EXPECT_FALSE(input.entries.has("ksp_rtol"));
  EXPECT_EQ(input.notes,
            (std::vector<std::string>{
                "gravity = 1 (" + folder_.path("home/.petscrc") +
                    ":1) has no effect: gravity = 3 (PETSC_OPTIONS) overrides it",
                "accuracy = 1e-2 (" + folder_.path("home/.petscrc") + ":2) is in force: nothing overrides it",
                "gravity = 2 (.petscrc:2) has no effect: gravity = 3 (PETSC_OPTIONS) overrides it",
                "train_speed = 20 (.petscrc:3) has no effect: train_speed = 40 (" + scene + ":1) overrides it",
                "gravity = 3 (PETSC_OPTIONS) is in force: nothing overrides it",
                "load_speed = 30 (PETSC_OPTIONS) is in force: nothing overrides it",
                "ksp_rtol = 1e-3 (PETSC_OPTIONS) is ignored: Traverse does not read this option from there",
                "da_grid_x = 4 (PETSC_OPTIONS) is ignored: Traverse does not read this option from there"}));
  EXPECT_EQ(getenv("PETSC_OPTIONS"), nullptr) << "PETSc would read it again";
}

TEST_F(Petscrc, IsAsSafeAsAScene) {
  for (const std::string& name : dangerous) {
    folder_.write(".petscrc", "-" + name + " victim\n");
    const Input input = input_of({});
    EXPECT_FALSE(any_contains(input.petsc_words, "victim")) << name;
    EXPECT_PRED2(any_contains, input.notes, name + " = victim (.petscrc:1) is ignored");
  }
  folder_.write(".petscrc", "-log_view :victim\n");
  EXPECT_PRED2(contains, message_of([] { input_of({}); }), "log_view = :victim (.petscrc:1)");
}

TEST_F(Petscrc, YamlOfTheEnvironmentIsReadToo) {
  setenv("PETSC_OPTIONS_YAML", "train: {speed: 7}\n", 1);
  EXPECT_EQ(input_of({}).entries.find("train_speed")->value, "7");
  EXPECT_EQ(getenv("PETSC_OPTIONS_YAML"), nullptr);
}

TEST_F(Petscrc, SkippedFilesAreNotRead) {
  folder_.write(".petscrc", "not an option\n");
  EXPECT_PRED2(contains, message_of([] { input_of({}); }), ".petscrc:1");
  EXPECT_TRUE(input_of({"-skip_petscrc"}).notes.empty());
}

TEST(Table, OptionsOfTsWithoutEffect) {
  Entries entries;
  entries.set({"ts_rk_type", "4", "s.yml", 7});
  ASSERT_EQ(PetscOptionsSetValue(nullptr, "-ts_rk_type", "4"), 0);
  EXPECT_PRED2(any_contains, notes_on_unused(entries), "ts_rk_type = 4 (s.yml:7) has no effect in this scene");
  ASSERT_EQ(PetscOptionsClearValue(nullptr, "-ts_rk_type"), 0);
  Entries tolerance;
  tolerance.set({"ts_rtol", "1e-6", "command line", 0});
  EXPECT_PRED2(any_contains, notes_on_unused(tolerance),
               "ts_rtol = 1e-6 (command line) has no effect with this ts_adapt_type");
  tolerance.set({"ts_adapt_type", "ladder", "command line", 0});
  EXPECT_TRUE(notes_on_unused(tolerance).empty());
  tolerance.set({"ts_atol", "1e-6", "command line", 0});
  EXPECT_PRED2(any_contains, notes_on_unused(tolerance),
               "ts_atol = 1e-6 (command line) has no effect with this ts_adapt_type");
}

TEST(Table, OptionsOfVehiclesWithoutAny) {
  Entries entries;
  entries.set({"load_speed", "40", "s.yml", 3});
  entries.set({"train_speed", "40", "command line", 0});
  entries.set({"contact_impact_steps", "5", "s.yml", 4});
  EXPECT_PRED2(any_contains, notes_on_unused(entries),
               "train_speed = 40 (command line) has no effect: no vehicles run in this scene");
  EXPECT_EQ(notes_on_unused(entries).size(), 2U);
  entries.set({"vehicle_car_file", "car.yml", "s.yml", 5});
  EXPECT_TRUE(notes_on_unused(entries).empty());
}

TEST(Table, NoneOfOursStandsInPetscsTable) {
  Input input = input_of({"-train_speed", "40", "-ts_dt", "0.1"});
  put_into_petsc(input);
  PetscBool found = PETSC_TRUE;
  ASSERT_EQ(PetscOptionsHasName(nullptr, nullptr, "-train_speed", &found), 0);
  EXPECT_EQ(found, PETSC_FALSE);
  ASSERT_EQ(PetscOptionsHasName(nullptr, nullptr, "-ts_dt", &found), 0);
  EXPECT_EQ(found, PETSC_TRUE);
  EXPECT_EQ(in_force().find("train_speed")->value, "40");
  ASSERT_EQ(PetscOptionsClear(nullptr), 0);
}

}  // namespace
}  // namespace traverse::options
