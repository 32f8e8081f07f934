// The stretches of the bridge that move, one around each train. Ahead of a train nothing has happened yet; behind it
// vibrations die away.
// Stages and steps leave out what is at rest: spans that do not touch their neighbours whole, a continuous bridge node
// by node, where waves are followed until they are below the tolerance. What is put to rest takes its energy with it,
// which is counted.
#pragma once

#include <array>
#include <vector>

#include "base/archive.hpp"
#include "structure/beam_motion.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

class ActiveWindow {
 public:
  /// tolerance: of the largest displacement and velocity so far of each unknown of a column; below it nodes are at
  /// rest. `watched`: the columns of probes, which rest only below `quiet`. rest: displacements at rest, this rank's,
  /// null for 0; kept.
  ActiveWindow(const beam::Beam& beam, const BeamOperator& op, double tolerance, std::vector<int> watched,
               const double* rest);

  static constexpr double quiet = 1e-9;

  /// Collective. From a state: only what moves is in the window, and what is loaded (columns, as merge() leaves them;
  /// where parts of the beam do not touch, whole parts).
  void begin(BeamMotion& motion, double* v, double* w, const std::vector<Range>& loaded);
  /// Collective. Wider, for a step with loads on these columns, whose effect dies out within `reach` columns.
  void open(const std::vector<Range>& loaded, int reach);
  /// Collective. Narrower at both ends of each stretch, after the step. On one rank a stretch with several loads is
  /// parted where it rests between them.
  void close(BeamMotion& motion, double* v, double* w);

  /// J, put to rest so far, this rank's share.
  double energy_left() const { return energy_left_; }
  double tolerance() const { return tolerance_; }
  /// Columns, as merge() leaves them.
  const std::vector<Range>& moving() const { return moving_; }
  void keep(base::Archive& archive) {
    archive.same(moving_, loaded_, reach_, largest_, steps_);
    archive.sum(energy_left_);
  }

 private:
  void record_largest(const double* v, const double* w, int first, int past);
  bool rests(int first, int past, const double* v, const double* w) const;
  void agree();
  int next(int node) const;
  int previous(int node) const;
  bool is_loaded_in(const Range& range, const Range& load) const {
    return load.first >= range.first && load.past <= range.past;
  }
  Range trimmed(const Range& range, const double* v, const double* w) const;
  void agree_on_ends();
  void part(BeamMotion& motion, double* v, double* w);
  Range longest_rest(Range gap, const double* v, const double* w) const;
  int local(int column) const;

  const beam::Beam& beam_;
  bool parts_, shared_;
  double tolerance_;
  std::vector<int> watched_;  // ascending
  const double* rest_;
  std::vector<Range> moving_;  // columns
  std::vector<Range> loaded_;  // in the last step
  int reach_ = 0;
  std::vector<Range> parted_;  // of a step
  std::vector<int> ends_;
  struct Largest {
    double displacement = 0.0, rate = 0.0;
  };
  std::array<Largest, beam::kinds> largest_{};  // of each unknown of a column
  double energy_left_ = 0.0;                    // this rank's share
  int steps_ = 0;
};

}  // namespace traverse::structure
