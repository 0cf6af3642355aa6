// stormcellar-pull: fetches grids from the data servers of other machines. The text below describes
// its command line.
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/counted.h"
#include "fetch/pull/pull_service.h"
#include "service/log.h"
#include "service/program.h"
#include "service/turns.h"
#include "stormcellar/base/version.h"

namespace stormcellar::pull {
namespace {

constexpr std::string_view program = "stormcellar-pull";
// A thread that gives no sign for this long hangs. During a transfer, each thread gives a sign at
// least once a second.
constexpr std::chrono::minutes longest_silence{5};

constexpr std::string_view usage =
    "usage: stormcellar-pull --config FILE [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML), that of stormcellard\n"
    "  --check-config   check what concerns this program in FILE, and exit\n"
    "  --version, --help\n";

// Ends the threads and starts new ones with the new configuration. Returns false if that fails.
bool reload(std::unique_ptr<PullService>& service, const std::filesystem::path& file) {
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
    return service != nullptr;
}

int pull(const PullConfig& config, const std::filesystem::path& file) {
    set_log_level(config.log_level);
    const auto signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    auto opened = PullService::open(real_file_system(), config);
    if (!opened) return complain(program, opened.error());
    std::unique_ptr<PullService> service = std::move(*opened);
    say(LogLevel::info, "stormcellar-pull {}: asking {} for grids, which go to {}",
        software_version, counted(config.sources.size(), "machine"), config.directory.native());
    SystemdNotifier notifier;
    FirstFailure written;
    const bool is_stopped =
        take_turns({.turn = [&] { written.note(service->publish()); },
                    .is_well = [&] { return service->longest_silence() < longest_silence; },
                    .reload = [&] { return reload(service, file); }},
                   *signals, notifier);
    service.reset();
    return is_stopped ? EXIT_SUCCESS : EXIT_FAILURE;
}

int run(const ServiceArguments& arguments) {
    const Result<PullConfig> config = load_pull_config(*arguments.config);
    if (!config) return complain(program, config.error());
    if (!arguments.check) return pull(*config, *arguments.config);
    return say_checked(program, program, *arguments.config);
}

}  // namespace
}  // namespace stormcellar::pull

int main(int argc, char** argv) {
    using namespace stormcellar::pull;
    return stormcellar::run_service({program, usage, {}, run}, argc, argv);
}
