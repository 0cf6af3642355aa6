#include "synth/replay.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <queue>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "level2/containers/gzip_stream.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/level2/chunk_name.h"
#include "synth/replay_pieces.h"
#include "synth/replay_turns.h"
#include "synth/replay_writer.h"

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

Status make_directory(const fs::path& path) {
    std::error_code problem;
    fs::create_directories(path, problem);
    if (problem) return fail(ErrorCode::io, "{}: {}", path.native(), problem.message());
    return {};
}

// Turns "20220317_000842" into "20220317-000842".
std::string volume_in_chunk_names(UtcTime time) {
    std::string text = format_compact(time);
    std::replace(text.begin(), text.end(), '_', '-');
    return text;
}

Clock::duration clock_seconds(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

// A file that is written piece by piece.
struct Growing {
    std::vector<std::byte> bytes;
    std::vector<std::size_t> ends;  // the ends of its pieces
    std::vector<Arrival> arrivals;
    std::size_t next = 0;  // index in arrivals
    bool ends_volume = false;

    [[nodiscard]] std::span<const std::byte> piece(std::size_t number) const {
        const std::size_t begin = number == 0 ? 0 : ends[number - 1];
        return std::span(bytes).subspan(begin, ends[number] - begin);
    }
};

class Player {
  public:
    Player(const std::vector<ReplayItem>& items, const fs::path& drop, FileSystem& file_system,
           const ReplayOptions& options, std::vector<fs::path> targets)
        : items_(items),
          drop_(drop),
          file_system_(file_system),
          options_(options),
          targets_(std::move(targets)),
          turns_(turns_of(items, options)),
          writer_(options.delivery == Delivery::open ? most_open_files : 0) {}

    Result<ReplayReport> play() {
        const auto played = options_.delivery == Delivery::whole ? play_whole() : play_pieces();
        if (!played) return pass_on(played);
        const auto closed = writer_.close();
        if (!closed) return pass_on(closed);
        report_.stopped = report_.files < items_.size();
        return std::move(report_);
    }

  private:
    // The time at which a file, or one of its pieces, is due.
    struct Due {
        double seconds = 0;
        std::size_t item = 0;
        bool operator>(const Due& other) const {
            return std::pair(seconds, item) > std::pair(other.seconds, other.item);
        }
    };

    [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }

    Status play_whole() {
        double due_s = 0;
        for (const Arrival& arrival : arrivals_of(options_.faults, 0, items_.size())) {
            // A reordered file comes right after the file that now precedes it.
            due_s = std::max(due_s, turns_[arrival.piece].start_s);
            if (!wait_until(due_s, arrival.piece)) return {};
            const ReplayItem& item = items_[arrival.piece];
            auto bytes = sources_.read(item.source);
            if (!bytes) return pass_on(bytes);
            if (options_.stamp) options_.stamp(item, *bytes);
            const std::size_t kept = note_arrival(item, item.name, 0, arrival, bytes->size());
            if (arrival.fault != Fault::drop) {
                const fs::path target = drop_ / item.name;
                auto done = make_directory(target.parent_path());
                if (done) {
                    done =
                        write_file_atomically(file_system_, target, std::span(*bytes).first(kept));
                }
                if (!done) return done;
            }
            if (!arrival.again) end_turn(item);
        }
        return {};
    }

    Status play_pieces() {
        std::priority_queue<Due, std::vector<Due>, std::greater<>> queue;
        for (std::size_t i = 0; i < items_.size(); ++i)
            queue.push({turns_[i].start_s, i});
        while (!queue.empty()) {
            const Due due = queue.top();
            queue.pop();
            if (!wait_until(due.seconds, due.item)) break;
            auto played = play_next(due.item);
            if (!played) {
                return fail(played.error().code, "{}{}", played.error().message,
                            growing_.empty() ? "" : "; some files stay unfinished");
            }
            if (const auto place = growing_.find(due.item); place != growing_.end()) {
                const double part = static_cast<double>(place->second.next) /
                                    static_cast<double>(place->second.arrivals.size());
                queue.push({turns_[due.item].start_s + part * turns_[due.item].span_s, due.item});
            }
        }
        for (const auto& [item, growing] : growing_)
            report_.unfinished.push_back(drop_ / targets_[item]);
        return {};
    }

    // Writes one piece. The first piece begins the file. After its last piece, the file is
    // forgotten.
    Status play_next(std::size_t item) {
        auto place = growing_.find(item);
        if (place == growing_.end()) {
            auto begun = begin(item);
            if (!begun) return pass_on(begun);
            place = growing_.emplace(item, std::move(*begun)).first;
        }
        Growing& growing = place->second;
        auto written = write_piece(item, growing);
        if (!written) return written;
        if (++growing.next == growing.arrivals.size()) {
            growing_.erase(place);
            end_turn(items_[item]);
        }
        return {};
    }

    Result<Growing> begin(std::size_t item) {
        auto bytes = sources_.read(items_[item].source);
        if (!bytes) return pass_on(bytes);
        const bool chunks = options_.delivery == Delivery::chunks;
        const fs::path target = drop_ / targets_[item];
        const auto made = make_directory(chunks ? target : target.parent_path());
        if (!made) return pass_on(made);
        Growing growing;
        growing.bytes = chunks ? level2::without_gzip(*bytes) : std::move(*bytes);
        if (options_.stamp) options_.stamp(items_[item], growing.bytes);
        growing.ends = piece_ends(growing.bytes);
        growing.arrivals =
            arrivals_of(options_.faults, static_cast<std::uint32_t>(item + 1), growing.ends.size());
        growing.ends_volume = chunks && ends_volume(growing.bytes);
        return growing;
    }

    Status write_piece(std::size_t item, const Growing& growing) {
        const Arrival& arrival = growing.arrivals[growing.next];
        const auto piece = growing.piece(arrival.piece);
        const bool chunks = options_.delivery == Delivery::chunks;
        const fs::path name =
            chunks ? targets_[item] / chunk_name(item, growing, arrival.piece) : targets_[item];
        const std::size_t kept =
            note_arrival(items_[item], name, arrival.piece + 1, arrival, piece.size());
        if (arrival.fault == Fault::drop) return {};
        const auto bytes = piece.first(kept);
        return chunks ? writer_.put(drop_ / name, bytes) : writer_.append(drop_ / name, bytes);
    }

    [[nodiscard]] std::string chunk_name(std::size_t item, const Growing& growing,
                                         std::size_t piece) const {
        level2::ChunkName name;
        name.volume = volume_in_chunk_names(*items_[item].time);
        name.number = static_cast<int>(piece) + 1;
        if (piece == 0) {
            name.kind = level2::ChunkKind::start;
        } else if (piece + 1 == growing.ends.size() && growing.ends_volume) {
            name.kind = level2::ChunkKind::end;
        }
        return to_string(name);
    }

    // Notes an arrival and its fault. Returns the number of bytes of the element to write.
    std::size_t note_arrival(const ReplayItem& item, const fs::path& name, std::size_t chunk,
                             const Arrival& arrival, std::size_t bytes) {
        const std::size_t kept = kept_bytes(arrival, bytes);
        const bool nothing_cut = arrival.fault == Fault::truncate && kept == bytes;
        if (arrival.fault != Fault::none && !arrival.again && !nothing_cut) {
            report_.faults.push_back({arrival.fault, item.source, name, chunk, bytes, kept});
        }
        if (arrival.fault != Fault::drop) ++report_.writes;
        report_.bytes += kept;
        return kept;
    }

    void end_turn(const ReplayItem& item) {
        ++report_.files;
        if (options_.replayed) options_.replayed(report_.files);
        if (options_.ended) options_.ended(item);
    }

    // Waits, checking the flag ten times a second. Returns false if the flag is set.
    [[nodiscard]] bool wait_until(double seconds, std::size_t item) {
        if (!has_begun_ && seconds >= options_.past_s) {
            has_begun_ = true;
            if (options_.begun) options_.begun();
            begin_ = Clock::now() - clock_seconds(options_.past_s);
        }
        if (!has_begun_) return !stopped();
        const auto end = begin_ + clock_seconds(seconds);
        const double wait_s = std::chrono::duration<double>(end - Clock::now()).count();
        if (wait_s > long_wait_s && options_.waits) options_.waits(wait_s, items_[item].source);
        while (!stopped() && Clock::now() < end) {
            std::this_thread::sleep_until(
                std::min(end, Clock::now() + std::chrono::milliseconds(100)));
        }
        return !stopped();
    }

    const std::vector<ReplayItem>& items_;
    const fs::path& drop_;
    FileSystem& file_system_;
    const ReplayOptions& options_;
    std::vector<fs::path> targets_;
    archive::SourceReader sources_;
    std::vector<ReplayTurn> turns_;
    PieceWriter writer_;
    std::map<std::size_t, Growing> growing_;  // by item
    ReplayReport report_;
    bool has_begun_ = false;  // the pieces due before past_s have been written
    Clock::time_point begin_;
};

}  // namespace

