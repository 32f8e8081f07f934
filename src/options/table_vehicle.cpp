// Rows of the option table: a vehicle and its parts. See table.hpp for the columns.
#include <array>

#include "derived_rows.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using enum Kind;

constexpr Range share = {0.0, 1.0, true};

// clang-format off
constexpr Row vehicle[] = {
  {"file", file, "", "", any, "", 0, "a YAML file with this vehicle's options, without vehicle_<name>_ before them"},
  {"length", number, "m", "", positive, "", 0, "over the couplings, origin in the middle: spaces a train without train_spacing"},
  {"bodies", texts, "", "", any, "", 0, "names of the rigid bodies"},
  {"joints", texts, "", "", any, "", 0, "names of the joints"},
  {"springs", texts, "", "", any, "", 0, "names of the springs with dampers"},
  {"torsion_springs", texts, "", "", any, "", 0, "names of the torsion springs with dampers"},
  {"wheels", texts, "", "", any, "", 0, "names of the wheels"},
  {"actuators", texts, "", "", any, "", 0, "names of the prescribed forces"},
  {"drivers", texts, "", "", any, "", 0, "names of the prescribed motions"},
  {"contacts", texts, "", "", any, "", 0, "names of the contacts between bodies"},
  {"sensors", texts, "", "", any, "", 0, "names of the points on bodies whose accelerations are stored"},
};

constexpr Row body[] = {
  {"mass", number, "kg", "", positive, "", 0, "mass"},
  {"inertia", number, "kg m2", "", positive, "", 0, "about the centre of mass"},
  {"position", numbers, "m", "", any, "", 2, "x, y of the centre of mass at t = 0, relative to the vehicle's origin"},
  {"angle", number, "rad", "0", any, "", 0, "at t = 0, counter-clockwise"},
  {"velocity", numbers, "m/s, rad/s", "0, 0, 0", any, "", 3, "vx, vy, omega at t = 0, on top of the train's speed"},
};

