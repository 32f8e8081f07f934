// Flattens YAML blocks and merge keys to option names, parses PETSc's classic lines, includes nested options files, and
// finds files by their path.
#include "options/read_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <sstream>

#include "base/text.hpp"
#include "options/input_texts.hpp"
#include "options/installed.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

constexpr std::size_t deepest_include = 64, most_includes = 1000;
constexpr int deepest_block = 64;
constexpr std::size_t most_characters = 16 << 20;  // limit for a file, and for its text with all anchors expanded

std::string at(const std::string& file, int line) { return fmt::format("{}:{}: ", file, line); }

/// Traverses a YAML tree and adds an entry for each leaf. An entry of a merge key (<<) is used unless the block itself
/// has an entry of the same name.
class Flattener {
 public:
  Flattener(const std::string& file, std::vector<Entry>& entries) : file_(file), entries_(entries) {}

  void map(const YAML::Node& node, const std::string& prefix, bool merged = false) {
    const Nested nested(*this, node);
    const bool table = !prefix.empty() && is_table(node);
    std::unordered_map<std::string, int> lines;
    std::vector<YAML::Node> merges;
    for (const auto& item : node) {
      const int line = line_of(item.first);
      if (!item.first.IsScalar()) throw InputError(at(file_, line) + "a key must be a word");
      const std::string& key = item.first.Scalar();
      count(prefix.size() + key.size() + 1, line);
      if (key == "<<") {  // YAML's merge key; an anchor's block may be kept under a key that starts with $$
        merges.push_back(item.second);
        continue;
      }
      if (key.starts_with("$$")) continue;
      check_key(key, line);
      const auto [first, is_new] = lines.try_emplace(key, line);
      if (!is_new) refuse_second(prefix + key, line, first->second);
      if (item.second.IsNull() && std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isdigit(c); }))
        throw InputError(at(file_, line) + "'" + key +
                         "' is in the place of a name: in braces a comma ends a value; use a decimal point, and "
                         "brackets for a list");
      value(item.second, table && key == "name" ? prefix.substr(0, prefix.size() - 1) : prefix + key, line, merged);
    }
    for (const YAML::Node& merge : merges) add_merged(merge, prefix);
  }

 private:
  /// Counts the depth of nested blocks. A block that contains an alias of its own anchor would be nested without end.
  class Nested {
   public:
    Nested(Flattener& flattener, const YAML::Node& node) : depth_(flattener.depth_) {
      if (++depth_ > deepest_block)
        throw InputError(
            fmt::format("{}blocks are nested more than {} deep, or a block contains itself by an alias (*)",
                        at(flattener.file_, line_of(node)), deepest_block));
    }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;
    ~Nested() { --depth_; }

   private:
    int& depth_;
  };

  static int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

  /// Whether a block is a file with options beside it, {name: track.csv, unit: mm}.
  static bool is_table(const YAML::Node& node) {
    const auto belongs = [](const auto& item) {
      return item.first.IsScalar() &&
             (item.first.Scalar() == "name" || find_row(table_rows(), item.first.Scalar()) != nullptr);
    };
    return node.size() > 1 && node["name"] && std::all_of(node.begin(), node.end(), belongs);
  }

  void check_key(const std::string& key, int line) const {
    for (const char c : key) {
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') {
        throw InputError(at(file_, line) + "'" + key +
                         "' is not the name of an option; allowed: letters, digits and _");
      }
    }
    if (key.empty()) throw InputError(at(file_, line) + "a key is empty");
  }

  void add_merged(const YAML::Node& node, const std::string& prefix) {
    if (node.IsMap()) return map(node, prefix, true);
    const Nested nested(*this, node);
    count(node.size(), line_of(node));
    if (!node.IsSequence()) throw InputError(at(file_, line_of(node)) + "<< needs a block or a list of blocks");
    for (const auto& item : node) add_merged(item, prefix);
  }

  /// Whether a block has the names of blocks: `tracks: {left: {...}, right: {...}}`, which is `tracks: [left, right]`
  /// with these two blocks beside it.
  static bool names_blocks(const YAML::Node& node, const std::string& name) {
    return (name == "trains" || name == "loads" || name == "tracks") && node.size() > 0 &&
           std::all_of(node.begin(), node.end(), [](const auto& item) { return item.second.IsMap(); });
  }

  void value(const YAML::Node& node, const std::string& name, int line, bool merged) {
    if (node.IsMap() && names_blocks(node, name)) {
      std::vector<std::string> names;
      for (const auto& item : node) names.push_back(item.first.Scalar());
      add(name, fmt::format("{}", fmt::join(names, ",")), line, merged);
      map(node, "", merged);
    } else if (node.IsMap()) {
      map(node, name + "_", merged);
    } else if (node.IsSequence()) {
      add(name, list(node, name), line, merged);
    } else {
      if (node.IsScalar()) count(node.Scalar().size(), line);
      add(name, node.IsNull() ? "" : node.Scalar(), line, merged);
    }
  }

  /// Limits the characters, because nested anchors can expand to more text than the memory can store.
  void count(std::size_t characters, int line) {
    characters_ += characters;
    if (characters_ > most_characters)
      throw InputError(
          fmt::format("{}the anchors expand to more than {} characters", at(file_, line), most_characters));
  }

  /// Adds an entry. A file may give an option once; `beam: {mass: 1}` and `beam_mass: 2` are the same option.
  void add(const std::string& name, std::string text, int line, bool merged) {
    const auto [first, is_new] = given_.try_emplace(name, line);
    if (!is_new && merged) return;
    if (!is_new) refuse_second(name, line, first->second);
    entries_.push_back({name, std::move(text), file_, line});
  }

  [[noreturn]] void refuse_second(const std::string& name, int line, int first) const {
    throw InputError(
        fmt::format("{}{} is given twice, first in line {}; remove one of the two", at(file_, line), name, first));
  }

  std::string list(const YAML::Node& node, const std::string& name) {
    if (node.size() == 0) return "[]";  // an empty list is permitted, a key without a value is not
    std::string joined;
    for (const auto& item : node) {
      if (!item.IsScalar()) {
        throw InputError(at(file_, line_of(item)) + name +
                         ": a list may contain numbers or words, not lists or blocks");
      }
      if (!joined.empty()) joined += ',';
      count(item.Scalar().size() + 1, line_of(item));
      joined += item.Scalar();
    }
    return joined;
  }

  const std::string& file_;
  std::vector<Entry>& entries_;
  std::unordered_map<std::string, int> given_;  // the line of each option
  std::size_t characters_ = 0;
  int depth_ = 0;
};

