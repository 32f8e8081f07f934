// Reads the options of beam, supports and foundation of a scene, and decides whether the beam has axial unknowns, which
// it needs if something in the scene acts along it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/notes.hpp"
#include "limits.hpp"
#include "options/relations.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double elements_per_half_wave = 2.0;  // of the highest mode of a track beside the axis
constexpr double most_stations = 1e6;           // limit for equally spaced springs

/// The number of elements per span for the accuracy. It is even, so that midspan is a node. The error of deflections is
/// of fourth order in the element length.
int elements_from_accuracy(double accuracy) {
  const double wanted = 10.0 * std::pow(1e-3 / accuracy, 0.25);
  return std::max(4, 2 * static_cast<int>(std::lround(wanted / 2.0)));
}

void read_mesh(const Options& o, Scene& scene) {
  beam::BeamModel& beam = *scene.beam;
  beam.spans = o.numbers("beam_spans");
  const std::size_t spans = beam.spans.size();
  if (o.has("beam_elements_per_span")) {
    beam.elements = o.integers("beam_elements_per_span", spans, "one per span");
  } else {
    const int chosen = elements_from_accuracy(scene.accuracy);
    beam.elements.assign(spans, chosen);
    scene.mesh_open = true;
  }
}

beam::Support support_of(const std::string& word) {
  if (word == "free") return beam::Support::free;
  if (word == "pinned") return beam::Support::pinned;
  if (word == "clamped") return beam::Support::clamped;
  if (word == "guided") return beam::Support::guided;
  return beam::Support::roller;
}

beam::Joint joint_of(const std::string& word) {
  if (word == "continuous") return beam::Joint::continuous;
  return word == "hinge" ? beam::Joint::hinge : beam::Joint::separate;
}

void read_joints(const Options& o, beam::BeamModel& beam) {
  const std::size_t inner = beam.spans.size() - 1;
  const auto words = o.texts("beam_continuity", std::max<std::size_t>(inner, 1), "one per inner span end");
  for (const std::string& word : words) beam.joints.push_back(joint_of(word));
  if (!o.has("beam_hinges")) return;
  for (const double x : o.numbers("beam_hinges")) beam.hinges.push_back(as_division(beam, x));
  std::sort(beam.hinges.begin(), beam.hinges.end());
}

void read_supports(const Options& o, beam::BeamModel& beam) {
  const std::size_t ends = beam.spans.size() + 1;
  if (!o.has("support_types")) {
    beam.supports.assign(ends, beam.all_separate() ? beam::Support::pinned : beam::Support::roller);
    beam.supports.front() = beam::Support::pinned;
    return;
  }
  for (const std::string& word : o.texts("support_types", ends, "one per span end")) {
    beam.supports.push_back(support_of(word));
  }
}

/// The line of a track, whose options begin with the name of the block.
beam::ActionLine read_track_line(const Options& o, const Block& block, double shear_centre) {
  beam::ActionLine line{o.number(block.option("eccentricity")) - shear_centre};
  const double height = o.number(block.option("load_height"));
  line.shift = height * o.number(block.option("cant")) / o.number(block.option("cant_base"));
  const std::string radius = block.option("curve_radius");
  if (!o.has(radius)) return line;
  if (o.number(radius) == 0.0 || o.number("gravity") == 0.0) o.refuse(radius, "allowed: not 0, with gravity");
  line.shift_by_speed = -(o.number(block.option("height")) + height) / (o.number("gravity") * o.number(radius));
  return line;
}

