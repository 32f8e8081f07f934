// Reads and checks each bridge of a stock.
#include "screen/stock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <string_view>
#include <unordered_set>

#include "norm/en1991.hpp"
#include "options/named_table.hpp"
#include "screen/beam_modes.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::screen {
namespace {

using options::NamedTable;

constexpr options::KnownColumn bridge_columns[] = {{"name"},
                                                   {"spans", "m"},
                                                   {"mass", "kg/m"},
                                                   {"EI", "N m2"},
                                                   {"f1", "Hz"},
                                                   {"eccentricity", "m"},
                                                   {"GJ", "N m2"},
                                                   {"torsional_frequency", "Hz"},
                                                   {"polar_inertia", "kg m"},
                                                   {"damping"},
                                                   {"type"},
                                                   {"speed", "m/s"},
                                                   {"deck_acceleration", "m/s2"},
                                                   {"deflection_over_span"}};
constexpr std::size_t most_spans = 20, most_bridges = 100'000;
constexpr double shortest_span = 1.0, longest_span = 1000.0;          // m
constexpr double largest_ratio = 10.0;                                // of two spans
constexpr double lowest_frequency = 0.05, highest_frequency = 200.0;  // Hz
constexpr double least_torsion = 0.2;                                 // first frequency of torsion over that of bending
constexpr double largest_eccentricity = 50.0;                         // m
constexpr double least_damping = 1e-4, greatest_damping = 0.2;

std::vector<double> spans_of(const NamedTable& table, std::size_t row) {
  const std::vector<double> spans = table.numbers(row, "spans");
  for (const double span : spans)
    if (!(span >= shortest_span && span <= longest_span))
      table.refuse(row, fmt::format("spans: '{:g}'; allowed: lengths from {:g} to {:g} m, separated by blanks", span,
                                    shortest_span, longest_span));
  if (spans.empty() || spans.size() > most_spans)
    table.refuse(row, fmt::format("spans: {} of them; allowed: 1 to {}", spans.size(), most_spans));
  const auto [least, greatest] = std::minmax_element(spans.begin(), spans.end());
  if (*greatest > largest_ratio * *least)
    table.refuse(row, fmt::format("spans: the longest is more than {:g} times the shortest", largest_ratio));
  return spans;
}

/// EI in N m2, given or from the first frequency.
double stiffness_of(const NamedTable& table, std::size_t row, const Bridge& bridge) {
  const double beta = beam_modes(bridge.spans, 1).front().beta;
  const double of_frequency = bridge.mass * std::pow(2.0 * std::numbers::pi, 2) / std::pow(beta, 4);
  const double EI = table.has("f1") ? of_frequency * std::pow(table.positive(row, "f1"), 2) : table.positive(row, "EI");
  const double frequency = std::sqrt(EI / of_frequency);
  if (!(frequency >= lowest_frequency && frequency <= highest_frequency))
    table.refuse(row, fmt::format("a first frequency of {:.4g} Hz; allowed: {:g} to {:g} Hz", frequency,
                                  lowest_frequency, highest_frequency));
  return EI;
}

/// Reads the torsion of a bridge whose bending has been read.
void read_torsion(const NamedTable& table, std::size_t row, Bridge& bridge) {
  if (!table.has("eccentricity")) return;
  bridge.eccentricity = table.number(row, "eccentricity");
  if (std::abs(bridge.eccentricity) > largest_eccentricity)
    table.refuse(row,
                 fmt::format("eccentricity: {:g}; allowed: up to {:g} m", bridge.eccentricity, largest_eccentricity));
  if (bridge.eccentricity == 0.0) return;
  bridge.polar_inertia = table.positive(row, "polar_inertia");
  const double longest = *std::max_element(bridge.spans.begin(), bridge.spans.end());
  const double of_frequency = bridge.polar_inertia * std::pow(2.0 * longest, 2);
  bridge.GJ = table.has("GJ") ? table.positive(row, "GJ")
                              : of_frequency * std::pow(table.positive(row, "torsional_frequency"), 2);
  const double frequency = std::sqrt(bridge.GJ / of_frequency), least = least_torsion * first_frequency(bridge);
  if (!(frequency >= least && frequency <= highest_frequency))
    table.refuse(row, fmt::format("a first frequency of torsion of {:.4g} Hz; allowed: {:.4g} to {:g} Hz", frequency,
                                  least, highest_frequency));
}

double damping_of(const NamedTable& table, std::size_t row, double longest) {
  if (table.has("damping")) {
    const double ratio = table.positive(row, "damping");
    if (!(ratio >= least_damping && ratio <= greatest_damping))
      table.refuse(row, fmt::format("damping: {:g}; allowed: a ratio from {:g} to {:g}", ratio, least_damping,
                                    greatest_damping));
    return ratio;
  }
  const std::string_view name = table.text(row, "type");
  const auto* found = std::find_if(std::begin(options::damping_bounds), std::end(options::damping_bounds),
                                   [&](const options::DampingBound& bound) { return bound.name == name; });
  if (found == std::end(options::damping_bounds))
    table.refuse(row, fmt::format("type: '{}'; allowed: steel, composite, prestressed, reinforced, filler_beam", name));
  return norm::least_damping(static_cast<options::BridgeMaterial>(found - std::begin(options::damping_bounds)),
                             longest);
}

/// The factor that makes a response a fraction of the strictest limit of its quantity.
double factor_of(const NamedTable& table, std::size_t row, const char* quantity,
                 const std::vector<options::VerdictLimit>& limits) {
  double factor = 0.0;
  for (const options::VerdictLimit& limit : limits) {
    if (limit.quantity != quantity) continue;
    const double own = table.has(quantity) ? table.positive(row, quantity) : limit.value;
    factor = std::max(factor, limit.factor / own);
  }
  return factor;
}

void check_columns(const NamedTable& table, const std::vector<options::VerdictLimit>& limits) {
  for (const char* name : {"name", "spans", "mass"})
    if (!table.has(name)) table.refuse_columns(fmt::format("the column {} is missing", name));
  for (const auto& [one, other] : {std::pair{"EI", "f1"}, std::pair{"damping", "type"}})
    if (table.has(one) == table.has(other))
      table.refuse_columns(fmt::format("allowed: one of the columns {} and {}", one, other));
  for (const char* name : {"GJ", "torsional_frequency", "polar_inertia"})
    if (table.has(name) && !table.has("eccentricity"))
      table.refuse_columns(fmt::format("the column {} needs the column eccentricity", name));
  if (table.has("eccentricity") && !table.has("polar_inertia"))
    table.refuse_columns("the column polar_inertia is missing, which eccentricity needs");
  if (table.has("eccentricity") && table.has("GJ") == table.has("torsional_frequency"))
    table.refuse_columns("allowed with eccentricity: one of the columns GJ and torsional_frequency");
  for (const char* quantity : {"deck_acceleration", "deflection_over_span"})
    if (table.has(quantity) && std::none_of(limits.begin(), limits.end(), [&](const options::VerdictLimit& limit) {
          return limit.quantity == quantity;
        }))
      table.refuse_columns(fmt::format("the column {} has no effect: the limits do not contain it", quantity));
}

}  // namespace

