#include "pipeline/ingest/ingest.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "base/beneath.h"
#include "base/checksum.h"
#include "base/stopwatch.h"
#include "level2/decode/volume_checks.h"
#include "level2/messages/message_2.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/drop/read_whole.h"
#include "pipeline/ingest/ingest_parts.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;
using Clock = std::chrono::steady_clock;

// Nearly all of a volume of chunks lies on the shelf.
constexpr std::uint64_t most_held_chunk_bytes = std::uint64_t{64} << 20;

// A radar's file holds one, and one that somebody joined some hours. All are gridded in one job.
constexpr std::size_t most_volumes = 64;

bool has_moment(const level2::Volume& volume, level2::Moment moment) {
    return std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                       [&](const level2::Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

// All that anything is made of.
std::vector<level2::Moment> moments_of(const IngestOptions& options) {
    std::vector<level2::Moment> moments = {options.moment};
    for (const Domain& domain : options.domains)
        moments.insert(moments.end(), domain.moments.begin(), domain.moments.end());
    std::sort(moments.begin(), moments.end());
    moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
    return moments;
}

// The reason without the path that begins it: the catalog has the path beside it.
std::string without_path(const std::string& message, const fs::path& path) {
    const std::string start = path.native() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

// The row and the log say whose data stand among those of no known station.
std::string of_other_station(const std::string& station, const std::string& reason) {
    const std::string text = fmt::format("of {}, of which no data are taken in", station);
    return reason.empty() ? text : text + "; " + reason;
}

// A radar's record holds 120 radials at most.
constexpr std::size_t most_radials_of_a_chunk = 120;

bool is_lone_chunk(const level2::Decoded& decoded) {
    return !decoded.volume.header && decoded.report.ldm_records == 1U &&
           !decoded.volume.sweeps.empty() &&
           decoded.volume.radial_count() <= most_radials_of_a_chunk;
}

constexpr std::string_view lone_chunk_text =
    "looks like one chunk of a volume: chunks are put together where their names hold "
    "YYYYMMDD-HHMMSS-NUMBER-KIND or LDM's key";

// A chunk has it in the names of its directories, if at all.
std::string station_of_name(const fs::path& path) {
    return is_chunk_name(path) ? station_of_path(path) : station_of_file_name(path);
}

}  // namespace

Ingestor::Impl::Impl(catalog::CatalogWriter& its_catalog, cache::StoreWriter* its_store,
                     IngestOptions its_options)
    : catalog(its_catalog),
      store(its_store),
      options(std::move(its_options)),
      mosaics(store, options.domains, options.frames) {
    if (store != nullptr) site_grids.emplace(*store, options);
    LivingFile::Options follow{
        .selection = {moments_of(options), {}},
        .moment = options.moment,
        .fallback_station = {},
        .scratch = options.living.scratch,
        .beneath = options.beneath,
        .chunk_timeout = options.living.chunk_timeout,
        .chunk_grace = options.living.chunk_grace,
    };
    GrowingLimits limits = GrowingLimits::of(follow.selection.moments.size());
    limits.shelf_bytes = options.living.put_aside_bytes;
    limits.count = options.living.count;
    limits.station_shelf_bytes = limits.shelf_bytes / 8;
    if (store != nullptr && options.living.make && !options.living.scratch.empty()) {
        follow.open_sweep_limit_bytes = limits.station_held_bytes;
        living.emplace(follow, limits);
    }
    limits.held_bytes = most_held_chunk_bytes;
    chunks.emplace(follow, limits);
}

Ingestor::Ingestor(catalog::CatalogWriter& catalog, cache::StoreWriter& store,
                   IngestOptions options)
    : impl_(new Impl(catalog, &store, std::move(options))) {}
Ingestor::Ingestor(catalog::CatalogWriter& catalog, IngestOptions options)
    : impl_(new Impl(catalog, nullptr, std::move(options))) {}
Ingestor::~Ingestor() = default;

MosaicKeeper& Ingestor::mosaics() {
    return impl_->mosaics;
}

std::string Ingestor::Impl::taken_station(const std::string& station, Admit admit) const {
    if (station.empty() || !options.stations) return station;
    const bool is_taken =
        admit == Admit::yes ? options.stations->admits(station) : options.stations->knows(station);
    return is_taken ? station : std::string{};
}

Status Ingestor::Impl::record(FileFacts facts) {
    facts.station = taken_station(facts.station);
    if (const auto registered = catalog.register_file(facts); !registered) {
        return pass_on(registered);
    }
    return {};
}

Result<IngestOutcome> Ingestor::Impl::reject(const FileFacts& facts, Error why,
                                             IngestOutcome outcome) {
    FileFacts rejected = facts;
    rejected.state = FileState::rejected;
    rejected.reason = std::move(why.message);
    if (Status stored = record(rejected); !stored) return pass_on(stored);
    outcome.result = IngestResult::rejected;
    outcome.rejected_with = why.code;
    outcome.station = taken_station(facts.station);
    outcome.reason = rejected.reason;
    return outcome;
}

// With a stamp that settles nothing: after a restart the cause may be gone.
Result<IngestOutcome> Ingestor::Impl::give_up(const fs::path& path, const Error& why) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    if (const auto stamp = stamp_of(path, options.beneath)) facts.size_bytes = stamp->size_bytes;
    facts.modified_ns = catalog::never_read_ns;
    if (living) living->forget(path);
    auto rejected =
        reject(facts, {why.code, "given up: " + without_path(why.message, path)}, IngestOutcome{});
    // What failed, and not what failed while that was stored.
    return rejected ? std::move(rejected) : Result<IngestOutcome>{tl::unexpected<Error>(why)};
}

// It may not even be looked at: its directory has no permission. Tried again when it is offered.
Result<IngestOutcome> Ingestor::Impl::reject_unread(const fs::path& path, const Error& why) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    facts.modified_ns = catalog::never_read_ns;
    return reject(facts, {why.code, without_path(why.message, path)}, {});
}

