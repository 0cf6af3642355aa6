// tests/testing/text_bytes.h -- converts a text to bytes.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace stormcellar::testing {

inline std::span<const std::byte> text_bytes(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace stormcellar::testing
