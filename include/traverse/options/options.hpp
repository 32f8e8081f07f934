// Typed and checked access to the options in force. Each getter throws InputError with one line that names the option,
// its value, its source and the permitted values.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "traverse/options/entry.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {

class Options {
 public:
  /// The options as given, without any check.
  explicit Options(Entries entries);
  /// For tests: names and values with the source "command line".
  Options(std::initializer_list<std::pair<std::string, std::string>> values);
  /// For tests: YAML text with the source `name`.
  static Options from_yaml(const std::string& text, const std::string& name = "scene.yml");

  /// All given options in their order.
  const Entries& entries() const { return entries_; }
  /// Whether the option is given and is not an empty list.
  bool has(std::string_view name) const;
  /// The first given option whose name begins with the prefix; null if there is none.
  const Entry* first_with_prefix(std::string_view prefix) const;

  /// Adds default options, such as the options of a vehicle's file. An option that is given already is unchanged.
  void add_defaults(const std::vector<Entry>& entries);
  /// Makes a name known in addition to the fixed names, for an option of a vehicle or its parts. Returns false if the
  /// name is known already.
  bool declare(const std::string& name, const Row& row);
  /// Whether an option has this name.
  bool knows(std::string_view name) const { return find_known(name) != nullptr; }
  /// The row of a name, also of an option beside one that names a table (table_rows); null for an unknown name.
  const Row* find_known(std::string_view name) const;
  /// The known name that is most similar to `name`; empty if none is similar.
  std::string nearest_known(const std::string& name) const;

  /// Checks that an option that the value of option `name` names is known. InputError with the most similar known name.
  void check_known(std::string_view name, const std::string& other) const;
  /// Checks that option `name` does not give more than `most` things; what: their name in the plural.
  void check_at_most(std::string_view name, double count, double most, std::string_view what) const;
  /// Checks that each given option is known. Throws InputError with the most similar known name.
  void check_names() const;
  /// Checks that each known given option has the type of its row and is in its range.
  void check_values() const;

  // The given value, otherwise the default of the row; without either an InputError "NAME is missing: <text>".
  double number(std::string_view name) const;
  int integer(std::string_view name) const;
  bool flag(std::string_view name) const;
  std::string text(std::string_view name) const;
  std::string choice(std::string_view name) const { return text(name); }
  std::vector<double> numbers(std::string_view name) const;
  std::vector<int> integers(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  /// The given number; none if it is not given, or if one of the row's words is given in its place.
  std::optional<double> optional_number(std::string_view name) const;
  /// A list of `count` entries. A single given entry is used for all. `what` describes the entries for the message.
  std::vector<double> numbers(std::string_view name, std::size_t count, std::string_view what) const;
  std::vector<int> integers(std::string_view name, std::size_t count, std::string_view what) const;
  std::vector<std::string> texts(std::string_view name, std::size_t count, std::string_view what) const;

  /// The number in a word of option `name`, in the unit of `row` and of any range; speeds may be in km/h.
  double to_quantity(std::string_view name, const std::string& word, const Row& row) const;
  /// Whether the value of a number_or_file option is a number.
  bool is_number(std::string_view name) const;
  /// Whether the value of an option that may name a table does so; a word does with a point or a slash in it.
  bool is_table(std::string_view name) const;
  /// The path of the file that an option names, relative to the file that names it or to the working directory.
  std::string path(std::string_view name) const;
  /// The same for an option that may name a folder, too.
  std::string path_or_folder(std::string_view name) const;

  /// Keeps a note on what was read, once; it is for the notes of the scene.
  void note(const std::string& text) const {
    if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
  }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Throws InputError "NAME = value (where): why", or "NAME: why" if the option is not given.
  [[noreturn]] void refuse(std::string_view name, const std::string& why) const;

  /// All given options with their values, for the results file.
  std::vector<std::pair<std::string, std::string>> all() const;

 private:
  const Row& row(std::string_view name) const;
  void check_value(const Entry& entry, const Row& row) const;
  std::string value_or_default(std::string_view name) const;
  std::vector<std::string> list(std::string_view name) const;
  double to_number(std::string_view name, const std::string& word) const;
  int to_integer(std::string_view name, const std::string& word) const;
  template <class T>
  void check_once(std::string_view name, const std::vector<T>& values) const;
  template <class T>
  std::vector<T> spread(std::string_view name, std::vector<T> list, std::size_t count, std::string_view what) const;

  Entries entries_;
  std::unordered_map<std::string, const Row*> declared_;
  mutable std::vector<std::string> notes_;
};

}  // namespace traverse::options