/// Reads the torsion of the beam; the supports must have been read.
void read_torsion(const Options& o, Scene& scene) {
  if (!o.has("beam_GJ")) return;
  beam::BeamModel& beam = *scene.beam;
  beam::Torsion torsion;
  torsion.GJ = read_distribution(o, "beam_GJ");
  if (o.has("beam_ECw")) torsion.warping = read_distribution(o, "beam_ECw");
  torsion.inertia = read_distribution(o, "beam_polar_inertia");
  const double shear_centre = torsion.shear_centre = o.number("beam_shear_centre");
  torsion.mass_centre = o.number("beam_mass_centre") - shear_centre;
  torsion.tracks = {read_track_line(o, {"track", {}}, shear_centre)};
  for (const Block& block : blocks_of(o, "tracks"))
    scene.tracks.push_back({block.name, read_track_line(o, block, shear_centre)});
  const bool beside = torsion.tracks.front() != beam::ActionLine() ||
                      std::ranges::any_of(scene.tracks, [](const Track& t) { return t.line != beam::ActionLine(); });
  if (!scene.tracks.empty()) torsion.tracks.clear();  // trains and loads name those that they run on
  const bool by_modes = o.has("model_modes") && o.integer("model_modes") > 0;
  const std::size_t ends = beam.supports.size();
  const std::vector<std::string> words = o.texts("support_torsion", ends, "one per span end, or one for all");
  for (std::size_t end = 0; end < ends; ++end)
    torsion.held.push_back(beam::fixes_vertical(beam.supports[end]) && words[end] == "held" ? 1 : 0);
  if (o.has("support_bearing_spacing"))
    torsion.bearing_spacing = o.numbers("support_bearing_spacing", ends, "one per span end, or one for all");
  if (beside && by_modes && scene.mesh_open) {
    // The spans share the half waves of the modes.
    const int in_span = 2 * static_cast<int>(std::ceil(0.5 * elements_per_half_wave * o.integer("model_modes") /
                                                       static_cast<double>(beam.spans.size())));
    for (int& elements : beam.elements) elements = std::max(elements, in_span);
  }
  beam.torsion = std::move(torsion);
}

std::pair<double, double> pair_of(const std::vector<double>& two) { return {two[0], two[1]}; }

void read_damping(const Options& o, Damping& damping) {
  if (o.has("beam_rayleigh")) damping.rayleigh = pair_of(o.numbers("beam_rayleigh"));
  if (o.has("beam_damping_ratios")) damping.ratios = pair_of(o.numbers("beam_damping_ratios", 2, "zeta1 and zeta2"));
  if (!o.has("beam_damping_frequencies")) return;
  damping.frequencies = pair_of(o.numbers("beam_damping_frequencies"));
  if (damping.frequencies->first == damping.frequencies->second) {
    o.refuse("beam_damping_frequencies", "allowed: two different frequencies");
  }
}

/// Whether two beams end at x, or the slope can be discontinuous there.
bool is_joint(const beam::BeamModel& beam, double x) {
  if (std::find(beam.hinges.begin(), beam.hinges.end(), x) != beam.hinges.end()) return true;
  if (std::any_of(beam.cracks.begin(), beam.cracks.end(), [&](const beam::Crack& c) { return c.x == x; })) return true;
  double end = beam.start;
  for (std::size_t i = 1; i < beam.spans.size(); ++i) {
    end += beam.spans[i - 1];
    if (end == x && beam.joint(static_cast<int>(i)) != beam::Joint::continuous) return true;
  }
  return false;
}

bool is_span_end(const beam::BeamModel& beam, double x) {
  double end = beam.start;
  bool found = x == end;
  for (const double span : beam.spans) {
    end += span;
    found = found || x == end;
  }
  return found;
}

/// Adds a point to the list, on the given side of a joint, or one on each side.
void add_point(const Options& o, const beam::BeamModel& beam, const std::string& option, const std::string& side,
               beam::PointFoundation point, std::vector<beam::PointFoundation>& points) {
  if (side != "right" && !is_joint(beam, point.x)) {
    o.refuse(option, fmt::format("{} at {:g} m, where the beam is continuous; allowed there: right", side, point.x));
  }
  point.from_left = side != "right";
  points.push_back(point);
  if (side != "both") return;
  point.from_left = false;
  points.push_back(point);
}

