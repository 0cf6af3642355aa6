#include "cli/picture.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "cli/commands.h"

namespace stormcellar::cli {

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

int report_no_grid(const cache::Store& store, const std::string& domain, const std::string& when) {
    const auto domains = store.domains();
    const std::string known = !domains || domains->empty()
                                  ? std::string{"the cache is empty"}
                                  : fmt::format("domains are {}", fmt::join(*domains, ", "));
    fmt::print(stderr, "stormcellar: {}\n",
               printable(fmt::format("{}: no grid of domain '{}'{}; {}", store.directory().native(),
                                     domain, when, known)));
    return exit_nothing_matched;
}

std::string ascii(std::string_view text) {
    std::string safe = printable(text);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7E; }, '?');
    return safe;
}

}  // namespace stormcellar::cli
