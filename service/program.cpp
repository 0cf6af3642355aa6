#include "service/program.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <fmt/format.h>
#include <sys/resource.h>

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

int say_checked(std::string_view program, std::string_view service_user,
                const std::filesystem::path& file) {
    fmt::print("{}\n{}: ok\n", checked_as(program, service_user), printable(file.native()));
    return EXIT_SUCCESS;
}

void raise_descriptor_limit(std::uint64_t wanted) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = std::max<rlim_t>(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, wanted));
    (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace stormcellar
