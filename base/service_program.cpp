#include "base/service_program.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

#include <fmt/format.h>

#include "base/printable.h"
#include "stormcellar/base/version.h"

namespace stormcellar {
namespace {

constexpr int exit_failed = 1;
constexpr int exit_bad_usage = 2;

int answer(const ServiceProgram& program, int argc, char** argv) {
    const Result<ServiceArguments> arguments =
        parse_service_arguments(argc, argv, program.own_flags);
    if (!arguments) {
        complain(program.name, arguments.error());
        fmt::print(stderr, "{}", program.usage);
        return exit_bad_usage;
    }
    if (arguments->help) {
        fmt::print("{}", program.usage);
        return EXIT_SUCCESS;
    }
    if (arguments->version) {
        fmt::print("{} {}\n", program.name, software_version);
        return EXIT_SUCCESS;
    }
    return program.run(*arguments);
}

}  // namespace

int run_service(const ServiceProgram& program, int argc, char** argv) {
    try {
        return answer(program, argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", program.name, printable(error.what()));
        return exit_failed;
    }
}

int complain(std::string_view program, const Error& error) {
    fmt::print(stderr, "{}: {}\n", program, printable(error.message));
    return exit_failed;
}

std::string reloading_state() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return fmt::format("RELOADING=1\nMONOTONIC_USEC={}",
                       std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000);
}

}  // namespace stormcellar
