// Reads texts from the disk or from a results file, checks that they are UTF-8 without control characters, and records
// a copy of each. Parses a YAML text twice: by document events, to detect a second document, and then as a tree.
#include "options/input_texts.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/regular_file.hpp"
#include "base/text.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

struct Mounted {
  std::string prefix;  // empty if nothing is mounted
  std::vector<InputText> files;
};

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

Mounted mounted_inputs;  // one per process, as PETSc's options
constexpr std::string_view memory_prefix = "table ";
const std::map<std::string, std::string>* tables_in_memory = nullptr;
std::vector<InputText> recorded;
std::vector<char> recorded_tables;  // for each recorded text: 1 for a table

const InputText* find_mounted(const std::string& path) {
  if (mounted(path).empty()) return nullptr;
  const std::string name = path.substr(mounted_inputs.prefix.size());
  const auto found = std::find_if(mounted_inputs.files.begin(), mounted_inputs.files.end(),
                                  [&](const InputText& file) { return file.name == name; });
  return found == mounted_inputs.files.end() ? nullptr : &*found;
}

void record(const std::string& path, const std::string& text, bool table) {
  if (tables_in_memory != nullptr) return;
  const std::string name = path.substr(mounted(path).size());
  if (std::any_of(recorded.begin(), recorded.end(), [&](const InputText& file) { return file.name == name; })) return;
  recorded.push_back({name, text});
  recorded_tables.push_back(table ? 1 : 0);
}

std::string text_on_disk(const std::string& path, const TextKind& kind) {
  std::string text, why = base::read_regular_file(path, kind.most_characters, text);
  if (why.empty()) return text;
  if (why == base::too_long)
    why = fmt::format("longer than {} characters, so this is not {}", kind.most_characters, kind.what);
  throw InputError(fmt::format("{}{}{}: {}", kind.option, kind.option.empty() ? "" : " = ", path, why));
}

/// Records the line in which a document begins.
class DocumentStart : public YAML::EventHandler {
 public:
  int line() const { return line_; }

  void OnDocumentStart(const YAML::Mark& mark) override { line_ = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int line_ = 0;
};

}  // namespace

void check_characters(std::string_view text, const std::string& name) {
  if (text.starts_with("\x89HDF"))
    throw InputError(fmt::format(
        "{}: is an HDF5 file, not a text; if it is a results file, traverse {} repeats its run", name, name));
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = base::length_of_character(text, i);
    if (length == 0)
      throw InputError(
          fmt::format("{}:{}: byte 0x{:02x} is not valid UTF-8; save the file as UTF-8", name, line, byte));
    const bool blank = byte == '\n' || byte == '\t' || byte == '\r';
    if ((byte < 0x20 && !blank) || byte == 0x7f)
      throw InputError(fmt::format("{}:{}: contains the control character 0x{:02x}{}, so this is not a text", name,
                                   line, byte, byte == 0 ? " (NUL)" : ""));
    if (byte == '\n') ++line;
    i += length;
  }
}

std::string read_text(const std::string& path, const TextKind& kind) {
  const InputText* stored = find_mounted(path);
  std::string text = path.starts_with(memory_prefix) && tables_in_memory != nullptr
                         ? tables_in_memory->at(path.substr(memory_prefix.size()))
                     : stored != nullptr ? stored->text
                                         : text_on_disk(path, kind);
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  check_characters(text, path);
  record(path, text, kind.table);
  return text;
}

TablesInMemory::TablesInMemory(const std::map<std::string, std::string>& tables) { tables_in_memory = &tables; }
TablesInMemory::~TablesInMemory() { tables_in_memory = nullptr; }

std::string in_memory(const std::string& name) {
  const bool known = tables_in_memory != nullptr && tables_in_memory->contains(name);
  return known ? std::string(memory_prefix) + name : "";
}

void record_text(const std::string& path, const std::string& text) { record(path, text, true); }

const std::vector<InputText>& inputs_read() { return recorded; }

std::vector<InputText> tables_read() {
  std::vector<InputText> tables;
  for (std::size_t i = 0; i < recorded.size(); ++i)
    if (recorded_tables[i] != 0) tables.push_back(recorded[i]);
  return tables;
}

void mount_inputs(const std::string& prefix, std::vector<InputText> files) {
  mounted_inputs = {prefix, std::move(files)};
}

const std::string& mounted(const std::string& path) {
  static const std::string none;
  return !mounted_inputs.prefix.empty() && path.starts_with(mounted_inputs.prefix) ? mounted_inputs.prefix : none;
}

bool is_mounted(const std::string& path) { return find_mounted(path) != nullptr; }

std::vector<std::string> mounted_in(const std::string& folder) {
  std::vector<std::string> paths;
  const std::string& prefix = mounted(folder);
  if (prefix.empty()) return paths;
  for (const InputText& file : mounted_inputs.files)
    if (std::filesystem::path(file.name).parent_path() == std::filesystem::path(folder.substr(prefix.size())))
      paths.push_back(prefix + file.name);
  return paths;
}

YAML::Node one_document(const std::string& text, const std::string& file, const std::string& prefix) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStart start;
  if (parser.HandleNextDocument(start) && parser.HandleNextDocument(start))
    throw InputError(
        fmt::format("{}:{}: {}contains more than one YAML document (a line ---), or text that belongs to none", file,
                    start.line(), prefix));
  return YAML::Load(text);
}

}  // namespace traverse::options
