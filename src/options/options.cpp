// Conversion of option texts to numbers, flags, choices, lists and paths, checked for range, count and magnitude
// against the table of options.
#include "traverse/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/text.hpp"
#include "options/limits.hpp"
#include "options/parse_number.hpp"
#include "options/read_file.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

/// The words of a comma list without the brackets around it.
std::vector<std::string> split(const std::string& value) {
  std::string text = base::trimmed(value);
  if (text.size() >= 2 && text.front() == '[' && text.back() == ']')
    text = base::trimmed(text.substr(1, text.size() - 2));
  std::vector<std::string> words;
  if (text.empty()) return words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(base::trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return words;
}

/// The probable reason why a word is not a number: a comma, or a unit after it.
std::string why_not_a_number(const std::string& word, const Row& row) {
  double number = 0.0;
  const bool one = row.kind == Kind::number || row.kind == Kind::integer || row.kind == Kind::number_or_file;
  if (one && word.find(',') != std::string::npos) {
    std::string with_point = word;
    with_point.replace(with_point.find(','), 1, ".");
    if (parse_number(with_point, number))
      return fmt::format(" (expected one number; use a decimal point: {})", with_point);
    return " (expected one number, not a list)";
  }
  const std::size_t end = word.find_first_not_of("+-.0123456789eE");
  if (end == std::string::npos || row.unit.empty() || row.unit == "1" || !parse_number(word.substr(0, end), number))
    return "";
  if (row.unit == "m/s") return " (give a speed in m/s, or in km/h as in 100 km/h)";
  return fmt::format(" (give the number without its unit, in {})", row.unit);
}

bool is_choice(const Row& row, std::string_view word) {
  return word.find(' ') == std::string_view::npos &&
         fmt::format(" {} ", row.choices).find(fmt::format(" {} ", word)) != std::string::npos;
}

/// Whether a default is empty or a remark in brackets, which is not a value.
bool is_remark(std::string_view fallback) { return fallback.empty() || fallback.front() == '('; }

Entries entries_of(const std::vector<Entry>& list) {
  Entries entries;
  for (const Entry& entry : list) entries.set(entry);
  return entries;
}

Entries entries_of(std::initializer_list<std::pair<std::string, std::string>> values) {
  Entries entries;
  for (const auto& [name, value] : values) entries.set({name, value, "command line", 0});
  return entries;
}

}  // namespace

Options::Options(Entries entries) : entries_(std::move(entries)) {}

Options::Options(std::initializer_list<std::pair<std::string, std::string>> values) : Options(entries_of(values)) {}

Options Options::from_yaml(const std::string& text, const std::string& name) {
  return Options(entries_of(parse_yaml(text, name)));
}

bool Options::has(std::string_view name) const {
  const Entry* entry = entries_.find(name);
  if (entry == nullptr) return false;
  const Row* known = find_known(name);
  const bool list = known != nullptr && (known->kind == Kind::numbers || known->kind == Kind::integers ||
                                         known->kind == Kind::texts || known->kind == Kind::choice_list);
  return !list || !split(entry->value).empty();
}

const Entry* Options::first_with_prefix(std::string_view prefix) const {
  for (const Entry& entry : entries_) {
    if (entry.name.starts_with(prefix)) return &entry;
  }
  return nullptr;
}

void Options::add_defaults(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries_of(entries)) entries_.set_default(entry);
}

const Row& Options::row(std::string_view name) const {
  const Row* known = find_known(name);
  if (known == nullptr) throw Error(fmt::format("option {} is read but is not in the option table", name), 1);
  return *known;
}

void Options::check_at_most(std::string_view name, double count, double most, std::string_view what) const {
  if (!(count <= most)) refuse(name, fmt::format("{:.6g} {}; allowed: at most {:g}", count, what, most));
}

void Options::check_values() const {
  for (const Entry& entry : entries_) {
    if (const Row* known = find_known(entry.name)) check_value(entry, *known);
  }
}

