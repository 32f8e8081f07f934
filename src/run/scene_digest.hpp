// A short text that tells scenes apart by what is asked of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/input_texts.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Of the scene's options, but for `free` ones and those that only show things, and of the texts of files; `more`: what
/// else tells.
std::string digest_of(const Scene& scene, std::span<const std::string_view> free,
                      const std::vector<options::InputText>& files, std::string_view more = {});

}  // namespace traverse::app
