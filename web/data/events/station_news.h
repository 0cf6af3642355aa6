// web/data/events/station_news.h -- records when each station was last heard, and its newest
// volume.
//
// Times of arrival are by this machine's clock, and times of volumes by the radar's clock. A volume
// in the future (by is_believed()) is never the newest, because no volume would come after it.
//
// Threads   Many threads may use it.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/utc_time.h"
#include "web/data/events/event.h"

namespace stormcellar::web {

// Facts about a volume that are known when it is first seen.
struct SeenVolume {
    UtcTime start;
    int vcp = 0;  // 0: not known
};

// The end of a volume without a grid.
struct EndedVolume {
    UtcTime start;
    int sweeps = 0;
    bool is_complete = false;
};
[[nodiscard]] Event volume_ended_event(const std::string& station, const EndedVolume& volume,
                                       UtcTime now);

class StationNews {
  public:
    explicit StationNews(std::chrono::seconds silent_after) : silent_after_(silent_after) {}

    struct Page {
        std::string station;
        std::optional<UtcTime> newest_volume;  // its start
        std::optional<UtcTime> heard;          // when something came from it last
        bool is_silent = false;
        // Returns when something came last. If nothing has come yet, returns the start of the
        // newest volume.
        [[nodiscard]] std::optional<UtcTime> spoke() const { return heard ? heard : newest_volume; }
    };

    // Notes what is known when the server begins. Makes no events.
    void note(const std::string& station, std::optional<UtcTime> newest_volume,
              std::optional<UtcTime> heard, UtcTime now);
    // Notes that something came, with its volume if that is known. Returns station_spoke if the
    // station was silent and has now been heard. Returns volume_begun if the volume starts more
    // than 15 seconds after the newest.
    [[nodiscard]] std::vector<Event> hear(const std::string& station,
                                          std::optional<SeenVolume> volume, UtcTime heard,
                                          UtcTime now);
    // Returns a station_silent for each station that has become silent.
    [[nodiscard]] std::vector<Event> look(UtcTime now);

    [[nodiscard]] std::vector<Page> pages() const;  // sorted by station

  private:
    const std::chrono::seconds silent_after_;
    mutable Mutex mutex_;
    std::map<std::string, Page> pages_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
