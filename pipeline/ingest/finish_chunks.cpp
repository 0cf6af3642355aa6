#include "pipeline/ingest/finish_chunks.h"

#include <chrono>
#include <utility>
#include <vector>

#include "base/steady_time.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/take_volumes.h"

namespace stormcellar::pipeline {
namespace {

using catalog::FileFacts;
using catalog::FileState;

FileFacts row_of(const std::filesystem::path& path, const ChunkVolume::File& file,
                 const std::string& station) {
    FileFacts facts = facts_unread(path, file.stamp, station);
    facts.content_hash = file.content_hash;
    facts.state = FileState::complete;
    return facts;
}

// Returns the rows of all complete chunks except the first.
std::vector<FileFacts> rows_of_others(const ChunkVolume& volume, const std::string& station) {
    const std::filesystem::path first = volume.first_file();
    std::vector<FileFacts> others;
    for (const auto& [path, file] : volume.files())
        if (path != first && file.is_whole) others.push_back(row_of(path, file, station));
    return others;
}

// Returns the rows with the state `seen`. They are stored while the volume is gridded, so that
// readers of the catalog find all of its chunks.
std::vector<FileFacts> as_seen(std::vector<FileFacts> rows) {
    for (FileFacts& row : rows)
        row.state = FileState::seen;
    return rows;
}

// Returns ok if every file passes `check`, or if there is no check.
Status check_all(const ReadCheck& check, const ChunkVolume& volume) {
    if (!check) return {};
    for (const auto& [path, file] : volume.files()) {
        Status passed = check(path, file.stamp.size_bytes, file.content_hash);
        if (!passed) return passed;
    }
    return {};
}

}  // namespace

std::string station_of(const ChunkVolume& volume, const ChunkPath& chunk) {
    std::string station = volume.station();
    return station.empty() ? station_of_path(chunk.path) : station;
}

Result<IngestOutcome> finish_chunks(IngestContext& context, ChunkVolume& volume,
                                    const std::string& station, const ReadCheck& is_the_same,
                                    IngestOutcome outcome) {
    const auto start = std::chrono::steady_clock::now();
    const std::filesystem::path first = volume.first_file();
    FileFacts facts = row_of(first, volume.files().at(first), station);
    std::vector<FileFacts> others = rows_of_others(volume, station);
    if (const Status same = check_all(is_the_same, volume); !same) return pass_on(same);
    if (const Status wanted = check_all(context.options.check_read, volume); !wanted)
        return context.reject(facts, wanted.error(), std::move(outcome));
    outcome.missing_chunks = volume.missing_numbers();
    auto decoded = volume.finish();
    outcome.decode_s += seconds_since(start);
    // If a sweep on the shelf cannot be read back, or memory is short, the files are not to blame.
    // They are read again.
    if (!decoded && decoded.error().cause() == Cause::system) return pass_on(decoded);
    const auto settle_others = [&] {
        return context.catalog.register_files(context.taken_station(station), others);
    };
    if (!decoded) {
        for (FileFacts& other : others) {
            other.state = FileState::rejected;
            other.reason = decoded.error().message;
        }
        if (Status settled = settle_others(); !settled) return pass_on(settled);
        return context.reject(facts, decoded.error(), std::move(outcome));
    }
    // Register the other chunks first. Then the row of the first chunk describes the whole volume.
    const std::string taken_station = context.taken_station(station);
    if (Status seen = context.catalog.register_files(taken_station, as_seen(others)); !seen)
        return pass_on(seen);
    TakeVolumes volumes(context, std::move(facts), std::move(outcome));
    volumes.set_use_dealiased(
        [&](const level2::Volume& dealiased) { volume.keep_dealiased(dealiased); });
    auto taken = volumes.take(std::move(*decoded), MayBePartial::yes);
    if (!taken) return taken;
    if (Status settled = settle_others(); !settled) return pass_on(settled);
    if (context.living && !taken->station.empty()) context.living->keep_last(volume.take_kept());
    return taken;
}

}  // namespace stormcellar::pipeline