/// The listed stations, or equally spaced stations from the first to the last.
std::vector<double> read_stations(const Options& o, const std::string& name) {
  std::vector<double> x = o.numbers(name + "_x");
  if (!o.has(name + "_spacing")) return x;
  if (x.size() != 2 || !(x[1] > x[0])) o.refuse(name + "_x", "allowed with a spacing: the first and the last station");
  const double spacing = o.number(name + "_spacing"), bays = std::round((x[1] - x[0]) / spacing);
  o.check_at_most(name + "_spacing", bays, most_stations, "stations");
  if (std::abs(x[0] + bays * spacing - x[1]) > 1e-6 * spacing)
    o.refuse(name + "_spacing",
             fmt::format("does not divide the distance from {:g} to {:g} m into equal parts", x[0], x[1]));
  std::vector<double> all;
  for (int i = 0; i <= static_cast<int>(bays); ++i) all.push_back(x[0] + i * spacing);
  return all;
}

std::vector<beam::PointFoundation> read_points(const Options& o, const beam::FoundationKind& kind,
                                               const beam::BeamModel& beam) {
  const std::string name = "foundation_" + std::string(kind.name);
  const bool vertical = kind.direction == beam::Direction::vertical;
  std::vector<beam::PointFoundation> points;
  options::check_relations(o, options::Related::springs, name + "_");
  if (!o.has(name + "_x")) return points;
  const std::vector<double> x = read_stations(o, name);
  const auto numbers = [&](const char* what) { return o.numbers(name + what, x.size(), "one per station"); };
  const auto words = [&](const char* what) { return o.texts(name + what, x.size(), "one per station"); };
  const std::vector<double> k = numbers("_k"), c = numbers("_c"), gap = numbers("_gap"), cubic = numbers("_cubic");
  const auto along_x = [&](const char* what) {
    return kind.direction == beam::Direction::longitudinal ? numbers(what) : std::vector<double>(x.size(), 0.0);
  };
  const std::vector<double> depth = along_x("_depth"), limit = along_x("_limit");
  const std::vector<double> eccentricity = vertical && beam.torsion ? numbers("_eccentricity") : std::vector<double>();
  const std::vector<std::string> side = words("_side");
  const std::vector<std::string> one_sided =
      vertical ? words("_one_sided") : std::vector<std::string>(x.size(), "false");
  const double length = beam.length();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const beam::FoundationLaw law{one_sided[i] == "true", gap[i], cubic[i], limit[i]};
    beam::PointFoundation point{place_on_beam(o, name + "_x", x[i], length), k[i], c[i], false, law};
    point.depth = depth[i];
    if (!eccentricity.empty()) point.eccentricity = eccentricity[i] - beam.torsion->shear_centre;
    if (point.depth != 0.0 && !is_span_end(beam, point.x))
      o.refuse(name + "_depth", fmt::format("at {:g} m, within a span; allowed: 0, or stations at span ends", point.x));
    add_point(o, beam, name + "_side", side[i], point, points);
  }
  return points;
}

std::optional<beam::Bed> read_bed(const Options& o, const beam::FoundationKind& kind) {
  const std::string name = "foundation_" + std::string(kind.name);
  const bool vertical = kind.direction == beam::Direction::vertical;
  const beam::FoundationLaw law{vertical && o.flag(name + "_one_sided"), o.number(name + "_gap"),
                                o.number(name + "_cubic")};
  options::check_relations(o, options::Related::bed, name + "_");
  if (!o.has(name + "_k") && !o.has(name + "_c") && !o.has(name + "_cubic")) return std::nullopt;
  return beam::Bed{read_distribution(o, name + "_k"), read_distribution(o, name + "_c"), law};
}

bool acts_along_x(const options::Options& o, const std::string& actuator) {
  return o.has(actuator + "_table") || o.numbers(actuator + "_force").front() != 0.0;
}

