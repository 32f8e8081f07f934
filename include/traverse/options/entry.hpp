// Options as the user gave them: name, value and the place where each one was written.
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
  std::string source;  // a file, or in words ("command line")
  int line = 0;        // in the file, from 1; 0: the source is no file

  /// Whether it was given in a file, not on the command line.
  bool from_file() const { return line > 0; }
  /// "scene.yml:12" or "command line".
  std::string where() const;
  /// For messages: "name = value (where)", long values cut.
  std::string given() const;
};

/// All options in force: one entry a name, in the order in which the names came up.
class Entries {
 public:
  /// Adds an entry; one of the same name is replaced.
  void set(Entry entry);
  /// Adds an entry unless its name is there already.
  void set_default(Entry entry);
  /// Gives an entry a name that no other entry has.
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
