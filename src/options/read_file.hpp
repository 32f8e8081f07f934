// Options files: YAML (names ending in .yml or .yaml) flattened as PETSc does, or PETSc's classic text.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/entry.hpp"

namespace traverse::options {

/// The entries of a file in their order. Nested keys are joined by underscores, lists become comma lists.
/// An option `options_file` inside a file is followed: its entries stand in its place; its path is found as by
/// find_file. Throws InputError naming file and line for a file that cannot be read or is not well formed.
std::vector<Entry> read_options_file(const std::string& path);

/// The same from text in memory; `name` stands for the file in messages.
std::vector<Entry> parse_yaml(const std::string& text, const std::string& name);
std::vector<Entry> parse_classic(const std::string& text, const std::string& name);
/// Those of a file of PETSc's classic text, whatever it is called; files that it names are not followed.
std::vector<Entry> read_classic_file(const std::string& path);

/// The words of a line; "..." and '...' hold blanks together, # starts a comment. where: begins messages.
std::vector<std::string> split_words(const std::string& line, const std::string& where);

/// Words as on a command line: `-name value` or `-name` alone; a word that starts with a dash and a letter is a name,
/// `-5.0` is a value. Throws InputError for a value that belongs to no name.
std::vector<Entry> parse_words(const std::vector<std::string>& words, const std::string& source, int line);

/// The file that the file `named_in` calls `path`: beside `named_in` first, then from the working directory, then
/// in what is installed with the program (share/traverse, which holds options/), or empty. An empty
/// `named_in` stands for the command line, which counts from the working directory.
std::string find_file(const std::string& path, const std::string& named_in);

}  // namespace traverse::options
