// Sobol' indices, elementary effects and derivatives from the rows of a study, with intervals by bootstrap.
#include "results/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/random_stream.hpp"
#include "base/sampling_design.hpp"
#include "results/study_statistics.hpp"
#include "results/terminal.hpp"

namespace traverse::results {
namespace {

using options::Sensitivity;
using Method = Sensitivity::Method;

constexpr std::size_t resamples = 400;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr double uncertain = 0.1;  // relative error from which on a derivative is marked

/// estimate(samples) for all samples, and its interval from samples drawn with replacement.
IndexEstimate bootstrap(std::size_t samples, double confidence, std::uint64_t seed,
                        const std::function<double(const std::vector<std::size_t>&)>& estimate) {
  std::vector<std::size_t> chosen(samples);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  IndexEstimate found;
  found.value = estimate(chosen);
  const base::RandomStream random(seed, "bootstrap");
  std::vector<double> drawn;
  for (std::size_t r = 0; r < resamples; ++r) {
    for (std::size_t s = 0; s < samples; ++s)
      chosen[s] = static_cast<std::size_t>(random.uniform(r * samples + s) * static_cast<double>(samples));
    drawn.push_back(estimate(chosen));
  }
  std::sort(drawn.begin(), drawn.end());
  found.low = quantile(drawn, 0.5 * (1.0 - confidence));
  found.high = quantile(drawn, 0.5 * (1.0 + confidence));
  return found;
}

/// Variance of the rows A and B of the chosen samples.
double variance(const std::vector<double>& a, const std::vector<double>& b, const std::vector<std::size_t>& chosen) {
  double sum = 0.0, squares = 0.0;
  for (const std::size_t s : chosen) {
    sum += a[s] + b[s];
    squares += a[s] * a[s] + b[s] * b[s];
  }
  const double n = 2.0 * static_cast<double>(chosen.size());
  return squares / n - (sum / n) * (sum / n);
}

const char* name_of(Method method) {
  return method == Method::sobol ? "sobol" : method == Method::morris ? "morris" : "local";
}

/// "0.123 [0.101, 0.145]".
std::string with_interval(double value, double low, double high) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", value, low, high);
}

}  // namespace

std::vector<SobolIndices> sobol_indices(const std::vector<double>& values, std::size_t factors, double confidence,
                                        std::uint64_t seed) {
  const std::size_t block = base::saltelli_block(factors), samples = values.size() / block;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<std::vector<double>> row(block, std::vector<double>(samples));  // centred: less scatter of the estimates
  for (std::size_t s = 0; s < samples; ++s)
    for (std::size_t k = 0; k < block; ++k) row[k][s] = values[s * block + k] - mean;
  const std::vector<double>&a = row.front(), &b = row.back();
  std::vector<SobolIndices> indices;
  for (std::size_t i = 0; i < factors; ++i) {
    const std::vector<double>& ab = row[1 + i];
    const auto part = [&](auto term) {
      return [&, term](const std::vector<std::size_t>& chosen) {
        double sum = 0.0;
        for (const std::size_t s : chosen) sum += term(s);
        const double all = variance(a, b, chosen);
        return all > 0.0 ? sum / static_cast<double>(chosen.size()) / all : 0.0;
      };
    };
    indices.push_back({bootstrap(samples, confidence, seed, part([&](std::size_t s) { return b[s] * (ab[s] - a[s]); })),
                       bootstrap(samples, confidence, seed,
                                 part([&](std::size_t s) { return 0.5 * (a[s] - ab[s]) * (a[s] - ab[s]); }))});
  }
  return indices;
}

std::vector<MorrisMeasures> morris_measures(const std::vector<double>& values, const std::vector<int>& step,
                                            std::size_t factors, double confidence, std::uint64_t seed) {
  const std::size_t block = base::morris_block(factors), trajectories = values.size() / block;
  std::vector<MorrisMeasures> measures;
  for (std::size_t i = 0; i < factors; ++i) {
    std::vector<double> effect(trajectories);
    for (std::size_t t = 0; t < trajectories; ++t) {
      const int signed_step = step[t * factors + i];
      const double* after = &values[t * block + static_cast<std::size_t>(std::abs(signed_step))];
      effect[t] = (after[0] - after[-1]) / (signed_step > 0 ? base::morris_step : -base::morris_step);
    }
    MorrisMeasures one;
    const auto n = static_cast<double>(trajectories);
    one.mean = std::accumulate(effect.begin(), effect.end(), 0.0) / n;
    double squares = 0.0;
    for (const double e : effect) squares += (e - one.mean) * (e - one.mean);
    one.deviation = trajectories > 1 ? std::sqrt(squares / (n - 1.0)) : not_known;
    one.magnitude = bootstrap(trajectories, confidence, seed, [&](const std::vector<std::size_t>& chosen) {
      double sum = 0.0;
      for (const std::size_t t : chosen) sum += std::abs(effect[t]);
      return sum / static_cast<double>(chosen.size());
    });
    measures.push_back(one);
  }
  return measures;
}

