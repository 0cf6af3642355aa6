#include "tests/testing/test_name.h"

#include <algorithm>
#include <cctype>

namespace stormcellar::testing {

std::string test_name(std::string_view file_name) {
    std::string name{file_name};
    const auto is_other = [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); };
    std::replace_if(name.begin(), name.end(), is_other, '_');
    return name;
}

}  // namespace stormcellar::testing
