#include "batch/grid_task.h"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <sys/stat.h>

#include "batch/check.h"
#include "batch/held_cache.h"
#include "batch/leftovers.h"
#include "batch/source.h"
#include "batch/standing.h"
#include "batch/usage.h"
#include "pipeline/care/archive_fill.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;
using pipeline::IngestOutcome;
using pipeline::IngestResult;

// Times at which existing grids were written (ns since 1970), by the names of their volumes.
using StandingFiles = std::map<std::string, std::int64_t>;

std::size_t hour_of(const fs::path& path) {
    const std::string name = path.filename();  // of the file, or of a member
    const auto volume = volume_named(name.substr(name.find_last_of(member_mark) + 1));
    if (!volume) return 0;
    return static_cast<std::size_t>((volume->start - UtcTime{volume->day()}) /
                                    std::chrono::hours{1});
}

class GridRun {
  public:
    GridRun(const Plan& plan, const Task& task, const TaskOptions& options,
            cache::StoreWriter& store)
        : plan_(plan),
          recipe_(plan.recipe()),
          task_(task),
          day_(std::get<StationDay>(task.work)),
          options_(options),
          store_(store) {
        record_.number = task.number;
        record_.plan = plan.facts().hash;
        record_.station = day_.station;
        record_.day = format_compact(UtcTime{day_.day}).substr(0, 8);
    }

    Result<Record> run() {
        auto brought = bring(recipe_, day_, make_directory("files"), options_.stop);
        if (!brought) return pass_on(brought);
        auto catalog = catalog::CatalogWriter::open(options_.scratch / "catalog");
        if (!catalog) return pass_on(catalog);
        pipeline::Ingestor ingestor(*catalog, store_, ingest_options(brought->beneath));
        const auto done = files_done(brought->files);
        if (!done) return pass_on(done);
        record_.files = brought->files.size() + brought->left_out.size();
        if (Status whole = check_whole(*brought); !whole) return pass_on(whole);
        for (const pipeline::LeftOut& refused : brought->left_out)
            leave_out(refused.path, refused.reason);
        for (const fs::path& path : brought->files) {
            if (done->contains(path)) {
                ++record_.taken_by_hour.at(hour_of(path));
                continue;
            }
            if (options_.stop) return fail(ErrorCode::busy, "stopped; the next run continues");
            if (Status taken = take(ingestor, path); !taken) return pass_on(taken);
        }
        if (unread_) return tl::unexpected<Error>(std::move(*unread_));
        const auto standing = grids_standing(store_, plan_, task_);
        if (!standing) return pass_on(standing);
        record_.grids = standing->size();
        record_.digest = digest_of(*standing);
        usage_.end(record_);
        return std::move(record_);
    }

  private:
    fs::path make_directory(const char* name) const {
        fs::path path = options_.scratch / name;
        std::error_code ignored;
        fs::create_directories(path, ignored);
        return path;
    }

    [[nodiscard]] pipeline::IngestOptions ingest_options(const fs::path& beneath) const {
        auto options = pipeline::ingest_options(recipe_.archive_options(options_.threads));
        options.moments = recipe_.moments;
        options.beneath = beneath;
        return options;
    }

    // Fails if files of the plan are missing. For example, a source that is not mounted is an empty
    // directory.
    [[nodiscard]] Status check_whole(const BroughtFiles& brought) const {
        if (brought.files.size() >= day_.files) return {};
        return fail(ErrorCode::io,
                    "{}: has {} of the {} files that the plan counted; if the others are gone for "
                    "good, make another plan",
                    recipe_.source, brought.files.size(), day_.files);
    }

