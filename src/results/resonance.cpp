// Writes the datasets of resonance speeds v = f d/i and cancellation speeds, and prints the speeds of the first mode in
// km/h.
#include "results/resonance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace traverse::results {
void record(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
            const std::vector<Cancellation>& cancellations, Recorder& recorder) {
  std::vector<Recorder::Dataset> sets;
  const auto add = [&sets](const char* name, const char* unit, const auto& list, auto get) {
    std::vector<double> values;
    for (const auto& one : list) values.push_back(get(one));
    if (!values.empty()) sets.push_back({name, {values.size()}, values, unit});
  };
  if (!trains.empty())
    add("/resonances/hslm_a", "1", resonances,
        [&](const Resonance& r) { return static_cast<double>(trains[r.train]); });
  add("/resonances/mode", "1", resonances, [](const Resonance& r) { return static_cast<double>(r.mode); });
  add("/resonances/order", "1", resonances, [](const Resonance& r) { return static_cast<double>(r.order); });
  add("/resonances/frequency", "Hz", resonances, [](const Resonance& r) { return r.frequency; });
  add("/resonances/distance", "m", resonances, [](const Resonance& r) { return r.distance; });
  add("/resonances/speed", "m/s", resonances, [](const Resonance& r) { return r.speed; });
  add("/resonances/deflection_speed", "m/s", resonances, [](const Resonance& r) { return r.of_deflection; });
  add("/resonances/acceleration_speed", "m/s", resonances, [](const Resonance& r) { return r.of_acceleration; });
  add("/cancellations/mode", "1", cancellations, [](const Cancellation& c) { return static_cast<double>(c.mode); });
  add("/cancellations/half_waves", "1", cancellations,
      [](const Cancellation& c) { return static_cast<double>(c.half_waves); });
  add("/cancellations/speed", "m/s", cancellations, [](const Cancellation& c) { return c.speed; });
  recorder.datasets(sets);
}

void print(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
           const std::vector<Cancellation>& cancellations) {
  const std::size_t none = std::max<std::size_t>(1, trains.size());
  std::size_t last = none;
  for (const Resonance& r : resonances) {
    if (r.mode != 1) continue;
    if (last == none) fmt::print("resonances v = f1 d/i of f1 {:.4g} Hz, km/h", r.frequency);
    if (r.train != last)
      fmt::print("\n  {}d {:.4g} m", trains.empty() ? "" : fmt::format("{:>5}  ", fmt::format("A{}", trains[r.train])),
                 r.distance);
    last = r.train;
    fmt::print("; i {} predicted {:.4g}, {}", r.order, 3.6 * r.speed,
               std::isnan(r.of_deflection) ? "no peak there" : fmt::format("found {:.4g}", 3.6 * r.of_deflection));
  }
  if (last < none) fmt::print("\n");
  std::string speeds;
  for (const Cancellation& c : cancellations)
    if (c.mode == 1) speeds += fmt::format("{}{:.4g}", speeds.empty() ? "" : ", ", 3.6 * c.speed);
  if (!speeds.empty()) fmt::print("cancellation speeds v = 2 f1 L/(2 k + 1): {} km/h\n", speeds);
  std::fflush(stdout);
}

}  // namespace traverse::results
