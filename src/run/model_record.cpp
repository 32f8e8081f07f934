// Writes the datasets of /model: spans, supports, stiffness and mass along the bridge, foundations, vehicles with their
// bodies, wheels, springs and joints, and moving forces. The digest is of the sorted options and the texts of all input
// files, without options that leave the results unchanged. Deflections of a shape are those at the nodes from the
// stored displacement vector, and inside elements by recovery with the loads of that instant.
#include "run/model_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/digest.hpp"
#include "base/notes.hpp"
#include "beam/mesh.hpp"
#include "beam/shape.hpp"
#include "modes/modes.hpp"
#include "run/response_extremes.hpp"
#include "traverse/options/verdict_limit.hpp"

namespace traverse::run {
namespace {

using results::Recorder;
using Pairs = std::vector<std::pair<std::string, std::string>>;

constexpr const char* support_words[] = {"free", "roller", "pinned", "clamped", "guided", "along"};
constexpr const char* joint_words[] = {"continuous", "hinge", "separate"};

/// Adds rows of `columns` numbers; no dataset if there are no rows.
void add_rows(Recorder& recorder, const std::string& name, std::size_t columns, std::vector<double> values,
              std::string unit) {
  if (values.empty()) return;
  const std::size_t rows = values.size() / columns;
  std::vector<std::size_t> shape = {rows};
  if (columns > 1) shape.push_back(columns);
  recorder.datasets({{"/model/" + name, std::move(shape), std::move(values), std::move(unit)}});
}

/// Rows of x and value; two rows at a jump.
std::vector<double> along(const beam::Distribution& quantity, double from, double to) {
  std::vector<double> rows;
  const auto add = [&](double x, double inside) { rows.insert(rows.end(), {x, quantity.at(x, inside)}); };
  double previous = from;
  add(from, to);
  for (const double x : quantity.breaks(from, to)) {
    add(x, previous);
    if (quantity.at(x, previous) != quantity.at(x, to)) add(x, to);
    previous = x;
  }
  add(to, from);
  return rows;
}

void record_foundation(const beam::BeamModel& beam, Recorder& recorder) {
  beam::for_points(beam.foundation, [&](const beam::FoundationKind& kind, const auto& points) {
    std::vector<double> rows;
    for (const beam::PointFoundation& p : points)
      rows.insert(rows.end(), {p.x, p.k, p.c, p.law.gap, p.law.one_sided ? 1.0 : 0.0, p.law.cubic, p.law.slides_at});
    const beam::FoundationUnits units = units_of(kind);
    add_rows(recorder, fmt::format("foundation/{}", kind.name), 7, std::move(rows),
             fmt::format("m, {}, {}, {}, 1, {}, N", units.k, units.c, units.gap, units.cubic));
  });
  beam::for_beds(beam.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    add_rows(recorder, fmt::format("foundation/{}", kind.name), 2, along(bed.k, beam.start, beam.end()),
             fmt::format("m, {}", units_of(kind).k));
  });
}

void record_bridge(const beam::BeamModel& beam, Recorder& recorder) {
  add_rows(recorder, "spans", 1, beam.spans, "m");
  Pairs supports;
  const int ends = static_cast<int>(beam.supports.size());
  for (int i = 0; i < ends; ++i) {
    const bool inner = i > 0 && i + 1 < ends;
    supports.emplace_back(support_words[static_cast<std::size_t>(beam.supports[static_cast<std::size_t>(i)])],
                          inner ? joint_words[static_cast<std::size_t>(beam.joint(i))] : "end");
  }
  if (!supports.empty()) recorder.tables({{"/model/supports", supports}});
  if (beam.given) return;
  add_rows(recorder, "hinges", 1, beam.hinges, "m");
  add_rows(recorder, "EI", 2, along(beam.EI, beam.start, beam.end()), "m, N m2");
  if (beam.GA) add_rows(recorder, "GA", 2, along(*beam.GA, beam.start, beam.end()), "m, N");
  if (beam.rotary_inertia.maximum() > 0.0)
    add_rows(recorder, "rotary_inertia", 2, along(beam.rotary_inertia, beam.start, beam.end()), "m, kg m");
  std::vector<double> cracks;
  for (const beam::Crack& crack : beam.cracks) cracks.insert(cracks.end(), {crack.x, crack.k});
  add_rows(recorder, "cracks", 2, std::move(cracks), "m, N m/rad");
  std::vector<double> masses, dampers;
  Pairs names;
  for (const beam::PointMass& one : beam.point_masses) masses.insert(masses.end(), {one.x, one.mass});
  for (const beam::MassDamper& one : beam.dampers) {
    dampers.insert(dampers.end(), {one.x, one.mass, one.k, one.c});
    names.emplace_back(std::to_string(names.size()), one.name);
  }
  add_rows(recorder, "point_masses", 2, std::move(masses), "m, kg");
  add_rows(recorder, "dampers", 4, std::move(dampers), "m, kg, N/m, N s/m");
  if (!names.empty()) recorder.tables({{"/model/damper_names", names}});
  add_rows(recorder, "settlement", 1, beam.settlement, "m");
  if (beam.temperature)
    add_rows(recorder, "temperature", 2, {beam.temperature->strain(), beam.temperature->curvature()}, "1, 1/m");
  add_rows(recorder, "mass", 2, along(beam.mass, beam.start, beam.end()), "m, kg/m");
  record_foundation(beam, recorder);
}

void record_type(const train::Vehicle& vehicle, const std::string& group, Recorder& recorder) {
  Pairs names, joint_names;
  std::vector<double> bodies, wheels, springs, ropes, joints, joint_ends;
  for (const multibody::Body& b : vehicle.mechanism.bodies) {
    names.emplace_back(vehicle.name, b.name);
    bodies.insert(bodies.end(), {b.position.x(), b.position.y(), b.mass});
  }
  for (const train::Wheel& w : vehicle.wheels) {
    const multibody::Body& body = vehicle.mechanism.bodies[static_cast<std::size_t>(w.body)];
    wheels.insert(wheels.end(), {body.position.x(), body.position.y(), w.radius});
  }
  for (const multibody::Spring& s : vehicle.mechanism.springs)
    springs.insert(springs.end(), {s.from.x(), s.from.y(), s.to.x(), s.to.y(), static_cast<double>(s.bodies[0]),
                                   static_cast<double>(s.bodies[1])});
  for (std::size_t i = 0; i < vehicle.mechanism.ropes.size(); ++i) {
    const multibody::Rope& rope = vehicle.mechanism.ropes[i];
    for (std::size_t p = 0; p < rope.points.size(); ++p)
      ropes.insert(ropes.end(), {static_cast<double>(i), rope.points[p].x(), rope.points[p].y(),
                                 static_cast<double>(rope.bodies[p])});
  }
  for (const multibody::Joint& j : vehicle.mechanism.joints) {
    const Eigen::Vector2d from = j.type->needs.ends ? j.from : j.point, to = j.type->needs.ends ? j.to : j.point;
    joint_names.emplace_back(j.name, j.type->name);
    joints.insert(joints.end(),
                  {from.x(), from.y(), static_cast<double>(j.bodies[0]), static_cast<double>(j.bodies[1])});
    joint_ends.insert(joint_ends.end(), {from.x(), from.y(), to.x(), to.y()});
  }
  if (!names.empty()) recorder.tables({{"/model/" + group + "/names", names}});
  if (!joint_names.empty()) recorder.tables({{"/model/" + group + "/joint_names", joint_names}});
  add_rows(recorder, group + "/bodies", 3, std::move(bodies), "m, m, kg");
  add_rows(recorder, group + "/wheels", 3, std::move(wheels), "m, m, m");
  add_rows(recorder, group + "/springs", 6, std::move(springs), "m, m, m, m, 1, 1");
  add_rows(recorder, group + "/ropes", 4, std::move(ropes), "1, m, m, 1");
  add_rows(recorder, group + "/joints", 4, std::move(joints), "m, m, 1, 1");
  add_rows(recorder, group + "/joint_ends", 4, std::move(joint_ends), "m, m, m, m");
}

void record_load(const train::MovingLoad& load, const std::string& name, Recorder& recorder) {
  std::vector<double> forces, lines;
  for (std::size_t i = 0; i < load.forces.size(); ++i) {
    const double length = length_of(load, i);
    if (length == 0.0) {
      forces.insert(forces.end(), {load.positions[i], load.forces[i]});
    } else {
      lines.insert(lines.end(),
                   {load.positions[i] - 0.5 * length, load.positions[i] + 0.5 * length, load.forces[i] / length});
    }
  }
  add_rows(recorder, "forces/" + name, 2, std::move(forces), "m, N");
  add_rows(recorder, "line_loads/" + name, 3, std::move(lines), "m, m, N/m");
}

/// Stores the courses: their number, the first vehicle or force of each, and its speed at the times at which its
/// acceleration changes.
template <class Moving>
void record_courses(const Moving& moving, const std::string& name, Recorder& recorder) {
  std::vector<double> rows;
  Pairs names;
  for (std::size_t i = 0; i < moving.courses.size(); ++i) {
    const train::Course& course = moving.courses[i];
    const auto add = [&](double t) {
      rows.insert(rows.end(), {static_cast<double>(i), static_cast<double>(course.first), t, course.speed.speed(t)});
    };
    if (course.speed.constant()) add(0.0);
    for (const double t : course.speed.kinks()) add(t);
    names.emplace_back(std::to_string(i), course.name);
  }
  add_rows(recorder, name, 4, std::move(rows), "1, 1, s, m/s");
  std::vector<results::Attribute> list;
  for (auto& [number, text] : names) list.push_back({number, text});
  if (!list.empty()) recorder.attributes("/model/" + name, list);
}

void record_train(const scene::Scene& scene, Recorder& recorder) {
  record_courses(scene.train, "trains", recorder);
  record_courses(scene.load, "loads", recorder);
  std::vector<double> train;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    train.insert(train.end(), {static_cast<double>(scene.train.vehicles[i]), scene.train.positions[i]});
  add_rows(recorder, "train", 2, std::move(train), "1, m");
  for (std::size_t i = 0; i < scene.vehicles.size() && !scene.train.vehicles.empty(); ++i)
    record_type(scene.vehicles[i], fmt::format("vehicles/{}", i), recorder);
  if (!scene.sweep || scene.sweep->trains.empty()) return record_load(scene.load, "load", recorder);
  for (std::size_t i = 0; i < scene.sweep->trains.size(); ++i)
    record_load(scene.sweep->loads[i], fmt::format("A{}", scene.sweep->trains[i]), recorder);
}

/// /quantities: the quantities of peaks and limits, each with its unit.
void record_quantities(Recorder& recorder) {
  Pairs peaks, limits;
  for (std::size_t q = 0; q < quantities; ++q) peaks.emplace_back(stored_names[q], quantity_units[q]);
  for (const options::LimitQuantity& row : options::limit_quantities) limits.emplace_back(row.name, row.unit);
  recorder.tables({{"/quantities/peaks", peaks}, {"/quantities/limits", limits}});
}

constexpr std::size_t points_per_call = 4000;  // points inside elements in one call; each needs a kilobyte

using Point = beam::ShapePoints::Point;

/// Collective. Adds the deflections of the track at the nodes of all ranks.
void add_nodes(const beam::Beam& beam, const std::vector<double>& v, const std::vector<Point>& points,
               std::vector<double>& deflection) {
  const beam::Line& line = beam.bridge();
  const auto add = [&](std::size_t i, int component, double factor) {
    const int local = points[i].node < 0 ? -1 : beam.local(line.unknown(points[i].node, component));
    if (local >= 0) deflection[i] += factor * v[static_cast<std::size_t>(local)];
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(i, 1, 1.0);
    if (line.has_tracks_beside()) add(i, 5, line.eccentricity(0));
  }
  MPI_Allreduce(MPI_IN_PLACE, deflection.data(), static_cast<int>(deflection.size()), MPI_DOUBLE, MPI_SUM, beam.comm());
}

/// Collective. Sets the deflections of points[which[0]], points[which[1]], ...
void fill_inside(const beam::Beam& beam, double self_weight, const LargestDeflection& worst,
                 const std::vector<Point>& points, const std::vector<std::size_t>& which,
                 std::vector<double>& deflection) {
  std::vector<double> stations;
  for (const std::size_t i : which) stations.push_back(points[i].x);
  recovery::Recovery recovery(beam, std::move(stations), self_weight);
  std::vector<recovery::Response> responses;
  recovery.evaluate(worst.v.data(), worst.w.data(), worst.a.data(), worst.loads, responses);
  for (std::size_t k = 0; k < which.size(); ++k) deflection[which[k]] = responses[k].deflection;
}

}  // namespace

