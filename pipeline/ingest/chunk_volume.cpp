#include "pipeline/ingest/chunk_volume.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/beneath.h"
#include "base/checksum.h"
#include "pipeline/drop/drop_names.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

// A file above this size is not a chunk. Real chunks have less than a hundredth of it.
constexpr std::uint64_t most_chunk_bytes = std::uint64_t{32} << 20;
// A job that reads further chunks stops after this many bytes, or after this many files that turn
// out not to belong to the volume. Chunks that the job has not read are read by their own jobs.
constexpr std::uint64_t most_read_at_once = std::uint64_t{64} << 20;
constexpr std::size_t most_refused_at_once = 4;
constexpr std::chrono::minutes longest_failing{2};
constexpr std::chrono::seconds between_catching_up{1};

// Puts the partial sweeps of chunks on the volume's shelf, a file on disk for sweeps.
class ShelfDepot final : public level2::SweepDepot {
  public:
    explicit ShelfDepot(SweepShelf& shelf) : shelf_(shelf) {}
    std::optional<std::uint64_t> put(const level2::Sweep& sweep) override {
        const auto place = shelf_.put(sweep);
        if (!place) return std::nullopt;
        places_.push_back(*place);
        return places_.size() - 1;
    }
    Result<level2::Sweep> get(std::uint64_t place) const override {
        auto sweep = shelf_.get(places_.at(place));
        // Return io, whatever the error of the shelf is, because the files are not to blame.
        if (!sweep) return fail(ErrorCode::io, "{}", sweep.error().message);
        return sweep;
    }

  private:
    SweepShelf& shelf_;
    std::vector<SweepShelf::Place> places_;
};

// Returns the key of a sweep in ShelvedVolume.
std::size_t cut_of(const level2::Sweep& sweep) {
    return static_cast<std::size_t>(std::max(0, sweep.elevation_number));
}

// Returns null if there is no room for a shelf.
std::unique_ptr<ShelvedVolume> kept_volume_in(const fs::path& directory) {
    auto shelf = SweepShelf::make_in(directory);
    if (!shelf) return nullptr;
    auto kept = std::make_unique<ShelvedVolume>();
    kept->shelf = std::move(*shelf);
    return kept;
}

}  // namespace

ChunkVolume::ChunkVolume(const FollowedFile::Options& options, const level2::LiveOptions& live)
    : moments_(options.moments),
      beneath_(options.beneath),
      kept_(kept_volume_in(options.scratch)),
      depot_(kept_ ? std::make_unique<ShelfDepot>(*kept_->shelf) : nullptr),
      live_(with_depot(live)) {}

level2::LiveOptions ChunkVolume::with_depot(level2::LiveOptions live) const {
    live.depot = depot_.get();
    return live;
}

Result<ChunkVolume::Added> ChunkVolume::add(const ChunkPath& chunk, const FileStamp& stamp) {
    const auto known = files_.find(chunk.path);
    if (known != files_.end() && known->second.stamp == stamp) {
        return known->second.is_whole ? Added::added : Added::unfinished;
    }
    const auto refused = refused_.find(chunk.path);
    if (refused != refused_.end() && refused->second == stamp) return Added::not_ours;
    const auto added = read_and_add(chunk, stamp);
    if (added && *added == Added::not_ours) refused_.insert_or_assign(chunk.path, stamp);
    return added;
}

Result<ChunkVolume::Added> ChunkVolume::read_and_add(const ChunkPath& chunk,
                                                     const FileStamp& stamp) {
    const auto bytes = read_beneath(beneath_, chunk.path, most_chunk_bytes);
    if (!bytes) {
        const ErrorCode code = bytes.error().code;
        if (code == ErrorCode::io || is_shortage(code)) return pass_on(bytes);
        return Added::not_ours;
    }
    read_bytes_ += bytes->size();
    File file{stamp, xxh3_64(*bytes), chunk.name.number, true};
    const auto added = live_.add(chunk.name.number, chunk.name.kind, *bytes, arrival_of(stamp));
    if (!added) {
        const ErrorCode code = added.error().code;
        if (is_shortage(code)) {
            return fail(code, "{}: {}", chunk.path.native(), added.error().message);
        }
        if (code != ErrorCode::empty && code != ErrorCode::truncated) return Added::not_ours;
        file.is_whole = false;
        files_.insert_or_assign(chunk.path, file);
        return Added::unfinished;
    }
    if (*added == level2::LiveVolume::Added::another_volume) return Added::not_ours;
    files_.insert_or_assign(chunk.path, file);
    former_representative_ = std::exchange(representative_, chunk.path);
    shelve_new_sweeps();
    return Added::added;
}

Result<ChunkVolume::Added> ChunkVolume::add_with_siblings(const ChunkPath& chunk,
                                                          const FileStamp& stamp) {
    auto added = add(chunk, stamp);
    if (!added || *added == Added::not_ours || is_loaded_) return added;
    if (const Status all = add_siblings(chunk); !all) return pass_on(all);
    is_loaded_ = true;
    return added;
}

bool ChunkVolume::InOneJob::is_enough(const ChunkVolume& volume) const {
    return volume.read_bytes_ - read_bytes > most_read_at_once ||
           volume.refused_.size() - refused >= most_refused_at_once;
}