std::vector<LocalDerivative> local_derivatives(const std::vector<double>& values, const std::vector<double>& steps) {
  std::vector<LocalDerivative> derivatives;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double* at = &values[1 + base::local_points_per_factor * i];
    const double ahead = (at[0] - values.front()) / steps[i], behind = (values.front() - at[1]) / steps[i];
    derivatives.push_back({0.5 * (ahead + behind), 0.5 * std::abs(ahead - behind)});
  }
  return derivatives;
}

SensitivityAnalysis::SensitivityAnalysis(const StudyTable& table) : table_(table), design_(*table.study().sensitivity) {
  for (const options::StudyDimension& d : table.study().dimensions)
    if (d.axis == design_.axis) factors_.push_back(&d);
  for (const StudyTable::Column& column : table.columns()) {
    if (!column.what->for_people) continue;
    if (column.what->each == StudyColumn::limit) {
      for (std::size_t l = 0; l < table.limits().size(); ++l)
        add(table.limits()[l].quantity, std::string(options::limit_quantity(table.limits()[l].quantity)->unit), column,
            l, 1);
    } else {
      add(column.what->name, column.what->unit, column, 0, column.width);
    }
  }
}

void SensitivityAnalysis::add(const std::string& name, const std::string& unit, const StudyTable::Column& column,
                              std::size_t first, std::size_t count) {
  const options::Study& study = table_.study();
  const bool least = name.starts_with("least_");
  Quantity quantity{name, unit, std::vector<double>(study.axes[design_.axis].length, not_known), false};
  for (std::size_t run = 0; run < table_.runs(); ++run) {
    double& value = quantity.values[study.place(run, design_.axis)];
    for (std::size_t k = first; k < first + count; ++k) {
      const double other = column.values[run * column.width + k];
      value = least ? std::fmin(value, other) : std::fmax(value, other);
    }
  }
  quantity.known = std::none_of(quantity.values.begin(), quantity.values.end(), [](double v) { return std::isnan(v); });
  for (const Quantity& other : quantities_)
    if (other.name == name) return;  // a second limit of the quantity
  if (quantity.known) quantities_.push_back(std::move(quantity));
}

std::vector<std::string> SensitivityAnalysis::measures() const {
  switch (design_.method) {
    case Method::sobol:
      return {"first", "first_low", "first_high", "total", "total_low", "total_high"};
    case Method::morris:
      return {"mean_effect", "effect_deviation", "effect_magnitude", "effect_magnitude_low", "effect_magnitude_high"};
    case Method::local:
      return {"derivative", "derivative_error", "elasticity", "effect_of_deviation"};
  }
  return {};
}

std::vector<double> SensitivityAnalysis::numbers(const Quantity& quantity) const {
  const std::size_t factors = factors_.size();
  const double confidence = table_.study().confidence;
  std::vector<double> all;
  if (design_.method == Method::sobol) {
    for (const auto& [first, total] : sobol_indices(quantity.values, factors, confidence, design_.seed))
      all.insert(all.end(), {first.value, first.low, first.high, total.value, total.low, total.high});
  } else if (design_.method == Method::morris) {
    const std::size_t block = base::morris_block(factors);
    std::vector<int> step(quantity.values.size() / block * factors, 0);
    for (std::size_t t = 0; t < quantity.values.size() / block; ++t)
      for (std::size_t p = 1; p < block; ++p)
        for (std::size_t i = 0; i < factors; ++i)
          if (const double change = factors_[i]->values[t * block + p] - factors_[i]->values[t * block + p - 1];
              change != 0.0)
            step[t * factors + i] = change > 0.0 ? static_cast<int>(p) : -static_cast<int>(p);
    for (const MorrisMeasures& one : morris_measures(quantity.values, step, factors, confidence, design_.seed))
      all.insert(all.end(), {one.mean, one.deviation, one.magnitude.value, one.magnitude.low, one.magnitude.high});
  } else {
    std::vector<double> steps;
    for (std::size_t i = 0; i < factors; ++i) {
      const double* value = &factors_[i]->values[1 + base::local_points_per_factor * i];
      steps.push_back(0.5 * (value[0] - value[1]));
    }
    const std::vector<LocalDerivative> derivatives = local_derivatives(quantity.values, steps);
    for (std::size_t i = 0; i < factors; ++i)
      all.insert(all.end(), {derivatives[i].value, derivatives[i].error,
                             derivatives[i].value * factors_[i]->values.front() / quantity.values.front(),
                             derivatives[i].value * factors_[i]->deviation});
  }
  return all;
}

