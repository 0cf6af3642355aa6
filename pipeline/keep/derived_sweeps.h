// pipeline/keep/derived_sweeps.h -- keeps results that were made from shelved sweeps, such as
// dealiased velocities, so that each is made once while a volume grows. Used only inside the
// pipeline room.
//
// Threads   Many threads may use one object. keep() must not run while another thread puts a
//           received sweep on the same shelf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "pipeline/keep/sweep_shelf.h"
#include "retrieve/derived/quality_moment.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {

class DerivedSweeps {
  public:
    using Key = std::size_t;

    // Returns the sweep that was made from a received sweep; none if it is not kept, for example
    // because a late radial replaced the received sweep on the shelf. Errors: those of the shelf.
    [[nodiscard]] std::optional<Result<level2::Sweep>> find(
        const SweepShelf& shelf, Key key, const SweepShelf::Place& received) const {
        SweepShelf::Place place;
        {
            const MutexLock lock(mutex_);
            const auto kept = kept_.find(key);
            if (kept == kept_.end() || kept->second.received != received.offset)
                return std::nullopt;
            place = kept->second.place;
        }
        return shelf.get(place);
    }
    [[nodiscard]] bool has(Key key, const SweepShelf::Place& received) const {
        const MutexLock lock(mutex_);
        const auto kept = kept_.find(key);
        return kept != kept_.end() && kept->second.received == received.offset;
    }
    // Keeps a sweep, and the facts about the echo that was left out of this sweep. Replaces an
    // earlier sweep of this key. Errors: those of the shelf.
    Status keep(SweepShelf& shelf, Key key, const SweepShelf::Place& received,
                const level2::Sweep& made, const retrieve::LeftOutEcho& left_out = {}) {
        const MutexLock lock(mutex_);
        const auto place = shelf.put(made);
        if (!place) return pass_on(place);
        kept_.insert_or_assign(key, Kept{received.offset, *place, left_out});
        return {};
    }
    // Returns the echo that was left out of a sweep; nothing if the sweep is not kept.
    [[nodiscard]] retrieve::LeftOutEcho left_out(Key key) const {
        const MutexLock lock(mutex_);
        const auto kept = kept_.find(key);
        return kept != kept_.end() ? kept->second.left_out : retrieve::LeftOutEcho{};
    }

  private:
    struct Kept {
        std::uint64_t received = 0;  // offset of the received sweep
        SweepShelf::Place place;
        retrieve::LeftOutEcho left_out;
    };
    mutable Mutex mutex_;
    std::map<Key, Kept> kept_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
