// A digest of all inputs of a scene.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/input_texts.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// A 64-bit hash (16 hex digits) of the scene's options, the files' texts and `more`. Options in `excluded`, and
/// options that only change the display, are not included.
std::string digest_of(const scene::Scene& scene, std::span<const std::string_view> excluded,
                      const std::vector<options::InputText>& files, std::string_view more = {});

}  // namespace traverse::run
