// stormcellar-web: the data server as a service. The text below describes its command line.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/beneath.h"
#include "base/memory.h"
#include "cache/map_guard.h"
#include "service/log.h"
#include "service/program.h"
#include "service/turns.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"
#include "web/config/web_setup.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view program = "stormcellar-web";

constexpr std::string_view usage =
    "usage: stormcellar-web --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

// Connections, open grids and raw files each take a descriptor.
constexpr std::uint64_t wanted_descriptors = 65'536;

void reload(WebService& service, const std::filesystem::path& file) {
    const auto fresh = load_web_setup(file);
    if (!fresh) {
        say(LogLevel::error, "the configuration stays as it was: {}", fresh.error().message);
    } else {
        for (const std::string& sentence : needs_restart(*fresh, service.setup()))
            say(LogLevel::warning, "{}", sentence);
        set_log_level(fresh->log_level);
        const Status taken = service.reload(*fresh);
        if (taken) say(LogLevel::info, "reloaded {}", file.native());
        if (!taken)
            say(LogLevel::error, "the configuration stays as it was: {}", taken.error().message);
    }
}

// Warns if the drop directory cannot be read. Clients would otherwise only learn that a file cannot
// be read now.
void look_at_drop(const std::filesystem::path& drop) {
    if (drop.empty()) return;
    const auto names = names_beneath(drop, drop);
    if (names) return;
    say(LogLevel::warning,
        "cannot read the drop directory {}; clients get no raw files until it can be read "
        "(web-ldm-group.conf; below /home web-ldm-in-home.conf)",
        names.error().message);
}

// Does the work of one turn. If memory or threads have run out, the server goes on unchanged.
void take_turn(WebService& service, const std::filesystem::path& file, bool reloads) {
    try {
        if (reloads) {
            reload(service, file);
        } else {
            service.look_again();
        }
    } catch (const std::exception& error) {
        say(LogLevel::error, "{}: {}",
            reloads ? "the configuration stays as it was" : "a look failed", error.what());
    }
}

int serve(const WebSetup& setup, const std::filesystem::path& file) {
    keep_freed_memory();
    hold_arenas(2 * static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
    cache::install_map_guard();
    raise_descriptor_limit(wanted_descriptors);
    set_log_level(setup.log_level);
    set_added_stations(setup.added_stations);
    const auto signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    auto service = WebService::open(setup);
    if (!service) return complain(program, service.error());
    say(LogLevel::info, "stormcellar-web {}: listening on {}", software_version,
        fmt::join((*service)->addresses(), " "));
    if (!(*service)->has_catalog())
        say(LogLevel::warning, "there is no catalog {} yet", setup.catalog.native());
    look_at_drop(setup.drop);
    SystemdNotifier notifier;
    const bool is_stopped = take_turns({.turn = [&] { take_turn(**service, file, false); },
                                        .is_well = [&] { return (*service)->is_at_work(); },
                                        .reload =
                                            [&] {
                                                take_turn(**service, file, true);
                                                return true;
                                            }},
                                       *signals, notifier);
    service->reset();
    return is_stopped ? EXIT_SUCCESS : EXIT_FAILURE;
}

int run(const ServiceArguments& arguments) {
    Result<WebSetup> setup = load_web_setup(*arguments.config);
    if (!setup) return complain(program, setup.error());
    // systemd sets STATE_DIRECTORY if the unit names a StateDirectory.
    if (const char* state = std::getenv("STATE_DIRECTORY"); state != nullptr && *state == '/')
        setup->numbers = std::filesystem::path(state) / "times";
    if (!arguments.check) return serve(*setup, *arguments.config);
    return say_checked(program, program, *arguments.config);
}

}  // namespace
}  // namespace stormcellar::web

int main(int argc, char** argv) {
    using namespace stormcellar::web;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
