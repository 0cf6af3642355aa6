// render/options/option_text.h -- reads the value of a picture's option from the text of a command
// line or an address.
//
// Threads   Pure, except that they change the given settings.
// Errors    bad_argument; the message begins with the name under which the option was given.
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

// The functions below set a value from a text. They refuse places out of range, unknown names and
// texts that are not numbers, but they accept a single number out of its range, which scene_of()
// refuses later.
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
// A flag is set by an empty text, 1 or true, and cleared by 0 or false.
[[nodiscard]] Status take_text(const FlagValue& value, const std::string& option,
                               const std::string& text, PictureSettings to);

}  // namespace stormcellar::render
