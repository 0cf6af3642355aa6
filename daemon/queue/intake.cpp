#include "daemon/queue/intake.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/drop_names.h"

namespace stormcellar::daemon {
namespace {

namespace ended = pipeline::ended;

constexpr std::size_t most_growing = 4096;
constexpr std::size_t most_going_on = 4096;
// Number of problems that one pass of the main loop may report; the next scan reports the rest.
constexpr std::size_t most_problems = 64;
constexpr std::size_t most_told = 4096;
constexpr std::int64_t recent_ns = 1'000'000'000;
// If a scan finds a file that is younger than this, the file is live.
constexpr std::int64_t live_ns = 600 * recent_ns;

// Returns a key that all files of one volume share.
std::string volume_of(const std::filesystem::path& path) {
    auto chunk = pipeline::ChunkPath::of(path);
    return chunk ? std::move(chunk->key) : path.native();
}

// Returns true if the job gridded or registered a volume, or if it showed sweeps of a volume that
// goes on.
bool is_good(const Finished& finished) {
    if (!finished.taken) return false;
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    return outcome.goes_on || std::holds_alternative<ended::Gridded>(outcome.ending) ||
           std::holds_alternative<ended::Registered>(outcome.ending);
}

}  // namespace

Clock real_clock() {
    return {[] { return std::chrono::steady_clock::now(); },
            [] {
                return std::int64_t{std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count()};
            }};
}

Intake::Intake(const Config& config, Clock clock)
    : drop_(config.fixed.paths.drop),
      stations_(config.fixed.ingest.stations),
      clock_(std::move(clock)),
      reread_(config.reloadable.reread),
      schedule_(config.fixed.queue_limit),
      growing_(config.reloadable.quiet, most_growing) {
    schedule_.set_workers(config.reloadable.worker_count());
}

void Intake::reload(const ReloadableConfig& config) {
    reread_ = config.reread;
    growing_.set_quiet(config.quiet);
    schedule_.set_workers(config.worker_count());
}

std::string Intake::station_of(const std::filesystem::path& path) const {
    std::string station = pipeline::station_of_path(path);
    return stations_.knows(station) ? station : std::string{};
}

void Intake::leave_to_scan(const std::filesystem::path& path) {
    refused_ = true;
    seen_.forget(path);
}

// Notes whether the file's volume is going on, which means that it has closed sweeps but no end
// yet. Jobs of such a volume come before jobs of new volumes.
void Intake::note_going_on(const std::filesystem::path& path, bool goes_on) {
    if (!goes_on) {
        going_on_.erase(volume_of(path));
        return;
    }
    if (going_on_.size() >= most_going_on) going_on_.erase(going_on_.begin());
    going_on_.insert(volume_of(path));
}

void Intake::note_displaced() {
    for (const auto& paths : {schedule_.take_displaced(), growing_.take_displaced()}) {
        for (const std::filesystem::path& path : paths) {
            followed_.erase(path);
            leave_to_scan(path);
        }
    }
}

// Makes a job for the file. A followed file has been in the catalog since following began.
Job Intake::job_for(const std::filesystem::path& path, Urgency urgency) const {
    Job job;
    job.path = path;
    const bool is_followed = followed_.contains(path);
    job.urgency = urgency;
    // Treat the last chunk of a volume as urgent: if the volume could not be followed, its grid
    // waits for that chunk.
    const auto chunk = pipeline::ChunkPath::of(path);
    const bool is_end = chunk && chunk->name.kind == level2::ChunkKind::end;
    job.is_begun = is_end || going_on_.contains(volume_of(path));
    job.is_registered = is_followed;
    job.station = station_of(path);
    return job;
}

void Intake::offer(Job job, const FileStamp& stamp) {
    const std::filesystem::path path = job.path;
    hold(job);
    if (schedule_.offer(std::move(job), clock_.steady()) == Offered::refused) {
        leave_to_scan(path);
    } else {
        seen_.add(path, stamp);
    }
    note_displaced();
}

void Intake::hold_back(const std::map<std::filesystem::path, std::chrono::seconds>& waits) {
    for (const auto& [path, wait] : waits)
        held_back_[path] = clock_.steady() + wait;
}

void Intake::hold(Job& job) {
    const auto held = held_back_.find(job.path);
    if (held == held_back_.end()) return;
    if (clock_.steady() >= held->second) {
        held_back_.erase(held);
        return;
    }
    job.not_before = std::max(job.not_before, held->second);
    job.urgency = Urgency::backlog;
    job.newest_ns = 0;
}

// Returns the time of a close. It is never earlier than the last close, so that files keep their
// order even if the wall clock is set back.
std::int64_t Intake::closed_now_ns() {
    const std::int64_t now_ns = clock_.wall_ns();
    newest_closed_ns_ = now_ns >= newest_closed_ns_ ? now_ns : newest_closed_ns_ + 1;
    return newest_closed_ns_;
}

void Intake::file_closed(const std::filesystem::path& path, const FileStamp& stamp) {
    Job job = job_for(path, Urgency::live);
    job.closed_at = clock_.steady();
    job.newest_ns = closed_now_ns();
    const auto incomplete_at = growing_.found_incomplete_at(path);
    if (incomplete_at && !followed_.contains(path)) {
        const SteadyTime earliest = *incomplete_at + reread_;
        if (earliest > clock_.steady()) job.not_before = earliest;
    }
    growing_.forget(path);
    offer(std::move(job), stamp);
}

void Intake::file_created(const std::filesystem::path& path, const FileStamp& stamp) {
    if (!growing_.add_new(path, stamp, clock_.steady(), station_of(path))) leave_to_scan(path);
    note_displaced();
}

void Intake::file_found(const std::filesystem::path& path, const FileStamp& stamp) {
    if (growing_.contains(path)) return;  // growing_ reads the stamp every second anyway
    if (seen_.contains(path, stamp)) {
        seen_.found_again(path);
        return;
    }
    // If the file was just written, its writer is probably still writing.
    const std::int64_t age_ns = clock_.wall_ns() - stamp.modified_ns;
    if (age_ns >= 0 && age_ns < recent_ns) {
        file_created(path, stamp);
    } else {
        const bool is_live = age_ns >= -live_ns && age_ns < live_ns;
        Job job = job_for(path, is_live ? Urgency::live : Urgency::backlog);
        // A time in the future must not put this file before files that are closed now.
        job.newest_ns = std::min(stamp.modified_ns, clock_.wall_ns());
        offer(std::move(job), stamp);
    }
}

// Queues the file, so that the sink finds it missing and marks its rows. The job is not urgent and
// comes last. If the schedule refuses the job, RowKeeper marks the rows later.
void Intake::file_gone(const std::filesystem::path& path) {
    growing_.forget(path);
    followed_.erase(path);
    seen_.forget(path);
    Job job;
    job.path = path;
    schedule_.offer(std::move(job), clock_.steady());
}

// Handles a directory that is gone. If it was moved away, the kernel does not report its files.
// Followed files are known by path, and are handled here. Other files are known only by hash, so a
// scan must follow; then RowKeeper marks their rows.
void Intake::directory_gone(const std::filesystem::path& path, bool deleted) {
    std::vector<std::filesystem::path> gone;
    const auto is_below = [&](const std::filesystem::path& file) {
        return std::mismatch(path.begin(), path.end(), file.begin(), file.end()).first ==
               path.end();
    };
    for (auto at = followed_.lower_bound(path); at != followed_.end() && is_below(*at); ++at)
        gone.push_back(*at);
    for (const std::filesystem::path& file : gone)
        file_gone(file);
    if (!deleted) lost_ = true;
}

void Intake::entry_left_out(const std::filesystem::path& path, std::string_view kind) {
    tell({ErrorCode::not_a_file, fmt::format("{}: is {}, so it is not read", path.native(), kind)});
}

void Intake::tell(Error problem) {
    const std::filesystem::path key = problem.message;
    if (told_.contains(key, {})) return told_.found_again(key);
    if (problems_.size() >= most_problems) return;
    if (told_.count() < most_told) told_.add(key, {});
    problems_.push_back(std::move(problem));
}

void Intake::entry_unseen() {
    ++unseen_;
    if (!look_again_at_) {
        look_again_at_ = clock_.steady() + Schedule::retry_delay(looks_in_vain_ + 1);
    }
}

void Intake::events_lost() {
    ++overflows_;
    lost_ = true;
}

void Intake::drop_vanished() {
    lost_ = true;
}

void Intake::directory_problem(const Error& error) {
    tell(error);
}

void Intake::forget_seen() {
    seen_.forget_all();
    lost_ = true;
}

void Intake::poll_growing() {
    for (GrowingFiles::Due& due : growing_.poll(
             clock_.steady(), [this](const std::filesystem::path& path) { return look(path); })) {
        Job job = job_for(due.path, Urgency::live);
        job.finish_as_is = due.finish_as_is;
        job.newest_ns = std::min(due.stamp.modified_ns, clock_.wall_ns());
        offer(std::move(job), due.stamp);
    }
}

// Handles a job that failed. Puts it back for another attempt. After the last attempt, or if too
// many jobs already wait for another attempt, leaves the file to the next scan.
void Intake::job_failed(const Finished& finished) {
    const ErrorCode code = finished.taken.error().code;
    const bool was_last = finished.job.failures + 1 >= most_tries && !is_shortage(code);
    if (was_last) schedule_.finished(finished.job.path);
    if (was_last || !schedule_.retry(finished.job, finished.ended))
        leave_to_scan(finished.job.path);
    // A full disk makes all jobs fail, so do not decode the next file yet.
    if (code == ErrorCode::no_space) {
        schedule_.hold_until(finished.ended + Schedule::retry_delay(finished.job.failures + 1));
    }
}

// Queues the job again. Puts it into the backlog, so that live jobs come first.
void Intake::give_next_turn(const Finished& finished) {
    schedule_.finished(finished.job.path);
    Job job = job_for(finished.job.path, Urgency::backlog);
    job.finish_as_is = finished.job.finish_as_is;
    job.newest_ns = finished.job.newest_ns;
    offer(std::move(job), finished.taken->stamp);
}

// Notes that the chunk `by` now represents the volume instead of the chunk `former`, which must no
// longer be polled. If the job of `former` is not collected yet, relieved_ keeps job_ended() from
// adding `former` again; jobs may be collected in another order than they ran.
void Intake::note_represented(const std::filesystem::path& former,
                              const std::filesystem::path& by) {
    if (former.empty() || former == by) return;
    growing_.forget(former);
    if (schedule_.is_running(former)) relieved_.insert_or_assign(former, by);
}

void Intake::job_ended(const Finished& finished) {
    const std::filesystem::path& path = finished.job.path;
    schedule_.worked(path, finished.ended - finished.started, finished.ended, is_good(finished));
    const auto relieved = relieved_.extract(path);
    if (!finished.taken) return job_failed(finished);
    const pipeline::IngestOutcome& outcome = finished.taken->ingest;
    SteadyTime again{};
    followed_.erase(path);
    note_going_on(path, outcome.goes_on);
    const bool is_relieved = relieved && relieved.mapped() != outcome.former_representative;
    if (const auto* rest = std::get_if<ended::Incomplete>(&outcome.ending)) {
        if (rest->has_next_turn) return give_next_turn(finished);
        if (!rest->is_followed) again = finished.ended + reread_;
        if (is_relieved) {
            // Another chunk now represents the volume of this file.
        } else if (!growing_.add_incomplete(path, finished.taken->stamp, finished.ended,
                                            rest->is_followed, station_of(path))) {
            leave_to_scan(path);
        } else if (rest->is_followed) {
            followed_.insert(path);
        }
    } else if (std::holds_alternative<ended::Vanished>(outcome.ending)) {
        seen_.forget(path);
    }
    note_represented(outcome.former_representative, path);
    schedule_.finished(path, again);
    note_displaced();
}

// Puts a job back after an attempt to register its file, or ends the job if the file is gone. If
// the attempt failed, the file is registered when it is ingested.
void Intake::registered(const Finished& noted) {
    if (noted.taken && std::holds_alternative<ended::Vanished>(noted.taken->ingest.ending)) {
        job_ended(noted);
    } else {
        schedule_.registered(noted.job.path);
    }
}

void Intake::begin_scan() {
    lost_ = false;
    refused_ = false;
    is_looking_again_ = look_again_at_.has_value();
    looks_in_vain_ += is_looking_again_ ? 1 : 0;
    look_again_at_.reset();
    seen_.begin_scan();
    told_.begin_scan();
}

void Intake::end_scan(bool whole) {
    if (!whole) {
        if (is_looking_again_) entry_unseen();
        return;
    }
    if (!look_again_at_) looks_in_vain_ = 0;
    seen_.end_scan();
    told_.end_scan();
    // Handle followed files that are gone without an event.
    const std::vector<std::filesystem::path> followed(followed_.begin(), followed_.end());
    for (const std::filesystem::path& path : followed) {
        const Standing standing = look(path).standing;
        if (standing != Standing::regular && standing != Standing::unknown) file_gone(path);
    }
}

bool Intake::needs_scan() const {
    const bool looks_again = look_again_at_ && *look_again_at_ <= clock_.steady();
    return lost_ || looks_again || (refused_ && schedule_.waiting_count() < schedule_.limit() / 2);
}

std::optional<SteadyTime> Intake::next_time(bool can_start, bool can_register) const {
    std::optional<SteadyTime> time;
    if (can_register) time = schedule_.next_unregistered_time();
    for (const auto& other :
         {can_start ? schedule_.next_time() : std::nullopt, growing_.next_time()}) {
        if (other) time = time ? std::min(*time, *other) : *other;
    }
    return time;
}

SteadyTime::duration Intake::longest_wait() const {
    const auto oldest = schedule_.oldest_offer();
    return oldest ? clock_.steady() - *oldest : SteadyTime::duration{};
}

Pending Intake::pending() const {
    return {schedule_.waiting_count(), schedule_.running_count(), growing_.count(),
            schedule_.retrying_count()};
}

}  // namespace stormcellar::daemon
