// An ordered list of options with an index by name; a later entry of the same name replaces the earlier one.
#include "traverse/options/entry.hpp"

namespace traverse::options {

std::string Entry::where() const { return line > 0 ? source + ":" + std::to_string(line) : source; }

std::string Entry::given() const {
  constexpr std::size_t longest = 80;
  std::string text = name;
  if (!value.empty()) text += " = " + value.substr(0, longest) + (value.size() > longest ? "..." : "");
  return text + " (" + where() + ")";
}

void Entries::set(Entry entry) {
  const auto [place, is_new] = index_.try_emplace(entry.name, entries_.size());
  if (is_new) {
    entries_.push_back(std::move(entry));
  } else {
    entries_[place->second] = std::move(entry);
  }
}

void Entries::set_default(Entry entry) {
  if (!has(entry.name)) set(std::move(entry));
}

void Entries::rename(const std::string& from, const std::string& to) {
  auto place = index_.extract(from);
  entries_[place.mapped()].name = place.key() = to;
  index_.insert(std::move(place));
}

const Entry* Entries::find(std::string_view name) const {
  const auto place = index_.find(std::string(name));
  return place == index_.end() ? nullptr : &entries_[place->second];
}

}  // namespace traverse::options