void record_notes(const std::vector<std::string>& notes, results::Recorder& recorder) {
  Pairs rows;
  for (const std::string& note : notes) rows.emplace_back(std::to_string(rows.size() + 1), base::text_of_note(note));
  if (!rows.empty()) recorder.tables({{"/model/notes", rows}});
}

void record_model(const scene::Scene& scene, const std::vector<std::string>& notes, results::Recorder& recorder) {
  record_notes(notes, recorder);
  record_quantities(recorder);
  if (scene.beam) record_bridge(*scene.beam, recorder);
  record_train(scene, recorder);
}

void record_modes(const SharedBeam& shared, results::Recorder& recorder) {
  if (!shared.omega) return;
  const auto [omega1, omega2] = *shared.omega;
  modes::Modes modes;
  if (shared.modal)
    modes = modes::as_stored(*shared.beam, shared.modal->basis(), beam::ShapePoints(shared.beam->mesh()));
  for (const SharedBeam::RatioOfMode& mode : shared.damping_ratios()) {
    if (!shared.modal) modes.omega.push_back(mode.omega);
    if (shared.modal && !shared.modal->dampers_couple()) modes.ratio.push_back(mode.beam + mode.dampers);
    modes.beam_ratio.push_back(mode.beam);
    modes.damper_ratio.push_back(mode.dampers);
  }
  recorder.modes(modes, shared.rayleigh.a, shared.rayleigh.b, omega1, omega2);
}