/// Whether a word begins as the name of an option: one or two dashes, then a letter or _.
bool is_name(const std::string& word) {
  std::size_t dashes = 0;
  while (dashes < word.size() && word[dashes] == '-') ++dashes;
  return dashes >= 1 && dashes <= 2 && dashes < word.size() &&
         (std::isalpha(static_cast<unsigned char>(word[dashes])) != 0 || word[dashes] == '_');
}

void check_name(const std::string& word, const std::string& source, int line) {
  const auto belongs = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (std::all_of(word.begin(), word.end(), belongs)) return;
  throw InputError(
      (line > 0 ? at(source, line) : source + ": ") + "'" + word +
      "' is not the name of an option; allowed: letters, digits and _, and a blank before the value (-name value); "
      "for a file whose name begins with a dash write ./" +
      word);
}

bool is_yaml(const std::string& path) { return path.ends_with(".yml") || path.ends_with(".yaml"); }

/// The files that an option `options_file` of a file names; none for [].
std::vector<std::string> names_in(const Entry& entry) {
  std::vector<std::string> names;
  if (entry.value == "[]") return names;
  std::istringstream list(entry.value);
  for (std::string name; std::getline(list, name, ',');) {
    if (std::string plain = base::trimmed(name); !plain.empty()) names.push_back(std::move(plain));
  }
  if (names.empty())
    throw InputError("options_file (" + entry.where() + "): has no value; allowed: the name of a file, or [] for none");
  return names;
}

bool is_same(const std::string& file, const std::string& other) {
  std::error_code ignored;
  return file == other || std::filesystem::equivalent(file, other, ignored);
}

/// The entries of a file and of the files that it names. above: the chain of files that leads to this one. read: the
/// number of files read.
std::vector<Entry> read_nested(const std::string& path, std::vector<std::string> above, std::size_t& read) {
  const std::string text = read_text(path, {"options_file", "an options file", most_characters, false});
  above.push_back(path);
  std::vector<Entry> all;
  for (Entry& entry : is_yaml(path) ? parse_yaml(text, path) : parse_classic(text, path)) {
    if (entry.name != "options_file") {
      all.push_back(std::move(entry));
      continue;
    }
    for (const std::string& name : names_in(entry)) {
      const std::string found = find_file(name, path), option = "options_file = " + name + " (" + entry.where() + "): ";
      if (found.empty()) {
        throw InputError(option + "there is no such file beside the file that names it or in the working directory");
      }
      if (std::any_of(above.begin(), above.end(), [&](const std::string& file) { return is_same(file, found); }))
        throw InputError(option + "the files name each other in a circle");
      if (above.size() > deepest_include)
        throw InputError(fmt::format("{}the files are nested more than {} deep", option, deepest_include));
      if (++read > most_includes) throw InputError(fmt::format("{}more than {} files in all", option, most_includes));
      for (Entry& inner : read_nested(found, above, read)) all.push_back(std::move(inner));
    }
  }
  return all;
}

