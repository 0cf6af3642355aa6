#include "pipeline/care/rebuild_catalog.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "pipeline/drop/drop_names.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

// Directories are searched to this depth, as the daemon does.
constexpr int max_depth = 16;

// Returns true if a file may hold volumes of the station: neither the file nor its directory has
// the name of another station.
bool may_be_of(const fs::path& path, const std::string& station) {
    if (station.empty()) return true;
    const std::string by_name = station_of_file_name(path);
    if (!by_name.empty()) return by_name == station;
    const std::string directory = path.parent_path().filename().native();
    return !is_icao(directory) || directory == station;
}

// Returns the regular files below a directory, sorted. Notes directories that cannot be read as
// problems.
Result<std::vector<fs::path>> files_below(const fs::path& directory, RebuildReport& report) {
    std::vector<fs::path> files;
    std::vector<std::pair<fs::path, int>> left = {{directory, 0}};
    while (!left.empty()) {
        const auto [parent, depth] = std::move(left.back());
        left.pop_back();
        std::error_code error;
        for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
             entry.increment(error)) {
            if (is_temporary_name(entry->path().filename().native())) continue;
            std::error_code unknown;
            const fs::file_type type = entry->symlink_status(unknown).type();
            if (unknown && type != fs::file_type::not_found) {
                report.problems.push_back(
                    {ErrorCode::io,
                     fmt::format("{}: {}", entry->path().native(), unknown.message())});
            }
            if (type == fs::file_type::regular) files.push_back(entry->path());
            if (type == fs::file_type::directory && depth < max_depth) {
                left.emplace_back(entry->path(), depth + 1);
            }
        }
        if (!error) continue;
        Error problem{ErrorCode::io, fmt::format("{}: {}", parent.native(), error.message())};
        if (depth == 0) return tl::unexpected<Error>(std::move(problem));
        report.problems.push_back(std::move(problem));
    }
    std::sort(files.begin(), files.end());
    return files;
}

void count(const IngestOutcome& outcome, RebuildReport& report) {
    switch (outcome.result()) {
        case IngestResult::unchanged:
            ++report.unchanged;
            break;
        case IngestResult::rejected:
            ++report.rejected;
            break;
        case IngestResult::vanished:
        case IngestResult::incomplete:  // the file is being written; the daemon will ingest it
            break;
        default:
            ++report.registered;
    }
}

}  // namespace

Result<RebuildReport> rebuild_catalog(const RebuildOptions& options) {
    RebuildReport report;
    // Rows are found by their paths. The daemon stores absolute paths in which links are resolved.
    std::error_code error;
    const fs::path drop = fs::canonical(options.drop, error);
    if (error) {
        return fail(ErrorCode::not_found, "{}: {}", options.drop.native(), error.message());
    }
    catalog::CatalogOptions writing;
    writing.stations = options.stations;
    writing.drop = drop;
    auto catalog = catalog::CatalogWriter::open(options.catalog, writing);
    if (!catalog) return pass_on(catalog);
    if (options.station.empty()) {
        // One database that cannot be used must not keep the others from being examined.
        (void)catalog->examine_all();
    } else if (Status examined = catalog->examine(options.station); !examined) {
        return pass_on(examined);
    }
    catalog->read_archives_again();
    Result<std::vector<fs::path>> files = options.files;
    if (options.files.empty()) files = files_below(drop, report);
    if (!files) return pass_on(files);
    std::erase_if(*files, [&](const fs::path& path) { return !may_be_of(path, options.station); });

    IngestOptions ingest;
    ingest.stations = options.stations;
    ingest.decode_threads = options.threads;
    Ingestor ingestor(*catalog, ingest);
    report.files = files->size();
    for (std::size_t i = 0; i < files->size(); ++i) {
        const auto outcome = ingestor.ingest((*files)[i], true);
        if (outcome) {
            count(*outcome, report);
        } else if (outcome.error().code == ErrorCode::no_space) {
            return pass_on(outcome);  // such an error would also occur for the next file
        } else if (!outcome.error().message.starts_with(options.catalog.native())) {
            report.problems.push_back(outcome.error());
        }
        if (options.progress) options.progress(i + 1, files->size());
    }
    const auto gone = catalog->mark_missing(drop);
    if (!gone) return pass_on(gone);
    report.gone = *gone;
    for (catalog::Trouble& trouble : catalog->troubles())
        report.problems.push_back(std::move(trouble.error));
    report.repairs = catalog->take_repairs();
    return report;
}

}  // namespace stormcellar::pipeline
