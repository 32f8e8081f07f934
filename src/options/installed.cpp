// Files that are installed for all users. scripts/install.cmake says where they are, for this file only.
#include "options/installed.hpp"

#include <dlfcn.h>
#include <sys/auxv.h>

#include <filesystem>

namespace traverse::options {

std::string installed_path(const std::string& path) {
  const auto* program = reinterpret_cast<const char*>(getauxval(AT_EXECFN));  // NOLINT: an address, by its definition
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&installed_path), &library) == 0) library.dli_fname = nullptr;
  std::error_code ignored;
  const auto beside = [&](const char* file, const char* folder) {
    return (std::filesystem::canonical(file == nullptr ? "" : file, ignored).parent_path() / folder).lexically_normal();
  };
  for (const std::filesystem::path& folder :
       {beside(program, DATA_FROM_PROGRAM), beside(library.dli_fname, DATA_FROM_LIBRARY), std::filesystem::path(DATA)})
    if (folder.is_absolute() && std::filesystem::exists(folder / path, ignored)) return (folder / path).string();
  return "";
}

}  // namespace traverse::options
