#include "pipeline/ingest/chunk_volumes.h"

#include <algorithm>
#include <utility>

#include "pipeline/drop/drop_names.h"
#include "pipeline/options/ingest_options.h"

namespace stormcellar::pipeline {
namespace {

// Limit of the remembered volumes without a place. Beyond the limit, all of these are forgotten.
constexpr std::size_t most_representatives = 4096;

}  // namespace

bool ChunkVolumes::may_be_due(const ChunkPath& chunk) const {
    const auto beside = chunks_beside(chunk, options_.beneath);
    if (!beside) return true;  // reading the file will report the reason
    bool has_end = chunk.name.kind == level2::ChunkKind::end;
    auto newest = level2::LiveVolume::Clock::time_point::min();
    const auto look_at = [&](const ChunkPath& one) {
        has_end = has_end || one.name.kind == level2::ChunkKind::end;
        const auto stamp = stamp_of(one.path, options_.beneath);
        if (stamp) newest = std::max(newest, arrival_of(*stamp));
    };
    look_at(chunk);
    for (const ChunkPath& one : *beside)
        look_at(one);
    const auto waited = level2::LiveVolume::Clock::now() - newest;
    return has_end || waited >= options_.chunk_timeout;
}

std::filesystem::path ChunkVolumes::poll_for_place(const ChunkPath& chunk) {
    const MutexLock lock(mutex_);
    if (representatives_.size() >= most_representatives && !representatives_.contains(chunk.key))
        representatives_.clear();
    std::filesystem::path former = std::exchange(representatives_[chunk.key], chunk.path);
    return former == chunk.path ? std::filesystem::path{} : former;
}

ChunkVolumes::Shared ChunkVolumes::find(const ChunkPath& chunk, const std::string& station,
                                        Expected expected) {
    const MutexLock lock(mutex_);
    if (Shared known = volumes_.find(chunk.key)) return known;
    if (volumes_.was_given_up(chunk.key)) {
        if (expected == Expected::more) return nullptr;
        if (expected == Expected::its_end_is_there && !volumes_.take_second_try(chunk.key))
            return nullptr;
    } else if (!volumes_.make_place(station) && expected == Expected::more) {
        return nullptr;
    }
    level2::LiveOptions live;
    live.timeout = options_.chunk_timeout;
    live.grace = options_.chunk_grace;
    live.decode.output_limit_bytes = most_unpacked_bytes;
    live.decode.array_limit_bytes = most_array_bytes(options_.selection);
    live.decode.selection = options_.selection;
    live.decode.fallback_station = station_of_path(chunk.path);
    representatives_.erase(chunk.key);
    auto made = std::make_shared<Guarded<ChunkVolume>>(options_, live);
    volumes_.add(chunk.key, made, station);
    return made;
}

ChunkVolumes::Shared ChunkVolumes::find_known(const ChunkPath& chunk) const {
    const MutexLock lock(mutex_);
    return volumes_.find(chunk.key);
}

bool ChunkVolumes::grew(const ChunkPath& chunk, const Shared& volume, const Growth& growth,
                        const std::string& station) {
    const MutexLock lock(mutex_);
    // The volume was forgotten in the meantime, for example because it is read anew.
    if (volumes_.find(chunk.key) != volume) return !volumes_.was_given_up(chunk.key);
    return volumes_.grew(chunk.key, volume.get(), station, growth);
}

std::uint64_t ChunkVolumes::take_given_up() {
    const MutexLock lock(mutex_);
    return volumes_.take_given_up();
}

void ChunkVolumes::forget_key(const std::string& key) {
    volumes_.forget(key);
    representatives_.erase(key);
}

void ChunkVolumes::forget(const ChunkPath& chunk) {
    const MutexLock lock(mutex_);
    forget_key(chunk.key);
}

void ChunkVolumes::forget(const ChunkPath& chunk, const Shared& volume) {
    const MutexLock lock(mutex_);
    if (volumes_.find(chunk.key) == volume) forget_key(chunk.key);
}

std::size_t ChunkVolumes::count() const {
    const MutexLock lock(mutex_);
    return volumes_.count();
}

}  // namespace stormcellar::pipeline
