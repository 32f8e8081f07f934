// A digest of the sorted options and the texts of all input files, without options that leave the results unchanged.
#include "run/scene_digest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/digest.hpp"

namespace traverse::run {

std::string digest_of(const scene::Scene& scene, std::span<const std::string_view> excluded,
                      const std::vector<options::InputText>& files, std::string_view more) {
  auto entries = scene.options;
  std::erase_if(entries, [&](const auto& option) {
    const std::string& name = option.first;
    const bool display_only = name == "verbose" || name.starts_with("ts_monitor") || name.starts_with("log_") ||
                              name.starts_with("report_") || name.find("_view") != name.npos;
    return display_only || std::find(excluded.begin(), excluded.end(), name) != excluded.end();
  });
  std::sort(entries.begin(), entries.end());
  base::Digest digest;
  const auto add = [&](std::string_view text) {
    digest.add(std::to_string(text.size()) + ":");
    digest.add(text);
  };
  for (const auto& [name, value] : entries) {
    add(name);
    add(value);
  }
  for (const options::InputText& file : files) add(file.text);
  add(more);
  return fmt::format("{:016x}", digest.value());
}

}  // namespace traverse::run