double first_frequency(const Bridge& bridge) {
  const double beta = beam_modes(bridge.spans, 1).front().beta;
  return beta * beta * std::sqrt(bridge.EI / bridge.mass) / (2.0 * std::numbers::pi);
}

std::vector<Bridge> read_stock(const std::string& path, const std::vector<options::VerdictLimit>& limits,
                               std::vector<std::string>& notes) {
  const NamedTable table(path, bridge_columns);
  table.check_names();
  if (!table.note().empty()) notes.push_back(table.note());
  check_columns(table, limits);
  if (table.rows() > most_bridges) table.refuse(most_bridges, fmt::format("allowed: {} bridges", most_bridges));
  std::vector<Bridge> stock;
  std::unordered_set<std::string> names;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Bridge bridge;
    bridge.name = table.text(row, "name");
    if (bridge.name.empty() || !names.insert(bridge.name).second)
      table.refuse(row, fmt::format("name: '{}'; allowed: a different name for each bridge", bridge.name));
    bridge.spans = spans_of(table, row);
    bridge.mass = table.positive(row, "mass");
    bridge.EI = stiffness_of(table, row, bridge);
    read_torsion(table, row, bridge);
    bridge.damping = damping_of(table, row, *std::max_element(bridge.spans.begin(), bridge.spans.end()));
    bridge.speed = table.has("speed") ? table.speed(row, "speed") : std::numeric_limits<double>::infinity();
    bridge.of_acceleration = factor_of(table, row, "deck_acceleration", limits);
    bridge.of_deflection = factor_of(table, row, "deflection_over_span", limits);
    stock.push_back(std::move(bridge));
  }
  return stock;
}

}  // namespace traverse::screen
