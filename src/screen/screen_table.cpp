// Collects rows of verdicts.
#include "screen/screen_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/digest.hpp"

namespace traverse::screen {

std::vector<double> row_of(const std::vector<Verdict>& verdicts) {
  std::vector<double> row;
  row.reserve(pair_width * verdicts.size());
  for (const PairColumn& column : pair_columns)
    for (const Verdict& verdict : verdicts) row.push_back(column.of(verdict));
  return row;
}

void Governing::add(double other, double ratio, bool exact) {
  const bool first = std::isnan(ratio_), better = exact != exact_ ? exact : ratio > ratio_,
             equal = exact == exact_ && ratio == ratio_ && other < other_;  // rows come in any order
  if (!first && !better && !equal) return;
  other_ = other;
  ratio_ = ratio;
  exact_ = exact;
}

void Totals::add(std::size_t bridge, const std::vector<double>& row) {
  const std::size_t formations = of_formation_.size();
  constexpr std::size_t ratio = pair_column("ratio"), exceeding = pair_column("exceeding_speeds"),
                        decided_by = pair_column("decided_by");
  const auto column = [&](std::size_t index, std::size_t formation) { return row[index * formations + formation]; };
  for (std::size_t f = 0; f < formations; ++f) {
    const auto by = static_cast<DecidedBy>(static_cast<int>(column(decided_by, f)));
    if (by == DecidedBy::nothing) {
      not_run_ += 1.0;
      continue;
    }
    const bool exact = by == DecidedBy::passages;
    (exact ? by_passages_ : by_bound_) += 1.0;
    if (column(exceeding, f) > 0.0) restricted_ += 1.0;
    of_bridge_[bridge].add(static_cast<double>(f), column(ratio, f), exact);
    of_formation_[f].add(static_cast<double>(bridge), column(ratio, f), exact);
  }
}

std::string problem_digest(const std::vector<Bridge>& stock, const std::vector<Formation>& fleet,
                           const std::vector<double>& speeds, int modes, int parts, double samples) {
  base::Digest digest;
  for (const Bridge& b : stock) {
    digest.add(b.name);
    digest.add(b.spans);
    digest.add(std::vector<double>{b.EI, b.mass, b.damping, b.speed, b.of_acceleration, b.of_deflection});
    if (b.eccentricity != 0.0) digest.add(std::vector<double>{b.eccentricity, b.GJ, b.polar_inertia});
  }
  for (const Formation& f : fleet) {
    digest.add(f.name);
    digest.add(f.loads);
    digest.add(f.distance);
    digest.add(std::vector<double>{f.speed});
  }
  digest.add(speeds);
  digest.add(std::vector<double>{static_cast<double>(modes), static_cast<double>(parts), samples});
  return fmt::format("{:016x}", digest.value());
}

double row_digest(const std::vector<double>& row) {
  base::Digest digest;
  digest.add(row);
  return static_cast<double>(digest.value() >> 11);
}

}  // namespace traverse::screen
