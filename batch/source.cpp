#include "batch/source.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>

#include "base/printable.h"
#include "batch/plan.h"
#include "pipeline/drop/drop_names.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/fetch/fetch.h"

namespace stormcellar::batch {
namespace {

namespace fs = std::filesystem;

constexpr int max_depth = 16;  // of directories; the daemon's limit is the same
constexpr int transfers_of_a_task = 4;

struct TimeSpan {
    UtcTime from, to;
    [[nodiscard]] bool has(UtcTime time) const { return from <= time && time <= to; }
};

bool is_archive_name(std::string_view name) {
    static constexpr std::array<std::string_view, 6> endings = {".tar", ".tar.gz",  ".tgz",
                                                                ".zip", ".tar.bz2", ".tar.Z"};
    return std::ranges::any_of(endings, [&](auto ending) { return name.ends_with(ending); });
}

Error failure(const fs::path& path, const std::error_code& error) {
    return {error == std::errc::no_such_file_or_directory ? ErrorCode::not_found : ErrorCode::io,
            fmt::format("{}: {}", path.native(), error.message())};
}

// Returns the file name of a member, which may be in an archive inside the archive.
std::string own_name_of(const std::string& member) {
    return fs::path(member.substr(member.find_last_of(member_mark) + 1)).filename();
}

// Calls `take` for each member that is a file. Then calls `leave_out` for each unreadable member
// that may be a volume or an archive, and once more if the archive ends too early.
template <class Take, class LeaveOut>
Status for_each_member(const fs::path& path, Take take, LeaveOut leave_out) {
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (!file.is_open()) return tl::unexpected(failure(path, {errno, std::system_category()}));
    auto reader = archive::ArchiveReader::open(file.number());
    if (!reader)
        return fail(ErrorCode::corrupt, "{}: is no archive, though named as one", path.native());
    while (const auto member = reader->next()) {
        if (Status taken = take(*member); !taken) return taken;
    }
    const auto& left_out = reader->left_out();
    for (const archive::LeftOut& one : left_out) {
        const std::string name = own_name_of(one.name);
        if (one.name.empty() || is_archive_name(name) || volume_named(name)) leave_out(name, one);
    }
    // Report the early end, because further members may have followed.
    const std::string& why = reader->why_ended();
    if (reader->is_unreadable()) return fail(ErrorCode::io, "{}: {}", path.native(), why);
    if (!why.empty() && (left_out.empty() || left_out.back().reason != why))
        leave_out(std::string{}, archive::LeftOut{{}, why});
    return {};
}

// Collects the files of each station-day during a walk through a source.
class Walk {
  public:
    Walk(fs::path root, TimeSpan span) : root_(std::move(root)), span_(span) {}

    Status directory(const fs::path& parent, int depth) {
        std::error_code error;
        std::vector<fs::path> deeper;
        for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
             entry.increment(error)) {
            const std::string name = entry->path().filename().string();
            if (pipeline::is_temporary_name(name)) continue;
            std::error_code unknown;
            const fs::file_type type = entry->symlink_status(unknown).type();
            // A file that was removed during the walk is no failure.
            if (unknown && type != fs::file_type::not_found)
                return tl::unexpected(failure(entry->path(), unknown));
            if (type == fs::file_type::directory && depth < max_depth) {
                deeper.push_back(entry->path());
            } else if (type == fs::file_type::regular) {
                if (Status taken = file(entry->path(), name); !taken) return taken;
            } else if (type == fs::file_type::symlink) {
                if (listing_.links++ == 0) listing_.first_link = entry->path();
            }
        }
        if (error) return tl::unexpected(failure(parent, error));
        for (const fs::path& child : deeper) {
            if (Status walked = directory(child, depth + 1); !walked) return walked;
        }
        return {};
    }

    SourceListing listing() && {
        for (auto& [key, found] : found_) {
            StationDay& day = listing_.days.emplace_back(std::move(found.day));
            day.in.assign(found.in.begin(), found.in.end());
        }
        return std::move(listing_);
    }

  private:
    struct Found {
        StationDay day;
        std::set<std::string> in;
    };

