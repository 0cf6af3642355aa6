// stormcellar-feed: follows the public chunk bucket for some stations. Its usage is the text below.
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <signal.h>
#include <systemd/sd-daemon.h>

#include "base/counted.h"
#include "base/printable.h"
#include "base/service_log.h"
#include "base/service_program.h"
#include "base/waited_signals.h"
#include "feed/feed_service.h"
#include "stormcellar/base/version.h"

namespace stormcellar::feed {
namespace {

constexpr std::string_view program = "stormcellar-feed";
// The program looks for signals, and writes the status and feeds the watchdog, as often as this.
constexpr std::chrono::milliseconds between_looks{100}, between_reports{2000};

constexpr std::string_view usage =
    "usage: stormcellar-feed --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

constexpr std::string_view no_station =
    "[feed] stations names no station, so there is nothing to follow, and the service will not "
    "start";

// Tells systemd. Without it, nothing happens.
void notify(const std::string& state) {
    (void)::sd_notify(0, state.c_str());
}

Result<FeedConfig> load_with_stations(const std::filesystem::path& file) {
    auto config = load_feed_config(file);
    if (config && config->stations.empty()) {
        return fail(ErrorCode::bad_argument, "{}: {}", file.native(), no_station);
    }
    return config;
}

void publish(FeedService& service) {
    static bool was_written = true;
    const Status written = service.publish();
    if (!written && was_written) say(LogLevel::error, "{}", written.error().message);
    was_written = written.has_value();
}

// Runs until a signal comes, and returns its number.
int run_until_signal(FeedService& service, const WaitedSignals& signals) {
    std::atomic<bool> stop{false};
    int number = 0;
    SteadyTime next_look{}, next_report{};
    service.run(stop, [&] {
        const SteadyTime now = steady_now();
        if (now < next_look) return;
        next_look = now + between_looks;
        number = signals.next(std::chrono::milliseconds{0}).value_or(0);
        stop = number != 0;
        if (now < next_report && !stop) return;
        next_report = now + between_reports;
        publish(service);
        notify("WATCHDOG=1");
    });
    return number;
}

// Returns none if the service goes on as it was.
std::unique_ptr<FeedService> reloaded(const std::filesystem::path& file) {
    const auto fresh = load_with_stations(file);
    if (!fresh) {
        say(LogLevel::error, "the configuration stays as it was: {}", fresh.error().message);
        return nullptr;
    }
    auto opened = FeedService::open(real_file_system(), *fresh);
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
    const WaitedSignals signals;
    auto opened = FeedService::open(real_file_system(), config);
    if (!opened) return complain(program, opened.error());
    std::unique_ptr<FeedService> service = std::move(*opened);
    say(LogLevel::info, "stormcellar-feed {}: following {} of {}, whose chunks go to {}",
        software_version, counted(config.stations.size(), "station"), config.bucket,
        config.drop.native());
    notify("READY=1");
    for (;;) {
        const int number = run_until_signal(*service, signals);
        if (number != SIGHUP) {
            say(LogLevel::info, "stopping: received {}", number == SIGTERM ? "SIGTERM" : "SIGINT");
            break;
        }
        notify(reloading_state());
        if (auto fresh = reloaded(file)) service = std::move(fresh);
        notify("READY=1");
    }
    notify("STOPPING=1");
    return EXIT_SUCCESS;
}

int run(const ServiceArguments& arguments) {
    const auto config = arguments.check ? load_feed_config(*arguments.config)
                                        : load_with_stations(*arguments.config);
    if (!config) return complain(program, config.error());
    if (!arguments.check) return feed(*config, *arguments.config);
    if (config->stations.empty()) {
        fmt::print(stderr, "note: {}: {}\n", printable(arguments.config->native()), no_station);
    }
    fmt::print("{}\n{}: ok\n", checked_as(program, program), printable(arguments.config->native()));
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace stormcellar::feed

int main(int argc, char** argv) {
    using namespace stormcellar::feed;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
