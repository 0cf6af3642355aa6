// stormcellar status: shows what the running daemon reports about itself.
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/query/status_source.h"
#include "cli/query/status_table.h"
#include "cli/shared/commands.h"
#include "cli/shared/paint.h"
#include "cli/shared/query_options.h"
#include "cli/shared/short_duration.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {
namespace {

std::optional<double> age_of(const nlohmann::json& status, UtcTime now) {
    const auto updated = status.find("updated");
    if (updated == status.end() || !updated->is_string()) return std::nullopt;
    const auto time = parse_utc(updated->get<std::string>(), now);
    if (!time) return std::nullopt;
    return std::chrono::duration<double>(now - *time).count();
}

int run_status(const StatusOptions& options) {
    const auto places = places_of(options);
    if (!places) return report_error(places.error());
    auto found = find_status(*places);
    if (!found) return report_error(found.error());
    add_loops(found->document, places->loops);
    const UtcTime now = now_utc();
    const std::optional<double> age_s = age_of(found->document, now);
    const bool answered = found->silent.empty();
    if (!answered) {
        const std::string line = fmt::format(
            "no daemon answers ({}); the status is that of {}, {} old", printable(found->silent),
            printable(found->from.native()), short_duration(age_s));
        fmt::print(stderr, "stormcellar: {}\n", in_red(line, paint_for(STDERR_FILENO)));
    }
    if (options.json) {
        nlohmann::json age = nullptr;
        if (age_s) age = *age_s;
        found->document["source"] = {
            {"answered", answered}, {"from", printable(found->from.native())}, {"age_s", age}};
        print_json(found->document);
    } else {
        fmt::print("{}", status_table(found->document, now, paint_for(STDOUT_FILENO)));
    }
    return answered ? exit_done : exit_failed;
}

}  // namespace

Run set_up_status(CLI::App& status) {
    const auto options = std::make_shared<StatusOptions>();
    auto* socket =
        status.add_option("--socket", options->socket,
                          "Unix socket on which the daemon answers. Default: the usual places");
    auto* state = status.add_option("--state", options->state, "State directory of the daemon")
                      ->excludes(socket);
    status
        .add_option(
            "--config", options->config,
            "Configuration file of the daemon, which names the socket and the state directory")
        ->excludes(socket)
        ->excludes(state);
    status.add_flag("--json", options->json, "Print one JSON document");
    return [options] { return run_status(*options); };
}

}  // namespace stormcellar::cli
