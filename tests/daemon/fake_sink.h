// tests/daemon/fake_sink.h -- a sink whose results a test sets, and which records its calls.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/queue/sink.h"

namespace stormcellar::daemon {

class IdleSink : public Sink {
  public:
    Result<Taken> take(const std::filesystem::path&, bool, pipeline::Tries /*tries*/) override {
        return Taken{};
    }
    Result<int> mark_missing(const OnStep& /*step*/) override { return 0; }
};

class FakeSink final : public Sink {
  public:
    using Answer =
        std::function<Result<pipeline::IngestOutcome>(const std::filesystem::path&, bool finish)>;

    explicit FakeSink(Answer answer) : answer_(std::move(answer)) {}

    Result<Taken> take(const std::filesystem::path& path, bool finish_as_is,
                       pipeline::Tries /*tries*/) override {
        Taken taken;
        taken.stamp = look_at(path).stamp;
        Result<pipeline::IngestOutcome> outcome = answer_(path, finish_as_is);
        {
            const std::lock_guard lock(mutex_);
            calls_.push_back(path.filename().native() + (finish_as_is ? "!" : ""));
        }
        called_.notify_all();
        if (!outcome) return pass_on(outcome);
        taken.ingest = *outcome;
        return taken;
    }

    Result<pipeline::Noted> note(const std::filesystem::path& path) override {
        {
            const std::lock_guard lock(mutex_);
            noted_.push_back(path.filename().native());
        }
        called_.notify_all();
        return std::filesystem::exists(path) ? pipeline::Noted::stands : pipeline::Noted::gone;
    }
    Result<int> mark_missing(const OnStep& step) override {
        ++missing_looks_;
        if (looks) looks(step);
        return 0;
    }
    CacheRolled roll_cache(const cache::Budgets& /*budgets*/, const OnStep& step) override {
        if (rolls) rolls(step);
        return {};
    }
    // Called by mark_missing() and roll_cache(). Set them before the sink is used.
    std::function<void(const OnStep&)> looks, rolls;
    [[nodiscard]] int missing_looks() const { return missing_looks_; }

    // Returns false if the calls do not come in time.
    bool wait_for_calls(std::size_t count) {
        std::unique_lock lock(mutex_);
        return called_.wait_for(lock, std::chrono::seconds{20},
                                [&] { return calls_.size() >= count; });
    }
    // Waits until there are `count` calls of note() or time is up. Returns the files in the order
    // of the calls.
    std::vector<std::string> wait_for_noted(std::size_t count) {
        std::unique_lock lock(mutex_);
        called_.wait_for(lock, std::chrono::seconds{20}, [&] { return noted_.size() >= count; });
        return noted_;
    }
    // Returns the calls of take() in the order in which they ended: "NAME", or "NAME!" if
    // finish_as_is was set.
    std::vector<std::string> calls() {
        const std::lock_guard lock(mutex_);
        return calls_;
    }

  private:
    Answer answer_;
    std::atomic<int> missing_looks_ = 0;
    std::mutex mutex_;
    std::condition_variable called_;
    std::vector<std::string> calls_, noted_;
};

// Returns an ending with this result, without details.
inline pipeline::Ending ending_of(pipeline::IngestResult result) {
    namespace ended = pipeline::ended;
    // in the order of the enumeration
    static const std::array<pipeline::Ending, 9> endings = {
        ended::Gridded{},      ended::NoMoment{},   ended::NoPosition{},
        ended::OtherStation{}, ended::Incomplete{}, ended::Rejected{},
        ended::Unchanged{},    ended::Vanished{},   ended::Registered{}};
    return endings.at(static_cast<std::size_t>(result));
}

inline pipeline::IngestOutcome outcome_of(pipeline::IngestResult result) {
    pipeline::IngestOutcome outcome;
    outcome.ending = ending_of(result);
    outcome.station = "KTLX";
    outcome.volume_time = UtcTime{std::chrono::milliseconds{1'647'475'722'000}};
    if (result == pipeline::IngestResult::gridded) outcome.grids = {"/c/grid.scg"};
    return outcome;
}

}  // namespace stormcellar::daemon
