// stormcellar-web: the data server as a service. Its usage is the text below.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <systemd/sd-daemon.h>

#include "base/beneath.h"
#include "base/memory.h"
#include "base/printable.h"
#include "base/service_log.h"
#include "base/service_program.h"
#include "base/steady_time.h"
#include "base/waited_signals.h"
#include "cache/map_guard.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"
#include "web/config/web_setup.h"
#include "web/service/watchdog.h"
#include "web/service/web_service.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view program = "stormcellar-web";
// Period in which the program looks for a catalog and feeds the watchdog when it is due.
constexpr std::chrono::milliseconds turn{1000};

constexpr std::string_view usage =
    "usage: stormcellar-web --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

// Each connection, open grid and raw file takes a descriptor, and 1,024 is the usual soft limit for
// the sake of old programs.
void raise_descriptor_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = std::max<rlim_t>(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, 65'536));
    (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

// Tells systemd. Without it, nothing happens.
void notify(const std::string& state) {
    (void)::sd_notify(0, state.c_str());
}

Watchdog systemd_watchdog() {
    std::uint64_t microseconds = 0;
    std::optional<std::chrono::microseconds> period;
    if (::sd_watchdog_enabled(0, &microseconds) > 0)
        period = std::chrono::microseconds{microseconds};
    return Watchdog(period, [] { notify("WATCHDOG=1"); });
}

void reload(WebService& service, const std::filesystem::path& file) {
    notify(reloading_state());
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
    notify("READY=1");
}

// Without the right to read it, clients are told only that a file cannot be read now.
void look_at_drop(const std::filesystem::path& drop) {
    if (drop.empty()) return;
    const auto names = names_beneath(drop, drop);
    if (names) return;
    say(LogLevel::warning,
        "cannot read the drop directory {}; clients get no raw files until it can be read "
        "(web-ldm-group.conf; below /home web-ldm-in-home.conf)",
        names.error().message);
}

// For want of memory or threads a turn may fail; the server goes on as it is.
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
        if (reloads) notify("READY=1");
    }
}

int serve(const WebSetup& setup, const std::filesystem::path& file) {
    keep_freed_memory();
    hold_arenas(2 * static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
    cache::install_map_guard();
    raise_descriptor_limit();
    set_log_level(setup.log_level);
    set_added_stations(setup.added_stations);
    const WaitedSignals signals;
    auto service = WebService::open(setup);
    if (!service) return complain(program, service.error());
    say(LogLevel::info, "stormcellar-web {}: listening on {}", software_version,
        fmt::join((*service)->addresses(), " "));
    if (!(*service)->has_catalog())
        say(LogLevel::warning, "there is no catalog {} yet", setup.catalog.native());
    look_at_drop(setup.drop);
    notify("READY=1");
    Watchdog watchdog = systemd_watchdog();
    for (;;) {
        watchdog.feed(**service, steady_now());
        const auto number = signals.next(turn);
        if (!number || *number == SIGHUP) {
            take_turn(**service, file, number.has_value());
        } else {
            say(LogLevel::info, "stopping: received {}", *number == SIGTERM ? "SIGTERM" : "SIGINT");
            break;
        }
    }
    notify("STOPPING=1");
    service->reset();
    return EXIT_SUCCESS;
}

int run(const ServiceArguments& arguments) {
    Result<WebSetup> setup = load_web_setup(*arguments.config);
    if (!setup) return complain(program, setup.error());
    // The unit's StateDirectory.
    if (const char* state = std::getenv("STATE_DIRECTORY"); state != nullptr && *state == '/')
        setup->numbers = std::filesystem::path(state) / "times";
    if (!arguments.check) return serve(*setup, *arguments.config);
    fmt::print("{}\n{}: ok\n", checked_as(program, program), printable(arguments.config->native()));
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace stormcellar::web

int main(int argc, char** argv) {
    using namespace stormcellar::web;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
