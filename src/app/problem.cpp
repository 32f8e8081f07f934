// Keeps the options and tables of a problem as texts, and reads its scene from them.
#include "traverse/problem.hpp"

#include <fmt/format.h>

#include <cmath>

#include "options/input_texts.hpp"
#include "options/read_file.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse {
namespace {

constexpr const char* source = "problem";
constexpr double same_place = 1e-9;  // relative to the step of a table

std::string list_of(const std::vector<double>& numbers) { return fmt::format("{}", fmt::join(numbers, ",")); }

}  // namespace

Value::Value(double number) : text_(fmt::format("{}", number)) {}
Value::Value(int number) : text_(std::to_string(number)) {}
Value::Value(bool flag) : text_(flag ? "true" : "false") {}
Value::Value(const std::vector<double>& list) : text_(list_of(list)) {}

Problem::Problem(std::initializer_list<std::pair<std::string, Value>> options) {
  for (const auto& [name, value] : options) set(name, value);
}

Problem Problem::read(const std::string& file) {
  Problem problem;
  const std::string found = options::find_file(file, "");
  for (options::Entry& entry : options::read_options_file(found.empty() ? file : found))
    problem.entries_.set(std::move(entry));
  return problem;
}

Problem Problem::from_yaml(const std::string& text) {
  Problem problem;
  for (options::Entry& entry : options::parse_yaml(text, source)) problem.entries_.set(std::move(entry));
  return problem;
}

Problem Problem::of(options::Entries entries) {
  Problem problem;
  problem.entries_ = std::move(entries);
  return problem;
}

Problem& Problem::set(const std::string& name, const Value& value) {
  entries_.set({name, value.text(), source, 0});
  return *this;
}

Problem& Problem::remove(const std::string& name) {
  options::Entries rest;
  for (const options::Entry& entry : entries_)
    if (entry.name != name) rest.set(entry);
  entries_ = std::move(rest);
  return *this;
}

Problem& Problem::table(const std::string& name, const std::vector<std::vector<double>>& columns) {
  std::string& text = tables_[name];
  text.clear();
  for (std::size_t row = 0; !columns.empty() && row < columns.front().size(); ++row) {
    for (const std::vector<double>& column : columns) {
      if (column.size() != columns.front().size())
        throw InputError(fmt::format("table {}: its columns have different lengths", name));
      fmt::format_to(std::back_inserter(text), "{} ", column[row]);
    }
    text += '\n';
  }
  return *this;
}

Problem& Problem::table(const std::string& name, const std::function<double(double)>& f, double from, double to,
                        double step) {
  constexpr double most_rows = 1e6;
  const double steps = std::round((to - from) / step);
  if (!(step > 0.0 && steps >= 1.0 && steps < most_rows &&
        std::abs(from + steps * step - to) < same_place * step * steps))
    throw InputError(fmt::format("table {}: from {:g} to {:g} by {:g}: wanted: a whole number of steps, from 1 to {:g}",
                                 name, from, to, step, most_rows));
  std::vector<std::vector<double>> columns(2);
  for (double k = 0.0; k <= steps; ++k) {
    const double x = from + (to - from) * (k / steps);
    columns[0].push_back(x);
    columns[1].push_back(f(x));
  }
  return table(name, columns);
}

Problem& Problem::change(Change change) {
  changes_.push_back(std::make_shared<const Change>(std::move(change)));
  return *this;
}

scene::Scene Problem::scene() const {
  return scene([this] { return scene::read_scene(options::Options(options::complete(entries_, source))); });
}

scene::Scene Problem::scene(const std::function<scene::Scene()>& read) const {
  const options::TablesInMemory tables(tables_);
  scene::Scene scene = read();
  for (const std::shared_ptr<const Change>& one : changes_) (*one)(scene);
  scene.output.file.clear();
  scene.quiet = true;
  return scene;
}

}  // namespace traverse
