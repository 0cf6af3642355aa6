#include "synth/replay.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <set>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include "level2/archive_header.h"
#include "level2/gzip_stream.h"
#include "level2/ldm_framer.h"

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t pieces_without_records = 16;
constexpr double longest_gap_s = 1e8;            // three years: no clock overflows
constexpr std::size_t start_bytes = 64U << 10U;  // holds the header, gzipped or not

// None when it cannot be read, which is said when its turn comes.
std::optional<UtcTime> time_in_header(const fs::path& path) {
    std::vector<char> start(start_bytes);
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    auto bytes = std::as_bytes(std::span(start));
    level2::GzipStream gzip(bytes);
    if (level2::is_gzip(bytes)) bytes = gzip.next();
    const auto header = level2::read_archive_header(bytes);
    if (!header) return std::nullopt;
    return header->time();
}

Result<std::vector<ReplayItem>> items_of(const fs::path& source) {
    std::error_code problem;
    if (!fs::exists(source, problem)) {
        return fail(ErrorCode::not_found, "{}: there is no such file or directory",
                    source.native());
    }
    std::vector<ReplayItem> items;
    if (fs::is_regular_file(source, problem)) {
        items.push_back({source, source.filename(), {}});
        return items;
    }
    if (!fs::is_directory(source, problem)) {
        return fail(ErrorCode::not_a_file, "{}: neither a file nor a directory", source.native());
    }
    fs::recursive_directory_iterator walk(source, problem);
    for (; !problem && walk != fs::recursive_directory_iterator(); walk.increment(problem)) {
        const fs::path& path = walk->path();
        const bool hidden = path.filename().native().starts_with('.');
        if (!hidden && walk->is_regular_file(problem)) {
            items.push_back({path, path.lexically_relative(source), {}});
        }
    }
    if (problem) return fail(ErrorCode::io, "{}: {}", source.native(), problem.message());
    return items;
}

// Known times first, then names.
bool earlier(const ReplayItem& a, const ReplayItem& b) {
    if (a.time.has_value() != b.time.has_value()) return a.time.has_value();
    if (a.time && *a.time != *b.time) return *a.time < *b.time;
    return a.name < b.name;
}

Status append(const fs::path& path, std::span<const std::byte> bytes) {
    const auto failed = [&path] {
        return fail(ErrorCode::io, "{}: {}", path.native(), std::system_category().message(errno));
    };
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) return failed();
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            Status outcome = failed();
            ::close(file);
            return outcome;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    if (::close(file) != 0) return failed();
    return {};
}

class Player {
  public:
    Player(const fs::path& drop, FileSystem& file_system, const ReplayOptions& options)
        : drop_(drop), file_system_(file_system), options_(options) {}

    Result<ReplayReport> play(const std::vector<ReplayItem>& items) {
        for (std::size_t i = 0; i < items.size() && !stopped(); ++i) {
            const bool last = i + 1 == items.size();
            if (!last) gap_s_ = gap(items[i], items[i + 1]);  // the last file takes that before it
            const auto begin = Clock::now();
            if (auto played = play_one(items[i]); !played) return pass_on(played);
            if (!last) wait_until(begin, gap_s_);
        }
        report_.stopped = report_.files < items.size();
        return report_;
    }

  private:
    [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }

    [[nodiscard]] double gap(const ReplayItem& item, const ReplayItem& next) const {
        if (options_.interval_s) return *options_.interval_s;
        if (!item.time || !next.time) return 0;
        const double gap_s = std::chrono::duration<double>(*next.time - *item.time).count();
        return std::min(gap_s / options_.speed, longest_gap_s);
    }

