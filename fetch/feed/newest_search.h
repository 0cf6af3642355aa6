// fetch/feed/newest_search.h -- finds the newest volume of a station in the ring of volume numbers.
//
// The first listing names the directories that exist. In the order of their numbers, their times
// rise up to the newest volume. The next directory, if any, has the oldest volume, and from there
// the times rise again. So the search bisects, and compares each time with the newest time of the
// first directory. A directory with a newer time is at or before the newest volume; any other
// directory after the first is behind the newest volume. The search takes some 12 listings, however
// full the ring is. If a station has jumped to another number, the times may fall more than once,
// and the search may end at any such fall. Then no chunks follow there, and StationFollower
// searches further.
//
// Threads   Plain data; one thread at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fetch/bucket/bucket_listing.h"
#include "fetch/feed/chunk_key.h"

namespace stormcellar::feed {

class NewestSearch {
  public:
    explicit NewestSearch(std::string station) : station_(std::move(station)) {}

    // Returns the next question to ask. Call it until is_done().
    [[nodiscard]] fetch::ListingQuestion question() const;
    // Takes the answer to the question that question() returned.
    void take(const fetch::ListingPage& answer, UtcTime now);
    [[nodiscard]] bool is_done() const { return step_ == Step::done; }

    // The place at which StationFollower begins. This is the directory before the newest, so that a
    // complete volume comes first, or the newest directory if there is no directory before it.
    // Chunks older than `from` belong to an earlier round of the volume numbers.
    struct Start {
        int number = 0;
        UtcTime from;
    };
    // Returns none if the bucket has no volume of this station.
    [[nodiscard]] std::optional<Start> start() const;

  private:
    enum class Step { directories, oldest, bisect, done };
    void take_directories(const fetch::ListingPage& answer);
    void take_oldest(const fetch::ListingPage& answer, UtcTime now);
    void narrow();

    std::string station_;
    Step step_ = Step::directories;
    std::vector<int> numbers_;             // numbers of existing directories, ascending
    UtcTime first_time_;                   // the newest time in numbers_[0]
    std::size_t newest_ = 0, beyond_ = 0;  // the newest volume is in [newest_, beyond_)
};

}  // namespace stormcellar::feed
