// Rows of the option table: options with a fixed name. See table.hpp for the columns.
#include <array>
#include <limits>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

using enum Kind;
constexpr Range tolerance = {1e-10, 0.1}, tolerance_or_none = {0.0, 0.1};
constexpr double unbounded = std::numeric_limits<double>::infinity();
// Below these no beam is meant: a steel wire of 0.1 mm has EI = 1e-6 N m2, EA = 1.6e3 N and 6e-5 kg/m.
constexpr Range beam_length = {1e-3, 1e6, true}, beam_stiffness = {1e-7, unbounded, true},
                beam_weight = {1e-7, unbounded, true};

/// Text put together by the compiler.
struct Words {
  std::array<char, 400> letters{};
  std::size_t size = 0;
  constexpr void add(std::string_view more) {
    for (const char letter : more) letters[size++] = letter;
  }
  constexpr operator std::string_view() const { return {letters.data(), size}; }  // NOLINT: it is text
};

constexpr Words names_of_analyses = [] {
  Words words;
  for (const AnalysisRow& row : analyses) {
    words.add(words.size == 0 ? "" : " ");
    words.add(row.name);
  }
  return words;
}();

constexpr Words text_of_analyses = [] {
  Words words;
  std::string_view before = "what is computed: ";
  for (const AnalysisRow& row : analyses) {
    for (const std::string_view part : {before, row.name, std::string_view(" ("), row.words, std::string_view(")")})
      words.add(part);
    before = "; ";
  }
  return words;
}();

// clang-format off
constexpr Row beam_rows[] = {
  {"options_file", text, "", "", any, "", 0, "a YAML (.yml, .yaml) or classic options file, which may name further ones"},

  {"bridge_modes_file", file, "", "", any, "", 0, "the bridge by natural modes from elsewhere, instead of beam_spans: results of -scene_analysis modes or other HDF5, or text (doc/guide/given_modes.md)"},
  {"bridge_track", integer, "", "1", {1, 1000}, "", 0, "which of the tracks in bridge_modes_file the train runs on"},
  {"beam_spans", numbers, "m", "", beam_length, "", 0, "length of each span; left out: no bridge"},
  {"beam_elements_per_span", integers, "", "(from accuracy)", {1, 100000}, "", 0, "elements a span, one number or one per span"},
  {"beam_EI", number_or_file, "N m2", "", beam_stiffness, "", 0, "bending stiffness, or a file x,value"},
  {"beam_EA", number_or_file, "N", "", beam_stiffness, "", 0, "axial stiffness, or a file x,value; needed for longitudinal action only"},
  {"beam_GA", number_or_file, "N", "", beam_stiffness, "", 0, "shear stiffness kappa G A (Timoshenko's beam), or a file x,value; left out: the beam does not shear"},
  {"beam_rotary_inertia", number_or_file, "kg m", "", not_negative, "", 0, "of a section about its neutral axis, rho I, or a file x,value; left out: none"},
  {"beam_mass", number_or_file, "kg/m", "", beam_weight, "", 0, "mass per length, or a file x,value"},
  {"beam_continuity", choice_list, "", "continuous", any, "continuous simply_supported hinge", 0, "at every inner span end, one word serves all; simply_supported: two beams end there"},
  {"beam_hinges", numbers, "m", "", not_negative, "", 0, "stations of hinges within spans"},
  {"beam_cracks_x", numbers, "m", "", not_negative, "", 0, "stations of cracks"},
  {"beam_cracks_k", numbers, "N m/rad", "", positive, "", 0, "each a rotational spring between its two sides, one serves all"},
  {"beam_cracks_width", numbers, "m", "", positive, "", 0, "instead of springs: length about x over which EI is less, one serves all"},
  {"beam_cracks_EI_factor", numbers, "1", "", {1e-6, 1.0, true}, "", 0, "what is left of EI there, one serves all"},
  {"beam_temperature_uniform", number, "K", "0", any, "", 0, "warmer than when the beam was built in"},
  {"beam_temperature_gradient", number, "K", "0", any, "", 0, "by how much its top is warmer than its bottom"},
  {"beam_temperature_expansion", number, "1/K", "1.2e-5", not_negative, "", 0, "coefficient of expansion"},
  {"beam_temperature_depth", number, "m", "", positive, "", 0, "of the beam, from bottom to top, for the gradient"},
  {"beam_damping_ratios", numbers, "1", "", {0.0, 0.999}, "", 0, "damping ratios at the first two distinct frequencies (eq. 20); the second at most f2/f1 times the first, at least f1/f2"},
  {"beam_damping_frequencies", numbers, "Hz", "", positive, "", 2, "the frequencies that the damping ratios belong to"},
  {"beam_rayleigh", numbers, "1/s, s", "", not_negative, "", 2, "a, b of C = a M + b K, instead of damping ratios"},
  {"beam_self_weight", flag, "", "false", any, "", 0, "gravity acts on the beam too"},
  {"beam_surface_height", number, "m", "0", any, "", 0, "of the running surface above the neutral axis"},

  {"support_settlement", numbers, "m", "0", any, "", 0, "how far each support stands above (below: negative) where it was built, one at every span end"},
  {"support_stiffness", numbers, "N/m", "0", not_negative, "", 0, "vertical, of each support, one at every span end; 0: rigid"},
  {"support_scour", numbers, "1", "0", {0.0, 1.0}, "", 0, "part of this stiffness that is lost, one at every span end"},
  {"support_types", choice_list, "", "(pinned, then rollers; simply supported spans: all pinned)", any, "free roller pinned clamped guided", 0, "support at every span end, one word serves all"},

  {"surface_left", choice, "", "rigid", any, "rigid none", 0, "what wheels run on beyond the beam's left end; none: nothing is there, they roll over the end and fall"},
  {"surface_right", choice, "", "rigid", any, "rigid none", 0, "the same beyond its right end"},
};

