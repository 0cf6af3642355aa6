// fetch/feed/poll_pace.h -- how long to wait before the bucket is asked again for one station.
//
// While chunks come, the next listing follows after the polling interval, or after half the time
// from chunk to chunk where that is longer, but three intervals at most. A station that has been
// silent for a minute is asked less and less often, down to every 30 s. After a failure the pause
// doubles from 1 s to 60 s, or is what the server asks for, up to 60 s. Whatever happens, listings
// that bring nothing come 20 times within a minute at most. Pauses are shortened by up to a tenth
// by chance, so that stations do not ask all at once.
//
// Threads   Plain data: one thread at a time. The caller passes the current time.
#pragma once

#include <chrono>
#include <deque>
#include <random>

#include "base/steady_time.h"

namespace stormcellar::feed {

class PollPace {
  public:
    static constexpr std::chrono::seconds window{60}, silent_after{60};

    // `most_in_vain`: listings within a minute that bring nothing.
    PollPace(std::chrono::milliseconds every, std::size_t most_in_vain, unsigned seed)
        : every_(every), most_in_vain_(most_in_vain), chance_(seed) {}

    void note_news(SteadyTime now, std::chrono::milliseconds between_chunks);
    void note_nothing(SteadyTime now);
    void note_failure(SteadyTime now, std::chrono::seconds retry_after);
    [[nodiscard]] bool is_silent(SteadyTime now) const { return now - news_ >= silent_after; }
    // `is_urgent`: the answer only led to the next question, so it follows at once.
    [[nodiscard]] std::chrono::milliseconds pause(SteadyTime now, bool is_urgent = false);

  private:
    void count(SteadyTime now);

    const std::chrono::milliseconds every_;
    const std::size_t most_in_vain_;
    std::minstd_rand chance_;
    SteadyTime news_ = steady_now();
    std::chrono::milliseconds between_chunks_{0}, asked_pause_{0};
    int silent_turns_ = 0, failures_ = 0;
    std::deque<SteadyTime> counted_;  // listings that brought nothing, the last most_in_vain_
};

}  // namespace stormcellar::feed
