#include "service/arguments.h"

#include <algorithm>

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include "base/printable.h"

namespace stormcellar {

Result<ServiceArguments> parse_service_arguments(int argc, char** argv,
                                                 const std::vector<std::string_view>& own_flags) {
    ServiceArguments arguments;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--config" && i + 1 < argc) {
            arguments.config = argv[++i];
        } else if (word.starts_with("--config=")) {
            arguments.config = word.substr(9);
        } else if (word == "--check-config") {
            arguments.check = true;
        } else if (word == "--version") {
            arguments.version = true;
        } else if (word == "--help" || word == "-h") {
            arguments.help = true;
        } else if (std::ranges::find(own_flags, word) != own_flags.end()) {
            if (!arguments.flag.empty() && arguments.flag != word) {
                return fail(ErrorCode::bad_argument, "{} and {} cannot be given together",
                            arguments.flag, word);
            }
            arguments.flag = word;
        } else if (word == "--config") {
            return fail(ErrorCode::bad_argument, "--config: give a file");
        } else {
            return fail(ErrorCode::bad_argument, "{}: is not an option", word);
        }
    }
    if (!arguments.help && !arguments.version && !arguments.config)
        return fail(ErrorCode::bad_argument, "--config FILE must be given");
    return arguments;
}

std::string checked_as(std::string_view program, std::string_view service_user) {
    if (::geteuid() == 0) {
        return fmt::format(
            "checked as the user root, who may read everything; as the service: sudo -u {} {} ...",
            service_user, program);
    }
    const passwd* const user = ::getpwuid(::geteuid());
    return fmt::format("checked as the user {}",
                       user == nullptr ? fmt::format("{}", ::geteuid()) : printable(user->pw_name));
}

}  // namespace stormcellar
