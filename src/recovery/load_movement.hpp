// The moving loads of two successive instants: where they were and are, and which stations they have passed.
#pragma once

#include <span>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"

namespace traverse::recovery {

/// A load has passed a station: it is on the other side than at the previous instant.
struct StationPassage {
  std::size_t station = 0;  // its index
  double time = 0.0;        // s, if the load has moved uniformly
};

class LoadMovement {
 public:
  /// A load that has moved since the previous instant: its previous and its present values and positions, m. A load
  /// that has entered or left the beam since then has one position outside, and the same value in both.
  struct Moved {
    ElementLoad from, to;
    double x_from, x_to;
  };

  /// Of the stations of `recovery`, which must outlive this object.
  explicit LoadMovement(const Recovery& recovery);

  /// The next instant, with all loads of Recovery::evaluate(). The times must be ascending; a repeated time replaces
  /// the loads.
  void advance(double t, const std::vector<ElementLoad>& loads);

  /// s since the previous instant; 0: there is none.
  double interval() const { return interval_; }
  const std::vector<Moved>& moved() const { return moved_; }
  /// By station, then by time.
  std::span<const StationPassage> passages() const { return passages_; }
  void keep(base::Bytes& bytes) { bytes(time_, loads_, first_); }

 private:
  void record_moved(const std::vector<ElementLoad>& loads);
  void record_passages();

  const Recovery& recovery_;
  double time_ = 0.0, interval_ = 0.0;
  bool first_ = true;
  std::vector<ElementLoad> loads_;  // of the latest instant
  std::vector<Moved> moved_;
  std::vector<char> found_;         // for each of loads_: whether it is on the beam at the present instant too
  std::vector<std::size_t> along_;  // the stations in ascending order of x
  std::vector<StationPassage> passages_;
};

}  // namespace traverse::recovery
