// The state of an existing bridge: cracks, elastic or settled supports, temperature.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double station_rounding = 1e-9;  // m

bool is_nearly(double x, double other) { return std::abs(x - other) < station_rounding; }

/// Reads cracks with a width over which EI is reduced. Both ends become nodes of every mesh.
void read_weak_stretches(const Options& o, const std::vector<double>& x, beam::BeamModel& beam) {
  const std::vector<double> width = o.numbers("beam_cracks_width", x.size(), "one per station");
  const std::vector<double> factor = o.numbers("beam_cracks_EI_factor", x.size(), "one per station");
  double before = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double from = as_division(beam, x[i] - 0.5 * width[i]);
    const double to = as_division(beam, x[i] + 0.5 * width[i]);
    if (is_nearly(from, before)) from = before;
    if (from < before || to > beam.length())
      o.refuse("beam_cracks_width",
               fmt::format("the crack from {:g} to {:g} m is outside the beam or overlaps the crack "
                           "before it; allowed: within 0 to {:g} m, from left to right",
                           from, to, beam.length()));
    before = to;
    beam.EI = beam.EI.with_factor(from, to, factor[i]);
    for (const double end : {from, to})
      if (end > 0.0 && end < beam.length()) beam.cuts.push_back(end);
  }
}

/// The support without its vertical restraint, which a spring replaces.
beam::Support without_vertical(const Options& o, beam::Support support) {
  using beam::Support;
  if (support == Support::roller) return Support::free;
  if (support == Support::pinned) return Support::along;
  if (support == Support::clamped) return Support::guided;
  o.refuse("support_stiffness",
           "belongs to a support without vertical restraint; allowed: at rollers, pinned and clamped supports "
           "(support_types)");
}

/// Replaces vertical supports with a stiffness by springs.
void make_supports_elastic(const Options& o, const std::vector<double>& stiffness, const std::vector<double>& scour,
                           beam::BeamModel& beam) {
  double x = 0.0;
  for (std::size_t end = 0; end < stiffness.size(); ++end) {
    if (scour[end] > 0.0 && stiffness[end] == 0.0)
      o.refuse("support_scour", "reduces support_stiffness, which is 0 (rigid) there; allowed: 0 at rigid supports");
    if (stiffness[end] > 0.0) {
      const bool inner = end > 0 && end < beam.spans.size();
      if (inner && beam.joint(static_cast<int>(end)) == beam::Joint::separate)
        o.refuse("support_stiffness",
                 "belongs to a support on which two beams end; allowed: where the beam is continuous");
      beam.supports[end] = without_vertical(o, beam.supports[end]);
      beam::PointFoundation spring;
      spring.x = std::min(x, beam.length());
      spring.k = stiffness[end] * (1.0 - scour[end]);
      spring.option = "support_stiffness";
      beam.foundation.vertical.push_back(spring);
    }
    if (end < beam.spans.size()) x += beam.spans[end];
  }
}

}  // namespace

double as_division(const beam::BeamModel& beam, double x) {
  double end = beam.start;
  if (is_nearly(x, end)) return end;
  for (const double span : beam.spans) {
    end += span;
    if (is_nearly(x, end)) return end;
  }
  return x;
}

void read_cracks(const Options& o, beam::BeamModel& beam) {
  if (!o.has("beam_cracks_x")) return;
  const std::vector<double> x = o.numbers("beam_cracks_x");
  if (o.has("beam_cracks_width")) return read_weak_stretches(o, x, beam);
  const std::vector<double> k = o.numbers("beam_cracks_k", x.size(), "one per station");
  for (std::size_t i = 0; i < x.size(); ++i) beam.cracks.push_back({as_division(beam, x[i]), k[i]});
}

void read_bearings(const Options& o, beam::BeamModel& beam) {
  const std::size_t ends = beam.spans.size() + 1;
  const auto numbers = [&](const char* name) { return o.numbers(name, ends, "one per span end"); };
  if (o.has("support_settlement")) beam.settlement = numbers("support_settlement");
  if (!o.has("support_stiffness")) return;
  const std::vector<double> stiffness = numbers("support_stiffness"), scour = numbers("support_scour");
  make_supports_elastic(o, stiffness, scour, beam);
  for (std::size_t end = 0; end < beam.settlement.size(); ++end)
    if (beam.settlement[end] != 0.0 && stiffness[end] > 0.0)
      o.refuse("support_settlement", "a support with a settlement must be rigid; allowed: support_stiffness 0 there");
}

std::optional<beam::Temperature> read_temperature(const Options& o) {
  beam::Temperature t;
  t.uniform = o.number("beam_temperature_uniform");
  t.gradient = o.number("beam_temperature_gradient");
  t.expansion = o.number("beam_temperature_expansion");
  if (t.uniform == 0.0 && t.gradient == 0.0) return std::nullopt;
  const std::optional<double> depth = o.optional_number("beam_temperature_depth");
  if (t.gradient != 0.0 && !depth) o.refuse("beam_temperature_gradient", "needs beam_temperature_depth");
  t.depth = depth.value_or(1.0);
  return t;
}

}  // namespace traverse::scene
