// tests/cli/run_in_process.h -- runs a subcommand inside the test program and keeps its output.
#pragma once

#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "cli/subcommands.h"
#include "tests/testing/program.h"

namespace stormcellar::cli {

// Runs a subcommand. Blanks separate the arguments; the first is the subcommand.
inline testing::ProgramResult run_in_process(const std::string& arguments) {
    CLI::App app;
    const Subcommand* subcommand =
        find_subcommand(std::string_view(arguments).substr(0, arguments.find(' ')));
    if (subcommand == nullptr) return {};
    const Command command = add_subcommand(app, *subcommand);
    app.parse(arguments);
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    testing::ProgramResult ran;
    ran.status = command.run();
    ran.out = ::testing::internal::GetCapturedStdout();
    ran.err = ::testing::internal::GetCapturedStderr();
    return ran;
}

}  // namespace stormcellar::cli
