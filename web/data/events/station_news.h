// web/data/events/station_news.h -- when each station was last heard, and its newest volume.
//
// This machine's clock gives the times of arrival, and the radar's clock the times of volumes. A
// volume from the future (by is_believed()) is never the newest, since no volume would come after
// it.
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

// The end of a volume that has no grid.
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
        std::optional<UtcTime> heard;          // when something last came
        bool is_silent = false;
        // Returns when something last came; if nothing came yet, the start of the newest volume.
        [[nodiscard]] std::optional<UtcTime> spoke() const { return heard ? heard : newest_volume; }
    };

    // Notes the known facts when the server begins, without events.
    void note(const std::string& station, std::optional<UtcTime> newest_volume,
              std::optional<UtcTime> heard, UtcTime now);
    // Notes that something came, with its volume if known. Returns station_spoke if a silent
    // station was heard recently, and volume_begun if the volume starts over 15 seconds after the
    // newest.
    [[nodiscard]] std::vector<Event> hear(const std::string& station,
                                          std::optional<SeenVolume> volume, UtcTime heard,
                                          UtcTime now);
    // Returns station_silent for each station that has become silent.
    [[nodiscard]] std::vector<Event> look(UtcTime now);

    [[nodiscard]] std::vector<Page> pages() const;  // sorted by station

  private:
    const std::chrono::seconds silent_after_;
    mutable Mutex mutex_;
    std::map<std::string, Page> pages_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
