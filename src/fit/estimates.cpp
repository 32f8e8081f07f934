// Covariance from the singular values of the scaled Jacobian, and the combinations of unknowns that the data do not
// determine.
#include "fit/estimates.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::fit {
namespace {

constexpr double singular = 1e-4;         // relative to the largest singular value of the scaled Jacobian
constexpr double without_effect = 1e-10;  // sensitivity relative to the largest one: the data do not depend on it
constexpr double member = 0.1;            // part of a singular vector from which an unknown belongs to it
constexpr double hardly = 0.98;           // correlation from which two unknowns are hardly told apart
constexpr double chance = 3.0;            // standard deviations of the sum of squares that chance explains
constexpr double dependent = 0.3;         // correlation of neighbouring residuals from which a sentence warns
constexpr double same_place = 1e-3;       // of the range between the bounds
constexpr double same_misfit = 0.01;  // difference of sums of squares, over their mean square, explained by rounding
constexpr double infinite = std::numeric_limits<double>::infinity(),
                 undefined = std::numeric_limits<double>::quiet_NaN();

/// The values of the columns of `free` unknowns only.
struct Scaled {
  std::vector<Eigen::Index> index;  // of the unknowns that are free and have an effect
  Eigen::VectorXd norm;             // of their columns
  Eigen::MatrixXd jacobian;         // with columns of norm 1
};

Scaled scaled(const Minimum& minimum, const std::vector<char>& held) {
  Scaled found;
  const Eigen::VectorXd norm = minimum.jacobian.colwise().norm();
  for (Eigen::Index j = 0; j < norm.size(); ++j)
    if (held[static_cast<std::size_t>(j)] == 0 && norm[j] > without_effect * norm.maxCoeff()) found.index.push_back(j);
  const auto count = static_cast<Eigen::Index>(found.index.size());
  found.norm.resize(count);
  found.jacobian.resize(minimum.jacobian.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    found.norm[j] = norm[found.index[static_cast<std::size_t>(j)]];
    found.jacobian.col(j) = minimum.jacobian.col(found.index[static_cast<std::size_t>(j)]) / found.norm[j];
  }
  return found;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

/// Writes the estimates and the sentences of one minimum.
class Writer {
 public:
  Writer(const Minimum& minimum, const Residuals& residuals)
      : minimum_(minimum), residuals_(residuals), held_(at_bounds(minimum)), free_(scaled(minimum, held_)) {}

  Estimates write() {
    set_ratio();
    set_values();
    set_covariance();
    add_pairs();
    add_dependence();
    if (!has_converged(minimum_))
      say(fmt::format("The minimisation has not converged ({}): -tao_max_it, fit_starts or narrower bounds may help.",
                      minimum_.reason));
    return std::move(found_);
  }

 private:
  void say(std::string sentence) { found_.sentences.push_back(std::move(sentence)); }
  const Unknown& unknown_of(Eigen::Index j) const { return residuals_.unknowns()[static_cast<std::size_t>(j)]; }
  const std::string& name(Eigen::Index j) const { return unknown_of(j).name; }
  double slope(Eigen::Index j) const { return unknown_of(j).slope(minimum_.u[j]); }
  Estimate& estimate(Eigen::Index j) { return found_.of[static_cast<std::size_t>(j)]; }

  void set_ratio() {
    const double sum = minimum_.residuals.squaredNorm();
    const double freedom = residuals_.independent() - static_cast<double>(free_.index.size());
    found_.ratio = freedom > 0.0 ? sum / freedom : undefined;
    if (freedom > 0.0 && found_.ratio > 1.0 + chance * std::sqrt(2.0 / freedom)) {
      scale_ = std::sqrt(found_.ratio);
      say(
          fmt::format("The residuals are {:.2g} times as large as the standard deviations of the measurements: the "
                      "model does not explain all of them, and the standard errors are multiplied by this number.",
                      scale_));
    }
  }

  void set_values() {
    for (Eigen::Index j = 0; j < minimum_.u.size(); ++j) {
      const bool held = held_[static_cast<std::size_t>(j)] != 0;
      found_.of.push_back({unknown_of(j).value(minimum_.u[j]), held ? undefined : infinite, held});
      if (held)
        say(fmt::format("{} is at its {} bound, and the misfit decreases beyond it.", name(j),
                        minimum_.u[j] < 0.5 ? "lower" : "upper"));
      else if (std::find(free_.index.begin(), free_.index.end(), j) == free_.index.end())
        say(fmt::format("The data do not depend on {}.", name(j)));
    }
  }

  void set_covariance() {
    const auto count = static_cast<Eigen::Index>(free_.index.size());
    found_.correlation = Eigen::MatrixXd::Constant(minimum_.u.size(), minimum_.u.size(), undefined);
    if (count == 0) return;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(free_.jacobian.transpose() * free_.jacobian, Eigen::ComputeFullV);
    const Eigen::VectorXd& square = svd.singularValues();
    const Eigen::MatrixXd& V = svd.matrixV();
    std::vector<char> open(static_cast<std::size_t>(count), 0);
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const bool determined = square[k] > singular * singular * square[0] && k < minimum_.residuals.size();
      if (determined)
        inverse += V.col(k) * V.col(k).transpose() / square[k];
      else
        add_combination(V.col(k), open);
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      if (open[static_cast<std::size_t>(i)] != 0) continue;
      const Eigen::Index to = free_.index[static_cast<std::size_t>(i)];
      estimate(to).standard_error = scale_ * std::sqrt(inverse(i, i)) / free_.norm[i] * slope(to);
      for (Eigen::Index j = 0; j < count; ++j)
        if (open[static_cast<std::size_t>(j)] == 0)
          found_.correlation(to, free_.index[static_cast<std::size_t>(j)]) =
              inverse(i, j) / std::sqrt(inverse(i, i) * inverse(j, j));
    }
  }

  /// A change of the unknowns that does not change the computed values.
  void add_combination(const Eigen::VectorXd& direction, std::vector<char>& open) {
    std::vector<std::string> names, changes;
    double first = 0.0;
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      if (std::abs(direction[i]) < member * direction.cwiseAbs().maxCoeff()) continue;
      open[static_cast<std::size_t>(i)] = 1;
      const Eigen::Index j = free_.index[static_cast<std::size_t>(i)];
      const double value = unknown_of(j).value(minimum_.u[j]);
      const double change = direction[i] / free_.norm[i] * slope(j) / (value != 0.0 ? std::abs(value) : 1.0);
      if (names.empty()) first = change;
      names.push_back(name(j));
      changes.push_back(fmt::format("{} by {:+.2g} %", name(j), change / first));
    }
    if (names.size() == 1) return say(fmt::format("The data do not depend on {}.", names.front()));
    say(fmt::format(
        "The data cannot tell {} apart: if they change together ({}), the misfit stays the same. Fix one of "
        "them, or add a measurement that depends on them in another way.",
        joined(names), joined(changes)));
  }

