#include "fetch/pull/source_puller.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fetch/pull/grid_list.h"
#include "service/log.h"

namespace stormcellar::pull {
namespace {

constexpr std::chrono::milliseconds first_pause{1000}, longest_pause{60'000};
constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30;
// The list of grids is requested from a multiple of this time on, so that its URL and its tag stay
// the same for a while.
constexpr std::chrono::minutes list_step{10};
// Most turns request only the grids of the last half hour. About every 12th turn requests the whole
// list, to find late grids.
constexpr std::chrono::minutes short_list{30};
constexpr int short_lists = 12;
// Grids younger than this are requested again. A machine makes a partial again within minutes, when
// the rest of its volume comes.
constexpr std::chrono::minutes young{20};
constexpr std::chrono::seconds between_asking{60};
// Limits of one turn. So fetching many missing grids takes several turns, and a machine that sends
// junk is paused.
constexpr int most_of_a_turn = 1000, most_refused_in_a_row = 16;

// Returns true if the error concerns only one grid, so that the machine itself works.
bool is_of_the_grid(ErrorCode code) {
    return code == ErrorCode::corrupt || code == ErrorCode::truncated ||
           code == ErrorCode::unsupported || code == ErrorCode::over_budget ||
           code == ErrorCode::empty;
}

UtcTime rounded_down(UtcTime time) {
    return time - time.time_since_epoch() % list_step;
}

}  // namespace

std::chrono::milliseconds pause_after(int failures) {
    return std::min(longest_pause, first_pause * (1 << std::clamp(failures - 1, 0, 10)));
}

SourcePuller::SourcePuller(PullSource source, const PullConfig& config, PulledGrids grids,
                           const std::atomic<bool>& stop)
    : source_(std::move(source)),
      config_(config),
      grids_(std::move(grids)),
      stop_(stop),
      client_({.stall = config.stall, .stop = &stop, .beat = [this] { beat(); }}) {
    status_.name = source_.name;
    status_.url = source_.url;
    note_outcome({});
}

Status SourcePuller::turn() {
    fetched_ = refused_in_a_row_ = 0;
    if (const auto lines = lines_.take_held_back(steady_now()))
        say(LogLevel::warning, "{}: {} more grids were refused", source_.name, *lines);
    Status done = try_to_pull();
    if (stop_) return {};
    const std::size_t removed = grids_.prune(now_utc());
    {
        const MutexLock lock(mutex_);
        status_.removed += removed;
    }
    failures_ = done ? 0 : failures_ + 1;
    note_outcome(done);
    return done;
}

// Runs a turn. An exception ends only this turn and not the service.
Status SourcePuller::try_to_pull() {
    try {
        return pull();
    } catch (const std::exception& error) {  // memory is short
        return fail(ErrorCode::exhausted, "cannot fetch its grids: {}", error.what());
    }
}

std::chrono::milliseconds SourcePuller::pause() const {
    if (failures_ == 0) return config_.every;
    const auto asked = client_.retry_after().value_or(std::chrono::seconds{0});
    return std::clamp<std::chrono::milliseconds>(asked, pause_after(failures_), longest_pause);
}

SourceStatus SourcePuller::status() const {
    const MutexLock lock(mutex_);
    return status_;
}

// Notes in the status how a turn ended. Also called at the start, before the first turn.
void SourcePuller::note_outcome(const Status& done) {
    const MutexLock lock(mutex_);
    status_.grids = grids_.count();
    status_.bytes = grids_.bytes();
    status_.newest = grids_.newest();
    status_.error = done ? std::string{} : done.error().message;
    status_.next_try.reset();
    if (done) return;
    ++status_.failures;
    status_.next_try = now_utc() + pause();
}

Status SourcePuller::pull() {
    const UtcTime now = now_utc();
    const bool is_long = steady_now() >= next_long_list_;
    const auto back = is_long ? std::chrono::milliseconds{config_.age}
                              : std::min<std::chrono::milliseconds>(config_.age, short_list);
    const auto news = list(rounded_down(std::max(now - back, UtcTime{list_step})), now);
    if (!news) return pass_on(news);
    if (is_long) next_long_list_ = steady_now() + short_lists * config_.every;
    if (Status fetched = fetch_missing(); !fetched) return fetched;
    return ask_again(now);
}

// Fetches the list. Returns true if it differs from the last list.
Result<bool> SourcePuller::list(UtcTime from, UtcTime now) {
    std::vector<std::byte> text;
    const std::string url = list_url(source_, from);
    const auto answer = client_.get({.url = url,
                                     .known_tag = url == list_url_ ? list_tag_ : std::string{},
                                     .most_bytes = most_list_bytes,
                                     .take = [&](std::span<const std::byte> bytes) -> Status {
                                         text.insert(text.end(), bytes.begin(), bytes.end());
                                         return {};
                                     }});
    if (!answer) return pass_on(answer);
    if (!answer->is_unchanged) {
        auto listed = parse_grid_list(text, source_, std::max(from, now - config_.age), now);
        if (!listed) return pass_on(listed);
        listed_ = std::move(*listed);
        list_url_ = url;
        list_tag_ = answer->tag;
        forget_unlisted(from, now);
    }
    const MutexLock lock(mutex_);
    status_.answered = now_utc();
    return !answer->is_unchanged;
}

// Forgets requests and refusals of grids that are too old, and of grids that the list lacks. The
// list begins at `from`.
void SourcePuller::forget_unlisted(UtcTime from, UtcTime now) {
    const std::set<cache::GridName> listed(listed_.begin(), listed_.end());
    const auto is_gone = [&](const auto& one) {
        const UtcTime time = one.first.time;
        return time < now - config_.age || (time >= from && !listed.contains(one.first));
    };
    std::erase_if(asked_, is_gone);
    std::erase_if(bad_, is_gone);
}

bool SourcePuller::may_fetch() const {
    return !stop_ && fetched_ < most_of_a_turn;
}

// Removes the oldest grids to make room. Returns false if that removed the new grid `name`.
bool SourcePuller::make_room_for(const cache::GridName& name) {
    if (grids_.bytes() <= config_.bytes_a_source) return true;
    const std::uint64_t bytes = grids_.bytes();
    const std::size_t removed = grids_.prune(now_utc());
    if (!grids_.has(name)) no_room_ = {name.time, bytes - grids_.bytes()};
    const MutexLock lock(mutex_);
    status_.removed += removed;
    return grids_.has(name);
}

bool SourcePuller::has_room_for(const cache::GridName& name) const {
    return !no_room_ || name.time > no_room_->time ||
           grids_.bytes() + no_room_->bytes <= config_.bytes_a_source;
}

void SourcePuller::complain(const Error& why) {
    if (lines_.allow(steady_now())) say(LogLevel::warning, "{}: {}", source_.name, why.message);
}

Status SourcePuller::fetch_missing() {
    for (const cache::GridName& name : listed_) {
        if (!may_fetch()) return {};
        if (grids_.has(name)) continue;
        if (!has_room_for(name)) return {};
        if (Status fetched = fetch(name); !fetched) return fetched;
        // Grids come newest first. If there is no room for this grid, there is none for older
        // grids.
        if (!make_room_for(name)) return {};
    }
    return {};
}

Status SourcePuller::ask_again(UtcTime now) {
    for (const cache::GridName& name : listed_) {
        if (!may_fetch() || name.time < now - young) return {};
        const auto asked = asked_.find(name);
        const bool is_due = asked == asked_.end() || steady_now() >= asked->second + between_asking;
        if (!grids_.has(name) || !is_due) continue;
        if (Status fetched = fetch(name); !fetched) return fetched;
        if (!make_room_for(name)) return {};
    }
    return {};
}

// Fetches a grid, unless requests for it are paused. Fails only if the machine itself must be
// paused.
Status SourcePuller::fetch(const cache::GridName& name) {
    const auto known = bad_.find(name);
    if (known != bad_.end() && steady_now() < known->second.next) return {};
    ++fetched_;
    const Status done = get(name);
    if (name.time >= now_utc() - young) asked_[name] = steady_now();
    if (done) {
        refused_in_a_row_ = 0;
        bad_.erase(name);
        return {};
    }
    // The machine has evicted the grid since the list was made.
    if (done.error().code == ErrorCode::not_found) return {};
    if (!is_of_the_grid(done.error().code)) return done;
    Bad& bad = bad_[name];
    bad.next = steady_now() + pause_after(++bad.tries);
    if (bad.tries == 1) complain(done.error());
    {
        const MutexLock lock(mutex_);
        ++status_.refused;
    }
    if (++refused_in_a_row_ < most_refused_in_a_row) return {};
    return fail(ErrorCode::corrupt, "{} grids in a row were refused, the last: {}",
                refused_in_a_row_, done.error().message);
}

Status SourcePuller::get(const cache::GridName& name) {
    beat();
    std::optional<PulledGrids::Incoming> incoming;  // set when the first bytes arrive
    const auto take = [&](std::span<const std::byte> bytes) -> Status {
        if (!incoming) {
            auto begun = grids_.begin(name);
            if (!begun) return pass_on(begun);
            incoming.emplace(std::move(*begun));
        }
        return incoming->append(bytes);
    };
    const auto answer =
        client_.get({.url = file_url(source_, name),
                     .known_tag = grids_.tag_of(name),
                     .most_bytes = std::min(most_file_bytes, config_.bytes_a_source),
                     .take = take});
    if (!answer) return pass_on(answer);
    if (answer->is_unchanged) return {};
    if (!incoming) return fail(ErrorCode::empty, "{}: an empty answer", file_url(source_, name));
    if (Status kept = grids_.keep(std::move(*incoming), answer->tag); !kept) return kept;
    say(LogLevel::debug, "{}: {} {} {}, {} bytes", source_.name, name.domain,
        level2::moment_name(name.moment), format_utc(name.time), answer->bytes);
    const MutexLock lock(mutex_);
    ++status_.pulled;
    return {};
}

}  // namespace stormcellar::pull
