// fetch/feed/poll_pace.h -- decides how long to wait before the next listing of a station.
//
// While chunks come, the next listing follows after the polling interval, or after half the time
// between chunks if that is longer, but never after more than three intervals. A station that has
// been silent for a minute is asked less and less often, down to every 30 s. After a failure the
// pause is 1 s, or the polling interval if that is shorter. The pause doubles with each further
// failure, up to 60 s. If the server requests a longer pause, that pause applies, up to 60 s.
// Listings without news are limited to 20 within a minute. Each pause is shortened at random by up
// to a tenth, so that stations do not ask at the same time.
//
// Threads   Plain data; one thread at a time. The caller passes the current time.
#pragma once

#include <chrono>
#include <deque>
#include <random>

#include "base/steady_time.h"

namespace stormcellar::feed {

class PollPace {
  public:
    static constexpr std::chrono::seconds window{60}, silent_after{60};

    // `most_in_vain` is the limit of listings without news within a minute.
    PollPace(std::chrono::milliseconds every, std::size_t most_in_vain, unsigned seed)
        : every_(every), most_in_vain_(most_in_vain), chance_(seed) {}

    void note_news(SteadyTime now, std::chrono::milliseconds between_chunks);
    void note_nothing(SteadyTime now);
    void note_failure(SteadyTime now, std::chrono::seconds retry_after);
    [[nodiscard]] bool is_silent(SteadyTime now) const { return now - news_ >= silent_after; }
    // Returns the pause before the next listing. `is_urgent` is true if the last answer only led to
    // the next question, which may follow at once.
    [[nodiscard]] std::chrono::milliseconds pause(SteadyTime now, bool is_urgent = false);

  private:
    void count(SteadyTime now);

    const std::chrono::milliseconds every_;
    const std::size_t most_in_vain_;
    std::minstd_rand chance_;
    SteadyTime news_ = steady_now();
    std::chrono::milliseconds between_chunks_{0}, asked_pause_{0};
    int silent_turns_ = 0, failures_ = 0;
    std::deque<SteadyTime> counted_;  // times of the last most_in_vain_ listings without news,
                                      // and of failures
};

}  // namespace stormcellar::feed
