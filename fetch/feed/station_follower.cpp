#include "fetch/feed/station_follower.h"

#include <algorithm>
#include <utility>

namespace stormcellar::feed {
namespace {

// Between two volumes, a radar's clock may be set back by up to this time.
constexpr std::chrono::hours clock_set_back{1};
constexpr std::chrono::seconds grace{60}, between_looks{15};
// While chunks come, every fourth listing without news asks for the next directory, and the other
// three ask for the volume. For a silent station three of four ask for the next directory, because
// the station more likely continues with a new volume.
constexpr int every_fourth = 4;
// A search around the ring of volume numbers begins this far after the last volume, and then goes
// in steps of 13. It visits every number, because 13 and 999 have no common divisor.
constexpr int ring_step = 13, first_step = 3;

}  // namespace

void VolumeChunks::add(int number, level2::ChunkKind kind) {
    done_.set(static_cast<std::size_t>(number));
    highest_ = std::max(highest_, number);
    if (kind == level2::ChunkKind::end) end_ = std::max(end_, number);
}

int VolumeChunks::without_gap() const {
    int number = 0;
    while (number < highest_ && has(number + 1))
        ++number;
    return number;
}

int VolumeChunks::missing() const {
    return highest_ - static_cast<int>(done_.count()) + (end_ == 0 ? 1 : 0);
}

StationFollower::StationFollower(std::string station, const std::vector<VolumeId>& written,
                                 SteadyTime now)
    : station_(std::move(station)) {
    if (written.empty()) search_.emplace(station_);
    for (const VolumeId& volume : written)
        begin(volume, now);
}

std::optional<VolumeId> StationFollower::volume() const {
    if (!current_) return std::nullopt;
    return current_->id;
}

void StationFollower::begin(const VolumeId& id, SteadyTime now) {
    leave_previous();
    if (current_ && !current_->chunks.is_whole()) {
        previous_ = std::move(current_);
        previous_->next_look = now + between_looks;
        previous_->until = now + grace;
    }
    current_.emplace();
    current_->id = last_ = id;
    probes_ = 0;
}

void StationFollower::leave_previous() {
    if (previous_ && !previous_->chunks.is_whole()) missing_ += previous_->chunks.missing();
    previous_.reset();
}

fetch::ListingQuestion StationFollower::question(SteadyTime now, bool is_silent) {
    if (previous_ && (previous_->chunks.is_whole() || now >= previous_->until)) leave_previous();
    const bool is_open = current_ && !current_->chunks.is_whole();
    if (search_) {
        asked_ = Asked::search;
        question_ = search_->question();
    } else if (previous_ && now >= previous_->next_look) {
        previous_->next_look = now + between_looks;
        asked_ = Asked::previous;
        question_ = question_of(*previous_);
    } else if (is_open && (in_vain_ % every_fourth == every_fourth - 1) == is_silent) {
        asked_ = Asked::current;
        question_ = question_of(*current_);
    } else {
        asked_ = Asked::directory;
        question_ = question_of_directory(is_silent);
    }
    return question_;
}

fetch::ListingQuestion StationFollower::question_of(const Followed& volume) const {
    std::string after = prefix_of(station_, volume.id);
    if (const int number = volume.chunks.without_gap(); number > 0)
        after += fmt::format("-{:03}-~", number);
    return {.prefix = directory_of(station_, volume.id.number), .start_after = std::move(after)};
}

fetch::ListingQuestion StationFollower::question_of_directory(bool is_silent) {
    const int expected = volume_number_after(last_.number);
    const int number = next_directory(is_silent);
    // In the expected directory, the next volume may have an earlier time, because the clock of the
    // radar may have been set back. In any other directory, only a newer volume can be the next.
    const std::string after = number == expected
                                  ? prefix_of(station_, {last_.time - clock_set_back, number})
                                  : prefix_of(station_, {last_.time, number}) + "~";
    return {.prefix = directory_of(station_, number), .start_after = after};
}

int StationFollower::next_directory(bool is_silent) {
    const int expected = volume_number_after(last_.number);
    if (!is_silent) return expected;
    const int probe = probes_++;
    if (probe % 2 == 0) return expected;
    switch (probe / 2 % 3) {
        case 0:
            return volume_number_after(last_.number, 2);
        case 1:
            return 1;
        default:
            return volume_number_after(last_.number,
                                       first_step + probe / 6 * ring_step % last_volume);
    }
}

StationFollower::News StationFollower::take_search(const fetch::ListingPage& answer, UtcTime utc) {
    search_->take(answer, utc);
    if (!search_->is_done()) return {{}, true};
    const auto start = search_->start();
    if (!start) {
        search_.emplace(station_);
        return {};
    }
    // Pretend that the last volume was in the directory before the found one, so that the found
    // directory is listed next.
    last_ = {start->from + clock_set_back, volume_number_after(start->number, last_volume - 1)};
    search_.reset();
    return {{}, true};
}

// Returns those chunks in the answer that the question asked for, sorted. Ignores other keys.
std::vector<StationFollower::Chunk> StationFollower::chunks_in(const fetch::ListingPage& answer,
                                                               UtcTime utc) const {
    std::vector<Chunk> chunks;
    for (const fetch::BucketObject& object : answer.objects) {
        const bool is_asked =
            object.key.starts_with(question_.prefix) && object.key > question_.start_after;
        auto key = is_asked ? parse_chunk_key(object.key, utc) : std::nullopt;
        if (key) chunks.push_back({std::move(*key), object.size_bytes, object.modified});
    }
    std::ranges::stable_sort(chunks, {}, [](const Chunk& chunk) {
        return std::pair{chunk.key.volume, chunk.key.number};
    });
    return chunks;
}

StationFollower::News StationFollower::take(const fetch::ListingPage& answer, UtcTime utc,
                                            SteadyTime now) {
    if (asked_ == Asked::search) return take_search(answer, utc);
    News news = new_in(answer, utc, now);
    in_vain_ = news.chunks.empty() ? in_vain_ + 1 : 0;
    return news;
}

StationFollower::News StationFollower::new_in(const fetch::ListingPage& answer, UtcTime utc,
                                              SteadyTime now) {
    const std::vector<Chunk> listed = chunks_in(answer, utc);
    News news;
    const auto add_new_of = [&](const Followed& volume) {
        for (const Chunk& chunk : listed) {
            const bool is_repeated =
                !news.chunks.empty() && news.chunks.back().key.number == chunk.key.number;
            if (chunk.key.volume == volume.id && !volume.chunks.has(chunk.key.number) &&
                !is_repeated)
                news.chunks.push_back(chunk);
        }
    };
    if (asked_ == Asked::previous) {
        if (previous_) add_new_of(*previous_);
        news.is_urgent = true;
        return news;
    }
    if (asked_ == Asked::current) add_new_of(*current_);
    if (!news.chunks.empty()) return news;
    // If this is the directory of the volume that is followed, only a later volume in it is new.
    const auto next = std::ranges::find_if(listed, [&](const Chunk& chunk) {
        return !current_ || (chunk.key.volume != current_->id &&
                             (asked_ == Asked::directory || current_->id < chunk.key.volume));
    });
    if (next == listed.end()) return news;
    begin(next->key.volume, now);
    add_new_of(*current_);
    return news;
}

void StationFollower::note_done(const ChunkKey& key) {
    for (auto* const volume : {&current_, &previous_})
        if (*volume && (*volume)->id == key.volume) (*volume)->chunks.add(key.number, key.kind);
}

}  // namespace stormcellar::feed
