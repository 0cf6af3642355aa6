#include "daemon/status/metrics_text.h"

#include <algorithm>
#include <functional>

#include "base/printable.h"
#include "stormcellar/base/version.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;
using Type = MetricsWriter::Type;

double seconds_between(UtcTime from, UtcTime to) {
    return std::chrono::duration<double>(to - from).count();
}

double seconds_since_epoch(UtcTime time) {
    return seconds_between(UtcTime{}, time);
}

void write_unreadable(MetricsWriter& out, const StatusFacts& facts) {
    out.gauge("stormcellar_drop_directory_lost", "1 while the drop directory cannot be read.",
              std::uint64_t{facts.drop_lost.empty() ? 0U : 1U});
    out.gauge("stormcellar_unreadable_directories",
              "Directories below the drop directory that cannot be read.",
              facts.unreadable.count());
    if (facts.unreadable.named.empty()) return;
    out.family("stormcellar_unreadable_directory", Type::gauge,
               "Always 1; a directory that cannot be read, of the first 16.");
    for (const auto& [directory, reason] : facts.unreadable.named)
        out.sample(std::uint64_t{1},
                   {{"directory", printable(directory)}, {"reason", printable(reason)}});
}

void write_process(MetricsWriter& out, const StatusFacts& facts, const Pending& pending) {
    out.family("stormcellar_build_info", Type::gauge, "Always 1; the version is a label.");
    out.sample(std::uint64_t{1}, {{"version", software_version}});
    out.gauge("stormcellar_start_time_seconds", "When the daemon started, in seconds since 1970.",
              seconds_since_epoch(facts.started));
    out.family("stormcellar_state", Type::gauge, "1 for the current state of the daemon.");
    for (const std::string_view state : {"starting", "running", "stopping", "stopped"})
        out.sample(std::uint64_t{facts.state == state ? 1U : 0U}, {{"state", state}});
    out.family(
        "stormcellar_queue_files", Type::gauge,
        "Files that wait, are being ingested, still grow, or failed and will be tried again.");
    out.sample(std::uint64_t{pending.waiting}, {{"state", "waiting"}});
    out.sample(std::uint64_t{pending.running}, {{"state", "running"}});
    out.sample(std::uint64_t{pending.growing}, {{"state", "growing"}});
    out.sample(std::uint64_t{pending.retrying}, {{"state", "retrying"}});
    out.gauge("stormcellar_databases_in_trouble", "Databases of stations that cannot be used now.",
              facts.catalog.troubles.size());
    out.gauge("stormcellar_longest_wait_seconds",
              "How long the first file of the queue has waited.", facts.longest_wait_s);
    out.counter("stormcellar_living_left_out_total",
                "Living grids that were not made because whole volumes waited.",
                facts.living_left_out);
    out.counter("stormcellar_growing_given_up_total",
                "Growing volumes that were given up to make room and are read again.",
                facts.given_up);
    out.counter("stormcellar_event_overflows_total",
                "How often the kernel dropped directory events.", facts.overflows);
    out.counter(
        "stormcellar_unseen_entries_total",
        "How often a file or directory could not be examined for want of descriptors or memory.",
        facts.unseen);
    out.counter("stormcellar_scans_total", "Scans of the whole drop directory.", facts.scans);
    out.gauge("stormcellar_watched_directories",
              "Directories in the drop directory that are watched.", facts.directories);
    write_unreadable(out, facts);
}

void write_files(MetricsWriter& out, const StatusFacts& facts) {
    out.family("stormcellar_files_total", Type::counter, "Files that were ingested, by result.");
    for (const IngestResult result : all_results)
        out.sample(facts.results.at(index_of(result)), {{"result", name_of(result)}});
    out.counter("stormcellar_partial_volumes_total",
                "Gridded files whose volume had not ended or was damaged.", facts.partial);
    out.counter("stormcellar_grids_committed_total", "Single-site grids put into the cache.",
                facts.grids);
    out.counter("stormcellar_living_grids_total",
                "Living grids, one for each time that sweeps entered the grid of a growing volume.",
                facts.living);
    out.family("stormcellar_rejected_files_total", Type::counter,
               "Files that could not be read, decoded or gridded, by reason.");
    for (const ErrorCode code : all_error_codes)
        out.sample(facts.rejected.at(index_of(code)), {{"reason", name_of(code)}});
    out.family("stormcellar_store_failures_total", Type::counter,
               "Attempts that failed because the catalog or the cache could not be written.");
    for (const ErrorCode code : all_error_codes)
        out.sample(facts.failed.at(index_of(code)), {{"reason", name_of(code)}});
    out.summary(
        "stormcellar_close_to_cache_seconds",
        "Time from the close of a file to its grids in the cache, over the last 4096 files.",
        facts.close_to_cache);
    out.summary("stormcellar_close_to_living_seconds",
                "Time from the close that completed a sweep to the grid that shows it.",
                facts.close_to_living);
    out.summary("stormcellar_antenna_to_cache_seconds",
                "Time from a volume's newest radial to its grids in the cache, for live data.",
                facts.antenna_to_cache);
    out.counter("stormcellar_not_live_volumes_total",
                "Volumes over an hour old when they were gridded, such as replayed data.",
                facts.not_live);
}

