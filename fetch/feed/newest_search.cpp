#include "fetch/feed/newest_search.h"

#include <algorithm>
#include <chrono>

namespace stormcellar::feed {
namespace {

// A probe asks for several keys, because some of them may not be keys of chunks.
constexpr int keys_of_a_probe = 10;

}  // namespace

fetch::ListingQuestion NewestSearch::question() const {
    if (step_ == Step::directories) return {.prefix = station_ + "/", .by_folders = true};
    if (step_ == Step::oldest) return {.prefix = directory_of(station_, numbers_.front())};
    const int middle = numbers_[(newest_ + beyond_) / 2];
    return {.prefix = directory_of(station_, middle),
            .start_after = prefix_of(station_, {first_time_, middle}) + "~",
            .most_keys = keys_of_a_probe};
}

void NewestSearch::take(const fetch::ListingPage& answer, UtcTime now) {
    if (step_ == Step::directories) return take_directories(answer);
    if (step_ == Step::oldest) return take_oldest(answer, now);
    const std::size_t middle = (newest_ + beyond_) / 2;
    const bool is_newer = std::ranges::any_of(answer.objects, [&](const fetch::BucketObject& one) {
        const auto key = parse_chunk_key(one.key, now);
        return key && key->station == station_ && key->volume.number == numbers_[middle] &&
               key->volume.time > first_time_;
    });
    (is_newer ? newest_ : beyond_) = middle;
    narrow();
}

void NewestSearch::take_directories(const fetch::ListingPage& answer) {
    const std::string prefix = station_ + "/";
    for (std::string_view folder : answer.folders) {
        if (!folder.starts_with(prefix) || !folder.ends_with('/')) continue;
        folder.remove_prefix(prefix.size());
        folder.remove_suffix(1);
        if (const auto number = parse_volume_number(folder)) numbers_.push_back(*number);
    }
    std::ranges::sort(numbers_);
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    step_ = numbers_.empty() ? Step::done : Step::oldest;
}

void NewestSearch::take_oldest(const fetch::ListingPage& answer, UtcTime now) {
    std::optional<UtcTime> newest;
    for (const fetch::BucketObject& object : answer.objects) {
        const auto key = parse_chunk_key(object.key, now);
        const bool is_here =
            key && key->station == station_ && key->volume.number == numbers_.front();
        if (is_here && (!newest || key->volume.time > *newest)) newest = key->volume.time;
    }
    // The directory is empty, or was emptied after it was listed, so skip it.
    if (!newest) numbers_.erase(numbers_.begin());
    step_ = newest ? Step::bisect : numbers_.empty() ? Step::done : Step::oldest;
    if (!newest) return;
    first_time_ = *newest;
    beyond_ = numbers_.size();
    narrow();
}

void NewestSearch::narrow() {
    if (beyond_ - newest_ <= 1) step_ = Step::done;
}

std::optional<NewestSearch::Start> NewestSearch::start() const {
    if (step_ != Step::done || numbers_.empty()) return std::nullopt;
    constexpr std::chrono::hours earlier_round{1};
    const int newest = numbers_[newest_];
    const int before = newest == 1 ? last_volume : newest - 1;
    const bool has_before = std::ranges::binary_search(numbers_, before);
    // All directories between the first and the newest have newer volumes than the first directory.
    const bool is_between = has_before && newest_ >= 2;
    return Start{has_before ? before : newest,
                 is_between ? first_time_ : first_time_ - earlier_round};
}

}  // namespace stormcellar::feed
