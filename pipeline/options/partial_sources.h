// pipeline/options/partial_sources.h -- records which machines bring partials of mosaics, and tells
// which of them are late.
//
// A machine is late for a frame if its newest volume is older than the frame by more than the
// allowed time. The frame then leaves out the stations of this machine that no timely machine
// brings, and says so. Lateness depends only on the times of volumes, and not on a clock. So a
// frame does not depend on who makes it or when.
//
// Threads   Many threads may use one object.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

struct LateMachine {
    std::string name;
    std::set<std::string> stations;  // its stations that no timely machine brings; not empty
    UtcTime newest;                  // middle of the machine's newest volume
    // Returns a text such as "north (KFWS KTLX): nothing since 2013-05-20T20:04:00Z".
    [[nodiscard]] std::string text() const;
};

class PartialSources {
  public:
    explicit PartialSources(std::chrono::seconds late_after) : late_after_(late_after) {}

    // Notes that a machine brought a partial of this station. `middle` is the middle of its volume.
    void brought(const std::string& machine, const std::string& domain, level2::Moment moment,
                 const std::string& station, UtcTime middle);
    // Returns, by name, the machines that are late for a frame and bring stations that no timely
    // machine brings.
    [[nodiscard]] std::vector<LateMachine> late_for(const std::string& domain,
                                                    level2::Moment moment, UtcTime instant) const;
    // Returns the middle of the newest volume that a machine brought for any mosaic. Returns none
    // if the machine brought nothing.
    [[nodiscard]] std::optional<UtcTime> newest_of(const std::string& machine) const;

  private:
    using Mosaic = std::pair<std::string, level2::Moment>;
    struct Brought {
        UtcTime newest{};
        std::set<std::string> stations;
    };
    const std::chrono::seconds late_after_;
    mutable Mutex mutex_;
    std::map<Mosaic, std::map<std::string, Brought>> mosaics_
        STORMCELLAR_GUARDED_BY(mutex_);  // by machine
};

}  // namespace stormcellar::pipeline