// Adds the other chunks of the volume. The chunk `of` becomes the representative.
Status ChunkVolume::add_siblings(const ChunkPath& of) {
    const InOneJob before{read_bytes_, refused_.size()};
    representative_ = of.path;
    const auto found = chunks_beside(of, beneath_);
    if (!found) {
        const ErrorCode code = found.error().code;
        if (code == ErrorCode::io || is_shortage(code)) return pass_on(found);
        return {};
    }
    Status all;
    for (const ChunkPath& chunk : *found) {
        if (before.is_enough(*this)) break;
        const auto stamp = stamp_of(chunk.path, beneath_);
        if (!stamp && stamp.error().code != ErrorCode::not_found) all = pass_on(stamp);
        if (!stamp || !stamp->regular) continue;
        if (const auto added = add(chunk, *stamp); !added) all = pass_on(added);
    }
    representative_ = of.path;
    former_representative_.clear();  // no job was told to poll the former representative
    const auto now = level2::LiveVolume::Clock::now();
    if (!all && !fails_since_) fails_since_ = now;
    // After two minutes, go on without the files that cannot be read, so that one bad sector does
    // not hold back the rest of the volume.
    if (!all && now - *fails_since_ < longest_failing) return all;
    return {};
}

// Ignores errors, because a chunk that cannot be read here has a job of its own.
void ChunkVolume::add_what_is_missing(const ChunkPath& of) {
    const auto now = level2::LiveVolume::Clock::now();
    const bool is_early = now < next_catching_up_ && of.name.kind != level2::ChunkKind::end;
    if (live_.missing_numbers().empty() || is_early) return;
    next_catching_up_ = now + between_catching_up;
    const auto found = chunks_beside(of, beneath_);
    if (!found) return;
    const fs::path representative = representative_, former = former_representative_;
    const InOneJob before{read_bytes_, refused_.size()};
    for (const ChunkPath& chunk : *found) {
        if (before.is_enough(*this)) break;
        if (files_.contains(chunk.path)) continue;
        const auto stamp = stamp_of(chunk.path, beneath_);
        if (stamp && stamp->regular) (void)add(chunk, *stamp);
    }
    representative_ = representative;
    former_representative_ = former;
}

bool ChunkVolume::has_representative() const {
    const auto representative = files_.find(representative_);
    return representative != files_.end() && representative->second.is_whole;
}

bool ChunkVolume::is_representative(const fs::path& path) const {
    return path == representative_ && has_representative();
}

fs::path ChunkVolume::first_file() const {
    const auto first =
        std::min_element(files_.begin(), files_.end(), [](const auto& a, const auto& b) {
            return std::tuple(!a.second.is_whole, a.second.number, a.first) <
                   std::tuple(!b.second.is_whole, b.second.number, b.first);
        });
    return first->first;
}

// Puts a sweep on the shelf, under the number of its cut. A late chunk does not change this number.
void ChunkVolume::shelve(const level2::Sweep& sweep) {
    if (!kept_) return;
    const auto place = kept_->shelf->put(sweep);
    if (!place) return;
    const std::size_t cut = cut_of(sweep);
    const ShelvedVolume::Kept kept(sweep, moments_);
    kept_->places.insert_or_assign(cut, *place);
    radial_counts_.insert_or_assign(cut, sweep.radials.size());
    for (const level2::Radial& radial : sweep.radials) {
        if (level2::is_time_of_volume(radial.time, kept_->facts.start_time()))
            newest_radial_ = std::max(newest_radial_.value_or(radial.time), radial.time);
    }
    kept_->sweeps.insert_or_assign(cut, kept);
    if (kept.moments.any()) news_.add(kept.moments, kept_->is_lowest(kept.elevation_deg));
}

void ChunkVolume::keep_dealiased(const level2::Volume& dealiased) {
    if (!kept_) return;
    for (const level2::Sweep& sweep : dealiased.sweeps)
        kept_->keep_dealiased(cut_of(sweep), sweep);
}

void ChunkVolume::shelve_new_sweeps() {
    if (kept_) kept_->facts = live_.facts();
    for (const level2::LiveSweep& live : live_.take_sweeps())
        shelve(live.sweep);
}

std::optional<catalog::VolumeFacts> ChunkVolume::living_facts() const {
    if (!has_sweeps()) return std::nullopt;
    const File& first = files_.at(first_file());
    if (!first.is_whole || first.number != 1) return std::nullopt;
    catalog::VolumeFacts facts = facts_of(kept_->facts, false);
    if (!facts.start_time) return std::nullopt;
    facts.sweep_count = static_cast<int>(kept_->places.size());
    for (const auto& [cut, count] : radial_counts_)
        facts.radial_count += static_cast<int>(count);
    facts.end_time = newest_radial_;
    return facts;
}

Result<level2::Decoded> ChunkVolume::finish() {
    auto decoded = live_.finish();
    if (!decoded || !kept_) return decoded;
    kept_->facts = decoded->volume;
    kept_->facts.sweeps.clear();
    for (const level2::Sweep& sweep : decoded->volume.sweeps) {
        if (!kept_->places.contains(cut_of(sweep))) shelve(sweep);
    }
    return decoded;
}

level2::LiveVolume::Clock::time_point arrival_of(const FileStamp& stamp) {
    const std::int64_t wall_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                     std::chrono::system_clock::now().time_since_epoch())
                                     .count();
    const std::chrono::nanoseconds age{std::max<std::int64_t>(0, wall_ns - stamp.changed_ns)};
    return level2::LiveVolume::Clock::now() -
           std::chrono::duration_cast<level2::LiveVolume::Clock::duration>(age);
}

}  // namespace stormcellar::pipeline
