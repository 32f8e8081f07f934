// Correlation, ratio of the amplitudes and constant difference of each record and its computed counterpart.
#include "fit/record_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "options/parse_number.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::fit {
namespace {

constexpr double doubtful_ratio = 5.0;  // of the amplitudes, from which on further runs show what the bounds explain
constexpr double reach_margin = 3.0;    // factor of the amplitudes between the bounds
constexpr double related = 0.8;         // correlation of series that show the same passage
constexpr double the_same = 0.9, unrelated = 0.5;
constexpr double opposed = -0.5;
constexpr double better = 0.2;        // increase of the correlation by another clock
constexpr double shifted = 0.02;      // of the duration of the passage
constexpr double offset_part = 0.15;  // of the range of a record
constexpr double close_factor = 2.5;  // of a suggested factor
constexpr double earth = 9.81;        // m/s2

/// Means, standard deviations and correlation of two series.
struct Statistics {
  double mean_measured = 0.0, mean_computed = 0.0, measured = 0.0, computed = 0.0, correlation = 0.0;
  double ratio() const { return measured / computed; }
};

Statistics statistics_of(const ComparedSeries& both) {
  const auto count = static_cast<Eigen::Index>(both.measured.size());
  const Eigen::Map<const Eigen::ArrayXd> x(both.measured.data(), count), y(both.computed.data(), count);
  Statistics found;
  found.mean_measured = x.mean();
  found.mean_computed = y.mean();
  const Eigen::ArrayXd dx = x - found.mean_measured, dy = y - found.mean_computed;
  found.measured = std::sqrt(dx.square().mean());
  found.computed = std::sqrt(dy.square().mean());
  const double both_spread = found.measured * found.computed;
  found.correlation = both_spread > 0.0 ? (dx * dy).mean() / both_spread : 0.0;
  return found;
}

/// The doubts about one series.
class RecordCheck {
 public:
  /// response: of the unknowns u.
  RecordCheck(const options::Fit& fit, const ForwardModel& model, const Residuals& residuals,
              const std::vector<double>& response, const Eigen::VectorXd& u, std::size_t series)
      : fit_(fit),
        model_(model),
        residuals_(residuals),
        response_(response),
        s_(series),
        series_(fit.series[series]),
        shift_(shift_of(u)),
        now_(statistics_of(compared(response, shift_))) {}

  /// InputError for a record that no values within the bounds can explain.
  void refuse() const {
    if (!(now_.measured > 0.0)) return;
    const Alignment best = best_alignment();
    const Statistics aligned = best.correlation > related ? statistics_of(compared(response_, best.shift)) : now_;
    if (is_another_clock(best)) refuse_clock(best.shift);
    if (!series_.gain && is_doubtful(now_.ratio()) && !can_be_explained()) refuse_unit(aligned.ratio());
  }

  void add_to(std::vector<std::string>& doubts) const {
    if (!(now_.measured > 0.0)) return;
    const Alignment best = best_alignment();
    if (now_.correlation < opposed && best.correlation < -now_.correlation)
      doubts.push_back(
          fmt::format("{}: the record has the opposite sign of the computed series (correlation {:.2f}): {} {:g}?",
                      option("series"), now_.correlation, option("factor"), -factor()));
    else if (!series_.align && !is_given("align") && best.correlation > std::max(related, now_.correlation + better) &&
             std::abs(best.shift) > shifted * model_.duration())
      doubts.push_back(
          fmt::format("{}: the correlation with the computed series is {:.2f}, and {:.2f} if the clock of the record "
                      "is {:.4g} s at the start of the scene: {} true?",
                      option("series"), now_.correlation, best.correlation, best.shift, option("align")));
    if (series_.offset || is_given("offset") || std::abs(now_.correlation) < related) return;
    const double offset = now_.mean_measured - now_.correlation * now_.ratio() * now_.mean_computed;
    const std::vector<double>& measured = residuals_.measured(s_);
    const auto [least, greatest] = std::minmax_element(measured.begin(), measured.end());
    if (std::abs(offset) > offset_part * (*greatest - *least))
      doubts.push_back(fmt::format("{}: the record has a constant of {:.3g} {} beside the computed series: {} true?",
                                   option("series"), offset, residuals_.unit(s_), option("offset")));
  }

