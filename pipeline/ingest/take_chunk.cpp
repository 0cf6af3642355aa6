#include <chrono>
#include <utility>

#include "base/steady_time.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/finish_chunks.h"
#include "pipeline/ingest/handlers.h"
#include "pipeline/ingest/show_living.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;
using Added = ChunkVolume::Added;

}  // namespace

// Returns which chunks of the volume are still expected. None are expected if the file has been
// quiet and the volume's end has come; a volume that found no place is then read.
ChunkVolumes::Expected TakeChunk::expected() const {
    using Expected = ChunkVolumes::Expected;
    switch (file_.finish) {
        case Finish::as_it_is:
            return Expected::nothing;
        case Finish::when_quiet:
            return context_.chunks.may_be_due(chunk_) ? Expected::nothing : Expected::more;
        case Finish::when_it_ends:
            break;
    }
    const bool is_end = chunk_.name.kind == level2::ChunkKind::end;
    return is_end ? Expected::its_end_is_there : Expected::more;
}

Result<IngestOutcome> TakeChunk::take() {
    const std::string path_station = context_.taken_station(station_of_path(chunk_.path));
    const ChunkVolumes::Expected to_come = expected();
    while (true) {
        const auto shared = context_.chunks.find(chunk_, path_station, to_come);
        outcome_.given_up += context_.chunks.take_given_up();
        if (!shared) return poll_for_place();
        auto volume = shared->lock();
        if (!volume->is_closed()) return add_to(shared, volume);
        // Another worker may have finished the volume while this worker waited for it.
        const auto settled =
            context_.catalog.is_settled(chunk_.path, stamp_.size_bytes, stamp_.modified_ns);
        if (!settled) return pass_on(settled);
        if (*settled) {
            outcome_.ending = ended::Unchanged{};
            return std::move(outcome_);
        }
        context_.chunks.forget(chunk_, shared);
    }
}

// Makes the newest chunk represent the volume, so that it is offered again.
Result<IngestOutcome> TakeChunk::poll_for_place() {
    outcome_.former_representative = context_.chunks.poll_for_place(chunk_);
    return context_.wait_unread(facts_unread(chunk_.path, stamp_, station_of_path(chunk_.path)),
                                std::move(outcome_));
}

Result<IngestOutcome> TakeChunk::add_to(const ChunkVolumes::Shared& shared,
                                        Guarded<ChunkVolume>::Locked& volume) {
    const auto start = std::chrono::steady_clock::now();
    const auto added = volume->add_with_siblings(chunk_, stamp_);
    if (!added) return pass_on(added);
    if (*added == Added::not_ours && volume->files().empty())
        context_.chunks.forget(chunk_, shared);
    // If a file holds no complete chunk even when nothing more is expected, it is not a chunk.
    const bool is_no_chunk =
        *added == Added::not_ours || (*added == Added::unfinished && file_.may_be_partial());
    if (is_no_chunk) {
        volume.unlock();
        return pipeline::take(context_, file_, kind_by_itself(context_, file_, stamp_));
    }
    outcome_.decode_s = seconds_since(start);
    if (*added == Added::unfinished) {
        outcome_.ending = ended::Incomplete{};
        return std::move(outcome_);
    }
    volume->add_what_is_missing(chunk_);
    const std::string station = station_of(*volume, chunk_);
    outcome_.station = context_.taken_station(station);
    const bool is_over = volume->is_whole() || file_.finish == Finish::as_it_is ||
                         (file_.finish == Finish::when_quiet && volume->is_due());
    return is_over ? finish(shared, *volume, station) : show(shared, *volume, station);
}

Result<IngestOutcome> TakeChunk::finish(const ChunkVolumes::Shared& shared, ChunkVolume& volume,
                                        const std::string& station) {
    // Close the volume, so that its files are joined anew if it cannot be stored. It stays known
    // until it is finished, so that other jobs wait for it. Otherwise two objects of one volume
    // would overwrite each other's rows.
    volume.close();
    auto finished =
        finish_chunks(context_, volume, station, file_.is_the_same, std::move(outcome_));
    // The chunk that was the representative need not be polled any more.
    if (finished) finished->former_representative = volume.take_former_representative();
    context_.chunks.forget(chunk_, shared);
    return finished;
}

// Records a chunk of a volume that has not ended. The row of the first chunk describes the volume,
// so that the volume can be listed and read while it grows. If the volume had ended before, and a
// late chunk reopened it, its row does not change.
Status TakeChunk::record(const ChunkVolume& volume, const fs::path& path,
                         const std::string& station) {
    const ChunkVolume::File& file = volume.files().at(path);
    FileFacts facts = facts_unread(path, file.stamp, station);
    if (path == volume.first_file()) {
        if (const auto living = volume.living_facts()) facts.volumes = {*living};
        const auto settled = context_.catalog.is_settled(path, facts.size_bytes, facts.modified_ns);
        if (!settled) return pass_on(settled);
        if (*settled && path != chunk_.path) return {};
    }
    facts.content_hash = file.content_hash;
    facts.state = FileState::seen;
    return context_.record(std::move(facts));
}

Result<IngestOutcome> TakeChunk::show(const ChunkVolumes::Shared& shared, ChunkVolume& volume,
                                      const std::string& station) {
    if (Status stored = record(volume, chunk_.path, station); !stored) return pass_on(stored);
    if (const fs::path first = volume.first_file(); volume.news().any && first != chunk_.path) {
        if (Status stored = record(volume, first, station); !stored) return pass_on(stored);
    }
    const bool has_place = context_.chunks.grew(chunk_, shared, volume.growth(), outcome_.station);
    if (!has_place) volume.close();
    outcome_.goes_on = has_place && volume.has_sweeps();
    outcome_.given_up += context_.chunks.take_given_up();
    if (volume.news().any && volume.kept() != nullptr) {
        const auto shown = show_living(context_, *volume.kept(), volume.news(),
                                       volume.first_file().filename().string(), outcome_);
        if (!shown) return pass_on(shown);
        if (*shown) volume.set_shown();
    }
    // One chunk must represent the volume, so that it is offered again.
    if (!volume.has_representative()) volume.set_representative(chunk_.path);
    if (volume.is_representative(chunk_.path)) {
        outcome_.ending = ended::Incomplete{};
        outcome_.former_representative = volume.take_former_representative();
    } else {
        outcome_.ending = ended::Registered{};
    }
    return std::move(outcome_);
}

}  // namespace stormcellar::pipeline
