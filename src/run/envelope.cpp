// Writes least and greatest deflections, accelerations, moments and shear forces of all probes with their times as the
// datasets of /envelope.
#include "run/envelope.hpp"

#include <string>
#include <utility>

namespace traverse::run {

std::vector<results::Recorder::Dataset> envelopes(const ResponseExtremes& peaks, bool forces) {
  std::vector<results::Recorder::Dataset> sets;
  if (peaks.probes() == 0) return sets;
  const auto add = [&](const std::string& name, Quantity q, double Range::End::*number, const char* unit) {
    std::vector<double> values;
    for (std::size_t p = 0; p < peaks.probes(); ++p)
      values.insert(values.end(), {peaks.range(q, p).least.*number, peaks.range(q, p).greatest.*number});
    sets.push_back({"/envelope/" + name, {peaks.probes(), 2}, std::move(values), unit});
  };
  const auto add_with_times = [&](const std::string& name, Quantity q, const char* unit) {
    add(name, q, &Range::End::value, unit);
    add(name + "_time", q, &Range::End::time, "s");
  };
  add_with_times("deflection", deflection, "m");
  add_with_times("acceleration", acceleration, "m/s2");
  if (!forces) return sets;
  add_with_times("moment", moment, "N m");
  add_with_times("shear", shear_force, "N");
  add("moment_shear", moment, &Range::End::other, "N");
  add("shear_moment", shear_force, &Range::End::other, "N m");
  return sets;
}

}  // namespace traverse::run