std::string digest_of(const scene::Scene& scene, std::span<const std::string_view> excluded,
                      const std::vector<options::InputText>& files, std::string_view more) {
  auto entries = scene.options;
  std::erase_if(entries, [&](const auto& option) {
    const std::string& name = option.first;
    const bool display_only = name == "verbose" || name.starts_with("ts_monitor") || name.starts_with("log_") ||
                              name.starts_with("report_") || name.find("_view") != name.npos;
    return display_only || std::find(excluded.begin(), excluded.end(), name) != excluded.end();
  });
  std::sort(entries.begin(), entries.end());
  base::Digest digest;
  const auto add = [&](std::string_view text) {
    digest.add(std::to_string(text.size()) + ":");
    digest.add(text);
  };
  for (const auto& [name, value] : entries) {
    add(name);
    add(value);
  }
  for (const options::InputText& file : files) add(file.text);
  add(more);
  return fmt::format("{:016x}", digest.value());
}

results::Shape shape_of(const beam::Beam& beam, const scene::Scene& scene, const LargestDeflection& worst) {
  const beam::ShapePoints shape(beam.mesh(), scene.output.probes);
  const std::vector<Point>& points = shape.points();
  results::Shape out{worst.time, shape.x(), std::vector<double>(points.size(), 0.0)};
  add_nodes(beam, worst.v, points, out.deflection);
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].node < 0) which.push_back(i);
    if (which.size() < points_per_call && (i + 1 < points.size() || which.empty())) continue;
    fill_inside(beam, scene.self_weight ? scene.gravity : 0.0, worst, points, which, out.deflection);
    which.clear();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const beam::SupportLine line = beam.support_lines().at(points[i].x);
    out.deflection[i] -= line.height(beam.model().settlement) + line.height(worst.ground);
  }
  return out;
}

}  // namespace traverse::run
