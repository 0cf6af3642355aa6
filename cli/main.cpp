// stormcellar: the command line. One subcommand a file; see cli/commands.h.
#include <exception>

#include "base/version.h"
#include "cli/commands.h"

namespace stormcellar::cli {
namespace {

int run(int argc, char** argv) {
    CLI::App app{"Weather radar Level II volumes: catalog, grids, loops."};
    app.name("stormcellar");
    app.set_version_flag("--version", std::string{software_version});
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::help);

    const Commands commands{
        // Sorted by name.
        add_cache(app), add_catalog(app), add_frame(app),
        add_grid(app),  add_info(app),    add_loop(app),
    };

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool asked_for_help = error.get_exit_code() == 0;
        if (asked_for_help) return app.exit(error) == 0 ? exit_done : exit_failed;
        fmt::print(stderr, "stormcellar: {}\nTry 'stormcellar --help'.\n", printable(error.what()));
        return exit_bad_usage;
    }
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    return exit_bad_usage;
}

}  // namespace
}  // namespace stormcellar::cli

int main(int argc, char** argv) {
    try {
        return stormcellar::cli::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "stormcellar: {}\n", stormcellar::cli::printable(error.what()));
        return stormcellar::cli::exit_failed;
    }
}
