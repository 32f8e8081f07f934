// Sample mean, standard deviation and quantiles over the chosen axes; the confidence intervals of quantiles are
// distribution-free, from order statistics and the binomial distribution.
#include "results/study_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "results/terminal.hpp"

namespace traverse::results {
namespace {

constexpr std::size_t max_printed = 12;  // groups
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The probability of exactly k successes in n.
double binomial(std::size_t n, std::size_t k, double p) {
  const auto N = static_cast<double>(n), K = static_cast<double>(k);
  return std::exp(std::lgamma(N + 1.0) - std::lgamma(K + 1.0) - std::lgamma(N - K + 1.0) + K * std::log(p) +
                  (N - K) * std::log1p(-p));
}

/// "12.3", and "?" for an unknown value.
std::string number_text(double value) { return std::isnan(value) ? "?" : fmt::format("{:.4g}", value); }

/// "12.3 [12.1, 12.6]".
std::string with_interval(double scale, double value, double low, double high) {
  return fmt::format("{} [{}, {}]", number_text(scale * value), number_text(scale * low), number_text(scale * high));
}

}  // namespace

RankInterval quantile_ranks(std::size_t n, double p, double confidence) {
  const double side = 0.5 * (1.0 - confidence);
  RankInterval ranks{0, n + 1};
  double below = 0.0;  // the probability that at most k samples are below the quantile
  for (std::size_t k = 0; k <= n; ++k) {
    below += p < 1.0 ? binomial(n, k, p) : 0.0;
    if (below <= side) ranks.lower = k + 1;
    if (below >= 1.0 - side) {
      ranks.upper = k + 1;
      break;
    }
  }
  ranks.upper = std::min(ranks.upper, n + 1);
  return ranks;
}

double quantile(const std::vector<double>& ascending, double p) {
  const double position = p * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (position - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

StudyStatistics::StudyStatistics(const StudyTable& table) : table_(table) {
  const options::Study& study = table.study();
  if (study.over.empty()) return;
  const auto is_averaged = [&](std::size_t axis) {
    return std::find(study.over.begin(), study.over.end(), axis) != study.over.end();
  };
  for (const options::StudyDimension& dimension : study.dimensions)
    if (!is_averaged(dimension.axis)) dimensions_.push_back(&dimension);
  std::map<std::vector<std::size_t>, std::size_t> known;  // positions on the other axes
  for (std::size_t run = 0; run < study.runs(); ++run) {
    std::vector<std::size_t> position;
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      if (!is_averaged(axis)) position.push_back(study.place(run, axis));
    const auto [group, is_new] = known.try_emplace(position, groups_.size());
    if (is_new) groups_.emplace_back();
    groups_[group->second].push_back(run);
  }
}

StudyStatistics::Numbers StudyStatistics::of(std::size_t group, const StudyTable::Column& column,
                                             std::size_t probe) const {
  const options::Study& study = table_.study();
  std::vector<double> samples;
  for (const std::size_t run : groups_[group])
    if (const double value = column.values[run * column.width + probe]; !std::isnan(value)) samples.push_back(value);
  std::sort(samples.begin(), samples.end());
  Numbers numbers;
  numbers.samples = samples.size();
  const std::vector<double> none(study.quantiles.size(), unknown);
  numbers.mean = numbers.deviation = unknown;
  numbers.quantile = numbers.low = numbers.high = none;
  if (samples.empty()) return numbers;
  const auto n = static_cast<double>(samples.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : samples) sum += value;
  numbers.mean = sum / n;
  for (const double value : samples) squares += (value - numbers.mean) * (value - numbers.mean);
  if (samples.size() > 1) numbers.deviation = std::sqrt(squares / (n - 1.0));
  for (std::size_t q = 0; q < study.quantiles.size(); ++q) {
    numbers.quantile[q] = quantile(samples, study.quantiles[q]);
    const RankInterval ranks = quantile_ranks(samples.size(), study.quantiles[q], study.confidence);
    if (ranks.lower > 0) numbers.low[q] = samples[ranks.lower - 1];
    if (ranks.upper <= samples.size()) numbers.high[q] = samples[ranks.upper - 1];
  }
  return numbers;
}

std::vector<Recorder::Dataset> StudyStatistics::datasets() const {
  std::vector<Recorder::Dataset> sets;
  if (groups_.empty()) return sets;
  const options::Study& study = table_.study();
  const std::string folder = "/study/statistics/";
  const std::size_t g = groups_.size(), k = study.quantiles.size();
  for (const options::StudyDimension* dimension : dimensions_) {
    std::vector<double> values;
    for (const auto& runs : groups_) values.push_back(study.value(runs.front(), *dimension));
    sets.push_back({folder + dimension->name(), {g}, std::move(values), dimension->unit});
  }
  sets.push_back({folder + "quantiles", {k}, study.quantiles, "1"});
  for (const StudyTable::Column& column : table_.columns()) {
    if (!column.what->for_people) continue;
    std::vector<double> samples, mean, deviation, quantiles, low, high;
    for (std::size_t group = 0; group < g; ++group)
      for (std::size_t probe = 0; probe < column.width; ++probe) {
        const Numbers numbers = of(group, column, probe);
        samples.push_back(static_cast<double>(numbers.samples));
        mean.push_back(numbers.mean);
        deviation.push_back(numbers.deviation);
        quantiles.insert(quantiles.end(), numbers.quantile.begin(), numbers.quantile.end());
        low.insert(low.end(), numbers.low.begin(), numbers.low.end());
        high.insert(high.end(), numbers.high.begin(), numbers.high.end());
      }
    std::vector<std::size_t> shape = {g};
    for (const std::size_t size : column.shape()) shape.push_back(size);
    std::vector<std::size_t> with_quantiles = shape;
    with_quantiles.push_back(k);
    const std::string name = folder + column.what->name;
    sets.push_back({name + "_samples", shape, std::move(samples), "1"});
    sets.push_back({name + "_mean", shape, std::move(mean), column.what->unit});
    sets.push_back({name + "_deviation", shape, std::move(deviation), column.what->unit});
    sets.push_back({name + "_quantile", with_quantiles, std::move(quantiles), column.what->unit});
    sets.push_back({name + "_quantile_low", with_quantiles, std::move(low), column.what->unit});
    sets.push_back({name + "_quantile_high", with_quantiles, std::move(high), column.what->unit});
  }
  return sets;
}

void StudyStatistics::print() const {
  if (groups_.empty()) return;
  const options::Study& study = table_.study();
  std::string names;
  for (const options::StudyDimension& d : study.dimensions)
    if (std::find(study.over.begin(), study.over.end(), d.axis) != study.over.end())
      names += (names.empty() ? "" : ", ") + d.name();
  fmt::print("statistics over {}: mean, deviation{}; each at the probe where it is largest\n", names,
             study.quantiles.empty() ? "" : fmt::format(", quantiles [within, with {:g} %]", 100.0 * study.confidence));
  const struct {
    const char *label, *column;
    const EngineeringUnit& unit;
  } rows[] = {{"deflection", "peak_deflection", engineering_unit("deflection")},
              {"acceleration", "peak_acceleration", engineering_unit("acceleration")},
              {"moment", "peak_moment", engineering_unit("moment")},
              {"least wheel force", "least_wheel_force", engineering_unit("force")},
              {"greatest wheel force", "greatest_wheel_force", engineering_unit("force")}};
  for (std::size_t group = 0; group < std::min(groups_.size(), max_printed); ++group) {
    std::string point;
    for (const options::StudyDimension* d : dimensions_)
      point +=
          fmt::format("{}{} {:.6g}", point.empty() ? "" : ", ", d->name(), study.value(groups_[group].front(), *d));
    if (!point.empty()) fmt::print("  at {}\n", point);
    for (const auto& row : rows) {
      const StudyTable::Column* column = table_.find(row.column);
      if (column == nullptr) continue;
      Numbers largest;
      for (std::size_t probe = 0; probe < column->width; ++probe)
        if (Numbers numbers = of(group, *column, probe); probe == 0 || numbers.mean > largest.mean)
          largest = std::move(numbers);
      if (largest.samples == 0) continue;
      fmt::print("  {:<22}{:.4g}, {} {}", row.label, row.unit.factor * largest.mean,
                 number_text(row.unit.factor * largest.deviation), row.unit.name);
      for (std::size_t q = 0; q < study.quantiles.size(); ++q)
        fmt::print("   {:g} %: {}", 100.0 * study.quantiles[q],
                   with_interval(row.unit.factor, largest.quantile[q], largest.low[q], largest.high[q]));
      fmt::print("\n");
    }
  }
  if (groups_.size() > max_printed) fmt::print("  and {} more in the results file\n", groups_.size() - max_printed);
}

}  // namespace traverse::results
