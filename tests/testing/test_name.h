// tests/testing/test_name.h -- names of parametrized tests.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::testing {

// Returns a file's name as GoogleTest allows names: anything but letters and digits becomes '_'.
[[nodiscard]] std::string test_name(std::string_view file_name);

}  // namespace stormcellar::testing
