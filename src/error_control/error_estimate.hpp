// Error estimates of a run's peaks, and the conditions that invalidate them.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "run/response_extremes.hpp"

namespace traverse::error_control {

/// The error estimate of one quantity's peak.
struct ErrorEstimate {
  bool present = false;   // the quantity exists in this scene
  bool accepted = false;  // the expected error is not above the wanted one
  double expected = 0.0;  // relative to the peak
  std::string why_not;    // the reason if it is not accepted

  void keep(base::Bytes& bytes) { bytes(present, accepted, expected, why_not); }
};

/// Prints a row of -accuracy_report if `prints` is set. wanted, error: relative. False if an accepted estimate is
/// exceeded.
bool report_row(const std::string& name, const ErrorEstimate& estimate, double wanted, double error, bool prints);
/// Prints the head of the report. against: description of the run of comparison; of: heading of the names.
void report_head(const std::string& against, const std::string& of);

/// The note that a quantity has no accepted error estimate, with the reason.
std::string not_estimated(run::Quantity quantity, const ErrorEstimate& estimate);

/// Quantities of a scene without a bridge: largest errors at any instant, relative to the largest displacement from the
/// start or the largest force.
enum MultibodyQuantity : std::size_t { position, joint_force, contact_force, multibody_quantities };
inline constexpr std::array<const char*, multibody_quantities> multibody_names = {"position", "joint force",
                                                                                  "contact force"};

struct Accuracy {
  bool measured = false;  // false: mesh and step were prescribed, or the scene has no measurable quantity
  std::array<ErrorEstimate, run::quantities> estimates;
  std::array<ErrorEstimate, multibody_quantities> multibody;  // without a bridge
  ErrorEstimate frequencies;                                  // estimate for natural frequencies
  bool lost_contact = false;                                  // wheels lost contact in trial runs
  /// After a complete run: rejects the estimate of low-passed accelerations if their peak is within the unsettled end.
  /// Returns the note, or "".
  std::string invalidate_at_end(bool unsettled);
  void reject_all();
  /// Accepts an estimate only if both do, with the larger error.
  void merge(const Accuracy& other);
  /// The expected errors in words, and the quantities of a scene with a bridge that have none, a line each.
  std::vector<std::string> lines() const;
  /// Name in the results file and expected error of each accepted estimate.
  std::vector<std::pair<std::string, double>> expected() const;
  double seconds = 0.0;  // wall time of the choice

  void keep(base::Bytes& bytes) { bytes(measured, estimates, multibody, frequencies, lost_contact, seconds); }
};

}  // namespace traverse::error_control
