// The texts of the files that a scene is read from. They are stored with the results, from which the scene can be run
// again.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

struct InputText {
  std::string name;  // its path, as it was found
  std::string text;
};

/// What a reader says of a file that it refuses.
struct TextKind {
  std::string_view option;  // that names it: "limits"; empty: none, as of tables
  std::string_view what;    // "a table"
  std::size_t most_characters = 0;
  bool table = false;  // its entries are not known as options
};

/// The text of a file, from the disk or out of a results file, without a byte-order mark; it is kept as read.
/// InputError where it is no regular file (a pipe, a device, a folder), cannot be read, is longer than allowed, or
/// holds what no text holds: a NUL or another control character, bytes that are no UTF-8.
std::string read_text(const std::string& path, const TextKind& kind);

/// The characters of a text, for those that are in memory already: the same refusals, with the line.
void check_characters(std::string_view text, const std::string& name);

/// Keeps the text of a table that is not its file's own; once is enough.
void record_text(const std::string& path, const std::string& text);

/// All that were noted, in their order.
const std::vector<InputText>& inputs_read();
/// Those among them that are no options files, whose entries are known as options.
std::vector<InputText> tables_read();

/// From now on paths that begin with `prefix` are those of these files.
void mount_inputs(const std::string& prefix, std::vector<InputText> files);
/// The prefix that a path begins with; empty: none.
const std::string& mounted(const std::string& path);
/// Whether there is such a file among those mounted. path: with the prefix.
bool is_mounted(const std::string& path);

}  // namespace traverse::options
