// The ranges of the bridge that move, one around each train. Ahead of a train nothing has moved yet; behind it
// vibrations decay. Stages and time steps exclude the parts at rest: whole separate spans, and single nodes of a
// continuous bridge, where waves are included until they are below the tolerance. The energy of nodes that are set to
// rest is lost; it is added up.
#pragma once

#include <array>
#include <vector>

#include "base/archive.hpp"
#include "structure/beam_motion.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

class ActiveWindow {
 public:
  /// Motions below the tolerance are set to rest. probes: columns with a tolerance of their own. rest: displacements at
  /// rest of this rank's unknowns, null for 0; the pointer is stored.
  ActiveWindow(const beam::Beam& beam, const BeamOperator& op, const WindowTolerance& tolerance,
               std::vector<int> probes, const double* rest);

  static constexpr double quiet = 1e-9;

  /// Collective. Sets the window from a state: it contains the moving and the loaded ranges of columns, as merge()
  /// returns them. If the beam has connected parts, it contains whole parts.
  void begin(BeamMotion& motion, double* v, double* w, const std::vector<Range>& loaded);
  /// Collective. Extends the window for a step with loads on these columns, whose effect is negligible outside `reach`
  /// columns.
  void open(const std::vector<Range>& loaded, int reach);
  /// Collective. Sets to rest what is quiet after the step: separate parts, one by one; of connected parts both ends of
  /// each range, and on one rank also the nodes between several loads.
  void close(BeamMotion& motion, double* v, double* w);

  /// Energy lost so far by setting nodes to rest, J, this rank's share.
  double energy_left() const { return energy_left_; }
  void forget_energy_left() { energy_left_ = 0.0; }
  double tolerance() const { return tolerance_.elsewhere; }
  /// The moving ranges of columns, as merge() returns them.
  const std::vector<Range>& moving() const { return moving_; }

  // Several ranks, each with the window of other trains on a bridge of its own (coupling/train_sharing.hpp):

  /// The ranks that compare their largest motions; MPI_COMM_NULL: this rank is alone.
  void beside(MPI_Comm comm) { beside_ = comm; }
  /// Adds ranges of columns that this rank steps from now on, or removes ranges that it does not step any more.
  void add(const std::vector<Range>& columns);
  void remove(const std::vector<Range>& columns);
  /// The moving parts with probes.
  std::vector<Range> probed() const;
  /// Calls use(double*, count) for what the windows of all ranks have in common.
  template <class Use>
  void exchange(Use use) {
    use(&largest_.front().displacement, 2 * largest_.size());
    double steps = steps_;
    use(&steps, 1);
    steps_ = static_cast<int>(steps);
  }

  void keep(base::Archive& archive) {
    archive.same(moving_, loaded_, reach_, largest_, steps_);
    archive.sum(energy_left_);
  }

 private:
  void record_largest(const double* v, const double* w, int first, int past);
  bool is_quiet(int first, int past, const double* v, const double* w) const;
  void share_largest();
  bool is_loaded_in(const Range& range, const Range& load) const {
    return load.first >= range.first && load.past <= range.past;
  }
  void close_parts(BeamMotion& motion, double* v, double* w);
  Range trimmed(const Range& range, const double* v, const double* w) const;
  void share_ends();
  void split(BeamMotion& motion, double* v, double* w);
  Range longest_quiet_range(Range gap, const double* v, const double* w) const;
  int local(int column) const;

  const beam::Beam& beam_;
  bool parts_, shared_;
  WindowTolerance tolerance_;
  std::vector<int> probe_columns_;  // ascending
  const double* at_rest_;
  std::vector<Range> moving_;  // columns
  std::vector<Range> loaded_;  // in the last step
  int reach_ = 0;
  std::vector<Range> split_;  // ranges of the next step, without the quiet ranges between them
  std::vector<char> quiet_;   // one for each part of the moving ranges
  std::vector<int> ends_;
  struct Largest {
    double displacement = 0.0, rate = 0.0;
  };
  std::array<Largest, beam::kinds> largest_{};  // largest motion of each unknown of a column
  double energy_left_ = 0.0;                    // J, this rank's share
  int steps_ = 0;
  MPI_Comm beside_ = MPI_COMM_NULL;
};

}  // namespace traverse::structure
