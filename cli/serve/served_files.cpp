#include "cli/serve/served_files.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <utility>

#include "cli/shared/commands.h"

namespace stormcellar::cli {

Result<std::unique_ptr<ServedFiles>> ServedFiles::take(const std::vector<std::string>& names,
                                                       int threads) {
    auto files = files_to_serve(names);
    if (!files) return pass_on(files);
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    auto cellar = ScratchCellar::make(threads > 0 ? threads : static_cast<int>(processors));
    if (!cellar) return pass_on(cellar);
    std::unique_ptr<ServedFiles> served(new ServedFiles(std::move(*cellar), std::move(*files)));
    if (Status first = served->take_first(); !first) return pass_on(first);
    return served;
}

ServedFiles::~ServedFiles() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
}

Result<std::size_t> ServedFiles::take_next() {
    const std::filesystem::path& file = files_[next_++];
    auto grids = cellar_->take(file);
    if (grids && *grids > 0) gridded_.push_back(file);
    return grids;
}

Status ServedFiles::take_first() {
    while (next_ < files_.size()) {
        const auto grids = take_next();
        if (!grids) return pass_on(grids);
        if (*grids > 0) return {};
    }
    return fail(ErrorCode::not_found, "none of the named files can be gridded");
}

void ServedFiles::take_rest() {
    thread_ = std::thread([this] {
        while (next_ < files_.size() && !is_stopping_) {
            const auto grids = take_next();
            if (!grids) report_error(grids.error());
        }
        for (std::size_t i = 0; i < gridded_.size() && !is_stopping_; ++i) {
            if (const Status derived = cellar_->derive(gridded_[i]); !derived)
                report_error(derived.error());
        }
    });
}

void serve_files(const ServedFiles& files, web::WebSetup& setup) {
    setup.catalog = files.cellar().catalog();
    setup.cache = files.cellar().cache();
    setup.web.silent = std::chrono::hours{24 * 365 * 100};
}

void serve_until_signal(const Signals& signals, web::WebService& service) {
    for (;;) {
        const auto number = signals.next(std::chrono::seconds{1});
        if (number && *number != SIGHUP) return;
        service.look_again();
    }
}

}  // namespace stormcellar::cli
