// The rows of a screen, one for each bridge: their columns, and what governs. Nothing is kept for each pair.
#pragma once

#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "screen/pair.hpp"

namespace traverse::screen {

/// The values of a pair in the results, in the order of a row.
struct PairColumn {
  const char* name;
  const char* unit;
  double (*of)(const Verdict& verdict);
};
inline constexpr PairColumn pair_columns[] = {
    {"ratio", "1", [](const Verdict& v) { return v.ratio; }},
    {"bound", "1", [](const Verdict& v) { return v.bound; }},
    {"permitted_speed", "m/s", [](const Verdict& v) { return v.permitted; }},
    {"governing_speed", "m/s", [](const Verdict& v) { return v.ratio_speed; }},
    {"exceeding_speeds", "1", [](const Verdict& v) { return v.exceeding; }},
    {"decided_by", "1", [](const Verdict& v) { return static_cast<double>(v.decided_by); }},
};
inline constexpr std::size_t pair_width = std::size(pair_columns);

/// The index of a column.
constexpr std::size_t pair_column(std::string_view name) {
  std::size_t index = 0;
  while (pair_columns[index].name != name) ++index;
  return index;
}

/// A row: the values of all formations, [column][formation].
std::vector<double> row_of(const std::vector<Verdict>& verdicts);

/// The pair with the largest ratio: of those that passages decided if there are any, otherwise of all.
class Governing {
 public:
  void add(double other, double ratio, bool exact);
  double other() const { return other_; }  // index of the bridge or formation; NaN: none
  double ratio() const { return ratio_; }
  bool exact() const { return exact_; }

 private:
  double other_ = Verdict::unknown, ratio_ = Verdict::unknown;
  bool exact_ = false;
};

/// Sums and extremes of the rows so far.
class Totals {
 public:
  Totals(std::size_t bridges, std::size_t formations) : of_bridge_(bridges), of_formation_(formations) {}
  void add(std::size_t bridge, const std::vector<double>& row);

  const std::vector<Governing>& of_bridges() const { return of_bridge_; }
  const std::vector<Governing>& of_formations() const { return of_formation_; }
  double by_bound() const { return by_bound_; }  // numbers of pairs
  double by_passages() const { return by_passages_; }
  double restricted() const { return restricted_; }  // below the speeds of line and formation
  double not_run() const { return not_run_; }

 private:
  std::vector<Governing> of_bridge_, of_formation_;
  double by_bound_ = 0.0, by_passages_ = 0.0, restricted_ = 0.0, not_run_ = 0.0;
};

/// A digest of everything that the values depend on: only rows of the same problem can be continued.
std::string problem_digest(const std::vector<Bridge>& stock, const std::vector<Formation>& fleet,
                           const std::vector<double>& speeds, int modes, int parts, double samples);
/// A number below 2^53 that depends on all values of a row.
double row_digest(const std::vector<double>& row);

}  // namespace traverse::screen