ReplayPlan plan_replay(const std::vector<ReplayItem>& items, const ReplayOptions& options) {
    ReplayPlan plan;
    plan.files = items.size();
    for (const ReplayItem& item : items) {
        if (!item.time) continue;
        plan.first = std::min(plan.first.value_or(*item.time), *item.time);
        plan.last = std::max(plan.last.value_or(*item.time), *item.time);
    }
    const bool whole = options.delivery == Delivery::whole;
    for (const ReplayTurn& turn : turns_of(items, options))
        plan.takes_s = std::max(plan.takes_s, turn.start_s + (whole ? 0 : turn.span_s));
    return plan;
}

Result<ReplayReport> replay(const std::vector<ReplayItem>& items, const fs::path& drop,
                            FileSystem& file_system, const ReplayOptions& options) {
    std::error_code problem;
    if (!fs::is_directory(drop, problem)) {
        return fail(ErrorCode::not_found, "{}: there is no such directory", drop.native());
    }
    auto targets = targets_of(items, options.delivery);
    if (!targets) return pass_on(targets);
    for (const fs::path& name : *targets) {
        const fs::path target = drop / name;
        if (fs::exists(fs::symlink_status(target, problem))) {
            return fail(ErrorCode::io, "{}: exists already; nothing was replayed", target.native());
        }
    }
    return Player(items, drop, file_system, options, std::move(*targets)).play();
}

}  // namespace stormcellar::synth
