// What is promised of a run's peaks, and when that is withdrawn.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "run/quantity.hpp"

namespace traverse::app {

/// What is said of one quantity's peak.
struct ErrorEstimate {
  bool present = false;   // in this scene
  bool kept = false;      // promised: the expected error is not above the wanted one
  double expected = 0.0;  // relative to the peak
  std::string why_not;    // where it is not promised

  void keep(base::Bytes& bytes) { bytes(present, kept, expected, why_not); }
};

/// A row of -accuracy_report, printed or not. wanted, error: relative. Whether the promise is not broken.
bool report_row(const std::string& name, const ErrorEstimate& promise, double wanted, double error, bool prints);
/// Its head. against: what the run is compared with; of: what the rows are.
void report_head(const std::string& against, const std::string& of);

/// The note that a quantity's peak is not promised, and why.
std::string not_promised(Quantity quantity, const ErrorEstimate& promise);

/// What is promised where there is no bridge: largest errors at any instant, over the largest way from the start or the
/// largest force.
enum AloneQuantity : std::size_t { position, joint_force, contact_force, alone_quantities };
inline constexpr std::array<const char*, alone_quantities> alone_names = {"position", "joint force", "contact force"};

struct Accuracy {
  bool measured = false;  // false: nothing was open, or there is nothing to measure
  std::array<ErrorEstimate, quantities> estimates;
  std::array<ErrorEstimate, alone_quantities> alone;  // where there is no bridge
  ErrorEstimate frequencies;                          // of natural modes
  bool lost_contact = false;                          // wheels did in trial runs
  static constexpr double the_end = std::numeric_limits<double>::infinity();
  double seen_until = the_end;  // s of the run, until which trial runs went
  /// After the run, in which wheels lost contact at these times, s: where no trial run has seen some of them, nothing
  /// is promised any more. Says so, or "".
  std::string withdrawn(const std::vector<double>& losses);
  /// After the run, in which something touched or let go that trial runs have not seen, in words: nothing is promised
  /// any more. Says so, or "".
  std::string invalidate_by_new_event(const std::string& what);
  /// After the run, in which curves bend within steps so many times as much as trial runs have seen: errors are larger,
  /// by the square of that, and what is above `wanted` then is not promised any more. Says so, or "".
  std::string invalidate_if_rougher(double times, double wanted);
  /// After a run to its end: the same of low-passed accelerations, where their peak is within the unsettled end of the
  /// run.
  std::string invalidate_at_end(bool unsettled);
  void promise_nothing();
  /// Promises no more than both do, with the larger error.
  void merge(const Accuracy& other);
  bool promises_something() const;  // of a bridge
  /// Name in the results file and expected error of each quantity that is promised.
  std::vector<std::pair<std::string, double>> expected() const;
  double seconds = 0.0;  // wall time that choosing took

  void keep(base::Bytes& bytes) { bytes(measured, estimates, alone, frequencies, lost_contact, seen_until, seconds); }
};

}  // namespace traverse::app
