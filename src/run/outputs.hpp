// The datasets that a run stores at every sample. A quantity is one row of a table: its name, its unit and the function
// that evaluates it from its object (a probe, a body, a wheel). The width of a dataset follows from the type of the
// function's result. The same row describes the dataset and fills it, so that both always agree.
//
//   constexpr Row<recovery::Response> rows[] = {{"moment", "N m", of<&recovery::Response::moment>}, ...};
//   outputs.add_each("/probes/", rows, 12, [](const Observed& now, std::size_t probe) { return now.probes[probe]; });
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "coupling/system.hpp"
#include "recovery/ground_forces.hpp"
#include "recovery/mass_dampers.hpp"
#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Stored energies and integrals of powers, J; `residual` is the imbalance.
struct EnergyTerms {
  double kinetic = 0.0, strain = 0.0, potential = 0.0, dissipated = 0.0, work = 0.0, residual = 0.0;
};

/// The values at a stored instant.
struct Observed {
  std::vector<recovery::Response> probes;                          // empty without a bridge
  std::vector<recovery::Response> rail;                            // at the probes, then at the stations of output_rail
  std::vector<beam::Reaction> supports;                            // at the ends of spans
  std::array<std::vector<structure::Movement>, 2> support_motion;  // of the supports there, upward and along the beam
  coupling::Observation motion;
  std::optional<recovery::GroundForces> ground;     // with a bridge
  std::optional<recovery::SleeperForces> sleepers;  // forces of the sleepers in output_sleepers
  std::optional<recovery::RailDevices> devices;     // with a rail
  std::optional<recovery::MassDampers> dampers;     // with a bridge
  EnergyTerms energy;
};

/// Objects that do not change during a run; outputs may refer to them.
struct Source {
  const scene::Scene& scene;
  const train::Fleet& fleet;
  const beam::Beam* beam;  // null: none
};

/// A quantity of a Thing. `get` returns its numbers, a double or a std::array, and has no state.
template <class Thing>
struct Row {
  template <class Get>
  constexpr Row(const char* its_name, const char* its_unit, Get)
      : name(its_name),
        unit(its_unit),
        components(count(static_cast<std::invoke_result_t<Get, const Thing&>*>(nullptr))),
        append([](const Thing& thing, std::vector<double>& values) { add(Get{}(thing), values); }) {}

  const char* name;
  const char* unit;
  std::size_t components;  // 0: a single number
  void (*append)(const Thing& thing, std::vector<double>& values);

 private:
  static constexpr std::size_t count(const double*) { return 0; }
  template <std::size_t n>
  static constexpr std::size_t count(const std::array<double, n>*) {
    return n;
  }
  static void add(double number, std::vector<double>& values) { values.push_back(number); }
  template <std::size_t n>
  static void add(const std::array<double, n>& numbers, std::vector<double>& values) {
    values.insert(values.end(), numbers.begin(), numbers.end());
  }
};

/// A member as the quantity.
template <auto member>
inline constexpr auto of = [](const auto& thing) { return thing.*member; };

/// The datasets of a run that get a row at each sample.
class Outputs {
 public:
  /// Adds datasets `group` + name of one thing: [n] or [n, components]. get(now) returns the thing at an instant. The
  /// table must outlive the outputs.
  template <class Thing, std::size_t rows, class Get>
  void add(const std::string& group, const Row<Thing> (&table)[rows], Get get) {
    for (const Row<Thing>& row : table) describe(group + row.name, row.unit, {}, row.components);
    append_.push_back([table = std::span(table), get](const Observed& now, std::vector<double>& values) {
      const Thing& thing = get(now);
      for (const Row<Thing>& row : table) row.append(thing, values);
    });
  }
  /// Adds the table for `count` objects: [n, count] or [n, count, components]. get(now, i) returns object i.
  template <class Thing, std::size_t rows, class Get>
  void add_each(const std::string& group, const Row<Thing> (&table)[rows], std::size_t count, Get get) {
    for (const Row<Thing>& row : table) describe(group + row.name, row.unit, {count}, row.components);
    append_.push_back([table = std::span(table), count, get](const Observed& now, std::vector<double>& values) {
      for (const Row<Thing>& row : table)
        for (std::size_t i = 0; i < count; ++i) row.append(get(now, i), values);
    });
  }
  /// Adds one dataset [n, count]: get(now, i) returns number i.
  template <class Get>
  void add_numbers(std::string name, std::string unit, std::size_t count, Get get) {
    describe(std::move(name), std::move(unit), {count}, 0);
    append_.push_back([count, get](const Observed& now, std::vector<double>& values) {
      for (std::size_t i = 0; i < count; ++i) values.push_back(get(now, i));
    });
  }
  /// Adds one dataset [n] of a number that get(now) returns.
  template <class Get>
  void add_number(std::string name, std::string unit, Get get) {
    describe(std::move(name), std::move(unit), {}, 0);
    append_.push_back([get](const Observed& now, std::vector<double>& values) { values.push_back(get(now)); });
  }
  /// Adds a dataset that does not change with time.
  void add_constant(std::string name, std::vector<double> values, const char* unit) {
    layout_.constants.push_back({std::move(name), std::move(values), unit});
  }

  const results::Layout& layout() const { return layout_; }
  /// Sets the rows of all datasets at an instant.
  void fill(const Observed& now, std::vector<double>& values) const {
    values.clear();
    for (const auto& append : append_) append(now, values);
  }

 private:
  void describe(std::string name, std::string unit, std::vector<std::size_t> shape, std::size_t components) {
    if (components > 0) shape.push_back(components);
    layout_.fields.push_back({std::move(name), std::move(shape), std::move(unit)});
  }

  results::Layout layout_;
  std::vector<std::function<void(const Observed&, std::vector<double>&)>> append_;
};

/// All outputs of a scene. The source's objects must outlive them.
Outputs outputs_of(const Source& source);

/// The stations of probes and span ends, in files of modes and of sweeps.
std::vector<results::Layout::Constant> stations(const std::vector<double>& probes, const std::vector<double>& supports);
/// The layout of a file of many runs of a bridge: its stations, and nothing over time.
results::Layout layout_without_series(const scene::Scene& scene);

}  // namespace traverse::run
