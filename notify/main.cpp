// stormcellar-notify: sends a message when a storm cell passes thresholds at a place. The text
// below describes its command line.
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/counted.h"
#include "cache/map_guard.h"
#include "notify/notify_service.h"
#include "service/log.h"
#include "service/program.h"
#include "service/turns.h"
#include "stormcellar/base/version.h"

namespace stormcellar::notify {
namespace {

constexpr std::string_view program = "stormcellar-notify";
// A thread that gives no sign for this long hangs. During a delivery, each thread gives a sign at
// least once a second, except while the name of a host is looked up.
constexpr std::chrono::minutes longest_silence{5};
constexpr std::chrono::seconds between_looks{5};

constexpr std::string_view usage =
    "usage: stormcellar-notify --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

// Ends the threads and starts new threads with the new configuration. Returns false if that fails.
bool reload(std::unique_ptr<NotifyService>& service, const std::filesystem::path& file) {
    const auto fresh = load_notify_config(file);
    if (!fresh) {
        say(LogLevel::error, "the configuration stays as it was: {}", fresh.error().message);
    } else {
        set_log_level(fresh->log_level);
        service.reset();
        auto opened = NotifyService::open(real_file_system(), *fresh);
        if (opened) service = std::move(*opened);
        if (opened) say(LogLevel::info, "reloaded {}", file.native());
        if (!opened) say(LogLevel::error, "{}", opened.error().message);
    }
    return service != nullptr;
}

int notify(const NotifyConfig& config, const std::filesystem::path& file) {
    set_log_level(config.log_level);
    cache::install_map_guard();
    const auto signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    auto opened = NotifyService::open(real_file_system(), config);
    if (!opened) return complain(program, opened.error());
    std::unique_ptr<NotifyService> service = std::move(*opened);
    say(LogLevel::info, "stormcellar-notify {}: {} about cells in {}", software_version,
        counted(config.rules.size(), "rule"), config.cache.native());
    SystemdNotifier notifier;
    FirstFailure turned;
    SteadyTime next_look{};
    const auto turn = [&] {
        if (steady_now() < next_look) return;
        next_look = steady_now() + between_looks;
        turned.note(service->turn(now_utc()));
    };
    const bool is_stopped =
        take_turns({.turn = turn,
                    .is_well = [&] { return service->longest_silence() < longest_silence; },
                    .reload = [&] { return reload(service, file); }},
                   *signals, notifier);
    service.reset();
    return is_stopped ? EXIT_SUCCESS : EXIT_FAILURE;
}

// Checks the configuration and the password files.
int check(const NotifyConfig& config, const std::filesystem::path& file) {
    const std::atomic<bool> stop{false};
    for (const NotifyRule& rule : config.rules) {
        if (const auto sender = make_sender(rule, stop, {}); !sender)
            return complain(program, sender.error());
    }
    return say_checked(program, program, file);
}

int run(const ServiceArguments& arguments) {
    const Result<NotifyConfig> config = load_notify_config(*arguments.config);
    if (!config) return complain(program, config.error());
    return arguments.check ? check(*config, *arguments.config) : notify(*config, *arguments.config);
}

}  // namespace
}  // namespace stormcellar::notify

int main(int argc, char** argv) {
    using namespace stormcellar::notify;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
