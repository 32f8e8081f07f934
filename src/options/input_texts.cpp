#include "options/input_texts.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace traverse::options {
namespace {

struct Mounted {
  std::string prefix;  // empty: nothing is
  std::vector<InputText> files;
};

Mounted mounted_inputs;  // one for the process, as PETSc's options are
std::vector<InputText> noted;
std::vector<char> noted_tables;

const InputText* find_mounted(const std::string& path) {
  if (mounted(path).empty()) return nullptr;
  const std::string name = path.substr(mounted_inputs.prefix.size());
  const auto found = std::find_if(mounted_inputs.files.begin(), mounted_inputs.files.end(),
                                  [&](const InputText& file) { return file.name == name; });
  return found == mounted_inputs.files.end() ? nullptr : &*found;
}

}  // namespace

std::unique_ptr<std::istream> open_input(const std::string& path) {
  if (const InputText* file = find_mounted(path)) return std::make_unique<std::istringstream>(file->text);
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*file || std::filesystem::is_directory(path)) return nullptr;
  return file;
}

void note_input(const std::string& path, bool table) {
  const std::string name = path.substr(mounted(path).size());
  if (std::any_of(noted.begin(), noted.end(), [&](const InputText& file) { return file.name == name; })) return;
  const std::unique_ptr<std::istream> file = open_input(path);
  if (file == nullptr) return;
  noted.push_back({name, {std::istreambuf_iterator<char>(*file), {}}});
  noted_tables.push_back(table ? 1 : 0);
}

void note_text(const std::string& path, const std::string& text) {
  if (std::any_of(noted.begin(), noted.end(), [&](const InputText& file) { return file.name == path; })) return;
  noted.push_back({path, text});
  noted_tables.push_back(1);
}

const std::vector<InputText>& inputs_read() { return noted; }

std::vector<InputText> tables_read() {
  std::vector<InputText> tables;
  for (std::size_t i = 0; i < noted.size(); ++i)
    if (noted_tables[i] != 0) tables.push_back(noted[i]);
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

}  // namespace traverse::options
