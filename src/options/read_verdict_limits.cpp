// Parses a YAML list of limits entry by entry. A value may be a fraction such as 1/600, and the message for an unknown
// quantity names the most similar one.
#include "options/read_verdict_limits.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "options/input_texts.hpp"
#include "options/parse_number.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t longest_file = 1 << 20;  // characters
constexpr std::size_t most_limits = 1000;

/// Reads the entries of one file.
class LimitReader {
 public:
  explicit LimitReader(const std::string& file) : file_(file) {}

  VerdictLimit read(const YAML::Node& entry) const {
    if (!entry.IsMap())
      refuse(entry, "expected an entry {clause: ..., quantity: ..., value: ..., factor: ..., text: ...}");
    VerdictLimit limit;
    std::vector<std::string> seen;
    for (const auto& item : entry) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) refuse(item.first, key + " is given twice");
      seen.push_back(key);
      if (!item.second.IsScalar() || item.second.Scalar().empty()) refuse(item.first, key + ": expected one value");
      const std::string& value = item.second.Scalar();
      if (key == "clause") {
        limit.clause = value;
      } else if (key == "text") {
        limit.text = value;
      } else if (key == "quantity") {
        limit.quantity = quantity(item.second);
      } else if (key == "value") {
        limit.value = number(key, item.second);
      } else if (key == "factor") {
        limit.factor = number(key, item.second);
      } else {
        refuse(item.first,
               fmt::format("'{}' is not a key of a limit; allowed: clause, quantity, value, factor, text", key));
      }
    }
    for (const char* key : {"clause", "quantity", "value"})
      if (std::find(seen.begin(), seen.end(), key) == seen.end()) refuse(entry, fmt::format("{} is missing", key));
    return limit;
  }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& why) const {
    throw InputError(fmt::format("{}:{}: limits: {}", file_, node.Mark().line + 1, why));
  }

 private:
  std::string quantity(const YAML::Node& node) const {
    const std::string& name = node.Scalar();
    if (limit_quantity(name) != nullptr) return name;
    std::vector<std::string> names;
    std::string all;
    for (const LimitQuantity& row : limit_quantities) {
      names.emplace_back(row.name);
      all += (all.empty() ? "" : ", ") + names.back();
    }
    const std::string near = nearest(name, names);
    refuse(node, near.empty() ? fmt::format("there is no quantity '{}'; allowed: {}", name, all)
                              : fmt::format("there is no quantity '{}'; did you mean {}?", name, near));
  }

  /// A number above zero, or a fraction of two such numbers: 1/600.
  double number(const std::string& key, const YAML::Node& node) const {
    const std::string& word = node.Scalar();
    const std::size_t bar = word.find('/');
    double numerator = 0.0, denominator = 1.0;
    const bool fits = parse_number(word.substr(0, bar), numerator) &&
                      (bar == std::string::npos || parse_number(word.substr(bar + 1), denominator));
    if (!fits || !(numerator > 0.0 && denominator > 0.0) || !is_quantity(numerator / denominator))
      refuse(node, fmt::format("{} '{}'; allowed: a number above 0, or a fraction such as 1/600", key, word));
    return numerator / denominator;
  }

  const std::string& file_;
};

}  // namespace

std::vector<VerdictLimit> parse_verdict_limits(const std::string& text, const std::string& name) {
  std::vector<VerdictLimit> limits;
  const LimitReader reader(name);
  try {
    const YAML::Node list = one_document(text, name, "limits: ");
    if (!list.IsSequence() || list.size() == 0)
      reader.refuse(list,
                    "expected a list of entries {clause: ..., quantity: ..., value: ..., factor: ..., text: ...}");
    if (list.size() > most_limits)
      reader.refuse(list, fmt::format("{} entries; allowed: at most {}", list.size(), most_limits));
    for (const auto& entry : list) limits.push_back(reader.read(entry));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: limits: not well-formed YAML: {}", name, error.mark.line + 1, error.msg));
  }
  return limits;
}

std::vector<VerdictLimit> read_verdict_limits(const std::string& path) {
  return parse_verdict_limits(read_text(path, {"limits", "a list of limits", longest_file, true}), path);
}

}  // namespace traverse::options
