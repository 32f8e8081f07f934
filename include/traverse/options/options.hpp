// Typed, checked reading of the options in force. Every getter throws InputError with one line that names the
// option, its value, where it was given and what is allowed.
#pragma once

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
  /// Options as they were given, before any check.
  explicit Options(Entries entries);
  /// For tests: names and values, given on the "command line".
  Options(std::initializer_list<std::pair<std::string, std::string>> values);
  /// For tests: YAML text, its lines counted as those of a file called `name`.
  static Options from_yaml(const std::string& text, const std::string& name = "scene.yml");

  /// All that is given, in its order.
  const Entries& entries() const { return entries_; }
  /// Whether the option is given and no empty list.
  bool has(std::string_view name) const;
  /// Whether any option is given whose name starts with this.
  const Entry* first_with_prefix(std::string_view prefix) const;

  /// Adds options that count unless they are given already: those of a vehicle's file.
  void add_defaults(const std::vector<Entry>& entries);
  /// Makes a name known besides the fixed ones: the options of a vehicle and its parts.
  /// False when the name is known already.
  bool declare(const std::string& name, const Row& row);
  bool knows(std::string_view name) const { return find_known(name) != nullptr; }
  /// The row of a name; null where nothing is known of it.
  const Row* find_known(std::string_view name) const;
  /// The known name that is nearest to one; empty where none is near.
  std::string nearest_known(const std::string& name) const;

  /// Every option given must be known, or owned by PETSc. Throws naming the nearest known one.
  void check_names() const;
  /// Every known option given must be of its row's type and inside its range.
  void check_values() const;

  // Values: what is given, otherwise the row's default; without either "NAME is missing: <text>".
  double number(std::string_view name) const;
  int integer(std::string_view name) const;
  bool flag(std::string_view name) const;
  std::string text(std::string_view name) const;
  std::string choice(std::string_view name) const { return text(name); }
  std::vector<double> numbers(std::string_view name) const;
  std::vector<int> integers(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  /// The number that is given; none where it is not.
  std::optional<double> optional_number(std::string_view name) const;
  /// A list of `count` entries where a single one serves all; `what` says what is counted, for the message.
  std::vector<double> numbers(std::string_view name, std::size_t count, std::string_view what) const;
  std::vector<int> integers(std::string_view name, std::size_t count, std::string_view what) const;
  std::vector<std::string> texts(std::string_view name, std::size_t count, std::string_view what) const;

  /// Whether the value of a number_or_file option is a number.
  bool is_number(std::string_view name) const;
  /// The file that an option names, found beside the file that names it or from the working directory.
  std::string path(std::string_view name) const;

  /// Throws InputError "NAME = value (where): why", or "NAME: why" when it is not given.
  [[noreturn]] void refuse(std::string_view name, const std::string& why) const;

  /// The full list with final values, for the results file.
  std::vector<std::pair<std::string, std::string>> all() const;

 private:
  const Row& row(std::string_view name) const;
  void check_value(const Entry& entry, const Row& row) const;
  std::string value_or_default(std::string_view name) const;
  std::vector<std::string> list(std::string_view name) const;
  double to_number(std::string_view name, const std::string& word) const;
  int to_integer(std::string_view name, const std::string& word) const;
  template <class T>
  std::vector<T> spread(std::string_view name, std::vector<T> list, std::size_t count, std::string_view what) const;

  Entries entries_;
  std::unordered_map<std::string, const Row*> declared_;
};

}  // namespace traverse::options