    Status play_one(const ReplayItem& item) {
        const auto bytes = read_file(item.source);
        if (!bytes) return pass_on(bytes);
        const fs::path target = drop_ / item.name;
        std::error_code problem;
        fs::create_directories(target.parent_path(), problem);
        if (problem) {
            return fail(ErrorCode::io, "{}: {}", target.parent_path().native(), problem.message());
        }
        if (options_.delivery == Delivery::whole) {
            auto written = write_file_atomically(file_system_, target, *bytes);
            if (!written) return written;
        } else {
            const auto whole = grow(target, *bytes);
            if (!whole) return pass_on(whole);
            if (!*whole) return {};
        }
        ++report_.files;
        report_.bytes += bytes->size();
        if (options_.replayed) options_.replayed(report_.files);
        return {};
    }

    // Gives whether all of it was written before somebody asked to stop.
    Result<bool> grow(const fs::path& target, std::span<const std::byte> bytes) {
        const auto begin = Clock::now();
        const std::vector<std::size_t> ends = piece_ends(bytes);
        std::size_t at = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            wait_until(begin, gap_s_ * static_cast<double>(i) / static_cast<double>(ends.size()));
            if (stopped()) {
                if (at > 0) report_.unfinished = target;
                return false;
            }
            const auto done = append(target, bytes.subspan(at, ends[i] - at));
            if (!done) {
                return fail(done.error().code, "{}; the file stays unfinished",
                            done.error().message);
            }
            at = ends[i];
        }
        return true;
    }

    // Looks at the flag ten times a second.
    void wait_until(Clock::time_point begin, double seconds) const {
        const auto end = begin + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(seconds));
        while (!stopped() && Clock::now() < end) {
            std::this_thread::sleep_until(
                std::min(end, Clock::now() + std::chrono::milliseconds(100)));
        }
    }

    const fs::path& drop_;
    FileSystem& file_system_;
    const ReplayOptions& options_;
    ReplayReport report_;
    double gap_s_ = options_.interval_s.value_or(0);  // from the file being played to the next
};

}  // namespace

Result<std::vector<ReplayItem>> find_replay_items(const std::vector<fs::path>& sources) {
    std::vector<ReplayItem> items;
    for (const fs::path& source : sources) {
        auto found = items_of(source);
        if (!found) return pass_on(found);
        std::move(found->begin(), found->end(), std::back_inserter(items));
    }
    if (items.empty()) return fail(ErrorCode::not_found, "there are no files to replay");
    std::set<fs::path> names;
    for (ReplayItem& item : items) {
        if (!names.insert(item.name).second) {
            return fail(ErrorCode::bad_argument, "{}: a second file of this name",
                        item.source.native());
        }
        item.time = time_in_header(item.source);
    }
    std::sort(items.begin(), items.end(), earlier);
    return items;
}

std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes) {
    std::vector<std::size_t> ends;
    const bool header = level2::read_archive_header(bytes).has_value();
    if (level2::is_ldm_record(bytes.subspan(header ? level2::archive_header_bytes : 0))) {
        level2::LdmFramer framer(bytes);
        bool first = true;
        while (const auto part = framer.next()) {
            if (part->kind != level2::LdmPart::Kind::record) continue;
            if (!first) ends.push_back(part->position);
            first = false;
        }
    } else {
        for (std::size_t i = 1; i < pieces_without_records; ++i) {
            const std::size_t end = bytes.size() * i / pieces_without_records;
            if (end > 0 && (ends.empty() || end > ends.back())) ends.push_back(end);
        }
    }
    if (ends.empty() || ends.back() < bytes.size()) ends.push_back(bytes.size());
    return ends;
}

Result<ReplayReport> replay(const std::vector<ReplayItem>& items, const fs::path& drop,
                            FileSystem& file_system, const ReplayOptions& options) {
    std::error_code problem;
    if (!fs::is_directory(drop, problem)) {
        return fail(ErrorCode::not_found, "{}: there is no such directory", drop.native());
    }
    for (const ReplayItem& item : items) {
        const fs::path target = drop / item.name;
        if (fs::exists(fs::symlink_status(target, problem))) {
            return fail(ErrorCode::io, "{}: exists already; nothing was replayed", target.native());
        }
    }
    return Player(drop, file_system, options).play(items);
}

}  // namespace stormcellar::synth