/// The option of a layered track that acts only along x; empty if there is none.
std::string option_along_the_track(const options::Options& o, const Scene& scene) {
  if (!scene.beam->track) return "";
  if (o.number("track_rail_temperature") != 0.0) return "track_rail_temperature";
  if (scene.beam->track->slides()) return "track_longitudinal_limit";
  if (!scene.beam->track->expansion_devices.empty()) return "track_rail_expansion_devices";
  return "";
}

/// A description of the action along the beam; empty if there is none. The horizontal components of normal forces on an
/// inclined surface are neglected.
std::string longitudinal_action(const options::Options& o, const Scene& scene) {
  const beam::Foundation& foundation = scene.beam->foundation;
  if (present(foundation, beam::Direction::longitudinal)) return "longitudinal foundations";
  if (scene.beam->temperature && scene.beam->temperature->strain() != 0.0) return "temperature";
  if (o.has("support_motion_along")) return "support_motion_along";
  if (!option_along_the_track(o, scene).empty()) return "the track's resistance along x";
  if (scene.beam->gradient != 0.0 && (scene.self_weight || !scene.vehicles.empty())) return "track_gradient";
  if (scene.analysis == Analysis::rail_forces) return "the requested rail forces";
  if (scene.analysis == Analysis::modes) return "the requested modes";
  const auto& courses = scene.train.courses;
  const bool speed_changes =
      std::any_of(courses.begin(), courses.end(), [](const train::Course& c) { return !c.speed.constant(); });
  for (const Vehicle& vehicle : scene.vehicles) {
    const bool rolls = !vehicle.wheels.empty();
    if (rolls && scene.train.drive == Drive::free) return "train_drive free";
    if (rolls && speed_changes) return "trains whose speed changes";
    for (const Wheel& wheel : vehicle.wheels) {
      if (wheel.law.friction > 0.0) return "friction of wheels";
    }
    for (const multibody::Actuator& actuator : vehicle.mechanism.actuators) {
      if (rolls && acts_along_x(o, "vehicle_" + vehicle.name + "_" + actuator.name)) return "actuators along x";
    }
  }
  return "";
}

}  // namespace

double place_on_beam(const Options& o, const std::string& name, double x, double length) {
  if (x > length * (1.0 + 1e-12))
    o.refuse(name, fmt::format("{:g} is outside the beam; allowed: from 0 to {:g} m", x, length));
  return std::min(x, length);
}

beam::Distribution read_distribution(const Options& o, const std::string& name) {
  if (o.is_number(name)) return o.number(name);
  beam::Distribution table = from_table(o, name, {}, [&](const auto& columns) {
    return beam::Distribution(columns[0], columns[1], fmt::format("{} ({})", name, o.path(name)));
  });
  const options::Row& row = *o.find_known(name);
  for (const double value : {table.minimum(), table.maximum()}) {
    if (!row.range.contains(value))
      o.refuse(name, fmt::format("contains {:g}; allowed: {}", value, options::allowed(row)));
  }
  return table;
}

beam::Foundation read_foundation(const Options& o, const beam::BeamModel& beam) {
  beam::Foundation f;
  for (const beam::FoundationKind& kind : beam::foundation_kinds) {
    if (kind.points != nullptr) {
      f.*kind.points = read_points(o, kind, beam);
    } else {
      f.*kind.bed = read_bed(o, kind);
    }
  }
  return f;
}

namespace {

/// The shear layer of a Pasternak foundation, G v'^2/2 per length, and the tension of the beam. A tension T adds T
/// v'^2/2 per length to the strain energy, as a rotational bed of the stiffness T does. SharedBeam refuses a
/// compression at which the beam buckles.
void read_tension(const Options& o, beam::BeamModel& beam) {
  if (o.has("foundation_shear_layer"))
    beam.foundation.rotational_bed =
        beam::Bed{read_distribution(o, "foundation_shear_layer"), 0.0, {}, "foundation_shear_layer"};
  if (!o.has("beam_tension")) return;
  beam::Distribution tension = read_distribution(o, "beam_tension");
  if (tension.minimum() < 0.0 && tension.maximum() > 0.0)
    o.refuse("beam_tension", "allowed: tension everywhere, or compression everywhere");
  if (tension.minimum() == 0.0 && tension.maximum() == 0.0) o.refuse("beam_tension", "allowed: a force other than 0");
  beam.foundation.rotational_bed = beam::Bed{std::move(tension), 0.0, {}, "beam_tension"};
}

void read_ground(const Options& o, beam::BeamModel& beam) {
  beam.ground = {o.choice("surface_left") == "rigid", o.choice("surface_right") == "rigid"};
}

}  // namespace