void Options::check_value(const Entry& entry, const Row& row) const {
  const std::string_view name = entry.name;
  // an empty list of parts or vehicles is permitted, in other lists the value is missing
  if (row.kind != Kind::flag && row.kind != Kind::texts && split(entry.value).empty()) {
    refuse(name, "has no value; allowed: " + allowed(row));
  }
  if (row.kind == Kind::texts && entry.from_file() && base::trimmed(entry.value).empty()) {
    refuse(name, "has no value; allowed: " + allowed(row) + ", or [] for none");
  }
  switch (row.kind) {
    case Kind::number:
    case Kind::integer:
      if (!is_choice(row, base::trimmed(entry.value))) (void)(row.kind == Kind::number ? number(name) : integer(name));
      break;
    case Kind::flag:
      (void)flag(name);
      break;
    case Kind::text:
    case Kind::word_or_table:
    case Kind::choice:
      (void)text(name);
      break;
    case Kind::numbers:
      (void)numbers(name);
      break;
    case Kind::integers:
      (void)integers(name);
      break;
    case Kind::texts:
    case Kind::choice_list:
      (void)texts(name);
      break;
    case Kind::file:
    case Kind::table:
      (void)path(name);
      break;
    case Kind::number_or_file:
      if (!is_number(name)) (void)path(name);
      break;
  }
}

void Options::refuse(std::string_view name, const std::string& why) const {
  const Entry* entry = entries_.find(name);
  if (entry == nullptr) throw InputError(fmt::format("{}: {}", name, why));
  throw InputError(entry->given() + ": " + why);
}

std::string Options::value_or_default(std::string_view name) const {
  const Row& known = row(name);
  if (const Entry* entry = entries_.find(name)) {
    std::string value = base::trimmed(entry->value);
    if (value.empty() && known.kind != Kind::flag) refuse(name, "has no value; allowed: " + allowed(known));
    return value;
  }
  if (is_remark(known.fallback)) {
    throw InputError(fmt::format("{} is missing: {}; allowed: {}", name, known.text, allowed(known)));
  }
  return std::string(known.fallback);
}

std::vector<std::string> Options::list(std::string_view name) const {
  const Row& known = row(name);
  const Entry* entry = entries_.find(name);
  const std::size_t most = most_entries(name, known);
  std::vector<std::string> expanded;
  for (const std::string& word : split(entry != nullptr ? entry->value : value_or_default(name))) {
    const std::size_t star = word.rfind('*');
    std::size_t count = 1;
    if (star != std::string::npos) {
      const std::string digits = base::trimmed(word.substr(star + 1));
      const auto [stop, code] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
      if (code == std::errc::result_out_of_range) count = std::numeric_limits<std::size_t>::max();
      if ((code != std::errc() && code != std::errc::result_out_of_range) || stop != digits.data() + digits.size() ||
          count < 1 || digits.empty()) {
        refuse(name, fmt::format("'{}': after * there must be a whole number, the number of repetitions", word));
      }
    }
    const std::string value = base::trimmed(word.substr(0, star));
    if (value.empty()) refuse(name, "has an empty entry; allowed: " + allowed(known));
    if (count > most || expanded.size() + count > most)
      refuse(name, fmt::format("has too many entries; allowed: at most {}", most));
    expanded.insert(expanded.end(), count, value);
  }
  if (known.count > 0 && expanded.size() != static_cast<std::size_t>(known.count))
    refuse(name, fmt::format("has {} entries; allowed: {}", expanded.size(), allowed(known)));
  return expanded;
}

double Options::to_quantity(std::string_view name, const std::string& word, const Row& known) const {
  double value = 0.0;
  if (!(known.unit == "m/s" ? parse_speed(word, value) : parse_number(word, value))) {
    refuse(name, fmt::format("'{}' is not a finite number{}; allowed: {}", word, why_not_a_number(word, known),
                             allowed(known)));
  }
  if (!is_quantity(value))
    refuse(name, fmt::format("'{}' is not a possible quantity in SI units; allowed: 0, or {:g} to {:g} in magnitude",
                             word, least_quantity, greatest_quantity));
  return value;
}

double Options::to_number(std::string_view name, const std::string& word) const {
  const Row& known = row(name);
  const double value = to_quantity(name, word, known);
  if (!known.range.contains(value))
    refuse(name,
           known.kind == Kind::numbers
               ? fmt::format("'{}' is not allowed; allowed: {}; a comma separates the numbers of a list, decimals "
                             "need a point",
                             word, allowed(known))
               : "allowed: " + allowed(known));
  return value;
}

int Options::to_integer(std::string_view name, const std::string& word) const {
  const double value = to_number(name, word);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
    refuse(name, "allowed: " + allowed(row(name)));
  }
  return static_cast<int>(value);
}

double Options::number(std::string_view name) const { return to_number(name, value_or_default(name)); }

int Options::integer(std::string_view name) const { return to_integer(name, value_or_default(name)); }

