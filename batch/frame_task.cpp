#include "batch/frame_task.h"

#include <set>
#include <utility>
#include <vector>

#include "batch/check.h"
#include "batch/held_cache.h"
#include "batch/leftovers.h"
#include "batch/standing.h"
#include "batch/usage.h"
#include "pipeline/care/archive_frames.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::batch {
namespace {

void add(const pipeline::FillReport& report, Record& record) {
    // Remember the names that are noted already, because several frames may lack the same damaged
    // partial.
    std::set<std::string> noted;
    for (const pipeline::LeftOut& note : report.notes) {
        if (noted.insert(note.reason).second)
            record.left_out.push_back({"a grid of a station", note.reason});
    }
}

}  // namespace

Status check_needs(const Plan& plan, std::size_t first, std::size_t end) {
    std::vector<std::pair<Task, Record>> needed;
    for (std::size_t need = first; need < end; ++need) {
        const auto task = plan.task(need);
        if (!task) return pass_on(task);
        auto record = read_record(plan, *task);
        if (!record) return fail(ErrorCode::unmet, "needs task {}, which is not done", need);
        needed.emplace_back(*task, std::move(*record));
    }
    const auto store = cache::StoreReader::open(plan.recipe().cache);
    if (!store) return pass_on(store);
    for (const auto& [task, record] : needed) {
        if (Status there = check_stands(*store, plan, task, record); !there) return there;
    }
    return {};
}

Result<TaskOutcome> run_frame_task(const Plan& plan, const Task& task, const TaskOptions& options) {
    const auto& hour = std::get<FrameHour>(task.work);
    const Recipe& recipe = plan.recipe();
    const HeldCache held(recipe.cache);
    if (Status met = check_needs(plan, hour.first_need, hour.end_need); !met) return pass_on(met);
    auto store = cache::StoreWriter::open(real_file_system(), recipe.cache, false);
    if (!store) return pass_on(store);
    remove_own_leftovers(recipe, task);
    if (Status removed = remove_damaged(*store, plan, task); !removed) return pass_on(removed);
    const Usage usage;
    Record record;
    record.number = task.number;
    record.kind = task.kind();
    record.plan = plan.facts().hash;
    const auto instants = pipeline::instants_between(hour.from, hour.to, recipe.domain->interval);
    std::size_t made = 0;
    for (const level2::Moment moment : recipe.moments) {
        pipeline::FillReport report;
        const Status framed = pipeline::make_frames(*store, *recipe.domain, moment, instants,
                                                    options.threads, {}, options.stop, report);
        if (!framed) return pass_on(framed);
        made += report.frames_made;
        add(report, record);
    }
    if (options.stop) return fail(ErrorCode::busy, "stopped; the next run continues");
    const auto standing = grids_standing(*store, plan, task);
    if (!standing) return pass_on(standing);
    record.grids = standing->size();
    record.digest = digest_of(*standing);
    for (const StandingGrid& frame : *standing)
        record.bytes_written += frame.bytes;
    usage.end(record);
    if (Status same = held.check(); !same) return pass_on(same);
    if (auto old = read_record(plan, task); made == 0 && old && old->digest == record.digest) {
        return TaskOutcome{true, std::move(*old)};
    }
    if (Status written = keep_record(plan, record); !written) return pass_on(written);
    return TaskOutcome{false, std::move(record)};
}

}  // namespace stormcellar::batch
