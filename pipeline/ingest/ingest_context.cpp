#include "pipeline/ingest/ingest_context.h"

#include <utility>
#include <vector>

#include "pipeline/drop/drop_names.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;

// This limit is small, because nearly all data of a volume in chunks are on disk.
constexpr std::uint64_t most_held_chunk_bytes = std::uint64_t{64} << 20;

// Returns all moments that are gridded, for sites or for domains.
std::vector<level2::Moment> moments_of(const IngestOptions& options) {
    std::vector<level2::Moment> moments = options.moments;
    for (const Domain& domain : options.domains)
        moments.insert(moments.end(), domain.moments.begin(), domain.moments.end());
    std::sort(moments.begin(), moments.end());
    moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
    return moments;
}

level2::Selection selection_of(const IngestOptions& options) {
    return decoded_for(moments_of(options), options.derived.quality);
}

FollowedFile::Options follow_options(const IngestOptions& options) {
    return {
        .selection = selection_of(options),
        .moments = options.moments,
        .fallback_station = {},
        .scratch = options.living.scratch,
        .beneath = options.beneath,
        .chunk_timeout = options.living.chunk_timeout,
        .chunk_grace = options.living.chunk_grace,
    };
}

GrowingLimits file_limits(const IngestOptions& options) {
    const level2::Selection selection = selection_of(options);
    GrowingLimits limits = GrowingLimits::of(
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size());
    limits.shelf_bytes = options.living.shelf_bytes;
    limits.count = options.living.count;
    limits.station_shelf_bytes = limits.shelf_bytes / 8;
    return limits;
}

bool grids_while_they_grow(const IngestOptions& options) {
    return options.living.make && !options.living.scratch.empty();
}

FollowedFile::Options file_options(const IngestOptions& options) {
    FollowedFile::Options follow = follow_options(options);
    follow.open_sweep_limit_bytes = file_limits(options).station_held_bytes;
    return follow;
}

GrowingLimits chunk_limits(const IngestOptions& options) {
    GrowingLimits limits = file_limits(options);
    limits.held_bytes = most_held_chunk_bytes;
    return limits;
}

}  // namespace

IngestContext::IngestContext(catalog::CatalogWriter& its_catalog, cache::StoreWriter* its_store,
                             IngestOptions its_options)
    : catalog(its_catalog),
      store(its_store),
      options(std::move(its_options)),
      mosaics(store, options.domains, options.frames, options.partial_sources),
      chunks(follow_options(options), chunk_limits(options)) {
    if (store == nullptr) return;
    site_grids.emplace(*store, options);
    if (grids_while_they_grow(options)) living.emplace(file_options(options), file_limits(options));
}

level2::DecodeOptions IngestContext::decode_options_for(const std::string& station) const {
    level2::DecodeOptions decode_options;
    decode_options.threads = share_of(options.decode_threads);
    decode_options.output_limit_bytes = options.most_output_bytes;
    decode_options.selection = selection_of(options);
    decode_options.array_limit_bytes = most_array_bytes(decode_options.selection);
    decode_options.fallback_station = station;
    return decode_options;
}

std::string IngestContext::taken_station(const std::string& station) const {
    if (station.empty() || !options.stations || options.stations->knows(station)) return station;
    return {};
}

void IngestContext::admit(const std::string& station) const {
    if (!station.empty() && options.stations) (void)options.stations->admits(station);
}

Status IngestContext::record(FileFacts facts) {
    facts.station = taken_station(facts.station);
    if (const auto registered = catalog.register_file(facts); !registered) {
        return pass_on(registered);
    }
    return {};
}

Result<IngestOutcome> IngestContext::reject(const FileFacts& facts, Error why,
                                            IngestOutcome outcome) {
    FileFacts rejected = facts;
    rejected.state = FileState::rejected;
    rejected.reason = std::move(why.message);
    if (Status stored = record(rejected); !stored) return pass_on(stored);
    outcome.ending = ended::Rejected{why.code};
    outcome.station = taken_station(facts.station);
    outcome.reason = rejected.reason;
    return outcome;
}

Result<IngestOutcome> IngestContext::reject_unread(const fs::path& path, const Error& why,
                                                   std::uint64_t size_bytes) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_name(path);
    facts.size_bytes = size_bytes;
    facts.modified_ns = catalog::never_read_ns;
    return reject(facts, why, {});
}

Result<IngestOutcome> IngestContext::wait_unread(FileFacts facts, IngestOutcome outcome) {
    if (Status noted = note_seen(std::move(facts)); !noted) return pass_on(noted);
    outcome.ending = ended::Incomplete{};
    return outcome;
}

Status IngestContext::note_seen(FileFacts facts) {
    const auto known = catalog.is_known(facts.path);
    if (!known) return pass_on(known);
    if (*known) return {};
    facts.station = taken_station(facts.station);
    facts.state = FileState::seen;
    return catalog.note_file(facts);
}

Status IngestContext::mark_gone(const fs::path& path) {
    if (living) living->forget(path);
    const auto marked = catalog.mark_gone(path);
    if (!marked) return pass_on(marked);
    return {};
}

FileFacts facts_unread(const fs::path& path, const FileStamp& stamp, std::string station) {
    FileFacts facts;
    facts.path = path;
    facts.station = std::move(station);
    facts.size_bytes = stamp.size_bytes;
    facts.modified_ns = stamp.modified_ns;
    return facts;
}

std::string station_of_name(const fs::path& path) {
    return is_chunk_name(path) ? station_of_path(path) : station_of_file_name(path);
}

std::string without_path(const std::string& message, const fs::path& path) {
    const std::string start = path.native() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

}  // namespace stormcellar::pipeline