/// Whether a tab is before the first word of a line, counted from 0, or of the line before it.
bool indented_by_tab(const std::string& text, int line) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string words; std::getline(lines, words); ++number) {
    const std::string blanks = words.substr(0, words.find_first_not_of(" \t"));
    if ((number == line || number == line - 1) && blanks.find('\t') != std::string::npos) return true;
  }
  return false;
}

}  // namespace

std::vector<Entry> parse_yaml(const std::string& text, const std::string& name) {
  std::vector<Entry> entries;
  try {
    const YAML::Node document = one_document(text, name);
    if (document.IsNull()) return entries;
    if (!document.IsMap()) throw InputError(at(name, 1) + "expected `key: value`");
    Flattener(name, entries).map(document, "");
  } catch (const YAML::Exception& error) {
    throw InputError(at(name, error.mark.line + 1) + "not well-formed YAML: " + error.msg +
                     (indented_by_tab(text, error.mark.line) ? " (a tab; YAML permits only blanks)" : ""));
  }
  return entries;
}

std::vector<std::string> split_words(const std::string& line, const std::string& where) {
  std::vector<std::string> words;
  std::size_t i = 0;
  while (i < line.size()) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
    } else if (c == '#') {
      break;
    } else if (c == '"' || c == '\'') {
      const std::size_t end = line.find(c, i + 1);
      if (end == std::string::npos) throw InputError(where + "a quotation mark is not closed");
      words.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      std::size_t end = i;
      while (end < line.size() && std::isspace(static_cast<unsigned char>(line[end])) == 0) ++end;
      words.push_back(line.substr(i, end - i));
      i = end;
    }
  }
  return words;
}

std::vector<Entry> parse_classic(const std::string& text, const std::string& name) {
  std::vector<Entry> entries;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::vector<std::string> words = split_words(line, at(name, number));
    if (words.empty() || words.front().starts_with("!") || words.front().starts_with("%")) continue;
    if (!is_name(words.front())) {
      throw InputError(at(name, number) + "expected `-name value`, found '" + words.front() + "'");
    }
    for (Entry& entry : parse_words(words, name, number)) entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<Entry> parse_words(const std::vector<std::string>& words, const std::string& source, int line) {
  std::vector<Entry> entries;
  bool has_value = true;  // whether the last entry has a value: then a further word has no name
  for (const std::string& word : words) {
    if (is_name(word)) {
      check_name(word, source, line);
      entries.push_back({word.substr(word.find_first_not_of('-')), "", source, line});
      has_value = false;
    } else if (!has_value) {
      entries.back().value = word;
      has_value = true;
    } else {
      throw InputError((line > 0 ? at(source, line) : source + ": ") + "'" + word +
                       "' is not the value of an option; write -name value, and a list without blanks");
    }
  }
  return entries;
}

std::string find_file(const std::string& path, const std::string& named_in) {
  if (std::string table = in_memory(path); !table.empty()) return table;
  if (const std::string& prefix = mounted(named_in); !prefix.empty()) {
    const std::filesystem::path folder = std::filesystem::path(named_in.substr(prefix.size())).parent_path();
    for (const std::filesystem::path& at :
         {(folder / path).lexically_normal(), folder / path, std::filesystem::path(path)})
      if (is_mounted(prefix + at.string()) || !mounted_in(prefix + at.string()).empty()) return prefix + at.string();
  }
  std::error_code ignored;
  if (!named_in.empty() && !std::filesystem::path(path).is_absolute()) {
    const std::filesystem::path beside = std::filesystem::path(named_in).parent_path() / path;
    const std::filesystem::path plain = beside.lexically_normal();  // a different file if a folder is a symbolic link
    if (std::filesystem::equivalent(beside, plain, ignored)) return plain.string();
    if (std::filesystem::exists(beside, ignored)) return beside.string();
  }
  if (std::filesystem::exists(path, ignored)) return path;
  return installed_path(path);
}

std::vector<Entry> read_options_file(const std::string& path) {
  std::size_t read = 0;
  return read_nested(path, {}, read);
}

std::vector<Entry> read_classic_file(const std::string& path) {
  return parse_classic(read_text(path, {"", "a file of PETSc's options", most_characters, false}), path);
}

}  // namespace traverse::options