constexpr Row run_rows[] = {
  {"train_vehicles", texts, "", "(the vehicle, if one is defined)", any, "", 0, "vehicles by name, front one first; name*count repeats"},
  {"train_positions", numbers, "m", "(front wheel at 0)", any, "", 0, "x of each vehicle's origin at t = 0, or of the first one"},
  {"train_spacing", numbers, "m", "(from vehicle lengths)", positive, "", 0, "distance from origin to origin, one number or one per gap"},
  {"trains", texts, "", "(train alone)", any, "", 0, "names of several trains, each a block of its own with the options of train: NAME_vehicles, NAME_speed, ..."},
  {"train_speed", number, "m/s", "", {-1e4, 1e4}, "", 0, "speed towards the right at t = 0, or 100 km/h; below 0: to the left, vehicles mirrored"},
  {"train_speed_file", file, "", "", any, "", 0, "instead of a speed: a table t,v (s, m/s), straight lines between its rows"},
  {"train_speed_over", choice, "", "time", any, "time position", 0, "position: the table is x,v over the place of the front wheel, the acceleration constant between its rows"},
  {"train_profile", text, "", "(the track's)", any, "", 0, "running surface of this train's wheels alone, as track_profile"},
  {"train_profile_shape", choice, "", "linear", any, "linear spline", 0, "as track_profile_shape, of the train's own profile"},
  {"train_bump_start", number, "m", "", any, "", 0, "as track_bump_start, of the train's own profile"},
  {"train_bump_length", number, "m", "", positive, "", 0, "its length"},
  {"train_bump_height", number, "m", "", any, "", 0, "its height in the middle"},
  {"train_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "of the random phases of the train's own profile"},
  {"train_wavelengths", numbers, "m", "(as track_wavelengths)", positive, "", 2, "shortest and longest wave of the train's own profile"},
  {"train_couplers", texts, "", "", any, "", 0, "names of what joins neighbouring vehicles: springs, joints, shared bogies"},
  {"train_drive", choice, "", "(constant; free without wheels)", any, "constant free", 0, "constant: each vehicle's x is driven at the speed; free: only forces act"},

  {"load_forces", numbers, "N", "", any, "", 0, "moving constant forces, downward"},
  {"load_positions", numbers, "m", "(first at 0)", any, "", 0, "x of each force at t = 0; with hslm_a of the first axle"},
  {"loads", texts, "", "(load alone)", any, "", 0, "names of several groups of forces, each a block of its own with the options of load: NAME_forces, NAME_speed, ..."},
  {"load_speed", number, "m/s", "(train_speed)", {-1e4, 1e4}, "", 0, "speed of the forces towards the right, or 100 km/h; below 0: to the left"},
  {"load_speed_file", file, "", "", any, "", 0, "instead of a speed: a table t,v (s, m/s), straight lines between its rows"},
  {"load_speed_over", choice, "", "time", any, "time position", 0, "position: the table is x,v over the place of the first force, the acceleration constant between its rows"},
  {"load_hslm_a", integer, "", "", {1, 10}, "", 0, "instead of forces: train A1 to A10 of EN 1991-2"},
  {"load_hslm_b", numbers, "1, m", "", positive, "", 2, "instead of forces: HSLM-B of EN 1991-2, the number of forces of 170 kN and their distance"},
  {"load_en15528", choice, "", "", any, "A1 B1 B2 C2 C3 C4 D2 D3 D4 D5 E4 E5", 0, "instead of forces: reference wagons of this line of EN 15528"},
  {"load_wagons", integer, "", "1", {1, 1000}, "", 0, "how many of these"},
  {"load_spread", number, "m", "(not spread)", {0.0, 10.0, true}, "", 0, "sleeper spacing: every force acts over three sleepers, by a quarter, a half and a quarter"},
  {"load_file", file, "", "", any, "", 0, "instead of forces: a file of two columns, x in m and force in N"},
  {"load_file_x", choice, "", "forward", any, "forward backward", 0, "where the x of load_file grow: towards where the load runs, or backward, as distances behind the first axle do"},

  {"track_profile", text, "", "none", any, "", 0, "none, bump, iso8608_A to iso8608_E (roads), german_low, german_high, fra_1 to fra_6 (rails), or a file x,height"},
  {"track_profile_shape", choice, "", "linear", any, "linear spline", 0, "of a profile from a file, between its rows: straight lines whose corners are rounded within 0.25 m of a row, or as far as the nearer row; spline: a natural cubic spline"},
  {"track_bump_start", number, "m", "", any, "", 0, "where the bump begins"},
  {"track_bump_length", number, "m", "", positive, "", 0, "its length"},
  {"track_bump_height", number, "m", "", any, "", 0, "its height in the middle"},
  {"track_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "of the random phases of roads and rails"},
  {"track_wavelengths", numbers, "m", "(iso8608 0.1, 100; german 0.5, 80; fra 1.5, 300)", positive, "", 2, "shortest and longest wave of the roughness"},
  {"track_dips_x", numbers, "m", "", any, "", 0, "stations of dips, which come on top of track_profile"},
  {"track_dips_length", numbers, "m", "", positive, "", 0, "length of the dips, one serves all"},
  {"track_dips_depth", numbers, "m", "", any, "", 0, "depth in their middle, one serves all; below 0 they are humps"},
  {"track_dips_shape", choice_list, "", "smooth", any, "smooth joint", 0, "smooth: a wave of a cosine, as of a weld; joint: two parabolas that meet at a corner, as of a dipped rail joint; one word serves all"},
};

constexpr Row later_rows[] = {
  {"gravity", number, "m/s2", "9.81", not_negative, "", 0, "downward"},
  {"scene_name", text, "", "(the first options file)", any, "", 0, "names the scene in messages and the results file"},
  {"scene_analysis", choice, "", analyses[0].name, any, names_of_analyses, 0, text_of_analyses},
  {"scene_start", choice, "", "equilibrium", any, "equilibrium given", 0, "given: positions and velocities as written"},
  {"scene_tail", number, "s", "", not_negative, "", 0, "free vibration after the last wheel has left"},
  {"ts_max_time", number, "s", "(when the last wheel has left)", positive, "", 0, "the run's end"},
  {"ts_max_steps", integer, "", "(no limit)", {1, 2147483646.0}, "", 0, "the run ends after so many steps at the latest"},
  {"ts_dt", number, "s", "(from accuracy)", positive, "", 0, "the step, or the first one; ts_time_step is the same"},
  {"ts_type", text, "", "(from accuracy)", any, "", 0, "the time integrator; -help integrators lists them"},
  {"ts_adapt_type", choice, "", "none", any, "none ladder basic dsp", 0, "ladder: steps of esdirk4 by their errors; basic, dsp: PETSc's step control, with PETSc's integrators"},
  {"ts_rtol", number, "1", "1e-4", not_negative, "", 0, "relative error that a step may make, where ts_adapt_type is not none"},
  {"ts_atol", number, "", "1e-4", not_negative, "", 0, "absolute error that a step may make, with ts_adapt_type basic or dsp; so the next four"},
  {"ts_adapt_dt_max", number, "s", "1e20", positive, "", 0, "the longest step"},
  {"ts_adapt_dt_min", number, "s", "1e-20", positive, "", 0, "the shortest step"},
  {"ts_adapt_clip", numbers, "1", "0.1,10", positive, "", 2, "least and greatest factor from a step to the next"},
  {"ts_adapt_safety", number, "1", "0.9", {0.0, 1.0, true}, "", 0, "part of the step that the error allows"},
  {"ts_adapt_monitor", flag, "", "false", any, "", 0, "prints what the step control decides"},
  {"ts_max_reject", integer, "", "12", {-1, 2147483646.0}, "", 0, "how often one step may be shortened, -1: without limit; ts_max_step_rejections is the same"},
  {"ts_monitor", flag, "", "false", any, "", 0, "prints each step"},
  {"ts_view", flag, "", "false", any, "", 0, "prints PETSc's words on the integrator"},
  {"ts_arkimex_type", text, "", "4", any, "", 0, "of ts_type arkimex: 3, 4 or 5"},
  {"ts_arkimex_fully_implicit", flag, "", "true", any, "", 0, "of ts_type arkimex; false: the beam alone is implicit"},
  {"ts_bdf_order", integer, "", "2", {1, 6}, "", 0, "of ts_type bdf: 1 or 2"},
  {"ts_rk_type", text, "", "3bs", any, "", 0, "of ts_type rk: 1fe, 2a, 2b, 3, 3bs, 4, 5f, 5dp, 5bs, 6vr, 7vr, 8vr"},
  {"ts_theta_theta", number, "1", "0.5", {0.0, 1.0, true}, "", 0, "of ts_type theta"},
  {"ts_theta_endpoint", flag, "", "false", any, "", 0, "of ts_type theta: at the ends of the step, not between them"},
  {"ts_genalpha_radius", number, "1", "0.9", any, "", 0, "of ts_type genalpha: what is left after a step of what oscillates fast within it"},
  {"modes_count", integer, "", "10", {1, 100000}, "", 0, "frequencies with scene_analysis modes"},
  {"contact_tolerance", number, "s", "(a thousandth of the step)", not_negative, "", 0, "steps end so close behind the loss or gain of a contact; 0: wherever they end"},
  {"step_kinks", flag, "", "true", any, "", 0, "steps end where wheels pass kinks of their way, such as span ends; needed for orders above 2"},
  {"step_probes", flag, "", "false", any, "", 0, "steps end where wheels pass probes, and peaks are looked for at every step, not among stored samples; so it is where accuracy chooses mesh or step"},
  {"step_lanes", flag, "", "true", any, "", 0, "has no effect any more: spans that do not touch go by their elements, as all others do"},
  {"step_ranks", choice, "", "auto", any, "auto all", 0, "ranks that take the steps of a single run: auto: as many of those at hand as make it faster, the others wait; all: all"},
  {"contact_seats", flag, "", "false", any, "", 0, "under wheels a bridge's elements bend between their nodes too, as those of rails and of beams that shear do; so it is where accuracy chooses mesh or step"},
  {"contact_impact_steps", integer, "", "20", {0, 100000}, "", 0, "steps that an impact after a separation takes at least; 0: as the step is"},
  {"accuracy", number, "1", "1e-3", tolerance, "", 0, "wanted relative error of the response; sets mesh, step and tolerance where left open"},
  {"accuracy_of", choice_list, "", "(all)", any, "deflection acceleration moment wheel_force acceleration_lowpass shear axial_displacement axial_force", 0, "peaks that the accuracy is wanted of; of others nothing is promised; acceleration_lowpass: of the acceleration low-passed as output_lowpass says; left out: all but shear, which is promised where the rest asks for as much, and of axial ones only where trains brake or are driven"},
  {"accuracy_whole", flag, "", "false", any, "", 0, "trial runs that find mesh and step for the accuracy are as long as the run, so that nothing comes that they have not seen"},
  {"accuracy_cache", flag, "", "true", any, "", 0, "mesh, step and modes that were chosen for the same scene before, kept beside its results in .traverse_choices, are taken again"},
  {"accuracy_report", flag, "", "false", any, "", 0, "runs the scene again, refined, and shows promised and true errors"},

  {"model_axial", choice, "", "auto", any, "auto true false", 0, "axial unknowns of the beam; auto: where there is longitudinal action"},
  {"model_modes", text, "", "auto", any, "", 0, "the bridge by so many natural modes, under moving forces alone exact in time; 0: by its elements; auto: in sweeps of forces by modes where these do as well"},
  {"model_damping_ratios", numbers, "1", "(Rayleigh damping)", {0.0, 0.999}, "", 0, "of each mode of model_modes, one serves all"},
  {"model_damping_bound", choice, "", "", any, "steel composite prestressed reinforced filler_beam", 0, "instead of beam_damping_ratios, both: the lower bound of EN 1991-2, table 6.6, for bridges of this kind and the longest span"},
  {"model_additional_damping", flag, "", "false", any, "", 0, "adds to it what EN 1991-2, 6.4.6.4, allows on spans below 30 m for what vehicles damp"},
  {"model_vehicles", choice, "", "auto", any, "auto full linear", 0, "vehicles as mechanisms, or those that can be with constant matrices about their start: exact up to squares of angles; auto: where the trial runs of accuracy find that it does not matter"},
  {"model_window", text, "", "auto", any, "", 0, "leave out of the steps what moves less than this part of the largest motion; auto: 1e-9 where spans do not touch; 0: nothing"},

  {"limits", file, "", "", any, "", 0, "a file of limits, such as options/limits/en1990.yml, that the run is checked against when it has ended"},

  {"norm_load_models", choice_list, "", "(lm71 where limits ask for it)", any, "lm71 sw0 sw2", 0, "static effects of these load models of EN 1991-2 along the bridge; with lm71 and a train the verdict of 6.4.6.5, on continuous bridges with sw0 too"},
  {"norm_alpha", number, "1", "1", {0.1, 10.0}, "", 0, "classification factor of LM71 and SW/0, EN 1991-2 6.3.2"},
  {"norm_track", choice, "", "standard", any, "standard careful", 0, "maintenance of the track: Phi3, or Phi2 of EN 1991-2 6.4.5.2"},
  {"norm_length", number, "m", "(from the spans)", positive, "", 0, "determinant length L_Phi of EN 1991-2 6.4.5.3"},
  {"norm_spacing", number, "m", "(a twentieth of each span)", positive, "", 0, "largest distance of the sections at which static effects are computed"},

  {"uic774_train_length", number, "m", "300", positive, "", 0, "scene_analysis rail: length of the train"},
  {"uic774_weight", number, "N/m", "8.0e4", not_negative, "", 0, "its weight, LM71's by default"},
  {"uic774_braking", number, "N/m", "2.0e4", not_negative, "", 0, "its braking force on the rails"},
  {"uic774_most_braking", number, "N", "6.0e6", positive, "", 0, "the greatest braking force of all its length, from its front on"},
  {"uic774_traction", number, "N/m", "3.3e4", not_negative, "", 0, "its traction"},
  {"uic774_most_traction", number, "N", "1.0e6", positive, "", 0, "the greatest traction, from its front on"},
  {"uic774_fronts", numbers, "m", "(0, to 90 m behind the bridge, every 10 m)", any, "", 3, "places of its front beyond the end of the bridge where it comes from: first, last, step"},
  {"uic774_direction", choice, "", "right", any, "right left both", 0, "which way it runs"},

  {"output_file", text, "", "results/<scene>.h5", any, "", 0, "HDF5 file of results; none: no file"},
  {"output_interval", number, "s", "(from the step)", positive, "", 0, "between stored samples"},
  {"output_probes", numbers, "m", "(middle of each span, of 200)", not_negative, "", 0, "stations on the beam where the response is stored"},
  {"output_probes_spacing", number, "m", "", positive, "", 0, "stations this far apart at most, evenly within every span and at its ends, besides those of output_probes"},
  {"output_lowpass", text, "Hz", "auto", any, "", 0, "frequency up to which deck accelerations count: their peak is given without a filter and, where this, output_lowpass_series or limits ask for it, with a low-pass there; auto: the greatest of 30 Hz, 1.5 f1 and f3; none: without alone"},
  {"output_lowpass_series", flag, "", "false", any, "", 0, "stores the filtered accelerations beside the others"},
  {"output_wheel_lowpass", number, "Hz", "20", {1.0, 1e6}, "", 0, "frequency up to which wheel forces count where a limit is of filtered ones; given, a single run says how much of its force a wheel loses without a filter and with a low-pass there"},
  {"output_passages", numbers, "m", "", any, "", 0, "places along the track at which time, speed and force of every wheel that passes are stored, as scales in a track find them"},
  {"output_sleepers", numbers, "m", "", any, "", 0, "stations on a layered track; of the sleeper nearest to each the forces in its pads and its ballast are stored"},
  {"output_unloading_level", number, "1", "0.6", {0.0, 1.0, true}, "", 0, "part of its force at the start from which on a wheel counts as unloaded, of low-passed forces"},
  {"checkpoint_interval", number, "s", "900", not_negative, "", 0, "of wall time between two checkpoints of a single run; 0: none, except where SIGUSR1, SIGTERM or SIGINT asks for one"},
  {"checkpoint_file", text, "", "<output_file>.checkpoint", any, "", 0, "where a run's checkpoints are written, each in place of the one before; none: nowhere"},
  {"restart", file, "", "", any, "", 0, "goes on from this checkpoint of the same scene, whose end and files may be others"},

  {"output_quiet", flag, "", "false", any, "", 0, "no progress on the terminal"},

  {"sweep_speed", numbers, "m/s", "", positive, "", 3, "runs the scene at each of these speeds: from, to, step; each may be in km/h"},
  {"sweep_hslm_a", integers, "", "", {1, 10}, "", 0, "runs the scene with each of these trains of EN 1991-2"},
  {"sweep_refine", number, "1", "(with limits: where one may be broken between two speeds)", tolerance_or_none, "", 0, "adds speeds near the peaks until every train's peaks over the speed are known to this part of their value; 0: only the speeds given"},
  {"sweep_lanes", choice, "", "8", any, "0 1 4 8", 0, "so many runs go side by side in the lanes of the processor's vectors, where they may; 0: each by itself, driven by TS"},
  {"sweep_instants", number, "", "20", {4.0, 1e4}, "", 0, "a period of the fastest mode is looked at so often where the bridge's modes move exactly in time; parabolas find the peaks between"},

  {"study_combine", choice, "", "grid", any, "grid together random", 0, "of the options that study_vary lists: every combination, their lists side by side, or study_draws runs that draw from each list"},
  {"study_draws", integer, "", "", {1, 1e6}, "", 0, "how many values are drawn of each random option"},
  {"study_seed", integer, "", "1", {0, 2147483647.0}, "", 0, "of the random draws; each option has a stream of its own"},
  {"study_statistics_over", texts, "", "(track_seed and what is drawn)", any, "", 0, "options that mean, deviation and quantiles go over"},
  {"study_statistics_quantiles", numbers, "1", "0.5,0.98", {0.0, 1.0, true}, "", 0, "which quantiles"},
  {"study_statistics_confidence", number, "1", "0.95", {0.5, 0.9999}, "", 0, "of the intervals that hold the quantiles"},
  {"study_refine", number, "1", "(only the speeds given)", tolerance_or_none, "", 0, "as sweep_refine: of every combination of the other options, and the greatest of what statistics go over; wants train_speed or load_speed among the lists of study_vary"},
  {"study_resume", flag, "", "false", any, "", 0, "takes finished runs of the same study from the results file that is there"},

  {"check", flag, "", "false", any, "", 0, "reads everything, shows the model, its loads at rest, what is chosen, what it costs and unusual input, and stops without a run"},
  {"help", text, "", "", any, "", 0, "prints this list; -help beam, -help wheel, ...: a part of it; -help beam_EI: one option"},

  {"log_view", flag, "", "false", any, "", 0, "PETSc's account of time, calls and messages, printed at the end"},
  {"malloc_debug", flag, "", "false", any, "", 0, "PETSc checks its memory"},
  {"skip_petscrc", flag, "", "false", any, "", 0, "on the command line: the files .petscrc and petscrc are not read"},
};

constexpr Row vary[] = {
  {"from", text, "", "", any, "", 0, "the first value"},
  {"to", text, "", "", any, "", 0, "the last one"},
  {"step", text, "", "", any, "", 0, "from one to the next"},
  {"count", integer, "", "", {1, 1e6}, "", 0, "how many, at equal distances, instead of a step"},
  {"uniform", texts, "", "", any, "", 2, "draws values between these two"},
  {"normal", texts, "", "", any, "", 2, "draws values with this mean and standard deviation"},
  {"lognormal", texts, "", "", any, "", 2, "draws values above 0 with this mean and standard deviation"},
  {"also", texts, "", "", any, "", 0, "further options that take the same values"},
};
constexpr Row vary_list = {"", texts, "", "", any, "", 0, "the values: a list, or from:to for whole numbers, from:to:step; speeds may be in km/h"};

constexpr std::string_view petsc_prefixes[] = {
  "ts_", "snes_", "ksp_", "pc_", "mat_", "vec_", "eps_", "st_", "svd_", "pep_", "nep_", "bv_", "ds_", "rg_", "fn_",
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

std::span<const Row> vary_rows() { return vary; }
const Row& vary_list_row() { return vary_list; }

bool owned_by_petsc(std::string_view name) {
  for (const std::string_view prefix : petsc_prefixes) {
    if (name.starts_with(prefix)) return true;
  }
  return false;
}

bool passes_to_petsc(std::string_view name) { return owned_by_petsc(name) && find_row(fixed_rows(), name) != nullptr; }

}  // namespace traverse::options
