#include "cli/serve/scratch_cellar.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_rule.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

Status add_file(const fs::path& file, std::set<fs::path>& files) {
    std::error_code error;
    const fs::path path = fs::canonical(file, error);
    if (error) return fail(ErrorCode::not_found, "{}: {}", file.native(), error.message());
    files.insert(path);
    return {};
}

// Returns the options for gridding all derived moments but classes, or all moments that are not
// derived.
pipeline::IngestOptions options_for_moments(bool are_derived, int threads) {
    pipeline::IngestOptions options;
    options.stations = std::make_shared<StationRule>(StationRule::any(StationRule::no_limit));
    options.moments.clear();
    std::ranges::copy_if(level2::all_moments, std::back_inserter(options.moments),
                         [&](level2::Moment moment) {
                             const level2::MomentFacts& facts = level2::facts_of(moment);
                             return facts.is_derived == are_derived && !facts.is_categorical;
                         });
    options.decode_threads = threads;
    options.grid_threads = threads;
    return options;
}

}  // namespace

Result<std::vector<fs::path>> files_to_serve(const std::vector<std::string>& names) {
    if (std::ranges::count(names, "-") > 0) {
        return fail(ErrorCode::bad_argument,
                    "raw files are served from where they are, so standard input cannot be served");
    }
    const auto inputs = InputFiles::find(names, InputFiles::all);
    if (!inputs) return pass_on(inputs);
    note_left_out(*inputs);
    std::set<fs::path> files;
    for (const InputFile& file : inputs->files()) {
        std::vector<fs::path> paths = file.chunks;
        if (paths.empty()) paths.push_back(file.path);
        for (const fs::path& path : paths) {
            if (Status added = add_file(path, files); !added) return pass_on(added);
        }
    }
    return std::vector<fs::path>(files.begin(), files.end());
}

ScratchCellar::ScratchCellar(ScratchDirectory scratch, catalog::CatalogWriter catalog,
                             cache::StoreWriter store, int threads)
    : scratch_(std::move(scratch)),
      catalog_(std::move(catalog)),
      store_(std::move(store)),
      ingestor_(catalog_, store_, options_for_moments(false, threads)),
      deriver_(catalog_, store_, options_for_moments(true, threads)) {}

Result<std::unique_ptr<ScratchCellar>> ScratchCellar::make(int threads) {
    auto scratch = ScratchDirectory::make();
    if (!scratch) return pass_on(scratch);
    catalog::CatalogOptions options;
    options.drop = "/";
    auto catalog = catalog::CatalogWriter::open(scratch->path() / "catalog", options);
    if (!catalog) return pass_on(catalog);
    auto store = cache::StoreWriter::open(real_file_system(), scratch->path() / "cache", false);
    if (!store) return pass_on(store);
    return std::unique_ptr<ScratchCellar>(
        new ScratchCellar(std::move(*scratch), std::move(*catalog), std::move(*store), threads));
}

Result<std::size_t> ScratchCellar::take(const fs::path& file) {
    const auto outcome = ingestor_.ingest(file, true, pipeline::Tries::last);
    if (!outcome) return pass_on(outcome);
    using enum pipeline::IngestResult;
    switch (outcome->result()) {
        case gridded:
        case unchanged:
        case registered:
            break;
        case no_position:
            print_note(
                fmt::format("{}: served, but not gridded: the position of the radar is unknown",
                            file.native()));
            break;
        default:
            print_note(fmt::format("{}: served, but not gridded{}{}", file.native(),
                                   outcome->reason.empty() ? "" : ": ", outcome->reason));
    }
    return outcome->grids.size();
}

Status ScratchCellar::derive(const fs::path& file) {
    const auto outcome = deriver_.ingest_again(file);
    if (!outcome) return pass_on(outcome);
    return {};
}

}  // namespace stormcellar::cli