void write_cache(MetricsWriter& out, const StatusFacts& facts) {
    if (!facts.usage) return;
    const cache::StoreUsage& usage = *facts.usage;
    out.gauge("stormcellar_cache_bytes", "Bytes that the cache takes on disk.", usage.bytes);
    if (usage.budget_bytes) {
        out.gauge("stormcellar_cache_budget_bytes", "Bytes that the cache may take on disk.",
                  *usage.budget_bytes);
    }
    out.gauge("stormcellar_cache_grids", "Grids in the cache.", usage.grids);
    out.gauge("stormcellar_cache_pinned_grids", "Pinned grids in the cache.", usage.pinned);
    out.counter("stormcellar_cache_evicted_grids_total", "Grids that were evicted to make room.",
                usage.evicted);
    out.counter("stormcellar_cache_evicted_bytes_total", "Bytes that were evicted to make room.",
                usage.evicted_bytes);
    out.counter("stormcellar_cache_not_kept_grids_total",
                "Grids that were not kept because they are older than all that the limits keep.",
                usage.not_kept);
}

// Writes a family of metrics, with a sample for each station that has a value.
class PerStation {
  public:
    PerStation(MetricsWriter& out, const StationBook& book) : out_(out), book_(book) {}

    void age(const char* name, const char* help, std::optional<UtcTime> StationState::*time,
             UtcTime now) {
        write(name, Type::gauge, help, [&](const std::string& station, const StationState& state) {
            if (state.*time)
                out_.sample(seconds_between(*(state.*time), now), {{"station", station}});
        });
    }
    void count(const char* name, const char* help, std::uint64_t StationState::*counter) {
        write(name, Type::counter, help,
              [&](const std::string& station, const StationState& state) {
                  out_.sample(state.*counter, {{"station", station}});
              });
    }
    void timings(const char* name, const char* help, Timings StationState::*timings) {
        write(name, Type::summary, help,
              [&](const std::string& station, const StationState& state) {
                  out_.sample(state.*timings, {{"station", station}});
              });
    }
    template <class WriteOne>
    void write(const char* name, Type type, const char* help, WriteOne write_one) {
        if (book_.stations().empty()) return;
        out_.family(name, type, help);
        for (const auto& [station, state] : book_.stations())
            write_one(station, state);
    }

  private:
    MetricsWriter& out_;
    const StationBook& book_;
};

void write_station_files(MetricsWriter& out, PerStation& each) {
    each.write(
        "stormcellar_station_files_total", Type::counter, "Files of the station, by result.",
        [&](const std::string& station, const StationState& state) {
            for (const IngestResult result : {IngestResult::gridded, IngestResult::no_moment,
                                              IngestResult::no_position, IngestResult::rejected}) {
                out.sample(state.results.at(index_of(result)),
                           {{"station", station}, {"result", name_of(result)}});
            }
        });
}

// Returns the time of the newest data of any station. If nothing has arrived, returns the time at
// which the service started, so that a feed that is dead from the start also counts as silent.
UtcTime last_data(const StatusFacts& facts) {
    std::optional<UtcTime> last;
    for (const auto& [station, state] : facts.stations.stations())
        last = std::max(last, state.data_at);
    return last.value_or(facts.started);
}

void write_stations(MetricsWriter& out, const StatusFacts& facts, UtcTime now) {
    const StationBook& book = facts.stations;
    out.gauge("stormcellar_stations", "Stations that the daemon knows something of.",
              book.stations().size());
    out.counter("stormcellar_stations_left_out_total",
                "Files and chunks of stations beyond those that the daemon remembers.",
                book.left_out());
    out.gauge(
        "stormcellar_last_data_age_seconds",
        "Time since the daemon last looked at a file or chunk of any station, or since its start.",
        seconds_between(last_data(facts), now));
    PerStation each(out, book);
    each.age("stormcellar_station_last_volume_age_seconds",
             "Time since the start of the newest gridded volume, by the radar's clock.",
             &StationState::volume_time, now);
    each.age("stormcellar_station_last_radial_age_seconds",
             "Time since the newest gridded radial, by the radar's clock.",
             &StationState::newest_radial, now);
    each.age("stormcellar_station_last_ingest_age_seconds", "Time since a volume was last gridded.",
             &StationState::ingested_at, now);
    each.age("stormcellar_station_last_data_age_seconds",
             "Time since the daemon last looked at a file or chunk of the station.",
             &StationState::data_at, now);
    write_station_files(out, each);
    each.count("stormcellar_station_partial_volumes_total",
               "Gridded files of the station whose volume had not ended or was damaged.",
               &StationState::partial);
    each.count("stormcellar_station_missing_chunks_total",
               "Missing chunks of the station's volumes.", &StationState::missing_chunks);
    each.count("stormcellar_station_not_live_volumes_total",
               "Volumes of the station over an hour old when they were gridded.",
               &StationState::not_live);
    each.timings(
        "stormcellar_station_close_to_cache_seconds",
        "Time from the close of a file to its grids in the cache, over the last 128 files.",
        &StationState::close_to_cache);
    each.count("stormcellar_station_living_grids_total", "Living grids of the station.",
               &StationState::living);
    each.timings("stormcellar_station_close_to_living_seconds",
                 "Time from the close that completed a sweep to the grid that shows it.",
                 &StationState::close_to_living);
    each.timings("stormcellar_station_antenna_to_cache_seconds",
                 "Time from a volume's newest radial to its grids in the cache, for live data.",
                 &StationState::antenna_to_cache);
}

