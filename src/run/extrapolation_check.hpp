// What a run does after the trial runs that chose its step have ended, and these have not seen: springs, supports and
// sleepers that touch or let go for the first time, and curves that bend more within a step than before.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "run/response_extremes.hpp"
#include "structure/nonlinear_foundation.hpp"
#include "train/fleet.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::app {

class ExtrapolationCheck {
 public:
  /// Times what curves bend before, up to which that is no more than runs and their beginnings differ by.
  static constexpr double alike = 2.0;

  ExtrapolationCheck() = default;  // trial runs have seen all
  /// until: when they ended, s of the run. beam: null where there is none.
  ExtrapolationCheck(double until, const train::Fleet& fleet, const beam::BeamModel* beam);

  /// Whether instants need what vehicles do inside.
  bool looks_at_springs() const { return !springs_.empty(); }
  /// The next instant, before `peaks` has it.
  void add(double t, const train::Fleet& fleet, const structure::NonlinearForces& foundation, ResponseExtremes& peaks);

  /// What was first to touch or to let go as it had not done before, and when, in words; "" where nothing was.
  const std::string& new_event() const { return new_event_; }
  /// How many times as much as before curves bend, Bends::times; 0 where nothing came after.
  double roughness(const ResponseExtremes& peaks) const {
    return bends_before_ ? peaks.roughness().times(*bends_before_) : 0.0;
  }

  void keep(base::Bytes& bytes) { bytes(seen_, bends_before_, new_event_); }

 private:
  /// What lets go: parts of a kind, as the springs of all vehicles of a type are, count as one.
  struct Part {
    std::size_t kind = 0;
    std::string name;
  };
  struct Spring {
    int vehicle = 0, spring = 0;  // of the fleet, of its mechanism
    bool torsion = false;
    Part part;
  };
  struct Support {
    std::size_t row = 0, place = 0;  // of foundation_kinds, of its points or spans
    Part part;
  };
  void add_springs(const train::Fleet& fleet);
  void add_supports(const beam::BeamModel& beam);
  void see(double t, const Part& part, double force);

  double until_ = std::numeric_limits<double>::infinity();
  std::vector<Spring> springs_;
  std::vector<Support> supports_;
  Part sleepers_;                    // those over a gap
  std::vector<unsigned char> seen_;  // of each kind, one bit each: loose, pressed, pulled
  std::optional<SecondDifference> bends_before_;
  std::string new_event_;
};

}  // namespace traverse::app