bool Options::flag(std::string_view name) const {
  const std::string value = value_or_default(name);
  for (const char* word : {"", "true", "True", "TRUE", "yes", "on", "1"}) {
    if (value == word) return true;
  }
  for (const char* word : {"false", "False", "FALSE", "no", "off", "0"}) {
    if (value == word) return false;
  }
  refuse(name, "allowed: true or false");
}

std::string Options::text(std::string_view name) const {
  std::string value = value_or_default(name);
  const Row& known = row(name);
  if (known.kind == Kind::choice && !is_choice(known, value)) refuse(name, "allowed: " + allowed(known));
  return value;
}

std::vector<double> Options::numbers(std::string_view name) const {
  std::vector<double> values;
  for (const std::string& word : list(name)) values.push_back(to_number(name, word));
  return values;
}

std::vector<int> Options::integers(std::string_view name) const {
  std::vector<int> values;
  for (const std::string& word : list(name)) values.push_back(to_integer(name, word));
  check_once(name, values);
  return values;
}

std::vector<std::string> Options::texts(std::string_view name) const {
  std::vector<std::string> words = list(name);
  const Row& known = row(name);
  if (known.kind == Kind::choice_list)
    for (const std::string& word : words)
      if (!is_choice(known, word)) refuse(name, fmt::format("'{}' is not allowed; allowed: {}", word, allowed(known)));
  check_once(name, words);
  return words;
}

std::optional<double> Options::optional_number(std::string_view name) const {
  if (!has(name) || is_choice(row(name), value_or_default(name))) return std::nullopt;
  return number(name);
}

template <class T>
void Options::check_once(std::string_view name, const std::vector<T>& values) const {
  if (!row(name).once) return;
  for (auto value = values.begin(); value != values.end(); ++value)
    if (std::find(values.begin(), value, *value) != value)
      refuse(name, fmt::format("has '{}' twice; allowed: each once", *value));
}

template <class T>
std::vector<T> Options::spread(std::string_view name, std::vector<T> values, std::size_t count,
                               std::string_view what) const {
  if (values.size() == 1) values.resize(count, values.front());
  if (values.size() != count) {
    const std::string allowed_counts = count == 1 ? "1" : fmt::format("one, or {}", count);
    refuse(name, fmt::format("has {} entries; allowed: {} ({})", values.size(), allowed_counts, what));
  }
  return values;
}

std::vector<double> Options::numbers(std::string_view name, std::size_t count, std::string_view what) const {
  return spread(name, numbers(name), count, what);
}

std::vector<int> Options::integers(std::string_view name, std::size_t count, std::string_view what) const {
  return spread(name, integers(name), count, what);
}

std::vector<std::string> Options::texts(std::string_view name, std::size_t count, std::string_view what) const {
  return spread(name, texts(name), count, what);
}

bool Options::is_number(std::string_view name) const {
  const std::string value = value_or_default(name);
  double parsed = 0.0;
  const bool like_a_number = value.find_first_not_of("+-.0123456789eE") == std::string::npos ||
                             value.ends_with("nan") || value.ends_with("inf");
  if (!parse_number(value, parsed) && !like_a_number) return false;
  (void)to_number(name, value);
  return true;
}

bool Options::is_table(std::string_view name) const {
  const Kind kind = row(name).kind;
  return kind == Kind::number_or_file
             ? !is_number(name)
             : kind != Kind::word_or_table || text(name).find_first_of("./") != std::string::npos;
}

std::string Options::path_or_folder(std::string_view name) const {
  const std::string value = value_or_default(name);
  const Entry* entry = entries_.find(name);
  std::string found = find_file(value, entry != nullptr && entry->from_file() ? entry->source : "");
  if (found.empty()) {
    const bool number = row(name).kind == Kind::number_or_file;
    refuse(name, number ? fmt::format("neither a number nor a file that exists{}; allowed: {}",
                                      why_not_a_number(value, row(name)), allowed(row(name)))
                        : "there is no such file in the working directory or beside the file that names it");
  }
  return found;
}

std::string Options::path(std::string_view name) const {
  std::string found = path_or_folder(name);
  std::error_code ignored;
  if (std::filesystem::is_directory(found, ignored)) refuse(name, "is a folder, not a file");
  return found;
}

std::vector<std::pair<std::string, std::string>> Options::all() const {
  std::vector<std::pair<std::string, std::string>> list;
  for (const Entry& entry : entries_) list.emplace_back(entry.name, entry.value);
  return list;
}

}  // namespace traverse::options
