// stormcellar view: shows the user's own files in the viewer, without a service and without a
// network.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/serve/browser.h"
#include "cli/serve/served_files.h"
#include "cli/shared/commands.h"
#include "service/log.h"
#include "service/signals.h"
#include "web/doors/viewer/viewer_files.h"
#include "web/service/web_service.h"

namespace stormcellar::cli {
namespace {

struct ViewOptions {
    std::vector<std::string> files;
    bool no_browser = false;
    int threads = 0;
};

// Returns the setup of a server at any free port that only this machine can reach.
Result<web::WebSetup> setup_of_files(const ServedFiles& files) {
    web::WebSetup setup;
    setup.state.clear();
    serve_files(files, setup);
    const auto address = web::parse_bind_address("127.0.0.1:0");
    if (!address) return pass_on(address);
    setup.web.listen = {*address};
    return setup;
}

int run_view(const ViewOptions& options) {
    if (web::viewer_files().empty()) {
        return report_error({ErrorCode::unsupported,
                             "this program was built without the viewer (STORMCELLAR_VIEWER=OFF)"});
    }
    set_log_level("warning");
    // Once the signals are open, the program itself handles Ctrl-C, so that it leaves nothing
    // behind.
    const auto signals = Signals::open();
    if (!signals) return report_error(signals.error());
    auto files = ServedFiles::take(options.files, options.threads);
    if (!files) return report_error(files.error());
    auto setup = setup_of_files(**files);
    if (!setup) return report_error(setup.error());
    auto service = web::WebService::open(std::move(*setup));
    if (!service) return report_error(service.error());
    const std::string address = (*service)->addresses().front() + "view/";
    fmt::print("the viewer is at {}\n", address);
    const bool is_opened = !options.no_browser && open_in_browser(address);
    fmt::print("{}Ctrl-C ends it\n", is_opened ? "" : "open this address in a browser; ");
    std::fflush(stdout);
    (*files)->take_rest();
    serve_until_signal(*signals, **service);
    service->reset();
    return exit_done;
}

}  // namespace

Run set_up_view(CLI::App& view) {
    const auto options = std::make_shared<ViewOptions>();
    view.add_option("FILE", options->files,
                    "Level II files, archives or directories of them, which are gridded and shown")
        ->required();
    view.add_flag("--no-browser", options->no_browser,
                  "Print the address without opening a browser");
    view.add_option("--threads", options->threads,
                    "Number of threads for decoding and gridding. Default: one for each processor")
        ->check(CLI::Range(0, 256));
    return [options] { return run_view(*options); };
}

}  // namespace stormcellar::cli
