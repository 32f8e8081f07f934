// Rows of the option table: a vehicle and its parts. See table.hpp for the columns.
#include <array>

#include "base/text.hpp"
#include "derived_rows.hpp"
#include "traverse/contact/law.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using enum Kind;

constexpr Range share = {0.0, 1.0, true};

constexpr base::StaticText names_of_laws = base::joined_names(contact::law_rows, " ");

constexpr base::StaticText text_of_laws = [] {
  base::StaticText text;
  text.add("force over penetration a");
  for (const contact::LawRow& row : contact::law_rows)
    if (!row.name.empty())
      for (const std::string_view part : {std::string_view("; "), row.name, std::string_view(": "), row.words})
        text.add(part);
  return text;
}();

// clang-format off
constexpr Row vehicle[] = {
  {"file", file, "", "", any, "", 0, "a YAML file with the options of this vehicle, without the prefix vehicle_<name>_"},
  {"length", number, "m", "", positive, "", 0, "length over the couplings, origin in the middle; sets the distances in a train without train_spacing"},
  {"bodies", texts, "", "", any, "", 0, "names of the rigid bodies"},
  {"joints", texts, "", "", any, "", 0, "names of the joints"},
  {"springs", texts, "", "", any, "", 0, "names of the springs with dampers"},
  {"torsion_springs", texts, "", "", any, "", 0, "names of the torsion springs with dampers"},
  {"ropes", texts, "", "", any, "", 0, "names of the ropes over several points"},
  {"wheels", texts, "", "", any, "", 0, "names of the wheels"},
  {"actuators", texts, "", "", any, "", 0, "names of the prescribed forces and moments"},
  {"drivers", texts, "", "", any, "", 0, "names of the prescribed motions"},
  {"contacts", texts, "", "", any, "", 0, "names of the contacts between bodies"},
  {"sensors", texts, "", "", any, "", 0, "names of the points on bodies whose accelerations are stored"},
  {"repeat_parts", texts, "", "", any, "", 0, "parts that stand for PART0, PART1, ...; of repeated bodies, BODY+1 is the next one, and a part without it is left out"},
  {"repeat_count", integer, "", "", {1, 10000}, "", 0, "how often these parts are repeated"},
  {"repeat_pitch", numbers, "m", "0, 0", any, "", 2, "x, y from each repetition to the next"},
  {"repeat_delay", number, "s", "0", any, "", 0, "by how much later the table of a repeated actuator is from each repetition to the next"},
};

constexpr Row body[] = {
  {"mass", number, "kg", "", positive, "", 0, "mass"},
  {"inertia", number, "kg m2", "", positive, "", 0, "moment of inertia about the centre of mass"},
  {"position", numbers, "m", "", any, "", 2, "x, y of the centre of mass at t = 0, relative to the vehicle's origin"},
  {"angle", number, "rad", "0", any, "", 0, "angle at t = 0, positive counter-clockwise"},
  {"velocity", numbers, "m/s, rad/s", "0, 0, 0", any, "", 3, "vx, vy, omega at t = 0, added to the train's speed"},
};

