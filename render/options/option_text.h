// render/options/option_text.h -- reads the value of a picture's option from a text: from a command
// line or from an address.
//
// Threads   Pure, except that they change the settings that they are given.
// Errors    bad_argument. The message begins with the name by which the option was given.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/options/picture_options.h"
#include "stormcellar/base/result.h"

namespace stormcellar::render {

// Parses this many numbers separated by commas, as in "35.3,-97.3".
[[nodiscard]] Result<std::vector<double>> numbers_of(const std::string& option,
                                                     const std::string& text, std::size_t count);

// These functions set a value from a text. They refuse places out of range, unknown names, and
// texts that are not numbers. They accept a single number that is out of range; scene_of() refuses
// it later.
[[nodiscard]] Status take_text(const NumbersValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);
[[nodiscard]] Status take_text(const TextValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);
[[nodiscard]] Status take_text(const NamesValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);
[[nodiscard]] Status take_text(const NumberValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);
[[nodiscard]] Status take_text(const WholeValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);
// Sets a flag from an empty text, 1 or true. Clears it from 0 or false.
[[nodiscard]] Status take_text(const FlagValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);

}  // namespace stormcellar::render
