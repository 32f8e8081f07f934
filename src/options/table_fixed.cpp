// Rows of the option table: options with a fixed name. See table.hpp for the columns.
#include <limits>
#include <vector>

#include "base/text.hpp"
#include "derived_rows.hpp"
#include "track/spectrum_names.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/options/norm_rules.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using enum Kind;
using base::add_joined, base::joined_names, base::StaticText;
constexpr Range tolerance = {1e-10, 0.1}, tolerance_or_none = {0.0, 0.1};
constexpr double unbounded = std::numeric_limits<double>::infinity();
// Values below these belong to no real beam: a steel wire of 0.1 mm has EI = 1e-6 N m2, EA = 1.6e3 N and 6e-5 kg/m.
constexpr Range beam_length = {1e-3, 1e6, true}, beam_stiffness = {1e-7, unbounded, true},
                beam_weight = {1e-7, unbounded, true};

constexpr StaticText names_of_analyses = joined_names(analyses, " ");

constexpr StaticText text_of_analyses = [] {
  StaticText text;
  text.add("kind of analysis: ");
  add_joined(text, analyses, "; ", [](StaticText& to, const AnalysisRow& row) {
    for (const std::string_view part : {row.name, std::string_view(" ("), row.words, std::string_view(")")})
      to.add(part);
  });
  return text;
}();

constexpr StaticText names_of_load_models = joined_names(load_models, " ");

constexpr StaticText text_of_profile = [] {
  StaticText text;
  text.add("height of the running surface: none, bump, ");
  text.add(track::names_of_spectra);
  text.add(", or a file x,height");
  return text;
}();

// clang-format off
constexpr Row beam_rows[] = {
  {"options_file", text, "", "", any, "", 0, "a YAML (.yml, .yaml) or classic PETSc options file; it may name further files"},

  {"bridge_modes_file", file, "", "", any, "", 0, "natural modes of the bridge from elsewhere, instead of beam_spans: results of -scene_analysis modes, other HDF5, or text (doc/guide/given_modes.md)"},
  {"bridge_track", integer, "", "1", {1, 1000}, "", 0, "number of the track in bridge_modes_file on which the train runs"},
  {"beam_spans", numbers, "m", "", beam_length, "", 0, "span lengths; without this option the scene has no bridge"},
  {"beam_elements_per_span", integers, "", "(from accuracy)", {1, 100000}, "", 0, "elements per span: one number, or one per span"},
  {"beam_EI", number_or_file, "N m2", "", beam_stiffness, "", 0, "bending stiffness, or a file x,value"},
  {"beam_EA", number_or_file, "N", "", beam_stiffness, "", 0, "axial stiffness, or a file x,value; only needed for longitudinal action"},
  {"beam_GA", number_or_file, "N", "", beam_stiffness, "", 0, "shear stiffness kappa G A (Timoshenko beam), or a file x,value; without it: no shear deformation"},
  {"beam_rotary_inertia", number_or_file, "kg m", "", not_negative, "", 0, "rotary inertia rho I about the neutral axis, or a file x,value; without it: none"},
  {"beam_tension", number_or_file, "N", "", any, "", 0, "tension of the beam, or a file x,value: stiffens it against its slope; negative: compression below its buckling load"},
  {"beam_mass", number_or_file, "kg/m", "", beam_weight, "", 0, "mass per length, or a file x,value"},
  {"beam_continuity", choice_list, "", "continuous", any, "continuous simply_supported hinge", 0, "connection at each inner span end, one word applies to all; simply_supported: two separate beams end there"},
  {"beam_hinges", numbers, "m", "", not_negative, "", 0, "stations of hinges within spans"},
  {"beam_cracks_x", numbers, "m", "", not_negative, "", 0, "stations of cracks"},
  {"beam_cracks_k", numbers, "N m/rad", "", positive, "", 0, "stiffness of the rotational spring in each crack; one value applies to all"},
  {"beam_GJ", number_or_file, "N m2", "", positive, "", 0, "stiffness in torsion (St. Venant), or a file x,value; without it the beam does not twist"},
  {"beam_ECw", number_or_file, "N m4", "", positive, "", 0, "stiffness against warping of the sections (Vlasov), or a file x,value; without it warping meets no resistance"},
  {"beam_polar_inertia", number_or_file, "kg m", "", positive, "", 0, "with beam_GJ: moment of inertia of the mass per length about its centre, or a file x,value"},
  {"beam_shear_centre", number, "m", "0", any, "", 0, "distance of the shear centre to the left of the axis, seen along x"},
  {"beam_mass_centre", number, "m", "0", any, "", 0, "distance of the centre of mass to the left of the axis; beside the shear centre it couples bending and torsion"},
  {"beam_cracks_width", numbers, "m", "", positive, "", 0, "instead of springs: length along x over which EI is reduced; one value applies to all"},
  {"beam_cracks_EI_factor", numbers, "1", "", {1e-6, 1.0, true}, "", 0, "remaining fraction of EI over beam_cracks_width; one value applies to all"},
  {"beam_point_masses_x", numbers, "m", "", not_negative, "", 0, "stations of masses on the beam"},
  {"beam_point_masses_mass", numbers, "kg", "", positive, "", 0, "mass at each of these stations; one value applies to all"},
  {"beam_dampers", texts, "", "", any, "", 0, "names of tuned mass dampers"},
  {"beam_temperature_uniform", number, "K", "0", any, "", 0, "temperature change since the beam was built, positive: warmer"},
  {"beam_temperature_gradient", number, "K", "0", any, "", 0, "temperature difference top minus bottom"},
  {"beam_temperature_expansion", number, "1/K", "1.2e-5", not_negative, "", 0, "coefficient of thermal expansion"},
  {"beam_temperature_depth", number, "m", "", positive, "", 0, "depth of the beam from bottom to top, for the gradient"},
  {"beam_damping_ratios", numbers, "1", "", {0.0, 0.999}, "", 0, "damping ratios of the first two distinct modes by the beam itself (eq. 20); springs add none, dampers add theirs; without springs the second is from f1/f2 to f2/f1 times the first"},
  {"beam_damping_frequencies", numbers, "Hz", "", positive, "", 2, "the two frequencies at which the damping ratios apply"},
  {"beam_rayleigh", numbers, "1/s, s", "", not_negative, "", 2, "a, b of C = a M + b K, instead of damping ratios"},
  {"beam_self_weight", flag, "", "false", any, "", 0, "gravity also acts on the beam"},
  {"beam_surface_height", number, "m", "0", any, "", 0, "height of the running surface above the neutral axis"},

  {"support_settlement", numbers, "m", "0", any, "", 0, "upward displacement of each support from its built position, negative: settlement; one per span end"},
  {"foundation_shear_layer", number_or_file, "N", "", positive, "", 0, "shear stiffness of the layer of a Pasternak foundation, or a file x,value: with a deflection v it exerts the force G v'' per length; its springs are foundation_vertical_bed_k"},
  {"support_motion", table, "s, m/s2", "", any, "", 0, "a file t,value of the vertical motion of all supports, or t,value0,value1,... with one column for each span end; the ground moves with the first and the last one"},
  {"support_motion_along", table, "s, m/s2", "", any, "", 0, "as support_motion, for the motion along the beam of the supports that hold it along x"},
  {"support_motion_values", choice, "", "acceleration", any, "acceleration displacement", 0, "what the files of support_motion and support_motion_along have; acceleration: m/s2, linear between its rows, from rest; displacement: m, cubic spline through its rows, which holds its end values"},
  {"support_stiffness", numbers, "N/m", "0", not_negative, "", 0, "vertical stiffness of each support, one per span end; 0: rigid"},
  {"support_scour", numbers, "1", "0", {0.0, 1.0}, "", 0, "fraction of support_stiffness that scour removes, one per span end"},
  {"support_types", choice_list, "", "(pinned, then rollers; simply supported spans: all pinned)", any, "free roller pinned clamped guided", 0, "type of support at each span end, one word applies to all"},
  {"support_bearing_spacing", numbers, "m", "", not_negative, "", 0, "distance between the two bearings of each support, or of all, that hold the twist, half of it on each side of the beam's axis: their forces are stored; 0: one bearing"},
  {"support_torsion", choice_list, "", "held", any, "held free", 0, "for each span end, or for all: whether a support that holds the deflection also holds the twist"},

  {"surface_left", choice, "", "rigid", any, "rigid none", 0, "running surface left of the beam; none: there is no surface, wheels roll over the end and fall"},
  {"surface_right", choice, "", "rigid", any, "rigid none", 0, "running surface right of the beam, as surface_left"},
};

