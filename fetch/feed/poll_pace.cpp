#include "fetch/feed/poll_pace.h"

#include <algorithm>

namespace stormcellar::feed {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds longest_first_pause{1000}, longest_pause{60'000},
    longest_silent_pause{30'000};
constexpr int most_intervals = 3, most_doublings = 10, most_silent_turns = 100;

}  // namespace

void PollPace::count(SteadyTime now) {
    counted_.push_back(now);
    if (counted_.size() > most_in_vain_) counted_.pop_front();
}

void PollPace::note_news(SteadyTime now, milliseconds between_chunks) {
    news_ = now;
    between_chunks_ = between_chunks;
    silent_turns_ = failures_ = 0;
}

void PollPace::note_nothing(SteadyTime now) {
    count(now);
    failures_ = 0;
    between_chunks_ = milliseconds{0};
    if (is_silent(now)) ++silent_turns_;
}

void PollPace::note_failure(SteadyTime now, std::chrono::seconds retry_after) {
    count(now);
    ++failures_;
    asked_pause_ = std::min<milliseconds>(retry_after, longest_pause);
}

milliseconds PollPace::pause(SteadyTime now, bool is_urgent) {
    milliseconds pause = std::clamp(between_chunks_ / 2, every_, most_intervals * every_);
    if (silent_turns_ > 0) {
        const milliseconds slower = every_ * std::min(silent_turns_, most_silent_turns);
        pause = std::max(every_, std::min(slower, longest_silent_pause));
    }
    if (is_urgent) pause = milliseconds{0};
    if (failures_ > 0) {
        const auto doubled =
            std::min(every_, longest_first_pause) * (1 << std::min(failures_ - 1, most_doublings));
        pause = std::min<milliseconds>(doubled, longest_pause);
    }
    std::uniform_int_distribution<milliseconds::rep> shorter(0, pause.count() / 10);
    pause -= milliseconds{shorter(chance_)};
    if (failures_ > 0) pause = std::max(pause, asked_pause_);
    if (counted_.size() < most_in_vain_) return pause;
    return std::max(pause, std::chrono::ceil<milliseconds>(counted_.front() + window - now));
}

}  // namespace stormcellar::feed
