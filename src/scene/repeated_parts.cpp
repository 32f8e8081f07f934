// Expands the options of repeated parts: numbers in references to bodies, and displaced points.
#include "repeated_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace traverse::scene {
namespace {

using options::Options;
using options::Part;
using options::Row;

constexpr std::string_view delay = "delay";  // of the table of an actuator

/// A reference to a body: the body with the number of the part plus `offset`, if the body is repeated.
struct Reference {
  std::string body;
  int offset = 0;
};

class Repeat {
 public:
  Repeat(const Options& o, std::string prefix) : o_(o), prefix_(std::move(prefix)) {
    if (!o.has(prefix_ + "repeat_parts")) return;
    parts_ = o.texts(prefix_ + "repeat_parts");
    count_ = o.integer(prefix_ + "repeat_count");
    pitch_ = o.numbers(prefix_ + "repeat_pitch");
    delay_ = o.number(prefix_ + "repeat_delay");
  }

  int count() const { return count_; }
  const std::vector<std::string>& parts() const { return parts_; }
  bool repeats(const std::string& part) const { return std::find(parts_.begin(), parts_.end(), part) != parts_.end(); }
  std::string option(const std::string& part, const Row& row) const {
    return fmt::format("{}{}_{}", prefix_, part, row.name);
  }

  /// The numbers of a repeated part: those for which all bodies that it refers to exist, [first, last).
  std::pair<int, int> numbers_of(const std::string& part, Part kind) const {
    int first = 0, last = count_;
    for (const Row& row : options::part_rows(kind)) {
      if (!refers_to_bodies(row) || !o_.entries().has(option(part, row))) continue;
      for (const std::string& word : o_.texts(option(part, row))) {
        const Reference reference = reference_of(word);
        if (!repeats(reference.body)) continue;
        first = std::max(first, -reference.offset);
        last = std::min(last, count_ - reference.offset);
      }
    }
    return {first, std::max(first, last)};
  }

  /// The value of an option of repetition `number`.
  std::string value(const std::string& name, const Row& row, int number) const {
    if (refers_to_bodies(row)) return bodies(o_.texts(name), number);
    if (is_place(row)) return places(o_.numbers(name), number);
    if (row.name == delay) return fmt::format("{}", o_.number(name) + number * delay_);
    return o_.entries().find(name)->value;
  }

 private:
  static bool refers_to_bodies(const Row& row) {
    constexpr std::string_view references[] = {"bodies", "body", "reaction_body", "drum", "lifts"};
    return std::find(std::begin(references), std::end(references), row.name) != std::end(references);
  }
  static bool is_place(const Row& row) {
    constexpr std::string_view places[] = {"position", "point", "points", "from", "to", "centres", "line"};
    return std::find(std::begin(places), std::end(places), row.name) != std::end(places);
  }

  static Reference reference_of(const std::string& word) {
    const std::size_t sign = word.find_last_of("+-");
    if (sign == std::string::npos || sign == 0) return {word, 0};
    const char* const begin = word.data() + sign + (word[sign] == '+' ? 1 : 0);
    const char* const end = word.data() + word.size();
    int offset = 0;
    const auto [stop, error] = std::from_chars(begin, end, offset);
    return error == std::errc() && stop == end ? Reference{word.substr(0, sign), offset} : Reference{word, 0};
  }

  std::string bodies(const std::vector<std::string>& words, int number) const {
    std::string all;
    for (const std::string& word : words) {
      const Reference reference = reference_of(word);
      all += all.empty() ? "" : ",";
      all += repeats(reference.body) ? fmt::format("{}{}", reference.body, number + reference.offset) : word;
    }
    return all;
  }

  std::string places(std::vector<double> numbers, int number) const {
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += number * pitch_[i % 2];
    return fmt::format("{}", fmt::join(numbers, ","));
  }

  const Options& o_;
  std::string prefix_;
  std::vector<std::string> parts_;
  int count_ = 0;
  std::vector<double> pitch_ = {0.0, 0.0};
  double delay_ = 0.0;
};

/// The list of the vehicle that has this part.
std::optional<Part> kind_of(const Options& o, const std::string& prefix, const std::string& part) {
  for (int kind = 0; kind < options::part_kinds; ++kind) {
    const std::string list = prefix + std::string(options::part_list(static_cast<Part>(kind)));
    if (!o.has(list)) continue;
    const std::vector<std::string> names = o.texts(list);
    if (std::find(names.begin(), names.end(), part) != names.end()) return static_cast<Part>(kind);
  }
  return {};
}

}  // namespace

void add_repeated_parts(Options& o, const std::string& prefix) {
  const std::string list = prefix + "repeat_parts";
  const Repeat repeat(o, prefix);
  std::vector<options::Entry> all;
  for (const std::string& part : repeat.parts()) {
    const std::optional<Part> kind = kind_of(o, prefix, part);
    if (!kind) o.refuse(list, fmt::format("'{}' is in no list of this vehicle (bodies, joints, ...)", part));
    for (const Row& row : options::part_rows(*kind)) o.declare(repeat.option(part, row), row);
    const auto [first, last] = repeat.numbers_of(part, *kind);
    for (int number = first; number < last; ++number)
      for (const Row& row : options::part_rows(*kind)) {
        const std::string name = repeat.option(part, row);
        const options::Entry* given = o.entries().find(name);
        const bool delayed = row.name == delay && o.entries().has(prefix + "repeat_delay");
        if (given == nullptr && !delayed) continue;
        options::Entry entry = given != nullptr ? *given : *o.entries().find(prefix + "repeat_delay");
        entry.name = repeat.option(fmt::format("{}{}", part, number), row);
        entry.value = repeat.value(name, row, number);
        all.push_back(std::move(entry));
      }
  }
  o.add_defaults(all);
}

std::vector<std::string> part_names(const Options& o, const std::string& prefix, Part part) {
  const std::string list = prefix + std::string(options::part_list(part));
  if (!o.has(list)) return {};
  const Repeat repeat(o, prefix);
  std::vector<std::string> names;
  for (const std::string& name : o.texts(list)) {
    if (!repeat.repeats(name)) {
      names.push_back(name);
      continue;
    }
    const auto [first, last] = repeat.numbers_of(name, part);
    for (int number = first; number < last; ++number) names.push_back(fmt::format("{}{}", name, number));
  }
  return names;
}

}  // namespace traverse::scene
