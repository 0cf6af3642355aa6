#include "cli/shared/paint.h"

#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

namespace stormcellar::cli {
namespace {

std::string painted(std::string_view text, std::string_view style, Paint paint) {
    if (paint == Paint::plain || text.empty()) return std::string(text);
    return fmt::format("\x1B[{}m{}\x1B[0m", style, text);
}

}  // namespace

Paint paint_for(int descriptor) {
    const char* const no_color = std::getenv("NO_COLOR");
    const char* const terminal = std::getenv("TERM");
    const bool is_refused = no_color != nullptr && *no_color != '\0';
    const bool is_able = terminal != nullptr && *terminal != '\0' &&
                         std::string_view{terminal} != "dumb" && ::isatty(descriptor) == 1;
    return is_able && !is_refused ? Paint::colors : Paint::plain;
}

std::string in_red(std::string_view text, Paint paint) {
    return painted(text, "1;31", paint);
}

std::string in_yellow(std::string_view text, Paint paint) {
    return painted(text, "33", paint);
}

}  // namespace stormcellar::cli
