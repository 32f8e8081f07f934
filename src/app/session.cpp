// Starts and ends the libraries for a program that computes runs itself.
#include <slepceps.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/petsc.hpp"
#include "process_start.hpp"
#include "traverse/options/input.hpp"
#include "traverse/simulate.hpp"

namespace traverse {
namespace {

/// Hides an environment variable from PETSc during this object's lifetime; it may belong to the host program.
class HiddenVariable {
 public:
  explicit HiddenVariable(const char* name) : name_(name) {
    if (const char* value = std::getenv(name)) value_ = value;
    unsetenv(name_);
  }
  ~HiddenVariable() {
    if (value_) setenv(name_, value_->c_str(), 1);
  }
  HiddenVariable(const HiddenVariable&) = delete;
  HiddenVariable& operator=(const HiddenVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> value_;
};

}  // namespace

Session::Session(const std::vector<std::string>& petsc_words) {
  PetscBool running = PETSC_FALSE;
  base::check(SlepcInitialized(&running));
  starts_ = running == PETSC_FALSE;
  if (!starts_) return;
  std::vector<std::string> all = {"traverse", "-skip_petscrc", "true", "-options_left", "false"};
  all.insert(all.end(), petsc_words.begin(), petsc_words.end());
  options::Arguments words(std::move(all));
  const HiddenVariable text("PETSC_OPTIONS"), yaml("PETSC_OPTIONS_YAML");
  app::start_lightly();
  base::check(SlepcInitialize(words.argc(), words.argv(), nullptr, nullptr));
  app::started();
  base::check(PetscPopSignalHandler());  // signals belong to the host program
  base::check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
}

Session::~Session() {
  if (starts_) (void)SlepcFinalize();
}

}  // namespace traverse
