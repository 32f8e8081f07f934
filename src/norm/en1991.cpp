// Load Model 71 (EN 1991-2, 6.3.2), Load Models SW/0 and SW/2 (6.3.3), trains as a row of axle forces, determinant
// lengths, dynamic factors Phi, phi' and phi'', frequency bounds and damping ratios of clause 6.4 and annex C in closed
// form, and sentences on numbers that are usual in another unit.
#include "norm/en1991.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "traverse/base/error.hpp"

namespace traverse::norm {
namespace {

constexpr double percent = 0.01;
constexpr double bounds_from = 4.0, bounds_change = 20.0,
                 bounds_to = 100.0;                                   // m, lengths at which the limits of n0 change
constexpr double damping_changes = 20.0, vehicles_damp_below = 30.0;  // m
constexpr double full_speed = 22.0;  // m/s, speed from which irregularities have their full effect

/// c/(sqrt(L) - 0.2) + d in [1, most].
double phi_of_length(double length, double c, double d, double most) {
  const double root = std::sqrt(length) - 0.2;
  return root <= 0.0 ? most : std::clamp(c / root + d, 1.0, most);
}

constexpr double unit_ratio = 31.6227766;  // ratio of frequencies for a factor of 1000 in EI or mass
constexpr double bounds_margin = 2.0;      // factor of the bounds
constexpr double high_damping = 0.1;
constexpr double fastest_train = 160.0;  // m/s: the record of a train on rails is 574.8 km/h

bool between(double value, const std::pair<double, double>& bounds, double slack) {
  return value >= bounds.first / slack && value <= bounds.second * slack;
}

LoadModel lm71() {
  constexpr double axle = 250e3, distance = 1.6, load = 80e3, margin = 0.8;  // N, m, N/m, m
  LoadModel model{"", "EN 1991-2 6.3.2", {}, {}, load, -margin, 3.0 * distance + margin};
  for (int i = 0; i < 4; ++i) model.forces.push_back({axle, i * distance});
  return model;
}

/// Two uniform loads (N/m) of a length with a gap between them, m.
LoadModel two_loads(double load, double length, double gap) {
  return {"", "EN 1991-2 6.3.3", {}, {{load, 0.0, length}, {load, length + gap, 2.0 * length + gap}}, 0.0, 0.0, 0.0};
}

struct Loads {
  std::string_view name;
  LoadModel (*make)();
};

constexpr Loads loads_of[] = {
    {"lm71", lm71},
    {"sw0", [] { return two_loads(133e3, 15.0, 5.3); }},
    {"sw2", [] { return two_loads(150e3, 25.0, 7.0); }},
};

constexpr const Loads* loads_row(std::string_view name) {
  for (const Loads& row : loads_of)
    if (row.name == name) return &row;
  return nullptr;
}

static_assert(std::all_of(std::begin(options::load_models), std::end(options::load_models),
                          [](const options::LoadModelRow& row) { return loads_row(row.name) != nullptr; }),
              "every load model that may be asked for has its line in loads_of");

}  // namespace

double determinant_length(std::span<const double> spans) {
  constexpr double k[] = {1.0, 1.2, 1.3, 1.4, 1.5};
  const double mean = std::accumulate(spans.begin(), spans.end(), 0.0) / static_cast<double>(spans.size());
  return std::max(k[std::min(spans.size(), std::size(k)) - 1] * mean, *std::max_element(spans.begin(), spans.end()));
}

std::vector<double> determinant_lengths(const beam::BeamModel& model) {
  std::vector<double> lengths;
  for (std::size_t first = 0; first < model.spans.size();) {
    std::size_t end = first + 1;
    while (end < model.spans.size() && model.joint(static_cast<int>(end)) != beam::Joint::separate) ++end;
    lengths.resize(end, determinant_length(std::span(model.spans).subspan(first, end - first)));
    first = end;
  }
  return lengths;
}

double phi2(double length) { return phi_of_length(length, 1.44, 0.82, 1.67); }
double phi3(double length) { return phi_of_length(length, 2.16, 0.73, 2.0); }

double phi_of_speed(double v, double length, double n0) {
  const double K = v / (2.0 * length * n0);
  return K < 0.76 ? K / (1.0 - K + K * K * K * K) : 1.325;
}

double phi_of_track(double v, double length, double n0) {
  const double a = std::min(v / full_speed, 1.0), tenth = length / 10.0, twentieth = length / 20.0;
  const double sum =
      56.0 * std::exp(-tenth * tenth) + 50.0 * (length * n0 / 80.0 - 1.0) * std::exp(-twentieth * twentieth);
  return std::max(0.0, a / 100.0 * sum);
}

std::optional<std::pair<double, double>> frequency_bounds(double length) {
  if (length < bounds_from || length > bounds_to) return {};
  const double low = length <= bounds_change ? 80.0 / length : 23.58 * std::pow(length, -0.592);
  return std::pair{low, 94.76 * std::pow(length, -0.748)};
}

double least_damping(options::BridgeMaterial material, double span) {
  const options::DampingBound& bound = options::damping_bounds[static_cast<std::size_t>(material)];
  return percent * (bound.long_spans + bound.slope * std::max(0.0, damping_changes - span));
}

double additional_damping(double span) {
  if (span >= vehicles_damp_below) return 0.0;
  const double L = span, numerator = 0.0187 * L - 0.00064 * L * L;
  return percent * std::max(0.0, numerator / (1.0 - 0.0441 * L - 0.0044 * L * L + 0.000255 * L * L * L));
}

std::string unusual_frequency(double n0, double length, const char* EI, const char* mass) {
  const auto bounds = frequency_bounds(length);
  if (!(n0 > 0.0) || !bounds || between(n0, *bounds, 1.0)) return "";
  std::string line = fmt::format(
      "the first frequency, {:.3g} Hz, is {} the range of railway bridges of {:.3g} m: {:.3g} to {:.3g} Hz "
      "(EN 1991-2, figure 6.10)",
      n0, n0 < bounds->first ? "below" : "above", length, bounds->first, bounds->second);
  if (between(n0, *bounds, bounds_margin)) return line;
  if (between(n0 * unit_ratio, *bounds, bounds_margin))
    line += fmt::format("; {} is possibly given in kN m2; its unit is N m2", EI);
  else if (between(n0 / unit_ratio, *bounds, bounds_margin))
    line += fmt::format("; {} is possibly given in t/m; its unit is kg/m", mass);
  return line;
}

std::string unusual_bridge_mass(double value, double span, const char* mass) {
  if (span < min_bridge_span || value >= lightest_bridge) return "";
  return fmt::format("{}: {:g} kg/m is small for spans of {:g} m; it is possibly given in t/m", mass, value, span);
}

std::string unusual_damping(double ratio) {
  if (!(ratio > high_damping)) return "";
  return fmt::format("a damping ratio of {:.3g} is {:.3g} % of critical damping, bridges have 0.5 to 3 %", ratio,
                     100.0 * ratio);
}

std::string unusual_speed(const std::string& what, double speed) {
  if (!(speed > fast_speed)) return "";
  return fmt::format("{}: {:g} m/s is {:g} km/h, faster than any train {}; speeds are in m/s", what, speed, 3.6 * speed,
                     speed > fastest_train ? "has run" : "in service");
}

bool is_possibly_in_kilonewtons(double force) { return force > 0.0 && force < 1e-3 * heaviest_axle * earth; }

LoadModel load_model(std::string_view name) {
  const options::LoadModelRow* row = options::load_model_row(name);
  if (row == nullptr) throw InputError("there is no load model '" + std::string(name) + "'");
  LoadModel model = loads_row(name)->make();
  model.name = row->title;
  return model;
}

LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x) {
  LoadModel model;
  model.name = std::move(name);
  for (std::size_t i = 0; i < forces.size(); ++i) model.forces.push_back({forces[i], x[i]});
  return model;
}

}  // namespace traverse::norm