constexpr Row spring[] = {
  {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
  {"from", numbers, "m", "", any, "", 2, "x, y on the first body at t = 0"},
  {"to", numbers, "m", "", any, "", 2, "x, y on the second body at t = 0"},
  {"stiffness", number, "N/m", "0", not_negative, "", 0, "stiffness"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "damping"},
  {"free_length", number, "m", "(the distance at t = 0)", not_negative, "", 0, "length without force"},
  {"preload", number, "N", "0", any, "", 0, "force at t = 0, tension positive; instead of free_length"},
  {"table", file, "", "", any, "", 0, "a file elongation,force instead of stiffness: m beyond the free length, N in tension; straight lines, the end ones continued"},
  {"damper_table", file, "", "", any, "", 0, "a file rate,force instead of damping: m/s of elongation, N in tension; straight lines, the end ones continued"},
  {"gap", number, "m", "0", not_negative, "", 0, "play: loose until longer or shorter than free by this; stiffness or table count from there"},
  {"side", choice, "", "both", any, "both compression tension", 0, "compression: never pulls (a bump stop); tension: never pushes (a rope)"},
};

constexpr Row torsion_spring[] = {
  {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
  {"stiffness", number, "Nm/rad", "0", not_negative, "", 0, "stiffness"},
  {"damping", number, "Nms/rad", "0", not_negative, "", 0, "damping"},
  {"free_angle", number, "rad", "(the angle at t = 0)", any, "", 0, "angle of the second body against the first without moment"},
  {"table", file, "", "", any, "", 0, "a file twist,moment instead of stiffness: rad beyond the free angle, Nm that turns it back; straight lines, the end ones continued"},
  {"damper_table", file, "", "", any, "", 0, "a file rate,moment instead of damping: rad/s, Nm; straight lines, the end ones continued"},
  {"gap", number, "rad", "0", not_negative, "", 0, "play: loose until twisted by this either way; stiffness or table count from there"},
  {"side", choice, "", "both", any, "both compression tension", 0, "compression: acts on negative twist only; tension: on positive"},
};

constexpr Row wheel[] = {
  {"body", text, "", "", any, "", 0, "the body whose centre of mass is the wheel's centre"},
  {"radius", number, "m", "", positive, "", 0, "radius"},
  {"law", choice, "", "hertz", any, "hertz linear", 0, "force over penetration: k a^1.5 or k a"},
  {"stiffness", number, "N/m^1.5 or N/m", "", positive, "", 0, "k of the law"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "of the contact"},
  {"restitution", number, "1", "", share, "", 0, "speed after an impact over that before it, instead of damping"},
  {"restitution_law", choice, "", "exact", any, "exact lankarani_nikravesh", 0, "how the hysteresis damping follows from it; the latter is for values near 1"},
  {"friction", number, "1", "0", not_negative, "", 0, "coefficient of friction"},
  {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction is nearly full (eq. 49)"},
  {"flat_length", number, "m", "", positive, "", 0, "of a rounded flat on the tread, L^2/(16 radius) deep"},
  {"flat_angle", number, "rad", "(half a turn)", any, "", 0, "the wheel rolls by it until the middle of the flat is down"},
  {"polygon_order", integer, "", "", {1, 1000}, "", 0, "waves around a wheel that is out of round"},
  {"polygon_amplitude", number, "m", "", not_negative, "", 0, "of these waves: the radius varies by plus and minus as much"},
  {"polygon_phase", number, "rad", "0", any, "", 0, "of the wave where the wheel stands at the start; 0: its crest"},
  {"young", number, "N/m2", "", positive, "", 0, "modulus of the wheel (eq. 48), instead of stiffness"},
  {"poisson", number, "1", "0.3", {-0.99, 0.5}, "", 0, "Poisson's ratio of the wheel"},
  {"rail_young", number, "N/m2", "(the wheel's)", positive, "", 0, "modulus of the rail"},
  {"rail_poisson", number, "1", "(the wheel's)", {-0.99, 0.5}, "", 0, "Poisson's ratio of the rail"},
};

constexpr Row actuator[] = {
  {"body", text, "", "", any, "", 0, "the body it acts on"},
  {"reaction_body", text, "", "ground", any, "", 0, "the body that takes the reaction"},
  {"bodies", texts, "", "", any, "", 2, "body and reaction body in one"},
  {"force", numbers, "N", "0, 0", any, "", 2, "fx, fy at the centre of mass"},
  {"moment", number, "Nm", "0", any, "", 0, "counter-clockwise"},
  {"table", file, "", "", any, "", 0, "a file instead: t,moment or t,fx,fy or t,fx,fy,moment; straight lines between its rows"},
};

constexpr Row driver[] = {
  {"body", text, "", "", any, "", 0, "the body whose coordinate is prescribed"},
  {"coordinate", choice, "", "", any, "x y phi", 0, "which one; x counts from the vehicle's origin"},
  {"value", number, "m or rad", "(as at t = 0)", any, "", 0, "at t = 0"},
  {"rate", number, "m/s or rad/s", "0", any, "", 0, "constant rate"},
  {"table", file, "", "", any, "", 0, "a file t,value instead of value and rate; a smooth curve (natural cubic spline) through its rows"},
};

constexpr Row contact[] = {
  {"type", choice, "", "", any, "arc_arc arc_line", 0, "two arcs, or an arc on a straight line"},
  {"bodies", texts, "", "", any, "", 2, "the two bodies, with arc_line that with the arc first; ground is the fixed frame"},
  {"radii", numbers, "m", "", any, "", 0, "of the two arcs, or of the arc on the line; below 0: a hollow arc, the other one inside"},
  {"centres", numbers, "m", "", any, "", 0, "x, y of each arc's centre at t = 0"},
  {"line", numbers, "m", "", any, "", 4, "arc_line: x, y of its two ends at t = 0; beyond an end its end point touches"},
  {"law", choice, "", "hertz", any, "hertz linear", 0, "force over penetration: k a^1.5 or k a"},
  {"stiffness", number, "N/m^1.5 or N/m", "", positive, "", 0, "k of the law"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "of the contact"},
  {"restitution", number, "1", "", share, "", 0, "speed after an impact over that before it, instead of damping"},
  {"restitution_law", choice, "", "exact", any, "exact lankarani_nikravesh", 0, "how the hysteresis damping follows from it; the latter is for values near 1"},
  {"friction", number, "1", "0", not_negative, "", 0, "coefficient of friction"},
  {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction is nearly full (eq. 49)"},
  {"young", number, "N/m2", "", positive, "", 0, "modulus of the first body (eq. 48), instead of stiffness"},
  {"poisson", number, "1", "0.3", {-0.99, 0.5}, "", 0, "Poisson's ratio of the first body"},
  {"other_young", number, "N/m2", "(the first's)", positive, "", 0, "modulus of the second body"},
  {"other_poisson", number, "1", "(the first's)", {-0.99, 0.5}, "", 0, "Poisson's ratio of the second body"},
};

constexpr Row sensor[] = {
  {"body", text, "", "", any, "", 0, "the body that it is fixed to"},
  {"point", numbers, "m", "(the centre of mass)", any, "", 2, "x, y at t = 0, relative to the vehicle's origin"},
};
// clang-format on

struct PartTable {
  std::string_view list, word;
  std::span<const Row> rows;  // of joints: joint_rows()
};
constexpr std::array<PartTable, part_kinds> parts = {{{"bodies", "body", body},
                                                      {"joints", "joint", {}},
                                                      {"springs", "spring", spring},
                                                      {"torsion_springs", "torsion spring", torsion_spring},
                                                      {"wheels", "wheel", wheel},
                                                      {"actuators", "actuator", actuator},
                                                      {"drivers", "driver", driver},
                                                      {"contacts", "contact", contact},
                                                      {"sensors", "sensor", sensor}}};

const PartTable& table_of(Part part) { return parts[static_cast<std::size_t>(part)]; }

}  // namespace

std::span<const Row> vehicle_rows() { return vehicle; }
std::span<const Row> part_rows(Part part) { return part == Part::joint ? joint_rows() : table_of(part).rows; }
std::string_view part_list(Part part) { return table_of(part).list; }
std::string_view part_word(Part part) { return table_of(part).word; }

}  // namespace traverse::options
