#include "pipeline/ingest.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/ranges.h>

#include "base/checksum.h"
#include "base/file_system.h"
#include "grid/audit.h"
#include "grid/brick_grid.h"
#include "grid/column_geometry.h"
#include "grid/position_error.h"
#include "level2/decode.h"
#include "level2/message_2.h"
#include "level2/volume_checks.h"
#include "pipeline/file_facts.h"
#include "pipeline/geometry_cache.h"
#include "pipeline/keep_rule.h"
#include "pipeline/mosaic_keeper.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;
using Clock = std::chrono::steady_clock;

// A geometry of the default grid takes a few MiB.
constexpr std::size_t kept_geometries = 16;

// Counts a file in while it is worked on.
class Running {
  public:
    explicit Running(std::atomic<int>& count) : count_(count) { ++count_; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { --count_; }

  private:
    std::atomic<int>& count_;
};

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool has_moment(const level2::Volume& volume, level2::Moment moment) {
    return std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                       [&](const level2::Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

// The reason without the path that begins it: the catalog has the path beside it.
std::string without_path(const std::string& message, const fs::path& path) {
    const std::string start = path.native() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

void note_position(const level2::Volume& volume, IngestOutcome& outcome) {
    if (level2::antenna_position(volume) && !volume.station.empty()) return;
    outcome.result = IngestResult::no_position;
    outcome.reason = "neither the file nor the station table says where the radar stands";
}

void note_not_kept(IngestOutcome& outcome) {
    ++outcome.not_kept;
    outcome.reason = "older than what the cache keeps";
}

// Whether another try cannot help: the fault lies in what the file says.
bool is_of_the_data(const Error& error) {
    return error.code == ErrorCode::bad_argument || error.code == ErrorCode::corrupt ||
           error.code == ErrorCode::unsupported;
}

// What was met in reading a file, in any of its volumes.
struct Reading {
    bool damaged = false;                    // bytes are lost
    std::vector<std::string> troubles = {};  // of the radar, by its last message 2

    // As grids keep them.
    [[nodiscard]] std::vector<std::string> troubles_of(const std::string& station) const {
        if (troubles.empty()) return {};
        return {fmt::format("{}: {}", station, fmt::join(troubles, ", "))};
    }
};

}  // namespace

struct Ingestor::Impl {
    Impl(catalog::Catalog& its_catalog, const cache::Store* its_store, IngestOptions its_options)
        : catalog(its_catalog),
          store(its_store),
          options(std::move(its_options)),
          mosaics(store, options.domains, options.frames) {}

    catalog::Catalog& catalog;
    const cache::Store* store;  // none: files are only registered
    IngestOptions options;
    GeometryCache geometries{kept_geometries};
    MosaicKeeper mosaics;
    std::atomic<int> running{0};
    std::array<std::mutex, 16>
        commits;  // one at a time for each grid file, by the hash of its path

    Result<IngestOutcome> read_and_take_in(const fs::path& path, const FileStamp& before,
                                           bool finish_partial, IngestOutcome outcome);
    Result<IngestOutcome> reject(const FileFacts& facts, Error why, IngestOutcome outcome);
    Result<IngestOutcome> take_in(FileFacts facts, level2::Decoded decoded, bool finish_partial,
                                  IngestOutcome outcome);
    Result<IngestOutcome> grid_all(const FileFacts& facts,
                                   const std::vector<level2::Volume>& volumes,
                                   const Reading& reading, IngestOutcome outcome);
    Status grid_one(const FileFacts& facts, const level2::Volume& volume, const Reading& reading,
                    IngestOutcome& outcome);
    Result<fs::path> commit(grid::Grid& made, const level2::Volume& volume,
                            const grid::GridderOptions& gridder, IngestOutcome& outcome);
    Status keep_mosaics(const FileFacts& facts, const level2::Volume& volume,
                        const Reading& reading, IngestOutcome& outcome);
    [[nodiscard]] int share_of(int threads) const { return std::max(1, threads / running.load()); }
};

Ingestor::Ingestor(catalog::Catalog& catalog, const cache::Store& store, IngestOptions options)
    : impl_(new Impl(catalog, &store, std::move(options))) {}
Ingestor::Ingestor(catalog::Catalog& catalog, IngestOptions options)
    : impl_(new Impl(catalog, nullptr, std::move(options))) {}
Ingestor::~Ingestor() = default;

MosaicKeeper& Ingestor::mosaics() {
    return impl_->mosaics;
}

Result<IngestOutcome> Ingestor::Impl::reject(const FileFacts& facts, Error why,
                                             IngestOutcome outcome) {
    FileFacts rejected = facts;
    rejected.state = FileState::rejected;
    rejected.reason = std::move(why.message);
    if (const auto registered = catalog.register_file(rejected); !registered) {
        return pass_on(registered);
    }
    outcome.result = IngestResult::rejected;
    outcome.rejected_with = why.code;
    outcome.station = facts.station;
    outcome.reason = rejected.reason;
    return outcome;
}

// Grids one volume and commits it. A volume whose radar nobody can place has no grid.
Status Ingestor::Impl::grid_one(const FileFacts& facts, const level2::Volume& volume,
                                const Reading& reading, IngestOutcome& outcome) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna || volume.station.empty()) {
        note_position(volume, outcome);
        return {};
    }
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    const UtcTime time = volume.start_time().value_or(UtcTime{});
    if (!store->would_keep(site.icao, options.moment, time)) {
        note_not_kept(outcome);
        return {};
    }
    spec.spacing_m = options.spacing_m;
    spec.nx = options.nx;
    spec.ny = options.ny;
    if (!options.levels_m.empty()) spec.levels_m = options.levels_m;

    const auto start = Clock::now();
    const auto geometry = geometries.get(site, spec);
    if (!geometry) return pass_on(geometry);
    grid::GridderOptions gridder;
    gridder.moment = options.moment;
    gridder.threads = share_of(options.grid_threads);
    auto made = grid::make_grid(volume, site, **geometry, gridder);
    if (!made) return pass_on(made);
    made->provenance.predicted_error =
        grid::unplanned_error(volume, site, spec, (*geometry)->frame_kind(), gridder);
    made->provenance.source_files = {facts.path.filename().string()};
    made->provenance.source_modified_ns = facts.modified_ns;
    made->provenance.partial = reading.damaged || !level2::is_complete(volume);
    made->provenance.radar_troubles = reading.troubles_of(site.icao);
    if (antenna->disagreement) made->provenance.notes.push_back(*antenna->disagreement);
    outcome.grid_s += seconds_since(start);
    outcome.partial = outcome.partial || made->provenance.partial;

    const auto commit_start = Clock::now();
    auto path = commit(*made, volume, gridder, outcome);
    outcome.commit_s += seconds_since(commit_start);
    if (!path) return pass_on(path);
    if (path->empty()) {
        note_not_kept(outcome);
    } else {
        outcome.grids.push_back(std::move(*path));
    }
    return {};
}

// What a domain cannot use is no reason to reject the file, whose own grid stands.
Status Ingestor::Impl::keep_mosaics(const FileFacts& facts, const level2::Volume& volume,
                                    const Reading& reading, IngestOutcome& outcome) {
    const auto antenna = level2::antenna_position(volume);
    if (mosaics.is_idle() || !antenna || volume.station.empty()) return {};
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    VolumeSource source{volume, site, facts.path.filename().string()};
    source.modified_ns = facts.modified_ns;
    source.partial = reading.damaged || !level2::is_complete(volume);
    source.radar_troubles = reading.troubles_of(site.icao);
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    const auto start = Clock::now();
    const auto kept = mosaics.take_in(source, share_of(options.grid_threads));
    outcome.mosaic_s += seconds_since(start);
    if (!kept) {
        if (!is_of_the_data(kept.error())) return pass_on(kept);
        outcome.reason = "in no mosaic: " + kept.error().message;
        return {};
    }
    outcome.partials.insert(outcome.partials.end(), kept->partials.begin(), kept->partials.end());
    if (!kept->problems.empty()) outcome.reason = "left out: " + kept->problems.front();
    outcome.frames.insert(outcome.frames.end(), kept->frames.begin(), kept->frames.end());
    return {};
}

// A grid that cannot be audited is as good as others: nothing is known of it then.
Result<fs::path> Ingestor::Impl::commit(grid::Grid& made, const level2::Volume& volume,
                                        const grid::GridderOptions& gridder,
                                        IngestOutcome& outcome) {
    const std::string& domain = made.sites.front().icao;
    auto path = store->path_of(domain, made.moment, made.time);
    if (!path) return path;
    const auto bricks = grid::BrickGrid::from(made, grid::default_quantization(options.moment));
    const auto audited = grid::audit(bricks.view(), volume, made.sites.front(), gridder);
    if (audited) made.provenance.audit = audited->rows;
    const std::scoped_lock lock(commits.at(fs::hash_value(*path) % commits.size()));
    if (auto reason = reason_to_keep(*path, cache::describe(made))) {
        outcome.reason = std::move(*reason);
        return path;
    }
    return store->commit(domain, cache::describe(made), bricks.view());
}

// Grids first, then settles the catalog's row: a crash between the two makes the work be done
// again, never lost.
Result<IngestOutcome> Ingestor::Impl::grid_all(const FileFacts& facts,
                                               const std::vector<level2::Volume>& volumes,
                                               const Reading& reading, IngestOutcome outcome) {
    outcome.result = store == nullptr ? IngestResult::registered : IngestResult::no_moment;
    for (const level2::Volume& volume : volumes) {
        if (store == nullptr) continue;
        if (!options.own_grids) {
            note_position(volume, outcome);
        } else if (has_moment(volume, options.moment)) {
            if (const Status gridded = grid_one(facts, volume, reading, outcome); !gridded) {
                if (!is_of_the_data(gridded.error())) return pass_on(gridded);
                const Error& why = gridded.error();
                return reject(facts, {why.code, "cannot be gridded: " + why.message}, outcome);
            }
        }
        if (const Status kept = keep_mosaics(facts, volume, reading, outcome); !kept) {
            return pass_on(kept);
        }
    }
    const bool some_partial = !options.own_grids && !outcome.partials.empty();
    if (!outcome.grids.empty() || some_partial || outcome.not_kept > 0)
        outcome.result = IngestResult::gridded;
    if (const auto registered = catalog.register_file(facts); !registered) {
        return pass_on(registered);
    }
    return outcome;
}

Result<IngestOutcome> Ingestor::Impl::take_in(FileFacts facts, level2::Decoded decoded,
                                              bool finish_partial, IngestOutcome outcome) {
    facts.reason = reason_of(decoded.report);
    const bool complete = decoded.report.complete;
    Reading reading{decoded.report.bytes_dropped > 0, {}};
    if (decoded.report.rda_status) {
        reading.troubles = level2::rda_troubles(*decoded.report.rda_status);
    }
    const std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    for (const level2::Volume& volume : volumes) {
        facts.volumes.push_back(facts_of(volume));
        outcome.newest_radial = std::max(outcome.newest_radial, facts.volumes.back().end_time);
    }
    if (!volumes.empty()) {
        facts.station = volumes.front().station;
        outcome.volume_time = volumes.front().start_time();
    }
    outcome.station = facts.station;
    outcome.reason = facts.reason;

    facts.state = FileState::seen;
    if (const auto registered = catalog.register_file(facts); !registered) {
        return pass_on(registered);
    }
    const bool ended = !volumes.empty() && level2::has_ended(volumes.back());
    if (!ended && !finish_partial) {
        outcome.result = IngestResult::incomplete;
        return outcome;
    }
    facts.state = complete ? FileState::complete : FileState::partial;
    return grid_all(facts, volumes, reading, std::move(outcome));
}

Result<IngestOutcome> Ingestor::ingest(const fs::path& path, bool finish_partial) {
    const Running running(impl_->running);
    IngestOutcome outcome;
    const auto before = stamp_of(path);
    if (!before) {
        if (before.error().code != ErrorCode::not_found) return pass_on(before);
        if (const auto marked = impl_->catalog.mark_gone(path); !marked) return pass_on(marked);
        outcome.result = IngestResult::vanished;
        return outcome;
    }
    const auto settled = impl_->catalog.is_settled(path, before->size_bytes, before->modified_ns);
    if (!settled) return pass_on(settled);
    if (*settled) {
        outcome.result = IngestResult::unchanged;
        return outcome;
    }
    return impl_->read_and_take_in(path, *before, finish_partial, std::move(outcome));
}

Result<IngestOutcome> Ingestor::ingest_again(const fs::path& path) {
    const Running running(impl_->running);
    const auto before = stamp_of(path);
    if (!before) return pass_on(before);
    return impl_->read_and_take_in(path, *before, true, {});
}

Result<IngestOutcome> Ingestor::Impl::read_and_take_in(const fs::path& path,
                                                       const FileStamp& before, bool finish_partial,
                                                       IngestOutcome outcome) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    facts.size_bytes = before.size_bytes;
    facts.modified_ns = before.modified_ns;
    if (!before.regular) {
        return reject(facts, {ErrorCode::not_a_file, "is not a regular file"}, outcome);
    }
    const auto read_start = Clock::now();
    const auto bytes = read_file(path);
    outcome.read_s = seconds_since(read_start);
    const auto after = stamp_of(path);
    if (!bytes && after) {
        const ErrorCode code = bytes.error().code;
        // Ours for now, as when descriptors run out: the file is not to blame.
        if (code == ErrorCode::io || code == ErrorCode::no_space) return pass_on(bytes);
        if (code == ErrorCode::permission) facts.modified_ns = catalog::never_read_ns;
        return reject(facts, {code, without_path(bytes.error().message, path)}, outcome);
    }
    if (!bytes || !after || *after != before) {
        outcome.result = IngestResult::incomplete;
        outcome.reason = "changed while it was read";
        return outcome;
    }
    facts.content_hash = xxh3_64(*bytes);

    const auto decode_start = Clock::now();
    level2::DecodeOptions decode_options;
    decode_options.threads = share_of(options.decode_threads);
    decode_options.fallback_station = facts.station;
    auto decoded = level2::decode(*bytes, decode_options);
    outcome.decode_s = seconds_since(decode_start);
    if (!decoded) {
        const ErrorCode code = decoded.error().code;
        if (!finish_partial && (code == ErrorCode::empty || code == ErrorCode::truncated)) {
            outcome.result = IngestResult::incomplete;  // there may be more to come
            outcome.reason = decoded.error().message;
            return outcome;
        }
        return reject(facts, decoded.error(), outcome);
    }
    return take_in(std::move(facts), std::move(*decoded), finish_partial, outcome);
}

}  // namespace stormcellar::pipeline
