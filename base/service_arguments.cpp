#include "base/service_arguments.h"

#include <algorithm>

namespace stormcellar {

Result<ServiceArguments> parse_service_arguments(
    int argc, char** argv, std::initializer_list<std::string_view> own_flags) {
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
            arguments.flags.insert(word);
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

}  // namespace stormcellar
