// Starts the program in a separate process group with a clean MPI environment and a limit of processor time, collects
// its output, and checks exit status and messages.
#include "support/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "support/folders.hpp"

namespace traverse::test {
namespace {

using Clock = std::chrono::steady_clock;

/// The variables of this process without the variables by which Open MPI marks a process as part of a run.
std::vector<std::string> clean_environment() {
  std::vector<std::string> variables;
  for (char** v = environ; *v != nullptr; ++v) {
    const std::string variable = *v;
    const auto starts = [&](const char* prefix) { return variable.rfind(prefix, 0) == 0; };
    if (!starts("OMPI_") && !starts("PMIX_") && !starts("ORTE_") && !starts("PETSC_OPTIONS"))
      variables.push_back(variable);
  }
  // A waiting rank yields the processor to other processes, on a busy machine possibly to the rank for which it waits.
  variables.insert(variables.end(),
                   {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "OMPI_MCA_pml=ob1",
                    "OMPI_MCA_btl=self,vader", "OMPI_MCA_mpi_yield_when_idle=1", "HWLOC_COMPONENTS=-gl,-opencl"});
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

Child::Child(std::vector<std::string> command, const std::string& folder) {
  const std::string words = "ulimit -S -t 300; cd \"$0\" && exec \"$@\"";
  command.insert(command.begin(), {"/bin/sh", "-c", words, folder});
  std::vector<std::string> environment = clean_environment();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  const std::string out = streams_.path("out"), err = streams_.path("err");
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that a shell sets to be ignored in background processes have their default action here.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  sigset_t all;
  sigfillset(&all);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int status =
      posix_spawn(&pid_, "/bin/sh", &files, &attributes, pointers_to(command).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (status != 0) throw std::runtime_error("cannot start the program");
}

Child::~Child() {
  if (ended()) return;
  ::kill(-pid_, SIGKILL);
  waitpid(pid_, &state_, 0);
}

void Child::kill(int signal) const { ::kill(pid_, signal); }

bool Child::ended() {
  if (!ended_) ended_ = waitpid(pid_, &state_, WNOHANG) == pid_;
  return ended_;
}

std::string Child::written(const std::string& ending) const { return text_of(streams_.path(ending)); }

bool Child::wait_until(const std::function<bool()>& state, double seconds) {
  for (const auto start = Clock::now(); since(start) < seconds; pause()) {
    if (state()) return true;
    if (ended()) return false;
  }
  return false;
}

bool Child::wait_for(const std::string& text, double seconds) {
  return wait_until([&] { return written("out").find(text) != std::string::npos; }, seconds);
}

Outcome Child::wait(double seconds) {
  Outcome outcome;
  const auto start = Clock::now();
  while (!ended() && since(start) < seconds) pause();
  if (!ended()) {
    outcome.timed_out = true;
    ::kill(-pid_, SIGKILL);
    waitpid(pid_, &state_, 0);
    ended_ = true;
  }
  if (WIFEXITED(state_)) outcome.status = WEXITSTATUS(state_);
  if (WIFSIGNALED(state_)) outcome.signal = WTERMSIG(state_);
  outcome.timed_out |= outcome.signal == SIGXCPU || outcome.status == 128 + SIGXCPU;
  outcome.out = written("out");
  outcome.err = written("err");
  return outcome;
}

std::vector<std::string> Workplace::command(const std::vector<std::string>& words, int ranks) const {
  std::vector<std::string> command;
  if (ranks > 1) command = {"mpirun", "--oversubscribe", "-n", std::to_string(ranks)};
  command.insert(command.end(), {program_path(), "-options_file", "scene.yml"});
  command.insert(command.end(), words.begin(), words.end());
  return command;
}

Outcome Workplace::run(const std::vector<std::string>& words, int ranks, double seconds) const {
  return Child(command(words, ranks), folder()).wait(seconds);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> complaints(const Outcome& outcome) {
  std::vector<std::string> lines = lines_of(outcome.err);
  std::erase_if(lines, [](const std::string& l) { return l.find("ORTE_ERROR_LOG") != std::string::npos; });
  const auto rule =
      std::find_if(lines.begin(), lines.end(), [](const std::string& l) { return l.starts_with("----"); });
  std::vector<std::string> ours(
      lines.begin(),
      rule);  // here the text of mpirun begins, between rules; lines of the program may also follow it
  for (auto line = rule; line != lines.end(); ++line) {
    if (line->starts_with("traverse: ")) ours.push_back(*line);
  }
  return ours;
}

void expect_success(const Outcome& outcome) {
  EXPECT_FALSE(outcome.timed_out) << "it did not end\n" << outcome.out;
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
}

void expect_refusal(const Workplace& workplace, const Outcome& outcome, const std::vector<std::string>& parts) {
  ASSERT_FALSE(outcome.timed_out) << "it did not end\n" << outcome.out;
  EXPECT_EQ(outcome.signal, 0);
  EXPECT_NE(outcome.status, 0) << outcome.out;
  const std::vector<std::string> lines = complaints(outcome);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_TRUE(lines.front().starts_with("traverse: ")) << lines.front();
  for (const std::string& part : parts) {
    EXPECT_NE(lines.front().find(part), std::string::npos) << "no '" << part << "' in: " << lines.front();
  }
  EXPECT_EQ(outcome.out.find("summary"), std::string::npos) << outcome.out;
  EXPECT_FALSE(workplace.has("results")) << "a results folder was made";
}

const char* const two_spans = R"(beam:
  spans: [20.0, 20.0]
  elements_per_span: 4
  EI: 1.0e10
  EA: 1.0e10
  mass: 2000.0
support:
  types: [pinned, roller, roller]
)";

const char* const quarter_car = R"(vehicle:
  car:
    bodies:  [body, axle]
    joints:  [guide]
    springs: [suspension]
    wheels:  [wheel]
    drivers: [level]
    body:    {mass: 5000.0, inertia: 100.0, position: [0.0, 2.0]}
    axle:    {mass: 1000.0, inertia: 10.0, position: [0.0, 0.5]}
    guide:   {type: prismatic, bodies: [body, axle], point: [0.0, 0.5], axis: [0.0, 1.0]}
    suspension: {bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.5], stiffness: 1.6e6, damping: 1.0e4}
    wheel:   {body: axle, radius: 0.5, law: hertz, stiffness: 1.0e10}
    level:   {body: body, coordinate: phi}
train:
  vehicles: car
  speed: 40.0
)";

std::string small_scene() { return std::string(two_spans) + quarter_car + "ts_dt: 0.01\n"; }

}  // namespace traverse::test
