// fetch/feed/newest_search.h -- finds the newest volume of a station in the ring of volume numbers.
//
// One listing names the directories that exist. In the order of their numbers, their times rise to
// the newest and then fall once to the oldest, wherever that is. So the search takes the first
// directory's newest time and bisects: a directory with something newer is before the fall, any
// other one is behind it. That takes some 12 listings, once, however full the ring is. If a station
// has jumped to another number, the times may fall more than once, and the search may find the end
// of any rise; StationFollower looks further if nothing comes after it.
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

    // Returns the next question, until is_done().
    [[nodiscard]] fetch::ListingQuestion question() const;
    // Takes the answer to question().
    void take(const fetch::ListingPage& answer, UtcTime now);
    [[nodiscard]] bool is_done() const { return step_ == Step::done; }

    // Start of the follower: with the directory before the newest, so that a complete volume
    // comes first, or with the newest itself. Chunks older than `from` are from an earlier round of
    // the ring.
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
    std::vector<int> numbers_;             // of directories that exist, ascending
    UtcTime first_time_;                   // the newest time in numbers_[0]
    std::size_t newest_ = 0, beyond_ = 0;  // the newest volume is in [newest_, beyond_)
};

}  // namespace stormcellar::feed
