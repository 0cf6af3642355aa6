#include <utility>

#include "pipeline/ingest/finish_chunks.h"
#include "pipeline/ingest/handlers.h"

namespace stormcellar::pipeline {

Result<IngestOutcome> TakeGone::take(const Gone& gone) {
    if (Status marked = context_.mark_gone(file_.path); !marked) return pass_on(marked);
    // A deleted archive keeps its disk space while it is open.
    (void)context_.archives.take(file_.path, {});
    IngestOutcome outcome;
    outcome.ending = ended::Vanished{};
    const auto shared = gone.chunk ? context_.chunks.find_known(*gone.chunk) : nullptr;
    if (!shared) return outcome;
    const auto volume = shared->lock();
    if (volume->is_closed() || !volume->is_representative(file_.path)) return outcome;
    const bool is_over = file_.finish == Finish::as_it_is ||
                         (file_.finish == Finish::when_quiet && volume->is_due());
    if (is_over) return finish(*gone.chunk, shared, *volume);
    outcome.ending = ended::Incomplete{};
    outcome.station = context_.taken_station(station_of(*volume, *gone.chunk));
    outcome.reason = deleted_text;
    return outcome;
}

Result<IngestOutcome> TakeGone::finish(const ChunkPath& chunk, const ChunkVolumes::Shared& shared,
                                       ChunkVolume& volume) {
    volume.close();
    auto finished = finish_chunks(context_, volume, station_of(volume, chunk), {}, {});
    context_.chunks.forget(chunk, shared);
    if (!finished) return finished;
    finished->reason += (finished->reason.empty() ? "" : "; ") + std::string{deleted_text};
    for (const auto& [path, file] : volume.files()) {
        const auto stamp = stamp_of(path, context_.options.beneath);
        if (stamp || stamp.error().code != ErrorCode::not_found) continue;
        if (Status marked = context_.mark_gone(path); !marked) return pass_on(marked);
    }
    return finished;
}

}  // namespace stormcellar::pipeline
