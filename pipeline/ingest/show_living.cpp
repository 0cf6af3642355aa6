#include "pipeline/ingest/show_living.h"

#include "pipeline/keep/keep_rule.h"

namespace stormcellar::pipeline {

Result<bool> show_living(IngestContext& context, const ShelvedVolume& kept, UnshownSweeps news,
                         const std::string& file, std::int64_t modified_ns,
                         IngestOutcome& outcome) {
    const IngestOptions& options = context.options;
    // A grid has the name of the start in the header: without it, the living grid would stay beside
    // that of the whole volume.
    if (!kept.facts.header) return false;
    const std::string station = context.taken_station(kept.facts.station);
    if (!context.living || !options.own_grids || station.empty()) return false;
    // The sweeps are shown with the next sweep, or when the volume has ended. Users look at low
    // sweeps first.
    if (!news.low && options.living.has_time && !options.living.has_time()) {
        outcome.living_left_out = true;
        return false;
    }
    const auto last = context.living->last_of(kept.facts.station);
    std::size_t standing = 0;
    const auto volume = volume_for_living_grid(kept, last.get(), &standing);
    // Its grid would have another time in its name than that of the whole volume, and stay beside
    // it.
    if (!volume || volume->start_time() != kept.facts.header->time()) return true;
    GridSource source{file, modified_ns, true};
    source.notes.push_back(fmt::format("{}{} sweeps have come, {} of the last volume stand",
                                       living_note, volume->sweeps.size() - standing, standing));
    const int threads = context.share_of(options.grid_threads);
    const Status shown = context.site_grids->keep_living(*volume, source, threads, outcome);
    if (!shown && shown.error().cause() != Cause::data) return pass_on(shown);
    return true;
}

}  // namespace stormcellar::pipeline
