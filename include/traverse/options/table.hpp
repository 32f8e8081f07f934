// Every option once: name, type, unit, default, range, choices and one line of text. The table drives the checks,
// the list that -help prints and the proposals for misspelt names.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

enum class Kind {
  number,
  integer,
  flag,  // true or false; a name alone is true
  text,
  choice,   // one of Row::choices
  file,     // the name of a file that exists
  numbers,  // lists: comma lists whose entries may be value*count
  integers,
  texts,
  choice_list,
  number_or_file,  // a number, or a file with two columns
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above = false;  // low itself is not allowed
  /// Whether the value lies in the range.
  bool holds(double value) const { return value <= high && (above ? value > low : value >= low); }
};
inline constexpr Range any = {};
inline constexpr Range positive = {0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative = {0.0};

struct Row {
  std::string_view name;  // of a part's option: the last word only
  Kind kind = Kind::number;
  std::string_view unit;
  std::string_view fallback;  // the default as a user would write it, or a remark in brackets; empty: none
  Range range;
  std::string_view choices;  // separated by blanks
  int count = 0;             // entries that a list must have; 0: any number
  std::string_view text;
};

/// The kinds of parts of a vehicle, in the order of `part_lists`.
enum class Part { body, joint, spring, torsion_spring, wheel, actuator, driver, contact, sensor };
inline constexpr int part_kinds = 9;
/// The option that lists the parts of a kind: "bodies", ...
std::string_view part_list(Part part);
/// "body", "joint", ... for messages.
std::string_view part_word(Part part);

/// Options with a fixed name.
std::span<const Row> fixed_rows();
/// Options vehicle_<name>_<row>.
std::span<const Row> vehicle_rows();
/// Options vehicle_<name>_<part>_<row>.
std::span<const Row> part_rows(Part part);

/// Options train_<coupler>_<row>, besides those of springs and joints.
std::span<const Row> coupler_rows();

/// Options track_<stretch>_<row>.
std::span<const Row> stretch_rows();

/// Options study_vary_<option>_<row>, and study_vary_<option> itself.
std::span<const Row> vary_rows();
const Row& vary_list_row();

/// The row of a name; null where there is none.
const Row* find_row(std::span<const Row> rows, std::string_view name);

/// Whether a name is of the kinds that PETSc and SLEPc own.
bool owned_by_petsc(std::string_view name);
/// Whether an option goes on to PETSc: those of the kinds above that stand in the table, none that starts a program,
/// loads code or writes a file. Nothing else reaches PETSc.
bool passes_to_petsc(std::string_view name);

/// What is allowed, in words: "above 0 (m)", "one of none, bump", "2 numbers".
std::string allowed(const Row& row);

/// The same with the default, as -help has it.
std::string allowed_in_short(const Row& row);

/// The candidate with the fewest letters changed, added, left out or swapped; empty when none is near.
std::string nearest(std::string_view name, const std::vector<std::string>& candidates);

/// The text of -help: of everything, of a group of options such as beam or wheel, or of one option. InputError with
/// what there is for something else.
std::string help_text(const std::string& about = {});

}  // namespace traverse::options
