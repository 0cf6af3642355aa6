#include "cli/shared/commands.h"

#include <cstdio>

namespace stormcellar::cli {

int report_error(const Error& error) {
    fmt::print(stderr, "stormcellar: {}\n", printable(error.message));
    return error.code == ErrorCode::bad_argument ? exit_bad_usage : exit_failed;
}

void print_note(const std::string& text) {
    fmt::print(stderr, "stormcellar: note: {}\n", printable(text));
}

std::string plural(std::uint64_t count, std::string_view thing) {
    return fmt::format("{}{}", thing, count == 1 ? "" : "s");
}

}  // namespace stormcellar::cli
