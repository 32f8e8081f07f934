// Interpolates computed series at the measured times, filters both, and finds the difference of their clocks.
#include "fit/residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "run/low_pass.hpp"

namespace traverse::fit {
namespace {

constexpr double first_sd = 0.005;         // relative to the variation of a series
constexpr double logarithmic_from = 10.0;  // ratio of the bounds from which u is logarithmic
constexpr double largest_gain = 1e3;
constexpr std::size_t most_shifts = 4000, most_compared = 2000;  // of the search for the difference of the clocks
constexpr double least_sd = 1e-12;  // relative to the variation of a series, for measurements without noise

double interval_of(const std::vector<double>& time) {
  return (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

/// The root mean square deviation from the mean; 1 for a constant 0.
double variation(const std::vector<double>& values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  const double found = std::sqrt(sum / static_cast<double>(values.size()));
  return found > 0.0 ? found : std::abs(mean) > 0.0 ? std::abs(mean) : 1.0;
}

void filter(const options::MeasuredSeries& series, std::vector<double>& values) {
  if (series.low_pass) run::LowPass(*series.low_pass, interval_of(series.time)).apply(values);
}

}  // namespace

double Unknown::value(double u) const { return logarithmic ? low * std::pow(high / low, u) : low + u * (high - low); }
double Unknown::u(double value) const {
  const double at = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return std::clamp(at, 0.0, 1.0);
}
double Unknown::slope(double u) const { return logarithmic ? value(u) * std::log(high / low) : high - low; }

Residuals::Residuals(const options::Fit& fit, std::vector<std::string> units)
    : fit_(fit), units_(std::move(units)), size_(fit.modal_size()) {
  for (const options::FitParameter& p : fit.parameters)
    unknowns_.push_back({Unknown::Kind::option, p.name(), p.unit, p.low, p.high, p.start, 0,
                         p.low > 0.0 && p.high >= logarithmic_from * p.low});
  for (const options::MeasuredSeries& series : fit.series) {
    measured_.push_back(series.value);
    filter(series, measured_.back());
    sd_.push_back(series.sd.value_or(first_sd * variation(series.value)));
    size_ += series.time.size();
  }
}

void Residuals::align(const std::vector<double>& response, double interval, double range) {
  interval_ = interval;
  for (std::size_t s = 0; s < fit_.series.size(); ++s) {
    const options::MeasuredSeries& series = fit_.series[s];
    if (!series.align) continue;
    const std::size_t instants = (response.size() - fit_.modal_size()) / fit_.series.size();
    const double half = 0.5 * interval * static_cast<double>(instants - 1);
    const double first = best_alignment(s, response, series.time.front() - half, series.time.back() - half).shift;
    unknowns_.push_back({Unknown::Kind::shift, series.name + "_shift", "s", first - range, first + range, first, s});
  }
  for (std::size_t s = 0; s < fit_.series.size(); ++s) {
    if (!fit_.series[s].offset) continue;
    const auto [least, greatest] = std::minmax_element(measured_[s].begin(), measured_[s].end());
    const double bound = 2.0 * std::max({std::abs(*least), std::abs(*greatest), *greatest - *least, sd_[s]});
    unknowns_.push_back({Unknown::Kind::offset, fit_.series[s].name + "_offset", units_[s], -bound, bound, 0.0, s});
  }
  for (std::size_t s = 0; s < fit_.series.size(); ++s)
    if (fit_.series[s].gain)
      unknowns_.push_back(
          {Unknown::Kind::gain, fit_.series[s].name + "_gain", "1", 1.0 / largest_gain, largest_gain, 1.0, s, true});
}

double Residuals::end() const {
  double last = 0.0;
  std::vector<double> shift(fit_.series.size(), 0.0);
  for (const Unknown& unknown : unknowns_)
    if (unknown.kind == Unknown::Kind::shift) shift[unknown.series] = unknown.low;
  for (std::size_t s = 0; s < fit_.series.size(); ++s) last = std::max(last, fit_.series[s].time.back() - shift[s]);
  return last;
}

Eigen::VectorXd Residuals::start() const {
  Eigen::VectorXd u(static_cast<Eigen::Index>(unknowns_.size()));
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    const Unknown& unknown = unknowns_[static_cast<std::size_t>(j)];
    u[j] = unknown.u(unknown.start);
  }
  return u;
}

std::vector<double> Residuals::values(const Eigen::VectorXd& u) const {
  std::vector<double> values;
  for (std::size_t j = 0; j < options(); ++j) values.push_back(unknowns_[j].value(u[static_cast<Eigen::Index>(j)]));
  return values;
}

Spline Residuals::spline_of(std::size_t s, const std::vector<double>& response) const {
  const std::size_t first = fit_.modal_size(), count = (response.size() - first) / fit_.series.size();
  return {std::span<const double>(response).subspan(first + s * count, count), interval_};
}

ComparedShape Residuals::shape(std::size_t frequency, const std::vector<double>& response) const {
  std::size_t first = fit_.frequencies.size();
  for (std::size_t f = 0; f < frequency; ++f) first += fit_.frequencies[f].x.size();
  const std::vector<double>& measured = fit_.frequencies[frequency].shape;
  const auto count = static_cast<Eigen::Index>(measured.size());
  const Eigen::Map<const Eigen::VectorXd> m(measured.data(), count), c(response.data() + first, count);
  ComparedShape both{measured, std::vector<double>(measured.size(), 0.0)};
  const double square = c.squaredNorm(), product = c.dot(m);
  if (!(square > 0.0)) return both;
  Eigen::Map<Eigen::VectorXd>(both.computed.data(), count) = product / square * c;
  both.mac = product * product / (square * m.squaredNorm());
  return both;
}

/// The computed samples at the measured times, filtered.
std::vector<double> Residuals::computed(std::size_t s, const std::vector<double>& response, double shift) const {
  const options::MeasuredSeries& series = fit_.series[s];
  const Spline spline = spline_of(s, response);
  std::vector<double> values;
  values.reserve(series.time.size());
  for (const double t : series.time) values.push_back(spline(t - shift));
  filter(series, values);
  return values;
}

ComparedSeries Residuals::compared(std::size_t s, const std::vector<double>& response, const Eigen::VectorXd& u) const {
  double shift = 0.0, offset = 0.0, gain = 1.0;
  for (std::size_t j = options(); j < unknowns_.size(); ++j) {
    if (unknowns_[j].series != s) continue;
    const Unknown::Kind kind = unknowns_[j].kind;
    (kind == Unknown::Kind::shift    ? shift
     : kind == Unknown::Kind::offset ? offset
                                     : gain) = unknowns_[j].value(u[static_cast<Eigen::Index>(j)]);
  }
  ComparedSeries both = compared(s, response, shift);
  for (double& value : both.computed) value = gain * value + offset;
  return both;
}

ComparedSeries Residuals::compared(std::size_t s, const std::vector<double>& response, double shift) const {
  return {fit_.series[s].time, measured_[s], computed(s, response, shift)};
}

Eigen::VectorXd Residuals::evaluate(const std::vector<double>& response, const Eigen::VectorXd& u) const {
  Eigen::VectorXd r(static_cast<Eigen::Index>(size_));
  Eigen::Index i = 0;
  for (std::size_t f = 0; f < fit_.frequencies.size(); ++f)
    r[i++] = (response[f] - fit_.frequencies[f].value) / fit_.frequencies[f].sd;
  for (std::size_t f = 0; f < fit_.frequencies.size(); ++f) {
    if (fit_.frequencies[f].x.empty()) continue;
    const ComparedShape both = shape(f, response);
    double largest = 0.0;
    for (const double value : both.measured) largest = std::max(largest, std::abs(value));
    for (std::size_t k = 0; k < both.measured.size(); ++k)
      r[i++] = (both.computed[k] - both.measured[k]) / (fit_.frequencies[f].shape_sd * largest);
  }
  for (std::size_t s = 0; s < fit_.series.size(); ++s) {
    const ComparedSeries both = compared(s, response, u);
    for (std::size_t k = 0; k < both.measured.size(); ++k) r[i++] = (both.computed[k] - both.measured[k]) / sd_[s];
  }
  return r;
}

/// At most most_shifts shifts are compared, by most_compared values each.
Alignment Residuals::best_alignment(std::size_t s, const std::vector<double>& response, double low, double high) const {
  const options::MeasuredSeries& series = fit_.series[s];
  const Spline spline = spline_of(s, response);
  const std::size_t stride = series.time.size() / most_compared + 1;
  const auto shifts = static_cast<std::size_t>(
      std::clamp((high - low) / interval_of(series.time), 1.0, static_cast<double>(most_shifts)));
  Alignment best{0.5 * (low + high)};
  for (std::size_t i = 0; i <= shifts; ++i) {
    const double shift = low + (high - low) * static_cast<double>(i) / static_cast<double>(shifts);
    double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::size_t k = 0; k < series.time.size(); k += stride) {
      const double x = measured_[s][k], y = spline(series.time[k] - shift);
      n += 1.0, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    const double spread = std::sqrt(std::max((aa - a * a / n) * (bb - b * b / n), 0.0));
    const double correlation = spread > 0.0 ? (ab - a * b / n) / spread : -1.0;
    if (correlation > best.correlation) best = {shift, correlation};
  }
  return best;
}

void Residuals::set_starts(const std::vector<double>& response, Eigen::VectorXd& u) const {
  for (std::size_t j = options(); j < unknowns_.size(); ++j) {
    const Unknown& unknown = unknowns_[j];
    double& own = u[static_cast<Eigen::Index>(j)];
    if (unknown.kind == Unknown::Kind::shift)
      own = unknown.u(best_alignment(unknown.series, response, unknown.low, unknown.high).shift);
    else
      own = unknown.u(unknown.kind == Unknown::Kind::gain ? 1.0 : 0.0);
  }
  for (std::size_t j = options(); j < unknowns_.size(); ++j) {
    const Unknown& unknown = unknowns_[j];
    if (unknown.kind == Unknown::Kind::shift) continue;
    const ComparedSeries both = compared(unknown.series, response, u);  // a gain comes after the offset of its series
    const auto count = static_cast<Eigen::Index>(both.measured.size());
    const Eigen::Map<const Eigen::ArrayXd> m(both.measured.data(), count), c(both.computed.data(), count);
    const bool offset = fit_.series[unknown.series].offset;
    const Eigen::ArrayXd deviation = c - (offset ? c.mean() : 0.0);
    const double square = deviation.square().sum();
    const double gain = fit_.series[unknown.series].gain && square > 0.0 ? (deviation * m).sum() / square : 1.0;
    u[static_cast<Eigen::Index>(j)] =
        unknown.u(unknown.kind == Unknown::Kind::gain ? gain : m.mean() - gain * c.mean());
  }
}

double Residuals::independent(std::size_t s) const {
  const options::MeasuredSeries& series = fit_.series[s];
  const auto count = static_cast<double>(series.time.size());
  return series.low_pass ? count * std::min(1.0, 2.0 * *series.low_pass * interval_of(series.time)) : count;
}

double Residuals::independent() const {
  auto sum = static_cast<double>(fit_.modal_size());
  for (std::size_t s = 0; s < fit_.series.size(); ++s) sum += independent(s);
  return sum;
}

Eigen::VectorXd Residuals::of_series(std::size_t s, const Eigen::VectorXd& residuals) const {
  std::size_t first = fit_.modal_size();
  for (std::size_t i = 0; i < s; ++i) first += fit_.series[i].time.size();
  return residuals.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(fit_.series[s].time.size()));
}

Eigen::VectorXd Residuals::estimate_sd(const Eigen::VectorXd& residuals) {
  const double all = independent();
  const double free = std::max(1.0 - static_cast<double>(unknowns_.size()) / all, 1.0 / all);
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(residuals.size());
  auto first = static_cast<Eigen::Index>(fit_.modal_size());
  for (std::size_t s = 0; s < fit_.series.size(); ++s) {
    const auto count = static_cast<Eigen::Index>(fit_.series[s].time.size());
    if (!fit_.series[s].sd) {
      const double found = sd_[s] * residuals.segment(first, count).norm() / std::sqrt(independent(s) * free);
      const double own = std::max(found, least_sd * variation(fit_.series[s].value));
      factors.segment(first, count).setConstant(sd_[s] / own);
      sd_[s] = own;
    }
    first += count;
  }
  return factors;
}

}  // namespace traverse::fit
