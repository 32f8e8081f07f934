// The stretch of the bridge that moves. Ahead of the train nothing has happened yet; behind it vibrations die away.
// Stages and steps leave out what is at rest: spans that do not touch their neighbours whole, a continuous bridge node
// by node, where waves are followed until they are below the tolerance. What is put to rest takes its energy with it,
// which is counted.
#pragma once

#include <array>
#include <vector>

#include "base/archive.hpp"
#include "structure/beam_motion.hpp"

namespace traverse::structure {

class RestWindow {
 public:
  /// tolerance: of the largest displacement and velocity so far of each unknown of a column; below it nodes are at
  /// rest. `watched`: the columns of probes, which rest only below `quiet`. rest: displacements at rest, this rank's,
  /// null for 0; kept.
  RestWindow(const beam::Beam& beam, const BeamOperator& op, double tolerance, std::vector<int> watched,
             const double* rest);

  static constexpr double quiet = 1e-9;

  /// Collective. From a state: only what moves is in the window, and what lies between `low` and `high` (columns; where
  /// parts of the beam do not touch, borders of parts).
  void begin(BeamMotion& motion, double* v, double* w, int low, int high);
  /// Collective. Wider, for a step with loads between the columns `low` and `high`, whose effect dies out within
  /// `reach` columns.
  void open(int low, int high, int reach);
  /// Collective. Narrower at both ends, after the step.
  void close(BeamMotion& motion, double* v, double* w);

  /// J, put to rest so far, this rank's share.
  double energy_left() const { return energy_left_; }
  double tolerance() const { return tolerance_; }
  /// Columns: [first, past).
  int first() const { return first_; }
  int past() const { return past_; }
  void keep(base::Archive& archive) {
    archive.same(first_, past_, low_, high_, largest_, steps_);
    archive.sum(energy_left_);
  }

 private:
  void note_largest(const double* v, const double* w, int first, int past);
  bool rests(int first, int past, const double* v, const double* w) const;
  void agree();
  int local(int column) const;

  const beam::Beam& beam_;
  bool parts_, shared_;
  double tolerance_;
  std::vector<int> watched_;  // ascending
  const double* rest_;
  int first_ = 0, past_ = 0;  // columns: [first, past)
  int low_ = 0, high_ = 0;    // with loads in the last step
  struct Largest {
    double displacement = 0.0, rate = 0.0;
  };
  std::array<Largest, beam::kinds> largest_{};  // of each unknown of a column
  double energy_left_ = 0.0;                    // this rank's share
  int steps_ = 0;
};

}  // namespace traverse::structure