constexpr Row spring[] = {
  {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
  {"from", numbers, "m", "", any, "", 2, "x, y on the first body at t = 0"},
  {"to", numbers, "m", "", any, "", 2, "x, y on the second body at t = 0"},
  {"stiffness", number, "N/m", "0", not_negative, "", 0, "stiffness"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "damping"},
  {"free_length", number, "m", "(the distance at t = 0)", not_negative, "", 0, "length without force"},
  {"preload", number, "N", "0", any, "", 0, "force at t = 0, positive in tension; instead of free_length"},
  {"table", table, "m, N", "", any, "", 0, "a file elongation,force instead of stiffness: m beyond the free length, N in tension; linear between and beyond its rows"},
  {"damper_table", table, "m/s, N", "", any, "", 0, "a file rate,force instead of damping: m/s of elongation, N in tension; linear between and beyond its rows"},
  {"gap", number, "m", "0", not_negative, "", 0, "play: no force up to this change of length in either direction; stiffness or table begin there"},
  {"side", choice, "", "both", any, "both compression tension", 0, "compression: no tensile force (a bump stop); tension: no compressive force (a rope)"},
  {"winding_table", table, "s, m", "", any, "", 0, "a file t,length: m that a winch adds to the free length, negative where it hoists; cubic spline through its rows, which holds its end values"},
};

constexpr Row torsion_spring[] = {
  {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
  {"stiffness", number, "Nm/rad", "0", not_negative, "", 0, "stiffness"},
  {"damping", number, "Nms/rad", "0", not_negative, "", 0, "damping"},
  {"free_angle", number, "rad", "(the angle at t = 0)", any, "", 0, "angle of the second body relative to the first without moment"},
  {"table", table, "rad, N m", "", any, "", 0, "a file twist,moment instead of stiffness: rad beyond the free angle, Nm of the restoring moment; linear between and beyond its rows"},
  {"damper_table", table, "rad/s, N m", "", any, "", 0, "a file rate,moment instead of damping: rad/s, Nm; linear between and beyond its rows"},
  {"gap", number, "rad", "0", not_negative, "", 0, "play: no moment up to this twist in either direction; stiffness or table begin there"},
  {"side", choice, "", "both", any, "both compression tension", 0, "compression: acts on negative twist only; tension: on positive twist only"},
};

constexpr Row rope[] = {
  {"bodies", texts, "", "", any, "", 0, "the body of each point, in the order of the rope; ground is the fixed frame"},
  {"points", numbers, "m", "", any, "", 0, "x, y of each point at t = 0: the ends of the rope and its pulleys, which have no friction"},
  {"stiffness", number, "N/m", "", positive, "", 0, "stiffness of the whole rope"},
  {"EA", number, "N", "", positive, "", 0, "instead of stiffness: EA over the unstretched length, which grows as the rope shortens"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "damping of the whole rope"},
  {"free_length", number, "m", "(the length at t = 0)", positive, "", 0, "length without force"},
  {"preload", number, "N", "0", not_negative, "", 0, "tension at t = 0; instead of free_length"},
  {"winding_table", table, "s, m", "", any, "", 0, "a file t,length: m that a winch adds to the free length, negative where it hoists; cubic spline through its rows, which holds its end values"},
  {"drum", text, "", "", any, "", 0, "body that takes the rope up as it turns; the last point is where the rope meets it, on the body that carries it"},
  {"drum_radius", number, "m", "", any, "", 0, "radius of the drum, positive if it takes rope up as it turns counter-clockwise"},
  {"length", number, "m", "", positive, "", 0, "length of the path at t = 0: the bodies of lifts are moved up or down to it"},
  {"lifts", texts, "", "", any, "", 0, "the bodies that hang on the rope"},
};

constexpr Row wheel[] = {
  {"body", text, "", "", any, "", 0, "body whose centre of mass is the wheel's centre"},
  {"radius", number, "m", "", positive, "", 0, "radius"},
  {"law", choice, "", "hertz", any, names_of_laws, 0, text_of_laws},
  {"stiffness", number, "N/m^1.5 or N/m", "", positive, "", 0, "k of the contact law"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "damping of the contact"},
  {"restitution", number, "1", "", share, "", 0, "coefficient of restitution, instead of damping: speed after an impact over the speed before it"},
  {"restitution_law", choice, "", "exact", any, "exact lankarani_nikravesh", 0, "relation of restitution and hysteresis damping; lankarani_nikravesh: for values near 1"},
  {"friction", number, "1", "0", not_negative, "", 0, "coefficient of friction"},
  {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction nearly has its full value (eq. 49)"},
  {"flat_length", number, "m", "", positive, "", 0, "length L of a rounded flat on the tread; its depth is L^2/(16 radius)"},
  {"flat_angle", number, "rad", "(half a turn)", any, "", 0, "angle that the wheel rolls until the middle of the flat is at the bottom"},
  {"polygon_order", integer, "", "", {1, 1000}, "", 0, "number of waves around an out-of-round wheel"},
  {"polygon_amplitude", number, "m", "", not_negative, "", 0, "amplitude of these waves: the radius varies by plus and minus this value"},
  {"polygon_phase", number, "rad", "0", any, "", 0, "phase of the wave at the contact point at t = 0; 0: crest"},
  {"young", number, "N/m2", "", positive, "", 0, "Young's modulus of the wheel (eq. 48), instead of stiffness"},
  {"poisson", number, "1", "0.3", {-0.99, 0.5}, "", 0, "Poisson's ratio of the wheel"},
  {"rail_young", number, "N/m2", "(the wheel's)", positive, "", 0, "Young's modulus of the rail"},
  {"rail_poisson", number, "1", "(the wheel's)", {-0.99, 0.5}, "", 0, "Poisson's ratio of the rail"},
};

constexpr Row actuator[] = {
  {"body", text, "", "", any, "", 0, "body on which the force acts"},
  {"reaction_body", text, "", "ground", any, "", 0, "body on which the reaction acts"},
  {"bodies", texts, "", "", any, "", 2, "both of these bodies in one option"},
  {"force", numbers, "N", "0, 0", any, "", 2, "fx, fy at the centre of mass"},
  {"moment", number, "Nm", "0", any, "", 0, "moment, positive counter-clockwise"},
  {"table", table, "s, N, N, N m", "", any, "", 0, "a file t,moment or t,fx,fy or t,fx,fy,moment instead; linear between its rows"},
  {"delay", number, "s", "0", any, "", 0, "time by which the table is later"},
};

constexpr Row driver[] = {
  {"body", text, "", "", any, "", 0, "body whose coordinate is prescribed"},
  {"coordinate", choice, "", "", any, "x y phi", 0, "prescribed coordinate; x is relative to the vehicle's origin"},
  {"value", number, "m or rad", "(the position at t = 0)", any, "", 0, "value at t = 0"},
  {"rate", number, "m/s or rad/s", "0", any, "", 0, "constant rate"},
  {"table", table, "s", "", any, "", 0, "a file t,value instead of value and rate; cubic spline through its rows, which holds its end values"},
};

constexpr Row contact[] = {
  {"type", choice, "", "", any, "arc_arc arc_line", 0, "two arcs, or an arc and a straight line"},
  {"bodies", texts, "", "", any, "", 2, "the two bodies, for arc_line the one with the arc first; ground is the fixed frame"},
  {"radii", numbers, "m", "", any, "", 0, "radii of the two arcs, or of the arc on the line; negative: a hollow arc around the other one"},
  {"centres", numbers, "m", "", any, "", 0, "x, y of each arc's centre at t = 0"},
  {"line", numbers, "m", "", any, "", 4, "arc_line: x, y of its two ends at t = 0; beyond an end the contact is with the end point"},
  {"law", choice, "", "hertz", any, names_of_laws, 0, text_of_laws},
  {"stiffness", number, "N/m^1.5 or N/m", "", positive, "", 0, "k of the contact law"},
  {"damping", number, "Ns/m", "0", not_negative, "", 0, "damping of the contact"},
  {"restitution", number, "1", "", share, "", 0, "coefficient of restitution, instead of damping: speed after an impact over the speed before it"},
  {"restitution_law", choice, "", "exact", any, "exact lankarani_nikravesh", 0, "relation of restitution and hysteresis damping; lankarani_nikravesh: for values near 1"},
  {"friction", number, "1", "0", not_negative, "", 0, "coefficient of friction"},
  {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction nearly has its full value (eq. 49)"},
  {"young", number, "N/m2", "", positive, "", 0, "Young's modulus of the first body (eq. 48), instead of stiffness"},
  {"poisson", number, "1", "0.3", {-0.99, 0.5}, "", 0, "Poisson's ratio of the first body"},
  {"other_young", number, "N/m2", "(the first's)", positive, "", 0, "Young's modulus of the second body"},
  {"other_poisson", number, "1", "(the first's)", {-0.99, 0.5}, "", 0, "Poisson's ratio of the second body"},
};

constexpr Row sensor[] = {
  {"body", text, "", "", any, "", 0, "body to which the sensor is fixed"},
  {"point", numbers, "m", "(the centre of mass)", any, "", 2, "x, y at t = 0, relative to the vehicle's origin"},
};
// clang-format on

struct PartTable {
  std::string_view list, word;
  std::span<const Row> rows;  // rows of joints: joint_rows()
};
constexpr std::array<PartTable, part_kinds> parts = {{{"bodies", "body", body},
                                                      {"joints", "joint", {}},
                                                      {"springs", "spring", spring},
                                                      {"torsion_springs", "torsion spring", torsion_spring},
                                                      {"ropes", "rope", rope},
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