    // Returns the files that need not be read again, because each has a grid that is not older than
    // the file. Excludes the last of these files, because it may lack the grid of another moment.
    Result<std::set<fs::path>> files_done(const std::vector<fs::path>& files) const {
        const auto standing = grids_standing(store_, plan_, task_);
        if (!standing) return pass_on(standing);
        StandingFiles made_of;
        for (const StandingGrid& grid : *standing)
            made_of[grid.volume] = grid.made_ns;
        std::set<fs::path> done;
        std::optional<fs::path> last;
        for (const fs::path& path : files) {
            const auto named = volume_named(path.filename().native());
            if (!named) continue;
            const auto found = made_of.find(level2::volume_name(named->station, named->start));
            const auto stamp = pipeline::stamp_of(path);
            if (found == made_of.end() || !stamp || stamp->modified_ns > found->second) continue;
            done.insert(path);
            last = path;
        }
        if (last) done.erase(*last);
        return done;
    }

    Status take(pipeline::Ingestor& ingestor, const fs::path& path) {
        auto outcome = ingestor.ingest(path, true);
        // Grid the other files before failing, so that another try has little left to do.
        if (!outcome && outcome.error().code == ErrorCode::io) {
            if (!unread_) unread_ = std::move(outcome.error());
            return {};
        }
        if (!outcome && !is_shortage(outcome.error().code))
            outcome = ingestor.give_up(path, outcome.error());
        if (!outcome) return pass_on(outcome);
        // Count the file as unread, because another user may be able to read it, or the source may
        // be mounted again.
        const auto* const rejected = std::get_if<pipeline::ended::Rejected>(&outcome->ending);
        if ((rejected && rejected->with == ErrorCode::permission) ||
            outcome->result() == IngestResult::vanished) {
            if (!unread_)
                unread_ = Error{ErrorCode::io,
                                fmt::format("{}: {}", path.native(),
                                            rejected ? outcome->reason : std::string{"is gone"})};
            return {};
        }
        const std::string name = path.filename().native();
        std::error_code ignored;
        const auto size = fs::file_size(path, ignored);
        if (!ignored) record_.bytes_read += size;
        if (outcome->result() != IngestResult::gridded) {
            leave_out(path, pipeline::reason_left_out(*outcome, recipe_.moments.front()));
            return {};
        }
        if (!outcome->reason.empty()) record_.notes.push_back({name, outcome->reason});
        ++record_.taken_by_hour.at(hour_of(path));
        count_written(outcome->grids);
        count_written(outcome->partials);
        return {};
    }

    void leave_out(const fs::path& path, std::string reason) {
        record_.left_out.push_back({path.filename().native(), std::move(reason)});
        ++record_.left_out_by_hour.at(hour_of(path));
    }

    void count_written(const std::vector<fs::path>& paths) {
        for (const fs::path& path : paths) {
            struct stat facts {};
            if (::stat(path.c_str(), &facts) == 0)
                record_.bytes_written += static_cast<std::uint64_t>(facts.st_blocks) * 512;
        }
    }

    const Plan& plan_;
    const Recipe& recipe_;
    const Task& task_;
    const StationDay& day_;
    const TaskOptions& options_;
    cache::StoreWriter& store_;
    Usage usage_;
    Record record_;
    std::optional<Error> unread_;  // of the first file that could not be read or gridded
};

}  // namespace

Result<TaskOutcome> run_grid_task(const Plan& plan, const Task& task, const TaskOptions& options) {
    auto store = cache::StoreWriter::open(real_file_system(), plan.recipe().cache, false);
    if (!store) return pass_on(store);
    const HeldCache held(plan.recipe().cache);
    remove_own_leftovers(plan.recipe(), task);
    if (Status removed = remove_damaged(*store, plan, task); !removed) return pass_on(removed);
    if (auto record = read_record(plan, task)) {
        const auto standing = grids_standing(*store, plan, task);
        if (!standing) return pass_on(standing);
        if (digest_of(*standing) == record->digest) return TaskOutcome{true, std::move(*record)};
        // Drop the record, so that no frame is made before the task has made its grids again.
        if (Status dropped = drop_record(plan, task); !dropped) return pass_on(dropped);
    }
    auto record = GridRun(plan, task, options, *store).run();
    if (!record) return pass_on(record);
    if (Status same = held.check(); !same) return pass_on(same);
    if (Status written = keep_record(plan, *record); !written) return pass_on(written);
    return TaskOutcome{false, std::move(*record)};
}

}  // namespace stormcellar::batch
