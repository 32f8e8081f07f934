// Compares units without the signs that people set between their parts.
#include "options/table_units.hpp"

#include <algorithm>
#include <vector>

#include "base/text.hpp"

namespace traverse::options {
namespace {

struct UnitRow {
  std::string_view quantity, si, name;
  double factor = 1.0;  // from SI
};
constexpr UnitRow unit_rows[] = {
#include "engineering_units_rows.inc"
};

std::string plain(std::string_view unit) {
  constexpr std::pair<std::string_view, std::string_view> written[] = {
      {" ", ""},       {"*", ""},       {"^", ""},       {"\u00b7", ""},
      {"\u00b2", "2"}, {"\u00b3", "3"}, {"\u00b5", "u"}, {"\u00b0", "deg"}};
  std::string text(unit);
  for (const auto& [sign, with] : written)
    for (std::size_t at = 0; (at = text.find(sign, at)) != std::string::npos;) text.replace(at, sign.size(), with);
  return text;
}

}  // namespace

std::optional<TableUnit> table_unit(std::string_view unit, std::string_view si) {
  const std::string wanted = plain(unit), quantity = plain(si);
  if (!wanted.empty() && wanted == quantity) return TableUnit();
  for (const UnitRow& row : unit_rows)
    if ((quantity.empty() || plain(row.si) == quantity) && plain(row.name) == wanted) return TableUnit{row.factor};
  return {};
}

std::string table_units(std::string_view si) {
  std::vector<std::string_view> names = {si};
  for (const UnitRow& row : unit_rows)
    if (plain(row.si) == plain(si) && std::find(names.begin(), names.end(), row.name) == names.end())
      names.push_back(row.name);
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

UnitName unit_name(std::string_view text) {
  const std::string cell = base::trimmed(text);
  for (const char* brackets : {"[]", "()"}) {
    const std::size_t open = cell.rfind(brackets[0]);
    if (cell.ends_with(brackets[1]) && open != std::string::npos && open > 0)
      return {base::trimmed(cell.substr(0, open)), base::trimmed(cell.substr(open + 1, cell.size() - open - 2))};
  }
  return {cell, ""};
}

}  // namespace traverse::options