    Status file(const fs::path& path, const std::string& name) {
        if (is_archive_name(name)) {
            const std::string in = fs::relative(path, root_).native();
            Status read = for_each_member(
                path,
                [&](const archive::Member& member) -> Status {
                    count(own_name_of(member.name), in, member.bytes.size());
                    return {};
                },
                [&](const std::string& own_name, const archive::LeftOut& one) {
                    const auto volume = volume_named(own_name);
                    if (volume && !span_.has(volume->start)) return;
                    const fs::path what = one.name.empty() ? path : member_path(path, one.name);
                    listing_.cut.push_back(fmt::format("{}: {}", what.native(), one.reason));
                });
            if (read || read.error().cause() != Cause::data) return read;
            listing_.cut.push_back(read.error().message);
            return {};
        }
        std::error_code error;
        const auto size = fs::file_size(path, error);
        if (error && error != std::errc::no_such_file_or_directory)
            return tl::unexpected(failure(path, error));
        if (!error) count(name, fs::relative(path.parent_path(), root_).native(), size);
        return {};
    }

    void count(const std::string& name, const std::string& in, std::uint64_t bytes) {
        const auto volume = volume_named(name);
        if (!volume) {
            note_nameless((fs::path(in) / name).lexically_normal().native());
            return;
        }
        if (!span_.has(volume->start)) return;
        if (!is_plan_text(in)) return note_nameless(printable(in));
        Found& found = found_[{volume->day(), volume->station}];
        found.day.day = volume->day();
        found.day.station = volume->station;
        found.in.insert(in);
        ++found.day.files;
        found.day.bytes += bytes;
    }

    void note_nameless(const std::string& name) {
        if (listing_.nameless++ == 0) listing_.first_nameless = name;
    }

    fs::path root_;
    TimeSpan span_;
    std::map<std::pair<std::chrono::sys_days, std::string>, Found> found_;
    SourceListing listing_;
};

// Returns the range in which a task's volumes begin.
TimeSpan span_of(const Recipe& recipe, std::chrono::sys_days day) {
    return {std::max<UtcTime>(day, recipe.from - recipe.margin()),
            std::min<UtcTime>(UtcTime{day} + std::chrono::days{1} - std::chrono::milliseconds{1},
                              recipe.to + recipe.margin())};
}

bool is_of(const std::string& name, const StationDay& what, const TimeSpan& span) {
    const auto volume = volume_named(name);
    return volume && volume->station == what.station && span.has(volume->start);
}

Status set_time(const fs::path& path, UtcTime time) {
    const std::int64_t ms = time.time_since_epoch().count();
    const timespec at{static_cast<time_t>(ms / 1000), static_cast<long>(ms % 1000) * 1'000'000};
    const std::array times{at, at};
    if (::utimensat(AT_FDCWD, path.c_str(), times.data(), 0) == 0) return {};
    return tl::unexpected(failure(path, {errno, std::system_category()}));
}

// Returns the time at which a file was last changed.
Result<UtcTime> time_of(const fs::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0) {
        return tl::unexpected(failure(path, {errno, std::system_category()}));
    }
    return UtcTime{std::chrono::milliseconds{std::int64_t{facts.st_mtim.tv_sec} * 1000 +
                                             facts.st_mtim.tv_nsec / 1'000'000}};
}

Status add_members(const fs::path& tar, const StationDay& what, const TimeSpan& span,
                   const fs::path& scratch, std::set<fs::path>& files,
                   std::vector<pipeline::LeftOut>& left_out) {
    const auto modified = time_of(tar);
    if (!modified) return pass_on(modified);
    const auto take = [&](const archive::Member& member) -> Status {
        const std::string name = own_name_of(member.name);
        if (!is_of(name, what, span)) return {};
        // Make the copy anew, because another archive may have held a file of this name, complete
        // or not.
        fs::path path = scratch / name;
        for (int number = 2; files.contains(path); ++number)
            path = scratch / std::to_string(number) / name;
        std::error_code error;
        fs::create_directories(path.parent_path(), error);
        if (error) return tl::unexpected(failure(path, error));
        if (Status written = write_file_atomically(real_file_system(), path, member.bytes);
            !written) {
            return written;
        }
        files.insert(path);
        return set_time(path, member.modified.value_or(*modified));
    };
    return for_each_member(tar, take, [&](const std::string& name, const archive::LeftOut& one) {
        if (volume_named(name) && !is_of(name, what, span)) return;
        const fs::path in = tar.filename();
        left_out.push_back({one.name.empty() ? in : member_path(in, one.name), one.reason});
    });
}