constexpr Row run_rows[] = {
  {"train_vehicles", texts, "", "(the vehicle, if only one is defined)", any, "", 0, "vehicles by name, from the front; name*count repeats"},
  {"train_positions", numbers, "m", "(front wheel at 0)", any, "", 0, "x of the origin of each vehicle, or of the first one, at t = 0"},
  {"train_spacing", numbers, "m", "(from vehicle lengths)", positive, "", 0, "distance between neighbouring origins: one number, or one per gap"},
  {"trains", texts, "", "(one train: the options of train)", any, "", 0, "names of several trains; each has its own block with the options of train: NAME_vehicles, NAME_speed, ..."},
  {"train_times", numbers, "s", "(one train, by train_positions)", any, "", 0, "timetable: at each of these times such a train enters the bridge with its first wheel; those that are never on it during the run are left out"},
  {"train_track", text, "", "(the only one)", any, "", 0, "name of the track (tracks) on which this train runs"},
  {"trains_from", number, "s", "0", any, "", 0, "the time of the timetable (train_times) at which the run begins"},
  {"train_speed", number, "m/s", "", {-1e4, 1e4}, "", 0, "speed at t = 0, in m/s or as 100 km/h; positive: to the right; negative: to the left, vehicles mirrored"},
  {"train_speed_file", table, "s, m/s", "", any, "", 0, "table t,v (s, m/s) instead of a speed, linear between its rows"},
  {"train_position_file", table, "s, m", "", any, "", 0, "table t,x (s, m) instead of a speed: x of the front wheel of the train, which begins there; its speed is linear between the rows and their middles"},
  {"train_speed_over", choice, "", "time", any, "time position", 0, "position: the table is x,v over the position of the front wheel, with constant acceleration between its rows"},
  {"train_profile", word_or_table, "m, m", "(track_profile)", any, "", 0, "running surface of the wheels of this train only, values as of track_profile"},
  {"train_profile_shape", choice, "", "linear", any, "linear spline", 0, "as track_profile_shape, for the profile of this train"},
  {"train_bump_start", number, "m", "", any, "", 0, "as track_bump_start, for the profile of this train"},
  {"train_bump_length", number, "m", "", positive, "", 0, "as track_bump_length, for the profile of this train"},
  {"train_bump_height", number, "m", "", any, "", 0, "as track_bump_height, for the profile of this train"},
  {"train_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "as track_seed, for the profile of this train"},
  {"train_wavelengths", numbers, "m", "(track_wavelengths)", positive, "", 2, "as track_wavelengths, for the profile of this train"},
  {"train_couplers", texts, "", "", any, "", 0, "names of the connections between neighbouring vehicles: springs, joints, shared bogies"},
  {"train_drive", choice, "", "(constant; free without wheels)", any, "constant free", 0, "constant: x of each vehicle is prescribed by the speed; free: only forces act"},

  {"load_forces", numbers, "N", "", any, "", 0, "moving constant forces, positive downward"},
  {"load_positions", numbers, "m", "(first force at 0)", any, "", 0, "x of each force at t = 0; with load_hslm_a, load_hslm_b, load_en15528 or load_file: x of the first axle; a force that moves from an end of the bridge is not on it at t = 0"},
  {"loads", texts, "", "(one load: the options of load)", any, "", 0, "names of several groups of forces; each has its own block with the options of load: NAME_forces, NAME_speed, ..."},
  {"load_track", text, "", "(the only one)", any, "", 0, "name of the track (tracks) on which these forces move"},
  {"load_sideways_height", number, "m", "(downward forces)", any, "", 0, "the forces act to the left, at this height above the shear centres, as wind does; they only twist the beam"},
  {"load_speed", number, "m/s", "(train_speed)", {-1e4, 1e4}, "", 0, "speed of the forces, in m/s or as 100 km/h; positive: to the right; negative: to the left"},
  {"load_speed_file", table, "s, m/s", "", any, "", 0, "table t,v (s, m/s) instead of a speed, linear between its rows"},
  {"load_position_file", table, "s, m", "", any, "", 0, "table t,x (s, m) instead of a speed: x of the first force, which begins there; its speed is linear between the rows and their middles"},
  {"load_speed_over", choice, "", "time", any, "time position", 0, "position: the table is x,v over the position of the first force, with constant acceleration between its rows"},
  {"load_hslm_a", integer, "", "", {1, 10}, "", 0, "instead of load_forces: train A1 to A10 of EN 1991-2"},
  {"load_hslm_b", numbers, "1, m", "", positive, "", 2, "instead of load_forces: HSLM-B of EN 1991-2, the number of forces of 170 kN and their distance"},
  {"load_en15528", choice, "", "", any, "A1 B1 B2 C2 C3 C4 D2 D3 D4 D5 E4 E5", 0, "instead of load_forces: reference wagons of this line category of EN 15528"},
  {"load_wagons", integer, "", "1", {1, 1000}, "", 0, "number of reference wagons (load_en15528)"},
  {"load_spread", number, "m", "(no distribution)", {0.0, 10.0, true}, "", 0, "sleeper spacing: each force is distributed over three sleepers, a quarter, a half and a quarter"},
  {"load_file", table, "m, N", "", any, "", 0, "instead of load_forces: a file of two columns, x in m and force in N, or a table of axles or of weighed vehicles as for screen_fleet"},
  {"load_formation", text, "", "(the only one)", any, "", 0, "name of the formation or vehicle in load_file"},
  {"load_file_x", choice, "", "forward", any, "forward backward", 0, "direction in which x of load_file grows; forward: travel direction; backward: as distances behind the first axle"},
  {"load_moments", numbers, "N m", "", any, "", 0, "moving concentrated moments at load_positions, counter-clockwise, one for each force or alone"},
  {"load_distributed", numbers, "m, m, N/m", "", any, "", 0, "moving line loads: x of both ends at t = 0 and the load per length, downward; three numbers for each"},
  {"load_table", table, "s, N", "", any, "", 0, "table t,F (s, N; of line loads N/m), linear between its rows, that is added to each force of the group"},
  {"load_frequency", number, "Hz", "", positive, "", 0, "frequency f of the harmonic part that is added to each force: sum of amplitude_k sin(2 pi k f t + phase_k)"},
  {"load_amplitude", numbers, "N", "", any, "", 0, "amplitudes of the harmonics k = 1, 2, ... (of line loads N/m)"},
  {"load_phase", numbers, "rad", "0", any, "", 0, "phases of the harmonics, one for each amplitude"},
  {"load_unbalance", number, "kg m", "", not_negative, "", 0, "rotating mass times its eccentricity; adds unbalance (2 pi f)^2 to the first amplitude"},

  {"track_profile", word_or_table, "m, m", "none", any, "", 0, text_of_profile},
  {"track_profile_shape", choice, "", "linear", any, "linear spline", 0, "of a profile file; linear: straight lines, kinks rounded within 0.25 m of a row or up to the nearer row; spline: natural cubic spline"},
  {"track_bump_start", number, "m", "", any, "", 0, "x at which the bump begins"},
  {"track_bump_length", number, "m", "", positive, "", 0, "length of the bump"},
  {"track_bump_height", number, "m", "", any, "", 0, "height of the bump in its middle"},
  {"track_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "seed of the random phases of the roughness"},
  {"track_wavelengths", numbers, "m", "(those of the spectrum)", positive, "", 2, "shortest and longest wavelength of the roughness"},
  {"track_gradient", number, "1", "0", {-1.0, 1.0}, "", 0, "gradient of beam and track, tan of the angle (0.04: rises by 40 per mille to the right); x is along the beam, gravity has a component along it"},
  {"track_dips_x", numbers, "m", "", any, "", 0, "stations of dips, which are added to track_profile"},
  {"track_dips_length", numbers, "m", "", positive, "", 0, "length of each dip; one value applies to all"},
  {"track_dips_depth", numbers, "m", "", any, "", 0, "depth of each dip in its middle, negative: a hump; one value applies to all"},
  {"track_dips_shape", choice_list, "", "smooth", any, "smooth joint", 0, "smooth: cosine wave, as of a weld; joint: two parabolas with a kink between them, as of a dipped rail joint; one word applies to all"},
};

constexpr Row later_rows[] = {
  {"gravity", number, "m/s2", "9.81", not_negative, "", 0, "gravitational acceleration, downward"},
  {"scene_name", text, "", "(name of the first options file)", any, "", 0, "name of the scene in messages and the results file"},
  {"scene_analysis", choice, "", analyses[0].name, any, names_of_analyses, 0, text_of_analyses},
  {"scene_start", choice, "", "equilibrium", any, "equilibrium given", 0, "initial state: static equilibrium, or the given positions and velocities"},
  {"scene_tail", number, "s", "", not_negative, "", 0, "time of free vibration after the last wheel has left"},
  {"ts_max_time", number, "s", "(when the last wheel has left)", positive, "", 0, "end time of the run"},
  {"ts_max_steps", integer, "", "(no limit)", {1, 2147483646.0}, "", 0, "largest number of steps of the run"},
  {"ts_dt", number, "s", "(from accuracy)", positive, "", 0, "time step, or the first one; ts_time_step is the same option"},
  {"ts_type", text, "", "(from accuracy)", any, "", 0, "time integrator; -help integrators lists them"},
  {"ts_adapt_type", choice, "", "none", any, "none ladder basic dsp", 0, "step-size control; ladder: esdirk4 by its error estimates; basic, dsp: PETSc's control of PETSc's integrators"},
  {"ts_rtol", number, "1", "1e-4", not_negative, "", 0, "relative error allowed per step, if ts_adapt_type is not none"},
  {"ts_atol", number, "", "1e-4", not_negative, "", 0, "absolute error allowed per step, with ts_adapt_type basic or dsp"},
  {"ts_adapt_dt_max", number, "s", "1e20", positive, "", 0, "longest step, with ts_adapt_type basic or dsp"},
  {"ts_adapt_dt_min", number, "s", "1e-20", positive, "", 0, "shortest step, with ts_adapt_type basic or dsp"},
  {"ts_adapt_clip", numbers, "1", "0.1,10", positive, "", 2, "least and greatest ratio of successive steps, with ts_adapt_type basic or dsp"},
  {"ts_adapt_safety", number, "1", "0.9", {0.0, 1.0, true}, "", 0, "safety factor of the step, with ts_adapt_type basic or dsp"},
  {"ts_adapt_monitor", flag, "", "false", any, "", 0, "prints the decisions of the step-size control"},
  {"ts_max_reject", integer, "", "12", {-1, 2147483646.0}, "", 0, "how often one step may be shortened, -1: no limit; ts_max_step_rejections is the same option"},
  {"ts_monitor", flag, "", "false", any, "", 0, "prints each step"},
  {"ts_view", flag, "", "false", any, "", 0, "prints PETSc's description of the integrator"},
  {"ts_arkimex_type", text, "", "4", any, "", 0, "scheme of ts_type arkimex: 3, 4 or 5"},
  {"ts_bdf_order", integer, "", "2", {1, 6}, "", 0, "order of ts_type bdf: 1 or 2"},
  {"ts_rk_type", text, "", "3bs", any, "", 0, "scheme of ts_type rk: 1fe, 2a, 2b, 3, 3bs, 4, 5f, 5dp, 5bs, 6vr, 7vr, 8vr"},
  {"ts_genalpha_radius", number, "1", "0.9", any, "", 0, "spectral radius of ts_type genalpha: factor of fast oscillations in one step"},
  {"modes_count", integer, "", "10", {1, 100000}, "", 0, "number of frequencies with scene_analysis modes"},
  {"contact_tolerance", number, "s", "(a thousandth of the step)", not_negative, "", 0, "steps end within this time after a contact closes or opens; 0: contact events do not change the steps"},
  {"step_kinks", flag, "", "true", any, "", 0, "steps end where wheels pass kinks of the running surface, such as span ends; needed for orders above 2"},
  {"step_probes", flag, "", "false", any, "", 0, "steps end where wheels pass probes; always if accuracy sets mesh or step; peaks are searched at every step in any case"},
  {"step_lanes", flag, "", "true", any, "", 0, "no effect any more: separate spans are computed by their elements, as all others"},
  {"step_ranks", choice, "", "auto", any, "auto all", 0, "ranks that compute a single run; auto: as many of the available ranks as make it faster, the others wait; all: all ranks"},
  {"contact_seats", flag, "", "false", any, "", 0, "bridge elements also deflect between their nodes under wheels, as rails and shear-flexible beams do; always if accuracy sets mesh or step"},
  {"contact_impact_steps", integer, "", "20", {0, 100000}, "", 0, "least number of steps of an impact after a separation; 0: no shorter steps"},
  {"accuracy", number, "1", "1e-3", tolerance, "", 0, "wanted relative error of the response; sets mesh, step and tolerance where they are not given"},
  {"accuracy_of", choice_list, "", "(all)", any, "deflection acceleration moment wheel_force acceleration_lowpass shear axial_displacement axial_force", 0, "peaks for which accuracy applies; no error is estimated for others; acceleration_lowpass: filtered by output_lowpass; default: all (shear: without effect on mesh and step; axial ones: if trains brake or are driven)"},
  {"accuracy_whole", flag, "", "false", any, "", 0, "no effect any more: trial runs cover the whole run always"},
  {"accuracy_cache", flag, "", "true", any, "", 0, "mesh, step and modes selected earlier for the same scene, stored beside its results in .traverse_choices, are used again"},
  {"accuracy_report", flag, "", "false", any, "", 0, "runs the scene again with a refined model and shows estimated and true errors"},

  {"model_axial", choice, "", "auto", any, "auto true false", 0, "axial unknowns of the beam; auto: if there is longitudinal action"},
  {"model_modes", integer, "", "auto", {0, 100000}, "auto", 0, "number of natural modes that represent the bridge, exact in time under moving forces alone; 0: elements; auto: modes with model_damping_bound, and in sweeps of forces if they are accurate enough"},
  {"model_damping_ratios", numbers, "1", "(Rayleigh damping)", {0.0, 0.999}, "", 0, "damping ratio of each mode of model_modes; one value applies to all"},
  {"model_damping_bound", choice, "", "", any, "steel composite prestressed reinforced filler_beam", 0, "damping ratio of each mode: lower bound of EN 1991-2, table 6.6, for this kind of bridge and the longest span; modes represent the bridge then, unless model_modes is 0 or the scene needs elements"},
  {"model_additional_damping", flag, "", "false", any, "", 0, "adds the additional damping of EN 1991-2, 6.4.6.4, for vehicles on spans below 30 m to model_damping_bound"},
  {"model_vehicles", choice, "", "auto", any, "auto full linear", 0, "model of the vehicles; full: mechanisms; linear: constant matrices about the initial state where possible, exact up to squares of angles; auto: linear if the trial runs of accuracy find it sufficient"},
  {"model_window", number, "1", "auto", {0.0, 0.1}, "auto", 0, "parts of the bridge that move less than this fraction of the largest motion are excluded from the steps; auto: 1e-9 for separate spans; 0: none"},

  {"limits", file, "", "", any, "", 0, "a file of limits, such as options/limits/en1990.yml; the run is checked against them at its end"},

  {"norm_load_models", choice_list, "", "(lm71 if limits need it)", any, names_of_load_models, 0, "static effects of these load models of EN 1991-2 along the bridge; lm71 and a train: also the check of 6.4.6.5, with sw0 on continuous bridges", true},
  {"norm_alpha", number, "1", "1", {0.1, 10.0}, "", 0, "classification factor of LM71 and SW/0, EN 1991-2 6.3.2"},
  {"norm_track", choice, "", "standard", any, "standard careful", 0, "maintenance of the track; standard: Phi3; careful: Phi2 of EN 1991-2 6.4.5.2"},
  {"norm_second_track", number, "m", "", any, "", 0, "distance of a second track to the left of the beam's axis, on which load models stand too; the train is on track_eccentricity alone"},
  {"norm_length", number, "m", "(from the spans)", positive, "", 0, "determinant length L_Phi of EN 1991-2 6.4.5.3"},
  {"norm_lane_load", number, "N/m", "0", not_negative, "", 0, "uniform load that accompanies the scene's train or forces in static effects, on all unfavourable parts of the bridge"},
  {"norm_range", numbers, "m", "(everywhere)", any, "", 2, "from, to: x between which the foremost force of the scene's train or forces stands in static effects; a trolley or crane that reaches a part of the beam only"},
  {"norm_lane_gap", numbers, "m", "0,0", any, "", 2, "from, to: range without norm_lane_load, relative to the foremost force; behind it is below 0"},
  {"norm_spacing", number, "m", "(a twentieth of each span)", positive, "", 0, "largest distance between the sections at which static effects are computed"},

  {"uic774_train_length", number, "m", "300", positive, "", 0, "scene_analysis rail: length of the train"},
  {"uic774_weight", number, "N/m", "8.0e4", not_negative, "", 0, "weight of the train per length, by default that of LM71"},
  {"uic774_braking", number, "N/m", "2.0e4", not_negative, "", 0, "braking force of the train per length, on the rails"},
  {"uic774_most_braking", number, "N", "6.0e6", positive, "", 0, "greatest total braking force; it acts from the front of the train on"},
  {"uic774_traction", number, "N/m", "3.3e4", not_negative, "", 0, "traction force of the train per length"},
  {"uic774_most_traction", number, "N", "1.0e6", positive, "", 0, "greatest total traction force; it acts from the front of the train on"},
  {"uic774_fronts", numbers, "m", "(0 to 90 m past the bridge, every 10 m)", any, "", 3, "positions of the train's front, measured from the bridge end at which it enters: first, last, step"},
  {"uic774_direction", choice, "", "right", any, "right left both", 0, "travel direction of the train"},

  {"screen_stock", file, "", "", any, "", 0, "scene_analysis screen: the table of bridges, with the columns name, spans, mass, EI or f1, damping or type, and others"},
  {"screen_fleet", text, "", "", any, "", 0, "the trains: a table of axles with the columns name, load_kN or load_t, position or spacing, and speed, a table of weighed vehicles (doc/guide/tables.md), or a folder of such tables"},
  {"screen_speeds", numbers, "m/s", "(10 to 250 km/h, every km/h)", positive, "", 3, "speeds of the screen: from, to, step; each may be in km/h; a train runs up to its own speed and that of the bridge"},
  {"screen_modes", integer, "", "3", {1, 8}, "", 0, "number of bending modes of each bridge; frequencies above them are left out of the deck acceleration, without any other filter"},
  {"screen_stations", integer, "", "10", {2, 50}, "", 0, "least number of equal parts of each span, between which the response is sampled; peaks along the bridge are searched for exactly"},
  {"screen_samples", number, "", "20", {8.0, 1000.0}, "", 0, "samples per period of the highest mode in a passage; peaks between samples are searched for exactly"},
  {"screen_audit", integer, "", "0", {0, 1e6}, "", 0, "number of pairs, drawn at random, that are checked by passages at all speeds after the screen"},
  {"screen_resume", flag, "", "false", any, "", 0, "uses the finished bridges of the same screen in the existing results file"},
  {"screen_pair", texts, "", "", any, "", 0, "a bridge and a formation: instead of the screen, prints the scene of their passages; with an options file of the train as third entry, prints that of its vehicles on a rough track at the permitted speed"},

  {"output_file", text, "", "results/<scene>.h5", any, "", 0, "HDF5 file of results; none: no file"},
  {"output_interval", number, "s", "(from the step)", positive, "", 0, "time between stored samples"},
  {"output_probes", numbers, "m", "(midspan of the first 200 spans, of all without output_series)", not_negative, "", 0, "stations on the beam at which the response is stored"},
  {"output_probes_spacing", number, "m", "", positive, "", 0, "largest distance of further stations, evenly within each span and at its ends, in addition to output_probes"},
  {"output_lowpass", number, "Hz", "auto", {0.0, 1e6, true}, "auto none", 0, "cut-off frequency of the low-pass for deck accelerations; auto: max(30 Hz, 1.5 f1, f3); none: no filter; the unfiltered peak is always stored, the filtered one if this option, output_lowpass_series or limits need it"},
  {"output_series", flag, "", "true", any, "", 0, "false, for long lines: of bridge and vehicles only peaks are stored, by probe, span and train, and trains beside the bridge are not computed"},
  {"output_lowpass_series", flag, "", "false", any, "", 0, "also stores the filtered accelerations over time"},
  {"output_wheel_lowpass", number, "Hz", "20", {1.0, 1e6}, "", 0, "cut-off frequency of the low-pass for wheel forces in limits; if given, a single run also reports the wheel unloading without and with this filter"},
  {"output_passages", numbers, "m", "", any, "", 0, "places along the track at which time, speed and force of each passing wheel are stored, as scales in a track measure them"},
  {"output_contact_points", flag, "", "false", any, "", 0, "stores position, velocity and acceleration of the running surface under each wheel, along its path"},
  {"output_profile", number, "m", "none", {1e-4, 1e3}, "none auto", 0, "distance of the stations at which the height of the running surface under the wheels is stored; auto: a fortieth of its shortest wave"},
  {"output_rail", numbers, "m", "", any, "", 0, "stations on a layered track, also beyond the bridge, at which the response of the rail is stored"},
  {"output_sleepers", numbers, "m", "", any, "", 0, "stations on a layered track; the pad and ballast forces of the nearest sleeper are stored"},
  {"output_unloading_level", number, "1", "0.6", {0.0, 1.0, true}, "", 0, "lost fraction of the initial wheel force from which on a wheel counts as unloaded, for filtered forces"},
  {"checkpoint_interval", number, "s", "900", not_negative, "", 0, "wall-clock time between checkpoints of a single run; 0: only on SIGUSR1, SIGTERM or SIGINT"},
  {"checkpoint_file", text, "", "<output_file>.checkpoint", any, "", 0, "file of the checkpoints; each replaces the one before; none: no checkpoints"},
  {"restart", file, "", "", any, "", 0, "continues from this checkpoint of the same scene; end time and file names may differ"},

  {"report_project", text, "", "", any, "", 0, "name of the project on the title page of the report"},
  {"report_structure", text, "", "(scene_name)", any, "", 0, "name of the structure"},
  {"report_line", text, "", "", any, "", 0, "line and kilometre of the structure"},
  {"report_author", text, "", "", any, "", 0, "who has made the calculation"},
  {"report_checker", text, "", "", any, "", 0, "who has checked it"},
  {"report_revision", text, "", "", any, "", 0, "revision of the report"},
  {"report_date", text, "", "(day of the run)", any, "", 0, "date of the report"},
  {"report_note", text, "", "", any, "", 0, "a remark on the title page"},
  {"report_material", text, "", "", any, "", 0, "materials of the structure, such as C50/60, St 1570/1770"},
  {"report_cross_section", file, "", "", any, "", 0, "a picture of the cross-section, PNG or JPEG"},
  {"report_drawings", texts, "", "", any, "", 0, "numbers of the drawings"},
  {"report_logo", file, "", "", any, "", 0, "a picture for the title page, PNG or JPEG"},
  {"report_norm_edition", text, "", "", any, "", 0, "edition of the norm, such as EN 1991-2:2003"},
  {"report_national_annex", text, "", "", any, "", 0, "national annex, such as DIN EN 1991-2/NA:2012-08"},
  {"report_language", choice, "", "en", any, "en de fr", 0, "language of the report"},

  {"verbose", flag, "", "false", any, "", 0, "print the description of the model, and in sweeps the resonance speeds of each train; the results file always has them"},
  {"output_quiet", flag, "", "false", any, "", 0, "no progress display on the terminal"},

  {"sweep_speed", numbers, "m/s", "", positive, "", 3, "runs the scene at each of these speeds: from, to, step; each may be in km/h; a train or load with the speed 0 stands"},
  {"sweep_hslm_a", integers, "", "", {1, 10}, "", 0, "runs the scene with each of these trains A1 to A10 of EN 1991-2", true},
  {"sweep_refine", number, "1", "(with limits: where a limit may be exceeded between two speeds)", tolerance_or_none, "", 0, "adds speeds near the peaks until the peaks of each train over the speed have this relative accuracy; 0: only the given speeds"},
  {"sweep_lanes", choice, "", "8", any, "0 1 4 8", 0, "largest number of runs that are computed together in SIMD lanes; 0: each run separately with TS"},
  {"sweep_instants", number, "", "20", {4.0, 1e4}, "", 0, "samples per period of the fastest mode if the modes are exact in time; peaks between samples are interpolated by parabolas"},

  {"study_combine", choice, "", "grid", any, "grid together random", 0, "how the lists of study_vary are combined; grid: all combinations; together: lists of equal length, row by row; random: study_draws draws from each list"},
  {"study_draws", integer, "", "", {1, 1e6}, "", 0, "number of values that are drawn of each random option; with study_sensitivity: base samples of Sobol's or trajectories of Morris' design, from 2"},
  {"study_sensitivity", choice, "", "none", any, "none local morris sobol", 0, "which random options matter; local: derivatives at their means; morris: elementary effects; sobol: parts of the variance"},
  {"study_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "seed of the random draws; each option has its own random stream"},
  {"study_statistics_over", texts, "", "(track_seed and drawn options)", any, "", 0, "options over which mean, deviation and quantiles are computed"},
  {"study_statistics_quantiles", numbers, "1", "0.5,0.98", {0.0, 1.0, true}, "", 0, "probabilities of the quantiles"},
  {"study_statistics_confidence", number, "1", "0.95", {0.5, 0.9999}, "", 0, "confidence level of the intervals of the quantiles"},
  {"study_refine", number, "1", "(only the speeds given)", tolerance_or_none, "", 0, "as sweep_refine, for each combination of the other options and for the largest value over those of the statistics; study_vary must contain train_speed or load_speed"},
  {"find_option", text, "", "", any, "", 0, "the option whose values are searched, such as beam_EI or load_speed: all values between find_between that keep the limits, or for which a quantity has a value"},
  {"find_between", texts, "", "", any, "", 2, "least and greatest value of the search, in the unit of find_option; speeds may be in km/h"},
  {"find_also", texts, "", "", any, "", 0, "other options that take the value of find_option in every run"},
  {"find_keep", text, "", "limits", any, "", 0, "what the values shall keep; limits: all limits of runs; or the quantity of one limit"},
  {"find_quantity", text, "", "", any, "", 0, "instead of limits: the quantity that shall not exceed find_equals; the ends of the intervals are the values at which it equals it"},
  {"find_equals", number, "", "", positive, "", 0, "value of find_quantity, in its SI unit"},
  {"find_for_each", texts, "", "(trains and others, if find_option is a speed)", any, "", 0, "varied options with a separate answer for each of their values"},
  {"find_points", integer, "", "(13; for speeds two in the width of a resonance)", {3, 2000}, "", 0, "number of first values, between which others are added"},
  {"find_accuracy", number, "1", "1e-3", {1e-8, 0.1}, "", 0, "relative accuracy of the ends of the intervals"},

  {"study_resume", flag, "", "false", any, "", 0, "uses the finished runs of the same study in the existing results file"},

  {"fit_starts", integer, "", "1", {1, 1000}, "", 0, "number of minimisations from different starts within the bounds; more than one finds out whether the misfit has several minima"},
  {"fit_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "seed of the starts after the first one"},
  {"tao_type", choice, "", "brgn", any, "brgn pounders", 0, "least-squares method of PETSc's TAO for fits; brgn: regularised Gauss-Newton; pounders: without derivatives"},
  {"tao_max_it", integer, "", "50", {0, 100000}, "", 0, "largest number of iterations of a minimisation"},
  {"tao_gatol", number, "1", "1e-3", not_negative, "", 0, "gradient of the misfit at which a minimisation ends; brgn: in standard errors of the unknowns"},
  {"tao_grtol", number, "1", "1e-8", not_negative, "", 0, "the same, relative to the misfit"},
  {"tao_gttol", number, "1", "0", not_negative, "", 0, "the same, relative to the gradient at the start"},
  {"tao_monitor", flag, "", "false", any, "", 0, "prints each iteration"},
  {"tao_converged_reason", flag, "", "false", any, "", 0, "prints why each minimisation ended"},
  {"tao_view", flag, "", "false", any, "", 0, "prints PETSc's description of the method"},

  {"describe", flag, "", "false", any, "", 0, "reads everything, shows model, static loads, selected methods, cost and unusual input, and stops without a run"},
  {"help", text, "", "", any, "", 0, "prints this list; -help beam, -help wheel, ...: one group; -help beam_EI: one option"},

  {"log_view", flag, "", "false", any, "", 0, "prints PETSc's summary of time, calls and messages at the end"},
  {"malloc_debug", flag, "", "false", any, "", 0, "PETSc checks its memory"},
  {"skip_petscrc", flag, "", "false", any, "", 0, "only on the command line: the files .petscrc and petscrc are not read"},
};

constexpr Row beside_tables[] = {
  {"columns", texts, "", "(all)", any, "", 0, "columns to be read, by their names or numbers: the first one, x or time, and those of the values; or only that of the values"},
  {"unit", texts, "", "(that of the column's name, or SI)", any, "", 0, "unit of the values, such as mm, kN or km/h, or the units of all columns"},
  {"factor", number, "1", "1", any, "", 0, "number by which the values are multiplied"},
  {"shift", number, "", "0", any, "", 0, "number that is added to the first column, in its SI unit"},
  {"decimal", choice, "", "(found from the file)", any, "point comma", 0, "decimal sign of the file"},
};
constexpr Row vary[] = {
  {"from", text, "", "", any, "", 0, "first value"},
  {"to", text, "", "", any, "", 0, "last value"},
  {"step", text, "", "", any, "", 0, "distance between values"},
  {"count", integer, "", "", {1, 1e6}, "", 0, "number of values at equal distances, instead of a step"},
  {"uniform", texts, "", "", any, "", 2, "draws from the uniform distribution between these two values"},
  {"normal", texts, "", "", any, "", 2, "draws from the normal distribution with this mean and standard deviation"},
  {"lognormal", texts, "", "", any, "", 2, "draws from the lognormal distribution (values above 0) with this mean and standard deviation"},
  {"also", texts, "", "", any, "", 0, "other options that take the value of this one in every run"},
};
constexpr Row fit[] = {
  {"frequency", integer, "", "", {1, 100}, "", 0, "number of the measured natural frequency, 1: the lowest, as -scene_analysis modes lists them"},
  {"value", number, "Hz", "", positive, "", 0, "measured frequency"},
  {"shape", table, "m", "", any, "", 0, "with frequency: table of the mode's shape, x and the deflection there in any scale"},
  {"shape_sd", number, "1", "0.05", positive, "", 0, "standard deviation of the values of the shape, relative to the largest of them"},
  {"sd", number, "", "(of series: from the residuals)", positive, "", 0, "standard deviation of the measured value, or of each value of a series after its factor"},
  {"series", table, "s", "", any, "", 0, "table of a measured series, the time in its first column (s)"},
  {"column", integer, "", "2", {2, 1000}, "", 0, "column of the measured values"},
  {"quantity", choice, "", "", any, "deflection velocity acceleration moment shear", 0, "measured quantity; deflection, velocity and acceleration upward, moment in sagging"},
  {"x", number, "m", "", not_negative, "", 0, "station of the measurement on the bridge"},
  {"dataset", text, "", "", any, "", 0, "instead of quantity and x: a dataset of the results file of a run over time, such as vehicles/0/car/acceleration"},
  {"component", integer, "", "1", {1, 100000}, "", 0, "with dataset: the number in each of its rows"},
  {"factor", number, "", "1", any, "", 0, "number by which the measured values are multiplied: 1e-3 from mm to m, negative for values that are positive downward"},
  {"from", number, "s", "(the first row)", any, "", 0, "time of the first row that is used, by the clock of the measurement"},
  {"to", number, "s", "(the last row)", any, "", 0, "time of the last row that is used"},
  {"align", flag, "", "false", any, "", 0, "the difference of the clocks of measurement and scene is estimated; false: they are the same"},
  {"offset", flag, "", "false", any, "", 0, "a constant in the measured values is estimated, such as the zero of a gauge"},
  {"gain", flag, "", "false", any, "", 0, "a factor of the measured values is estimated, such as an unknown gauge factor"},
  {"lowpass", number, "Hz", "(no filter)", positive, "", 0, "cut-off frequency of a low-pass for measured and computed values"},
};
constexpr Row fit_bounds = {"", texts, "", "", any, "", 2, "lowest and highest value of the option; speeds may be in km/h"};
constexpr Row vary_list = {"", texts, "", "", any, "", 0, "values: a list, from:to for whole numbers, or from:to:step; speeds may be in km/h"};

constexpr std::string_view petsc_prefixes[] = {
  "ts_", "tao_", "snes_", "ksp_", "pc_", "mat_", "vec_", "eps_", "st_", "svd_", "pep_", "nep_", "bv_", "ds_", "rg_", "fn_",
  "beam_ksp_", "beam_pc_", "beam_mat_", "beam_eps_", "beam_st_", "log_", "options_", "malloc", "info", "on_error_",
  "fp_trap", "start_in_debugger", "stop_for_debugger", "debug", "petsc", "version", "viewer_", "view", "display",
  "draw_", "x_", "memory_", "objects_dump", "citations", "python", "saws", "is_", "sf_", "dm_", "cuda_", "device",
  "use_gpu_aware_mpi", "skip_petscrc", "no_signal_handler", "check_pointer_intensity", "error_output_", "mpi",
  "shared_tmp", "not_shared_tmp", "tmp", "get_total_flops", "hdf5", "history", "nox", "prefix_p", "slepc",
};
// clang-format on

}  // namespace

std::span<const Row> fixed_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(beam_rows), std::end(beam_rows));
    for (const std::span<const Row> more :
         {foundation_rows(), std::span<const Row>(run_rows), track_rows(), std::span<const Row>(later_rows)})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return rows;
}

std::span<const Row> table_rows() { return beside_tables; }

std::span<const Row> vary_rows() { return vary; }
const Row& vary_list_row() { return vary_list; }

std::span<const Row> fit_rows() { return fit; }
const Row& fit_bounds_row() { return fit_bounds; }

bool owned_by_petsc(std::string_view name) {
  for (const std::string_view prefix : petsc_prefixes) {
    if (name.starts_with(prefix)) return true;
  }
  return false;
}

bool passes_to_petsc(std::string_view name) { return owned_by_petsc(name) && find_row(fixed_rows(), name) != nullptr; }

}  // namespace traverse::options
