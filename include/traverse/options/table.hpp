// The option table: name, type, unit, default, range, choices and one line of text of each option. The checks, the list
// of -help and the proposals for misspelt names use this table.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::options {

enum class Kind {
  number,
  integer,
  flag,  // true or false; a name without a value means true
  text,
  choice,   // one of Row::choices
  file,     // the name of an existing file
  numbers,  // a list, like the next three types: separated by commas, an entry may be value*count
  integers,
  texts,
  choice_list,
  number_or_file,  // a number, or a table with the columns x (m) and value (Row::unit)
  table,           // the name of an existing file with columns of numbers, whose units are Row::unit
  word_or_table,   // the same, or a word
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above = false;  // low itself is excluded
  /// Whether the value is in the range.
  bool contains(double value) const { return value <= high && (above ? value > low : value >= low); }
};
inline constexpr Range any = {};
inline constexpr Range positive = {0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative = {0.0};

struct Row {
  std::string_view name;  // name; for an option of a part only its last word
  Kind kind = Kind::number;
  std::string_view unit;
  std::string_view fallback;  // the default value, or a remark on the default in brackets; empty: none
  Range range;
  std::string_view choices;  // permitted words, separated by blanks; of a number: words in its place
  int count = 0;             // required number of entries of a list; 0: any number
  std::string_view text;
  bool once = false;  // no entry of a list may be repeated
};

/// The kinds of parts of a vehicle, in the order of the table in table_vehicle.cpp.
enum class Part { body, joint, spring, torsion_spring, rope, wheel, actuator, driver, contact, sensor };
inline constexpr int part_kinds = 10;
/// The option with the list of the parts of a kind: "bodies", ...
std::string_view part_list(Part part);
/// The name of a kind in messages: "body", "joint", ...
std::string_view part_word(Part part);

/// The options with a fixed name.
std::span<const Row> fixed_rows();
/// The options vehicle_<name>_<row>.
std::span<const Row> vehicle_rows();
/// The options vehicle_<name>_<part>_<row>.
std::span<const Row> part_rows(Part part);

/// The options train_<coupler>_<row>, in addition to the options of springs and joints.
std::span<const Row> coupler_rows();

/// The options track_<stretch>_<row>, and beam_<damper>_<row>.
std::span<const Row> stretch_rows();
std::span<const Row> damper_rows();

/// The options study_vary_<option>_<row>, and study_vary_<option> itself.
std::span<const Row> vary_rows();
const Row& vary_list_row();

/// The options fit_to_<name>_<row>, and the row of fit_vary_<option>.
std::span<const Row> fit_rows();
const Row& fit_bounds_row();

/// Whether an option may name a table of numbers.
bool names_table(const Row& row);
/// The options NAME_<row> beside an option NAME that may name a table of numbers.
std::span<const Row> table_rows();
/// A name NAME_<row> of such an option as its two parts; none for other names.
std::optional<std::pair<std::string, const Row*>> beside_table(std::string_view name);

/// The row of a name; null for an unknown name.
const Row* find_row(std::span<const Row> rows, std::string_view name);

/// Whether a name begins like the names of PETSc's and SLEPc's options.
bool owned_by_petsc(std::string_view name);
/// Whether an option is passed to PETSc. Only PETSc's options in this table are passed; none of them starts a program,
/// loads code or writes a file.
bool passes_to_petsc(std::string_view name);

/// The text of the permitted values: "above 0 (m)", "one of none, bump", "2 numbers".
std::string allowed(const Row& row);

/// A shorter text of the permitted values, with the default, for -help.
std::string allowed_in_short(const Row& row);

/// The most similar candidate, by the letters changed, added, removed or swapped; empty if none is similar.
std::string nearest(std::string_view name, const std::vector<std::string>& candidates);

/// The text of -help for all options, for a group of options such as beam or wheel, or for one option. InputError with
/// the list of groups for any other word.
std::string help_text(const std::string& about = {});

}  // namespace traverse::options