Status add_files(const fs::path& directory, const StationDay& what, const TimeSpan& span,
                 std::set<fs::path>& files) {
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        std::error_code ignored;
        const bool is_file = entry->symlink_status(ignored).type() == fs::file_type::regular;
        if (is_file && !pipeline::is_temporary_name(name) && is_of(name, what, span))
            files.insert(entry->path());
    }
    if (error) return tl::unexpected(failure(directory, error));
    return {};
}

Result<BroughtFiles> fetch_files(const Recipe& recipe, const StationDay& what, const TimeSpan& span,
                                 const fs::path& scratch, const std::atomic<bool>& stop) {
    fetch::FetchRequest request;
    request.source = recipe.source;
    request.stations = {what.station};
    request.from = span.from;
    request.to = span.to;
    request.directory = scratch;
    request.parallel = transfers_of_a_task;
    request.stop = &stop;
    const auto report = fetch::fetch(request);
    if (!report) return pass_on(report);
    if (report->stopped) return fail(ErrorCode::busy, "stopped while files were fetched");
    // If the bucket lists a file but refuses it, leave the file out, because another try would not
    // help. Return every other failure, because another try may succeed.
    std::vector<pipeline::LeftOut> refused;
    for (const fetch::FetchFailure& failure : report->failures) {
        if (!failure.is_refused) {
            return fail(ErrorCode::io, "{} of {} files could not be fetched: {}: {}",
                        report->failures.size(), report->found, failure.what, failure.reason);
        }
        refused.push_back({fs::path(failure.what).filename(), failure.reason});
    }
    std::ranges::sort(refused, {}, &pipeline::LeftOut::path);
    std::set<fs::path> files;
    if (Status added = add_files(scratch, what, span, files); !added) return pass_on(added);
    return BroughtFiles{{files.begin(), files.end()}, scratch, std::move(refused)};
}

}  // namespace

std::optional<NamedVolume> volume_named(std::string_view file_name) {
    const std::string station = station_in_name(file_name);
    if (station.empty() || file_name.ends_with("_MDM")) return std::nullopt;
    constexpr std::size_t icao = 4, time = 15;
    // NCEI writes four digits before the name of the station.
    const std::size_t before = icao_of(file_name.substr(0, icao)) == station ? 0 : icao;
    if (file_name.size() < before + icao + time) return std::nullopt;
    const auto start = parse_compact(file_name.substr(before + icao, time));
    if (!start) return std::nullopt;
    return NamedVolume{station, *start};
}

Result<SourceListing> list_source(const std::string& source, UtcTime from, UtcTime to) {
    Walk walk(source, {from, to});
    if (Status walked = walk.directory(source, 0); !walked) return pass_on(walked);
    return std::move(walk).listing();
}

SourceListing every_day_of(const std::vector<std::string>& stations, UtcTime from, UtcTime to) {
    using std::chrono::days;
    SourceListing listing;
    for (auto day = std::chrono::floor<days>(from); day <= to; day += days{1}) {
        for (const std::string& station : stations)
            listing.days.push_back({day, station, {}, 0, 0});
    }
    return listing;
}

Result<BroughtFiles> bring(const Recipe& recipe, const StationDay& what, const fs::path& scratch,
                           const std::atomic<bool>& stop) {
    const TimeSpan span = span_of(recipe, what.day);
    if (is_address(recipe.source)) return fetch_files(recipe, what, span, scratch, stop);
    const fs::path root = recipe.source;
    std::set<fs::path> files;
    std::vector<pipeline::LeftOut> left_out;
    bool from_tars = false;
    for (const std::string& in : what.in) {
        const fs::path place = (root / in).lexically_normal();
        std::error_code unknown;
        const bool is_tar = is_archive_name(in) && !fs::is_directory(place, unknown);
        if (unknown) return tl::unexpected(failure(place, unknown));
        from_tars = from_tars || is_tar;
        Status added = is_tar ? add_members(place, what, span, scratch, files, left_out)
                              : add_files(place, what, span, files);
        if (!added) return pass_on(added);
    }
    BroughtFiles brought{
        {files.begin(), files.end()}, from_tars ? fs::path{} : root, std::move(left_out)};
    std::ranges::stable_sort(brought.files, {}, [](const fs::path& path) {
        const auto volume = volume_named(path.filename().native());
        return std::pair{volume ? volume->start : UtcTime{}, path.filename()};
    });
    return brought;
}

}  // namespace stormcellar::batch