void read_beam(const Options& o, Scene& scene) {
  if (read_given_bridge(o, scene)) return read_ground(o, *scene.beam);
  if (!o.has("beam_spans")) return;
  scene.beam.emplace();
  beam::BeamModel& beam = *scene.beam;
  read_mesh(o, scene);
  beam.EI = read_distribution(o, "beam_EI");
  if (o.has("beam_EA")) beam.EA = read_distribution(o, "beam_EA");
  beam.mass = read_distribution(o, "beam_mass");
  if (o.has("beam_GA")) beam.GA = read_distribution(o, "beam_GA");
  if (o.has("beam_rotary_inertia")) beam.rotary_inertia = read_distribution(o, "beam_rotary_inertia");
  read_joints(o, beam);
  read_cracks(o, beam);
  read_masses(o, beam);
  read_supports(o, beam);
  read_torsion(o, scene);
  beam.foundation = read_foundation(o, beam);
  read_tension(o, beam);
  read_bearings(o, beam);
  beam.temperature = read_temperature(o);
  read_damping(o, scene.damping);
  scene.self_weight = o.flag("beam_self_weight");
  beam.surface_height = o.number("beam_surface_height");
  read_ground(o, beam);
}

void decide_axial(const options::Options& o, Scene& scene) {
  if (!scene.beam || scene.beam->given) return;
  const std::string setting = o.choice("model_axial");
  std::string missing;
  if (!o.has("beam_EA")) missing = "beam_EA";
  for (const char* name : {"track_rail_EA", "track_longitudinal_k"}) {
    if (scene.beam->track && !o.has(name)) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  const bool stiffness = missing.empty();
  const bool axial_strain = scene.beam->temperature && scene.beam->temperature->strain() != 0.0;
  const auto check = [&](const std::string& option, const std::string& acts) {
    if (!stiffness || setting == "false")
      o.refuse(option, acts + (stiffness ? "; allowed with it: model_axial auto or true" : ", which needs " + missing));
  };
  if (axial_strain) check("beam_temperature_uniform", "causes axial strain");
  if (o.has("support_motion_along")) check("support_motion_along", "acts along x");
  if (setting == "true" && !stiffness) o.refuse("model_axial", "needs " + missing);
  if (const std::string along = option_along_the_track(o, scene); !along.empty()) check(along, "acts along x");
  if (setting != "auto") {
    scene.beam->axial = setting == "true";
    scene.notes.push_back(
        base::detail(fmt::format("axial unknowns: {}, as requested", scene.beam->axial ? "modelled" : "none")));
    return;
  }
  const beam::Foundation& foundation = scene.beam->foundation;
  if (!stiffness && present(foundation, beam::Direction::longitudinal)) {
    const options::Entry* entry = o.first_with_prefix("foundation_longitudinal");
    o.refuse(entry->name, "longitudinal foundations need " + missing);
  }
  const std::string action = longitudinal_action(o, scene);
  scene.beam->axial = stiffness && !action.empty();
  if (scene.beam->axial) {
    scene.notes.push_back(base::detail("axial unknowns: modelled, because of " + action));
  } else if (action.empty()) {
    scene.notes.push_back(base::detail("axial unknowns: none, nothing acts along the beam"));
  } else {
    scene.notes.push_back(fmt::format("axial unknowns: none, {} not given ({} would use them)", missing, action));
  }
}

}  // namespace traverse::scene
