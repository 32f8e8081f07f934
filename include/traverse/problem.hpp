// A problem as a program describes it: a bridge and what crosses it, by options, tables and changes of its own.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "traverse/options/entry.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse {

/// The value of an option: a number or a list of numbers in SI units, a text such as "250 km/h", or a truth value.
class Value {
 public:
  Value(double number);                                // NOLINT(google-explicit-constructor): written as a number
  Value(int number);                                   // NOLINT(google-explicit-constructor)
  Value(bool flag);                                    // NOLINT(google-explicit-constructor)
  Value(const char* text) : text_(text) {}             // NOLINT(google-explicit-constructor)
  Value(std::string text) : text_(std::move(text)) {}  // NOLINT(google-explicit-constructor)
  Value(const std::vector<double>& list);              // NOLINT(google-explicit-constructor)
  Value(std::initializer_list<double> list) : Value(std::vector<double>(list)) {}

  /// The value as a scene file has it.
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A value: copies are independent, and nothing is shared between two problems of a process. Options have the names of
/// the program (`traverse -help`, without the dash). They are read when the scene is needed, not before.
class Problem {
 public:
  using Change = std::function<void(scene::Scene&)>;

  Problem() = default;  // without options
  /// The options by their names.
  Problem(std::initializer_list<std::pair<std::string, Value>> options);
  /// The options of a scene file. Paths in it are relative to its folder. Throws InputError.
  static Problem read(const std::string& file);
  /// The options of a text in YAML, or in JSON.
  static Problem from_yaml(const std::string& text);

  /// Options with their sources, as read_input gives them.
  static Problem of(options::Entries entries);

  /// Sets an option, or replaces its value.
  Problem& set(const std::string& name, const Value& value);
  Problem& remove(const std::string& name);
  /// A table with these columns, in place of a file: an option that names the file `name`, such as "wave.csv", reads
  /// it.
  Problem& table(const std::string& name, const std::vector<std::vector<double>>& columns);
  /// A table of the function y = f(x) for x = from, from + step, ..., to.
  Problem& table(const std::string& name, const std::function<double(double)>& f, double from, double to, double step);
  /// What no option can say, such as a contact law: a change of each scene that is read from this problem.
  Problem& change(Change change);

  /// The scene of these options, checked and changed. Throws InputError with one line.
  scene::Scene scene() const;
  /// The scene that `read` reads, such as that of a run of a study, with the tables and changes of this problem.
  scene::Scene scene(const std::function<scene::Scene()>& read) const;

  /// The options with their sources, as given.
  const options::Entries& entries() const { return entries_; }
  /// Whether two problems have the same tables and changes, so that only their options may differ.
  bool differs_in_options_only(const Problem& other) const {
    return tables_ == other.tables_ && changes_ == other.changes_;
  }

 private:
  options::Entries entries_;
  std::map<std::string, std::string> tables_;  // the text of each table by its name
  std::vector<std::shared_ptr<const Change>> changes_;
};

}  // namespace traverse
