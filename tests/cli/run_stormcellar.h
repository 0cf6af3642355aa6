// tests/cli/run_stormcellar.h -- runs the command line program as a user would.
#pragma once

#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/data.h"
#include "tests/testing/program.h"

namespace stormcellar {
namespace testing {

using Words = std::vector<std::string>;

inline ProgramResult run_stormcellar(const Words& arguments) {
    return run_program(STORMCELLAR_PROGRAM, arguments);
}

// Returns the words of a text, which blanks separate.
inline Words words(const std::string& text) {
    std::istringstream from(text);
    return {std::istream_iterator<std::string>(from), {}};
}

// Returns the words of all lists, in order.
inline Words with(Words first, const Words& second, const Words& third = {}) {
    first.insert(first.end(), second.begin(), second.end());
    first.insert(first.end(), third.begin(), third.end());
    return first;
}

// Expects that the program succeeded. Returns the JSON document that it printed.
inline nlohmann::json json_of(const ProgramResult& ran) {
    EXPECT_EQ(ran.status, 0) << ran.err;
    return nlohmann::json::parse(ran.out, nullptr, false);
}

}  // namespace testing

namespace cli {

using testing::json_of;
using testing::with;
using testing::words;
using testing::Words;

inline std::string volume(const std::string& name) {
    return testing::real_file("volumes") / name;
}

inline testing::ProgramResult run(const Words& arguments) {
    return testing::run_stormcellar(arguments);
}

}  // namespace cli
}  // namespace stormcellar
