// Reads options files: YAML (names that end in .yml or .yaml), flattened as in PETSc, or PETSc's classic text.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// The entries of a file in their order. Nested keys are joined by underscores, lists become comma lists.
/// An option `options_file` in a file is replaced by the entries of the file that it names, found as by find_file.
/// Throws InputError with file and line for a file that cannot be read or is not well formed.
std::vector<Entry> read_options_file(const std::string& path);

/// The entries of a text in memory; `name` is the name of the file in messages.
std::vector<Entry> parse_yaml(const std::string& text, const std::string& name);
std::vector<Entry> parse_classic(const std::string& text, const std::string& name);
/// The entries of a file in PETSc's classic text with any name; files that it names are not read.
std::vector<Entry> read_classic_file(const std::string& path);

/// The words of a line; blanks in "..." and '...' do not separate words, # begins a comment. where: prefix of messages.
std::vector<std::string> split_words(const std::string& line, const std::string& where);

/// The entries of words in the form of a command line: `-name value` or `-name` alone. A word that begins with a dash
/// and a letter is a name, `-5.0` is a value. Throws InputError for a value without a name.
std::vector<Entry> parse_words(const std::vector<std::string>& words, const std::string& source, int line);

/// The path of the file that the file `named_in` names `path`. It is searched relative to the folder of `named_in`,
/// then to the working directory, then to the installed files (share/traverse, which has options/); empty if it is not
/// found. An empty `named_in` means the command line, whose paths are relative to the working directory.
std::string find_file(const std::string& path, const std::string& named_in);

}  // namespace traverse::options