  void add_pairs() {
    for (Eigen::Index i = 0; i < found_.correlation.rows(); ++i)
      for (Eigen::Index j = i + 1; j < found_.correlation.cols(); ++j)
        if (const double own = found_.correlation(i, j); std::abs(own) > hardly)
          say(fmt::format(
              "The data hardly tell {} and {} apart (correlation {:.4f}): an error of one is compensated by "
              "an error of the other.",
              name(i), name(j), own));
  }

  void add_dependence() {
    for (std::size_t s = 0; s < residuals_.series_count(); ++s) {
      const Eigen::VectorXd r = residuals_.of_series(s, minimum_.residuals);
      const double sum = r.squaredNorm();
      if (residuals_.filtered(s) || sum == 0.0) continue;
      const double neighbours = r.head(r.size() - 1).dot(r.tail(r.size() - 1)) / sum;
      if (neighbours > dependent + chance / std::sqrt(static_cast<double>(r.size())))
        say(fmt::format(
            "Neighbouring residuals of {} are correlated ({:.2f}): they are not only independent noise, and "
            "the true errors are larger than the standard errors.",
            residuals_.name(s), neighbours));
    }
  }

  const Minimum& minimum_;
  const Residuals& residuals_;
  std::vector<char> held_;
  Scaled free_;
  double scale_ = 1.0;
  Estimates found_;
};

}  // namespace

Estimates estimates_of(const Minimum& minimum, const Residuals& residuals) {
  return Writer(minimum, residuals).write();
}

std::vector<DistinctMinimum> distinct_minima(const std::vector<Minimum>& minima) {
  std::vector<const Minimum*> sorted;
  for (const Minimum& one : minima) sorted.push_back(&one);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Minimum* a, const Minimum* b) { return a->misfit() < b->misfit(); });
  std::vector<DistinctMinimum> found;
  for (const Minimum* one : sorted) {
    if (one != sorted.front() && !has_converged(*one)) continue;
    const auto same = std::find_if(found.begin(), found.end(), [&](const DistinctMinimum& other) {
      const Eigen::VectorXd between = one->u - other.best->u;
      const double mean = other.best->residuals.squaredNorm() / static_cast<double>(one->residuals.size());
      return between.cwiseAbs().maxCoeff() < same_place ||
             (other.best->jacobian * between).squaredNorm() < same_misfit * std::max(mean, same_misfit);
    });
    if (same == found.end())
      found.push_back({one, 1});
    else
      ++same->count;
  }
  return found;
}

}  // namespace traverse::fit
