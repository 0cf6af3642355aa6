// tests/testing/test_name.h -- names of parameterised tests.
#pragma once

#include <string>
#include <string_view>

namespace stormcellar::testing {

// A file's name as GoogleTest takes names: what is neither letter nor digit becomes '_'.
[[nodiscard]] std::string test_name(std::string_view file_name);

}  // namespace stormcellar::testing