void write_sites(MetricsWriter& out, const StatusFacts& facts) {
    if (facts.sites.empty()) return;
    out.family("stormcellar_site_pair_faults", Type::gauge,
               "Faults found when site b was last compared with site a.");
    for (const auto& [key, report] : facts.sites) {
        out.sample(std::uint64_t{report.faults.size()},
                   {{"domain", key[0]}, {"a", key[1]}, {"b", key[2]}});
    }
    out.family("stormcellar_site_pair_bias_db", Type::gauge,
               "How much more site b shows than site a, if it could be determined.");
    for (const auto& [key, report] : facts.sites) {
        if (!report.found.bias_db.untold.empty()) continue;
        out.sample(report.found.bias_db.value, {{"domain", key[0]}, {"a", key[1]}, {"b", key[2]}});
    }
}

void write_machines(MetricsWriter& out, const StatusFacts& facts, UtcTime now) {
    if (facts.machines.empty()) return;
    const auto all = [&](const char* name, Type type, const char* help,
                         const std::function<std::uint64_t(const MachineFacts&)>& value) {
        out.family(name, type, help);
        for (const MachineFacts& machine : facts.machines)
            out.sample(value(machine), {{"machine", machine.name}});
    };
    const auto ages = [&](const char* name, const char* help,
                          std::optional<UtcTime> MachineFacts::*time) {
        out.family(name, Type::gauge, help);
        for (const MachineFacts& machine : facts.machines) {
            if (machine.*time)
                out.sample(seconds_between(*(machine.*time), now), {{"machine", machine.name}});
        }
    };
    all("stormcellar_machine_late", Type::gauge,
        "1 while the machine is late with its parts of mosaics.",
        [](const MachineFacts& machine) { return std::uint64_t{machine.is_late ? 1U : 0U}; });
    all("stormcellar_machine_partials_total", Type::counter,
        "Parts of mosaics that were taken from the machine.",
        [](const MachineFacts& machine) { return machine.taken; });
    all("stormcellar_machine_refused_total", Type::counter,
        "Files of the machine that are damaged, or no parts of a mosaic.",
        [](const MachineFacts& machine) { return machine.refused; });
    all("stormcellar_machine_replaced_total", Type::counter,
        "Parts of other machines that parts of the machine took the place of.",
        [](const MachineFacts& machine) { return machine.replaced; });
    ages("stormcellar_machine_last_arrival_age_seconds",
         "Time since the machine last brought something.", &MachineFacts::arrived);
    ages("stormcellar_machine_newest_volume_age_seconds",
         "Time since the middle of the newest volume of the machine.", &MachineFacts::newest);
}

void write_loops(MetricsWriter& out, const StatusFacts& facts) {
    const std::vector<LoopState>& loops = facts.loops.empty() ? facts.others_loops : facts.loops;
    if (loops.empty()) return;
    const auto all = [&](const char* name, Type type, const char* help,
                         const std::function<std::uint64_t(const LoopState&)>& value) {
        out.family(name, type, help);
        for (const LoopState& loop : loops)
            out.sample(value(loop), {{"loop", loop.name}});
    };
    all("stormcellar_loop_running", Type::gauge, "1 while the process of the loop runs.",
        [](const LoopState& loop) { return std::uint64_t{loop.is_running ? 1U : 0U}; });
    all("stormcellar_loop_restarts_total", Type::counter,
        "How often the process of the loop was started again.",
        [](const LoopState& loop) { return loop.restarts; });
    all("stormcellar_loop_made_total", Type::counter, "How often the loop was made.",
        [](const LoopState& loop) { return loop.made; });
    out.family("stormcellar_loop_last_made_seconds", Type::gauge,
               "When the loop was last made, in seconds since 1970.");
    for (const LoopState& loop : loops) {
        if (loop.last_made) out.sample(seconds_since_epoch(*loop.last_made), {{"loop", loop.name}});
    }
}

}  // namespace

std::string metrics_text(const StatusFacts& facts, const Pending& pending, UtcTime now) {
    MetricsWriter out;
    write_process(out, facts, pending);
    write_files(out, facts);
    write_cache(out, facts);
    write_stations(out, facts, now);
    write_sites(out, facts);
    write_machines(out, facts, now);
    write_loops(out, facts);
    return out.take();
}

}  // namespace stormcellar::daemon