void SensitivityAnalysis::record(Recorder& recorder) const {
  if (quantities_.empty()) return;
  std::vector<std::string> factor_names, quantity_names;
  for (const options::StudyDimension* factor : factors_) factor_names.push_back(factor->name());
  const std::vector<std::string> names = measures();
  std::vector<std::vector<double>> sets(names.size());
  std::vector<std::pair<std::string, std::string>> units;
  for (const Quantity& quantity : quantities_) {
    quantity_names.push_back(quantity.name);
    units.emplace_back(quantity.name, quantity.unit);
    const std::vector<double> all = numbers(quantity);
    for (std::size_t k = 0; k < all.size(); ++k) sets[k % names.size()].push_back(all[k]);
  }
  recorder.names("/factor", factor_names);
  recorder.names("/quantity", quantity_names);
  recorder.tables({{"/sensitivity/units", units}});
  std::vector<Recorder::Dataset> datasets;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool ratio = design_.method == Method::sobol || names[k] == "elasticity";
    datasets.push_back({"/sensitivity/" + names[k],
                        {quantities_.size(), factors_.size()},
                        std::move(sets[k]),
                        ratio ? "1" : "as /sensitivity/units"});
  }
  recorder.datasets(datasets);
  recorder.attributes("/sensitivity", {{"method", std::string(name_of(design_.method))},
                                       {"confidence", table_.study().confidence},
                                       {"base_samples", static_cast<long>(design_.base_samples)}});
}

void SensitivityAnalysis::print() const {
  const bool sobol = design_.method == Method::sobol, morris = design_.method == Method::morris;
  const std::size_t width = measures().size(), key = sobol ? 3 : morris ? 2 : 3;  // the number that ranks the factors
  for (const Quantity& quantity : quantities_) {
    const std::vector<double> all = numbers(quantity);
    std::vector<std::size_t> order(factors_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto size = [&](std::size_t i) { return std::abs(all[i * width + key]); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return size(i) > size(j); });
    std::vector<std::vector<std::string>> rows = {
        sobol    ? std::vector<std::string>{quantity.name, "alone", "with all its interactions"}
        : morris ? std::vector<std::string>{quantity.name, "size of the effect", "mean", "deviation"}
                 : std::vector<std::string>{quantity.name, "change for one deviation", "elasticity", "its error"}};
    for (const std::size_t i : order) {
      const double* n = &all[i * width];
      rows.push_back({factors_[i]->name()});
      if (sobol)
        rows.back().insert(rows.back().end(), {with_interval(n[0], n[1], n[2]), with_interval(n[3], n[4], n[5])});
      else if (morris)
        rows.back().insert(rows.back().end(), {with_interval(n[2], n[3], n[4]) + " " + quantity.unit,
                                               fmt::format("{:.3g}", n[0]), fmt::format("{:.3g}", n[1])});
      else
        rows.back().insert(rows.back().end(),
                           {fmt::format("{:.4g} {}", n[3], quantity.unit), fmt::format("{:.4g}", n[2]),
                            fmt::format("{:.2g}{}", n[0] != 0.0 ? std::abs(n[2] * n[1] / n[0]) : 0.0,
                                        n[1] > uncertain * std::abs(n[0]) ? " (a kink, or too large a step)" : "")});
    }
    fmt::print("sensitivity\n");
    print_columns(rows);
  }
}

}  // namespace traverse::results
