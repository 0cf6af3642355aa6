#include "fetch/feed/station_feed.h"

#include <algorithm>
#include <utility>

#include "service/log.h"

namespace stormcellar::feed {
namespace {

// A chunk has 20 to 300 kB.
constexpr std::uint64_t most_chunk_bytes = std::uint64_t{4} << 20;
constexpr int most_bad_tries = 3, most_tries = 8;
constexpr std::chrono::milliseconds longest_between_chunks{60'000};

// Returns true if the error concerns only one chunk, so that the server itself works.
bool is_of_the_chunk(ErrorCode code) {
    return code == ErrorCode::truncated || code == ErrorCode::over_budget ||
           code == ErrorCode::not_found || code == ErrorCode::permission || code == ErrorCode::io;
}

}  // namespace

StationFeed::StationFeed(std::string station, const std::vector<VolumeId>& written, FeedTools tools,
                         unsigned seed)
    : station_(std::move(station)),
      tools_(tools),
      pace_(tools.config.every, tools.config.most_in_vain, seed),
      follower_(station_, written, steady_now()) {
    status_.station = station_;
}

StationStatus StationFeed::status() const {
    StationStatus status = status_;
    status.is_searching = follower_.is_searching();
    status.volume = follower_.volume();
    status.chunk = follower_.chunk();
    status.missing = follower_.missing();
    return status;
}

void StationFeed::ask(std::chrono::milliseconds wait) {
    ++status_.listings;
    const SteadyTime now = steady_now();
    tools_.client.list(follower_.question(now, pace_.is_silent(now)), wait,
                       [this](Result<fetch::ListingPage> answer) { take(std::move(answer)); });
}

void StationFeed::take(Result<fetch::ListingPage> answer) {
    if (!answer) return fail_turn(answer.error());
    status_.answered = now_utc();
    auto news = follower_.take(*answer, now_utc(), steady_now());
    if (news.chunks.empty()) {
        note_good();
        pace_.note_nothing(steady_now());
        note_silence();
        return ask(pace_.pause(steady_now(), news.is_urgent));
    }
    const auto& last = news.chunks.back().modified;
    if (last && modified_) {
        const auto each = (*last - *modified_) / static_cast<int>(news.chunks.size());
        between_chunks_ = std::clamp<std::chrono::milliseconds>(each, {}, longest_between_chunks);
    }
    if (last) modified_ = last;
    wanted_.assign(news.chunks.begin(), news.chunks.end());
    has_news_ = false;
    get_next();
}

// Handles the chunks that need no request, and then requests the first chunk that needs one.
void StationFeed::get_next() {
    while (!wanted_.empty()) {
        const StationFollower::Chunk& chunk = wanted_.front();
        const std::string key = to_string(chunk.key);
        if (chunk.size_bytes == 0 || chunk.size_bytes > most_chunk_bytes) {
            give_up({ErrorCode::over_budget,
                     fmt::format("{}: has {} bytes, which no chunk has", key, chunk.size_bytes)});
        } else if (tools_.drop.has(chunk.key, chunk.size_bytes)) {
            ++status_.present;
            has_news_ = true;
            finish_chunk();
        } else {
            tools_.client.get(key, chunk.size_bytes,
                              [this](Result<Bytes> bytes) { keep(std::move(bytes)); });
            return;
        }
    }
    finish_turn();
}

void StationFeed::keep(Result<Bytes> bytes) {
    const ChunkKey key = wanted_.front().key;
    if (bytes) {
        if (const Status written = tools_.drop.write(key, *bytes); !written)
            return fail_turn(written.error());
        ++status_.written;
        status_.written_at = now_utc();
        has_news_ = true;
        say(LogLevel::debug, "{}: {} bytes", to_string(key), bytes->size());
        finish_chunk();
        return get_next();
    }
    tries_ = key == tried_ ? tries_ + 1 : 1;
    tried_ = key;
    if (tries_ < (is_of_the_chunk(bytes.error().code) ? most_bad_tries : most_tries))
        return fail_turn(bytes.error());
    give_up(bytes.error());
    get_next();
}

void StationFeed::finish_chunk() {
    follower_.note_done(wanted_.front().key);
    wanted_.pop_front();
}

void StationFeed::give_up(const Error& why) {
    ++status_.refused;
    complain(why);
    finish_chunk();
}

// Notes that a failure is over. Call it only after a whole turn has worked, because the bucket may
// answer while the disk is still full.
void StationFeed::note_good() {
    if (status_.error.empty()) return;
    status_.error.clear();
    status_.next_try.reset();
    quiet_since_ += steady_now() - failing_since_;  // do not count a time of failures as silence
    if (tools_.lines.allow(steady_now())) say(LogLevel::info, "{}: continues", station_);
}

void StationFeed::finish_turn() {
    note_good();
    const SteadyTime now = steady_now();
    if (has_news_) {
        if (status_.is_silent && tools_.lines.allow(now))
            say(LogLevel::info, "{}: chunks come again", station_);
        status_.is_silent = false;
        quiet_since_ = now;
        pace_.note_news(now, between_chunks_);
    } else {
        pace_.note_nothing(now);
        note_silence();
    }
    ask(pace_.pause(now));
}

void StationFeed::fail_turn(const Error& why) {
    ++status_.failures;
    if (status_.error.empty()) {
        failing_since_ = steady_now();
        complain(why);
    }
    status_.error = why.message;
    wanted_.clear();
    const SteadyTime now = steady_now();
    pace_.note_failure(now, tools_.client.retry_after());
    const auto pause = pace_.pause(now);
    status_.next_try = now_utc() + pause;
    ask(pause);
}

void StationFeed::note_silence() {
    const SteadyTime now = steady_now();
    if (status_.is_silent || now - quiet_since_ < tools_.config.silent_after) return;
    status_.is_silent = true;
    if (!tools_.lines.allow(now)) return;
    say(LogLevel::warning, "{}: {}", station_,
        follower_.is_searching() ? "the bucket has no volume of this station"
                                 : "no chunk has come for 10 minutes");
}

void StationFeed::complain(const Error& why) {
    if (tools_.lines.allow(steady_now())) say(LogLevel::warning, "{}: {}", station_, why.message);
}

}  // namespace stormcellar::feed
