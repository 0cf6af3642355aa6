// stormcellar serve: runs the data server for one person until Ctrl-C.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/serve/served_files.h"
#include "cli/shared/commands.h"
#include "cli/shared/service_places.h"
#include "service/log.h"
#include "service/signals.h"
#include "stormcellar/base/station_table.h"
#include "web/service/web_service.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

struct ServeOptions {
    std::vector<std::string> files;
    std::string cache, catalog, config;
    std::vector<std::string> listen, names;
    bool cors = false, verbose = false;
    int threads = 0;
};

// Reads the configuration if one is named, or if no option says which directories to serve.
// Otherwise returns a setup that names no directories.
Result<web::WebSetup> setup_by_config(const ServeOptions& options) {
    web::WebSetup setup;
    setup.state.clear();
    setup.catalog.clear();
    setup.cache.clear();
    const bool says_what =
        !options.files.empty() || !options.cache.empty() || !options.catalog.empty();
    if (says_what && options.config.empty()) return setup;
    const auto places = service_places(options.config);
    if (!places) return pass_on(places);
    if (!*places) {
        return fail(ErrorCode::bad_argument,
                    "name what to serve: files, --cache and --catalog, or --config FILE for the "
                    "data of a service");
    }
    return web::load_web_setup((*places)->config);
}

Status take_addresses(const ServeOptions& options, web::WebSetup& setup) {
    if (!options.listen.empty()) setup.web.listen.clear();
    for (const std::string& text : options.listen) {
        const auto address = web::parse_bind_address(text);
        if (!address) return fail(ErrorCode::bad_argument, "--listen: {}", address.error().message);
        setup.web.listen.push_back(*address);
    }
    for (const std::string& name : options.names) {
        if (!web::is_host_name(name)) {
            return fail(ErrorCode::bad_argument,
                        "--allow-host: \"{}\" is not the name of a host (without a port)", name);
        }
        setup.web.names.push_back(name);
    }
    return {};
}

// Returns the setup of the server. Errors: bad_argument, and those of a configuration.
Result<web::WebSetup> setup_of(const ServeOptions& options) {
    auto setup = setup_by_config(options);
    if (!setup) return setup;
    if (!options.cache.empty()) setup->cache = options.cache;
    if (!options.catalog.empty()) setup->catalog = options.catalog;
    if (options.cors) setup->web.cors = true;
    for (const fs::path* directory : {&setup->cache, &setup->catalog}) {
        const bool was_typed =
            directory == &setup->cache ? !options.cache.empty() : !options.catalog.empty();
        if (was_typed && !fs::is_directory(*directory))
            return fail(ErrorCode::not_found, "{}: there is no such directory",
                        directory->native());
    }
    if (Status taken = take_addresses(options, *setup); !taken) return pass_on(taken);
    return setup;
}

int run_serve(const ServeOptions& options) {
    auto setup = setup_of(options);
    if (!setup) return report_error(setup.error());
    set_added_stations(setup->added_stations);
    set_log_level(options.verbose ? "debug" : "warning");
    // Once the signals are open, the program itself handles Ctrl-C, so that it leaves nothing
    // behind.
    const auto signals = Signals::open();
    if (!signals) return report_error(signals.error());
    std::unique_ptr<ServedFiles> files;
    if (!options.files.empty()) {
        auto taken = ServedFiles::take(options.files, options.threads);
        if (!taken) return report_error(taken.error());
        files = std::move(*taken);
        serve_files(*files, *setup);
    }
    auto service = web::WebService::open(std::move(*setup));
    if (!service) return report_error(service.error());
    for (const std::string& address : (*service)->addresses())
        fmt::print("listening on {}\n", address);
    std::fflush(stdout);
    if (files) files->take_rest();
    serve_until_signal(*signals, **service);
    service->reset();
    return exit_done;
}

}  // namespace

Run set_up_serve(CLI::App& serve) {
    const auto options = std::make_shared<ServeOptions>();
    auto* files = serve.add_option("FILE", options->files,
                                   "Level II files, archives or directories of them, which are "
                                   "gridded and served");
    auto* cache =
        serve.add_option("--cache", options->cache, "Directory of a cache whose grids are served");
    auto* catalog =
        serve.add_option("--catalog", options->catalog,
                         "Directory of a catalog (state/catalog) whose raw files are served");
    cache->excludes(files);
    catalog->excludes(files);
    serve.add_option(
        "--config", options->config,
        "Configuration file of a service, to take its directories and its [web] table. "
        "Default, if no file, cache or catalog is named: $STORMCELLAR_CONFIG, else "
        "/etc/stormcellar/stormcellard.toml");
    serve
        .add_option("--listen", options->listen,
                    "Numeric address and port to listen on; may be repeated. Port 0 takes any "
                    "free port. Default: 127.0.0.1:8090 and [::1]:8090")
        ->type_name("ADDRESS:PORT")
        ->allow_extra_args(false);
    serve
        .add_option("--allow-host", options->names,
                    "Name by which clients may call this server, in addition to localhost and the "
                    "addresses of --listen; may be repeated")
        ->type_name("NAME")
        ->allow_extra_args(false);
    serve.add_flag("--cors", options->cors,
                   "Let web pages of other servers read public data in a browser");
    serve
        .add_option("--threads", options->threads,
                    "Number of threads for decoding and gridding. Default: one for each processor")
        ->check(CLI::Range(0, 256));
    serve.add_flag("--verbose", options->verbose, "Print a line for each answer on stderr");
    return [options] { return run_serve(*options); };
}

}  // namespace stormcellar::cli