 private:
  std::string option(const char* row) const { return fmt::format("fit_to_{}_{}", series_.name, row); }
  /// Whether the input says something on it: align: false and offset: false are answers to a doubt.
  bool is_given(const char* row) const { return model_.given().find(option(row)) != nullptr; }
  /// The given factor of the record.
  double factor() const {
    const options::Entry* const given = model_.given().find(option("factor"));
    double value = 1.0;
    if (given != nullptr) options::parse_number(given->value, value);
    return value;
  }
  static bool is_doubtful(double ratio) { return !(ratio < doubtful_ratio && ratio > 1.0 / doubtful_ratio); }

  ComparedSeries compared(const std::vector<double>& response, double shift) const {
    return residuals_.compared(s_, response, shift);
  }

  /// Of the clock, s.
  double shift_of(const Eigen::VectorXd& u) const {
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      const Unknown& one = residuals_.unknowns()[static_cast<std::size_t>(j)];
      if (one.kind == Unknown::Kind::shift && one.series == s_) return one.value(u[j]);
    }
    return 0.0;
  }

  /// By any clock with which the record and the passage overlap.
  Alignment best_alignment() const {
    return residuals_.best_alignment(s_, response_, series_.time.front() - model_.duration(), series_.time.back());
  }

  /// Whether values within the bounds may have the amplitude of the record: each option at its bounds, and the product
  /// of their effects.
  bool can_be_explained() const {
    double least = 1.0 / reach_margin, greatest = reach_margin;
    for (std::size_t j = 0; j < fit_.parameters.size(); ++j) {
      double low = 1.0, high = 1.0;
      for (const double value : {fit_.parameters[j].low, fit_.parameters[j].high}) {
        std::vector<double> values = model_.start();
        values[j] = value;
        const double effect = statistics_of(compared(model_.run({values}).front(), shift_)).computed / now_.computed;
        low = std::min(low, effect);
        high = std::max(high, effect);
      }
      least *= low;
      greatest *= high;
    }
    return now_.ratio() > least && now_.ratio() < greatest;
  }

  /// Whether the record begins after the loads have left, and shows their passage.
  bool is_another_clock(const Alignment& best) const {
    return !is_given("align") && series_.time.front() >= model_.duration() && best.correlation > the_same &&
           now_.correlation < unrelated && best.shift + 0.5 * model_.duration() > series_.time.front();
  }

  [[noreturn]] void refuse_clock(double shift) const {
    throw InputError(fmt::format(
        "{}: the record begins at {:g} s, when the loads have left ({:.3g} s), but shows their passage, as if its "
        "clock were {:.4g} s at the start of the scene; allowed: {} true, or false to fit it as it is",
        option("series"), series_.time.front(), model_.duration(), shift, option("align")));
  }

  [[noreturn]] void refuse_unit(double ratio) const {
    throw InputError(
        fmt::format("{}: the record is {:.3g} times the computed series, which no values within the bounds explain; is "
                    "its unit {}?{}",
                    option("series"), ratio, residuals_.unit(s_), suggestion(1.0 / ratio)));
  }

  /// The usual factor between two units that is close to this one.
  std::string suggestion(double wanted) const {
    double nearest = 0.0;
    for (const double one : {1e-6, 1e-3, 1e-2, 1e-1, 1.0 / earth, earth, 1e1, 1e2, 1e3, 1e6})
      if (nearest == 0.0 || std::abs(std::log(wanted / one)) < std::abs(std::log(wanted / nearest))) nearest = one;
    if (std::abs(std::log(wanted / nearest)) > std::log(close_factor)) return "";
    return fmt::format(" {} {:.4g}?", option("factor"), factor() * nearest);
  }

  const options::Fit& fit_;
  const ForwardModel& model_;
  const Residuals& residuals_;
  const std::vector<double>& response_;
  std::size_t s_;
  const options::MeasuredSeries& series_;
  double shift_;
  Statistics now_;
};

}  // namespace

std::vector<std::string> doubts_about_records(const options::Fit& fit, const ForwardModel& model,
                                              const Residuals& residuals) {
  if (fit.series.empty()) return {};
  const std::vector<double> response = model.run({model.start()}).front();
  for (std::size_t s = 0; s < fit.series.size(); ++s)
    RecordCheck(fit, model, residuals, response, residuals.start(), s).refuse();
  return doubts_that_remain(fit, model, residuals, response, residuals.start());
}

std::vector<std::string> doubts_that_remain(const options::Fit& fit, const ForwardModel& model,
                                            const Residuals& residuals, const std::vector<double>& response,
                                            const Eigen::VectorXd& u) {
  std::vector<std::string> doubts;
  for (std::size_t s = 0; s < fit.series.size(); ++s) RecordCheck(fit, model, residuals, response, u, s).add_to(doubts);
  return doubts;
}

}  // namespace traverse::fit
