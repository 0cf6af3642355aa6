#include "cli/files/echo_report.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "stormcellar/retrieve/echo_kinds.h"

namespace stormcellar::cli {
namespace {

using retrieve::EchoKind;
using retrieve::EchoShares;

std::vector<EchoShares> shares_of_volumes(const level2::Decoded& decoded) {
    std::vector<EchoShares> shares;
    for (const level2::Volume& volume : level2::split_volumes(decoded))
        shares.push_back(retrieve::echo_shares(
            retrieve::echo_kinds(volume, retrieve::weather_probabilities(volume))));
    return shares;
}

// Calls `visit` with each kind of echo.
template <class Visit>
void for_each_kind(Visit visit) {
    for (std::size_t i = static_cast<std::size_t>(EchoKind::weather); i < retrieve::echo_kind_count;
         ++i)
        visit(static_cast<EchoKind>(i));
}

}  // namespace

void print_echo(const level2::Decoded& decoded) {
    const std::vector<EchoShares> volumes = shares_of_volumes(decoded);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const std::string number = volumes.size() > 1 ? fmt::format(" of volume {}", i + 1) : "";
        fmt::print("\n{:<30}{:>9}\n", "echo" + number, "share");
        for_each_kind([&](EchoKind kind) {
            fmt::print("  {:<28}{:>7.2f} %\n", retrieve::echo_kind_name(kind),
                       100 * volumes[i].share(kind));
        });
        fmt::print("  gates with echo{:>22}\n", volumes[i].gates);
    }
}

nlohmann::ordered_json echo_json(const level2::Decoded& decoded) {
    auto list = nlohmann::ordered_json::array();
    for (const EchoShares& shares : shares_of_volumes(decoded)) {
        nlohmann::ordered_json percent;
        for_each_kind([&](EchoKind kind) {
            std::string key(retrieve::echo_kind_name(kind));
            std::ranges::replace(key, ' ', '_');
            percent[key] = 100 * shares.share(kind);
        });
        list.push_back({{"gates", shares.gates}, {"percent", std::move(percent)}});
    }
    return list;
}

}  // namespace stormcellar::cli
