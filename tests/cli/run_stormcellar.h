// tests/cli/run_stormcellar.h -- runs the command line program as a user would.
#pragma once

#include <string>
#include <vector>

#include "tests/testing/program.h"

namespace stormcellar::cli {

inline testing::ProgramResult run(const std::vector<std::string>& arguments) {
    return testing::run_program(STORMCELLAR_PROGRAM, arguments);
}

}  // namespace stormcellar::cli
