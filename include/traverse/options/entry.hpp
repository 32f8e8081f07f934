// Options as the user gives them: the name, the value and the source of each.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace traverse::options {

/// One option. `name` has no leading dash; lists are comma lists.
struct Entry {
  std::string name;
  std::string value;
  std::string source;  // a file, or a text such as "command line"
  int line = 0;        // in the file, from 1; 0: the source is not a file

  /// Whether the source is a file, not the command line.
  bool from_file() const { return line > 0; }
  /// The source: "scene.yml:12" or "command line".
  std::string where() const;
  /// The text for messages: "name = value (where)", with long values truncated.
  std::string given() const;
};

/// All options in force: one entry per name, in the order of their first appearance.
class Entries {
 public:
  /// Adds an entry, or replaces the entry of the same name.
  void set(Entry entry);
  /// Adds an entry unless there is one of the same name.
  void set_default(Entry entry);
  /// Renames an entry. No other entry may have the new name.
  void rename(const std::string& from, const std::string& to);
  const Entry* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
  std::size_t size() const { return entries_.size(); }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

 private:
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> index_;
};

}  // namespace traverse::options
