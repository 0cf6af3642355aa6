#include "base/host_name.h"

#include <array>
#include <string_view>

#include <unistd.h>

namespace stormcellar {
namespace {

constexpr std::size_t most_letters = 32;

}  // namespace

std::string host_name() {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return "host";
    std::string letters;
    for (const char c : std::string_view(name.data())) {
        if (c == '.' || letters.size() == most_letters) break;
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (is_plain) letters += c;
    }
    return letters.empty() ? "host" : letters;
}

}  // namespace stormcellar
