// The files that a scene is read from: their texts are kept, so that its results can tell what they came from, and may
// come out of a results file instead of the disk (rerun.hpp).
#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

namespace traverse::options {

struct InputText {
  std::string name;  // its path, as it was found
  std::string text;
};

/// A file to be read, from the disk or out of a results file; null where it cannot be read.
std::unique_ptr<std::istream> open_input(const std::string& path);
/// Keeps the text of a file that was read; once is enough.
void note_input(const std::string& path, bool table);

/// The same of a table whose text is not the file's own.
void note_text(const std::string& path, const std::string& text);

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
