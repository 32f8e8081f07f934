// A digest of all inputs of a scene.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/input_texts.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The digest of the scene's options, except for those in `free` and those of display, and of the texts of files;
/// `more`: a further text.
std::string digest_of(const Scene& scene, std::span<const std::string_view> free,
                      const std::vector<options::InputText>& files, std::string_view more = {});

}  // namespace traverse::app
