// stormcellar-pull: fetches grids from the data servers of other machines. Its usage is the text
// below.
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "base/counted.h"
#include "base/printable.h"
#include "base/service_log.h"
#include "base/service_program.h"
#include "base/waited_signals.h"
#include "pull/pull_service.h"
#include "stormcellar/base/version.h"

namespace stormcellar::pull {
namespace {

constexpr std::string_view program = "stormcellar-pull";
// Period in which the program writes the status and feeds the watchdog.
constexpr std::chrono::milliseconds turn{1000};
// A thread that is silent for this long is stuck; a transfer beats at least once a second.
constexpr std::chrono::minutes longest_silence{5};

constexpr std::string_view usage =
    "usage: stormcellar-pull --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

// Tells systemd. Without it, nothing happens.
void notify(const std::string& state) {
    (void)::sd_notify(0, state.c_str());
}

void publish(PullService& service) {
    static bool was_written = true;
    const Status written = service.publish();
    if (!written && was_written) say(LogLevel::error, "{}", written.error().message);
    was_written = written.has_value();
}

// The threads end, and begin anew as the configuration now says.
void reload(std::unique_ptr<PullService>& service, const std::filesystem::path& file) {
    notify(reloading_state());
    const auto fresh = load_pull_config(file);
    if (!fresh) {
        say(LogLevel::error, "the configuration stays as it was: {}", fresh.error().message);
    } else {
        set_log_level(fresh->log_level);
        service.reset();
        auto opened = PullService::open(real_file_system(), *fresh);
        if (opened) service = std::move(*opened);
        if (opened) say(LogLevel::info, "reloaded {}", file.native());
        if (!opened) say(LogLevel::error, "{}", opened.error().message);
    }
    notify("READY=1");
}

int pull(const PullConfig& config, const std::filesystem::path& file) {
    set_log_level(config.log_level);
    const WaitedSignals signals;
    auto opened = PullService::open(real_file_system(), config);
    if (!opened) return complain(program, opened.error());
    std::unique_ptr<PullService> service = std::move(*opened);
    say(LogLevel::info, "stormcellar-pull {}: asking {} for grids, which go to {}",
        software_version, counted(config.sources.size(), "machine"), config.directory.native());
    notify("READY=1");
    for (;;) {
        publish(*service);
        if (service->longest_silence() < longest_silence) notify("WATCHDOG=1");
        const auto number = signals.next(turn);
        if (!number) continue;
        if (*number != SIGHUP) {
            say(LogLevel::info, "stopping: received {}", *number == SIGTERM ? "SIGTERM" : "SIGINT");
            break;
        }
        reload(service, file);
        if (service == nullptr) return EXIT_FAILURE;
    }
    notify("STOPPING=1");
    service.reset();
    return EXIT_SUCCESS;
}

int run(const ServiceArguments& arguments) {
    const Result<PullConfig> config = load_pull_config(*arguments.config);
    if (!config) return complain(program, config.error());
    if (!arguments.check) return pull(*config, *arguments.config);
    fmt::print("{}\n{}: ok\n", checked_as(program, program), printable(arguments.config->native()));
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace stormcellar::pull

int main(int argc, char** argv) {
    using namespace stormcellar::pull;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
