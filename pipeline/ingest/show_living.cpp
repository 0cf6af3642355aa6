#include "pipeline/ingest/show_living.h"

#include <chrono>

#include "base/steady_time.h"
#include "pipeline/ingest/living_sweeps.h"
#include "pipeline/keep/keep_rule.h"

namespace stormcellar::pipeline {
namespace {

bool may_show(const LivingGrids& living, const UnshownSweeps& news) {
    const Load load = living.load ? living.load() : Load::light;
    return load == Load::light || (load == Load::heavy && news.low);
}

}  // namespace

Result<bool> show_living(IngestContext& context, const ShelvedVolume& kept, UnshownSweeps news,
                         const std::string& file, IngestOutcome& outcome) {
    const IngestOptions& options = context.options;
    // The start in the header gives the grid its name. Without the header, the living grid would
    // get another name and stay beside the final grid.
    if (!kept.facts.header) return false;
    const std::string station = context.taken_station(kept.facts.station);
    if (!context.living || !options.own_grids || station.empty()) return false;
    // If there is no time now, the next sweep or the end of the volume will show these sweeps.
    if (!may_show(options.living, news)) {
        outcome.living_left_out = true;
        return false;
    }
    const auto last = context.living->last_of(kept.facts.station);
    const auto start = std::chrono::steady_clock::now();
    auto sweeps = LivingSweeps::read(kept, last.get(), news.moments, options.derived);
    if (!sweeps) return true;
    outcome.dealiased_sweeps += sweeps->dealiased();
    outcome.grid_s += seconds_since(start);
    const int threads = context.share_of(options.grid_threads);
    for (const level2::Moment moment : options.moments) {
        if (!news.moments.test(static_cast<std::size_t>(moment))) continue;
        // Sweeps that have not come yet help to judge echo, so only the complete volume has POW.
        if (level2::uses_all_moments(moment)) continue;
        level2::Volume& volume = sweeps->volume_of(moment);
        // The living grid would get another time than the final grid, and would stay beside it.
        if (volume.start_time() != kept.facts.header->time()) continue;
        GridSource source{file, true};
        source.notes.push_back(fmt::format("{}{} sweeps have come, {} of the last volume stand",
                                           living_note, volume.sweeps.size() - sweeps->standing(),
                                           sweeps->standing()));
        if (options.derived.quality > 0)
            source.notes.push_back(
                retrieve::weather_note(options.derived.quality, sweeps->left_out()));
        if (level2::is_dealiased(moment)) {
            auto notes = retrieve::add_from_dealiased(volume, moment, options.derived);
            if (!notes) {
                note_not_derived(moment, notes.error(), outcome);
                continue;
            }
            source.notes.insert(source.notes.end(), notes->begin(), notes->end());
        }
        const Status shown =
            context.site_grids->keep_living(volume, moment, source, threads, outcome);
        if (!shown && shown.error().cause() != Cause::data) return pass_on(shown);
    }
    return true;
}

}  // namespace stormcellar::pipeline
