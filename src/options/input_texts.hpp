// The texts of the input files of a scene, which are stored with the results, so that the scene can be run again from
// the results file, and the reading of a YAML file that must contain one document. YAML::Load ignores further documents
// without a message, and YAML::LoadAll does not terminate if a document begins with a character that cannot begin one
// ("]", ",").
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

struct InputText {
  std::string name;  // the path at which it was found
  std::string text;
};

/// The data of a kind of file for the messages of its reader.
struct TextKind {
  std::string_view option;  // the option that names the file, such as "limits"; empty for tables
  std::string_view what;    // "a table"
  std::size_t most_characters = 0;
  bool table = false;  // its contents are not entries of options
};

/// The text of a file, from the disk or from a results file, without a byte-order mark; the text is recorded.
/// InputError if the file is not a regular file (a pipe, a device, a folder), cannot be read, is longer than permitted,
/// or contains a NUL, another control character or bytes that are not UTF-8.
std::string read_text(const std::string& path, const TextKind& kind);

/// Checks the characters of a text in memory in the same way. InputError with the line.
void check_characters(std::string_view text, const std::string& name);

/// Records the text of a table that differs from the contents of its file. A second text for a path is ignored.
void record_text(const std::string& path, const std::string& text);

/// All recorded texts in the order of reading.
const std::vector<InputText>& inputs_read();
/// The recorded texts except options files, because the entries of these are stored as options.
std::vector<InputText> tables_read();

/// Tables of a program in place of files, by their names, as long as the object exists: files of these names are not
/// looked for on the disk. What is read meanwhile is not recorded. Only one may exist at a time.
class TablesInMemory {
 public:
  explicit TablesInMemory(const std::map<std::string, std::string>& tables);
  ~TablesInMemory();
  TablesInMemory(const TablesInMemory&) = delete;
  TablesInMemory& operator=(const TablesInMemory&) = delete;
};
/// The path of a table in memory for read_text; empty if there is none of this name.
std::string in_memory(const std::string& name);

/// From now on a path that begins with `prefix` refers to one of these files.
void mount_inputs(const std::string& prefix, std::vector<InputText> files);
/// The prefix with which a path begins; empty if it has none.
const std::string& mounted(const std::string& path);
/// Whether there is a mounted file with this path, which includes the prefix.
bool is_mounted(const std::string& path);
/// The paths of the mounted files in a folder, which includes the prefix.
std::vector<std::string> mounted_in(const std::string& folder);

/// The document of a text, null for an empty text. InputError if something follows it; the message is file, line,
/// `prefix` and the reason. YAML::Exception if the text is not well formed.
YAML::Node one_document(const std::string& text, const std::string& file, const std::string& prefix = "");

}  // namespace traverse::options
