// What a run says of the limits that the user has set.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "traverse/options/verdict_limit.hpp"

namespace traverse::results {

/// The greatest value that a run has seen of a quantity, or why there is none.
struct EvaluatedQuantity {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double value = unknown;  // a magnitude
  double time = unknown;   // s
  double x = unknown;      // m, of a place on the bridge
  std::string thing{};     // what else it belongs to: "vehicle 3, rear_wheel"; "train A3 at 64 m/s (230 km/h)"
  std::string why{};       // it is not known; empty: it is

  /// "x = 12.5 m", "vehicle 3, rear_wheel"
  std::string place() const;
};

struct Verdict {
  options::VerdictLimit limit;
  std::string unit;
  EvaluatedQuantity found;
  std::size_t runs = 1, broken_in = 0;  // runs that know the quantity, and those that break the limit

  bool judged() const { return found.why.empty(); }
  bool kept() const { return found.value <= limit.value; }
  /// What is left to the limit, over it: below 0 where it is broken.
  double margin() const { return 1.0 - found.value / limit.value; }
  /// "kept", "broken" or "not judged".
  std::string word() const;
};

/// One line each, and behind them what is unusual in their scene.
void print_verdicts(const std::vector<Verdict>& verdicts, const std::vector<std::string>& unusual);

/// What many runs have found of each limit.
struct Judged {
  std::vector<options::VerdictLimit> limits;
  std::vector<double> value, x;  // [runs][limits], EvaluatedQuantity::unknown where a run does not know; m
  std::vector<std::string> why;  // [limits], of runs that do not know

  Judged() = default;
  Judged(const std::vector<options::VerdictLimit>& by, std::size_t runs)
      : limits(by), value(runs * by.size(), EvaluatedQuantity::unknown), x(value), why(by.size()) {}
};
/// A verdict on each limit by the run with the greatest value; run_text(i) names run i.
std::vector<Verdict> worst_of(const Judged& judged, const std::function<std::string(std::size_t)>& run_text);

/// Into /verdicts of the file.
void record_verdicts(Recorder& recorder, const std::vector<Verdict>& verdicts);

}  // namespace traverse::results
