// Lists the tables of a scene over time, and compares their first and last rows with the run.
#include "run/table_ends.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <set>

#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

/// What a table determines: a displacement cannot jump in rate, a force of 0 needs no note.
enum class Table { displacement, length, force };

using Use = std::function<void(const std::string&, const base::TimeFunction&, Table)>;

void of_vehicles(const scene::Scene& scene, const Use& use) {
  for (const int type : std::set<int>(scene.train.vehicles.begin(), scene.train.vehicles.end())) {
    const train::Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(type)];
    const auto option = [&](const std::string& part, const char* word) {
      return fmt::format("vehicle_{}_{}_{}", vehicle.name, part, word);
    };
    for (const multibody::Driver& d : vehicle.mechanism.drivers)
      use(option(d.name, "table"), d.value, Table::displacement);
    for (const multibody::Spring& s : vehicle.mechanism.springs)
      if (s.winding) use(option(s.name, "winding_table"), *s.winding, Table::length);
    for (const multibody::Actuator& a : vehicle.mechanism.actuators)
      for (const base::TimeFunction& action : a.action) use(option(a.name, "table"), action, Table::force);
  }
}

void of_scene(const scene::Scene& scene, const Use& use) {
  for (const base::TimeFunction& f : scene.support_motion) use("support_motion", f, Table::displacement);
  for (const base::TimeFunction& f : scene.support_motion_along) use("support_motion_along", f, Table::displacement);
  for (const train::Course& course : scene.load.courses)
    if (course.variation.table) use(course.name + "_table", *course.variation.table, Table::force);
  of_vehicles(scene, use);
}

void refuse_jolt(const std::string& option, const base::TimeFunction& f, double end) {
  const std::vector<double>& rows = f.rows();
  for (const std::size_t row : {std::size_t{0}, rows.size() - 1}) {
    const double t = rows[row], jump = f.jump_of_rate(row);
    if (!(t > 0.0 && t < end) || jump == 0.0) continue;
    throw InputError(fmt::format(
        "{}: the table {} at {:g} s, where the displacement would {} at once with a jump in speed of {:.4g}, by an "
        "infinite force; allowed: a table from 0 to the end of the run at {:g} s, or two equal {} rows",
        option, row == 0 ? "begins" : "ends", t, row == 0 ? "start" : "stop", std::abs(jump), end,
        row == 0 ? "first" : "last"));
  }
}

void add_note(const std::string& note, std::vector<std::string>& notes) {
  if (notes.empty() || notes.back() != note) notes.push_back(note);
}

}  // namespace

void check_table_ends(const scene::Scene& scene, double end, std::vector<std::string>& notes) {
  of_scene(scene, [&](const std::string& option, const base::TimeFunction& f, Table table) {
    if (f.straight()) return;
    if (table == Table::displacement) refuse_jolt(option, f, end);
    const std::vector<double>& rows = f.rows();
    const double last = f.value(rows.back());
    if (!(rows.back() < end) || f.value(rows[rows.size() - 2]) == last) return;
    if (table == Table::force && last == 0.0) return;
    const double rate = f.rate(rows.back() + end);  // far behind the table
    add_note(fmt::format("{}: the table ends at {:g} s, the run at {:g} s; {}", option, rows.back(), end,
                         rate != 0.0 ? fmt::format("without acceleration it goes on at {:.4g} m/s", rate)
                                     : std::string("the last value holds")),
             notes);
  });
  const auto of_speeds = [&](const std::vector<train::Course>& courses) {
    for (const train::Course& course : courses) {
      const std::vector<double> rows = course.speed.kinks();
      if (rows.size() < 2 || !(rows.back() < end) || course.speed.standstill() <= rows.back()) continue;
      if (course.speed.speed(rows[rows.size() - 2]) == course.speed.speed(rows.back())) continue;
      add_note(fmt::format("{}_speed_file: the table ends at {:g} s, the run at {:g} s; the last speed holds",
                           course.name, rows.back(), end),
               notes);
    }
  };
  of_speeds(scene.train.courses);
  of_speeds(scene.load.courses);
}

}  // namespace traverse::run
