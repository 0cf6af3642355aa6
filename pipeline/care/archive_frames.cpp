#include "pipeline/care/archive_frames.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {
namespace {

// A worker takes this many consecutive instants, because it can then reuse what it has just read.
constexpr std::size_t instants_a_turn = 4;

// The state in which the frame of an instant was found, and the problems of making it.
struct FrameOutcome {
    FrameStanding standing = FrameStanding::not_due;  // before this run
    std::vector<std::string> problems;
};

class FrameCrew {
  public:
    FrameCrew(cache::StoreWriter& store, const Domain& domain, level2::Moment moment,
              const std::vector<UtcTime>& instants, const FillProgress& progress,
              const std::atomic<bool>& stop)
        : store_(store),
          domain_(domain),
          moment_(moment),
          instants_(instants),
          progress_(progress),
          stop_(stop),
          outcomes_(instants.size()) {}

    Status work(int threads) {
        const auto turns =
            static_cast<int>((instants_.size() + instants_a_turn - 1) / instants_a_turn);
        const int workers = std::clamp(threads, 1, std::max(1, std::min(turns, most_workers)));
        for_each_piece(workers, workers, [&](int) { take_turns(std::max(1, threads / workers)); });
        const MutexLock lock(mutex_);
        return std::move(failure_);
    }

    void add_to(FillReport& report) {
        const MutexLock lock(mutex_);
        for (std::size_t i = 0; i < outcomes_.size(); ++i) {
            if (!outcomes_[i]) continue;  // the frame was not examined, after a stop or an error
            const FrameOutcome& outcome = *outcomes_[i];
            if (outcome.standing == FrameStanding::to_make) ++report.frames_made;
            if (outcome.standing == FrameStanding::current) ++report.frames_found;
            if (outcome.standing != FrameStanding::not_due) report.frames.push_back(instants_[i]);
            for (const std::string& problem : outcome.problems)
                report.notes.push_back({{}, problem});
        }
    }

  private:
    void take_turns(int threads) {
        MosaicMaker maker(&store_, {domain_}, FramesWhen::asked_for);
        for (;;) {
            const std::size_t first = next_.fetch_add(instants_a_turn);
            if (first >= instants_.size()) return;
            const std::size_t end = std::min(first + instants_a_turn, instants_.size());
            for (std::size_t i = first; i < end; ++i) {
                if (stop_ || has_failed()) return;
                keep(i, make(maker, instants_[i], threads));
            }
        }
    }

    Result<FrameOutcome> make(MosaicMaker& maker, UtcTime instant, int threads) {
        const cache::GridName frame{domain_.name, moment_, instant};
        const auto standing = standing_of(store_, maker.domains(), frame);
        if (!standing) return pass_on(standing);
        FrameOutcome outcome{*standing, {}};
        if (*standing == FrameStanding::to_make) {
            const auto made = maker.make_again(frame, threads, outcome.problems);
            if (!made) return pass_on(made);
        }
        return outcome;
    }

    void keep(std::size_t at, Result<FrameOutcome> outcome) {
        const MutexLock lock(mutex_);
        if (!outcome) {
            if (failure_) failure_ = pass_on(outcome);
            return;
        }
        outcomes_[at] = std::move(*outcome);
        if (progress_) progress_(++done_);
    }
    [[nodiscard]] bool has_failed() {
        const MutexLock lock(mutex_);
        return !failure_;
    }

    cache::StoreWriter& store_;
    const Domain& domain_;
    level2::Moment moment_;
    const std::vector<UtcTime>& instants_;
    const FillProgress& progress_;
    const std::atomic<bool>& stop_;
    std::atomic<std::size_t> next_{0};
    Mutex mutex_;
    std::vector<std::optional<FrameOutcome>> outcomes_ STORMCELLAR_GUARDED_BY(mutex_);
    std::size_t done_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    Status failure_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace

Status make_frames(cache::StoreWriter& store, const Domain& domain, level2::Moment moment,
                   const std::vector<UtcTime>& instants, int threads, const FillProgress& progress,
                   const std::atomic<bool>& stop, FillReport& report) {
    FrameCrew crew(store, domain, moment, instants, progress, stop);
    Status made = crew.work(threads);
    crew.add_to(report);
    return made;
}

}  // namespace stormcellar::pipeline
