// Reads the masses on a beam: those that move with it, and tuned mass dampers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "options/relations.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

beam::MassDamper read_damper(const Options& o, const std::string& name, const beam::BeamModel& beam) {
  const std::string prefix = "beam_" + name + "_";
  options::check_relations(o, options::Related::damper, prefix);
  beam::MassDamper damper;
  damper.name = name;
  damper.x = as_division(beam, place_on_beam(o, prefix + "x", o.number(prefix + "x"), beam.length()));
  damper.mass = o.number(prefix + "mass");
  if (o.has(prefix + "k")) {
    damper.k = o.number(prefix + "k");
  } else {
    const double omega = 2.0 * std::numbers::pi * o.number(prefix + "frequency");
    damper.k = damper.mass * omega * omega;
  }
  damper.c = o.has(prefix + "c") ? o.number(prefix + "c")
                                 : 2.0 * o.number(prefix + "damping_ratio") * std::sqrt(damper.k * damper.mass);
  return damper;
}

}  // namespace

void declare_named(Options& o, const std::string& list, const std::string& group, const std::string& what,
                   std::span<const options::Row> rows) {
  if (!o.has(list)) return;
  for (const std::string& name : o.texts(list))
    for (const options::Row& row : rows) {
      const std::string full = fmt::format("{}_{}_{}", group, name, row.name);
      if (!o.declare(full, row))
        o.refuse(list, fmt::format("two options would have the name {}; rename a {}", full, what));
    }
}

void declare_dampers(Options& o) { declare_named(o, "beam_dampers", "beam", "damper", options::damper_rows()); }

void read_masses(const Options& o, beam::BeamModel& beam) {
  if (o.has("beam_point_masses_x")) {
    const std::vector<double> x = o.numbers("beam_point_masses_x");
    const std::vector<double> mass = o.numbers("beam_point_masses_mass", x.size(), "one per station");
    for (std::size_t i = 0; i < x.size(); ++i)
      beam.point_masses.push_back(
          {as_division(beam, place_on_beam(o, "beam_point_masses_x", x[i], beam.length())), mass[i]});
  }
  if (o.has("beam_dampers"))
    for (const std::string& name : o.texts("beam_dampers")) beam.dampers.push_back(read_damper(o, name, beam));
}

}  // namespace traverse::scene
