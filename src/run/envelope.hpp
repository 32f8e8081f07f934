// The least and the greatest response of every probe over a run, for envelopes along the bridge.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"
#include "results/recorder.hpp"

namespace traverse::app {

/// Where a force passes a probe its shear jumps: the values on both sides follow from the two instants before and the
/// two behind by straight lines, and count too where these serve.
class Envelope {
 public:
  Envelope() = default;
  /// passages: of each probe the times (s, ascending) at which something passes it; empty where these are not known.
  explicit Envelope(std::vector<std::vector<double>> passages) : passages_(std::move(passages)) {}

  /// An instant not before the last one.
  void add(double t, std::span<const beam::Response> probes);
  /// /envelope/deflection, acceleration, moment, shear, each [p,2]: least and greatest; each with _time (s);
  /// moment_shear and shear_moment: the shear, and the moment, at these instants.
  std::vector<results::Recorder::Dataset> datasets() const;
  void keep(base::Bytes& bytes) { bytes(probes_); }

 private:
  static constexpr std::size_t quantities_ = 4;
  enum : std::size_t { deflection_, acceleration_, moment_, shear_ };
  struct Extreme {
    double value = 0.0, time = std::numeric_limits<double>::quiet_NaN();
    double other = 0.0;  // of a moment the shear, of a shear the moment
  };
  struct Forces {
    double time = 0.0, moment = 0.0, shear = 0.0;
    /// By a straight line through this one and another.
    Forces at(double t, const Forces& through) const;
  };
  struct Probe {
    std::array<Extreme, quantities_> least{}, greatest{};
    std::array<Forces, 2> before{};  // the latest instants, the last one at the end
    std::size_t instants = 0;        // since the last passage
    std::size_t passed = 0;          // of its passages
    std::optional<Forces> ahead;     // of a passage: as it comes; what is behind it is not known yet
  };
  void note(Probe& probe, std::size_t quantity, double value, double t, double other) const;
  void note_forces(Probe& probe, const Forces& now) const;
  /// Whether the instant is on one side of all passages.
  bool note_sides(Probe& probe, const std::vector<double>& passages, const Forces& now) const;

  std::vector<std::vector<double>> passages_;
  std::vector<Probe> probes_;
};

}  // namespace traverse::app
