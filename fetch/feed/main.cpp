// stormcellar-feed: follows the public chunk bucket for some stations. The text below describes its
// command line.
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <signal.h>

#include "base/counted.h"
#include "base/printable.h"
#include "fetch/feed/feed_service.h"
#include "service/log.h"
#include "service/program.h"
#include "service/turns.h"
#include "stormcellar/base/version.h"

namespace stormcellar::feed {
namespace {

constexpr std::string_view program = "stormcellar-feed";
// Time between checks for signals, and time between reports: a report writes the status and feeds
// the watchdog.
constexpr std::chrono::milliseconds between_looks{100}, between_reports{2000};

constexpr std::string_view usage =
    "usage: stormcellar-feed --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

constexpr std::string_view no_station =
    "[feed] stations names no station, so there is nothing to follow, and the service will not "
    "start";

Result<FeedConfig> load_with_stations(const std::filesystem::path& file) {
    auto config = load_feed_config(file);
    if (config && config->stations.empty()) {
        return fail(ErrorCode::bad_argument, "{}: {}", file.native(), no_station);
    }
    return config;
}

// Runs until a signal comes. Returns the number of the signal.
int run_until_signal(FeedService& service, const Signals& signals, Notifier& notifier) {
    std::atomic<bool> stop{false};
    int number = 0;
    SteadyTime next_look{}, next_report{};
    FirstFailure written;
    service.run(stop, [&] {
        const SteadyTime now = steady_now();
        if (now < next_look) return;
        next_look = now + between_looks;
        number = signals.next().value_or(0);
        stop = number != 0;
        if (now < next_report && !stop) return;
        next_report = now + between_reports;
        written.note(service.publish());
        notifier.send("WATCHDOG=1");
    });
    return number;
}

// Returns a service with the new configuration. Returns none if that fails; the old service then
// goes on.
std::unique_ptr<FeedService> reloaded(const std::filesystem::path& file) {
    const auto fresh = load_with_stations(file);
    auto opened = fresh.and_then(
        [](const FeedConfig& config) { return FeedService::open(real_file_system(), config); });
    if (!opened) {
        say(LogLevel::error, "the configuration stays as it was: {}", opened.error().message);
        return nullptr;
    }
    set_log_level(fresh->log_level);
    say(LogLevel::info, "reloaded {}", file.native());
    return std::move(*opened);
}

int feed(const FeedConfig& config, const std::filesystem::path& file) {
    set_log_level(config.log_level);
    const auto signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    auto opened = FeedService::open(real_file_system(), config);
    if (!opened) return complain(program, opened.error());
    std::unique_ptr<FeedService> service = std::move(*opened);
    say(LogLevel::info, "stormcellar-feed {}: following {} of {}, whose chunks go to {}",
        software_version, counted(config.stations.size(), "station"), config.bucket,
        config.drop.native());
    SystemdNotifier notifier;
    notifier.send("READY=1");
    for (;;) {
        const int number = run_until_signal(*service, *signals, notifier);
        if (number != SIGHUP) {
            say_stopping(number, notifier);
            return EXIT_SUCCESS;
        }
        const Reloading reloading(notifier);
        if (auto fresh = reloaded(file)) service = std::move(fresh);
    }
}

int run(const ServiceArguments& arguments) {
    const auto config = arguments.check ? load_feed_config(*arguments.config)
                                        : load_with_stations(*arguments.config);
    if (!config) return complain(program, config.error());
    if (!arguments.check) return feed(*config, *arguments.config);
    if (config->stations.empty()) {
        fmt::print(stderr, "note: {}: {}\n", printable(arguments.config->native()), no_station);
    }
    return say_checked(program, program, *arguments.config);
}

}  // namespace
}  // namespace stormcellar::feed

int main(int argc, char** argv) {
    using namespace stormcellar::feed;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
