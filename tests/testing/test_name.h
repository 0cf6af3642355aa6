// tests/testing/test_name.h -- names of parametrized tests.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::testing {

// Returns a file's name with '_' for everything but letters and digits, as GoogleTest requires.
[[nodiscard]] std::string test_name(std::string_view file_name);

}  // namespace stormcellar::testing
