// web/data/events/station_news.h -- when something came from each station, and its newest volume.
//
// Times of arrival are this machine's, times of volumes are the radar's. A volume from the future
// (by is_believed()) is never the newest, since no volume would come after it.
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

// Facts that are known of a volume when it is first seen.
struct SeenVolume {
    UtcTime start;
    int vcp = 0;  // 0: not known
};

// The end of a volume of which there is no grid.
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
        std::optional<UtcTime> heard;          // when something came
        bool is_silent = false;
        // When it spoke last: of one of which nothing came yet, the start of its newest volume.
        [[nodiscard]] std::optional<UtcTime> spoke() const { return heard ? heard : newest_volume; }
    };

    // Notes what is there when the server begins. It tells nothing.
    void note(const std::string& station, std::optional<UtcTime> newest_volume,
              std::optional<UtcTime> heard, UtcTime now);
    // Something came, of this volume if it is known. Returns what that means: station_spoke if the
    // station was silent, volume_begun if no volume was known that starts so late.
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