// What a domain cannot use is no reason to reject the file, whose own grid stands.
Status Ingestor::Impl::keep_mosaics(const FileFacts& facts, const level2::Volume& volume,
                                    const Reading& reading, IngestOutcome& outcome) {
    const auto antenna = level2::antenna_position(volume);
    if (mosaics.is_idle() || !antenna || volume.station.empty()) return {};
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    VolumeSource source{volume, site, facts.path.filename().string()};
    source.modified_ns = believed_ns(facts.modified_ns);
    source.partial = reading.damaged || !level2::is_complete(volume);
    source.radar_troubles = reading.troubles_of(site.icao);
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    const auto start = Clock::now();
    const auto kept = mosaics.take_in(source, share_of(options.grid_threads));
    outcome.mosaic_s += seconds_since(start);
    if (!kept) {
        if (kept.error().cause() != Cause::data) return pass_on(kept);
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
    std::string other;
    for (const level2::Volume& volume : volumes) {
        if (store == nullptr) continue;
        if (!volume.station.empty() && taken_station(volume.station).empty()) {
            other = volume.station;
            continue;
        }
        if (!volume.start_time()) {
            return reject(facts,
                          {ErrorCode::corrupt, "cannot be gridded: no time in it is plausible"},
                          outcome);
        }
        if (!options.own_grids) {
            (void)SiteGrids::has_place(volume, outcome);
        } else if (has_moment(volume, options.moment)) {
            const bool partial = reading.damaged || !level2::is_complete(volume);
            const GridSource source{facts.path.filename().string(), believed_ns(facts.modified_ns),
                                    partial, reading.troubles_of(volume.station)};
            const Status gridded =
                site_grids->keep(volume, source, share_of(options.grid_threads), outcome);
            if (!gridded) {
                if (gridded.error().cause() != Cause::data) return pass_on(gridded);
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
    if (outcome.result == IngestResult::no_moment && !other.empty())
        outcome.result = IngestResult::other_station;
    if (Status stored = record(facts); !stored) return pass_on(stored);
    return outcome;
}

Result<IngestOutcome> Ingestor::Impl::take_in(FileFacts facts, level2::Decoded decoded,
                                              bool finish_partial, IngestOutcome outcome) {
    facts.reason = reason_of(decoded.report);
    outcome.lone_chunk = is_lone_chunk(decoded);
    if (outcome.lone_chunk) {
        facts.reason =
            fmt::format("{}{}{}", lone_chunk_text, facts.reason.empty() ? "" : "; ", facts.reason);
    }
    const bool complete = decoded.report.complete;
    Reading reading{decoded.report.damaged, {}};
    if (decoded.report.rda_status) {
        reading.troubles = level2::rda_troubles(*decoded.report.rda_status);
    }
    const std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    if (volumes.size() > most_volumes) {
        const std::string reason = fmt::format("holds {} volumes, and a raw file may hold {}",
                                               volumes.size(), most_volumes);
        return reject(facts, {ErrorCode::unsupported, reason}, std::move(outcome));
    }
    for (const level2::Volume& volume : volumes) {
        if (volume.radial_count() == 0) continue;  // metadata alone are no volume
        facts.volumes.push_back(facts_of(volume, reading.damaged));
        outcome.newest_radial = std::max(outcome.newest_radial, facts.volumes.back().end_time);
    }
    for (const level2::Volume& volume : volumes)
        (void)taken_station(volume.station, Admit::yes);
    if (!volumes.empty()) {
        facts.station = volumes.front().station;
        outcome.volume_time = volumes.front().start_time();
    }
    outcome.station = taken_station(facts.station);
    if (!facts.station.empty() && outcome.station.empty())
        facts.reason = of_other_station(facts.station, facts.reason);
    outcome.reason = facts.reason;

    facts.state = FileState::seen;
    if (Status stored = record(facts); !stored) return pass_on(stored);
    const bool ended = !volumes.empty() && level2::has_ended(volumes.back());
    if (!ended && !finish_partial) {
        outcome.result = IngestResult::incomplete;
        return outcome;
    }
    facts.state = complete ? FileState::complete : FileState::partial;
    if (facts.volumes.empty()) {
        outcome.result = store == nullptr ? IngestResult::registered : IngestResult::no_moment;
        if (Status stored = record(facts); !stored) return pass_on(stored);
        return outcome;
    }
    return grid_all(facts, volumes, reading, std::move(outcome));
}

Status Ingestor::Impl::mark_gone(const fs::path& path) {
    if (living) living->forget(path);
    const auto marked = catalog.mark_gone(path);
    if (!marked) return pass_on(marked);
    return {};
}

Finish Ingestor::Impl::finish_of(bool finish_partial) const {
    if (!finish_partial) return Finish::when_it_ends;
    // Nobody who has nowhere to put things aside comes again when it has been quiet.
    return options.living.scratch.empty() ? Finish::as_it_is : Finish::when_quiet;
}

Result<IngestOutcome> Ingestor::ingest(const fs::path& path, bool finish_partial, Tries tries) {
    const Running running(impl_->running);
    auto outcome = impl_->ingest(path, finish_partial);
    if (outcome || tries == Tries::more_follow || is_shortage(outcome.error().code)) return outcome;
    return impl_->give_up(path, outcome.error());
}

Result<IngestOutcome> Ingestor::Impl::ingest(const fs::path& path, bool finish_partial) {
    IngestOutcome outcome;
    const auto before = stamp_of(path, options.beneath);
    if (!before) {
        const ErrorCode code = before.error().code;
        if (code == ErrorCode::permission) return reject_unread(path, before.error());
        if (code != ErrorCode::not_found) return pass_on(before);
        if (Status marked = mark_gone(path); !marked) return pass_on(marked);
        outcome.result = IngestResult::vanished;
        const auto gone = chunks ? ChunkPath::of(path) : std::nullopt;
        if (!gone) return outcome;
        auto taken = take_gone_chunk(*gone, finish_of(finish_partial), outcome);
        return taken ? std::move(*taken) : outcome;
    }
    const auto settled = catalog.is_settled(path, before->size_bytes, before->modified_ns);
    if (!settled) return pass_on(settled);
    if (*settled) {
        outcome.result = IngestResult::unchanged;
        return outcome;
    }
    if (before->size_bytes > options.most_file_bytes) {
        if (living) living->forget(path);
        return read_and_take_in(path, *before, finish_partial, std::move(outcome));
    }
    const auto chunk = chunks ? ChunkPath::of(path) : std::nullopt;
    if (chunk) {
        const Finish finish = finish_of(finish_partial);
        if (auto taken = take_chunk(*chunk, *before, finish, outcome)) return std::move(*taken);
    }
    if (auto followed = follow(path, *before, finish_partial, outcome)) {
        return std::move(*followed);
    }
    return read_and_take_in(path, *before, finish_partial, std::move(outcome));
}

Result<IngestResult> Ingestor::note(const fs::path& path) {
    const auto stamp = stamp_of(path, impl_->options.beneath);
    if (!stamp && stamp.error().code == ErrorCode::not_found) {
        if (Status marked = impl_->mark_gone(path); !marked) return pass_on(marked);
        // There is still something to do: ingest().
        return impl_->is_waited_for(path) ? IngestResult::registered : IngestResult::vanished;
    }
    if (!stamp || !stamp->regular) return IngestResult::registered;  // refused when it is taken in
    const auto known = impl_->catalog.is_known(path);
    if (!known) return pass_on(known);
    if (*known) return IngestResult::registered;
    FileFacts facts;
    facts.path = path;
    facts.station = impl_->taken_station(station_of_path(path));
    facts.size_bytes = stamp->size_bytes;
    facts.modified_ns = stamp->modified_ns;
    facts.state = FileState::seen;
    if (Status noted = impl_->catalog.note_file(facts); !noted) return pass_on(noted);
    return IngestResult::registered;
}

Result<IngestOutcome> Ingestor::ingest_again(const fs::path& path, const ReadCheck& is_the_same) {
    const Running running(impl_->running);
    const auto before = stamp_of(path, impl_->options.beneath);
    if (!before && before.error().code == ErrorCode::not_found) {
        for (const MemberName& name : member_names_in(path)) {
            const auto stamp = stamp_of(name.archive, impl_->options.beneath);
            if (stamp && stamp->regular) return impl_->take_member_again(name, *stamp, is_the_same);
        }
    }
    if (!before) return pass_on(before);
    if (const auto chunk = impl_->chunks ? ChunkPath::of(path) : std::nullopt) {
        impl_->chunks->forget(*chunk);
        if (auto taken = impl_->take_chunk(*chunk, *before, Finish::as_it_is, {}, is_the_same))
            return std::move(*taken);
    }
    return impl_->read_and_take_in(path, *before, true, {}, is_the_same);
}

level2::DecodeOptions Ingestor::Impl::decode_options_for(const std::string& station) {
    level2::DecodeOptions decode_options;
    decode_options.threads = share_of(options.decode_threads);
    decode_options.output_limit_bytes = options.most_output_bytes;
    decode_options.selection = {moments_of(options), {}};
    decode_options.array_limit_bytes = most_array_bytes(decode_options.selection);
    decode_options.fallback_station = station;
    return decode_options;
}

Result<IngestOutcome> Ingestor::Impl::read_and_take_in(const fs::path& path,
                                                       const FileStamp& before, bool finish_partial,
                                                       IngestOutcome outcome,
                                                       const ReadCheck& is_the_same) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    facts.size_bytes = before.size_bytes;
    facts.modified_ns = before.modified_ns;
    if (!before.regular) {
        return reject(facts,
                      {ErrorCode::not_a_file, fmt::format("is {}", kind_of_file(before.kind))},
                      outcome);
    }
    // Chunks are never archives, and come in their thousands.
    if (!is_the_same && before.size_bytes > 0 && !is_chunk_name(path)) {
        if (auto taken = take_archive(path, before, finish_partial, outcome)) {
            return std::move(*taken);
        }
    }
    if (before.size_bytes > options.most_file_bytes) {
        return reject(
            facts,
            {ErrorCode::unsupported, fmt::format("{} bytes, and a raw file may have {}: not read",
                                                 before.size_bytes, options.most_file_bytes)},
            outcome);
    }
    const level2::DecodeOptions decode_options = decode_options_for(facts.station);
    auto read = read_whole(options.beneath, path, before.size_bytes, decode_options);
    outcome.read_s = read.read_s;
    outcome.decode_s = read.decode_s;
    const auto after = stamp_of(path, options.beneath);
    if (!after || *after != before) {
        outcome.result = IngestResult::incomplete;
        outcome.reason = "changed while it was read";
        return outcome;
    }
    if (!read.was_read) {
        const ErrorCode code = read.was_read.error().code;
        // The system is short of something, such as descriptors: the file is not to blame.
        if (code == ErrorCode::io || is_shortage(code)) return pass_on(read.was_read);
        if (code == ErrorCode::permission) facts.modified_ns = catalog::never_read_ns;
        return reject(facts, {code, without_path(read.was_read.error().message, path)}, outcome);
    }
    facts.content_hash = read.content_hash;
    if (is_the_same) {
        const Status same = is_the_same(path, before.size_bytes, facts.content_hash);
        if (!same) return pass_on(same);
    }
    if (options.check_read) {
        const Status wanted = options.check_read(path, before.size_bytes, facts.content_hash);
        if (!wanted) {
            const Error& why = wanted.error();
            return reject(facts, {why.code, without_path(why.message, path)}, outcome);
        }
    }
    auto& decoded = read.decoded;
    if (!decoded) {
        const ErrorCode code = decoded.error().code;
        if (is_shortage(code)) return pass_on(decoded);
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
