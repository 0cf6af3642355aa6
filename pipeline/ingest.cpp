#include "pipeline/ingest.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/ranges.h>

#include "base/checksum.h"
#include "base/file_system.h"
#include "level2/decode.h"
#include "level2/message_2.h"
#include "level2/volume_checks.h"
#include "pipeline/file_facts.h"
#include "pipeline/living_files.h"
#include "pipeline/mosaic_keeper.h"
#include "pipeline/site_grids.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;
using Clock = std::chrono::steady_clock;

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

// All that anything is made of.
std::vector<level2::Moment> moments_of(const IngestOptions& options) {
    std::vector<level2::Moment> moments = {options.moment};
    for (const Domain& domain : options.domains)
        moments.insert(moments.end(), domain.moments.begin(), domain.moments.end());
    return moments;
}

// The reason without the path that begins it: the catalog has the path beside it.
std::string without_path(const std::string& message, const fs::path& path) {
    const std::string start = path.native() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
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
          mosaics(store, options.domains, options.frames) {
        if (store == nullptr) return;
        site_grids.emplace(*store, options);
        if (!options.living.scratch.empty()) {
            living.emplace(LivingFile::Options{
                .selection = {moments_of(options), {}},
                .moment = options.moment,
                .fallback_station = {},
                .scratch = options.living.scratch,
            });
        }
    }

    catalog::Catalog& catalog;
    const cache::Store* store;  // none: files are only registered
    IngestOptions options;
    MosaicKeeper mosaics;
    std::optional<SiteGrids> site_grids;  // where there is a cache
    std::optional<LivingFiles> living;    // where files are followed as they grow
    std::atomic<int> running{0};

    Result<IngestOutcome> read_and_take_in(const fs::path& path, const FileStamp& before,
                                           bool finish_partial, IngestOutcome outcome);
    Result<IngestOutcome> reject(const FileFacts& facts, std::string reason, IngestOutcome outcome);
    Result<IngestOutcome> take_in(FileFacts facts, level2::Decoded decoded, bool finish_partial,
                                  IngestOutcome outcome);
    Result<IngestOutcome> grid_all(const FileFacts& facts,
                                   const std::vector<level2::Volume>& volumes,
                                   const Reading& reading, IngestOutcome outcome);
    Status keep_mosaics(const FileFacts& facts, const level2::Volume& volume,
                        const Reading& reading, IngestOutcome& outcome);
    std::optional<Result<IngestOutcome>> follow(const fs::path& path, const FileStamp& before,
                                                bool finish_partial, IngestOutcome outcome);
    Result<IngestOutcome> show_living(const FileFacts& file, LivingFile& living_file,
                                      IngestOutcome outcome);
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

Result<IngestOutcome> Ingestor::Impl::reject(const FileFacts& facts, std::string reason,
                                             IngestOutcome outcome) {
    FileFacts rejected = facts;
    rejected.state = FileState::rejected;
    rejected.reason = std::move(reason);
    if (const auto registered = catalog.register_file(rejected); !registered) {
        return pass_on(registered);
    }
    outcome.result = IngestResult::rejected;
    outcome.station = facts.station;
    outcome.reason = rejected.reason;
    return outcome;
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

// Grids first, then settles the catalog's row: a crash between the two makes the work be done
// again, never lost.
Result<IngestOutcome> Ingestor::Impl::grid_all(const FileFacts& facts,
                                               const std::vector<level2::Volume>& volumes,
                                               const Reading& reading, IngestOutcome outcome) {
    outcome.result = store == nullptr ? IngestResult::registered : IngestResult::no_moment;
    for (const level2::Volume& volume : volumes) {
        if (store == nullptr) continue;
        if (!options.own_grids) {
            (void)SiteGrids::has_place(volume, outcome);
        } else if (has_moment(volume, options.moment)) {
            const bool partial = reading.damaged || !level2::is_complete(volume);
            const GridSource source{facts.path.filename().string(), facts.modified_ns, partial,
                                    reading.troubles_of(volume.station)};
            const Status gridded =
                site_grids->keep(volume, source, share_of(options.grid_threads), outcome);
            if (!gridded) {
                if (!is_of_the_data(gridded.error())) return pass_on(gridded);
                return reject(facts, "cannot be gridded: " + gridded.error().message, outcome);
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
    for (const level2::Volume& volume : volumes)
        facts.volumes.push_back(facts_of(volume));
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

// What has come of a volume that has not ended: for the catalog, and as a living grid.
Result<IngestOutcome> Ingestor::Impl::show_living(const FileFacts& file, LivingFile& living_file,
                                                  IngestOutcome outcome) {
    outcome.result = IngestResult::incomplete;
    outcome.followed = true;
    const KeptVolume& kept = living_file.kept();
    if (!living_file.has_news() || living_file.holds_several()) return outcome;
    FileFacts facts = file;
    facts.station = kept.facts.station;
    facts.content_hash = living_file.content_hash();
    facts.state = FileState::seen;
    catalog::VolumeFacts volume_facts = facts_of(kept.facts);
    volume_facts.sweep_count = static_cast<int>(kept.places.size());
    volume_facts.radial_count = static_cast<int>(living_file.radials());
    volume_facts.end_time = living_file.newest();
    facts.volumes.push_back(volume_facts);
    if (const auto registered = catalog.register_file(facts); !registered) {
        return pass_on(registered);
    }
    outcome.station = facts.station;
    outcome.volume_time = volume_facts.start_time;
    if (!options.own_grids || (options.living.has_time && !options.living.has_time())) {
        return outcome;  // with the next sweep, or when the volume has ended
    }
    living_file.set_shown();
    const auto last = living->last_of(kept.facts.station);
    std::size_t standing = 0;
    const auto volume = living_volume(kept, last.get(), &standing);
    if (!volume) return outcome;
    GridSource source{facts.path.filename().string(), facts.modified_ns, true};
    source.notes.push_back(fmt::format("living: {} sweeps have come, {} of the last volume stand",
                                       volume->sweeps.size() - standing, standing));
    const Status shown =
        site_grids->keep_living(*volume, source, share_of(options.grid_threads), outcome);
    if (!shown && !is_of_the_data(shown.error())) return pass_on(shown);
    return outcome;
}

// None: the file is to be read as a whole.
std::optional<Result<IngestOutcome>> Ingestor::Impl::follow(const fs::path& path,
                                                            const FileStamp& before,
                                                            bool finish_partial,
                                                            IngestOutcome outcome) {
    if (!living || !before.regular) return std::nullopt;
    std::shared_ptr<LivingFile> file = living->find(path);
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    facts.size_bytes = before.size_bytes;
    facts.modified_ns = before.modified_ns;
    if (!file && !finish_partial && LivingFile::is_growing(path)) {
        file = living->begin(path, facts.station);
    }
    if (!file) return std::nullopt;
    const auto start = Clock::now();
    const bool has_ended = file->read_to(before.size_bytes) && file->has_ended();
    outcome.decode_s = seconds_since(start);
    if (!file->is_whole()) {
        living->forget(path);
        return std::nullopt;
    }
    living->grew(path, *file);
    if (!has_ended && !finish_partial) return show_living(facts, *file, std::move(outcome));
    living->forget(path);
    facts.content_hash = file->content_hash();
    auto decoded = file->finish();
    outcome.decode_s = seconds_since(start);
    if (!decoded) return std::nullopt;
    auto taken = take_in(std::move(facts), std::move(*decoded), finish_partial, outcome);
    if (taken) living->keep_last(file->take_kept());
    return taken;
}

Result<IngestOutcome> Ingestor::ingest(const fs::path& path, bool finish_partial) {
    const Running running(impl_->running);
    IngestOutcome outcome;
    const auto before = stamp_of(path);
    if (!before) {
        if (before.error().code != ErrorCode::not_found) return pass_on(before);
        if (impl_->living) impl_->living->forget(path);
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
    if (auto followed = impl_->follow(path, *before, finish_partial, outcome)) {
        return std::move(*followed);
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
    if (!before.regular) return reject(facts, "is not a regular file", outcome);
    const auto read_start = Clock::now();
    const auto bytes = read_file(path);
    outcome.read_s = seconds_since(read_start);
    const auto after = stamp_of(path);
    if (!bytes && after) {
        const ErrorCode code = bytes.error().code;
        // Ours for now, as when descriptors run out: the file is not to blame.
        if (code == ErrorCode::io || code == ErrorCode::no_space) return pass_on(bytes);
        if (code == ErrorCode::permission) facts.modified_ns = catalog::never_read_ns;
        return reject(facts, without_path(bytes.error().message, path), outcome);
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
        return reject(facts, decoded.error().message, outcome);
    }
    return take_in(std::move(facts), std::move(*decoded), finish_partial, outcome);
}

}  // namespace stormcellar::pipeline
