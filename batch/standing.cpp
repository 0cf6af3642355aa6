#include "batch/standing.h"

#include <span>
#include <system_error>

#include "base/checksum.h"
#include "batch/check.h"
#include "batch/statistics_task.h"
#include "pipeline/care/archive_fill.h"
#include "pipeline/drop/file_facts.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/version.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::batch {
namespace {

// A volume begins at most this long before the time in its file's name. A file may hold several
// joined volumes; if one of these begins more than `most_after` after the day, its grid is not
// found here, and each run makes that grid again.
constexpr std::chrono::minutes most_before{15};
constexpr std::chrono::hours most_after{2};

struct Where {
    std::string domain;
    UtcTime from, to;
};

Where where_of(const Recipe& recipe, const Task& task) {
    if (const auto* const hour = std::get_if<FrameHour>(&task.work)) {
        return {recipe.domain->name, hour->from, hour->to};
    }
    const auto& day = std::get<StationDay>(task.work);
    return {recipe.domain_of(day.station), UtcTime{day.day} - most_before,
            UtcTime{day.day} + std::chrono::days{1} + most_after};
}

bool is_of(const cache::GridDescription& description, const Recipe& recipe, const Task& task) {
    const grid::Provenance& provenance = description.provenance;
    if (provenance.software_version != software_version) return false;
    const auto* const day = std::get_if<StationDay>(&task.work);
    if (day == nullptr) {
        return description.spec == recipe.domain->spec &&
               pipeline::is_derived_as(recipe.derived, description);
    }
    if (provenance.source_files.size() != 1) return false;
    const auto volume = volume_named(provenance.source_files.front());
    return volume && volume->station == day->station && volume->day() == day->day &&
           pipeline::is_of_grid(recipe.archive_options(1), description);
}

// Returns true if the file could not be read. Its contents may then still be sound.
bool may_be_sound(const Error& error) {
    return error.code == ErrorCode::io || is_shortage(error.code);
}

struct Found {
    std::vector<StandingGrid> standing;
    std::size_t damaged = 0;  // grids of all tasks, because a damaged header does not tell the task
};

Result<Found> find_grids(const cache::StoreReader& store, const Recipe& recipe, const Task& task) {
    Found found;
    const Where where = where_of(recipe, task);
    for (const level2::Moment moment : recipe.moments) {
        const auto entries = store.list(where.domain, moment, where.from, where.to);
        if (!entries) return pass_on(entries);
        for (const cache::StoreEntry& entry : *entries) {
            const auto file = cache::GridFile::open(entry.path);
            if (!file && may_be_sound(file.error())) return pass_on(file);
            if (!file) ++found.damaged;
            if (!file || !is_of(file->description(), recipe, task)) continue;
            const auto stamp = pipeline::stamp_of(entry.path);
            if (!stamp) continue;
            const grid::Provenance& provenance = file->description().provenance;
            found.standing.push_back(
                {task.kind() == TaskKind::frames ? std::string{} : provenance.source_files.front(),
                 stamp->modified_ns, entry.time, file->checksum(), entry.bytes_on_disk,
                 entry.path});
        }
    }
    return found;
}

}  // namespace

Result<std::vector<StandingGrid>> grids_standing(const cache::StoreReader& store, const Plan& plan,
                                                 const Task& task) {
    if (const auto* const part = std::get_if<MonthHour>(&task.work)) {
        std::vector<StandingGrid> counts;
        const auto bytes = read_file(tally_path(plan, *part));
        if (bytes) counts.push_back({{}, 0, {}, xxh3_64(*bytes), bytes->size(), {}});
        return counts;
    }
    auto found = find_grids(store, plan.recipe(), task);
    if (!found) return pass_on(found);
    return std::move(found->standing);
}

Status check_stands(const cache::StoreReader& store, const Plan& plan, const Task& task,
                    const Record& record) {
    const auto found = find_grids(store, plan.recipe(), task);
    if (!found) return pass_on(found);
    const std::size_t there = found->standing.size() + found->damaged;
    if (there > record.grids) return {};  // another plan uses the same cache
    if (there < record.grids) {
        return fail(ErrorCode::io,
                    "{}: has {} of the {} grids that task {} made; if the others are lost, submit "
                    "--deep makes them again",
                    plan.recipe().cache.native(), there, record.grids, task.number);
    }
    if (found->damaged > 0 || digest_of(found->standing) == record.digest) return {};
    return fail(ErrorCode::io, "{}: has other grids than task {} made; submit --deep settles it",
                plan.recipe().cache.native(), task.number);
}

Result<bool> is_sound(const StandingGrid& grid) {
    // A file of counts has no path here; its checksum covers all of its bytes.
    if (grid.path.empty()) return true;
    const auto file = cache::GridFile::open(grid.path);
    const Status sound = file ? file->verify() : Status{pass_on(file)};
    if (!sound && may_be_sound(sound.error())) return pass_on(sound);
    return sound.has_value();
}

Status remove_damaged(const cache::StoreReader& store, const Plan& plan, const Task& task) {
    const auto standing = grids_standing(store, plan, task);
    if (!standing) return pass_on(standing);
    for (const StandingGrid& grid : *standing) {
        const auto sound = is_sound(grid);
        if (!sound) return pass_on(sound);
        if (*sound) continue;
        // Drop the record, so that no frame is made before the task has made the grid again.
        if (Status dropped = drop_record(plan, task); !dropped) return dropped;
        std::error_code error;
        std::filesystem::remove(grid.path, error);
        if (error) return fail(ErrorCode::io, "{}: {}", grid.path.native(), error.message());
    }
    return {};
}

std::string digest_of(const std::vector<StandingGrid>& grids) {
    std::vector<std::uint64_t> sums;
    for (const StandingGrid& grid : grids)
        sums.push_back(grid.checksum);
    return fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(sums))));
}

}  // namespace stormcellar::batch
